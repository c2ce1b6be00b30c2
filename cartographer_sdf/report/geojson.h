// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_GEOJSON_H_
#define CARTOGRAPHER_SDF_REPORT_GEOJSON_H_

#include <string>

#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Where the map frame lies on the earth.
struct GeoOrigin {
  double latitude = 0.;   // [degrees], within 89 of the equator
  double longitude = 0.;  // [degrees]
  // Of the map frame's x axis, counterclockwise from east [degrees].
  double bearing = 0.;
};

// GeoJSON [RFC7946] that viewers of maps open: a line for the path of each
// trajectory ("kind": "path"), and one from submap to node for each
// inter-submap constraint ("kind": "closure"). Degrees of the WGS 84 ellipsoid,
// in the plane that touches it at the origin: good to a millimetre or so within
// a kilometre, and a metre within 10 km. Metres are among the properties.
[[nodiscard]] std::string FormatGeoJson(const PoseGraph& pose_graph,
                                        const GeoOrigin& origin);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_GEOJSON_H_
