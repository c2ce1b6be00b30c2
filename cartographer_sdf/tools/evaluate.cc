// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/evaluation/learning_tables.h"
#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/evaluation/precision_recall.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/report/svg_plot.h"
#include "cartographer_sdf/simulation/truth.h"
#include "cartographer_sdf/tools/evaluate_random_pairs.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/measurement.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(relations, "",
              "File of manually verified relations between scans, with lines "
              "of i, j, x, y, theta, t1, t2.");
DEFINE_string(
    matches, "",
    "Files of matches to score, as `match` writes them, separated by commas.");
DEFINE_double(positive_overlap, 0.5,
              "For --matches: a pair of submaps is positive if its common area "
              "is at least this fraction of the smaller submap's area.");
DEFINE_string(labels, "",
              "CSV files to write the truth about each match to, one for each "
              "file of --matches, separated by commas.");
DEFINE_string(query_truth, "",
              "File of true poses for the map of --query, in the world frame "
              "of --truth.");
DEFINE_string(csv, "", "CSV file to write all numbers to.");
DEFINE_string(
    curves, "",
    "CSV file to write precision and recall over the score threshold to, with "
    "a series for each method of --random_pairs and each file of --matches.");
DEFINE_string(
    plot, "",
    "SVG file to draw these curves to, without those of --max_clearances.");
DEFINE_string(free_space_plot, "",
              "SVG file to draw the curves of method paper for each of "
              "--max_clearances to, and that of shape_context.");

namespace cartographer_sdf {
namespace {

constexpr double kDegree = M_PI / 180.;

struct EvaluatedMap {
  PoseGraph pose_graph;
  std::map<SubmapId, ObservedPoints> observed;
};

absl::StatusOr<EvaluatedMap> ReadEvaluatedMap(const std::string& path,
                                              const bool with_areas,
                                              StageProgress* const progress) {
  EvaluatedMap result;
  SubmapCallback on_submap;
  if (with_areas) {
    on_submap = [&result](const SubmapId& id, const SubmapSummary&,
                          const OccupancyGrid& grid) {
      result.observed[id] = ThinnedObservedPoints(grid);
    };
  }
  absl::StatusOr<MapState> state =
      ReadMap(path, {on_submap}, progress->Begin("read"));
  progress->End();
  if (!state.ok()) return state.status();
  result.pose_graph = std::move(state->pose_graph);
  return result;
}

Measurement MeasureErrors(const std::string& subject,
                          const PoseErrorStatistics& errors) {
  const ErrorStatistics& t = errors.translation;
  const ErrorStatistics& r = errors.rotation;
  return {subject,
          {{"count", t.count},
           {"mean_m", t.mean},
           {"median_m", t.median},
           {"p90_m", t.percentile_90},
           {"max_m", t.max},
           {"mean_deg", r.mean / kDegree},
           {"median_deg", r.median / kDegree},
           {"p90_deg", r.percentile_90 / kDegree},
           {"max_deg", r.max / kDegree}}};
}

absl::Status MeasureRelations(const PoseGraph& pose_graph,
                              std::vector<Measurement>* const measurements) {
  const absl::StatusOr<std::vector<Relation>> relations =
      ReadRelations(FLAGS_relations);
  if (!relations.ok()) return relations.status();
  const RelationErrors errors =
      EvaluateRelations(pose_graph, *relations, FLAGS_seconds_per_scan);
  if (!errors.all.has_value()) {
    return absl::InvalidArgumentError(
        absl::StrCat("no relation of ", FLAGS_relations,
                     " lies within the time of ", FLAGS_input));
  }
  measurements->push_back(MeasureErrors("relations", *errors.all));
  if (errors.loops.has_value()) {
    measurements->push_back(MeasureErrors("loop relations", *errors.loops));
  }
  return absl::OkStatus();
}

absl::Status MeasureTrajectory(const PoseGraph& pose_graph, const Truth& truth,
                               std::vector<Measurement>* const measurements) {
  // A truth with submaps only is sufficient for matches.
  if (truth.T_world_tracking.empty()) return absl::OkStatus();
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(pose_graph, truth);
  if (!error.has_value()) {
    return absl::InvalidArgumentError(
        absl::StrCat(FLAGS_input, " and ", FLAGS_truth,
                     " have too few nodes in common to be aligned"));
  }
  measurements->push_back(MeasureErrors("nodes", error->errors));
  measurements->back().numbers.emplace_back("skipped", error->num_skipped);
  return absl::OkStatus();
}

Measurement MeasureMatches(const std::string& subject, const MatchScore& score,
                           const PrecisionRecallCurve& curve) {
  std::optional<double> median_degrees = score.median_rotation_error;
  if (median_degrees.has_value()) *median_degrees /= kDegree;
  return {subject,
          {{"pairs", score.num_pairs},
           {"positives", score.num_positives},
           {"answers", score.num_answers},
           {"recall_p1", score.recall_at_precision_1},
           {"recall_p1_ties", curve.RecallAtPrecision1()},
           {"recall_p99", score.recall_at_precision_99},
           {"ap", score.average_precision},
           {"threshold", score.threshold},
           {"wrong", score.num_wrong},
           {"near", score.num_near},
           {"median_m", score.median_translation_error},
           {"median_deg", median_degrees}}};
}

Measurement MeasureAccepted(const std::string& subject,
                            const PlaceRecognitionScore& score) {
  return {subject,
          {{"right", score.num_right},
           {"near", score.num_near},
           {"wrong", score.num_wrong},
           {"unknown", score.num_unknown},
           {"queries", score.num_queries},
           {"queries_positive", score.num_queries_with_positive},
           {"queries_matched", score.num_queries_matched},
           {"queries_right", score.num_queries_right}}};
}

// Names of the results of each table of matches; with several tables, after
// their files.
std::string SeriesName(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  std::replace_if(
      name.begin(), name.end(),
      [](const unsigned char c) { return c < ' ' || c == ',' || c == '"'; },
      '_');
  return name;
}

// Pairs of submaps of --input, or of --input and --query.
absl::StatusOr<PairTruths> PairTruthsOfFlags(const EvaluatedMap& map,
                                             const Truth& truth,
                                             StageProgress* const progress) {
  PairTruths pairs;
  if (FLAGS_query.empty()) {
    pairs = ComputePairTruths(map.observed, truth);
  } else {
    const absl::StatusOr<EvaluatedMap> query =
        ReadEvaluatedMap(FLAGS_query, /*with_areas=*/true, progress);
    if (!query.ok()) return query.status();
    const absl::StatusOr<Truth> query_truth = ReadTruth(FLAGS_query_truth);
    if (!query_truth.ok()) return query_truth.status();
    const absl::Status status = CheckIsTruthOf(FLAGS_query, query->pose_graph,
                                               FLAGS_query_truth, *query_truth);
    if (!status.ok()) return status;
    pairs =
        ComputePairTruths(map.observed, truth, query->observed, *query_truth);
  }
  MarkPositives(FLAGS_positive_overlap, &pairs);
  return pairs;
}

absl::Status ScoreMatchesOfFlags(const EvaluatedMap& map, const Truth& truth,
                                 StageProgress* const progress,
                                 std::vector<Measurement>* const measurements,
                                 std::vector<NamedCurve>* const curves) {
  const absl::StatusOr<PairTruths> pairs =
      PairTruthsOfFlags(map, truth, progress);
  if (!pairs.ok()) return pairs.status();
  const std::vector<std::string> files = SplitPaths(FLAGS_matches);
  std::vector<Measurement> accepted;
  const std::vector<std::string> label_files = SplitPaths(FLAGS_labels);
  for (size_t k = 0; k < files.size(); ++k) {
    absl::StatusOr<std::vector<MatchRow>> matches = ReadMatches(files[k]);
    if (!matches.ok()) return matches.status();
    if (FLAGS_query.empty()) OrderByIds(&*matches);
    const std::vector<AnswerLabel> labels = LabelAnswers(*pairs, *matches);
    const MatchScore score = ScoreAnswers(*pairs, labels);
    const PrecisionRecallCurve curve =
        JudgeAnswers(labels, score.num_positives, AnswerJudgement::kByPose);
    const std::string series = SeriesName(files[k]);
    const std::string suffix =
        files.size() == 1 ? "" : absl::StrCat(" ", series);
    measurements->push_back(
        MeasureMatches(absl::StrCat("matches", suffix), score, curve));
    accepted.push_back(
        MeasureAccepted(absl::StrCat("accepted", suffix),
                        ScorePlaceRecognition(*pairs, labels, *matches)));
    curves->push_back({series, curve, /*is_variant=*/false});
    if (label_files.empty()) continue;
    const absl::Status status = WriteAnswerLabels(label_files[k], labels);
    if (!status.ok()) return status;
  }
  measurements->insert(measurements->end(), accepted.begin(), accepted.end());
  return absl::OkStatus();
}

std::string DrawCurves(const std::string& title,
                       const std::vector<NamedCurve>& curves) {
  LinePlot plot;
  plot.title = title;
  plot.x = {"recall", std::make_pair(0., 1.)};
  plot.y = {"precision", std::make_pair(0., 1.05)};
  plot.legend = LegendCorner::kBottomLeft;
  for (const NamedCurve& curve : curves) {
    LineSeries series{curve.name, {}};
    for (const PrecisionRecallPoint& point : curve.curve.points) {
      series.points.emplace_back(point.recall, point.precision);
    }
    plot.series.push_back(std::move(series));
  }
  return StandaloneSvg(RenderLinePlot(plot));
}

absl::Status WriteResults(const std::vector<Measurement>& measurements,
                          const std::vector<NamedCurve>& curves) {
  absl::Status status;
  if (!FLAGS_csv.empty()) status = WriteMeasurements(FLAGS_csv, measurements);
  if (status.ok() && !FLAGS_curves.empty()) {
    status = WriteCurves(FLAGS_curves, curves);
  }
  std::vector<NamedCurve> of_methods, of_free_space;
  for (const NamedCurve& curve : curves) {
    if (!curve.is_variant) of_methods.push_back(curve);
    if (curve.is_variant || curve.name == "paper" ||
        curve.name == "shape_context") {
      of_free_space.push_back(curve);
    }
  }
  if (status.ok() && !FLAGS_plot.empty()) {
    status = WriteWholeFile(FLAGS_plot,
                            DrawCurves("Precision and recall", of_methods));
  }
  if (status.ok() && !FLAGS_free_space_plot.empty()) {
    status = WriteWholeFile(
        FLAGS_free_space_plot,
        DrawCurves("Features within a distance of walls", of_free_space));
  }
  return status;
}

absl::Status CheckFlags() {
  const bool has_truth = !FLAGS_truth.empty();
  const bool has_matches = !FLAGS_matches.empty();
  const std::pair<bool, const char*> needs[] = {
      {has_truth || !FLAGS_relations.empty(),
       "evaluate needs --relations or --truth"},
      {has_truth || !has_matches, "--matches needs --truth"},
      {FLAGS_query.empty() == FLAGS_query_truth.empty(),
       "--query and --query_truth need each other"},
      {has_matches || FLAGS_query.empty(), "--query needs --matches"},
      {FLAGS_labels.empty() ||
           SplitPaths(FLAGS_labels).size() == SplitPaths(FLAGS_matches).size(),
       "--labels needs --matches, a file for each"},
      {has_truth || !WantsRandomPairs(), "--random_pairs needs --truth"},
      {FLAGS_free_space_plot.empty() || WantsRandomPairs(),
       "--free_space_plot needs --random_pairs"},
      {(FLAGS_curves.empty() && FLAGS_plot.empty()) || has_matches ||
           WantsRandomPairs(),
       "--curves and --plot need --matches or --random_pairs"},
      {FLAGS_seconds_per_scan > 0. && std::isfinite(FLAGS_seconds_per_scan),
       "--seconds_per_scan must be positive"},
      {FLAGS_positive_overlap > 0. && FLAGS_positive_overlap <= 1.,
       "--positive_overlap must lie above 0 and not above 1"}};
  for (const auto& [is_met, sentence] : needs) {
    if (!is_met) return UsageError(sentence);
  }
  return CheckRandomPairFlags();
}

Json MeasurementsJson(const std::vector<Measurement>& measurements) {
  Json json = Json::array();
  for (const Measurement& measurement : measurements) {
    Json quantities = Json::object();
    for (const auto& [name, number] : measurement.numbers) {
      quantities[name] = ToJson(number);
    }
    json.push_back({{"subject", measurement.subject},
                    {"quantities", std::move(quantities)}});
  }
  return json;
}

// What the flags ask for, in the order of the flags.
absl::Status MeasureByFlags(const EvaluatedMap& map, const Truth& truth,
                            StageProgress* const progress,
                            std::vector<Measurement>* const measurements,
                            std::vector<NamedCurve>* const curves) {
  absl::Status status;
  if (!FLAGS_relations.empty()) {
    status = MeasureRelations(map.pose_graph, measurements);
  }
  if (status.ok() && !FLAGS_truth.empty()) {
    status = MeasureTrajectory(map.pose_graph, truth, measurements);
  }
  if (status.ok() && !FLAGS_matches.empty()) {
    status = ScoreMatchesOfFlags(map, truth, progress, measurements, curves);
  }
  if (status.ok() && WantsRandomPairs()) {
    status = MeasureRandomPairs(truth, progress, measurements, curves);
  }
  if (status.ok() && measurements->empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        FLAGS_truth, " has no nodes to measure; submaps need --matches"));
  }
  return status;
}

absl::Status RunEvaluate(RunRecord* const record) {
  StageProgress progress(record);
  Truth truth;
  if (!FLAGS_truth.empty()) {
    absl::StatusOr<Truth> read = ReadTruth(FLAGS_truth);
    if (!read.ok()) return read.status();
    truth = *std::move(read);
  }
  const absl::StatusOr<EvaluatedMap> map =
      ReadEvaluatedMap(FLAGS_input, !FLAGS_matches.empty(), &progress);
  if (!map.ok()) return map.status();
  absl::Status status =
      CheckIsTruthOf(FLAGS_input, map->pose_graph, FLAGS_truth, truth);
  if (!status.ok()) return status;
  std::vector<Measurement> measurements;
  std::vector<NamedCurve> curves;
  status = MeasureByFlags(*map, truth, &progress, &measurements, &curves);
  if (status.ok()) status = WriteResults(measurements, curves);
  if (!status.ok()) return status;
  record->Count("submaps", map->pose_graph.submap_poses.size());
  record->Count("nodes", map->pose_graph.nodes.size());
  record->answer["measurements"] = MeasurementsJson(measurements);
  std::cout << FormatMeasurements(measurements);
  return absl::OkStatus();
}

constexpr char kDescription[] =
    "Prints the errors of scans against --relations, for all relations and for "
    "those more than 30 s apart; the errors of nodes against --truth after a "
    "rigid alignment; and scores of --matches. With answers ordered by "
    "decreasing score, the scores are the fraction of positive pairs with a "
    "right answer before the first wrong one (recall_p1), that at a precision "
    "of 0.99 (recall_p99), and average precision (ap). Answers with equal "
    "scores count in the order of the table; in recall_p1_ties, together. Each "
    "file of --matches gets a line.\n\n"
    "A pair of submaps is positive if at least --positive_overlap of the "
    "smaller observed area lies in the other. An answer is right within 0.5 m "
    "and 10 degrees of the truth, wrong beyond 1 m or 10 degrees, and near in "
    "between. --labels writes this for each match.\n\n"
    "--random_pairs follows the protocol of the paper: draws pairs with "
    "--pair_seed, rotates one submap of each before describing it, and matches "
    "the pairs by --methods. An answer is right if the pair's common area "
    "reaches --min_overlaps; in the columns with _pose, its pose must be "
    "right, too.";

}  // namespace

Subcommand Evaluate() {
  Subcommand subcommand{
      "evaluate",
      "measure the errors of a map and of matches",
      "A.pbstream [--relations F] [--truth T.csv [--matches M.csv,...] "
      "[--random_pairs N]]",
      kDescription,
      {{"input", FileUse::kRead}},
      {{"relations", FileUse::kRead},
       "seconds_per_scan",
       {"truth", FileUse::kRead},
       {"matches", FileUse::kReadList},
       {"labels", FileUse::kWriteTextList},
       {"query",
        FileUse::kRead,
        {},
        "Second map, that of the queries of --matches."},
       {"query_truth", FileUse::kRead},
       "positive_overlap",
       {"csv", FileUse::kWriteText},
       {"curves", FileUse::kWriteText},
       {"plot", FileUse::kWriteText},
       {"free_space_plot", FileUse::kWriteText},
       "random_pairs",
       "methods",
       "pair_seed",
       "min_overlaps",
       "min_index_gap",
       "max_clearances",
       "configuration_directory",
       "configuration_basename",
       "threads"},
      &RunEvaluate};
  subcommand.check_flags = &CheckFlags;
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
