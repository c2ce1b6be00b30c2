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
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr double kDegrees = 180. / M_PI;
constexpr Color kClosureColor{0.84, 0.15, 0.16, 0.55};
constexpr int kMaxPixels = 2400;
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

std::vector<ReportedClosure> ReportedClosures(
    const std::vector<ClosureRecord>& records) {
  std::vector<ReportedClosure> closures;
  for (const ClosureRecord& record : records) {
    ReportedClosure reported;
    reported.match.pair = record.pair;
    reported.match.evidence = record.evidence;
    reported.match.inliers.resize(static_cast<size_t>(record.num_inliers));
    reported.accepted = record.status == ClosureStatus::kInGraph;
    reported.reason = ClosureStatusName(record.status);
    if (reported.accepted) reported.link = kClosureColor;
    closures.push_back(std::move(reported));
  }
  return closures;
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
                            const LogRunResult& result) {
  const absl::StatusOr<MapState> state = ReadMap(map);
  if (!state.ok()) return state.status();
  ReportContent content;
  content.title = "Run of " + FileName(log);
  content.subtitle = result.summary.has_value()
                         ? "Cartographer with the searcher."
                         : "Cartographer alone.";
  content.summary = SummaryRows(result);
  content.closures = ReportedClosures(result.closures);
  content.histograms.push_back(LatencyHistogram(result.sensor_seconds));
  content.options = FormatLiveOptions(options.live);
  ReportOptions report;
  report.map_picture_pixels = kMaxPixels;
  report.max_closure_pictures = 0;
  absl::Status status = DrawPictures(
      {{"The final map; closures of the searcher in red", &*state,
        &state->pose_graph, /*shows_links=*/true}},
      [&map](const SubmapCallback& on_submap) {
        return ReadMap(map, {on_submap, {}}).status();
      },
      report, &content);
  // Also makes the directory.
  if (status.ok()) status = WriteReport(directory, content);
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
