// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/apps/merge.h"
#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/localization/probability.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/map_summary.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/scan_localization.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_double(
    first_seconds, 0.,
    "Use only this duration of each trajectory of the query, or of the "
    "drive of --scan, as if it had just been driven: places are made "
    "from its scans. [s]");
DEFINE_double(start_seconds, 0.,
              "Time from the beginning of each trajectory at which "
              "--first_seconds starts. [s]");

DEFINE_int32(
    num_starts, 1,
    "Number of windows of --first_seconds, evenly spaced along the query, to "
    "localise separately. With this flag, --result has a list of them.");

namespace cartographer_sdf {
namespace {

bool IsGiven(const char* const flag) {
  return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default;
}

absl::StatusOr<std::optional<TimeWindow>> WindowOfFlags() {
  if (!IsGiven("first_seconds")) {
    if (IsGiven("start_seconds")) {
      return UsageError("--start_seconds needs --first_seconds");
    }
    return std::nullopt;
  }
  if (!(FLAGS_first_seconds > 0. && std::isfinite(FLAGS_first_seconds))) {
    return UsageError("--first_seconds must be positive");
  }
  if (!(FLAGS_start_seconds >= 0. && std::isfinite(FLAGS_start_seconds))) {
    return UsageError("--start_seconds must not be negative");
  }
  if (!FLAGS_output.empty()) {
    return UsageError(
        "--output takes the whole query: not together with --first_seconds");
  }
  return TimeWindow{FLAGS_start_seconds, FLAGS_first_seconds};
}

// Of what is localised: a map or its scans, or a scan.
absl::Status CheckQueryFlags() {
  if (FLAGS_scan.empty()) {
    if (!FLAGS_query.empty()) return absl::OkStatus();
    return UsageError(
        "--query is missing, the map or drive to find, or --scan, the scan");
  }
  for (const char* const flag : {"query", "output"}) {
    if (IsGiven(flag)) {
      return UsageError(absl::StrCat("--", flag, " does not go with --scan"));
    }
  }
  if (SplitPaths(FLAGS_scan).size() > 1 && !FLAGS_report.empty()) {
    return UsageError("--report takes a single --scan");
  }
  return absl::OkStatus();
}

absl::Status CheckFlagsOfRelocalize() {
  absl::Status status = CheckQueryFlags();
  if (status.ok()) status = CheckDropOdometry();
  if (!status.ok()) return status;
  const absl::Status window = WindowOfFlags().status();
  if (!window.ok()) return window;
  if (!IsGiven("num_starts")) return absl::OkStatus();
  if (FLAGS_num_starts < 1 || FLAGS_num_starts > 10000) {
    return UsageError("--num_starts must lie between 1 and 10000");
  }
  if (!IsGiven("first_seconds") || IsGiven("start_seconds") ||
      !FLAGS_report.empty()) {
    return UsageError(
        "--num_starts needs --first_seconds, and goes neither with "
        "--start_seconds nor with --report");
  }
  return absl::OkStatus();
}

void RecordStarts(const int num_localized, Json starts,
                  RunRecord* const record) {
  record->answer["starts"] = std::move(starts);
  record->Count("windows", static_cast<size_t>(FLAGS_num_starts));
  record->Count("localized", static_cast<size_t>(num_localized));
  if (num_localized == 0) {
    record->End(Outcome::kRefused, "no window was localized");
  } else if (num_localized < FLAGS_num_starts) {
    record->Warn(
        RunWarning::kWindowsNotLocalized,
        absl::StrFormat("%d of %d windows were not localized",
                        FLAGS_num_starts - num_localized, FLAGS_num_starts));
  }
}

void RecordAnswer(const Session& map, const Session& query,
                  const Localization& result, RunRecord* const record) {
  record->answer = ToJson(result);
  RecordMap(map.map.state, record);
  record->Count("places", map.map.places.size());
  record->Count("query_places", query.map.places.size());
  record->Count("agreeing", static_cast<size_t>(result.num_agreeing));
  if (!result.T_map_query) record->End(Outcome::kRefused, result.reason);
}

// Prints one line and adds one entry to the result for each window.
absl::Status RunManyStarts(const MapTask& task, const DescribedMap& map,
                           StageProgress* const progress,
                           RunRecord* const record) {
  const Options& options = task.options;
  const absl::StatusOr<DescribedMap> query =
      ReadMapWithScans(SourceOfFlags(FLAGS_query));
  if (!query.ok()) return query.status();
  double longest = 0.;
  for (const auto& [id, summary] : SummarizeTrajectories(query->state)) {
    longest = std::max(longest, summary.duration_seconds);
  }
  const double latest_start = std::max(0., longest - FLAGS_first_seconds);
  const ProgressCallback on_progress = progress->Begin("windows");
  Json results = Json::array();
  int num_localized = 0;
  for (int k = 0; k < FLAGS_num_starts; ++k) {
    const double start =
        FLAGS_num_starts == 1 ? 0. : latest_start * k / (FLAGS_num_starts - 1);
    const ScanMap window =
        DescribeScans(options.scan_places, options.loop_closing.place,
                      options.loop_closing.recognition.match, *query,
                      TimeWindow{start, FLAGS_first_seconds}, task.executor);
    const Localization result =
        LocalizeIn(options.localization, options.loop_closing, map, window.map,
                   task.executor);
    num_localized += result.T_map_query.has_value();
    std::cout << absl::StrFormat("%7.1f s: %s, %s\n", start,
                                 LocalizationVerdictName(result.verdict),
                                 result.reason);
    results.push_back({{"start_seconds", start}, {"result", ToJson(result)}});
    on_progress((k + 1.) / FLAGS_num_starts);
  }
  std::cout << num_localized << " of " << FLAGS_num_starts
            << " windows were localized\n";
  RecordStarts(num_localized, std::move(results), record);
  return absl::OkStatus();
}

absl::Status WriteCombinedMap(const MapTask& task, const Session& map,
                              const Session& query, const Localization& result,
                              StageProgress* const progress,
                              RunRecord* const record) {
  if (!result.T_map_query) {
    return RefusalError(absl::StrCat("nothing is written to ", FLAGS_output,
                                     ": ", query.path, " was not localized in ",
                                     map.path, ": ", result.reason));
  }
  const absl::StatusOr<MergingResult> merged =
      AttachQuery(task.options.fold_check, task.options.loop_closing, map,
                  query, result, task.executor, progress->Callback());
  if (!merged.ok()) return merged.status();
  if (!merged->refusal.empty()) {
    return RefusalError(absl::StrCat("nothing is written to ", FLAGS_output,
                                     ": ", merged->refusal));
  }
  const absl::Status status =
      WriteJoinedMap(merged->parts, merged->closed.pose_graph, FLAGS_output,
                     progress->Begin("write"));
  if (!status.ok()) return status;
  const ClosingOptions& closing = task.options.loop_closing.closing;
  WarnOfHostMotion(closing, closing.optimization, merged->closed.pose_graph,
                   record);
  return absl::OkStatus();
}

void PrintSummary(const Localization& result) {
  if (result.T_map_query) {
    std::cout << "localized: " << FormatPose(*result.T_map_query) << "\n";
  } else {
    std::cout << "not localized: " << LocalizationVerdictName(result.verdict)
              << "\n";
  }
  std::cout << "  " << result.reason << "\n";
  if (result.score) {
    const std::optional<double>& other = result.runner_up_score;
    std::cout << "  probability "
              << FormatProbability(ProbabilityOf(*result.score, other));
    if (other) {
      std::cout << ", runner-up "
                << FormatProbability(ProbabilityOf(*other, result.score));
    }
    std::cout << absl::StrFormat("; %d matches agree, %d contradict\n",
                                 result.num_agreeing, result.num_contradicting);
  }
  if (result.T_map_query) {
    std::cout << "  " << DescribeChanges(result.changes) << "\n";
  }
  for (const auto& [stage, seconds] : result.stage_seconds) {
    std::cout << absl::StrFormat("  %7.3f s %s\n", seconds, stage);
  }
}

// Writes the files that the flags ask for.
absl::Status WriteFiles(const MapTask& task, const Session& map,
                        const Session& query, const Localization& result,
                        StageProgress* const progress,
                        RunRecord* const record) {
  absl::Status status;
  if (!FLAGS_report.empty()) {
    status = WriteRelocalizationReport(
        ReportRequestOfFlags(task.options, record->run),
        task.options.loop_closing, task.options.localization, map, query,
        result, progress->Begin("report"));
  }
  if (status.ok() && !FLAGS_output.empty()) {
    status = WriteCombinedMap(task, map, query, result, progress, record);
  }
  return status;
}

// Localises the whole query, or one window of it.
absl::Status RunOnce(const MapTask& task,
                     const std::optional<TimeWindow>& window, DescribedMap map,
                     StageProgress* const progress, RunRecord* const record) {
  const Options& options = task.options;
  const absl::StatusOr<Session> query = DescribeSession(
      options.loop_closing, options.scan_places, SourceOfFlags(FLAGS_query),
      window, task.executor, progress->Begin("read and describe the query"));
  if (!query.ok()) return query.status();
  LocalizationOptions localization = options.localization;
  if (!FLAGS_output.empty()) {
    // Every match may contribute.
    localization.num_first_places = std::numeric_limits<int>::max();
    localization.max_num_confirmed_pairs = std::numeric_limits<int>::max();
  }
  const Localization result =
      LocalizeIn(localization, options.loop_closing, map, query->map,
                 task.executor, progress->Callback());
  const Session map_session{FLAGS_map, std::move(map), {}};
  RecordAnswer(map_session, *query, result, record);
  PrintRepair(map_session.map.state);
  PrintRepair(query->map.state);
  PrintSummary(result);
  const absl::Status status =
      WriteFiles(task, map_session, *query, result, progress, record);
  if (!status.ok()) return status;
  PrintPaths();
  return absl::OkStatus();
}

absl::Status RunRelocalize(RunRecord* const record) {
  if (!FLAGS_scan.empty()) return RunScanLocalization(record);
  const absl::StatusOr<MapTask> task = MapTaskOfFlags("relocalize");
  if (!task.ok()) return task.status();
  const absl::StatusOr<std::optional<TimeWindow>> window = WindowOfFlags();
  if (!window.ok()) return window.status();
  StageProgress progress(record);
  absl::StatusOr<DescribedMap> map = DescribeOrRemember(
      task->options.loop_closing, SourceOfFlags(FLAGS_map), FLAGS_places,
      task->executor,
      FLAGS_output.empty() ? PointClouds::kDrop : PointClouds::kKeep,
      progress.Begin("read and describe the map"), record);
  if (!map.ok()) return map.status();
  return IsGiven("num_starts")
             ? RunManyStarts(*task, *map, &progress, record)
             : RunOnce(*task, *window, *std::move(map), &progress, record);
}

}  // namespace

Subcommand RelocalizeSubcommand() {
  Subcommand subcommand{
      "relocalize",
      "find a map, or the start of a drive, in a map",
      "A.pbstream (B.pbstream [--first_seconds N] | --scan S.json) "
      "[--result R.json] [--output M.pbstream] [--report DIR]",
      "Searches for every submap of the query in the map, without a pose "
      "prior. The matches vote, and a pose is reported only if it is certain; "
      "otherwise the result is \"localized\": false with the reason, and the "
      "exit code is still 0, or 3 with --fail_on refused. T_map_query is the "
      "pose of the query's map frame in the map frame [m, rad].\n\n"
      "With --output, writes both maps as one: the query is attached to the "
      "map of --map, which does not move, and optimised. If the query is "
      "not localized, nothing is written, and the exit code is 3.\n\n"
      "With --scan in place of --query, finds a robot that stands still or "
      "drives by its scans: all poses that explain them, each with its "
      "probability. --map may then be a map of ROS's map_server, too.",
      {{"map",
        FileUse::kRead,
        {},
        "Map to search in, a .pbstream, or with --scan also a map of ROS "
        "(.yaml, .pgm, .png)."}},
      {{"query", FileUse::kRead, {}, "Map to search for, a .pbstream."},
       {"scan", FileUse::kReadList},
       "first_seconds",
       "start_seconds",
       "num_starts",
       {"output", FileUse::kCopyMap, {}, "Map to write, a .pbstream of both."},
       {"report", FileUse::kWriteInto, {"index.html"}},
       {"places", FileUse::kCache},
       "repair",
       "drop_odometry",
       "configuration_directory",
       "configuration_basename",
       "threads"},
      &RunRelocalize};
  subcommand.check_flags = &CheckFlagsOfRelocalize;
  subcommand.positional_flags = {"map", "query"};
  return subcommand;
}

}  // namespace cartographer_sdf
