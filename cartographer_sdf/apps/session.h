// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A saved map, or a stretch of one, to be localized or merged.

#ifndef CARTOGRAPHER_SDF_APPS_SESSION_H_
#define CARTOGRAPHER_SDF_APPS_SESSION_H_

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/closing/pipeline.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/scan_places.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/place_store/described_map.h"

namespace cartographer_sdf {

// Ids are those of the file.
struct Session {
  std::string path;
  DescribedMap map;
  // Grids of the submaps that are not in the file but made of scans.
  std::map<SubmapId, OccupancyGrid> scan_grids;
};

// Describes all submaps in a file, and places made of the scans of trajectories
// without submaps; with a window, only places made of the scans in it. See
// scan_places.h. `describe`, if given, describes the submaps in the file in
// place of DescribeMap. Fails as ReadMap does.
[[nodiscard]] absl::StatusOr<Session> DescribeSession(
    const LoopClosingOptions& options, const ScanPlaceOptions& scan_places,
    const MapSource& source, const std::optional<TimeWindow>& window,
    const Executor& executor, const ProgressCallback& on_progress = {},
    const MapDescriber& describe = {});

// Localizes the query in the map by the matches of its places with all places
// of the map, or with those that an index proposes (recognition.use_retrieval).
[[nodiscard]] Localization LocalizeIn(const LocalizationOptions& options,
                                      const LoopClosingOptions& stages,
                                      const DescribedMap& map,
                                      const DescribedMap& query,
                                      const Executor& executor,
                                      const StageCallback& on_stage = {});

// Several sessions joined into one map, under new trajectory numbers.
struct JoinedSessions {
  std::map<size_t, MapPart> parts;  // the joined sessions, by index
  // All ids are new.
  MapState state;    // as read
  PoseGraph placed;  // with the sessions at their placements
  std::map<SubmapId, Place> places;
  std::map<SubmapId, OdometryPose> odometry;
  std::map<NodeId, PointCloud2> point_clouds;
  std::map<int, size_t> session_of_trajectory;
  std::set<SubmapId> scan_submaps;  // in no file

  [[nodiscard]] size_t SessionOf(const SubmapId& id) const {
    return session_of_trajectory.at(id.trajectory);
  }
};

// Joins the sessions in `T_merged_session`; if odometry weights are to be
// inferred, each session uses its own.
[[nodiscard]] JoinedSessions JoinSessions(
    const ClosingOptions& options, const std::vector<const Session*>& sessions,
    const std::map<size_t, Rigid2>& T_merged_session);

// Removes the submaps that are in no file and hence cannot be written.
void RemoveScanSubmaps(const JoinedSessions& joined, PoseGraph* pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_SESSION_H_
