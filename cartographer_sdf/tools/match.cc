// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/closing/closure.h"
#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/evaluation/learning_tables.h"
#include "cartographer_sdf/evaluation/shape_context.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/recognition/recognize.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/method_options.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(
    method, "",
    "sdf, paper or shape_context; if empty, the method in the configuration "
    "file. Unless --configuration_basename is given, paper reads paper.lua and "
    "shape_context reads shape_context.lua.");
DEFINE_string(options_in_force, "",
              "File to write all options in force to, as Lua.");
DEFINE_string(terms, "",
              "CSV file to write the terms of every pair's score to. Only for "
              "method sdf.");
DEFINE_string(neighbour_terms, "",
              "CSV file to write the terms of every pair's neighbourhood score "
              "to. Only for method sdf, not with --alone.");
DEFINE_bool(alone, false,
            "Verify each pair of submaps by itself, without its neighbours. "
            "Only for method sdf.");
DEFINE_bool(agree, false,
            "Accept only matches that agree with each other, as in "
            "close_loops. Only for method sdf.");

DEFINE_bool(all_pairs, false,
            "Match every pair of submaps, not only those that an index of all "
            "submaps proposes: for studies; takes time quadratic in their "
            "number.");

namespace cartographer_sdf {
namespace {

// Options with the flags of this subcommand applied.
absl::StatusOr<MethodOptions> OptionsOfFlags() {
  absl::StatusOr<MethodOptions> method = LoadOptionsOfMethod(FLAGS_method);
  if (!method.ok()) return method.status();
  RecognitionOptions& recognition = method->options.loop_closing.recognition;
  if (recognition.match.method != Method::kSdf) {
    if (FLAGS_agree || FLAGS_alone || !FLAGS_terms.empty()) {
      return UsageError("--agree, --alone and --terms need method sdf");
    }
    recognition.verify_neighbourhoods = false;
  }
  // A table of all matches, however many say the same.
  recognition.neighbourhood.max_num_matches_per_submap = 0;
  if (FLAGS_alone) recognition.verify_neighbourhoods = false;
  if (FLAGS_all_pairs) recognition.use_retrieval = false;
  if (!FLAGS_neighbour_terms.empty() && !recognition.verify_neighbourhoods) {
    return UsageError(
        "--neighbour_terms needs method sdf, and neighbourhoods that are "
        "verified");
  }
  if (method->describes_clouds && !FLAGS_places.empty()) {
    return UsageError("--places needs method sdf or paper");
  }
  return method;
}

absl::StatusOr<DescribedMap> Describe(const MethodOptions& method,
                                      const std::string& path,
                                      const Executor& executor,
                                      StageClock* const clock,
                                      RunRecord* const record) {
  const ProgressCallback on_progress = clock->Begin("read and describe");
  if (method.describes_clouds) {
    return DescribeMapByShapeContexts(method.shape_context, path, executor,
                                      on_progress);
  }
  const LoopClosingOptions& stages = method.options.loop_closing;
  // --places applies to the map, not to the query.
  if (path == FLAGS_input) {
    return DescribeOrRemember(stages, SourceOfFlags(path), FLAGS_places,
                              executor, PointClouds::kDrop, on_progress,
                              record);
  }
  return DescribeMap(stages.place, stages.recognition.match,
                     SourceOfFlags(path), executor, on_progress);
}

// The map and, if there is one, the query.
absl::StatusOr<std::vector<DescribedMap>> DescribeMaps(
    const MethodOptions& method, const Executor& executor,
    StageClock* const clock, RunRecord* const record) {
  std::vector<DescribedMap> maps;
  for (const std::string& path : {FLAGS_input, FLAGS_query}) {
    if (path.empty()) continue;
    absl::StatusOr<DescribedMap> map =
        Describe(method, path, executor, clock, record);
    if (!map.ok()) return map.status();
    maps.push_back(*std::move(map));
  }
  return maps;
}

std::vector<MatchRow> ToRows(const std::vector<Match>& matches) {
  std::vector<MatchRow> rows;
  for (const Match& match : matches) {
    rows.push_back(ToRow(match, match.verdict == Verdict::kAccepted,
                         VerdictName(match.verdict)));
  }
  return rows;
}

// Revokes the acceptance of rows whose matches the others do not support.
void RefuseInconsistent(const ConsistencyOptions& options,
                        const std::vector<DescribedMap>& maps,
                        const std::vector<Match>& matches,
                        std::vector<MatchRow>* const rows) {
  std::vector<PairPose> pairs;
  std::vector<MatchRow*> accepted;
  for (size_t k = 0; k < rows->size(); ++k) {
    if (!(*rows)[k].accepted) continue;
    pairs.push_back(matches[k].pair);
    accepted.push_back(&(*rows)[k]);
  }
  const std::vector<SelectionResult> results =
      maps.size() > 1 ? SelectConsistentBetween(options, maps[0].odometry,
                                                maps[1].odometry, pairs)
                      : SelectConsistent(options, maps[0].odometry, pairs);
  for (size_t k = 0; k < results.size(); ++k) {
    if (results[k].selection == Selection::kSelected) continue;
    accepted[k]->accepted = false;
    accepted[k]->verdict =
        ClosureStatusName(results[k].selection == Selection::kInconsistent
                              ? ClosureStatus::kInconsistent
                              : ClosureStatus::kUnsupported);
  }
}

// Writes the tables that the flags ask for.
absl::Status WriteTables(const MethodOptions& method,
                         const std::vector<Match>& matches,
                         const std::vector<MatchRow>& rows) {
  absl::Status status = WriteMatches(FLAGS_output, rows);
  if (status.ok() && !FLAGS_terms.empty()) {
    status = WriteScoreTerms(FLAGS_terms, matches);
  }
  if (status.ok() && !FLAGS_neighbour_terms.empty()) {
    status = WriteNeighbourhoodTerms(
        FLAGS_neighbour_terms,
        method.options.loop_closing.recognition.neighbourhood, matches);
  }
  if (status.ok() && !FLAGS_options_in_force.empty()) {
    status = WriteWholeFile(FLAGS_options_in_force, FormatOptions(method));
  }
  return status;
}

// Counts of the map are those of --input.
void RecordMatches(const std::vector<DescribedMap>& maps,
                   const size_t num_pairs, const size_t num_accepted,
                   RunRecord* const record) {
  RecordMap(maps.front().state, record);
  record->Count("places", maps.front().places.size());
  if (maps.size() > 1) record->Count("query_places", maps[1].places.size());
  record->Count("pairs", num_pairs);
  record->Count("accepted", num_accepted);
  if (num_accepted == 0) {
    record->End(Outcome::kNothing, "no match was accepted");
  }
}

absl::Status RunMatch(RunRecord* const record) {
  const absl::StatusOr<MethodOptions> method = OptionsOfFlags();
  if (!method.ok()) return method.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  StageProgress progress(record);
  const StageCallback on_stage = progress.Callback();
  std::vector<std::pair<std::string, double>> stage_seconds;
  StageClock clock(on_stage, &stage_seconds);
  const Executor executor = MakeExecutor(*num_threads);
  const absl::StatusOr<std::vector<DescribedMap>> maps =
      DescribeMaps(*method, executor, &clock, record);
  if (!maps.ok()) return maps.status();
  const LoopClosingOptions& stages = method->options.loop_closing;
  const TrajectoryPlaces places = maps->front().trajectory_places();
  const std::vector<Match> matches =
      maps->size() > 1
          ? RecognizeBetween(stages.recognition, places,
                             maps->back().trajectory_places(), executor, &clock)
          : RecognizeWithin(stages.recognition, places, executor, &clock);
  clock.End();
  std::vector<MatchRow> rows = ToRows(matches);
  if (FLAGS_agree) {
    RefuseInconsistent(stages.closing.consistency, *maps, matches, &rows);
  }
  if (absl::Status status = WriteTables(*method, matches, rows); !status.ok()) {
    return status;
  }
  const auto num_accepted =
      std::count_if(rows.begin(), rows.end(),
                    [](const MatchRow& row) { return row.accepted; });
  RecordMatches(*maps, rows.size(), static_cast<size_t>(num_accepted), record);
  for (const DescribedMap& map : *maps) PrintRepair(map.state);
  std::cout << rows.size() << " pairs of submaps with a pose, " << num_accepted
            << " accepted: " << FLAGS_output << "\n";
  return absl::OkStatus();
}

}  // namespace

// Long: a description, with all flags.
Subcommand MatchSubcommand() {
  Subcommand subcommand{
      "match",
      "find submaps of one or two maps that see the same place",
      "A.pbstream [B.pbstream] --output M.csv "
      "[--method sdf|paper|shape_context] [--all_pairs] [--places P.places] "
      "[--alone] [--agree]",
      "Matches the pairs of submaps that an index proposes, and those that "
      "their matches propose, without a pose prior, and writes the best pose "
      "of each pair that has one, accepted or not, with its evidence. Does not "
      "optimise the map.\n\n"
      "The columns x, y, yaw are the pose of the query submap in the frame of "
      "the reference submap [m, rad]; a higher score is more certain (sdf: "
      "log-odds of being right; paper and shape_context: number of "
      "inliers).\n\n"
      "Each pair is verified together with the neighbours of both submaps on "
      "their trajectories; with --alone, by itself.\n\n"
      "With --agree, a match is no longer accepted if matches with more weight "
      "contradict it through the odometry between them, or if it is uncertain "
      "and no other supports it. Its verdict gives the reason.",
      {{"input", FileUse::kRead},
       {"output",
        FileUse::kWriteText,
        {},
        "CSV file to write the matches to; -: the standard output."}},
      {{"query",
        FileUse::kRead,
        {},
        "Second map, whose submaps are searched for in --input. If empty, the "
        "submaps of --input are matched with each other."},
       "method",
       "all_pairs",
       {"places", FileUse::kCache},
       "alone",
       "agree",
       "repair",
       {"terms", FileUse::kWriteText},
       {"neighbour_terms", FileUse::kWriteText},
       {"options_in_force", FileUse::kWriteText},
       "configuration_directory",
       "configuration_basename",
       "threads"},
      &RunMatch};
  subcommand.positional_flags = {"input", "query"};
  return subcommand;
}

}  // namespace cartographer_sdf
