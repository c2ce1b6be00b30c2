// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The pages of --report, and the table of audit.

#ifndef CARTOGRAPHER_SDF_REPORT_REPORTS_H_
#define CARTOGRAPHER_SDF_REPORT_REPORTS_H_

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
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/pose_graph/slips.h"
#include "cartographer_sdf/report/inspection.h"
#include "cartographer_sdf/report/inspection_maps.h"
#include "cartographer_sdf/report/inspector_page.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

[[nodiscard]] std::string FileName(const std::string& path);
[[nodiscard]] std::string FormatPose(const Rigid2& pose);
// "1 closure", "3 closures".
[[nodiscard]] std::string Counted(size_t count, const std::string& noun);

// --- What several pages add to an inspection. ---

// All submaps of a map, of one session.
void AddSubmaps(const MapState& state, Inspection* inspection);
// How far the map moved.
void AddDisplacement(Inspection* inspection);
// The last optimisation, if there is one, and a remark if it did not converge.
void AddOptimization(const OptimizationOptions& options,
                     const std::vector<OptimizationSummary>& summaries,
                     Inspection* inspection);
// A remark, and the flaw of the submap.
void AddTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps,
                    Inspection* inspection);

// A remark, and the flaw of the submaps that hold slips.
void AddSlips(const Slips& slips, const PoseGraph& pose_graph,
              Inspection* inspection);

// --- The pages, in request.directory. ---

// The map before and after, every closure with its evidence, and the best of
// the matches that were refused. Calls the reader once. `input` is the map's
// name; the options are those in force.
[[nodiscard]] absl::Status WriteCloseLoopsReport(
    const ReportRequest& request, const LoopClosingOptions& options,
    const std::string& input, const LoopClosingResult& result,
    const SubmapsReader& read_submaps);

// The map before and after, and each group of constraints at its own pose, with
// its evidence. Calls the reader once.
[[nodiscard]] absl::Status WriteAuditReport(const ReportRequest& request,
                                            const LoopClosingOptions& stages,
                                            const AuditOptions& options,
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

// Both maps, overlaid where the query was found or fits best; every placement
// with its probability; the matches, and their contradictions.
[[nodiscard]] absl::Status WriteRelocalizationReport(
    const ReportRequest& request, const LoopClosingOptions& stages,
    const LocalizationOptions& options, const Session& map,
    const Session& query, const Localization& result,
    const ProgressCallback& on_progress);

// The map with every candidate as an arrow with its probability, and the scans
// at the best ones.
[[nodiscard]] absl::Status WriteScanReport(
    const ReportRequest& request, const ScanLocalizationOptions& options,
    const std::string& map_name, const std::string& scan_name,
    const OccupancyGrid& grid, const std::vector<RobotScan>& scans,
    const ScanLocalization& result);

// The sessions where they were placed, and as they were optimised together.
[[nodiscard]] absl::Status WriteMergingReport(
    const ReportRequest& request, const LoopClosingOptions& stages,
    const MergingResult& result, const ProgressCallback& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_REPORTS_H_
