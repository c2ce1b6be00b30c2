// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Which trajectory a record of a map belongs to, and the record under another
// number.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_TRAJECTORY_RECORD_H_
#define CARTOGRAPHER_SDF_PBSTREAM_TRAJECTORY_RECORD_H_

#include <optional>
#include <string>

#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// None for the pose graph, the options, and records of an unknown kind.
[[nodiscard]] std::optional<int> TrajectoryOfRecord(
    const proto::SerializedData& data);

// The record, of which `data` is the content and TrajectoryOfRecord has an
// answer, with that number in its place. Every other field keeps its place and
// its bytes, known to us or not.
[[nodiscard]] std::string WithTrajectory(const std::string& record,
                                         const proto::SerializedData& data,
                                         int trajectory);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_TRAJECTORY_RECORD_H_
