// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Several maps as one: every record of each, under new numbers of its
// trajectories.

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
  // New number of each trajectory of the file. Those of all parts differ.
  std::map<int, int> trajectories;
};

// Numbers the trajectories of maps from zero on, in the order of the maps and,
// within each, of its file.
[[nodiscard]] std::vector<MapPart> NumberTrajectories(
    const std::vector<std::string>& paths,
    const std::vector<const MapState*>& maps);

// A SubmapId or NodeId under its new number.
template <typename IdType>
[[nodiscard]] IdType Renumbered(const MapPart& part, const IdType& id) {
  return {part.trajectories.at(id.trajectory), id.index};
}

// Adds a map under its new numbers. Of a landmark that is known already, the
// pose stays: to the host, equal names are one landmark.
void AppendMap(const MapPart& part, const MapState& map, MapState* joined);

// An error where the output is the input, which would be lost. WriteJoinedMap
// checks it, too; this is for whoever wants to know before the work is done.
[[nodiscard]] absl::Status CheckIsNoInput(const std::string& input,
                                          const std::string& output);

// Writes one map of all records of all parts, in the host's order of kinds and
// otherwise that of the parts, with the poses and constraints of `pose_graph`,
// which is what AppendMap makes of the parts and the caller has changed, as
// WriteMap does. Records other than the pose graph and the options keep every
// byte but the number of the trajectory; so do landmarks' names, timestamps and
// the order within a trajectory. Where GPS has its origin moves along with the
// first node of the trajectory.
//
// Fails as WriteMap does; the output must not be one of the parts. Decompresses
// each part once, or twice, for WriteMap's reason.
[[nodiscard]] absl::Status WriteJoinedMap(
    const std::vector<MapPart>& parts, const PoseGraph& pose_graph,
    const std::string& output, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_JOINED_MAP_FILE_H_
