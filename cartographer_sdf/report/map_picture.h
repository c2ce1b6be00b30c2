// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_MAP_PICTURE_H_
#define CARTOGRAPHER_SDF_REPORT_MAP_PICTURE_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/report/html_report.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/picture.h"

namespace cartographer_sdf {

// A line between two submaps, from where the robot was to where it was.
struct SubmapLink {
  SubmapId from;
  SubmapId to;
  Color color;
};

// Reads the map that a report is about and calls back for each of its submaps,
// as ReadMap() and PrepareMap() do.
using SubmapsReader = std::function<absl::Status(const SubmapCallback&)>;

// The path of each trajectory, in the colour of its number.
void DrawPaths(const PoseGraph& pose_graph, const PixelFrame& frame,
               Picture* picture);

// Where the robot was in the middle of each submap, in the submap's frame: the
// mean of its nodes; the origin where it has none.
[[nodiscard]] std::map<SubmapId, Eigen::Vector2d> SubmapCentres(
    const PoseGraph& pose_graph);

// One map as a picture, with the paths that were driven and links of submaps.
class MapPicture {
 public:
  // Shows the submaps of `state` where `pose_graph`, which must outlive this,
  // has them.
  MapPicture(const MapState& state, const PoseGraph& pose_graph,
             int max_pixels);

  // To be called for each submap; none is kept.
  void AddSubmap(const SubmapId& id, const OccupancyGrid& grid);

  // Later links are drawn over earlier ones.
  [[nodiscard]] ReportedPicture Finish(
      const std::string& caption, const std::vector<SubmapLink>& links) const;

 private:
  const PoseGraph& pose_graph_;
  MapPainter painter_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MAP_PICTURE_H_
