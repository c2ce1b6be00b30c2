// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The pictures of an inspection: whole maps in one frame and scale, and the
// submaps that its rows name.

#ifndef CARTOGRAPHER_SDF_REPORT_INSPECTION_MAPS_H_
#define CARTOGRAPHER_SDF_REPORT_INSPECTION_MAPS_H_

#include <functional>
#include <map>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/inspection.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// Reads the map that a report is about and calls back for each of its submaps,
// as ReadMap() and PrepareMap() do.
using SubmapsReader = std::function<absl::Status(const SubmapCallback&)>;

// The submaps at their poses in `pose_graph`.
[[nodiscard]] std::vector<PlacedGrid> PlaceGrids(const MapState& state,
                                                 const PoseGraph& pose_graph);

// The positions of each trajectory's nodes, in order.
[[nodiscard]] std::map<int, std::vector<Eigen::Vector2d>> PathsOf(
    const PoseGraph& pose_graph);

// Fills Inspection::drawn, and where the walls of each row's pair overlap.
// Submaps get a picture in the order of the rows, up to the number in the
// options. Calls the reader once, also where nothing is drawn.
[[nodiscard]] absl::Status DrawInspection(const ReportOptions& options,
                                          const SubmapsReader& read_submaps,
                                          Inspection* inspection);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_INSPECTION_MAPS_H_
