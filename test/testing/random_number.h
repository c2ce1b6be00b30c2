// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_RANDOM_NUMBER_H_
#define TEST_TESTING_RANDOM_NUMBER_H_

#include <random>

namespace cartographer_sdf::testing {

// In [low, high); the standard's distributions differ between libraries.
inline double Uniform(const double low, const double high,
                      std::mt19937* const engine) {
  return low + (high - low) * static_cast<double>((*engine)()) / 4294967296.;
}

// In [0, bound).
inline int UniformInt(const int bound, std::mt19937* const engine) {
  return static_cast<int>(Uniform(0., bound, engine));
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_RANDOM_NUMBER_H_
