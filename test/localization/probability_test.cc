// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/probability.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_sdf::probability_test {
namespace {

TEST(ProbabilityOfTest, IsThatOfTheOdds) {
  EXPECT_NEAR(ProbabilityOf(0.), 0.5, 1e-12);
  EXPECT_NEAR(ProbabilityOf(std::log(9.)), 0.9, 1e-12);
  EXPECT_NEAR(ProbabilityOf(-std::log(9.)), 0.1, 1e-12);
  EXPECT_EQ(ProbabilityOf(std::numeric_limits<double>::infinity()), 1.);
  EXPECT_EQ(ProbabilityOf(-1e9), 0.);
  EXPECT_EQ(ProbabilityOf(1e9), 1.);
}

TEST(ProbabilityOfTest, ThisTheOtherOrNeither) {
  const double first = std::log(6.), second = std::log(3.);
  EXPECT_NEAR(ProbabilityOf(first, second), 0.6, 1e-12);
  EXPECT_NEAR(ProbabilityOf(second, first), 0.3, 1e-12);
  EXPECT_EQ(ProbabilityOf(first, {}), ProbabilityOf(first));
  // Two that are certain.
  EXPECT_NEAR(ProbabilityOf(800., 800.), 0.5, 1e-12);
}

TEST(FormatProbabilityTest, ClaimsNoCertainty) {
  EXPECT_EQ(FormatProbability(0.9731), "97.3 %");
  EXPECT_EQ(FormatProbability(1.), "more than 99.9 %");
  EXPECT_EQ(FormatProbability(0.), "less than 0.1 %");
  EXPECT_EQ(FormatProbability(0.999), "99.9 %");
}

}  // namespace
}  // namespace cartographer_sdf::probability_test
