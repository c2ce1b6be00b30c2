// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A saved map with every submap made a place.
// No pose of the map takes part.

#ifndef CARTOGRAPHER_SDF_PLACE_STORE_DESCRIBED_MAP_H_
#define CARTOGRAPHER_SDF_PLACE_STORE_DESCRIBED_MAP_H_

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
  // Submaps without a wall are no places.
  std::map<SubmapId, Place> places;
  // The nodes' filtered range data, where they were asked for: 8 bytes a point.
  std::map<NodeId, PointCloud2> point_clouds;
  // Of all submaps in the file.
  std::map<SubmapId, OdometryPose> odometry;

  // Not to be used after the map.
  [[nodiscard]] TrajectoryPlaces trajectory_places() const {
    return {&places, &odometry};
  }
};

// Where local SLAM says that the submaps are, and how far the robot had driven.
[[nodiscard]] std::map<SubmapId, OdometryPose> OdometryPoses(
    const MapState& state);

// Of those grids that show a wall.
[[nodiscard]] std::map<SubmapId, Place> DescribePlaces(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::map<SubmapId, OccupancyGrid>& grids, const Executor& executor);

enum class PointClouds { kDrop, kKeep };

// Reads the file once; fails as ReadMap does. Holds a few grids at a time.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::string& path, const Executor& executor,
    const ProgressCallback& on_progress = {},
    PointClouds point_clouds = PointClouds::kDrop);

// The map with its point clouds, without places.
[[nodiscard]] absl::StatusOr<DescribedMap> ReadMapWithScans(
    const std::string& path, const ProgressCallback& on_progress = {});

struct RememberedMap {
  DescribedMap map;
  bool is_from_file = false;
  // Why the file of places could not be used although it was there, or not be
  // written: a line for the user, who need not do anything. Else empty.
  std::string complaint;
};

// As DescribeMap, but takes the places from a file (place_file.h) that an
// earlier run has left; else describes them and leaves one. `options_text` has
// the options that places depend on; a file of other options is not used. Fails
// as DescribeMap does.
[[nodiscard]] absl::StatusOr<RememberedMap> RememberMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::string& options_text, const std::string& path,
    const std::string& places_path, const Executor& executor,
    const ProgressCallback& on_progress = {},
    PointClouds point_clouds = PointClouds::kDrop);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_STORE_DESCRIBED_MAP_H_
