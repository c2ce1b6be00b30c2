// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_MAP_SUMMARY_H_
#define CARTOGRAPHER_SDF_REPORT_MAP_SUMMARY_H_

#include <cstdint>
#include <map>
#include <string>

#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {

// What the nodes of a trajectory tell, in the order of their indices.
struct TrajectorySummary {
  int num_submaps = 0;
  int num_nodes = 0;
  // Of the first node, and of all times, from the earliest to the latest.
  int64_t begin_time = 0;
  double duration_seconds = 0.;
  // By the poses in the map frame [m].
  double length = 0.;
  // Nodes that odometry connects to their predecessor.
  int num_nodes_with_odometry = 0;
  // Between nodes that follow each other by more than kGapSeconds.
  int num_gaps = 0;
  double longest_gap_seconds = 0.;
};

// Twice the time after which the host's default motion filter makes a node even
// where the robot stands.
constexpr double kGapSeconds = 10.;

[[nodiscard]] std::map<int, TrajectorySummary> SummarizeTrajectories(
    const MapState& map);

// For people, some tens of lines. `name` is what the map is called.
[[nodiscard]] std::string DescribeMap(const std::string& name,
                                      const MapState& map);

// Universal time, 100 ns ticks since 0001-01-01, as "2019-05-23 14:00:01 UTC";
// "-" outside of the years 1 to 9999.
[[nodiscard]] std::string FormatUniversalTime(int64_t ticks);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MAP_SUMMARY_H_
