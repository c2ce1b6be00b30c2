// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/ros_map.h"

#include <optional>

#include "absl/strings/str_format.h"

namespace cartographer_sdf {
namespace {

// Of map_saver; map_server knows them again by the thresholds below.
constexpr char kOccupied = 0;
constexpr char kFree = static_cast<char>(254);
constexpr char kUnknownGrey = static_cast<char>(205);

// YAML reads a name in double quotes with the escapes of C.
std::string QuoteYaml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

RosMap MakeRosMap(const MapPainter& painter, const std::string& image) {
  const double resolution = 1. / painter.frame().pixels_per_meter;
  const Eigen::Array2i size = painter.size();
  RosMap map;
  map.pgm =
      absl::StrFormat("P5\n# Cartographer map; %.6g m/pixel\n%d %d\n255\n",
                      resolution, size.x(), size.y());
  for (int y = 0; y < size.y(); ++y) {
    for (int x = 0; x < size.x(); ++x) {
      const std::optional<double> excess = painter.ExcessAt(x, y);
      map.pgm += !excess ? kUnknownGrey : *excess > 0. ? kOccupied : kFree;
      ++(!excess        ? map.num_unknown
         : *excess > 0. ? map.num_occupied
                        : map.num_free);
    }
  }
  const Eigen::Vector2d& top_left = painter.frame().top_left;
  map.yaml = absl::StrFormat(
      "image: %s\nmode: trinary\nresolution: %.6g\norigin: [%.9g, %.9g, 0.0]\n"
      "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
      QuoteYaml(image), resolution, top_left.x(),
      top_left.y() - size.y() * resolution);
  return map;
}

}  // namespace cartographer_sdf
