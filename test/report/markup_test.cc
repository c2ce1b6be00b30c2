// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/markup.h"

#include "gtest/gtest.h"

namespace cartographer_sdf::markup_test {
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
  EXPECT_EQ(EscapeMarkup("\xff\xfe"), "??");
  EXPECT_EQ(EscapeMarkup("\xc3"), "?");
  EXPECT_EQ(EscapeMarkup("\xe2\x82<"), "??&lt;");
  // Overlong, surrogate, beyond Unicode.
  EXPECT_EQ(EscapeMarkup("\xc0\xbc"), "??");
  EXPECT_EQ(EscapeMarkup("\xe0\x80\xbc"), "???");
  EXPECT_EQ(EscapeMarkup("\xed\xa0\x80"), "???");
  EXPECT_EQ(EscapeMarkup("\xf4\x90\x80\x80"), "????");
}

}  // namespace
}  // namespace cartographer_sdf::markup_test
