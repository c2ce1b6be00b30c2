// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/error_statistics.h"

#include "gtest/gtest.h"

namespace cartographer_sdf::error_statistics_test {
namespace {

TEST(SummarizeTest, InterpolatesBetweenSortedValues) {
  const std::optional<ErrorStatistics> odd = Summarize({5., 1., 3.});
  ASSERT_TRUE(odd.has_value());
  EXPECT_EQ(odd->count, 3);
  EXPECT_DOUBLE_EQ(odd->mean, 3.);
  EXPECT_DOUBLE_EQ(odd->median, 3.);
  EXPECT_DOUBLE_EQ(odd->percentile_90, 3. + 0.8 * 2.);
  EXPECT_DOUBLE_EQ(odd->max, 5.);
  const std::optional<ErrorStatistics> even = Summarize({8., 0., 2., 1.});
  ASSERT_TRUE(even.has_value());
  EXPECT_DOUBLE_EQ(even->mean, 2.75);
  EXPECT_DOUBLE_EQ(even->median, 1.5);
  EXPECT_DOUBLE_EQ(even->percentile_90, 2. + 0.7 * 6.);
}

TEST(SummarizeTest, OfOneIsThatOne) {
  const std::optional<ErrorStatistics> one = Summarize({7.});
  ASSERT_TRUE(one.has_value());
  EXPECT_EQ(one->count, 1);
  EXPECT_EQ(one->mean, 7.);
  EXPECT_EQ(one->median, 7.);
  EXPECT_EQ(one->percentile_90, 7.);
  EXPECT_EQ(one->max, 7.);
}

TEST(SummarizeTest, NoneOfNone) { EXPECT_FALSE(Summarize({}).has_value()); }

}  // namespace
}  // namespace cartographer_sdf::error_statistics_test
