// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/close_loops_report.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/html_report.h"
#include "cartographer_sdf/report/map_picture.h"
#include "cartographer_sdf/report/submap_pictures.h"

namespace cartographer_sdf {
namespace {

constexpr Color kClosureColor{0.84, 0.15, 0.16, 0.55};
constexpr Color kRefusedColor{0.58, 0.35, 0.75, 0.8};

// What did not go into the graph first, then the least certain: that is where
// one should look.
std::vector<const Closure*> InOrderOfInterest(
    const std::vector<Closure>& closures) {
  std::vector<const Closure*> order;
  for (const Closure& closure : closures) order.push_back(&closure);
  std::stable_sort(order.begin(), order.end(),
                   [](const Closure* a, const Closure* b) {
                     const bool a_in = a->status == ClosureStatus::kInGraph;
                     const bool b_in = b->status == ClosureStatus::kInGraph;
                     if (a_in != b_in) return b_in;
                     return a->match.pair.score < b->match.pair.score;
                   });
  return order;
}

// Those that are not in the graph lie over those that are.
std::vector<SubmapLink> LinksOf(const std::vector<Closure>& closures) {
  std::vector<SubmapLink> links;
  for (const bool in_graph : {true, false}) {
    for (const Closure& closure : closures) {
      if ((closure.status == ClosureStatus::kInGraph) != in_graph) continue;
      links.push_back({closure.match.pair.reference, closure.match.pair.query,
                       in_graph ? kClosureColor : kRefusedColor});
    }
  }
  return links;
}

struct ReadPictures {
  std::vector<ReportedPicture> maps;
  std::map<SubmapId, OccupancyGrid> grids;  // of the pairs to be drawn
};

absl::StatusOr<ReadPictures> PaintMaps(const SubmapsReader& read_submaps,
                                       const ReportOptions& options,
                                       const LoopClosingResult& result,
                                       const std::set<SubmapId>& wanted) {
  ReadPictures pictures;
  const int pixels = options.map_picture_pixels;
  MapPicture before(result.state, result.state.pose_graph, pixels);
  MapPicture after(result.state, result.closed.pose_graph, pixels);
  const absl::Status status = read_submaps(
      [&](const SubmapId& id, const SubmapSummary&, const OccupancyGrid& grid) {
        before.AddSubmap(id, grid);
        after.AddSubmap(id, grid);
        if (wanted.count(id) > 0) pictures.grids.emplace(id, grid);
      });
  if (!status.ok()) return status;
  pictures.maps.push_back(before.Finish("Before", {}));
  pictures.maps.push_back(
      after.Finish("After, with the closures: red in the graph, purple not",
                   LinksOf(result.closed.closures)));
  return pictures;
}

std::string DrawPair(const Match& match,
                     const std::map<SubmapId, OccupancyGrid>& grids,
                     const int max_pixels) {
  const auto reference = grids.find(match.pair.reference);
  const auto query = grids.find(match.pair.query);
  if (reference == grids.end() || query == grids.end()) return "";
  std::vector<PointPair> pairs;
  for (const auto& inlier : match.inliers) {
    pairs.push_back({inlier.first, inlier.second});
  }
  return DrawMatchedPair(reference->second, query->second,
                         match.pair.T_reference_query, pairs, max_pixels)
      .EncodePng();
}

std::string ReasonOf(const Closure& closure) {
  switch (closure.status) {
    case ClosureStatus::kInGraph:
      return absl::StrFormat("in the graph; error %.2f m, %.1f deg",
                             closure.graph_error.translation,
                             closure.graph_error.rotation * 180. / M_PI);
    case ClosureStatus::kInconsistent:
      return "closures with more weight contradict it";
    case ClosureStatus::kUnsupported:
      return "no other closure supports it, and it is not certain alone";
    case ClosureStatus::kScansDisagree:
      return "single scans do not fit where it puts them";
    case ClosureStatus::kOutlier:
      return absl::StrFormat(
          "the optimised map contradicts it, by %.2f m, %.1f deg",
          closure.graph_error.translation,
          closure.graph_error.rotation * 180. / M_PI);
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
  HistogramPlot score_plot;
  score_plot.title = "Scores of the closures";
  score_plot.x.label = "score (log-odds of being right)";
  score_plot.series = {{"in the graph", scores}, {"not", refused_scores}};
  HistogramPlot before;
  before.title = "Residuals of the closures' constraints before";
  before.x.label = "translation [m]";
  before.series = {{"before", ResidualsOf(result, result.state.pose_graph)}};
  HistogramPlot after;
  after.title = "Residuals of the closures' constraints after";
  after.x.label = "translation [m]";
  after.series = {{"after", ResidualsOf(result, result.closed.pose_graph)}};
  return {before, after, score_plot};
}

std::vector<std::string> MakeWarnings(const LoopClosingResult& result) {
  std::vector<std::string> warnings;
  if (Count(result, ClosureStatus::kInGraph) == 0) {
    warnings.push_back("No loop closure was found; the map is as it was.");
  }
  if (const int num_outliers = Count(result, ClosureStatus::kOutlier);
      num_outliers > 0) {
    warnings.push_back(absl::StrCat(
        num_outliers,
        " closures were rejected as outliers because the optimised map "
        "contradicts them: "
        "there are places that look alike. Look at the map where they were."));
  }
  for (const auto& [id, tear] : result.closed.torn_submaps) {
    warnings.push_back(
        absl::StrCat("A submap is torn inside; its closures have zero weight. ",
                     DescribeTear(id, tear)));
  }
  if (!result.closed.optimizations.empty() &&
      !result.closed.optimizations.back().converged) {
    warnings.push_back(
        absl::StrCat("The optimisation did not converge: ",
                     result.closed.optimizations.back().message));
  }
  return warnings;
}

std::vector<std::pair<std::string, std::string>> MakeSummary(
    const LoopClosingResult& result) {
  std::vector<std::pair<std::string, std::string>> summary = {
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
      {"New constraints",
       absl::StrCat(result.closed.pose_graph.constraints.size() -
                    result.state.pose_graph.constraints.size())},
      {"Odometry weights",
       absl::StrFormat("%.3g (translation), %.3g (rotation)",
                       result.optimization.odometry_translation_weight,
                       result.optimization.odometry_rotation_weight)}};
  if (!result.closed.optimizations.empty()) {
    const OptimizationSummary& last = result.closed.optimizations.back();
    summary.emplace_back(
        "Optimisation",
        absl::StrFormat("cost %.4g to %.4g in %d iterations, %d rounds",
                        last.initial_cost, last.final_cost, last.num_iterations,
                        result.closed.optimizations.size()));
  }
  return summary;
}

}  // namespace

absl::Status WriteCloseLoopsReport(const ReportRequest& request,
                                   const std::string& input,
                                   const LoopClosingResult& result,
                                   const SubmapsReader& read_submaps) {
  const std::vector<const Closure*> order =
      InOrderOfInterest(result.closed.closures);
  const size_t num_pictures = std::min(
      order.size(), static_cast<size_t>(request.options.max_closure_pictures));
  std::set<SubmapId> wanted;
  for (size_t k = 0; k < num_pictures; ++k) {
    wanted.insert(order[k]->match.pair.reference);
    wanted.insert(order[k]->match.pair.query);
  }
  absl::StatusOr<ReadPictures> pictures =
      PaintMaps(read_submaps, request.options, result, wanted);
  if (!pictures.ok()) return pictures.status();
  ReportContent content;
  content.title =
      "Loop closures of " + std::filesystem::path(input).filename().string();
  content.subtitle = "Found by the shape of free space, without a pose prior.";
  content.summary = MakeSummary(result);
  content.warnings = MakeWarnings(result);
  content.maps = std::move(pictures->maps);
  for (size_t k = 0; k < order.size(); ++k) {
    ReportedClosure reported;
    reported.match = order[k]->match;
    reported.accepted = order[k]->status == ClosureStatus::kInGraph;
    reported.reason = ReasonOf(*order[k]);
    if (k < num_pictures) {
      reported.png = DrawPair(order[k]->match, pictures->grids,
                              request.options.closure_picture_pixels);
    }
    content.closures.push_back(std::move(reported));
  }
  content.histograms = MakeHistograms(result);
  content.stages = result.stage_seconds;
  content.options = request.options_text;
  return WriteReport(request.directory, content, request.options);
}

}  // namespace cartographer_sdf
