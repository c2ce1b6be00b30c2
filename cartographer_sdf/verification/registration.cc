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
};

constexpr size_t kChunkOfPoints = 64;
using Numbers = std::array<double, kChunkOfPoints>;
using CellDistances = std::array<int, kChunkOfPoints>;

// Numbers of those points of a chunk that fall into the field, side by side, so
// that compilers treat several at once: registration is the larger half of
// recognition.
struct FieldPoints {
  size_t size = 0;
  // Where they are: in the frame of the points, and in cells from the corner
  // of four cells [m, cells].
  Numbers x, y, u, v;
  Numbers weight;
  std::array<const SurfaceCell*, kChunkOfPoints> cells;
  // CellDistances of the four cells [mm].
  CellDistances d00, d10, d01, d11;
  // To the middle of a wall [m]: a wall's cells are its points, and the field
  // is zero on their edge, half a cell away.
  Numbers residual;
  Numbers gradient_x, gradient_y;  // of that, in the frame of the field
  Numbers field_x, field_y;        // the points in the frame of the field [m]
  // Of the residual by the pose.
  Numbers jacobian_x, jacobian_y, jacobian_yaw;
};

struct FieldPose {
  FieldPose(const CellGeometry& geometry, const Rigid2& T_field_points)
      : R_field_points(T_field_points.RotationMatrix()),
        t_field_points(T_field_points.translation()),
        R_field_grid(geometry.T_submap_grid.RotationMatrix()) {
    const Rigid2 T_grid_points =
        geometry.T_submap_grid.Inverse() * T_field_points;
    R_cells_points = T_grid_points.RotationMatrix() / geometry.resolution;
    t_cells_points = geometry.GridToCells(T_grid_points.translation());
  }

  Eigen::Matrix2d R_field_points;
  Eigen::Vector2d t_field_points;
  Eigen::Matrix2d R_field_grid;
  Eigen::Matrix2d R_cells_points;
  Eigen::Vector2d t_cells_points;
};

// Finds the cells of the points. They lie far apart in memory: all are on their
// way before the first is looked at.
void FindCells(const SurfaceCellArray& cells, const FieldPose& pose,
               const SurfacePoint* const points, const size_t count,
               FieldPoints* const found) {
  const double end_x = static_cast<double>(cells.rows() - 1);
  const double end_y = static_cast<double>(cells.cols() - 1);
  size_t size = 0;
  for (size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d& p = points[k].position;
    const double x = pose.R_cells_points(0, 0) * p.x() +
                     pose.R_cells_points(0, 1) * p.y() +
                     pose.t_cells_points.x();
    const double y = pose.R_cells_points(1, 0) * p.x() +
                     pose.R_cells_points(1, 1) * p.y() +
                     pose.t_cells_points.y();
    if (!(x >= 0. && y >= 0. && x < end_x && y < end_y)) continue;
    const Eigen::Index i = static_cast<Eigen::Index>(x);
    const Eigen::Index j = static_cast<Eigen::Index>(y);
    const SurfaceCell* const cell = &cells(i, j);
    __builtin_prefetch(cell);
    __builtin_prefetch(cell + cells.rows());
    found->cells[size] = cell;
    found->u[size] = x - static_cast<double>(i);
    found->v[size] = y - static_cast<double>(j);
    found->x[size] = p.x();
    found->y[size] = p.y();
    found->weight[size] = points[k].weight;
    ++size;
  }
  found->size = size;
  const Eigen::Index stride = cells.rows();
  for (size_t k = 0; k < size; ++k) {
    const SurfaceCell* const cell = found->cells[k];
    found->d00[k] = cell[0].distance;
    found->d10[k] = cell[1].distance;
    found->d01[k] = cell[stride].distance;
    found->d11[k] = cell[stride + 1].distance;
  }
}

// As InterpolateField, and the points themselves in the frame of the field.
void Interpolate(const FieldPose& pose, const double resolution,
                 FieldPoints* const points) {
  FieldPoints& p = *points;
  const double half_cell = 0.5 * resolution;
  for (size_t k = 0; k < p.size; ++k) {
    const double f00 = 1e-3 * p.d00[k], f10 = 1e-3 * p.d10[k];
    const double f01 = 1e-3 * p.d01[k], f11 = 1e-3 * p.d11[k];
    const double bottom = f00 + p.u[k] * (f10 - f00);
    const double top = f01 + p.u[k] * (f11 - f01);
    const double along_x =
        ((1. - p.v[k]) * (f10 - f00) + p.v[k] * (f11 - f01)) / resolution;
    const double along_y = (top - bottom) / resolution;
    p.residual[k] = bottom + p.v[k] * (top - bottom) + half_cell;
    p.gradient_x[k] =
        pose.R_field_grid(0, 0) * along_x + pose.R_field_grid(0, 1) * along_y;
    p.gradient_y[k] =
        pose.R_field_grid(1, 0) * along_x + pose.R_field_grid(1, 1) * along_y;
    p.field_x[k] = pose.R_field_points(0, 0) * p.x[k] +
                   pose.R_field_points(0, 1) * p.y[k] + pose.t_field_points.x();
    p.field_y[k] = pose.R_field_points(1, 0) * p.x[k] +
                   pose.R_field_points(1, 1) * p.y[k] + pose.t_field_points.y();
  }
}

// Weighs the residuals as Geman and McClure do, and adds them up in the order
// of the points.
void AddResiduals(const double scale, FieldPoints* const points,
                  NormalEquations* const equations) {
  FieldPoints& p = *points;
  const double squared_scale = scale * scale;
  for (size_t k = 0; k < p.size; ++k) {
    const double ratio = 1. + p.residual[k] * p.residual[k] / squared_scale;
    p.weight[k] *= 1. / (ratio * ratio);
  }
  NormalEquations sums = *equations;
  for (size_t k = 0; k < p.size; ++k) {
    const double x = p.jacobian_x[k], y = p.jacobian_y[k];
    const double yaw = p.jacobian_yaw[k];
    const double weighted_x = p.weight[k] * x, weighted_y = p.weight[k] * y;
    const double weighted_yaw = p.weight[k] * yaw;
    sums.A(0, 0) += weighted_x * x;
    sums.A(1, 0) += weighted_y * x;
    sums.A(2, 0) += weighted_yaw * x;
    sums.A(1, 1) += weighted_y * y;
    sums.A(2, 1) += weighted_yaw * y;
    sums.A(2, 2) += weighted_yaw * yaw;
    sums.b[0] -= p.residual[k] * weighted_x;
    sums.b[1] -= p.residual[k] * weighted_y;
    sums.b[2] -= p.residual[k] * weighted_yaw;
    sums.sum_of_weights += p.weight[k];
  }
  *equations = sums;
}

// Calls set_jacobian(points) for the first `count` points, some at a time, and
// adds their residuals.
template <typename SetJacobian>
void AddPoints(const SurfaceModel& field,
               const std::vector<SurfacePoint>& points, const size_t count,
               const Rigid2& T_field_points, const double scale,
               const SetJacobian& set_jacobian,
               NormalEquations* const equations) {
  const FieldPose pose(field.geometry, T_field_points);
  const PinnedCells cells = field.cells.Pin();
  FieldPoints found;
  for (size_t begin = 0; begin < count; begin += kChunkOfPoints) {
    FindCells(*cells, pose, points.data() + begin,
              std::min(kChunkOfPoints, count - begin), &found);
    Interpolate(pose, field.geometry.resolution, &found);
    set_jacobian(&found);
    AddResiduals(scale, &found, equations);
  }
}

// Points of the frame that moves, against a field that stands.
void AddForward(const SurfaceModel& field,
                const std::vector<SurfacePoint>& points, const size_t count,
                const Rigid2& T_field_points, const double scale,
                NormalEquations* const equations) {
  const Eigen::Vector2d& origin = T_field_points.translation();
  AddPoints(
      field, points, count, T_field_points, scale,
      [&origin](FieldPoints* const found) {
        FieldPoints& p = *found;
        for (size_t k = 0; k < p.size; ++k) {
          const double arm_x = p.field_x[k] - origin.x();
          const double arm_y = p.field_y[k] - origin.y();
          p.jacobian_x[k] = p.gradient_x[k];
          p.jacobian_y[k] = p.gradient_y[k];
          p.jacobian_yaw[k] =
              p.gradient_x[k] * -arm_y + p.gradient_y[k] * arm_x;
        }
      },
      equations);
}

// Points that stand, against a field of the frame that moves.
void AddBackward(const SurfaceModel& field,
                 const std::vector<SurfacePoint>& points, const size_t count,
                 const Rigid2& T_points_field, const double scale,
                 NormalEquations* const equations) {
  const Eigen::Matrix2d R = T_points_field.RotationMatrix();
  AddPoints(
      field, points, count, T_points_field.Inverse(), scale,
      [&R](FieldPoints* const found) {
        FieldPoints& p = *found;
        for (size_t k = 0; k < p.size; ++k) {
          const double x = p.gradient_x[k], y = p.gradient_y[k];
          p.jacobian_x[k] = -(R(0, 0) * x + R(0, 1) * y);
          p.jacobian_y[k] = -(R(1, 0) * x + R(1, 1) * y);
          p.jacobian_yaw[k] = -(x * -p.field_y[k] + y * p.field_x[k]);
        }
      },
      equations);
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
