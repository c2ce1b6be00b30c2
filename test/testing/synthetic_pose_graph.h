// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Pose graphs of a robot that drives rounds through a rectangle of corridors,
// with known truth, laid out as Cartographer does: each node is constrained to
// the two submaps that it was inserted into.

#ifndef TEST_TESTING_SYNTHETIC_POSE_GRAPH_H_
#define TEST_TESTING_SYNTHETIC_POSE_GRAPH_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf::testing {

class NormalNumbers {
 public:
  explicit NormalNumbers(const uint32_t seed) : engine_(seed) {}
  // Box-Muller.
  double operator()(const double sigma) {
    const double u = 1. - Uniform();
    const double v = Uniform();
    return sigma * std::sqrt(-2. * std::log(u)) * std::cos(2. * M_PI * v);
  }
  // In [0, count).
  int Index(const int count) { return static_cast<int>(Uniform() * count); }

 private:
  // In [0, 1).
  double Uniform() { return static_cast<double>(engine_()) / 4294967296.; }

  std::mt19937 engine_;
};

// The defaults are a drive of 2 km with 10000 nodes and 139 submaps.
struct RoundTripOptions {
  int num_nodes = 10000;
  // Half of the nodes of a submap: the host's num_range_data.
  int nodes_between_submaps = 72;
  // Of the corridors' rectangle [m].
  double width = 300.;
  double height = 200.;
  int num_rounds = 2;
  // Per node: systematic error of the yaw [rad], and standard deviations.
  double yaw_bias = 0.;
  double translation_noise = 0.;
  double yaw_noise = 0.;
  // From the second round on, every so many nodes one inter-submap constraint
  // to the submap of the first round at the same place; none if 0.
  int nodes_between_closures = 0;
  double closure_translation_noise = 0.03;
  double closure_yaw_noise = 0.003;
  // Inter-submap constraints that are wrong.
  int num_false_closures = 0;
};

struct RoundTrip {
  PoseGraph truth;
  // As `truth`, but with poses by dead reckoning.
  PoseGraph open_loop;
};

inline Rigid2 PoseOnRectangle(const RoundTripOptions& options,
                              const double distance) {
  const double w = options.width;
  const double h = options.height;
  const double along = std::fmod(distance, 2. * (w + h));
  if (along < w) return Rigid2(along, 0., 0.);
  if (along < w + h) return Rigid2(w, along - w, M_PI_2);
  if (along < 2. * w + h) return Rigid2(2. * w + h - along, h, M_PI);
  return Rigid2(0., 2. * (w + h) - along, -M_PI_2);
}

// Nodes with their true poses and those of local SLAM.
inline void AddNodes(const RoundTripOptions& options,
                     NormalNumbers* const normal, PoseGraph* const graph) {
  const double step = options.num_rounds * 2. *
                      (options.width + options.height) / options.num_nodes;
  for (int i = 0; i != options.num_nodes; ++i) {
    Node node;
    node.time = int64_t{1000000} * i;
    node.T_map_node = PoseOnRectangle(options, step * i);
    node.T_local_node = node.T_map_node;
    if (i > 0) {
      const Node& previous = graph->nodes.at({0, i - 1});
      const Rigid2 T_previous_node =
          previous.T_map_node.Inverse() * node.T_map_node;
      const double dx = (*normal)(options.translation_noise);
      const double dy = (*normal)(options.translation_noise);
      const double dyaw = options.yaw_bias + (*normal)(options.yaw_noise);
      node.T_local_node = *previous.T_local_node *
                          Rigid2(T_previous_node.translation().x() + dx,
                                 T_previous_node.translation().y() + dy,
                                 T_previous_node.rotation() + dyaw);
    }
    graph->nodes[{0, i}] = node;
  }
}

inline void AddSubmaps(const RoundTripOptions& options,
                       PoseGraph* const graph) {
  const int period = options.nodes_between_submaps;
  for (int s = 0; s * period < options.num_nodes; ++s) {
    const Node& first = graph->nodes.at({0, s * period});
    graph->submap_poses[{0, s}] = first.T_map_node;
    for (int i = s * period; i < std::min((s + 2) * period, options.num_nodes);
         ++i) {
      graph->constraints.push_back({{0, s},
                                    {0, i},
                                    first.T_local_node->Inverse() *
                                        *graph->nodes.at({0, i}).T_local_node,
                                    5e2,
                                    1.6e3,
                                    Constraint::Tag::kIntraSubmap});
    }
  }
}

inline Constraint InterSubmapConstraint(const SubmapId& submap,
                                        const NodeId& node,
                                        const Rigid2& T_submap_node) {
  return {submap, node, T_submap_node,
          1.1e4,  1e5,  Constraint::Tag::kInterSubmap};
}

inline void AddClosures(const RoundTripOptions& options,
                        NormalNumbers* const normal, PoseGraph* const graph) {
  const int per_round = options.num_nodes / options.num_rounds;
  const int every = options.nodes_between_closures;
  for (int i = per_round; every > 0 && i < options.num_nodes; i += every) {
    const SubmapId submap{0, i % per_round / options.nodes_between_submaps};
    const double dx = (*normal)(options.closure_translation_noise);
    const double dy = (*normal)(options.closure_translation_noise);
    const double dyaw = (*normal)(options.closure_yaw_noise);
    graph->constraints.push_back(InterSubmapConstraint(
        submap, {0, i},
        graph->submap_poses.at(submap).Inverse() *
            graph->nodes.at({0, i}).T_map_node * Rigid2(dx, dy, dyaw)));
  }
  const int num_submaps = static_cast<int>(graph->submap_poses.size());
  for (int k = 0; k != options.num_false_closures; ++k) {
    const SubmapId submap{0, normal->Index(num_submaps)};
    const NodeId node{0, normal->Index(options.num_nodes)};
    const double x = (*normal)(3.);
    const double y = (*normal)(3.);
    graph->constraints.push_back(
        InterSubmapConstraint(submap, node, Rigid2(x, y, (*normal)(0.5))));
  }
}

inline RoundTrip MakeRoundTrip(const RoundTripOptions& options) {
  NormalNumbers normal(42);
  RoundTrip result;
  AddNodes(options, &normal, &result.truth);
  AddSubmaps(options, &result.truth);
  AddClosures(options, &normal, &result.truth);
  result.open_loop = result.truth;
  for (auto& [id, node] : result.open_loop.nodes) {
    node.T_map_node = *node.T_local_node;
  }
  for (auto& [id, T_map_submap] : result.open_loop.submap_poses) {
    T_map_submap =
        result.open_loop.nodes.at({0, id.index * options.nodes_between_submaps})
            .T_map_node;
  }
  return result;
}

// All from the given submap and node on becomes trajectory 1, moved by T in the
// map; what local SLAM knew of the way across is dropped.
inline PoseGraph SplitTrajectory(const PoseGraph& graph, const int first_submap,
                                 const int first_node, const Rigid2& T) {
  PoseGraph result;
  for (const auto& [id, T_map_submap] : graph.submap_poses) {
    if (id.index < first_submap) {
      result.submap_poses[id] = T_map_submap;
    } else {
      result.submap_poses[{1, id.index - first_submap}] = T * T_map_submap;
    }
  }
  for (const auto& [id, node] : graph.nodes) {
    if (id.index < first_node) {
      result.nodes[id] = node;
    } else {
      Node& moved = result.nodes[{1, id.index - first_node}];
      moved = node;
      moved.T_map_node = T * node.T_map_node;
    }
  }
  for (Constraint constraint : graph.constraints) {
    const bool second_submap = constraint.submap.index >= first_submap;
    const bool second_node = constraint.node.index >= first_node;
    if (constraint.tag == Constraint::Tag::kIntraSubmap &&
        second_submap != second_node) {
      continue;
    }
    if (second_submap) {
      constraint.submap = {1, constraint.submap.index - first_submap};
    }
    if (second_node) {
      constraint.node = {1, constraint.node.index - first_node};
    }
    result.constraints.push_back(constraint);
  }
  return result;
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_SYNTHETIC_POSE_GRAPH_H_
