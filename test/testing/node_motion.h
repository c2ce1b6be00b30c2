// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_NODE_MOTION_H_
#define TEST_TESTING_NODE_MOTION_H_

#include <algorithm>

#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf::testing {

// The largest distance between where two graphs have the same node, both in
// the map frame [m]. `to` has all nodes of `from`.
inline double LargestMotion(const PoseGraph& from, const PoseGraph& to) {
  double largest = 0.;
  for (const auto& [id, node] : from.nodes) {
    largest = std::max(largest, (node.T_map_node.translation() -
                                 to.nodes.at(id).T_map_node.translation())
                                    .norm());
  }
  return largest;
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_NODE_MOTION_H_
