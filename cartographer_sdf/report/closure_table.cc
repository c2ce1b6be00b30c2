// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/closure_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/localization/probability.h"

namespace cartographer_sdf {
namespace {

using Bound = Measure::Bound;

constexpr double kPercent = 100.;
constexpr double kDegreesPerRadian = 180. / M_PI;

std::vector<Measure> ErrorMeasures(const OutlierRejectionOptions& outliers) {
  const std::string path = absl::StrCat(kClosingPath, ".outlier_rejection.");
  return {{"error", "error in map", "m", 3,
           "How far its constraints are from what they claim in the optimised "
           "map, on average.",
           true, Bound::kAtMost, outliers.max_translation_error_meters,
           path + "max_translation_error_meters"},
          {"rotation_error", "rotation error", "deg", 2,
           "The same of its rotation.", false, Bound::kAtMost,
           kDegreesPerRadian * outliers.max_rotation_error,
           path + "max_rotation_error"},
          {"constraints", "constraints", "", 0,
           "Scans that were registered between the two submaps; each is a "
           "constraint of the pose graph."}};
}

InspectedRow RowOf(const Closure& closure) {
  InspectedRow row;
  row.status = ClosureStatusName(closure.status);
  row.pair = closure.match.pair;
  row.values = MatchValues(closure.match);
  const bool has_error = closure.status == ClosureStatus::kInGraph ||
                         closure.status == ClosureStatus::kOutlier;
  const auto if_measured = [has_error](const double value) {
    return has_error ? std::make_optional(value) : std::nullopt;
  };
  row.values.push_back(if_measured(closure.graph_error.translation));
  row.values.push_back(
      if_measured(kDegreesPerRadian * closure.graph_error.rotation));
  row.values.push_back(closure.constraints.empty()
                           ? std::nullopt
                           : std::make_optional(static_cast<double>(
                                 closure.constraints.size())));
  return row;
}

InspectedRow RowOf(const Match& refused) {
  InspectedRow row;
  row.status = VerdictName(refused.verdict);
  row.pair = refused.pair;
  row.values = MatchValues(refused);
  row.values.resize(row.values.size() + 3);
  return row;
}

void SortByScore(const bool best_first, std::vector<InspectedRow>* const rows) {
  std::stable_sort(rows->begin(), rows->end(),
                   [best_first](const InspectedRow& a, const InspectedRow& b) {
                     return best_first ? ScoreOf(a) > ScoreOf(b)
                                       : ScoreOf(a) < ScoreOf(b);
                   });
}

// How far down rows of a tone are: what deserves a look first, what came to
// nothing last.
int RankOf(const Tone tone) {
  return tone == Tone::kBad       ? 0
         : tone == Tone::kCaution ? 1
         : tone == Tone::kGood    ? 2
                                  : 3;
}

}  // namespace

LeastScore LeastScoreOf(const RecognitionOptions& options) {
  if (!options.verify_neighbourhoods) {
    return {options.match.verification.judgement.min_score,
            absl::StrCat(kJudgementPath, ".min_score")};
  }
  return {options.support.min_supported_score,
          absl::StrCat(kRecognitionPath, ".support.min_supported_score")};
}

// Long: a list of all.
std::vector<Measure> MatchMeasures(const JudgementOptions& judgement,
                                   const std::string& path,
                                   const LeastScore& least_score) {
  const auto option = [&path](const char* const name) {
    return absl::StrCat(path, ".", name);
  };
  return {
      {"probability", "probability", "%", 1,
       "Of being right, as the score says; what supports a match counts beside "
       "it.",
       true, Bound::kAtLeast, kPercent * ProbabilityOf(least_score.score),
       least_score.option},
      {"score", "score", "", 2,
       "Log-odds of being right, from the walls of both submaps and of those "
       "around them.",
       false, Bound::kAtLeast, least_score.score, least_score.option},
      {"margin", "lead over other poses", "", 2,
       "By how much the score exceeds that of the best other pose of the "
       "pair.",
       false, Bound::kAtLeast, judgement.min_margin, option("min_margin")},
      {"contradiction_ratio", "contradictions", "%", 1,
       "Wall points that stand in the free space of the other submap, in the "
       "worse direction.",
       true, Bound::kAtMost, kPercent * judgement.max_contradiction_ratio,
       option("max_contradiction_ratio")},
      {"hit_ratio", "walls that agree", "%", 1,
       "Wall points that lie on a wall of the other submap, in the worse "
       "direction."},
      {"wall_distance", "wall distance", "m", 3,
       "Root mean square distance of the walls that agree."},
      {"overlap_area", "common area", "m\xC2\xB2", 1,
       "What both submaps have observed.", false, Bound::kAtLeast,
       judgement.min_overlap_area, option("min_overlap_area")},
      {"overlap", "overlap", "%", 0, "The common area, of the smaller submap.",
       true},
      {"scatter", "wall directions", "", 3,
       "0 where all walls face one way, so that one submap could slide along "
       "them; at most 0.5.",
       false, Bound::kAtLeast, judgement.min_scatter_eigenvalue,
       option("min_scatter_eigenvalue")},
      {"inliers", "features", "", 0,
       "Keypoints of both submaps that agree with the pose."},
      {"confirming", "confirming neighbours", "", 1,
       "Pairs of neighbouring submaps that were found where this pose puts "
       "them, counted by the ground that they show."},
      {"refuting", "refuting neighbours", "", 1,
       "Pairs of neighbouring submaps that were found elsewhere, counted by "
       "their probability."},
      {"supporting", "supporting matches", "", 0,
       "Certain matches of submaps around these that put them where this one "
       "does. A score that is not certain needs one."},
      {"opposing", "opposing matches", "", 0,
       "Certain matches of submaps around these that put them elsewhere. More "
       "than twice as many as support the match refuse it."}};
}

std::vector<std::optional<double>> MatchValues(const Match& match) {
  const PairEvidence& evidence = match.evidence;
  const auto of_neighbours =
      [&match](
          const double NeighbourhoodEvidence::*value) -> std::optional<double> {
    if (!match.neighbourhood) return std::nullopt;
    return (*match.neighbourhood).*value;
  };
  return {kPercent * ProbabilityOf(match.pair.score),
          match.pair.score,
          match.margin,
          kPercent * evidence.ContradictionRatio(),
          kPercent * evidence.HitRatio(),
          evidence.WallDistance(),
          evidence.overlap_area,
          kPercent * evidence.overlap,
          evidence.MinScatterEigenvalue(),
          static_cast<double>(match.inliers.size()),
          of_neighbours(&NeighbourhoodEvidence::num_confirming),
          of_neighbours(&NeighbourhoodEvidence::num_refuting),
          match.num_supporting,
          match.num_opposing};
}

std::vector<RowStatus> RefusalStatuses(const std::string& path) {
  const auto status = [&path](const Verdict verdict, const char* const label,
                              const char* const meaning,
                              const char* const option) {
    return RowStatus{VerdictName(verdict), label, Tone::kNeutral, meaning,
                     absl::StrCat(path, ".", option)};
  };
  return {
      status(Verdict::kContradicted, "refused: contradicted",
             "Walls of one stand in free space of the other, or, between two "
             "trajectories, long ones do so in many pairs around.",
             "match.verification.judgement.max_contradiction_ratio"),
      status(Verdict::kAmbiguous, "refused: ambiguous",
             "Another pose of the two submaps is as good.",
             "match.verification.judgement.min_margin"),
      status(Verdict::kUnlikely, "refused: unlikely",
             "Too little agrees to be sure.", "support.min_supported_score"),
      status(Verdict::kDegenerate, "refused: could slide",
             "The walls face one way: the pose could slide along them.",
             "match.verification.judgement.min_scatter_eigenvalue"),
      status(Verdict::kTooLittleOverlap, "refused: too little overlap",
             "Both submaps have observed too little in common.",
             "match.verification.judgement.min_overlap_area")};
}

std::vector<RowStatus> ClosureStatuses(const std::string& path) {
  const auto status = [&path](const ClosureStatus of, const char* const label,
                              const Tone tone, const char* const meaning,
                              const char* const option) {
    return RowStatus{ClosureStatusName(of), label, tone, meaning,
                     *option == 0 ? "" : absl::StrCat(path, ".", option)};
  };
  return {
      status(ClosureStatus::kOutlier, "outlier", Tone::kBad,
             "Verification took it for right, but the optimised map "
             "contradicts it: the two places look alike, or a submap is bent.",
             "outlier_rejection.max_translation_error_meters"),
      status(ClosureStatus::kInconsistent, "inconsistent", Tone::kBad,
             "Closures with more weight contradict it, through odometry.",
             "consistency.max_mahalanobis_distance"),
      status(ClosureStatus::kUnsupported, "unsupported", Tone::kCaution,
             "No other closure supports it, and it is not certain alone.",
             "consistency.min_unsupported_score"),
      status(ClosureStatus::kScansDisagree, "scans disagree", Tone::kCaution,
             "Too few single scans of one submap fit the other at this pose.",
             "constraints.min_num_constraints"),
      status(ClosureStatus::kInGraph, "in the graph", Tone::kGood,
             "Its constraints are in the pose graph.", ""),
      status(ClosureStatus::kAlreadyInGraph, "already in the map",
             Tone::kNeutral, "Constraints of the map say the same already.",
             ""),
      status(ClosureStatus::kRedundant, "redundant", Tone::kNeutral,
             "Right, but better closures tie its submaps often enough.",
             "redundancy.min_num_ties")};
}

InspectedTable MakeClosureTable(const LoopClosingOptions& options,
                                const std::vector<Closure>& closures,
                                const std::vector<Match>& refused) {
  InspectedTable table{
      "closures", "Closures", "", {}, ClosureStatuses(kClosingPath)};
  table.measures =
      MatchMeasures(options.recognition.match.verification.judgement,
                    kJudgementPath, LeastScoreOf(options.recognition));
  for (Measure& measure : ErrorMeasures(options.closing.outlier_rejection)) {
    table.measures.push_back(std::move(measure));
  }
  for (RowStatus& status : RefusalStatuses(kRecognitionPath)) {
    table.statuses.push_back(std::move(status));
  }
  // The least certain closures first, and the most likely refused matches.
  for (const Closure& closure : closures) table.rows.push_back(RowOf(closure));
  SortByScore(false, &table.rows);
  std::vector<InspectedRow> others;
  for (const Match& match : refused) others.push_back(RowOf(match));
  SortByScore(true, &others);
  std::move(others.begin(), others.end(), std::back_inserter(table.rows));
  FinishTable(&table);
  return table;
}

void FinishTable(InspectedTable* const table) {
  // By the order of the statuses within a tone; refused matches come last.
  std::map<std::string, std::pair<int, size_t>> ranks;
  for (size_t k = 0; k < table->statuses.size(); ++k) {
    const RowStatus& status = table->statuses[k];
    ranks[status.name] = {RankOf(status.tone), k};
  }
  std::stable_sort(table->rows.begin(), table->rows.end(),
                   [&ranks](const InspectedRow& a, const InspectedRow& b) {
                     return ranks[a.status] < ranks[b.status];
                   });
  if (table->rows.size() > kMaxTableRows) {
    table->num_unlisted = table->rows.size() - kMaxTableRows;
    table->rows.resize(kMaxTableRows);
  }
}

int NumWithStatus(const std::vector<Closure>& closures,
                  const ClosureStatus status) {
  return static_cast<int>(std::count_if(
      closures.begin(), closures.end(),
      [status](const Closure& closure) { return closure.status == status; }));
}

std::optional<double> WallDistanceInGraph(
    const std::vector<Closure>& closures) {
  double sum = 0.;
  int count = 0;
  for (const Closure& closure : closures) {
    if (closure.status != ClosureStatus::kInGraph) continue;
    const double distance = closure.match.evidence.WallDistance();
    sum += distance * distance;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

InspectedRow MatchRowOf(const Match& match, const std::string& status,
                        const std::string& remark) {
  InspectedRow row;
  row.status = status;
  row.remark = remark;
  row.pair = match.pair;
  row.values = MatchValues(match);
  return row;
}

}  // namespace cartographer_sdf
