// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/session.h"

#include <set>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Adds the places that were made of scans as submaps of the session. A submap
// that is in the pose graph without a record of its own is not replaced.
void AddScanPlaces(ScanMap scans, Session* const session) {
  DescribedMap& map = session->map;
  PoseGraph& graph = map.state.pose_graph;
  std::set<SubmapId> added;
  for (const auto& [id, pose] : scans.map.state.pose_graph.submap_poses) {
    if (!graph.submap_poses.emplace(id, pose).second) continue;
    added.insert(id);
    map.state.submaps[id] = scans.map.state.submaps.at(id);
    map.odometry[id] = scans.map.odometry.at(id);
    session->scan_grids.emplace(id, std::move(scans.grids.at(id)));
    const auto place = scans.map.places.find(id);
    if (place != scans.map.places.end()) {
      map.places.emplace(id, std::move(place->second));
    }
  }
  for (const Constraint& constraint : scans.map.state.pose_graph.constraints) {
    if (added.count(constraint.submap) > 0) {
      graph.constraints.push_back(constraint);
    }
  }
}

std::set<int> TrajectoriesWithoutSubmaps(const MapState& state) {
  std::set<int> trajectories(state.trajectories.begin(),
                             state.trajectories.end());
  for (const auto& [id, submap] : state.submaps) {
    trajectories.erase(id.trajectory);
  }
  return trajectories;
}

}  // namespace

absl::StatusOr<Session> DescribeSession(const LoopClosingOptions& options,
                                        const ScanPlaceOptions& scan_places,
                                        const std::string& path,
                                        const std::optional<TimeWindow>& window,
                                        const Executor& executor,
                                        const ProgressCallback& on_progress) {
  const MatchOptions& match = options.recognition.match;
  if (window) {
    const absl::StatusOr<MapWithScans> read =
        ReadMapWithScans(path, on_progress);
    if (!read.ok()) return read.status();
    ScanMap scans =
        DescribeScans(scan_places, options.place, match, read->state,
                      read->point_clouds, *window, executor);
    return Session{path, std::move(scans.map), std::move(scans.grids)};
  }
  absl::StatusOr<DescribedMap> map = DescribeMap(
      options.place, match, path, executor, on_progress, PointClouds::kKeep);
  if (!map.ok()) return map.status();
  Session session{path, *std::move(map), {}};
  const std::set<int> without_submaps =
      TrajectoriesWithoutSubmaps(session.map.state);
  if (!without_submaps.empty()) {
    AddScanPlaces(DescribeScans(scan_places, options.place, match,
                                session.map.state, session.map.point_clouds,
                                TimeWindow(), executor, without_submaps),
                  &session);
  }
  return session;
}

Localization LocalizeIn(const LocalizationOptions& options,
                        const LoopClosingOptions& stages,
                        const DescribedMap& map, const DescribedMap& query,
                        const Executor& executor,
                        const StageCallback& on_stage) {
  CHECK_EQ(Validate(stages), "");
  const MapLayout map_layout =
      MakeMapLayout(map.state.pose_graph, map.odometry, map.places);
  const MapLayout query_layout =
      MakeMapLayout(query.state.pose_graph, query.odometry, query.places);
  return Localize(
      options, stages.closing.consistency, stages.recognition.match,
      {&map.places, &map_layout}, {&query.places, &query_layout},
      [&](const std::map<SubmapId, Place>& queries,
          const ProgressCallback& on_progress) {
        return MatchBetween(stages.recognition, map.places, queries, executor,
                            on_progress);
      },
      executor, on_stage);
}

}  // namespace cartographer_sdf
