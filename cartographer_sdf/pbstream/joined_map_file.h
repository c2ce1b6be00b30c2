// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Joins several maps into one: every record of each, with its trajectories
// renumbered.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_JOINED_MAP_FILE_H_
#define CARTOGRAPHER_SDF_PBSTREAM_JOINED_MAP_FILE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct MapPart {
  std::string path;
  // New number of each trajectory in the file; distinct across all parts.
  std::map<int, int> trajectories;
  OdometryRecords odometry_records = OdometryRecords::kKeep;
};

// Numbers the trajectories of all maps from zero, in the order of the maps and,
// within each, of its file. Parts are written as the maps were read: with or
// without odometry.
[[nodiscard]] std::vector<MapPart> NumberTrajectories(
    const std::vector<std::string>& paths,
    const std::vector<const MapState*>& maps);

// Returns a SubmapId or NodeId with the new trajectory number.
template <typename IdType>
[[nodiscard]] IdType Renumbered(const MapPart& part, const IdType& id) {
  return {part.trajectories.at(id.trajectory), id.index};
}

// Appends a map under its new trajectory numbers. A landmark that is already
// known keeps its pose: the host identifies landmarks by name.
void AppendMap(const MapPart& part, const MapState& map, MapState* joined);

// Returns an error if the output is the input, which would be lost.
// WriteJoinedMap also checks this; call it to detect the error before the work
// is done.
[[nodiscard]] absl::Status CheckIsNoInput(const std::string& input,
                                          const std::string& output);

// Writes one map with all records of all parts, ordered by kind as in the host,
// then by part. Poses and constraints come from `pose_graph`, the result of
// AppendMap for the parts as changed by the caller; see WriteMap. All other
// records except the options keep every byte but the trajectory number, and so
// do landmark names, timestamps and the order within a trajectory. The GPS
// origin of a trajectory moves along with its first node.
//
// Fails as WriteMap does; the output must not be one of the parts. Decompresses
// each part once, or twice, for the reason given at WriteMap.
[[nodiscard]] absl::Status WriteJoinedMap(
    const std::vector<MapPart>& parts, const PoseGraph& pose_graph,
    const std::string& output, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_JOINED_MAP_FILE_H_
