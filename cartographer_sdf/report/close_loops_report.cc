// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr Color kClosureColor{0.84, 0.15, 0.16, 0.55};
constexpr Color kRefusedColor{0.58, 0.35, 0.75, 0.8};

std::string ReasonOf(const Closure& closure) {
  switch (closure.status) {
    case ClosureStatus::kInGraph:
      return "in the graph; error " + FormatError(closure.graph_error);
    case ClosureStatus::kInconsistent:
      return "closures with more weight contradict it";
    case ClosureStatus::kUnsupported:
      return "no other closure supports it, and it is not certain alone";
    case ClosureStatus::kScansDisagree:
      return "single scans do not fit at its pose";
    case ClosureStatus::kOutlier:
      return "the optimised map contradicts it, by " +
             FormatError(closure.graph_error);
    case ClosureStatus::kAlreadyInGraph:
      return "constraints of the map say the same already";
    case ClosureStatus::kRedundant:
      return "better closures tie its submaps often enough";
    case ClosureStatus::kSelected:
    case ClosureStatus::kReady:
    case ClosureStatus::kDetectedOnly:
    case ClosureStatus::kGone:
      break;
  }
  return ClosureStatusName(closure.status);
}

int Count(const LoopClosingResult& result, const ClosureStatus status) {
  return static_cast<int>(std::count_if(
      result.closed.closures.begin(), result.closed.closures.end(),
      [status](const Closure& closure) { return closure.status == status; }));
}

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

std::vector<HistogramPlot> MakeHistograms(const LoopClosingResult& result) {
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
           {{"in the graph", scores}, {"refused", refused_scores}}}};
}

std::vector<std::pair<std::string, std::string>> MakeSummary(
    const LoopClosingResult& result) {
  return {
      {"Submaps", absl::StrCat(result.state.submaps.size(), ", ",
                               result.num_places, " of them with walls")},
      {"Nodes", absl::StrCat(result.state.pose_graph.nodes.size())},
      {"Pairs with a pose", absl::StrCat(result.num_matches)},
      {"Accepted by verification", absl::StrCat(result.closed.closures.size())},
      {"Closures in the graph",
       absl::StrCat(Count(result, ClosureStatus::kInGraph))},
      {"Torn submaps", absl::StrCat(result.closed.torn_submaps.size())},
      {"Inconsistent with others",
       absl::StrCat(Count(result, ClosureStatus::kInconsistent))},
      {"Unsupported", absl::StrCat(Count(result, ClosureStatus::kUnsupported))},
      {"Scans disagree",
       absl::StrCat(Count(result, ClosureStatus::kScansDisagree))},
      {"Outliers", absl::StrCat(Count(result, ClosureStatus::kOutlier))},
      {"Already in the graph",
       absl::StrCat(Count(result, ClosureStatus::kAlreadyInGraph))},
      {"Redundant", absl::StrCat(Count(result, ClosureStatus::kRedundant))},
      {"New constraints",
       absl::StrCat(result.closed.pose_graph.constraints.size() -
                    result.state.pose_graph.constraints.size())}};
}

// The content without pictures.
ReportContent MakeText(const std::string& input,
                       const LoopClosingResult& result) {
  ReportContent content;
  content.title = "Loop closures of " + FileName(input);
  content.subtitle =
      "Found from the shape of free space, without a pose prior.";
  if (Count(result, ClosureStatus::kInGraph) == 0) {
    content.warnings.push_back(
        "No loop closure was found; the map is unchanged.");
  }
  if (const int num_outliers = Count(result, ClosureStatus::kOutlier);
      num_outliers > 0) {
    content.warnings.push_back(absl::StrCat(
        num_outliers,
        " closures were rejected as outliers because the optimised map "
        "contradicts them: some places look alike. Check the map there."));
  }
  AddTornSubmaps(result.closed.torn_submaps, &content);
  content.summary = MakeSummary(result);
  AddOptimization(result.optimization, result.closed.optimizations, &content);
  for (const Closure& closure : result.closed.closures) {
    const bool in_graph = closure.status == ClosureStatus::kInGraph;
    content.closures.push_back({closure.match,
                                in_graph,
                                {},
                                ReasonOf(closure),
                                in_graph ? kClosureColor : kRefusedColor,
                                {}});
  }
  SortByInterest(&content.closures);
  content.histograms = MakeHistograms(result);
  content.stages = result.stage_seconds;
  return content;
}

}  // namespace

absl::Status WriteCloseLoopsReport(const ReportRequest& request,
                                   const std::string& input,
                                   const LoopClosingResult& result,
                                   const SubmapsReader& read_submaps) {
  ReportContent content = MakeText(input, result);
  content.options = request.options_text;
  const absl::Status status = DrawPictures(
      {{"Before", &result.state, &result.state.pose_graph},
       {"After, with the closures: red in the graph, purple refused",
        &result.state, &result.closed.pose_graph, /*shows_links=*/true}},
      read_submaps, request.options, &content);
  if (!status.ok()) return status;
  return WriteReport(request.directory, content);
}

}  // namespace cartographer_sdf
