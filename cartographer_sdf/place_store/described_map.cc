// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place_store/described_map.h"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/place_store/place_file.h"

namespace cartographer_sdf {
namespace {

// So many grids are described at once: enough for the threads of a large
// machine, little memory.
constexpr size_t kBatchSize = 16;

class BatchDescriber {
 public:
  BatchDescriber(const PlaceOptions& place_options,
                 const MatchOptions& match_options, const Executor& executor,
                 std::map<SubmapId, Place>* const places)
      : place_options_(place_options),
        match_options_(match_options),
        executor_(executor),
        places_(places) {}

  void Add(const SubmapId& id, const OccupancyGrid& grid) {
    batch_.emplace_back(id, grid);
    if (batch_.size() >= kBatchSize) Flush();
  }

  void Flush() {
    std::vector<std::optional<Place>> described(batch_.size());
    executor_(batch_.size(), [&](const size_t k) {
      described[k] =
          DescribePlace(place_options_, batch_[k].first, batch_[k].second);
      if (described[k] && match_options_.method == Method::kSdf) {
        FindSelfSimilarities(match_options_, &*described[k]);
      }
    });
    for (std::optional<Place>& place : described) {
      if (place) places_->emplace(place->id, *std::move(place));
    }
    batch_.clear();
  }

 private:
  const PlaceOptions& place_options_;
  const MatchOptions& match_options_;
  const Executor& executor_;
  std::map<SubmapId, Place>* const places_;
  std::vector<std::pair<SubmapId, OccupancyGrid>> batch_;
};

PointCloudCallback Collector(const PointClouds wanted,
                             std::map<NodeId, PointCloud2>* const clouds) {
  if (wanted == PointClouds::kDrop) return {};
  return [clouds](const NodeId& id, PointCloud2 cloud) {
    clouds->emplace(id, std::move(cloud));
  };
}

}  // namespace

absl::StatusOr<DescribedMap> DescribeMap(const PlaceOptions& place_options,
                                         const MatchOptions& match_options,
                                         const std::string& path,
                                         const Executor& executor,
                                         const ProgressCallback& on_progress,
                                         const PointClouds point_clouds) {
  DescribedMap map;
  BatchDescriber describer(place_options, match_options, executor, &map.places);
  absl::StatusOr<MapState> state = ReadMap(
      path,
      {[&describer](const SubmapId& id, const SubmapSummary&,
                    const OccupancyGrid& grid) { describer.Add(id, grid); },
       Collector(point_clouds, &map.point_clouds)},
      on_progress);
  if (!state.ok()) return state.status();
  describer.Flush();
  map.state = *std::move(state);
  map.odometry = OdometryPoses(map.state);
  return map;
}

absl::StatusOr<RememberedMap> RememberMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::string& options_text, const std::string& path,
    const std::string& places_path, const Executor& executor,
    const ProgressCallback& on_progress, const PointClouds point_clouds) {
  const absl::StatusOr<PlaceFileKey> key = MakePlaceFileKey(path, options_text);
  if (!key.ok()) return key.status();
  RememberedMap remembered;
  absl::StatusOr<std::map<SubmapId, Place>> places =
      ReadPlaces(places_path, *key);
  if (places.ok()) {
    DescribedMap& map = remembered.map;
    absl::StatusOr<MapState> state = ReadMap(
        path, {{}, Collector(point_clouds, &map.point_clouds)}, on_progress);
    if (!state.ok()) return state.status();
    map.state = *std::move(state);
    map.odometry = OdometryPoses(map.state);
    map.places = *std::move(places);
    remembered.is_from_file = true;
    return remembered;
  }
  if (!absl::IsNotFound(places.status())) {
    remembered.complaint = std::string(places.status().message());
  }
  absl::StatusOr<DescribedMap> map = DescribeMap(
      place_options, match_options, path, executor, on_progress, point_clouds);
  if (!map.ok()) return map.status();
  remembered.map = *std::move(map);
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
  // A submap is where its nodes are in the middle.
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

absl::StatusOr<MapWithScans> ReadMapWithScans(
    const std::string& path, const ProgressCallback& on_progress) {
  MapWithScans map;
  absl::StatusOr<MapState> state =
      ReadMap(path, {{}, Collector(PointClouds::kKeep, &map.point_clouds)},
              on_progress);
  if (!state.ok()) return state.status();
  map.state = *std::move(state);
  return map;
}

}  // namespace cartographer_sdf
