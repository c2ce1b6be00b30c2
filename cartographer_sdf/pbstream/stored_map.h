// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PBSTREAM_STORED_MAP_H_
#define CARTOGRAPHER_SDF_PBSTREAM_STORED_MAP_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// What ReadMap() returns, and the record that the pose graph was made of, for
// WriteMap() to change.
struct StoredMap {
  MapState state;
  proto::SerializedData pose_graph_record;
};

// See ReadMap().
[[nodiscard]] absl::StatusOr<StoredMap> ReadStoredMap(
    const std::string& path, const SubmapCallback& on_submap,
    const ProgressCallback& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_STORED_MAP_H_
