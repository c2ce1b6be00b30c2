// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The pages of --report, the table of audit, and the parts that pages about
// maps share: pictures and lines of the summary.

#ifndef CARTOGRAPHER_SDF_REPORT_REPORTS_H_
#define CARTOGRAPHER_SDF_REPORT_REPORTS_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/apps/audit.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/apps/merge.h"
#include "cartographer_sdf/closing/torn_submaps.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/report/html_report.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// A line between the robot's positions in two submaps.
struct SubmapLink {
  SubmapId from;
  SubmapId to;
  Color color;
};

// A whole map with the driven paths: the submaps of `state` at their poses in
// `pose_graph`. Both must outlive the MapPicture.
struct MapPicture {
  std::string caption;
  const MapState* state = nullptr;
  const PoseGraph* pose_graph = nullptr;
  // Whether to draw the links of the page's closures, the first one last, above
  // `other_links`.
  bool shows_links = false;
  std::vector<SubmapLink> other_links = {};
  // If several maps are overlaid, each in its colour: the map that each
  // trajectory belongs to. Empty for a single map.
  std::map<int, int> layers = {};
};

// Reads the map that a report is about and calls back for each of its submaps,
// as ReadMap() and PrepareMap() do.
using SubmapsReader = std::function<absl::Status(const SubmapCallback&)>;

// The submaps at their poses in `pose_graph`.
[[nodiscard]] std::vector<PlacedGrid> PlaceGrids(const MapState& state,
                                                 const PoseGraph& pose_graph);

// The positions of each trajectory's nodes, in order.
[[nodiscard]] std::map<int, std::vector<Eigen::Vector2d>> PathsOf(
    const PoseGraph& pose_graph);

// Adds the pictures of maps and, up to the number in the options, those of the
// page's closures. Calls the reader once.
[[nodiscard]] absl::Status DrawPictures(const std::vector<MapPicture>& maps,
                                        const SubmapsReader& read_submaps,
                                        const ReportOptions& options,
                                        ReportContent* content);

// Sorts closures by how much they deserve a look: refused ones first, then by
// increasing certainty.
void SortByInterest(std::vector<ReportedClosure>* closures);

[[nodiscard]] std::string FileName(const std::string& path);
[[nodiscard]] std::string FormatPose(const Rigid2& pose);
[[nodiscard]] std::string FormatError(const ConstraintError& error);

// Adds the page's text about the last optimisation, if there is one.
void AddOptimization(const OptimizationOptions& options,
                     const std::vector<OptimizationSummary>& summaries,
                     ReportContent* content);
void AddTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps,
                    ReportContent* content);

// --- The pages, in request.directory. ---

// The map before and after, every closure with its evidence, residuals, and the
// durations of the stages. Calls the reader once. `input` is the map's name.
[[nodiscard]] absl::Status WriteCloseLoopsReport(
    const ReportRequest& request, const std::string& input,
    const LoopClosingResult& result, const SubmapsReader& read_submaps);

// The map before and after, and each group with a doubtful constraint, drawn at
// the constraints' own pose, with its evidence. Calls the reader once.
[[nodiscard]] absl::Status WriteAuditReport(const ReportRequest& request,
                                            const std::string& input,
                                            const Audit& audit,
                                            const SubmapsReader& read_submaps);

// CSV with a line for each inter-submap constraint, in the file's order: its
// index among all constraints of the file, its ends and pose (submap <- node),
// the group that it was judged with (numbered from 0) and the group's pose
// (reference <- query), verdict and evidence. Values that an unchecked
// constraint lacks are empty.
[[nodiscard]] absl::Status WriteAuditTable(const std::string& path,
                                           const Audit& audit);

// Both maps, overlaid where the query was found or fits best; the matches, and
// their contradictions.
[[nodiscard]] absl::Status WriteRelocalizationReport(
    const ReportRequest& request, const Session& map, const Session& query,
    const Localization& result, const ProgressCallback& on_progress);

// The map with every candidate as an arrow with its probability, and the scans
// at the best ones.
[[nodiscard]] absl::Status WriteScanReport(const ReportRequest& request,
                                           const std::string& map_name,
                                           const std::string& scan_name,
                                           const OccupancyGrid& grid,
                                           const std::vector<RobotScan>& scans,
                                           const ScanLocalization& result);

[[nodiscard]] absl::Status WriteMergingReport(
    const ReportRequest& request, const MergingResult& result,
    const ProgressCallback& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_REPORTS_H_
