// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/optimization.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "cartographer_sdf/pose_graph/rotation_first.h"
#include "cartographer_sdf/pose_graph/slips.h"
#include "cartographer_sdf/pose_graph/spa_graph.h"
#include "cartographer_sdf/pose_graph/sparse_solver.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A single false closure can make up nearly all of the cost (1e7); the rest
// must still converge to a millimetre, which costs 1e-1.
constexpr double kFunctionTolerance = 1e-9;
// At slips, errors lie on either side of the Huber loss's knee in turn, and the
// cost falls ever more slowly. On fr079, ACES and Killian Court, what is left
// at 1e-6 changes the mean node error by 2 mm at most.
constexpr double kFunctionToleranceWithSlips = 1e-6;

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

// Ends the iterations where a step has moved no pose by more than the run asks
// for. Steps that were refused move nothing and do not count.
class SettledPoses : public ceres::IterationCallback {
 public:
  // `poses` are those that the solver changes.
  SettledPoses(const OptimizationRun& run,
               const std::vector<Eigen::Vector3d>& poses)
      : run_(run), poses_(poses), before_(poses) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& iteration) override {
    if (iteration.iteration == 0 || !iteration.step_is_successful) {
      return ceres::SOLVER_CONTINUE;
    }
    has_settled_ = true;
    for (size_t i = 0; i != poses_.size() && has_settled_; ++i) {
      const Eigen::Vector3d step = poses_[i] - before_[i];
      has_settled_ = step.head<2>().norm() <= run_.max_step_meters &&
                     std::abs(step.z()) <= run_.max_step_angle;
    }
    before_ = poses_;
    return has_settled_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                        : ceres::SOLVER_CONTINUE;
  }
  [[nodiscard]] bool has_settled() const { return has_settled_; }

 private:
  const OptimizationRun& run_;
  const std::vector<Eigen::Vector3d>& poses_;
  std::vector<Eigen::Vector3d> before_;
  bool has_settled_ = false;
};

ceres::Solver::Options SolverOptions(const OptimizationOptions& options,
                                     const SpaGraph& graph) {
  return SparseSolverOptions(
      options.max_num_iterations,
      graph.num_slips > 0 ? kFunctionToleranceWithSlips : kFunctionTolerance);
}

// Moves each landmark rigidly with the node that was nearest to it in the
// plane; on ties, the first.
void MoveLandmarks(const std::map<NodeId, Node>& old_nodes,
                   PoseGraph* const pose_graph) {
  for (auto& [id, T_map_landmark] : pose_graph->landmark_poses) {
    const Eigen::Vector2d p_map = T_map_landmark.translation.head<2>();
    const auto distance = [&p_map](const auto& id_and_node) {
      return (id_and_node.second.T_map_node.translation() - p_map).norm();
    };
    const auto nearest = std::min_element(old_nodes.begin(), old_nodes.end(),
                                          [&](const auto& a, const auto& b) {
                                            return distance(a) < distance(b);
                                          });
    if (nearest == old_nodes.end()) continue;
    const Rigid2 T_map_old_map =
        pose_graph->nodes.at(nearest->first).T_map_node *
        nearest->second.T_map_node.Inverse();
    T_map_landmark = Embed3D(T_map_old_map) * T_map_landmark;
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

// Takes the poses of the initialisation where their cost is lower.
void InitializeRotationFirst(const OptimizationOptions& options,
                             const double initial_cost, SpaGraph* const graph) {
  std::optional<std::vector<Eigen::Vector3d>> poses =
      RotationFirstPoses(*graph, options.huber_scale);
  if (!poses.has_value()) return;
  std::swap(graph->poses, *poses);
  if (!(SpaCost(*graph, options.huber_scale) < initial_cost)) {
    std::swap(graph->poses, *poses);
  }
}

constexpr int kMinNumSteps = 20;
// Odometry whose mean difference from local SLAM is smaller is uninformative
// [m], [rad].
constexpr double kMinTranslationDifference = 1e-5;
constexpr double kMinRotationDifference = 1e-6;
// Weights whose lambda is closer to 0 or 1 act as if the smaller were zero.
constexpr double kMinLambda = 1e-6;

// Least squares of y = lambda * x.
struct Regression {
  double xy = 0.;
  double xx = 0.;

  void Add(const double x, const double y) {
    xy += x * y;
    xx += x * x;
  }
  // Returns the weight that explains the slope, given a weight of `other`.
  [[nodiscard]] double Weight(const double other) const {
    const double lambda = std::min(xy / xx, 1. - kMinLambda);
    if (lambda < kMinLambda) return 0.;
    return other * std::sqrt(lambda / (1. - lambda));
  }
};

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
  if (!(options.min_slip_angle > 0.) ||
      !std::isfinite(options.min_slip_angle)) {
    return "min_slip_angle must be positive";
  }
  if (options.max_num_iterations < 1) {
    return "max_num_iterations must be positive";
  }
  return "";
}

OptimizationSummary Optimize(const OptimizationOptions& options,
                             const std::set<int>& frozen_trajectories,
                             PoseGraph* const pose_graph,
                             const OptimizationRun& run) {
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
  if (run.initialize_rotation_first) {
    InitializeRotationFirst(options, summary.initial_cost, &graph);
  }
  SettledPoses settled(run, graph.poses);
  ceres::Solver::Options solver_options = SolverOptions(options, graph);
  solver_options.update_state_every_iteration = true;
  solver_options.callbacks.push_back(&settled);
  const ceres::Solver::Summary solution = SolveSparse(
      solver_options, graph, options.huber_scale,
      [](const SpaEdge& edge) { return new SpaCostFunction(edge); },
      &graph.poses);
  if (solution.IsSolutionUsable()) {
    SetPoses(graph, pose_graph);
    summary.final_cost = SpaCost(graph, options.huber_scale);
  }
  summary.num_iterations =
      solution.num_successful_steps + solution.num_unsuccessful_steps;
  summary.converged =
      settled.has_settled() || solution.termination_type == ceres::CONVERGENCE;
  summary.message =
      settled.has_settled() ? "the poses have settled" : solution.message;
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

std::optional<OdometryWeights> InferOdometryWeights(
    const OptimizationOptions& options, const PoseGraph& pose_graph) {
  if (!(options.local_slam_pose_translation_weight > 0. &&
        options.local_slam_pose_rotation_weight > 0.)) {
    return std::nullopt;
  }
  Regression translation, rotation;
  int num_steps = 0;
  for (auto it = pose_graph.nodes.begin(); it != pose_graph.nodes.end(); ++it) {
    const std::optional<Step> step = StepTo(pose_graph, it);
    if (!step || IsSlip(options.min_slip_angle, *step)) continue;
    const Rigid2 optimized =
        std::prev(it)->second.T_map_node.Inverse() * it->second.T_map_node;
    const Rigid2& local = step->T_previous_node_by_local_slam;
    const Rigid2& odometry = step->T_previous_node_by_odometry;
    const Eigen::Vector2d x = odometry.translation() - local.translation();
    const Eigen::Vector2d y = optimized.translation() - local.translation();
    translation.Add(x.x(), y.x());
    translation.Add(x.y(), y.y());
    rotation.Add(NormalizeAngle(odometry.rotation() - local.rotation()),
                 NormalizeAngle(optimized.rotation() - local.rotation()));
    ++num_steps;
  }
  if (num_steps < kMinNumSteps ||
      translation.xx < num_steps * std::pow(kMinTranslationDifference, 2) ||
      rotation.xx < num_steps * std::pow(kMinRotationDifference, 2)) {
    return std::nullopt;
  }
  return OdometryWeights{
      translation.Weight(options.local_slam_pose_translation_weight),
      rotation.Weight(options.local_slam_pose_rotation_weight)};
}

}  // namespace cartographer_sdf
