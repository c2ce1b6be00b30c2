// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Makes places from the scans of a stretch of a map, as if it had just been
// driven: for relocalising a robot that has no finished submap yet, and for
// maps saved without submaps.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SCAN_PLACES_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SCAN_PLACES_H_

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/place_store/described_map.h"

namespace cartographer_sdf {

struct ScanPlaceOptions {
  // Scans per place, as Cartographer's 2 * num_range_data; each place begins
  // half of that after the previous one.
  int num_scans = 120;
  // As Cartographer's grid_options_2d and range_data_inserter.
  double resolution_meters = 0.05;
  double hit_probability = 0.55;
  double miss_probability = 0.49;
};
[[nodiscard]] std::string Validate(const ScanPlaceOptions& options);

// A time window of each trajectory, counted from its first node [s]. Without
// `num_seconds`, it extends to the last node.
struct TimeWindow {
  double start_seconds = 0.;
  std::optional<double> num_seconds;
};

// The nodes of a map in the window, and places made from their scans, as a
// separate map: its submaps are these places, each in the tracking frame of its
// first node, with intra-submap constraints to its nodes; nodes keep their ids
// and poses, and the index of a submap is that of its first node. Empty if no
// node with range data falls into the window.
struct ScanMap {
  DescribedMap map;
  std::map<SubmapId, OccupancyGrid> grids;
};

// `map` must have its point clouds. If `trajectories` is given, skips all
// others.
[[nodiscard]] ScanMap DescribeScans(
    const ScanPlaceOptions& options, const PlaceOptions& place_options,
    const MatchOptions& match_options, const DescribedMap& map,
    const TimeWindow& window, const Executor& executor,
    const std::optional<std::set<int>>& trajectories = {});

// Returns the scans of the trajectory's nodes in the robot's (tracking) frame,
// with the poses of local SLAM as odometry, in time order. `map` must have its
// point clouds.
[[nodiscard]] std::vector<OdometryScan> OdometryScansOf(const DescribedMap& map,
                                                        int trajectory);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SCAN_PLACES_H_
