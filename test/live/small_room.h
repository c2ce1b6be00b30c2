// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The cheapest of drives: round and round in one small room, with submaps of
// two scans, and a searcher that takes every match for a closure.

#ifndef TEST_LIVE_SMALL_ROOM_H_
#define TEST_LIVE_SMALL_ROOM_H_

#include <cmath>
#include <string>

#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/live/live_options.h"
#include "test/live/host.h"

namespace cartographer_sdf::testing {

// A room without symmetry, seen from a place within.
inline Scan ScanOfARoom(const Rigid2& T_room_robot) {
  constexpr float kStep = 0.12f;
  Scan scan;
  const Rigid2 T_robot_room = T_room_robot.Inverse();
  const auto add = [&](const float x, const float y) {
    scan.returns.push_back(
        (T_robot_room * Eigen::Vector2d(x, y)).cast<float>());
  };
  for (float t = 0.f; t < 6.f; t += kStep) {
    add(t, 0.f);
    if (t < 5.f) add(0.f, t);
    if (t < 3.f) {
      add(6.f, t);
      add(3.f + t, 3.f);
      add(t, 5.f);
    }
    if (t < 2.f) add(3.f, 3.f + t);
  }
  return scan;
}

// The k-th scan of a robot, `phase` [rad] along the way round.
inline void FeedScanOfARoom(
    cartographer::mapping::MapBuilderInterface* const map_builder,
    const int trajectory_id, const double phase, const int k) {
  const double angle = phase + 0.1 * k;
  const Rigid2 T_room_robot(1.5 + 0.7 * std::cos(angle),
                            1.5 + 0.7 * std::sin(angle), angle);
  FeedOdometry(map_builder, trajectory_id, 0.3 * k, T_room_robot);
  FeedScan(map_builder, trajectory_id, 0.3 * k, ScanOfARoom(T_room_robot));
}

inline LiveOptions EagerOptions() {
  LiveOptions options;
  options.log_closures = false;
  options.min_index_gap = 1;
  options.retrieval.min_num_candidates = 3;
  options.retrieval.max_num_candidates = 3;
  JudgementOptions& judgement = options.match.verification.judgement;
  judgement.min_overlap_area = 0.5;
  judgement.min_score = -1000.;
  judgement.min_margin = 0.;
  judgement.min_scatter_eigenvalue = 0.;
  options.consistency.min_unsupported_score = -1000.;
  options.constraints.min_num_constraints = 1;
  options.constraints.min_hit_ratio = 0.1;
  options.localization.max_num_candidates = 3;
  PlacementOptions& placement = options.localization.localizer.placement;
  placement.min_score = 1e-3;
  placement.min_lead = 0.;
  placement.max_contradicting_fraction = 1.;
  placement.min_observed_area = 0.5;
  options.localization.min_num_queries = 1;
  options.localization.query_interval_meters = 0.1;
  options.localization.window_meters = 1.;
  options.localization.resolution_meters = 0.1;
  return options;
}

// Submaps of two scans, of which the host keeps each, and its rounds every so
// many nodes.
inline std::string SmallSubmapsLua(const int every_n_nodes) {
  return "MAP_BUILDER.collate_by_trajectory = true\n"
         "POSE_GRAPH.constraint_builder.sampling_ratio = 0.\n"
         "POSE_GRAPH.global_sampling_ratio = 0.\n"
         "POSE_GRAPH.constraint_builder.min_score = 0.9\n"
         "POSE_GRAPH.optimization_problem.ceres_solver_options."
         "max_num_iterations = 3\n"
         "POSE_GRAPH.max_num_final_iterations = 3\n"
         "TRAJECTORY_BUILDER_2D.submaps.num_range_data = 2\n"
         "TRAJECTORY_BUILDER_2D.submaps.grid_options_2d.resolution = 0.1\n"
         "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.ceres_solver_options."
         "max_num_iterations = 3\n"
         "TRAJECTORY_BUILDER_2D.motion_filter.max_distance_meters = 0.01\n"
         "POSE_GRAPH.optimize_every_n_nodes = " +
         std::to_string(every_n_nodes) + "\n";
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_LIVE_SMALL_ROOM_H_
