// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Places made of the scans of a stretch of a map, as if it had just been
// driven: for relocalising a robot that has no finished submap yet, and maps
// that were saved without theirs.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SCAN_PLACES_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SCAN_PLACES_H_

#include <map>
#include <optional>
#include <set>
#include <string>

#include "cartographer_sdf/place_store/described_map.h"

namespace cartographer_sdf {

struct ScanPlaceOptions {
  // Scans of a place, as Cartographer's 2 * num_range_data; each place begins
  // half of that after the one before.
  int num_scans = 120;
  // As Cartographer's grid_options_2d and range_data_inserter.
  double resolution_meters = 0.05;
  double hit_probability = 0.55;
  double miss_probability = 0.49;
};
[[nodiscard]] std::string Validate(const ScanPlaceOptions& options);

// Of each trajectory, from its first node on [s]. No end: until its last one.
struct TimeWindow {
  double start_seconds = 0.;
  std::optional<double> num_seconds;
};

// The nodes of a map in the window, and places made of their scans. It is a map
// of its own: its submaps are these places, each in the tracking frame of
// its first node, with intra-submap constraints to its nodes; nodes keep their
// ids and poses, and the index of a submap is that of its first node. Empty
// where no node with range data falls into the window.
struct ScanMap {
  DescribedMap map;
  std::map<SubmapId, OccupancyGrid> grids;
};

// Of a map with its point clouds. Trajectories other than the given ones, if
// any are given, are left out.
[[nodiscard]] ScanMap DescribeScans(
    const ScanPlaceOptions& options, const PlaceOptions& place_options,
    const MatchOptions& match_options, const DescribedMap& map,
    const TimeWindow& window, const Executor& executor,
    const std::optional<std::set<int>>& trajectories = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SCAN_PLACES_H_
