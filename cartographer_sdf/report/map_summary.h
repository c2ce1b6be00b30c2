// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_MAP_SUMMARY_H_
#define CARTOGRAPHER_SDF_REPORT_MAP_SUMMARY_H_

#include <cstdint>
#include <map>
#include <string>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/pose_graph/slips.h"

namespace cartographer_sdf {

// Statistics of the nodes of a trajectory, in the order of their indices.
struct TrajectorySummary {
  int num_submaps = 0;
  int num_nodes = 0;
  // Time of the first node; duration from the earliest to the latest time.
  int64_t begin_time = 0;
  double duration_seconds = 0.;
  // From the poses in the map frame [m].
  double length = 0.;
  // Nodes that odometry connects to their predecessor.
  int num_nodes_with_odometry = 0;
  // Gaps of more than kGapSeconds between consecutive nodes.
  int num_gaps = 0;
  double longest_gap_seconds = 0.;
};

// Twice the time after which the host's default motion filter makes a node even
// if the robot stands still.
constexpr double kGapSeconds = 10.;

[[nodiscard]] std::map<int, TrajectorySummary> SummarizeTrajectories(
    const MapState& map);

// Human-readable, some tens of lines. `name` is the name of the map.
[[nodiscard]] std::string DescribeMap(const std::string& name,
                                      const MapState& map);

// "Local SLAM slipped at 2 steps, in 3 submaps: there odometry turned by angles
// that differ by up to 11.3 deg". Empty without slips.
[[nodiscard]] std::string DescribeSlips(const Slips& slips,
                                        const PoseGraph& pose_graph);

// Universal time, 100 ns ticks since 0001-01-01, as "2019-05-23 14:00:01 UTC";
// "-" outside the years 1 to 9999.
[[nodiscard]] std::string FormatUniversalTime(int64_t ticks);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MAP_SUMMARY_H_
