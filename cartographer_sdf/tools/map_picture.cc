// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/map_picture.h"

#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {

Picture PaintWithPaths(const MapPainter& painter, const PoseGraph& pose_graph) {
  Picture picture = painter.Paint();
  int color = 0;
  for (const auto& [trajectory, path] : PathsOf(pose_graph)) {
    DrawTrajectory(path, painter.frame(), CategoryColor(color++), &picture);
  }
  return picture;
}

}  // namespace cartographer_sdf
