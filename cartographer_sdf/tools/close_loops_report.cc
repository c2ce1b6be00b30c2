// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/close_loops_report.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/html_report.h"
#include "cartographer_sdf/report/submap_pictures.h"
#include "cartographer_sdf/tools/map_picture.h"

namespace cartographer_sdf {
namespace {

constexpr Color kClosureColor{0.84, 0.15, 0.16, 0.55};
constexpr Color kRefusedColor{0.58, 0.35, 0.75, 0.8};

// What did not go into the graph first, then the least certain: that is where
// one should look.
std::vector<const ClosureOutcome*> InOrderOfInterest(
    const std::vector<ClosureOutcome>& closures) {
  std::vector<const ClosureOutcome*> order;
  for (const ClosureOutcome& outcome : closures) order.push_back(&outcome);
  std::stable_sort(order.begin(), order.end(),
                   [](const ClosureOutcome* a, const ClosureOutcome* b) {
                     const bool a_in = a->fate == Fate::kInGraph;
                     const bool b_in = b->fate == Fate::kInGraph;
                     if (a_in != b_in) return b_in;
                     return a->match.closure.score < b->match.closure.score;
                   });
  return order;
}

// Those that are not in the graph lie over those that are.
std::vector<SubmapLink> LinksOf(const std::vector<ClosureOutcome>& closures) {
  std::vector<SubmapLink> links;
  for (const bool in_graph : {true, false}) {
    for (const ClosureOutcome& outcome : closures) {
      if ((outcome.fate == Fate::kInGraph) != in_graph) continue;
      links.push_back({outcome.match.closure.reference,
                       outcome.match.closure.query,
                       in_graph ? kClosureColor : kRefusedColor});
    }
  }
  return links;
}

struct ReadPictures {
  std::vector<ReportedPicture> maps;
  std::map<SubmapId, OccupancyGrid> grids;  // of the pairs to be drawn
};

absl::StatusOr<ReadPictures> PaintMaps(const std::string& input,
                                       const Options& options,
                                       const LoopClosingResult& result,
                                       const std::set<SubmapId>& wanted,
                                       const ProgressCallback& on_progress) {
  ReadPictures pictures;
  const int pixels = options.report.map_picture_pixels;
  MapPicture before(result.state, result.state.pose_graph, pixels);
  MapPicture after(result.state, result.pose_graph, pixels);
  const absl::StatusOr<MapState> read = ReadMap(
      input,
      [&](const SubmapId& id, const SubmapSummary&, const OccupancyGrid& grid) {
        before.AddSubmap(id, grid);
        after.AddSubmap(id, grid);
        if (wanted.count(id) > 0) pictures.grids.emplace(id, grid);
      },
      on_progress);
  if (!read.ok()) return read.status();
  pictures.maps.push_back(before.Finish("Before", {}));
  pictures.maps.push_back(
      after.Finish("After, with the closures: red in the graph, purple not",
                   LinksOf(result.closures)));
  return pictures;
}

std::string DrawPair(const Match& match,
                     const std::map<SubmapId, OccupancyGrid>& grids,
                     const int max_pixels) {
  const auto reference = grids.find(match.closure.reference);
  const auto query = grids.find(match.closure.query);
  if (reference == grids.end() || query == grids.end()) return "";
  std::vector<PointPair> pairs;
  for (const auto& inlier : match.inliers) {
    pairs.push_back({inlier.first, inlier.second});
  }
  return DrawMatchedPair(reference->second, query->second,
                         match.closure.T_reference_query, pairs, max_pixels)
      .EncodePng();
}

std::string ReasonOf(const ClosureOutcome& outcome) {
  switch (outcome.fate) {
    case Fate::kInGraph:
      return absl::StrFormat("in the graph; residual %.2f m, %.1f deg",
                             outcome.error.translation,
                             outcome.error.rotation * 180. / M_PI);
    case Fate::kContradicted:
      return "closures with more weight contradict it";
    case Fate::kUnsupported:
      return "no other closure supports it, and it is not certain alone";
    case Fate::kScansDisagree:
      return "single scans do not fit where it puts them";
    case Fate::kWithdrawn:
      return absl::StrFormat(
          "the optimised map contradicts it, by %.2f m, %.1f deg",
          outcome.error.translation, outcome.error.rotation * 180. / M_PI);
  }
  return "";
}

int Count(const LoopClosingResult& result, const Fate fate) {
  return static_cast<int>(std::count_if(
      result.closures.begin(), result.closures.end(),
      [fate](const ClosureOutcome& outcome) { return outcome.fate == fate; }));
}

std::vector<double> ResidualsOf(const LoopClosingResult& result,
                                const PoseGraph& poses) {
  std::vector<double> residuals;
  for (const ClosureOutcome& outcome : result.closures) {
    for (const Constraint& constraint : outcome.constraints) {
      residuals.push_back(ConstraintResidual(poses, constraint).translation);
    }
  }
  return residuals;
}

std::vector<HistogramPlot> MakeHistograms(const LoopClosingResult& result) {
  std::vector<double> scores, refused_scores;
  for (const ClosureOutcome& outcome : result.closures) {
    (outcome.fate == Fate::kInGraph ? scores : refused_scores)
        .push_back(outcome.match.closure.score);
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
  after.series = {{"after", ResidualsOf(result, result.pose_graph)}};
  return {before, after, score_plot};
}

std::vector<std::string> MakeWarnings(const LoopClosingResult& result) {
  std::vector<std::string> warnings;
  if (Count(result, Fate::kInGraph) == 0) {
    warnings.push_back("No loop closure was found; the map is as it was.");
  }
  if (const int withdrawn = Count(result, Fate::kWithdrawn); withdrawn > 0) {
    warnings.push_back(absl::StrCat(
        withdrawn,
        " closures were withdrawn because the optimised map contradicts them: "
        "there are places that look alike. Look at the map where they were."));
  }
  for (const auto& [id, tear] : result.torn_submaps) {
    warnings.push_back(
        absl::StrCat("A submap is torn inside, and kept from "
                     "voting. ",
                     DescribeTear(id, tear)));
  }
  if (!result.optimizations.empty() && !result.optimizations.back().converged) {
    warnings.push_back(absl::StrCat("The optimisation did not converge: ",
                                    result.optimizations.back().message));
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
      {"Accepted by verification", absl::StrCat(result.closures.size())},
      {"Closures in the graph", absl::StrCat(Count(result, Fate::kInGraph))},
      {"Torn submaps", absl::StrCat(result.torn_submaps.size())},
      {"Contradicted by others",
       absl::StrCat(Count(result, Fate::kContradicted))},
      {"Unsupported", absl::StrCat(Count(result, Fate::kUnsupported))},
      {"Scans disagree", absl::StrCat(Count(result, Fate::kScansDisagree))},
      {"Withdrawn", absl::StrCat(Count(result, Fate::kWithdrawn))},
      {"New constraints",
       absl::StrCat(result.pose_graph.constraints.size() -
                    result.state.pose_graph.constraints.size())},
      {"Odometry weights",
       absl::StrFormat("%.3g (translation), %.3g (rotation)",
                       result.optimization.odometry_translation_weight,
                       result.optimization.odometry_rotation_weight)}};
  if (!result.optimizations.empty()) {
    const OptimizationSummary& last = result.optimizations.back();
    summary.emplace_back(
        "Optimisation",
        absl::StrFormat("cost %.4g to %.4g in %d iterations, %d rounds",
                        last.initial_cost, last.final_cost, last.num_iterations,
                        result.optimizations.size()));
  }
  return summary;
}

}  // namespace

absl::Status WriteCloseLoopsReport(const std::string& directory,
                                   const std::string& input,
                                   const Options& options,
                                   const LoopClosingResult& result,
                                   const ProgressCallback& on_progress) {
  const std::vector<const ClosureOutcome*> order =
      InOrderOfInterest(result.closures);
  const size_t num_pictures = std::min(
      order.size(), static_cast<size_t>(options.report.max_closure_pictures));
  std::set<SubmapId> wanted;
  for (size_t k = 0; k < num_pictures; ++k) {
    wanted.insert(order[k]->match.closure.reference);
    wanted.insert(order[k]->match.closure.query);
  }
  absl::StatusOr<ReadPictures> pictures =
      PaintMaps(input, options, result, wanted, on_progress);
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
    reported.closure = order[k]->match.closure;
    reported.accepted = order[k]->fate == Fate::kInGraph;
    reported.reason = ReasonOf(*order[k]);
    if (k < num_pictures) {
      reported.png = DrawPair(order[k]->match, pictures->grids,
                              options.report.closure_picture_pixels);
    }
    content.closures.push_back(std::move(reported));
  }
  content.histograms = MakeHistograms(result);
  for (const auto& [stage, seconds] : result.stage_seconds) {
    content.stages.push_back({stage, seconds});
  }
  content.options = FormatOptions(options);
  return WriteReport(directory, content, options.report);
}

}  // namespace cartographer_sdf
