// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A whole map as the two files that ROS's map_server and Nav2 load, in the form
// in which cartographer_ros writes them (pbstream_to_ros_map).

#ifndef CARTOGRAPHER_SDF_REPORT_ROS_MAP_H_
#define CARTOGRAPHER_SDF_REPORT_ROS_MAP_H_

#include <string>

#include "cartographer_sdf/report/map_painter.h"

namespace cartographer_sdf {

struct RosMap {
  std::string pgm;   // binary PGM (P5), 8 bit
  std::string yaml;  // names the image
  int num_occupied = 0;
  int num_free = 0;
  int num_unknown = 0;
};

// The map that was painted, trinary: walls are 0, free space 254, what is
// unknown 205. A pixel is a wall if its mean probability, over all submaps,
// exceeds 1/2. The origin in the YAML file is the outer corner of the lower
// left pixel in the map frame [m]. `image` is the name of the PGM file.
[[nodiscard]] RosMap MakeRosMap(const MapPainter& painter,
                                const std::string& image);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_ROS_MAP_H_
