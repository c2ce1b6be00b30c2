// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/optimization.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cartographer_sdf/pose_graph/spa_graph.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::optimization_test {
namespace {

using ::cartographer_sdf::testing::InterSubmapConstraint;
using ::cartographer_sdf::testing::MakeRoundTrip;
using ::cartographer_sdf::testing::RoundTrip;
using ::cartographer_sdf::testing::RoundTripOptions;
using ::cartographer_sdf::testing::SplitTrajectory;
using ::testing::StartsWith;

Node NodeAt(const Rigid2& T_map_node) {
  Node node;
  node.T_map_node = T_map_node;
  node.T_local_node = T_map_node;
  return node;
}

Constraint IntraSubmapConstraint(const SubmapId& submap, const NodeId& node,
                                 const Rigid2& T_submap_node) {
  return {submap, node,  T_submap_node,
          5e2,    1.6e3, Constraint::Tag::kIntraSubmap};
}

double Distance(const Rigid2& a, const Rigid2& b) {
  return std::max((a.translation() - b.translation()).norm(),
                  std::abs(NormalizeAngle(a.rotation() - b.rotation())));
}

double MaxDistance(const PoseGraph& a, const PoseGraph& b) {
  double distance = 0.;
  for (const auto& [id, T_map_submap] : a.submap_poses) {
    distance =
        std::max(distance, Distance(T_map_submap, b.submap_poses.at(id)));
  }
  for (const auto& [id, node] : a.nodes) {
    distance = std::max(distance,
                        Distance(node.T_map_node, b.nodes.at(id).T_map_node));
  }
  return distance;
}

RoundTripOptions SmallRoundTrip() {
  RoundTripOptions options;
  options.num_nodes = 40;
  options.nodes_between_submaps = 5;
  options.width = 6.;
  options.height = 4.;
  options.nodes_between_closures = 3;
  options.translation_noise = 0.02;
  options.yaw_noise = 0.01;
  return options;
}

TEST(OptimizeTest, WeighsTwoMeasurementsOfOneNode) {
  // On a line, with nothing to turn: local SLAM says that node 1 is 2 m ahead
  // of node 0, which lies on submap 0, a constraint says 1 m from the submap.
  PoseGraph graph;
  graph.submap_poses[{0, 0}] = Rigid2();
  graph.nodes[{0, 0}] = NodeAt(Rigid2());
  graph.nodes[{0, 1}] = NodeAt(Rigid2(2., 0., 0.));
  graph.constraints = {IntraSubmapConstraint({0, 0}, {0, 0}, Rigid2()),
                       IntraSubmapConstraint({0, 0}, {0, 1}, {1., 0., 0.})};
  OptimizationOptions options;
  options.local_slam_pose_translation_weight = 1e3;
  const OptimizationSummary summary = Optimize(options, {}, &graph);
  EXPECT_TRUE(summary.converged) << summary.message;
  // Three springs in a row with stiffnesses a = 500^2, b = 1000^2, a share 1 m
  // in proportion to 1 / stiffness.
  const double a = 500. * 500.;
  const double b = 1000. * 1000.;
  const double force = 1. / (1. / a + 1. / b + 1. / a);
  EXPECT_NEAR(graph.nodes.at({0, 0}).T_map_node.translation().x(), -force / a,
              1e-6);
  EXPECT_NEAR(graph.nodes.at({0, 1}).T_map_node.translation().x(),
              1. + force / a, 1e-6);
  EXPECT_NEAR(summary.initial_cost, 0.5 * a, 1e-6);
  EXPECT_NEAR(summary.final_cost, 0.5 * force, 1e-6);
}

TEST(OptimizeTest, OdometryPullsByItsOwnWeights) {
  PoseGraph graph;
  graph.submap_poses[{0, 0}] = Rigid2();
  graph.nodes[{0, 0}] = NodeAt(Rigid2());
  graph.nodes[{0, 1}] = NodeAt(Rigid2(2., 0., 0.));
  graph.nodes[{0, 1}].T_previous_node_by_odometry = Rigid2(3., 0., 0.1);
  graph.constraints = {IntraSubmapConstraint({0, 0}, {0, 0}, Rigid2())};
  OptimizationOptions options;
  options.local_slam_pose_translation_weight = 1e3;
  options.local_slam_pose_rotation_weight = 2e3;
  options.odometry_translation_weight = 2e3;
  options.odometry_rotation_weight = 1e3;
  const OptimizationSummary summary = Optimize(options, {}, &graph);
  EXPECT_TRUE(summary.converged) << summary.message;
  EXPECT_LT(Distance(graph.nodes[{0, 0}].T_map_node, Rigid2()), 1e-9);
  EXPECT_LT(Distance(graph.nodes[{0, 1}].T_map_node,
                     Rigid2(2. * 0.2 + 3. * 0.8, 0., 0.1 * 0.2)),
            1e-6);
}

// The oracle: the same problem by dense Gauss-Newton, its Huber loss as
// iterated weights and its Jacobians by differences of residuals.
Eigen::Vector3d OracleResidual(const Rigid2& T_measured, const double w_t,
                               const double w_r, const Eigen::Vector3d& start,
                               const Eigen::Vector3d& end) {
  const Rigid2 T_start_end = Rigid2(start.x(), start.y(), start.z()).Inverse() *
                             Rigid2(end.x(), end.y(), end.z());
  const Eigen::Vector2d t =
      T_start_end.translation() - T_measured.translation();
  return {w_t * t.x(), w_t * t.y(),
          w_r * std::remainder(T_start_end.rotation() - T_measured.rotation(),
                               2. * M_PI)};
}

struct OracleEdge {
  int start;
  int end;
  Rigid2 T_start_end;
  double w_t;
  double w_r;
  bool robust;
};

std::vector<OracleEdge> OracleEdges(const PoseGraph& graph) {
  const int num_submaps = static_cast<int>(graph.submap_poses.size());
  std::vector<OracleEdge> edges;
  for (const Constraint& c : graph.constraints) {
    edges.push_back({c.submap.index, num_submaps + c.node.index,
                     c.T_submap_node, c.translation_weight, c.rotation_weight,
                     c.tag == Constraint::Tag::kInterSubmap});
  }
  for (int i = 1; i != static_cast<int>(graph.nodes.size()); ++i) {
    edges.push_back({num_submaps + i - 1, num_submaps + i,
                     graph.nodes.at({0, i - 1}).T_local_node->Inverse() *
                         *graph.nodes.at({0, i}).T_local_node,
                     1e5, 1e5, false});
  }
  return edges;
}

void OracleStep(const std::vector<OracleEdge>& edges, const double huber_scale,
                std::vector<Eigen::Vector3d>* const poses) {
  constexpr double kStep = 1e-6;
  const int size = 3 * static_cast<int>(poses->size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
  for (const OracleEdge& edge : edges) {
    const auto residual = [&edge](const Eigen::Matrix<double, 6, 1>& both) {
      return OracleResidual(edge.T_start_end, edge.w_t, edge.w_r,
                            both.head<3>(), both.tail<3>());
    };
    Eigen::Matrix<double, 6, 1> both;
    both << (*poses)[edge.start], (*poses)[edge.end];
    const Eigen::Vector3d r = residual(both);
    Eigen::Matrix<double, 3, 6> jacobian;
    for (int i = 0; i != 6; ++i) {
      const Eigen::Matrix<double, 6, 1> step =
          kStep * Eigen::Matrix<double, 6, 1>::Unit(i);
      jacobian.col(i) =
          (residual(both + step) - residual(both - step)) / (2. * kStep);
    }
    const double weight =
        edge.robust && r.norm() > huber_scale ? huber_scale / r.norm() : 1.;
    const int offsets[] = {3 * edge.start, 3 * edge.end};
    for (const Eigen::Index a : {0, 1}) {
      gradient.segment<3>(offsets[a]) +=
          weight * jacobian.middleCols<3>(3 * a).transpose() * r;
      for (const Eigen::Index b : {0, 1}) {
        hessian.block<3, 3>(offsets[a], offsets[b]) +=
            weight * jacobian.middleCols<3>(3 * a).transpose() *
            jacobian.middleCols<3>(3 * b);
      }
    }
  }
  const Eigen::VectorXd step = hessian.bottomRightCorner(size - 3, size - 3)
                                   .ldlt()
                                   .solve(gradient.tail(size - 3));
  for (size_t i = 1; i != poses->size(); ++i) {
    (*poses)[i] -= step.segment<3>(3 * static_cast<int>(i) - 3);
  }
}

PoseGraph SolveByOracle(PoseGraph graph, const double huber_scale) {
  std::vector<Eigen::Vector3d> poses;
  const auto add_pose = [&poses](const Rigid2& pose) {
    poses.emplace_back(pose.translation().x(), pose.translation().y(),
                       pose.rotation());
  };
  for (const auto& [id, T_map_submap] : graph.submap_poses) {
    add_pose(T_map_submap);
  }
  for (const auto& [id, node] : graph.nodes) {
    add_pose(node.T_map_node);
  }
  constexpr int kNumIterations = 300;
  for (int k = 0; k != kNumIterations; ++k) {
    OracleStep(OracleEdges(graph), huber_scale, &poses);
  }
  size_t i = 0;
  for (auto& [id, T_map_submap] : graph.submap_poses) {
    T_map_submap = Rigid2(poses[i].x(), poses[i].y(), poses[i].z());
    ++i;
  }
  for (auto& [id, node] : graph.nodes) {
    node.T_map_node = Rigid2(poses[i].x(), poses[i].y(), poses[i].z());
    ++i;
  }
  return graph;
}

TEST(OptimizeTest, AgreesWithADenseSolver) {
  for (const int num_false_closures : {0, 2}) {
    RoundTripOptions round_trip = SmallRoundTrip();
    round_trip.num_false_closures = num_false_closures;
    const RoundTrip trip = MakeRoundTrip(round_trip);
    const OptimizationOptions options;
    const PoseGraph oracle = SolveByOracle(trip.truth, options.huber_scale);
    PoseGraph graph = trip.open_loop;
    const OptimizationSummary summary = Optimize(options, {}, &graph);
    EXPECT_TRUE(summary.converged) << summary.message;
    // 1e-9 of the cost, in directions of some 1e4 stiffness.
    EXPECT_LT(MaxDistance(graph, oracle), 2e-4);
    EXPECT_GT(MaxDistance(trip.open_loop, oracle), 0.1);
    const double oracle_cost =
        SpaCost(BuildSpaGraph(options, {}, oracle), options.huber_scale);
    EXPECT_NEAR(summary.final_cost / oracle_cost, 1., 1e-6);
  }
}

TEST(OptimizeTest, HoldsTheFirstSubmap) {
  const RoundTrip trip = MakeRoundTrip(SmallRoundTrip());
  PoseGraph graph = trip.open_loop;
  Optimize({}, {}, &graph);
  EXPECT_EQ(Distance(graph.submap_poses.begin()->second,
                     trip.open_loop.submap_poses.begin()->second),
            0.);
  EXPECT_GT(Distance(graph.nodes.begin()->second.T_map_node,
                     trip.open_loop.nodes.begin()->second.T_map_node),
            0.);
}

TEST(OptimizeTest, FollowsARigidMotionOfTheWholeMap) {
  PoseGraph graph = MakeRoundTrip(SmallRoundTrip()).open_loop;
  const Rigid2 T(12., -7., 2.5);
  PoseGraph moved = graph;
  for (auto& [id, T_map_submap] : moved.submap_poses) {
    T_map_submap = T * T_map_submap;
  }
  for (auto& [id, node] : moved.nodes) {
    node.T_map_node = T * node.T_map_node;
  }
  const OptimizationSummary summary = Optimize({}, {}, &graph);
  const OptimizationSummary moved_summary = Optimize({}, {}, &moved);
  EXPECT_NEAR(moved_summary.final_cost / summary.final_cost, 1., 1e-6);
  for (auto& [id, T_map_submap] : moved.submap_poses) {
    T_map_submap = T.Inverse() * T_map_submap;
  }
  for (auto& [id, node] : moved.nodes) {
    node.T_map_node = T.Inverse() * node.T_map_node;
  }
  EXPECT_LT(MaxDistance(graph, moved), 1e-9);
}

TEST(OptimizeTest, FrozenTrajectoriesStayAndTheOtherComesToThem) {
  // The frozen one has the higher id.
  for (const int frozen : {0, 1}) {
    const RoundTrip trip = MakeRoundTrip(SmallRoundTrip());
    const Rigid2 T(30., 20., 2.);
    const PoseGraph split = SplitTrajectory(trip.truth, 4, 20, T);
    PoseGraph graph = split;
    const OptimizationSummary summary = Optimize({}, {frozen}, &graph);
    EXPECT_TRUE(summary.converged) << summary.message;
    const Rigid2 T_map_truth = frozen == 0 ? Rigid2() : T;
    for (const auto& [id, T_map_submap] : graph.submap_poses) {
      if (id.trajectory == frozen) {
        EXPECT_EQ(Distance(T_map_submap, split.submap_poses.at(id)), 0.);
      } else {
        const SubmapId true_id{0, id.trajectory == 0 ? id.index : id.index + 4};
        EXPECT_LT(Distance(T_map_submap,
                           T_map_truth * trip.truth.submap_poses.at(true_id)),
                  0.1);
      }
    }
    for (const auto& [id, node] : graph.nodes) {
      if (id.trajectory == frozen) {
        EXPECT_EQ(Distance(node.T_map_node, split.nodes.at(id).T_map_node), 0.);
      }
    }
  }
}

TEST(OptimizeTest, AFloatingTrajectoryStays) {
  RoundTripOptions round_trip = SmallRoundTrip();
  round_trip.nodes_between_closures = 0;
  const PoseGraph split = SplitTrajectory(MakeRoundTrip(round_trip).open_loop,
                                          4, 20, Rigid2(5., 6., 1.));
  PoseGraph graph = split;
  const OptimizationSummary summary = Optimize({}, {}, &graph);
  EXPECT_TRUE(summary.converged) << summary.message;
  // Dead reckoning fulfils everything there is.
  EXPECT_LT(MaxDistance(graph, split), 1e-9);
}

TEST(OptimizeTest, HuberLossBoundsThePullOfAFalseClosure) {
  RoundTripOptions round_trip = SmallRoundTrip();
  const RoundTrip trip = MakeRoundTrip(round_trip);
  PoseGraph good = trip.open_loop;
  Optimize({}, {}, &good);
  const auto disturbed_by = [&trip](const double error) {
    PoseGraph graph = trip.open_loop;
    graph.constraints.push_back(InterSubmapConstraint(
        {0, 0}, {0, 30},
        trip.truth.submap_poses.at({0, 0}).Inverse() *
            trip.truth.nodes.at({0, 30}).T_map_node * Rigid2(error, 0., 0.)));
    Optimize({}, {}, &graph);
    return graph;
  };
  const double near = MaxDistance(disturbed_by(5.), good);
  const double far = MaxDistance(disturbed_by(50.), good);
  EXPECT_GT(near, 0.03);
  EXPECT_LT(far, 0.1);
  EXPECT_LT(far, 2. * near);
}

TEST(OptimizeTest, LinearLossIsWhatTheScaleSays) {
  // One weak link of stiffness 1e4 against one robust constraint, 1 m apart:
  // its force is huber_scale * weight, so the link yields by 1e-4 * force.
  for (const double huber_scale : {1e-2, 2e-2}) {
    PoseGraph graph;
    graph.submap_poses[{0, 0}] = Rigid2();
    graph.nodes[{0, 0}] = NodeAt(Rigid2());
    graph.constraints = {IntraSubmapConstraint({0, 0}, {0, 0}, Rigid2()),
                         InterSubmapConstraint({0, 0}, {0, 0}, {1., 0., 0.})};
    graph.constraints[0].translation_weight = 1e2;
    OptimizationOptions options;
    options.huber_scale = huber_scale;
    Optimize(options, {}, &graph);
    EXPECT_NEAR(graph.nodes.at({0, 0}).T_map_node.translation().x(),
                1e-4 * huber_scale * 1.1e4, 4e-6);
  }
}

TEST(OptimizeTest, ConvergesFromFarAway) {
  RoundTripOptions round_trip;
  round_trip.num_nodes = 2000;
  round_trip.translation_noise = 0.01;
  round_trip.yaw_noise = 1e-3;
  round_trip.yaw_bias = 4e-4;  // 46 degrees in all.
  round_trip.nodes_between_closures = 50;
  round_trip.num_false_closures = 5;
  const RoundTrip trip = MakeRoundTrip(round_trip);
  EXPECT_GT(MaxDistance(trip.open_loop, trip.truth), 100.);
  PoseGraph from_truth = trip.truth;
  const OptimizationSummary best = Optimize({}, {}, &from_truth);
  PoseGraph graph = trip.open_loop;
  const OptimizationSummary summary = Optimize({}, {}, &graph);
  EXPECT_NEAR(summary.final_cost / best.final_cost, 1., 1e-6);
  EXPECT_LT(MaxDistance(graph, from_truth), 1e-3);
}

TEST(OptimizeTest, TurnsAWholeTrajectoryAround) {
  RoundTripOptions round_trip;
  round_trip.num_nodes = 1000;
  round_trip.nodes_between_submaps = 50;
  round_trip.translation_noise = 0.01;
  round_trip.yaw_noise = 1e-3;
  round_trip.nodes_between_closures = 5;
  const RoundTrip trip = MakeRoundTrip(round_trip);
  PoseGraph from_truth = SplitTrajectory(trip.truth, 10, 500, Rigid2());
  const OptimizationSummary best = Optimize({}, {}, &from_truth);
  for (const double degrees : {90., 175., 180., -120.}) {
    PoseGraph graph = SplitTrajectory(trip.open_loop, 10, 500,
                                      Rigid2(50., 40., degrees * M_PI / 180.));
    const OptimizationSummary summary = Optimize({}, {}, &graph);
    EXPECT_TRUE(summary.converged) << summary.message;
    EXPECT_NEAR(summary.final_cost / best.final_cost, 1., 1e-8) << degrees;
    EXPECT_LT(MaxDistance(graph, from_truth), 1e-4) << degrees;
  }
}

TEST(OptimizeTest, GivesTheSameBytesTwice) {
  const PoseGraph open_loop = MakeRoundTrip(SmallRoundTrip()).open_loop;
  PoseGraph first = open_loop;
  PoseGraph second = open_loop;
  const OptimizationSummary first_summary = Optimize({}, {}, &first);
  const OptimizationSummary second_summary = Optimize({}, {}, &second);
  EXPECT_EQ(MaxDistance(first, second), 0.);
  EXPECT_EQ(first_summary.final_cost, second_summary.final_cost);
  EXPECT_EQ(first_summary.num_iterations, second_summary.num_iterations);
}

TEST(OptimizeTest, StopsWhereTheIterationsRunOut) {
  PoseGraph graph = MakeRoundTrip(SmallRoundTrip()).open_loop;
  OptimizationOptions options;
  options.max_num_iterations = 2;
  const OptimizationSummary summary = Optimize(options, {}, &graph);
  EXPECT_FALSE(summary.converged);
  EXPECT_LE(summary.num_iterations, 3);
  EXPECT_LT(summary.final_cost, summary.initial_cost);
}

TEST(OptimizeTest, LandmarksMoveWithTheNearestNode) {
  PoseGraph graph;
  graph.submap_poses[{0, 0}] = Rigid2();
  graph.nodes[{0, 0}] = NodeAt(Rigid2());
  graph.nodes[{0, 5}] = NodeAt(Rigid2(10., 0., 0.));
  graph.constraints = {
      IntraSubmapConstraint({0, 0}, {0, 0}, Rigid2()),
      IntraSubmapConstraint({0, 0}, {0, 5}, {10., 3., M_PI_2})};
  graph.landmark_poses["near_first"] = Embed3D(Rigid2(4., 1., 0.));
  graph.landmark_poses["near_second"] =
      Rigid3{{11., 0., 2.}, Eigen::Quaterniond::Identity()};
  const OptimizationSummary summary = Optimize({}, {}, &graph);
  EXPECT_TRUE(summary.converged) << summary.message;
  const Rigid3& unmoved = graph.landmark_poses["near_first"];
  EXPECT_LT((unmoved.translation - Eigen::Vector3d(4., 1., 0.)).norm(), 1e-9);
  const Rigid3& moved = graph.landmark_poses["near_second"];
  EXPECT_LT((moved.translation - Eigen::Vector3d(10., 4., 2.)).norm(), 1e-6);
  EXPECT_NEAR(Project2D(moved).rotation(), M_PI_2, 1e-6);
}

TEST(OptimizeTest, HandlesGraphsWithLittleInThem) {
  PoseGraph graph;
  EXPECT_EQ(Optimize({}, {}, &graph).final_cost, 0.);
  graph.landmark_poses["alone"] = Rigid3();
  EXPECT_TRUE(Optimize({}, {}, &graph).converged);
  graph.nodes[{0, 3}] = NodeAt(Rigid2(1., 2., 3.));
  EXPECT_TRUE(Optimize({}, {}, &graph).converged);
  // No constraints; a trimmed node between; a submap without nodes.
  graph.nodes[{0, 5}] = NodeAt(Rigid2(2., 3., 3.));
  graph.nodes[{0, 6}] = NodeAt(Rigid2(5., 3., 3.));
  graph.submap_poses[{2, 9}] = Rigid2(7., 8., 1.);
  const PoseGraph before = graph;
  EXPECT_TRUE(Optimize({}, {}, &graph).converged);
  EXPECT_LT(MaxDistance(graph, before), 1e-12);
  EXPECT_TRUE(Optimize({}, {0, 2, 77}, &graph).converged);
  EXPECT_EQ(graph.landmark_poses.size(), 1u);
}

TEST(OptimizeTest, WeightsOfZeroLeaveAPoseFree) {
  PoseGraph graph;
  graph.submap_poses[{0, 0}] = Rigid2();
  graph.nodes[{0, 0}] = NodeAt(Rigid2(3., 4., 0.5));
  graph.constraints = {IntraSubmapConstraint({0, 0}, {0, 0}, Rigid2())};
  graph.constraints[0].rotation_weight = 0.;
  const OptimizationSummary summary = Optimize({}, {}, &graph);
  EXPECT_TRUE(summary.converged) << summary.message;
  EXPECT_LT(Distance(graph.nodes[{0, 0}].T_map_node, Rigid2(0., 0., 0.5)),
            1e-6);
}

TEST(OptimizeTest, RefusesValuesThatAreNotFinite) {
  PoseGraph graph = MakeRoundTrip(SmallRoundTrip()).open_loop;
  graph.constraints[4].translation_weight =
      std::numeric_limits<double>::quiet_NaN();
  const PoseGraph before = graph;
  const OptimizationSummary summary = Optimize({}, {}, &graph);
  EXPECT_FALSE(summary.converged);
  EXPECT_EQ(summary.message, "the pose graph has values that are not finite");
  EXPECT_EQ(MaxDistance(graph, before), 0.);
}

TEST(ConstraintResidualTest, IsTheErrorOfThePose) {
  PoseGraph graph;
  graph.submap_poses[{0, 0}] = Rigid2(1., 1., M_PI_2);
  graph.nodes[{0, 0}] = NodeAt(Rigid2(1., 5., -3.));
  // From the submap, the node is seen at (4, 0), turned by -3 - pi / 2.
  const ConstraintError error = ConstraintResidual(
      graph, InterSubmapConstraint({0, 0}, {0, 0}, {1., 4., -1.5 - M_PI_2}));
  EXPECT_NEAR(error.translation, 5., 1e-12);
  EXPECT_NEAR(error.rotation, 1.5, 1e-12);
}

TEST(OptimizationOptionsTest, ValidateNamesTheOffendingField) {
  EXPECT_EQ(Validate(OptimizationOptions{}), "");
  OptimizationOptions options;
  options.huber_scale = 0.;
  EXPECT_THAT(Validate(options), StartsWith("huber_scale must"));
  options = {};
  options.odometry_rotation_weight = -1.;
  EXPECT_THAT(Validate(options), StartsWith("odometry_rotation_weight must"));
  options = {};
  options.local_slam_pose_translation_weight =
      std::numeric_limits<double>::infinity();
  EXPECT_THAT(Validate(options),
              StartsWith("local_slam_pose_translation_weight must"));
  options = {};
  options.max_num_iterations = 0;
  EXPECT_THAT(Validate(options), StartsWith("max_num_iterations must"));
}

}  // namespace
}  // namespace cartographer_sdf::optimization_test
