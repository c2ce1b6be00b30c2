// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/compared_numbers.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_sdf::compared_numbers_test {
namespace {

TEST(ComparedNumbersTest, CanBeToldApart) {
  const auto format = [](const double number, const double threshold,
                         const int min_decimals) {
    const ComparedNumbers compared =
        FormatCompared(number, threshold, min_decimals);
    return compared.number + " " + compared.threshold;
  };
  EXPECT_EQ(format(3., 6.5, 1), "3.0 6.5");
  EXPECT_EQ(format(6.496, 6.5, 1), "6.496 6.500");
  EXPECT_EQ(format(6.4, 6.6, 0), "6 7");
  EXPECT_EQ(format(19.6, 20., 0), "19.6 20.0");
  EXPECT_EQ(format(6.5, 6.5, 1), "6.5 6.5");
  const double almost = std::nextafter(1., 0.);
  EXPECT_EQ(format(almost, 1., 1), "0.9999999999999999 1.0000000000000000");
  EXPECT_EQ(format(std::numeric_limits<double>::infinity(), 1., 1), "inf 1.0");
}

}  // namespace
}  // namespace cartographer_sdf::compared_numbers_test
