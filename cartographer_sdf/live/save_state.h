// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_LIVE_SAVE_STATE_H_
#define CARTOGRAPHER_SDF_LIVE_SAVE_STATE_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer/mapping/map_builder_interface.h"

namespace cartographer_sdf {

// Writes the map, with unfinished submaps, or nothing: the file is replaced
// when it is complete.
[[nodiscard]] absl::Status SaveState(
    const std::string& path,
    cartographer::mapping::MapBuilderInterface* map_builder);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_SAVE_STATE_H_
