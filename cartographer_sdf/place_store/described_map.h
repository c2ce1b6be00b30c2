// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A saved map with a place for every submap. Independent of the map's poses.

#ifndef CARTOGRAPHER_SDF_PLACE_STORE_DESCRIBED_MAP_H_
#define CARTOGRAPHER_SDF_PLACE_STORE_DESCRIBED_MAP_H_

#include <functional>
#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

struct DescribedMap {
  MapState state;
  // Submaps without walls have no place.
  std::map<SubmapId, Place> places;
  // The nodes' filtered range data, if requested: 8 bytes per point.
  std::map<NodeId, PointCloud2> point_clouds;
  // For all submaps in the file.
  std::map<SubmapId, OdometryPose> odometry;

  // Refers to this map, which must outlive it.
  [[nodiscard]] TrajectoryPlaces trajectory_places() const {
    return {&places, &odometry};
  }
};

// Returns each submap's pose by local SLAM and the distance driven.
[[nodiscard]] std::map<SubmapId, OdometryPose> OdometryPoses(
    const MapState& state);

// Describes the grids that show a wall.
[[nodiscard]] std::map<SubmapId, Place> DescribePlaces(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::map<SubmapId, OccupancyGrid>& grids, const Executor& executor);

enum class PointClouds { kDrop, kKeep };

// Reads the file once; fails as ReadMap does. Keeps only a few grids in memory
// at a time.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const MapSource& source, const Executor& executor,
    const ProgressCallback& on_progress = {},
    PointClouds point_clouds = PointClouds::kDrop);

// Makes a described map with point clouds of a file, as DescribeMap does or
// from places that were kept; fails as DescribeMap does.
using MapDescriber = std::function<absl::StatusOr<DescribedMap>(
    const MapSource& source, const ProgressCallback& on_progress)>;

// Reads the map with its point clouds, without places.
[[nodiscard]] absl::StatusOr<DescribedMap> ReadMapWithScans(
    const MapSource& source, const ProgressCallback& on_progress = {});

struct RememberedMap {
  DescribedMap map;
  bool is_from_file = false;
  // Why an existing place file could not be used, or why it could not be
  // written: a line for the user that requires no action. Otherwise empty.
  std::string complaint;
};

// Like DescribeMap, but takes the places from a file (place_file.h) that an
// earlier run has left; otherwise describes them and writes one. `options_text`
// holds the options that places depend on; a file with other options is not
// used. Fails as DescribeMap does, or if something else than places is there.
[[nodiscard]] absl::StatusOr<RememberedMap> RememberMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::string& options_text, const MapSource& source,
    const std::string& places_path, const Executor& executor,
    const ProgressCallback& on_progress = {},
    PointClouds point_clouds = PointClouds::kDrop);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_STORE_DESCRIBED_MAP_H_
