// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/registration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Fewer wall points than this fix no pose.
constexpr double kMinSumOfWeights = 5.;

struct NormalEquations {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double sum_of_weights = 0.;

  void Add(const double weight, const double residual,
           const Eigen::Vector3d& jacobian) {
    A.noalias() += weight * jacobian * jacobian.transpose();
    b.noalias() -= weight * residual * jacobian;
    sum_of_weights += weight;
  }
};

double GemanMcClureWeight(const double residual, const double scale) {
  const double ratio = 1. + residual * residual / (scale * scale);
  return 1. / (ratio * ratio);
}

Eigen::Vector2d Perpendicular(const Eigen::Vector2d& v) {
  return Eigen::Vector2d(-v.y(), v.x());
}

// The distance to the middle of a wall: a wall's cells are its points, and the
// field is zero on their edge, half a cell away.
double Residual(const SurfaceModel& field, const FieldSample& sample) {
  return sample.distance + 0.5 * field.geometry.resolution;
}

// Points of the frame that moves, against a field that stands.
void AddForward(const SurfaceModel& field,
                const std::vector<SurfacePoint>& points, const size_t count,
                const Rigid2& T_field_points, const double scale,
                NormalEquations* const equations) {
  const Rigid2 T_grid_points =
      field.geometry.T_submap_grid.Inverse() * T_field_points;
  const Eigen::Matrix2d R = T_grid_points.RotationMatrix();
  const Eigen::Matrix2d R_field_grid =
      field.geometry.T_submap_grid.RotationMatrix();
  const Eigen::Matrix2d R_field_points = T_field_points.RotationMatrix();
  for (size_t k = 0; k < count; ++k) {
    const std::optional<FieldSample> sample = SampleSurface(
        field, R * points[k].position + T_grid_points.translation());
    if (!sample) continue;
    const double residual = Residual(field, *sample);
    const Eigen::Vector2d gradient = R_field_grid * sample->gradient;
    equations->Add(
        points[k].weight * GemanMcClureWeight(residual, scale), residual,
        {gradient.x(), gradient.y(),
         gradient.dot(Perpendicular(R_field_points * points[k].position))});
  }
}

// Points that stand, against a field of the frame that moves.
void AddBackward(const SurfaceModel& field,
                 const std::vector<SurfacePoint>& points, const size_t count,
                 const Rigid2& T_points_field, const double scale,
                 NormalEquations* const equations) {
  const Rigid2 T_field_points = T_points_field.Inverse();
  const Rigid2 T_grid_field = field.geometry.T_submap_grid.Inverse();
  const Eigen::Matrix2d R_field_points = T_field_points.RotationMatrix();
  const Eigen::Matrix2d R_points_field = T_points_field.RotationMatrix();
  const Eigen::Matrix2d R_grid_field = T_grid_field.RotationMatrix();
  for (size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d p_field =
        R_field_points * points[k].position + T_field_points.translation();
    const std::optional<FieldSample> sample = SampleSurface(
        field, R_grid_field * p_field + T_grid_field.translation());
    if (!sample) continue;
    const double residual = Residual(field, *sample);
    const Eigen::Vector2d gradient =
        R_grid_field.transpose() * sample->gradient;
    const Eigen::Vector2d translation = -(R_points_field * gradient);
    equations->Add(points[k].weight * GemanMcClureWeight(residual, scale),
                   residual,
                   {translation.x(), translation.y(),
                    -gradient.dot(Perpendicular(p_field))});
  }
}

template <typename AddResiduals>
std::optional<Rigid2> GaussNewton(const RegistrationOptions& options,
                                  const Rigid2& guess,
                                  const AddResiduals& add_residuals) {
  CHECK_EQ(Validate(options), "");
  Rigid2 pose = guess;
  const double shrink = options.num_iterations > 1
                            ? std::pow(options.final_kernel_scale_meters /
                                           options.initial_kernel_scale_meters,
                                       1. / (options.num_iterations - 1))
                            : 1.;
  double scale = options.initial_kernel_scale_meters;
  for (int k = 0; k < options.num_iterations; ++k, scale *= shrink) {
    NormalEquations equations;
    // A third of the points is enough to come near.
    const int divisor = 2 * k < options.num_iterations ? 3 : 1;
    add_residuals(pose, scale, divisor, &equations);
    if (equations.sum_of_weights * divisor < kMinSumOfWeights) {
      return std::nullopt;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(equations.A);
    if (solver.info() != Eigen::Success || !solver.isPositive() ||
        solver.rcond() < 1e-9) {
      return std::nullopt;
    }
    const Eigen::Vector3d step = solver.solve(equations.b);
    pose =
        Rigid2(pose.translation() + step.head<2>(), pose.rotation() + step.z());
  }
  return pose;
}

// The first of the points are a fair sample of all.
size_t Count(const RegistrationOptions& options,
             const std::vector<SurfacePoint>& points, const int divisor) {
  return std::min(points.size(), static_cast<size_t>(options.max_num_points)) /
         divisor;
}

// Walls of each submap against the field of the other.
void AddBothWays(const RegistrationOptions& options,
                 const SurfaceModel& reference, const SurfaceModel& query,
                 const Rigid2& T_reference_query, const double scale,
                 const int divisor, NormalEquations* const equations) {
  AddForward(reference, query.walls, Count(options, query.walls, divisor),
             T_reference_query, scale, equations);
  AddBackward(query, reference.walls, Count(options, reference.walls, divisor),
              T_reference_query, scale, equations);
}

}  // namespace

std::string Validate(const RegistrationOptions& options) {
  if (options.num_iterations < 1 || options.num_iterations > 1000) {
    return "num_iterations must lie between 1 and 1000";
  }
  if (!(options.final_kernel_scale_meters > 0. &&
        options.initial_kernel_scale_meters >=
            options.final_kernel_scale_meters)) {
    return "final_kernel_scale_meters must be positive and not "
           "above initial_kernel_scale_meters";
  }
  if (options.max_num_points < 10) {
    return "max_num_points must be at least 10";
  }
  return "";
}

std::optional<Rigid2> RegisterSubmaps(const RegistrationOptions& options,
                                      const SurfaceModel& reference,
                                      const SurfaceModel& query,
                                      const Rigid2& guess_T_reference_query) {
  return GaussNewton(options, guess_T_reference_query,
                     [&](const Rigid2& pose, const double scale,
                         const int divisor, NormalEquations* const equations) {
                       AddBothWays(options, reference, query, pose, scale,
                                   divisor, equations);
                     });
}

Eigen::Matrix2d NormalScatter(const RegistrationOptions& options,
                              const SurfaceModel& reference,
                              const SurfaceModel& query,
                              const Rigid2& T_reference_query) {
  NormalEquations equations;
  AddBothWays(options, reference, query, T_reference_query,
              options.final_kernel_scale_meters, 1, &equations);
  if (equations.sum_of_weights < kMinSumOfWeights) {
    return Eigen::Matrix2d::Zero();
  }
  return equations.A.topLeftCorner<2, 2>() / equations.sum_of_weights;
}

std::optional<Rigid2> RegisterPoints(const RegistrationOptions& options,
                                     const SurfaceModel& reference,
                                     const std::vector<SurfacePoint>& points,
                                     const Rigid2& guess_T_reference_points,
                                     const PosePrior& prior) {
  CHECK_GT(prior.translation_sigma, 0.);
  CHECK_GT(prior.rotation_sigma, 0.);
  const double per_meter = prior.residual_sigma / prior.translation_sigma;
  const double per_radian = prior.residual_sigma / prior.rotation_sigma;
  const Eigen::Vector3d precision(per_meter * per_meter, per_meter * per_meter,
                                  per_radian * per_radian);
  return GaussNewton(
      options, guess_T_reference_points,
      [&](const Rigid2& pose, const double scale, const int divisor,
          NormalEquations* const equations) {
        AddForward(reference, points, Count(options, points, divisor), pose,
                   scale, equations);
        const Eigen::Vector2d moved =
            pose.translation() - guess_T_reference_points.translation();
        const Eigen::Vector3d deviation(
            moved.x(), moved.y(),
            NormalizeAngle(pose.rotation() -
                           guess_T_reference_points.rotation()));
        equations->A.diagonal() += precision;
        equations->b -= precision.cwiseProduct(deviation);
      });
}

}  // namespace cartographer_sdf
