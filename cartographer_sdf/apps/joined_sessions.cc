// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/joined_sessions.h"

#include <algorithm>
#include <string>
#include <utility>

#include "cartographer_sdf/pose_graph/odometry_weights.h"

namespace cartographer_sdf {
namespace {

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

// The places of a session and what belongs to them, under their new ids.
void AddPlaces(const Session& session, const size_t part,
               JoinedSessions* const joined) {
  for (const auto& [id, place] : session.map.places) {
    Place renamed = place;
    renamed.id = joined->Renamed(part, id);
    joined->places.emplace(renamed.id, std::move(renamed));
  }
  for (const auto& [id, pose] : session.map.odometry) {
    joined->odometry.emplace(joined->Renamed(part, id), pose);
  }
  for (const auto& entry : session.scan_grids) {
    joined->scan_submaps.insert(joined->Renamed(part, entry.first));
  }
  for (const auto& [id, cloud] : session.map.point_clouds) {
    const int number = joined->parts[part].trajectories.at(id.trajectory);
    joined->point_clouds.emplace(NodeId{number, id.index}, cloud);
  }
}

}  // namespace

std::optional<size_t> JoinedSessions::PartOf(const size_t session) const {
  const auto it = std::find(sessions.begin(), sessions.end(), session);
  if (it == sessions.end()) return std::nullopt;
  return static_cast<size_t>(it - sessions.begin());
}

Match JoinedSessions::Renamed(Match match, const size_t reference_part,
                              const size_t query_part) const {
  match.pair.reference = Renamed(reference_part, match.pair.reference);
  match.pair.query = Renamed(query_part, match.pair.query);
  return match;
}

JoinedSessions JoinSessions(const ClosingOptions& options,
                            const std::vector<const Session*>& sessions,
                            const std::map<size_t, Rigid2>& T_merged_session) {
  JoinedSessions joined;
  std::vector<std::string> paths;
  std::vector<const MapState*> states;
  for (const auto& entry : T_merged_session) {
    joined.sessions.push_back(entry.first);
    paths.push_back(sessions[entry.first]->path);
    states.push_back(&sessions[entry.first]->map.state);
  }
  joined.parts = NumberTrajectories(paths, states);
  MapState placed;
  for (size_t k = 0; k < joined.sessions.size(); ++k) {
    const MapPart& part = joined.parts[k];
    const MapState& state = *states[k];
    AppendMap(part, state, &joined.state);
    MapState moved = state;
    const Rigid2& pose = T_merged_session.at(joined.sessions[k]);
    // The first stays to the last bit.
    if (!IsIdentity(pose)) Move(pose, &moved.pose_graph);
    AppendMap(part, moved, &placed);
    AddPlaces(*sessions[joined.sessions[k]], k, &joined);
    const std::optional<OdometryWeights> weights =
        options.infer_odometry_weights
            ? InferOdometryWeights(options.optimization, state.pose_graph)
            : std::nullopt;
    for (const auto& [trajectory, number] : part.trajectories) {
      joined.session_of_trajectory[number] = joined.sessions[k];
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
