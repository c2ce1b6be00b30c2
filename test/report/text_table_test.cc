// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/text_table.h"

#include "gtest/gtest.h"

namespace cartographer_sdf::text_table_test {
namespace {

TEST(FormatTableTest, AlignsColumns) {
  EXPECT_EQ(FormatTable({{"id", "length"}, {"0", "1.5"}, {"trajectory", ""}}),
            "  id          length\n"
            "  0              1.5\n"
            "  trajectory\n");
  EXPECT_EQ(FormatTable({{"a"}, {"b", "c"}}), "  a\n  b  c\n");
  EXPECT_EQ(FormatTable({}), "");
}

}  // namespace
}  // namespace cartographer_sdf::text_table_test
