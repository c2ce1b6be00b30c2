// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/nearest_name.h"

#include "gtest/gtest.h"

namespace cartographer_sdf::nearest_name_test {
namespace {

TEST(NearestNameTest, FindsMisspellings) {
  EXPECT_EQ(NearestName("clos_loop", {"match", "close_loops", "simulate"}),
            "close_loops");
  EXPECT_EQ(NearestName("Match", {"match", "close_loops"}), "match");
  EXPECT_EQ(NearestName("mtach", {"match", "close_loops"}), "match");
}

TEST(NearestNameTest, FindsNothingFarAway) {
  EXPECT_EQ(NearestName("info", {"match", "close_loops"}), std::nullopt);
  EXPECT_EQ(NearestName("", {"match"}), std::nullopt);
  EXPECT_EQ(NearestName("match", {}), std::nullopt);
  EXPECT_EQ(NearestName(std::string(1000000, 'a'), {std::string(1000000, 'a')}),
            std::nullopt);
}

TEST(NearestNameTest, TakesTheFirstOnTies) {
  EXPECT_EQ(NearestName("bat", {"cat", "rat"}), "cat");
  EXPECT_EQ(NearestName("bat", {"rat", "cat"}), "rat");
}

}  // namespace
}  // namespace cartographer_sdf::nearest_name_test
