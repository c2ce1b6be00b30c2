// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Registers a sweep to the distance field of a map: Gauss-Newton on the
// distances of its echoes to the walls, with a robust kernel that narrows.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SWEEP_REGISTRATION_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SWEEP_REGISTRATION_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/localization/sweep.h"

namespace cartographer_sdf {

struct RegisteredSweep {
  Rigid2 T_grid_robot;
  // Of x, y [m^2] in the grid frame and of the heading [rad^2], about the
  // sensors' centre: large along what the echoes do not hold.
  Eigen::Matrix3d covariance;
};

// Uses about `num_beams` of the beams with an echo. Starts with a kernel of
// `first_kernel_scale` [m]. Nullopt if fewer than 5 echoes fall into the field.
[[nodiscard]] std::optional<RegisteredSweep> RegisterSweep(
    const DistanceField& field, const Sweep& sweep, size_t num_beams,
    double first_kernel_scale, const Rigid2& guess_T_grid_robot);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SWEEP_REGISTRATION_H_
