// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_LIVE_HOST_OPTIONS_H_
#define CARTOGRAPHER_SDF_LIVE_HOST_OPTIONS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"

namespace cartographer_sdf {

struct HostOptions {
  cartographer::mapping::proto::MapBuilderOptions map_builder;
  cartographer::mapping::proto::TrajectoryBuilderOptions trajectory_builder;
};

// Cartographer's own options: the tables map_builder and trajectory_builder of
// what the file returns, as in a file of cartographer_ros, whose other keys are
// passed over. It and what it includes is looked for in the directories, then
// where Cartographer is installed.
//
// Cartographer's reader knows no errors: a missing file and whatever is wrong
// inside of one is LOG(FATAL). Only options for 3D are an error here.
[[nodiscard]] absl::StatusOr<HostOptions> LoadHostOptions(
    const std::vector<std::string>& directories, const std::string& basename);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_HOST_OPTIONS_H_
