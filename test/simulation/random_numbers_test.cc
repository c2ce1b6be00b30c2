// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/random_numbers.h"

#include <algorithm>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_sdf::random_numbers_test {
namespace {

constexpr int kNumSamples = 100000;

TEST(RandomNumbersTest, UniformFillsItsRange) {
  RandomNumbers random(42);
  double smallest = 10., largest = -10., sum = 0.;
  for (int k = 0; k != kNumSamples; ++k) {
    const double number = random.Uniform(-2., 4.);
    smallest = std::min(smallest, number);
    largest = std::max(largest, number);
    sum += number;
  }
  EXPECT_GE(smallest, -2.);
  EXPECT_LT(smallest, -1.99);
  EXPECT_LT(largest, 4.);
  EXPECT_GT(largest, 3.99);
  // Four standard deviations of the mean.
  EXPECT_NEAR(sum / kNumSamples, 1., 4. * 6. / std::sqrt(12. * kNumSamples));
}

TEST(RandomNumbersTest, NormalHasUnitVarianceAndTails) {
  RandomNumbers random(42);
  double sum = 0., sum_squared = 0.;
  int beyond_two = 0;
  for (int k = 0; k != kNumSamples; ++k) {
    const double number = random.Normal();
    ASSERT_TRUE(std::isfinite(number));
    sum += number;
    sum_squared += number * number;
    beyond_two += std::abs(number) > 2.;
  }
  EXPECT_NEAR(sum / kNumSamples, 0., 4. / std::sqrt(kNumSamples));
  EXPECT_NEAR(sum_squared / kNumSamples, 1., 4. * std::sqrt(2. / kNumSamples));
  EXPECT_NEAR(beyond_two, 0.0455 * kNumSamples,
              4. * std::sqrt(0.0455 * kNumSamples));
}

TEST(RandomNumbersTest, IndicesAreEquallyLikely) {
  RandomNumbers random(42);
  std::vector<int> counts(7);
  for (int k = 0; k != kNumSamples; ++k) ++counts.at(random.Index(7));
  for (const int count : counts) {
    EXPECT_NEAR(count, kNumSamples / 7., 4. * std::sqrt(kNumSamples / 7.));
  }
}

TEST(RandomNumbersTest, SeedsAndStreamsDiffer) {
  const auto first = [](uint32_t seed, RandomStream stream) {
    return RandomNumbers(seed, stream).Uniform(0., 1.);
  };
  const double number = first(42, RandomStream::kPlan);
  EXPECT_EQ(number, first(42, RandomStream::kPlan));
  EXPECT_NE(number, first(43, RandomStream::kPlan));
  EXPECT_NE(number, first(42, RandomStream::kDrive));
  EXPECT_NE(first(42, RandomStream::kDrift), first(42, RandomStream::kLidar));
}

}  // namespace
}  // namespace cartographer_sdf::random_numbers_test
