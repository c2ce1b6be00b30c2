// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Calls something of each installed library; exits with 0 where both answer.

#include <cmath>
#include <iostream>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/pbstream/map_file.h"

int main() {
  const cartographer_sdf::Rigid2 T_a_b(1., 2., 0.5);
  const cartographer_sdf::Rigid2 identity = T_a_b * T_a_b.Inverse();
  const auto map = cartographer_sdf::ReadMap("does_not_exist.pbstream");
  std::cout << map.status() << "\n";
  const bool core_works = identity.translation().norm() < 1e-12 &&
                          std::abs(identity.rotation()) < 1e-12;
  return core_works && !map.ok() ? 0 : 1;
}
