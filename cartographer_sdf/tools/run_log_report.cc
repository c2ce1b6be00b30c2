// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/run_log_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/report/closure_table.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr double kDegrees = 180. / M_PI;
constexpr int kMapPixels = 2400;  // longer side of the map in the page
constexpr double kMilliseconds = 1e3;

// Nearest rank; 0 if there are no values.
double Quantile(std::vector<double> values, const double fraction) {
  if (values.empty()) return 0.;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<size_t>(
      std::ceil(fraction * static_cast<double>(values.size())));
  return values[std::clamp<size_t>(rank, 1, values.size()) - 1];
}

int NumInjected(const LogRunResult& result) {
  return static_cast<int>(
      std::count_if(result.closures.begin(), result.closures.end(),
                    [](const ClosureRecord& record) {
                      return record.status == ClosureStatus::kInGraph;
                    }));
}

// The first node that a constraint connected to the frozen map; null if none.
const NodeMoment* FirstConnected(const LogRunResult& result) {
  for (const NodeMoment& node : result.nodes) {
    if (node.is_connected) return &node;
  }
  return nullptr;
}

double BeginOf(const LogRunResult& result) { return result.nodes.front().time; }

Json LatencyJson(const std::vector<double>& seconds) {
  double sum = 0.;
  for (const double value : seconds) sum += value;
  const auto count = static_cast<double>(std::max<size_t>(1, seconds.size()));
  return {{"mean", kMilliseconds * sum / count},
          {"median", kMilliseconds * Quantile(seconds, 0.5)},
          {"p99", kMilliseconds * Quantile(seconds, 0.99)},
          {"max", kMilliseconds * Quantile(seconds, 1.)}};
}

Json SummaryJson(const LiveSummary& summary) {
  return {{"places", summary.num_places},
          {"submaps", summary.num_submaps},
          {"queries", summary.num_queries},
          {"candidates", summary.num_candidates},
          {"looks", summary.num_looks},
          {"dropped_scans", summary.num_dropped_scans},
          {"matches", summary.num_matches},
          {"closures", summary.num_closures},
          {"injected", summary.num_injected},
          {"constraints", summary.num_constraints},
          {"worker_cpu_seconds", summary.worker_cpu_seconds},
          {"callbacks", summary.num_callbacks},
          {"callback_milliseconds",
           {{"mean", kMilliseconds * summary.callback_mean_seconds},
            {"p99", kMilliseconds * summary.callback_p99_seconds},
            {"max", kMilliseconds * summary.callback_max_seconds}}}};
}

Json ClosuresJson(const std::vector<ClosureRecord>& records) {
  Json json = Json::array();
  for (const ClosureRecord& record : records) {
    const PairPose& pair = record.pair;
    json.push_back(
        {{"reference", ToJson(pair.reference)},
         {"query", ToJson(pair.query)},
         {"T_reference_query", ToJson(pair.T_reference_query)},
         {"score", pair.score},
         {"status", ClosureStatusName(record.status)},
         {"constraints", record.num_constraints},
         {"inliers", record.num_inliers},
         {"overlap_area", record.evidence.overlap_area},
         {"hit_ratio", record.evidence.HitRatio()},
         {"contradiction_ratio", record.evidence.ContradictionRatio()}});
  }
  return json;
}

Json LocalizationsJson(const std::vector<LocalizationMoment>& moments,
                       const double begin) {
  Json json = Json::array();
  for (const LocalizationMoment& moment : moments) {
    const LocalizationResult& result = moment.result;
    json.push_back({{"trajectory", result.trajectory_id},
                    {"localized", result.localized},
                    {"verdict", LocalizationVerdictName(result.verdict)},
                    {"reason", result.reason},
                    {"time", FromHostTime(result.time)},
                    {"T_map_tracking", ToJson(result.T_map_tracking)},
                    {"covariance", ToJson(result.covariance)},
                    {"T_map_local", ToJson(result.T_map_local)},
                    {"score", result.score},
                    {"runner_up_score", result.runner_up_score},
                    {"reference", ToJson(result.reference)},
                    {"queries", result.num_queries},
                    {"seconds_driven", moment.time - begin},
                    {"meters_driven", moment.distance},
                    {"process_cpu_seconds", moment.cpu_seconds},
                    {"query_cpu_seconds", result.cpu_seconds}});
  }
  return json;
}

Json ConnectedJson(const LogRunResult& result) {
  const NodeMoment* const connected = FirstConnected(result);
  if (connected == nullptr) return nullptr;
  return {{"seconds_driven", connected->time - BeginOf(result)},
          {"meters_driven", connected->distance},
          {"process_cpu_seconds", connected->cpu_seconds}};
}

Json RunJson(const std::string& log, const LogRunOptions& options,
             const LogRunResult& result) {
  return {{"log", log},
          {"map", ToJson(options.map_path)},
          {"scans", result.num_scans},
          {"nodes", result.nodes.size()},
          {"trajectory", result.trajectory_id},
          {"seconds", result.duration},
          {"meters", result.distance},
          {"wall_seconds", result.wall_seconds},
          {"cpu_seconds", result.cpu_seconds},
          {"final_wall_seconds", result.final_wall_seconds},
          {"final_cpu_seconds", result.final_cpu_seconds},
          {"max_delay_seconds", result.max_delay_seconds},
          {"add_sensor_data_milliseconds", LatencyJson(result.sensor_seconds)},
          {"connected", ConnectedJson(result)},
          {"localizations",
           LocalizationsJson(result.localizations, BeginOf(result))},
          {"searcher",
           result.summary.has_value() ? SummaryJson(*result.summary) : Json()},
          {"closures", ClosuresJson(result.closures)}};
}

std::string NodesCsv(const LogRunResult& result) {
  std::string csv = "node,time,distance,x,y,yaw,connected,cpu_seconds\n";
  for (const NodeMoment& node : result.nodes) {
    absl::StrAppendFormat(
        &csv, "%d,%.6f,%.3f,%.6f,%.6f,%.6f,%d,%.3f\n", node.node_index,
        node.time, node.distance, node.T_map_tracking.translation().x(),
        node.T_map_tracking.translation().y(), node.T_map_tracking.rotation(),
        node.is_connected ? 1 : 0, node.cpu_seconds);
  }
  return csv;
}

// Names and values of the summary.
using Rows = std::vector<std::pair<std::string, std::string>>;

Rows RunRows(const LogRunResult& result) {
  Rows rows = {
      {"Recording",
       absl::StrFormat("%d scans, %.0f s, %.1f m", result.num_scans,
                       result.duration, result.distance)},
      {"Nodes", absl::StrCat(result.nodes.size())},
      {"Time",
       absl::StrFormat("%.1f s, and %.1f s to finish; CPU %.1f s and %.1f s",
                       result.wall_seconds, result.final_wall_seconds,
                       result.cpu_seconds, result.final_cpu_seconds)},
      {"AddSensorData",
       absl::StrFormat("median %.2f ms, 99 %% %.2f ms",
                       kMilliseconds * Quantile(result.sensor_seconds, 0.5),
                       kMilliseconds * Quantile(result.sensor_seconds, 0.99))}};
  if (result.max_delay_seconds > 0.) {
    rows.emplace_back(
        "Behind real time",
        absl::StrFormat("%.2f s at most", result.max_delay_seconds));
  }
  return rows;
}

Rows SearcherRows(const LiveSummary& summary, const int num_injected) {
  return {{"Searcher",
           absl::StrFormat("%d submaps, %d queries, %d closures, %d of them in "
                           "the pose graph; CPU %.1f s",
                           summary.num_submaps, summary.num_queries,
                           summary.num_closures, num_injected,
                           summary.worker_cpu_seconds)},
          {"Added to AddSensorData",
           absl::StrFormat("mean %.4f ms, 99 %% %.4f ms, max %.4f ms",
                           kMilliseconds * summary.callback_mean_seconds,
                           kMilliseconds * summary.callback_p99_seconds,
                           kMilliseconds * summary.callback_max_seconds)}};
}

std::string LocalizationText(const LocalizationMoment& moment,
                             const double begin) {
  const LocalizationResult& found = moment.result;
  std::string text = LocalizationVerdictName(found.verdict);
  if (found.localized && found.T_map_tracking.has_value()) {
    absl::StrAppendFormat(&text, " at (%.2f, %.2f) m, %.1f deg",
                          found.T_map_tracking->translation().x(),
                          found.T_map_tracking->translation().y(),
                          kDegrees * found.T_map_tracking->rotation());
  }
  absl::StrAppendFormat(
      &text,
      " after %.1f m, %.1f s and %d queries of %.2f s CPU; score %.1f, "
      "runner-up %.1f",
      moment.distance, moment.time - begin, found.num_queries,
      found.cpu_seconds, found.score, found.runner_up_score);
  return text;
}

Rows SummaryRows(const LogRunResult& result) {
  Rows rows = RunRows(result);
  if (result.summary.has_value()) {
    for (auto& row : SearcherRows(*result.summary, NumInjected(result))) {
      rows.push_back(std::move(row));
    }
  }
  for (const LocalizationMoment& moment : result.localizations) {
    rows.emplace_back("Localisation",
                      LocalizationText(moment, BeginOf(result)));
  }
  if (const NodeMoment* const connected = FirstConnected(result);
      connected != nullptr) {
    rows.emplace_back(
        "Bound to the map",
        absl::StrFormat("after %.1f m, %.1f s, CPU %.2f s", connected->distance,
                        connected->time - BeginOf(result),
                        connected->cpu_seconds));
  }
  return rows;
}

std::vector<double> InMilliseconds(std::vector<double> seconds) {
  for (double& value : seconds) value *= kMilliseconds;
  return seconds;
}

HistogramPlot LatencyHistogram(const std::vector<double>& seconds) {
  const double longest = kMilliseconds * Quantile(seconds, 0.99);
  return {"Time of AddSensorData",
          {"ms", {{0., std::max(longest, 1e-3)}}},
          {{"calls", InMilliseconds(seconds)}}};
}

// Of closures beside a live Cartographer, by the options in SDF_LIVE.
std::vector<RowStatus> LiveStatuses() {
  std::vector<RowStatus> statuses = ClosureStatuses("");
  for (RowStatus& status : statuses) {
    if (!status.option.empty()) status.option.erase(0, 1);
  }
  statuses.push_back({ClosureStatusName(ClosureStatus::kReady), "ready",
                      Tone::kNeutral,
                      "Its constraints enter with the next optimisation.", ""});
  statuses.push_back({ClosureStatusName(ClosureStatus::kDetectedOnly),
                      "detected only", Tone::kNeutral,
                      "Injection is switched off, or there is no pose graph.",
                      "inject_constraints"});
  statuses.push_back({ClosureStatusName(ClosureStatus::kGone), "gone",
                      Tone::kNeutral,
                      "One of its submaps was trimmed or deleted before.", ""});
  return statuses;
}

InspectedTable LiveClosureTable(const LiveOptions& options,
                                const std::vector<ClosureRecord>& records) {
  const JudgementOptions& judgement = options.match.verification.judgement;
  const std::string path = "match.verification.judgement";
  InspectedTable table{
      "closures", "Closures", "",
      MatchMeasures(judgement, path,
                    {judgement.min_score, path + ".min_score"}),
      LiveStatuses()};
  table.measures.push_back(
      {"constraints", "constraints", "", 0,
       "Scans that were registered between the two submaps; each is a "
       "constraint of the pose graph.",
       false, Measure::Bound::kAtLeast,
       static_cast<double>(options.constraints.min_num_constraints),
       "constraints.min_num_constraints"});
  for (const ClosureRecord& record : records) {
    Match match;
    match.pair = record.pair;
    match.evidence = record.evidence;
    match.inliers.resize(static_cast<size_t>(record.num_inliers));
    InspectedRow row;
    row.status = ClosureStatusName(record.status);
    row.pair = record.pair;
    row.values = MatchValues(match);
    row.values[2].reset();  // the record has no margin
    row.values.push_back(static_cast<double>(record.num_constraints));
    table.rows.push_back(std::move(row));
  }
  FinishTable(&table);
  return table;
}

// The end of each search, where it says the robot is.
InspectedTable SearchTable(const LocalizationOptions& options,
                           const LogRunResult& result) {
  const std::string path = "localization.localizer.placement.";
  InspectedTable table{
      "searches",
      "Searches",
      "Arrows show where the robot was found.",
      {{"seconds", "after", "s", 1, "Driven until then.", true},
       {"meters", "after", "m", 1, "Driven until then.", true},
       {"score", "score", "", 2, "Log-odds of the answer.", true,
        Measure::Bound::kAtLeast, options.placement.min_score,
        path + "min_score"},
       {"runner_up_score", "runner-up", "", 2,
        "Score of the best answer that it excludes."},
       {"queries", "queries", "", 0, "Of the search."}},
      {{"located", "located", Tone::kGood, "The pose is certain.", ""},
       {"refused", "not located", Tone::kCaution,
        "The best pose is not certain.", path + "min_lead"}}};
  for (const LocalizationMoment& moment : result.localizations) {
    const LocalizationResult& found = moment.result;
    InspectedRow row;
    row.status = found.localized ? "located" : "refused";
    row.remark = found.reason;
    row.T_map_robot = found.T_map_tracking;
    row.values = {moment.time - BeginOf(result), moment.distance, found.score,
                  found.runner_up_score,
                  static_cast<double>(found.num_queries)};
    table.rows.push_back(std::move(row));
  }
  return table;
}

// What the searcher knew of the robot's pose as each node was made. Without a
// map there is nothing to search for.
PathPhases PhasesOf(const LogRunOptions& options, const LogRunResult& result) {
  PathPhases phases;
  if (!options.map_path) return phases;
  // As SearchStateName() has them.
  phases.names = {"searching", "located", "lost"};
  for (const NodeMoment& node : result.nodes) {
    size_t phase = 0;
    for (const LocalizationMoment& moment : result.localizations) {
      if (moment.time > node.time) break;
      phase = moment.result.localized ? 1 : moment.result.was_localized ? 2 : 0;
    }
    phases.phase_of_node[{result.trajectory_id, node.node_index}] = phase;
  }
  return phases;
}

void JudgeRun(const LogRunOptions& options, const LogRunResult& result,
              Inspection* const inspection) {
  const std::string driven =
      absl::StrFormat("%.0f s and %.0f m", result.duration, result.distance);
  if (!options.map_path) {
    inspection->tone = Tone::kGood;
    inspection->verdict = absl::StrFormat(
        "Mapped %s; %s in the pose graph.", driven,
        Counted(static_cast<size_t>(NumInjected(result)), "closure"));
    return;
  }
  for (const LocalizationMoment& moment : result.localizations) {
    if (!moment.result.localized) continue;
    inspection->tone = Tone::kGood;
    inspection->verdict =
        absl::StrFormat("Located after %.1f m and %.1f s of %s.",
                        moment.distance, moment.time - BeginOf(result), driven);
    return;
  }
  inspection->tone = Tone::kCaution;
  inspection->verdict =
      absl::StrCat("Not located in the map, after ", driven, ".");
}

// The submaps of the frozen map, and those of the robot.
void AddRunSubmaps(const MapState& map, const LogRunOptions& options,
                   const LogRunResult& result, Inspection* const inspection) {
  inspection->sessions = {{options.map_path ? "the map" : "the run"}};
  AddSubmaps(map, inspection);
  if (!options.map_path) return;
  inspection->sessions.push_back({"the robot"});
  for (auto& [id, submap] : inspection->submaps) {
    submap.session = id.trajectory == result.trajectory_id ? 1 : 0;
  }
}

Inspection InspectRun(const std::string& log, const MapState& map,
                      const LogRunOptions& options,
                      const LogRunResult& result) {
  Inspection inspection;
  inspection.title = "Run of " + FileName(log);
  JudgeRun(options, result, &inspection);
  inspection.numbers = SummaryRows(result);
  inspection.numbers.emplace_back("Searcher", result.summary.has_value()
                                                  ? "beside Cartographer"
                                                  : "none: Cartographer alone");
  AddRunSubmaps(map, options, result, &inspection);
  inspection.states = {
      {"final", "Final", "The map at the end of the run", &map.pose_graph}};
  inspection.phases = PhasesOf(options, result);
  if (options.map_path) {
    inspection.tables.push_back(
        SearchTable(options.live.localization.localizer, result));
  }
  inspection.tables.push_back(LiveClosureTable(options.live, result.closures));
  inspection.histograms.push_back(LatencyHistogram(result.sensor_seconds));
  inspection.stage_seconds = {{"until the last scan", result.wall_seconds},
                              {"to finish", result.final_wall_seconds}};
  return inspection;
}

}  // namespace

std::string FormatRunSummary(const LogRunResult& result) {
  std::string text;
  for (const auto& [name, value] : SummaryRows(result)) {
    absl::StrAppendFormat(&text, "%-24s %s\n", name, value);
  }
  return text;
}

absl::Status WriteRunReport(const std::string& directory,
                            const std::string& log, const std::string& map,
                            const LogRunOptions& options,
                            const LogRunResult& result,
                            const RunDescription& run) {
  const absl::StatusOr<MapState> state = ReadMap(map);
  if (!state.ok()) return state.status();
  Inspection inspection = InspectRun(log, *state, options, result);
  const ReportRequest request = {directory,
                                 {kMapPixels},
                                 FormatLiveOptions(options.live),
                                 ChangedLiveOptions(options.live),
                                 run};
  absl::Status status = DrawInspection(
      request.options,
      [&map](const SubmapCallback& on_submap) {
        return ReadMap(map, {on_submap, {}}).status();
      },
      &inspection);
  // Also makes the directory.
  if (status.ok()) status = WriteInspector(request, inspection);
  const std::filesystem::path path(directory);
  if (status.ok()) {
    status = WriteWholeFile((path / "nodes.csv").string(), NodesCsv(result));
  }
  if (status.ok()) {
    status = WriteWholeFile((path / "run.json").string(),
                            FormatJson(RunJson(log, options, result)));
  }
  return status;
}

}  // namespace cartographer_sdf
