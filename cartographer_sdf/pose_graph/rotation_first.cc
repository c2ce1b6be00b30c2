// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/rotation_first.h"

#include <cmath>
#include <cstddef>

#include "cartographer_sdf/pose_graph/sparse_solver.h"

namespace cartographer_sdf {
namespace {

// Coarse: the result is only an initial guess.
constexpr double kRotationTolerance = 1e-2;
constexpr int kMaxNumIterations = 50;

// A residual of two unknown 2-vectors: from_end * end - from_start * start -
// measured.
class LinearCost : public ceres::SizedCostFunction<2, 2, 2> {
 public:
  LinearCost(const Eigen::Matrix2d& from_start, const Eigen::Matrix2d& from_end,
             const Eigen::Vector2d& measured)
      : from_start_(from_start), from_end_(from_end), measured_(measured) {}

  bool Evaluate(double const* const* parameters, double* residual,
                double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
    const Eigen::Map<const Eigen::Vector2d> start(parameters[0]);
    const Eigen::Map<const Eigen::Vector2d> end(parameters[1]);
    Eigen::Map<Eigen::Vector2d>(residual, 2) =
        from_end_ * end - from_start_ * start - measured_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[0], 2, 2) = -from_start_;
    }
    if (jacobians != nullptr && jacobians[1] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[1], 2, 2) = from_end_;
    }
    return true;
  }

 private:
  const Eigen::Matrix2d from_start_;
  const Eigen::Matrix2d from_end_;
  const Eigen::Vector2d measured_;
};

}  // namespace

std::optional<std::vector<Eigen::Vector3d>> RotationFirstPoses(
    const SpaGraph& graph, const double huber_scale) {
  std::vector<Eigen::Vector3d> poses = graph.poses;
  std::vector<Eigen::Vector2d> directions, translations;
  for (const Eigen::Vector3d& pose : poses) {
    directions.emplace_back(std::cos(pose.z()), std::sin(pose.z()));
    translations.push_back(pose.head<2>());
  }
  const auto solve = [&](const auto& make_cost,
                         std::vector<Eigen::Vector2d>* const vectors) {
    return SolveSparse(
               SparseSolverOptions(kMaxNumIterations, kRotationTolerance),
               graph, huber_scale, make_cost, vectors)
        .IsSolutionUsable();
  };
  const auto direction_cost = [](const SpaEdge& edge) {
    const double w_r = edge.rotation_weight;
    return new LinearCost(w_r * edge.T_start_end.RotationMatrix(),
                          w_r * Eigen::Matrix2d::Identity(),
                          Eigen::Vector2d::Zero());
  };
  if (!solve(direction_cost, &directions)) return std::nullopt;
  for (size_t i = 0; i != poses.size(); ++i) {
    if (!graph.constant[i]) {
      poses[i].z() = std::atan2(directions[i].y(), directions[i].x());
    }
  }
  const auto translation_cost = [&poses](const SpaEdge& edge) {
    const double w_t = edge.translation_weight;
    const Eigen::Matrix2d R_start_map =
        Eigen::Rotation2Dd(-poses[edge.start].z()).toRotationMatrix();
    return new LinearCost(w_t * R_start_map, w_t * R_start_map,
                          w_t * edge.T_start_end.translation());
  };
  if (!solve(translation_cost, &translations)) return std::nullopt;
  for (size_t i = 0; i != poses.size(); ++i) {
    poses[i].head<2>() = translations[i];
  }
  return poses;
}

}  // namespace cartographer_sdf
