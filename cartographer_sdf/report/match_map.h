// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One match on the map that it was found in ([Millane2019], Fig. 1 and 8).

#ifndef CARTOGRAPHER_SDF_REPORT_MATCH_MAP_H_
#define CARTOGRAPHER_SDF_REPORT_MATCH_MAP_H_

#include <vector>

#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/submap_pictures.h"

namespace cartographer_sdf {

struct ShownSubmap {
  DistanceField field;
  Rigid2 T_map_submap;
};

struct ShownMatch {
  ShownSubmap reference;
  ShownSubmap query;
  std::vector<PointPair> inliers;  // each in its own submap frame
};

struct ShownPath {
  std::vector<Eigen::Vector2d> positions;  // in the frame of the picture [m]
  bool is_query = false;
};

// The map, pale; paths of the reference blue, of the query red; the two submaps
// as distance functions, the reference's blue, the query's red, darker where
// walls are far; lines between the features that agree, black.
[[nodiscard]] Picture DrawMatchOnMap(const MapPainter& map,
                                     const std::vector<ShownPath>& paths,
                                     const ShownMatch& match);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MATCH_MAP_H_
