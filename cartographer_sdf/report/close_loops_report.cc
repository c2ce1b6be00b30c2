// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/closure_table.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

std::vector<double> ResidualsOf(const LoopClosingResult& result,
                                const PoseGraph& poses) {
  std::vector<double> residuals;
  for (const Closure& closure : result.closed.closures) {
    for (const Constraint& constraint : closure.constraints) {
      residuals.push_back(ConstraintResidual(poses, constraint).translation);
    }
  }
  return residuals;
}

std::vector<HistogramPlot> ClosureHistograms(const LoopClosingResult& result) {
  std::vector<double> scores, refused_scores;
  for (const Closure& closure : result.closed.closures) {
    (closure.status == ClosureStatus::kInGraph ? scores : refused_scores)
        .push_back(closure.match.pair.score);
  }
  const std::string title = "Residuals of the closures' constraints ";
  const PlotAxis translation = {"translation [m]", {}};
  return {{title + "before",
           translation,
           {{"before", ResidualsOf(result, result.state.pose_graph)}}},
          {title + "after",
           translation,
           {{"after", ResidualsOf(result, result.closed.pose_graph)}}},
          {"Scores of the closures",
           {"score (log-odds of being right)", {}},
           {{"in the graph", scores}, {"not in the graph", refused_scores}}}};
}

// The first of them says how it went.
void JudgeClosing(const LoopClosingResult& result,
                  Inspection* const inspection) {
  const auto count = [&result](const ClosureStatus status) {
    return NumWithStatus(result.closed.closures, status);
  };
  const int num_closures = count(ClosureStatus::kInGraph);
  const int num_known = count(ClosureStatus::kAlreadyInGraph);
  const int num_outliers = count(ClosureStatus::kOutlier);
  if (num_closures > 0) {
    inspection->tone = Tone::kGood;
    inspection->verdict = absl::StrFormat(
        "Loops closed: %s, whose walls agree to %.0f cm.",
        Counted(num_closures, "closure"),
        100. * WallDistanceInGraph(result.closed.closures).value_or(0.));
  } else if (num_known > 0) {
    inspection->verdict = absl::StrFormat(
        "Nothing to close: the map has constraints already that say the same "
        "as %s; %s.",
        Counted(num_known, "closure"), DescribeWithoutClosures(result));
  } else {
    inspection->tone = Tone::kCaution;
    inspection->verdict =
        "No loop closure was found; " + DescribeWithoutClosures(result) + ".";
  }
  if (num_outliers > 0) {
    inspection->tone = Tone::kCaution;
    absl::StrAppend(&inspection->verdict, " ", Counted(num_outliers, "place"),
                    num_outliers == 1 ? " resembles another: look at it."
                                      : " resemble others: look at them.");
    inspection->remarks.push_back(
        absl::StrCat(Counted(num_outliers, "closure"),
                     " looked right, but the optimised map contradicts ",
                     num_outliers == 1 ? "it" : "them",
                     ": the status \"outlier\" in the table."));
  }
}

void AddClosingNumbers(const LoopClosingResult& result,
                       Inspection* const inspection) {
  auto& numbers = inspection->numbers;
  numbers = {
      {"Submaps", absl::StrCat(result.state.submaps.size(), ", ",
                               result.num_places, " of them with walls")},
      {"Nodes", absl::StrCat(result.state.pose_graph.nodes.size())},
      {"Pairs with a pose", absl::StrCat(result.num_matches)},
      {"Passed verification", absl::StrCat(result.closed.closures.size())}};
  for (const RowStatus& status : ClosureStatuses(kClosingPath)) {
    const auto count = std::count_if(
        result.closed.closures.begin(), result.closed.closures.end(),
        [&status](const Closure& closure) {
          return ClosureStatusName(closure.status) == status.name;
        });
    if (count > 0) {
      numbers.emplace_back("Closures: " + status.label, absl::StrCat(count));
    }
  }
  numbers.emplace_back(
      "New constraints",
      absl::StrCat(result.closed.pose_graph.constraints.size() -
                   result.state.pose_graph.constraints.size()));
  AddDisplacement(inspection);
  AddOptimization(result.optimization, result.closed.optimizations, inspection);
}

}  // namespace

absl::Status WriteCloseLoopsReport(const ReportRequest& request,
                                   const LoopClosingOptions& options,
                                   const std::string& input,
                                   const LoopClosingResult& result,
                                   const SubmapsReader& read_submaps) {
  Inspection inspection;
  inspection.title = "Loop closures of " + FileName(input);
  inspection.sessions = {{FileName(input)}};
  inspection.states = {
      {"before", "Before", "The map as it was", &result.state.pose_graph},
      {"after", "After", "The map with its loops closed",
       &result.closed.pose_graph}};
  AddSubmaps(result.state, &inspection);
  JudgeClosing(result, &inspection);
  AddClosingNumbers(result, &inspection);
  AddTornSubmaps(result.closed.torn_submaps, &inspection);
  AddSlips(result.closed.slips, result.state.pose_graph, &inspection);
  inspection.tables = {
      MakeClosureTable(options, result.closed.closures, result.refused)};
  inspection.histograms = ClosureHistograms(result);
  inspection.stage_seconds = result.stage_seconds;
  const absl::Status status =
      DrawInspection(request.options, read_submaps, &inspection);
  if (!status.ok()) return status;
  return WriteInspector(request, inspection);
}

}  // namespace cartographer_sdf
