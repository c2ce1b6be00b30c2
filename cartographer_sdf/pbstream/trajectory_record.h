// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds the trajectory that a record of a map belongs to, and renumbers it.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_TRAJECTORY_RECORD_H_
#define CARTOGRAPHER_SDF_PBSTREAM_TRAJECTORY_RECORD_H_

#include <optional>
#include <string>

#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Returns none for the pose graph, the options, and records of an unknown kind.
[[nodiscard]] std::optional<int> TrajectoryOfRecord(
    const proto::SerializedData& data);

// Returns `record`, whose content is `data`, with `trajectory` as its number.
// TrajectoryOfRecord must return a value for it. Every other field, known or
// unknown, keeps its place and its bytes.
[[nodiscard]] std::string WithTrajectory(const std::string& record,
                                         const proto::SerializedData& data,
                                         int trajectory);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_TRAJECTORY_RECORD_H_
