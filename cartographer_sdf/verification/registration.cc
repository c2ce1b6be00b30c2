// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/registration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Fewer wall points than this fix no pose.
constexpr double kMinSumOfWeights = 5.;

struct NormalEquations {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();  // the lower triangle
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double sum_of_weights = 0.;

  void Add(const double weight, const double residual,
           const Eigen::Vector3d& jacobian) {
    const Eigen::Vector3d weighted = weight * jacobian;
    for (int column = 0; column < 3; ++column) {
      for (int row = column; row < 3; ++row) {
        A(row, column) += weighted[row] * jacobian[column];
      }
    }
    b.noalias() -= residual * weighted;
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

constexpr size_t kPrefetchedPoints = 64;

// Both columns of the four cells around a point.
void PrefetchCells(const SurfaceCellArray& cells,
                   const Eigen::Vector2d& point) {
  if (!(point.x() >= 0. && point.y() >= 0. &&
        point.x() < static_cast<double>(cells.rows() - 1) &&
        point.y() < static_cast<double>(cells.cols() - 1))) {
    return;
  }
  const SurfaceCell* const cell = &cells(static_cast<Eigen::Index>(point.x()),
                                         static_cast<Eigen::Index>(point.y()));
  __builtin_prefetch(cell);
  __builtin_prefetch(cell + cells.rows());
}

// Calls visit(point, p_field, residual, gradient) for the first `count` points
// that fall into the field: the point in the field's frame [m], its distance to
// the middle of a wall [m] and the gradient of that in the field's frame. A
// wall's cells are its points, and the field is zero on their edge, half a cell
// away.
template <typename Visitor>
void VisitField(const SurfaceModel& field,
                const std::vector<SurfacePoint>& points, const size_t count,
                const Rigid2& T_field_points, const Visitor& visit) {
  const CellGeometry& geometry = field.geometry;
  const Rigid2 T_grid_points =
      geometry.T_submap_grid.Inverse() * T_field_points;
  const Eigen::Matrix2d R_cells_points =
      T_grid_points.RotationMatrix() / geometry.resolution;
  const Eigen::Vector2d t_cells_points =
      geometry.GridToCells(T_grid_points.translation());
  const Eigen::Matrix2d R_field_points = T_field_points.RotationMatrix();
  const Eigen::Matrix2d R_field_grid = geometry.T_submap_grid.RotationMatrix();
  const double half_cell = 0.5 * geometry.resolution;
  const PinnedCells field_cells = field.cells.Pin();
  std::array<Eigen::Vector2d, kPrefetchedPoints> cells;
  for (size_t begin = 0; begin < count; begin += kPrefetchedPoints) {
    const size_t size = std::min(kPrefetchedPoints, count - begin);
    // The cells lie far apart in memory: all are on their way before the first
    // is looked at.
    for (size_t k = 0; k < size; ++k) {
      cells[k] = R_cells_points * points[begin + k].position + t_cells_points;
      PrefetchCells(*field_cells, cells[k]);
    }
    for (size_t k = 0; k < size; ++k) {
      const std::optional<FieldSample> sample =
          SampleSurface(geometry, *field_cells, cells[k]);
      if (!sample) continue;
      const SurfacePoint& point = points[begin + k];
      visit(point,
            R_field_points * point.position + T_field_points.translation(),
            sample->distance + half_cell, R_field_grid * sample->gradient);
    }
  }
}

// Points of the frame that moves, against a field that stands.
void AddForward(const SurfaceModel& field,
                const std::vector<SurfacePoint>& points, const size_t count,
                const Rigid2& T_field_points, const double scale,
                NormalEquations* const equations) {
  VisitField(
      field, points, count, T_field_points,
      [&](const SurfacePoint& point, const Eigen::Vector2d& p_field,
          const double residual, const Eigen::Vector2d& gradient) {
        const Eigen::Vector2d arm = p_field - T_field_points.translation();
        equations->Add(
            point.weight * GemanMcClureWeight(residual, scale), residual,
            {gradient.x(), gradient.y(), gradient.dot(Perpendicular(arm))});
      });
}

// Points that stand, against a field of the frame that moves.
void AddBackward(const SurfaceModel& field,
                 const std::vector<SurfacePoint>& points, const size_t count,
                 const Rigid2& T_points_field, const double scale,
                 NormalEquations* const equations) {
  const Eigen::Matrix2d R_points_field = T_points_field.RotationMatrix();
  VisitField(field, points, count, T_points_field.Inverse(),
             [&](const SurfacePoint& point, const Eigen::Vector2d& p_field,
                 const double residual, const Eigen::Vector2d& gradient) {
               const Eigen::Vector2d translation = -(R_points_field * gradient);
               equations->Add(
                   point.weight * GemanMcClureWeight(residual, scale), residual,
                   {translation.x(), translation.y(),
                    -gradient.dot(Perpendicular(p_field))});
             });
}

// The coarse half of the iterations brings the pose near with a third of the
// points and the wide kernels; the fine half settles it.
struct Iterations {
  int begin;
  int end;
};
Iterations CoarseHalf(const RegistrationOptions& options) {
  return {0, (options.num_iterations + 1) / 2};
}
Iterations FineHalf(const RegistrationOptions& options) {
  return {(options.num_iterations + 1) / 2, options.num_iterations};
}
constexpr int kCoarseDivisor = 3;

double KernelScale(const RegistrationOptions& options, const int iteration) {
  if (options.num_iterations == 1) return options.initial_kernel_scale_meters;
  return options.initial_kernel_scale_meters *
         std::pow(
             options.final_kernel_scale_meters /
                 options.initial_kernel_scale_meters,
             static_cast<double>(iteration) / (options.num_iterations - 1));
}

// Calls add_residuals(pose, kernel scale, divisor of the number of points,
// equations) for each iteration.
template <typename AddResiduals>
std::optional<Rigid2> GaussNewton(const RegistrationOptions& options,
                                  const Iterations& iterations,
                                  const Rigid2& guess,
                                  const AddResiduals& add_residuals) {
  CHECK_EQ(Validate(options), "");
  Rigid2 pose = guess;
  for (int k = iterations.begin; k < iterations.end; ++k) {
    NormalEquations equations;
    const int divisor = k < CoarseHalf(options).end ? kCoarseDivisor : 1;
    add_residuals(pose, KernelScale(options, k), divisor, &equations);
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

std::optional<Rigid2> RegisterBothWays(const RegistrationOptions& options,
                                       const Iterations& iterations,
                                       const SurfaceModel& reference,
                                       const SurfaceModel& query,
                                       const Rigid2& guess) {
  return GaussNewton(options, iterations, guess,
                     [&](const Rigid2& pose, const double scale,
                         const int divisor, NormalEquations* const equations) {
                       AddBothWays(options, reference, query, pose, scale,
                                   divisor, equations);
                     });
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

std::optional<Rigid2> RegisterCoarsely(const RegistrationOptions& options,
                                       const SurfaceModel& reference,
                                       const SurfaceModel& query,
                                       const Rigid2& guess_T_reference_query) {
  return RegisterBothWays(options, CoarseHalf(options), reference, query,
                          guess_T_reference_query);
}

std::optional<Rigid2> RegisterFinely(const RegistrationOptions& options,
                                     const SurfaceModel& reference,
                                     const SurfaceModel& query,
                                     const Rigid2& coarse_T_reference_query) {
  return RegisterBothWays(options, FineHalf(options), reference, query,
                          coarse_T_reference_query);
}

std::optional<Rigid2> RegisterSubmaps(const RegistrationOptions& options,
                                      const SurfaceModel& reference,
                                      const SurfaceModel& query,
                                      const Rigid2& guess_T_reference_query) {
  const std::optional<Rigid2> coarse =
      RegisterCoarsely(options, reference, query, guess_T_reference_query);
  if (!coarse) return std::nullopt;
  return RegisterFinely(options, reference, query, *coarse);
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
  const Eigen::Matrix2d scatter =
      equations.A.topLeftCorner<2, 2>().selfadjointView<Eigen::Lower>();
  return scatter / equations.sum_of_weights;
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
      options, {0, options.num_iterations}, guess_T_reference_points,
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
