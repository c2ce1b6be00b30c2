// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place_store/described_map.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/place/field_memory.h"
#include "cartographer_sdf/place_store/place_file.h"

namespace cartographer_sdf {
namespace {

// Number of grids described at once: enough for the threads of a large machine,
// and little memory.
constexpr size_t kBatchSize = 16;

// Reads the map without places.
absl::StatusOr<DescribedMap> ReadAndVisit(const MapSource& source,
                                          const SubmapCallback& on_submap,
                                          const PointClouds wanted,
                                          const ProgressCallback& on_progress) {
  DescribedMap map;
  MapVisitor visitor{on_submap, {}};
  if (wanted == PointClouds::kKeep) {
    visitor.on_point_cloud = [&map](const NodeId& id, PointCloud2 cloud) {
      map.point_clouds.emplace(id, std::move(cloud));
    };
  }
  absl::StatusOr<MapState> state = ReadMap(source, visitor, on_progress);
  if (!state.ok()) return state.status();
  map.state = *std::move(state);
  map.odometry = OdometryPoses(map.state);
  return map;
}

}  // namespace

std::map<SubmapId, Place> DescribePlaces(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::map<SubmapId, OccupancyGrid>& grids, const Executor& executor) {
  std::vector<const std::pair<const SubmapId, OccupancyGrid>*> entries;
  for (const auto& entry : grids) entries.push_back(&entry);
  std::vector<std::optional<Place>> described(entries.size());
  executor(entries.size(), [&](const size_t k) {
    described[k] =
        DescribePlace(place_options, entries[k]->first, entries[k]->second);
    if (described[k] && match_options.method == Method::kSdf) {
      FindSelfSimilarities(match_options, &*described[k]);
    }
  });
  std::map<SubmapId, Place> places;
  for (std::optional<Place>& place : described) {
    if (!place) continue;
    const SubmapId id = place->id;
    places.emplace(id, *std::move(place));
  }
  return places;
}

absl::StatusOr<DescribedMap> DescribeMap(const PlaceOptions& place_options,
                                         const MatchOptions& match_options,
                                         const MapSource& source,
                                         const Executor& executor,
                                         const ProgressCallback& on_progress,
                                         const PointClouds point_clouds) {
  std::map<SubmapId, Place> places;
  std::map<SubmapId, OccupancyGrid> batch;
  FieldMemory memory(place_options);
  const auto describe_batch = [&] {
    std::map<SubmapId, Place> described =
        DescribePlaces(place_options, match_options, batch, executor);
    memory.Add(&described);
    places.merge(described);
    batch.clear();
  };
  const auto add = [&](const SubmapId& id, const SubmapSummary&,
                       OccupancyGrid grid) {
    batch.emplace(id, std::move(grid));
    if (batch.size() >= kBatchSize) describe_batch();
  };
  absl::StatusOr<DescribedMap> map =
      ReadAndVisit(source, add, point_clouds, on_progress);
  if (!map.ok()) return map;
  describe_batch();
  map->places = std::move(places);
  return map;
}

absl::StatusOr<RememberedMap> RememberMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::string& options_text, const MapSource& source,
    const std::string& places_path, const Executor& executor,
    const ProgressCallback& on_progress, const PointClouds point_clouds) {
  std::error_code error;
  if (std::filesystem::file_size(places_path, error) > 0 && !error &&
      !IsPlaceFile(places_path)) {
    return absl::AlreadyExistsError(absl::StrCat(
        "cannot write ", places_path, ": it exists, and is no file of places"));
  }
  const absl::StatusOr<PlaceFileKey> key =
      MakePlaceFileKey(source.path, options_text);
  if (!key.ok()) return key.status();
  absl::StatusOr<std::map<SubmapId, Place>> places =
      ReadPlaces(places_path, *key);
  absl::StatusOr<DescribedMap> map =
      places.ok() ? ReadAndVisit(source, {}, point_clouds, on_progress)
                  : DescribeMap(place_options, match_options, source, executor,
                                on_progress, point_clouds);
  if (!map.ok()) return map.status();
  RememberedMap remembered{*std::move(map), places.ok(), ""};
  if (places.ok()) {
    FieldMemory(place_options).Add(&*places);
    remembered.map.places = *std::move(places);
    return remembered;
  }
  if (!absl::IsNotFound(places.status())) {
    remembered.complaint = std::string(places.status().message());
  }
  const absl::Status status =
      WritePlaces(places_path, *key, remembered.map.places);
  if (!status.ok()) remembered.complaint = std::string(status.message());
  return remembered;
}

std::map<SubmapId, OdometryPose> OdometryPoses(const MapState& state) {
  // Distance driven up to each node.
  std::map<NodeId, double> driven;
  std::optional<std::pair<NodeId, Rigid2>> previous;
  double distance = 0.;
  for (const auto& [id, node] : state.pose_graph.nodes) {
    const Rigid2& pose =
        node.T_local_node ? *node.T_local_node : node.T_map_node;
    if (previous && previous->first.trajectory == id.trajectory) {
      distance += (pose.translation() - previous->second.translation()).norm();
    }
    driven[id] = distance;
    previous = {id, pose};
  }
  // The distance of a submap is the mean over its nodes.
  std::map<SubmapId, std::pair<double, int>> sums;
  for (const Constraint& constraint : state.pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    auto& [sum, count] = sums[constraint.submap];
    sum += driven[constraint.node];
    ++count;
  }
  std::map<SubmapId, OdometryPose> poses;
  for (const auto& [id, submap] : state.submaps) {
    const auto sum = sums.find(id);
    poses[id] = {
        submap.T_local_submap,
        sum == sums.end() ? 0. : sum->second.first / sum->second.second};
  }
  return poses;
}

absl::StatusOr<DescribedMap> ReadMapWithScans(
    const MapSource& source, const ProgressCallback& on_progress) {
  return ReadAndVisit(source, {}, PointClouds::kKeep, on_progress);
}

}  // namespace cartographer_sdf
