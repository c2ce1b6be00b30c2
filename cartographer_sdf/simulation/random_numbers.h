// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Random numbers that are identical with every standard library: the standard
// specifies the engines, but not the output of the distributions.

#ifndef CARTOGRAPHER_SDF_SIMULATION_RANDOM_NUMBERS_H_
#define CARTOGRAPHER_SDF_SIMULATION_RANDOM_NUMBERS_H_

#include <cmath>
#include <cstdint>
#include <random>

namespace cartographer_sdf {

// The purpose of the numbers. Purposes that share a seed do not share numbers,
// and drawing more numbers for one does not change the others.
enum class RandomStream : uint32_t {
  kPlan,
  kDrive,
  kDrift,
  kLidar,
  kMaterials,
  kPeople
};

class RandomNumbers {
 public:
  explicit RandomNumbers(uint32_t seed,
                         RandomStream stream = RandomStream::kPlan)
      : engine_(seed * 2654435761u + static_cast<uint32_t>(stream) * 40503u) {}

  // In [minimum, maximum).
  double Uniform(double minimum, double maximum) {
    return minimum + (maximum - minimum) * std::ldexp(engine_(), -32);
  }
  bool Chance(double probability) { return Uniform(0., 1.) < probability; }
  // In [0, size); size > 0.
  int Index(int size) { return static_cast<int>(Uniform(0., size)); }
  // Standard normal, by the Box-Muller transform.
  double Normal() {
    const double radius = std::sqrt(-2. * std::log(1. - Uniform(0., 1.)));
    return radius * std::cos(Uniform(0., 2. * M_PI));
  }

 private:
  std::mt19937 engine_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_RANDOM_NUMBERS_H_
