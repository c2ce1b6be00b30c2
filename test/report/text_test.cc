// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/text.h"

#include "gtest/gtest.h"

namespace cartographer_sdf::text_test {
namespace {

TEST(EscapeMarkupTest, EscapesWhatIsMarkup) {
  EXPECT_EQ(EscapeMarkup("<a href=\"x\">'&amp;'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;&#39;&lt;/a&gt;");
}

TEST(EscapeMarkupTest, KeepsUtf8) {
  const std::string text = "\u00fc \u20ac \U0001f600\n\t.";
  EXPECT_EQ(EscapeMarkup(text), text);
}

TEST(EscapeMarkupTest, ReplacesWhatIsNoText) {
  EXPECT_EQ(EscapeMarkup(std::string("a\0b\x1b\x7f", 5)), "a?b??");
  // U+FFFD.
  const std::string replaced = "\xef\xbf\xbd";
  EXPECT_EQ(EscapeMarkup("\xff\xfe"), replaced + replaced);
  EXPECT_EQ(EscapeMarkup("\xc3"), replaced);
  EXPECT_EQ(EscapeMarkup("\xe2\x82<"), replaced + "&lt;");
  // Overlong, surrogate, beyond Unicode.
  for (const char* const text :
       {"\xc0\xbc", "\xe0\x80\xbc", "\xed\xa0\x80", "\xf4\x90\x80\x80"}) {
    std::string escaped = EscapeMarkup(text);
    ASSERT_FALSE(escaped.empty());
    for (; !escaped.empty(); escaped.erase(0, replaced.size())) {
      EXPECT_EQ(escaped.substr(0, replaced.size()), replaced) << text;
    }
  }
}

TEST(FormatTableTest, AlignsColumns) {
  EXPECT_EQ(FormatTable({{"id", "length"}, {"0", "1.5"}, {"trajectory", ""}}),
            "  id          length\n"
            "  0              1.5\n"
            "  trajectory\n");
  EXPECT_EQ(FormatTable({{"a"}, {"b", "c"}}), "  a\n  b  c\n");
  EXPECT_EQ(FormatTable({}), "");
}

}  // namespace
}  // namespace cartographer_sdf::text_test
