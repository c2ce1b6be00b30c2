// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/session.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/localization/compared_numbers.h"
#include "cartographer_sdf/place/surface_model.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Adds the places made of scans as submaps of the session. A submap that is in
// the pose graph without a record of its own is not replaced.
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

void Move(const Rigid2& T_moved_map, PoseGraph* const graph) {
  for (auto& [id, pose] : graph->submap_poses) pose = T_moved_map * pose;
  for (auto& [id, node] : graph->nodes) {
    node.T_map_node = T_moved_map * node.T_map_node;
  }
  for (auto& [id, pose] : graph->landmark_poses) {
    pose = Embed3D(T_moved_map) * pose;
  }
}

bool IsIdentity(const Rigid2& pose) {
  return pose.translation().isZero(0.) && pose.rotation() == 0.;
}

// Adds the places of a session and their data under the new ids.
void AddPlaces(const Session& session, const MapPart& part,
               JoinedSessions* const joined) {
  for (const auto& [id, place] : session.map.places) {
    Place renamed = place;
    renamed.id = Renumbered(part, id);
    joined->places.emplace(renamed.id, std::move(renamed));
  }
  for (const auto& [id, pose] : session.map.odometry) {
    joined->odometry.emplace(Renumbered(part, id), pose);
  }
  for (const auto& [id, grid] : session.scan_grids) {
    joined->scan_submaps.insert(Renumbered(part, id));
  }
  for (const auto& [id, cloud] : session.map.point_clouds) {
    joined->point_clouds.emplace(Renumbered(part, id), cloud);
  }
}

// Why little or nothing can be found in a map, and what helps; empty if nothing
// is the matter. Areas [m^2] are what all of it must show, and what two submaps
// must have in common.
std::string ExplainBareMap(const DescribedMap& map, const double min_area,
                           const double min_common_area) {
  if (map.state.submaps.empty()) {
    return "; the map has no submaps: drive farther, or save it with "
           "unfinished submaps";
  }
  double area = 0.;
  double largest = 0.;
  for (const auto& [id, place] : map.places) {
    const double of_place = ObservedArea(place.surface);
    area += of_place;
    largest = std::max(largest, of_place);
  }
  if (area < min_area) {
    const ComparedNumbers compared = FormatCompared(area, min_area, 0);
    return absl::StrCat("; the map shows too little: ", compared.number,
                        " m2, ", compared.threshold, " are needed");
  }
  if (largest >= min_common_area) return "";
  const ComparedNumbers compared = FormatCompared(largest, min_common_area, 0);
  return absl::StrCat("; no submap of the map shows more than ",
                      compared.number, " m2, and two must have ",
                      compared.threshold, " in common");
}

bool HasInterSubmapConstraint(const PoseGraph& pose_graph) {
  return std::any_of(pose_graph.constraints.begin(),
                     pose_graph.constraints.end(),
                     [](const Constraint& constraint) {
                       return constraint.tag == Constraint::Tag::kInterSubmap;
                     });
}

// What the reason of a refusal lacks: what is the matter with the map.
std::string ExplainRefusal(const Localization& result, const DescribedMap& map,
                           const double min_area,
                           const double min_common_area) {
  if (result.verdict == LocalizationVerdict::kNothingAlike) {
    return ExplainBareMap(map, min_area, min_common_area);
  }
  if (result.verdict == LocalizationVerdict::kAmbiguous &&
      !HasInterSubmapConstraint(map.state.pose_graph)) {
    return "; the map has no loop closures: where it drifted, a place is in it "
           "more than once until close_loops has closed them";
  }
  return "";
}

}  // namespace

absl::StatusOr<Session> DescribeSession(const LoopClosingOptions& options,
                                        const ScanPlaceOptions& scan_places,
                                        const MapSource& source,
                                        const std::optional<TimeWindow>& window,
                                        const Executor& executor,
                                        const ProgressCallback& on_progress,
                                        const MapDescriber& describe) {
  const MatchOptions& match = options.recognition.match;
  if (window) {
    const absl::StatusOr<DescribedMap> read =
        ReadMapWithScans(source, on_progress);
    if (!read.ok()) return read.status();
    ScanMap scans = DescribeScans(scan_places, options.place, match, *read,
                                  *window, executor);
    return Session{source.path, std::move(scans.map), std::move(scans.grids)};
  }
  absl::StatusOr<DescribedMap> map =
      describe ? describe(source, on_progress)
               : DescribeMap(options.place, match, source, executor,
                             on_progress, PointClouds::kKeep);
  if (!map.ok()) return map.status();
  Session session{source.path, *std::move(map), {}};
  const std::set<int> without_submaps =
      TrajectoriesWithoutSubmaps(session.map.state);
  if (!without_submaps.empty()) {
    AddScanPlaces(DescribeScans(scan_places, options.place, match, session.map,
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
  IncrementalRecognition recognition(stages.recognition,
                                     map.trajectory_places(),
                                     query.trajectory_places(), executor);
  Localization result = Localize(
      options, stages.closing.consistency, stages.recognition.match,
      {&map.places, &map_layout}, {&query.places, &query_layout},
      [&recognition](const std::map<SubmapId, Place>& queries,
                     const ProgressCallback& on_progress) {
        return recognition.Add(queries, on_progress);
      },
      executor, on_stage);
  result.reason += ExplainRefusal(
      result, map, options.placement.min_observed_area,
      stages.recognition.match.verification.judgement.min_overlap_area);
  if (result.T_map_query) {
    std::vector<PairPose> agreeing;
    for (const size_t vote : result.placements.front().votes) {
      agreeing.push_back(result.matches[vote].pair);
    }
    StageClock clock(on_stage, &result.stage_seconds);
    clock.Begin("find changes");
    result.changes =
        FindChanges({&map.places, &map_layout}, {&query.places, &query_layout},
                    agreeing, executor);
    clock.End();
  }
  return result;
}

JoinedSessions JoinSessions(const ClosingOptions& options,
                            const std::vector<const Session*>& sessions,
                            const std::map<size_t, Rigid2>& T_merged_session) {
  JoinedSessions joined;
  std::vector<std::string> paths;
  std::vector<const MapState*> states;
  for (const auto& [k, pose] : T_merged_session) {
    paths.push_back(sessions[k]->path);
    states.push_back(&sessions[k]->map.state);
  }
  std::vector<MapPart> parts = NumberTrajectories(paths, states);
  MapState placed;
  auto next_part = parts.begin();
  for (const auto& [k, pose] : T_merged_session) {
    const MapPart& part = joined.parts[k] = std::move(*next_part++);
    MapState state = sessions[k]->map.state;
    AppendMap(part, state, &joined.state);
    const std::optional<OdometryWeights> weights =
        options.infer_odometry_weights
            ? InferOdometryWeights(options.optimization, state.pose_graph)
            : std::nullopt;
    // The first session stays bit for bit.
    if (!IsIdentity(pose)) Move(pose, &state.pose_graph);
    AppendMap(part, state, &placed);
    AddPlaces(*sessions[k], part, &joined);
    for (const auto& [trajectory, number] : part.trajectories) {
      joined.session_of_trajectory[number] = k;
      if (weights) placed.pose_graph.odometry_weights[number] = *weights;
    }
  }
  joined.placed = std::move(placed.pose_graph);
  return joined;
}

void RemoveScanSubmaps(const JoinedSessions& joined,
                       PoseGraph* const pose_graph) {
  for (const SubmapId& id : joined.scan_submaps) {
    pose_graph->submap_poses.erase(id);
  }
  std::vector<Constraint>& constraints = pose_graph->constraints;
  constraints.erase(
      std::remove_if(constraints.begin(), constraints.end(),
                     [&](const Constraint& constraint) {
                       return joined.scan_submaps.count(constraint.submap) > 0;
                     }),
      constraints.end());
}

}  // namespace cartographer_sdf
