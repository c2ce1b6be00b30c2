// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_MAP_PICTURE_H_
#define CARTOGRAPHER_SDF_TOOLS_MAP_PICTURE_H_

#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/picture.h"

namespace cartographer_sdf {

// What was painted, with the driven path of each trajectory in its colour.
[[nodiscard]] Picture PaintWithPaths(const MapPainter& painter,
                                     const PoseGraph& pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_MAP_PICTURE_H_
