// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/optimization.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/pose_graph/rotation_first.h"
#include "cartographer_sdf/pose_graph/spa_graph.h"
#include "cartographer_sdf/pose_graph/sparse_solver.h"
#include "ceres/ceres.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// One false closure can make up nearly all of the cost (1e7); what is left must
// still settle to a millimetre, which costs 1e-1.
constexpr double kFunctionTolerance = 1e-9;

class SpaCostFunction : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit SpaCostFunction(const SpaEdge& edge) : edge_(edge) {}

  bool Evaluate(double const* const* parameters, double* residual,
                double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const SpaError error = EvaluateSpaError(
        edge_, Eigen::Map<const Eigen::Vector3d>(parameters[0]),
        Eigen::Map<const Eigen::Vector3d>(parameters[1]));
    Eigen::Map<Eigen::Vector3d>(residual, 3) = error.residual;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[0], 3, 3) = error.jacobian_start;
    }
    if (jacobians != nullptr && jacobians[1] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[1], 3, 3) = error.jacobian_end;
    }
    return true;
  }

 private:
  const SpaEdge edge_;
};

SparseSolution Solve(const OptimizationOptions& options,
                     SpaGraph* const graph) {
  ceres::HuberLoss huber_loss(options.huber_scale);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  for (size_t i = 0; i != graph->poses.size(); ++i) {
    problem.AddParameterBlock(graph->poses[i].data(), 3);
    if (graph->constant[i]) {
      problem.SetParameterBlockConstant(graph->poses[i].data());
    }
  }
  for (const SpaEdge& edge : graph->edges) {
    problem.AddResidualBlock(
        new SpaCostFunction(edge), edge.robust ? &huber_loss : nullptr,
        graph->poses[edge.start].data(), graph->poses[edge.end].data());
  }
  return SolveSparse(options.max_num_iterations, kFunctionTolerance, &problem);
}

// Moves each landmark rigidly with the node that was nearest to it in the
// plane; of equally near ones the first.
void MoveLandmarks(const std::map<NodeId, Node>& old_nodes,
                   PoseGraph* const pose_graph) {
  for (auto& [id, T_map_landmark] : pose_graph->landmark_poses) {
    const std::pair<const NodeId, Node>* nearest = nullptr;
    double nearest_distance = std::numeric_limits<double>::infinity();
    for (const auto& id_and_node : old_nodes) {
      const double distance = (id_and_node.second.T_map_node.translation() -
                               T_map_landmark.translation.head<2>())
                                  .norm();
      if (distance < nearest_distance) {
        nearest = &id_and_node;
        nearest_distance = distance;
      }
    }
    if (nearest != nullptr) {
      const Rigid2 T_map_old_map =
          pose_graph->nodes.at(nearest->first).T_map_node *
          nearest->second.T_map_node.Inverse();
      T_map_landmark = Embed3D(T_map_old_map) * T_map_landmark;
    }
  }
}

void SetPoses(const SpaGraph& graph, PoseGraph* const pose_graph) {
  size_t i = 0;
  const auto set_pose = [&graph, &i](Rigid2* const pose) {
    if (!graph.constant[i]) {
      *pose = Rigid2(graph.poses[i].head<2>(), graph.poses[i].z());
    }
    ++i;
  };
  const std::map<NodeId, Node> old_nodes = pose_graph->nodes;
  for (auto& [id, T_map_submap] : pose_graph->submap_poses) {
    set_pose(&T_map_submap);
  }
  for (auto& [id, node] : pose_graph->nodes) {
    set_pose(&node.T_map_node);
  }
  MoveLandmarks(old_nodes, pose_graph);
}

}  // namespace

std::string Validate(const OptimizationOptions& options) {
  if (!(options.huber_scale > 0.) || !std::isfinite(options.huber_scale)) {
    return "huber_scale must be positive";
  }
  for (const auto& [name, weight] :
       {std::pair("local_slam_pose_translation_weight",
                  options.local_slam_pose_translation_weight),
        std::pair("local_slam_pose_rotation_weight",
                  options.local_slam_pose_rotation_weight),
        std::pair("odometry_translation_weight",
                  options.odometry_translation_weight),
        std::pair("odometry_rotation_weight",
                  options.odometry_rotation_weight)}) {
    if (!(weight >= 0.) || !std::isfinite(weight)) {
      return std::string(name) + " must be finite and not negative";
    }
  }
  if (options.max_num_iterations < 1) {
    return "max_num_iterations must be positive";
  }
  return "";
}

OptimizationSummary Optimize(const OptimizationOptions& options,
                             const std::set<int>& frozen_trajectories,
                             PoseGraph* const pose_graph) {
  CHECK_EQ(Validate(options), "");
  const auto start_time = std::chrono::steady_clock::now();
  SpaGraph graph = BuildSpaGraph(options, frozen_trajectories, *pose_graph);
  OptimizationSummary summary;
  summary.initial_cost = SpaCost(graph, options.huber_scale);
  summary.final_cost = summary.initial_cost;
  if (!std::isfinite(summary.initial_cost)) {
    summary.message = "the pose graph has values that are not finite";
    return summary;
  }
  if (std::optional<std::vector<Eigen::Vector3d>> poses =
          RotationFirstPoses(graph, options.huber_scale);
      poses.has_value()) {
    std::swap(graph.poses, *poses);
    if (!(SpaCost(graph, options.huber_scale) < summary.initial_cost)) {
      std::swap(graph.poses, *poses);
    }
  }
  const SparseSolution solution = Solve(options, &graph);
  if (solution.usable) {
    SetPoses(graph, pose_graph);
    summary.final_cost = SpaCost(graph, options.huber_scale);
  }
  summary.num_iterations = solution.num_iterations;
  summary.converged = solution.converged;
  summary.message = solution.message;
  summary.seconds = std::chrono::duration<double>(
                        std::chrono::steady_clock::now() - start_time)
                        .count();
  return summary;
}

ConstraintError ConstraintResidual(const PoseGraph& pose_graph,
                                   const Constraint& constraint) {
  const auto submap = pose_graph.submap_poses.find(constraint.submap);
  const auto node = pose_graph.nodes.find(constraint.node);
  CHECK(submap != pose_graph.submap_poses.end()) << constraint.submap;
  CHECK(node != pose_graph.nodes.end()) << constraint.node;
  const Rigid2 T_submap_node =
      submap->second.Inverse() * node->second.T_map_node;
  return ConstraintError{
      (T_submap_node.translation() - constraint.T_submap_node.translation())
          .norm(),
      std::abs(NormalizeAngle(T_submap_node.rotation() -
                              constraint.T_submap_node.rotation()))};
}

}  // namespace cartographer_sdf
