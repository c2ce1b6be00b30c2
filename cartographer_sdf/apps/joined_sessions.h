// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Several sessions as one map, under new trajectory numbers.

#ifndef CARTOGRAPHER_SDF_APPS_JOINED_SESSIONS_H_
#define CARTOGRAPHER_SDF_APPS_JOINED_SESSIONS_H_

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/closing/pipeline.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"

namespace cartographer_sdf {

struct JoinedSessions {
  std::vector<MapPart> parts;
  std::vector<size_t> sessions;  // of the parts, in the same order
  // All ids are the new ones.
  MapState state;    // as read
  PoseGraph placed;  // with the poses where the sessions were laid
  std::map<SubmapId, Place> places;
  std::map<SubmapId, OdometryPose> odometry;
  std::map<NodeId, PointCloud2> point_clouds;
  std::map<int, size_t> session_of_trajectory;
  std::set<SubmapId> scan_submaps;  // in no file

  [[nodiscard]] size_t SessionOf(const SubmapId& id) const {
    return session_of_trajectory.at(id.trajectory);
  }
  [[nodiscard]] SubmapId Renamed(size_t part, const SubmapId& id) const {
    return {parts[part].trajectories.at(id.trajectory), id.index};
  }
  // None of a session that was not joined.
  [[nodiscard]] std::optional<size_t> PartOf(size_t session) const;
  // The match with the new ids of its submaps.
  [[nodiscard]] Match Renamed(Match match, size_t reference_part,
                              size_t query_part) const;
};

// Joins the sessions that `T_merged_session` lays somewhere; each is weighed by
// the odometry weights that it shows, where they are to be inferred.
[[nodiscard]] JoinedSessions JoinSessions(
    const ClosingOptions& options, const std::vector<const Session*>& sessions,
    const std::map<size_t, Rigid2>& T_merged_session);

// Submaps that are in no file can't be written.
void RemoveScanSubmaps(const JoinedSessions& joined, PoseGraph* pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_JOINED_SESSIONS_H_
