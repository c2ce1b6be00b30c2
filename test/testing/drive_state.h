// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The state of a map without a file: a drive along a straight way.

#ifndef TEST_TESTING_DRIVE_STATE_H_
#define TEST_TESTING_DRIVE_STATE_H_

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf::testing {

// Adds a trajectory: submap and node i at i * spacing [m] along the way, the
// submap's grid of 4 m around it.
inline void AddStraightDrive(const int trajectory, const Rigid2& T_map_way,
                             const int num_submaps, const double spacing,
                             MapState* const state) {
  for (int i = 0; i != num_submaps; ++i) {
    const Rigid2 pose = T_map_way * Rigid2(spacing * i, 0., 0.);
    SubmapSummary& submap = state->submaps[{trajectory, i}];
    submap.T_local_submap = pose;
    submap.geometry.size = Eigen::Array2i(80, 80);
    submap.geometry.resolution = 0.05;
    submap.geometry.T_submap_grid = Rigid2(-2., -2., 0.);
    state->pose_graph.submap_poses[{trajectory, i}] = pose;
    Node& node = state->pose_graph.nodes[{trajectory, i}];
    node.T_map_node = pose;
    node.T_local_node = pose;
    state->pose_graph.constraints.push_back(
        Constraint{{trajectory, i},
                   {trajectory, i},
                   Rigid2(),
                   1.,
                   1.,
                   Constraint::Tag::kIntraSubmap});
  }
  state->trajectories.push_back(trajectory);
}

// Of submaps of two such drives along the same way; `offset` [m] from the
// truth.
inline PairPose PairOnWay(const SubmapId& reference, const SubmapId& query,
                          const double spacing, const double offset,
                          const double score) {
  return {reference, query,
          Rigid2(spacing * (query.index - reference.index) + offset, 0., 0.),
          score};
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_DRIVE_STATE_H_
