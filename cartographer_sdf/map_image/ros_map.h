// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Maps of ROS's map_server, as amcl, nav2 and slam_toolbox use them: an image
// with a YAML file that says what it means.

#ifndef CARTOGRAPHER_SDF_MAP_IMAGE_ROS_MAP_H_
#define CARTOGRAPHER_SDF_MAP_IMAGE_ROS_MAP_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// Whether the name is that of a ROS map: .yaml, .yml, .pgm or .png.
[[nodiscard]] bool IsRosMapName(const std::string& path);

// Reads a map by the name of its YAML file, or of its image, whose YAML file
// has the same name but for the extension. Members as in map_server: image,
// resolution, origin, negate, occupied_thresh, free_thresh, mode (trinary,
// scale or raw). The submap frame of the grid is the map frame. Any bytes yield
// a map or an error of one sentence.
[[nodiscard]] absl::StatusOr<OccupancyGrid> ReadRosMap(const std::string& path);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MAP_IMAGE_ROS_MAP_H_
