// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/evaluation/learning_tables.h"
#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/evaluation/match_table.h"
#include "cartographer_sdf/evaluation/relations.h"
#include "cartographer_sdf/evaluation/text_file.h"
#include "cartographer_sdf/evaluation/trajectory_error.h"
#include "cartographer_sdf/evaluation/truth.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "cartographer_sdf/tools/text_table.h"

DEFINE_string(relations, "",
              "Relations of scans that were verified by hand, lines of i, j, "
              "x, y, theta, t1, t2.");
DEFINE_double(seconds_per_scan, 0.1,
              "Scan i of the relations has the stamp 1e9 + i * this in the "
              "map [s].");
DEFINE_string(matches, "", "Matches to score, as `match` writes them.");
DEFINE_string(labels, "",
              "The file to write to what the truth says of each match.");
DEFINE_string(query_truth, "",
              "True poses of the second map, in the world of the first.");
DEFINE_string(csv, "", "The file to write all numbers to.");

namespace cartographer_sdf {
namespace {

constexpr double kDegree = M_PI / 180.;

// A line of the result: what was measured, and the numbers by name. A number
// that does not exist is absent.
struct Measurement {
  std::string subject;
  std::vector<std::pair<std::string, std::optional<double>>> numbers;
};

struct EvaluatedMap {
  PoseGraph pose_graph;
  std::map<SubmapId, ObservedPoints> observed;
};

absl::StatusOr<EvaluatedMap> ReadEvaluatedMap(const std::string& path,
                                              const bool with_areas) {
  Progress progress("read");
  EvaluatedMap result;
  SubmapCallback on_submap;
  if (with_areas) {
    on_submap = [&result](const SubmapId& id, const SubmapSummary&,
                          const OccupancyGrid& grid) {
      result.observed[id] = ThinnedObservedPoints(grid);
    };
  }
  absl::StatusOr<MapState> state =
      ReadMap(path, on_submap, progress.Callback());
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
  // A truth of the submaps alone serves the matches.
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

Measurement MeasureMatches(const MatchScore& score) {
  std::optional<double> median_degrees = score.median_rotation_error;
  if (median_degrees.has_value()) *median_degrees /= kDegree;
  return {"matches",
          {{"pairs", score.num_pairs},
           {"positives", score.num_positives},
           {"answers", score.num_answers},
           {"recall_p1", score.recall_at_precision_1},
           {"recall_p99", score.recall_at_precision_99},
           {"ap", score.average_precision},
           {"threshold", score.threshold},
           {"wrong", score.num_wrong},
           {"near", score.num_near},
           {"median_m", score.median_translation_error},
           {"median_deg", median_degrees}}};
}

absl::Status ScoreMatchesOfFlags(const EvaluatedMap& map, const Truth& truth,
                                 std::vector<Measurement>* const measurements) {
  const absl::StatusOr<std::vector<MatchRow>> matches =
      ReadMatches(FLAGS_matches);
  if (!matches.ok()) return matches.status();
  PairTruths pairs;
  std::vector<AnswerLabel> labels;
  if (FLAGS_query.empty()) {
    pairs = ComputePairTruths(map.observed, truth);
    labels = LabelAnswers(pairs, truth, *matches);
  } else {
    const absl::StatusOr<EvaluatedMap> query =
        ReadEvaluatedMap(FLAGS_query, /*with_areas=*/true);
    if (!query.ok()) return query.status();
    const absl::StatusOr<Truth> query_truth = ReadTruth(FLAGS_query_truth);
    if (!query_truth.ok()) return query_truth.status();
    pairs =
        ComputePairTruths(map.observed, truth, query->observed, *query_truth);
    labels = LabelAnswers(pairs, truth, *query_truth, *matches);
  }
  measurements->push_back(MeasureMatches(ScoreAnswers(pairs, labels)));
  if (FLAGS_labels.empty()) return absl::OkStatus();
  return WriteAnswerLabels(FLAGS_labels, labels);
}

std::string FormatNumber(const std::optional<double>& number) {
  if (!number.has_value()) return "-";
  return *number == std::round(*number) ? absl::StrFormat("%.0f", *number)
                                        : absl::StrFormat("%.3f", *number);
}

// Measurements of the same numbers share a table.
std::string FormatMeasurements(const std::vector<Measurement>& measurements) {
  std::string text;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> header;
  for (const Measurement& measurement : measurements) {
    std::vector<std::string> names = {""};
    std::vector<std::string> row = {measurement.subject};
    for (const auto& [name, number] : measurement.numbers) {
      names.push_back(name);
      row.push_back(FormatNumber(number));
    }
    if (names != header) {
      text += FormatTable(rows);
      rows = {names};
      header = names;
    }
    rows.push_back(row);
  }
  return text + FormatTable(rows);
}

absl::Status WriteMeasurements(const std::vector<Measurement>& measurements) {
  std::string content = "subject,quantity,value\n";
  for (const Measurement& measurement : measurements) {
    for (const auto& [name, number] : measurement.numbers) {
      if (!number.has_value()) continue;
      absl::StrAppendFormat(&content, "%s,%s,%.9g\n", measurement.subject, name,
                            *number);
    }
  }
  return WriteWholeFile(FLAGS_csv, content);
}

absl::Status CheckFlags() {
  if (FLAGS_relations.empty() && FLAGS_truth.empty()) {
    return UsageError("evaluate needs --relations or --truth");
  }
  if (!FLAGS_matches.empty() && FLAGS_truth.empty()) {
    return UsageError("--matches needs --truth");
  }
  if (FLAGS_query.empty() != FLAGS_query_truth.empty()) {
    return UsageError("--query and --query_truth need each other");
  }
  if (!FLAGS_query.empty() && FLAGS_matches.empty()) {
    return UsageError("--query needs --matches");
  }
  if (!FLAGS_labels.empty() && FLAGS_matches.empty()) {
    return UsageError("--labels needs --matches");
  }
  if (!(FLAGS_seconds_per_scan > 0.) ||
      !std::isfinite(FLAGS_seconds_per_scan)) {
    return UsageError("--seconds_per_scan must be positive");
  }
  return absl::OkStatus();
}

absl::Status RunEvaluate() {
  absl::Status status = CheckFlags();
  if (!status.ok()) return status;
  Truth truth;
  if (!FLAGS_truth.empty()) {
    absl::StatusOr<Truth> read = ReadTruth(FLAGS_truth);
    if (!read.ok()) return read.status();
    truth = *std::move(read);
  }
  const absl::StatusOr<EvaluatedMap> map =
      ReadEvaluatedMap(FLAGS_input, !FLAGS_matches.empty());
  if (!map.ok()) return map.status();
  std::vector<Measurement> measurements;
  if (!FLAGS_relations.empty()) {
    status = MeasureRelations(map->pose_graph, &measurements);
    if (!status.ok()) return status;
  }
  if (!FLAGS_truth.empty()) {
    status = MeasureTrajectory(map->pose_graph, truth, &measurements);
    if (!status.ok()) return status;
  }
  if (!FLAGS_matches.empty()) {
    status = ScoreMatchesOfFlags(*map, truth, &measurements);
    if (!status.ok()) return status;
  }
  if (!FLAGS_csv.empty()) {
    status = WriteMeasurements(measurements);
    if (!status.ok()) return status;
  }
  std::cout << FormatMeasurements(measurements);
  return absl::OkStatus();
}

}  // namespace

Subcommand Evaluate() {
  return Subcommand{
      "evaluate",
      "errors of a map and of matches against the truth",
      "--input A.pbstream [--relations F] [--truth T.csv [--matches M.csv]]",
      "Errors of scans against --relations, of all and of those more than 30 s "
      "apart; of nodes against --truth after a rigid alignment; and scores of "
      "--matches: of answers by falling score, the fraction of positive pairs "
      "that are answered before the first wrong one (recall_p1), at a "
      "precision of 0.99 (recall_p99), and average precision (ap).\n\n"
      "A pair of submaps is positive where half of the smaller observed area "
      "lies in the other. An answer is right within 0.5 m and 10 degrees of "
      "the truth, wrong beyond 1 m or 10 degrees, and near between. --labels "
      "writes this for each match.",
      {"input"},
      {"relations", "seconds_per_scan", "truth", "matches", "labels", "query",
       "query_truth", "csv"},
      &RunEvaluate};
}

}  // namespace cartographer_sdf
