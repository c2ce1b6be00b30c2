// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Point-to-field registration: Gauss-Newton on the distances of wall points to
// the walls of a distance field, with analytic gradients and a robust kernel
// that narrows (graduated non-convexity, [Yang2020]). Local: it needs a guess
// within some 0.5 m and 6 degrees.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_REGISTRATION_H_
#define CARTOGRAPHER_SDF_VERIFICATION_REGISTRATION_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"

namespace cartographer_sdf {

struct RegistrationOptions {
  int num_iterations = 12;
  // Scale of the Geman-McClure kernel in the first and the last iteration [m].
  double initial_kernel_scale_meters = 0.4;
  double final_kernel_scale_meters = 0.15;
  // Wall points used of each submap. Larger: more precise, slower.
  int max_num_points = 300;
};
[[nodiscard]] std::string Validate(const RegistrationOptions& options);

// The refined pose (reference <- query), from query walls to the reference's
// field and reference walls to the query's. None where too few points fall into
// the other's field, or the normal equations are singular.
[[nodiscard]] std::optional<Rigid2> RegisterSubmaps(
    const RegistrationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& guess_T_reference_query);

// The same in two halves: few points and wide kernels bring the pose within
// some 0.1 m, where most wrong poses can be told already; all points settle it.
[[nodiscard]] std::optional<Rigid2> RegisterCoarsely(
    const RegistrationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& guess_T_reference_query);
[[nodiscard]] std::optional<Rigid2> RegisterFinely(
    const RegistrationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& coarse_T_reference_query);

// The refined pose of points (a scan, in its node's frame) in the reference's
// field. A prior with these standard deviations [m], [rad], against residuals
// of `residual_sigma` [m], holds the guess where the walls leave it free.
struct PosePrior {
  double translation_sigma;
  double rotation_sigma;
  double residual_sigma = 0.05;
};
[[nodiscard]] std::optional<Rigid2> RegisterPoints(
    const RegistrationOptions& options, const SurfaceModel& reference,
    const std::vector<SurfacePoint>& points,
    const Rigid2& guess_T_reference_points, const PosePrior& prior);

// Scatter of the normals of the walls that match at a pose, in the reference
// frame, with weights that sum to one. Its smaller eigenvalue is near 0 where
// one could slide along, 0.5 where walls face all ways; its eigenvector is the
// direction in which the walls constrain the pose least. Walls that slant in
// the grid have steps, which raise the eigenvalue in a bare corridor to as much
// as 0.2. Zero where too few walls match to fix a pose.
[[nodiscard]] Eigen::Matrix2d NormalScatter(const RegistrationOptions& options,
                                            const SurfaceModel& reference,
                                            const SurfaceModel& query,
                                            const Rigid2& T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_REGISTRATION_H_
