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
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/html_report.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/tools/json.h"

namespace cartographer_sdf {
namespace {

constexpr double kDegrees = 180. / M_PI;
constexpr Color kClosureColor{0.84, 0.15, 0.16, 0.55};
constexpr int kMaxPixels = 2400;
constexpr double kMilliseconds = 1e3;

// Nearest rank; 0 of nothing.
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
                      return record.fate == ClosureFate::kInjected;
                    }));
}

// The first node that a constraint bound to the frozen map; null if none.
const NodeMoment* FirstConnected(const LogRunResult& result) {
  for (const NodeMoment& node : result.nodes) {
    if (node.is_connected) return &node;
  }
  return nullptr;
}

double BeginOf(const LogRunResult& result) { return result.nodes.front().time; }

Json PoseJson(const Rigid2& pose) {
  return Json::Object({{"x", pose.translation().x()},
                       {"y", pose.translation().y()},
                       {"yaw", pose.rotation()}});
}

Json SubmapJson(const SubmapId& id) {
  return Json::Object({{"trajectory", id.trajectory}, {"index", id.index}});
}

Json LatencyJson(const std::vector<double>& seconds) {
  double sum = 0.;
  for (const double value : seconds) sum += value;
  const auto count = static_cast<double>(std::max<size_t>(1, seconds.size()));
  return Json::Object({{"mean", kMilliseconds * sum / count},
                       {"median", kMilliseconds * Quantile(seconds, 0.5)},
                       {"p99", kMilliseconds * Quantile(seconds, 0.99)},
                       {"max", kMilliseconds * Quantile(seconds, 1.)}});
}

Json SummaryJson(const LiveSummary& summary) {
  std::vector<std::pair<std::string, Json>> matches;
  for (const auto& [verdict, count] : summary.num_matches) {
    matches.emplace_back(verdict, count);
  }
  return Json::Object(
      {{"places", summary.num_places},
       {"submaps", summary.num_submaps},
       {"queries", summary.num_queries},
       {"candidates", summary.num_candidates},
       {"matches", Json::Object(std::move(matches))},
       {"closures", summary.num_closures},
       {"injected", summary.num_injected},
       {"constraints", summary.num_constraints},
       {"worker_cpu_seconds", summary.worker_cpu_seconds},
       {"callbacks", static_cast<double>(summary.num_callbacks)},
       {"callback_milliseconds",
        Json::Object(
            {{"mean", kMilliseconds * summary.callback_mean_seconds},
             {"p99", kMilliseconds * summary.callback_p99_seconds},
             {"max", kMilliseconds * summary.callback_max_seconds}})}});
}

Json ClosureJson(const ClosureRecord& record) {
  const LoopClosure& closure = record.closure;
  return Json::Object(
      {{"reference", SubmapJson(closure.reference)},
       {"query", SubmapJson(closure.query)},
       {"T_reference_query", PoseJson(closure.T_reference_query)},
       {"score", closure.score},
       {"fate", ClosureFateName(record.fate)},
       {"constraints", record.num_constraints},
       {"inliers", closure.evidence.inliers},
       {"overlap_area", closure.evidence.overlap_area},
       {"hit_ratio", closure.evidence.hit_ratio},
       {"contradiction_ratio", closure.evidence.contradiction_ratio}});
}

Json LocalizationJson(const LocalizationMoment& moment, const double begin) {
  const LocalizationResult& result = moment.result;
  return Json::Object({{"trajectory", result.trajectory_id},
                       {"located", result.located},
                       {"reason", LocalizationReasonName(result.reason)},
                       {"time", FromHostTime(result.time)},
                       {"T_map_node", result.T_map_node.has_value()
                                          ? PoseJson(*result.T_map_node)
                                          : Json::Null()},
                       {"T_map_local", result.T_map_local.has_value()
                                           ? PoseJson(*result.T_map_local)
                                           : Json::Null()},
                       {"score", result.score},
                       {"runner_up_score", result.runner_up_score},
                       {"reference", result.reference.has_value()
                                         ? SubmapJson(*result.reference)
                                         : Json::Null()},
                       {"queries", result.num_queries},
                       {"seconds_driven", moment.time - begin},
                       {"meters_driven", moment.distance},
                       {"process_cpu_seconds", moment.cpu_seconds},
                       {"query_cpu_seconds", result.cpu_seconds}});
}

Json RunJson(const std::string& log, const LogRunOptions& options,
             const LogRunResult& result) {
  const double begin = BeginOf(result);
  std::vector<Json> closures;
  for (const ClosureRecord& record : result.closures) {
    closures.push_back(ClosureJson(record));
  }
  std::vector<Json> localizations;
  for (const LocalizationMoment& moment : result.localizations) {
    localizations.push_back(LocalizationJson(moment, begin));
  }
  const NodeMoment* const connected = FirstConnected(result);
  return Json::Object(
      {{"log", log},
       {"map",
        options.map_path.has_value() ? Json(*options.map_path) : Json::Null()},
       {"scans", result.num_scans},
       {"nodes", static_cast<int>(result.nodes.size())},
       {"trajectory", result.trajectory_id},
       {"seconds", result.duration},
       {"meters", result.distance},
       {"wall_seconds", result.wall_seconds},
       {"cpu_seconds", result.cpu_seconds},
       {"final_wall_seconds", result.final_wall_seconds},
       {"final_cpu_seconds", result.final_cpu_seconds},
       {"max_delay_seconds", result.max_delay_seconds},
       {"add_sensor_data_milliseconds", LatencyJson(result.sensor_seconds)},
       {"connected",
        connected == nullptr
            ? Json::Null()
            : Json::Object({{"seconds_driven", connected->time - begin},
                            {"meters_driven", connected->distance},
                            {"process_cpu_seconds", connected->cpu_seconds}})},
       {"localizations", Json::Array(std::move(localizations))},
       {"searcher", result.summary.has_value() ? SummaryJson(*result.summary)
                                               : Json::Null()},
       {"closures", Json::Array(std::move(closures))}});
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

// The map at the end, with the paths of its trajectories and the closures
// between the origins of their submaps.
absl::StatusOr<ReportedPicture> PaintMap(
    const std::string& map, const std::vector<ClosureRecord>& closures) {
  const absl::StatusOr<MapState> state = ReadMap(map);
  if (!state.ok()) return state.status();
  const PoseGraph& pose_graph = state->pose_graph;
  std::vector<PlacedGrid> grids;
  for (const auto& [id, submap] : state->submaps) {
    const auto pose = pose_graph.submap_poses.find(id);
    if (pose != pose_graph.submap_poses.end()) {
      grids.push_back({submap.geometry, pose->second});
    }
  }
  MapPainter painter(grids, kMaxPixels);
  const absl::StatusOr<MapState> read = ReadMap(
      map,
      [&](const SubmapId& id, const SubmapSummary&, const OccupancyGrid& grid) {
        const auto pose = pose_graph.submap_poses.find(id);
        if (pose != pose_graph.submap_poses.end()) {
          painter.AddSubmap(grid, pose->second);
        }
      });
  if (!read.ok()) return read.status();
  Picture picture = painter.Paint();
  DrawMetricGrid(painter.frame(), &picture);
  std::map<int, std::vector<Eigen::Vector2d>> paths;
  for (const auto& [id, node] : pose_graph.nodes) {
    paths[id.trajectory].push_back(node.T_map_node.translation());
  }
  for (const auto& [trajectory, path] : paths) {
    DrawTrajectory(path, painter.frame(), CategoryColor(trajectory), &picture);
  }
  for (const ClosureRecord& record : closures) {
    const auto reference =
        pose_graph.submap_poses.find(record.closure.reference);
    const auto query = pose_graph.submap_poses.find(record.closure.query);
    if (record.fate == ClosureFate::kInjected &&
        reference != pose_graph.submap_poses.end() &&
        query != pose_graph.submap_poses.end()) {
      DrawLink(reference->second.translation(), query->second.translation(),
               painter.frame(), kClosureColor, &picture);
    }
  }
  DrawScaleBar(painter.frame(), &picture);
  return ReportedPicture{"The map at the end; closures of the searcher in red",
                         picture.EncodePng()};
}

std::vector<std::pair<std::string, std::string>> SummaryRows(
    const LogRunResult& result) {
  std::vector<std::pair<std::string, std::string>> rows = {
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
  if (result.summary.has_value()) {
    const LiveSummary& summary = *result.summary;
    rows.emplace_back(
        "Searcher",
        absl::StrFormat("%d submaps, %d queries, %d closures, %d of them in "
                        "the pose graph; CPU %.1f s",
                        summary.num_submaps, summary.num_queries,
                        summary.num_closures, NumInjected(result),
                        summary.worker_cpu_seconds));
    rows.emplace_back(
        "Added to AddSensorData",
        absl::StrFormat("mean %.4f ms, 99 %% %.4f ms, max %.4f ms",
                        kMilliseconds * summary.callback_mean_seconds,
                        kMilliseconds * summary.callback_p99_seconds,
                        kMilliseconds * summary.callback_max_seconds));
  }
  for (const LocalizationMoment& moment : result.localizations) {
    const LocalizationResult& found = moment.result;
    std::string text = LocalizationReasonName(found.reason);
    if (found.located && found.T_map_node.has_value()) {
      absl::StrAppendFormat(&text, " at (%.2f, %.2f) m, %.1f deg",
                            found.T_map_node->translation().x(),
                            found.T_map_node->translation().y(),
                            kDegrees * found.T_map_node->rotation());
    }
    absl::StrAppendFormat(
        &text,
        " after %.1f m, %.1f s and %d queries of %.2f s CPU; score %.1f, "
        "runner-up %.1f",
        moment.distance, moment.time - BeginOf(result), found.num_queries,
        found.cpu_seconds, found.score, found.runner_up_score);
    rows.emplace_back("Localisation", text);
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
  absl::StatusOr<ReportedPicture> picture = PaintMap(map, result.closures);
  if (!picture.ok()) return picture.status();
  ReportContent content;
  content.title =
      absl::StrCat("Run of ", std::filesystem::path(log).filename().string());
  content.subtitle = result.summary.has_value()
                         ? "Cartographer with the searcher around it."
                         : "Cartographer alone.";
  content.summary = SummaryRows(result);
  content.maps.push_back(*std::move(picture));
  for (const ClosureRecord& record : result.closures) {
    ReportedClosure reported;
    reported.closure = record.closure;
    reported.accepted = record.fate == ClosureFate::kInjected;
    reported.reason = ClosureFateName(record.fate);
    content.closures.push_back(std::move(reported));
  }
  HistogramPlot latency;
  latency.title = "Time of AddSensorData";
  latency.x.label = "ms";
  const double longest = kMilliseconds * Quantile(result.sensor_seconds, 0.99);
  latency.x.range = {0., std::max(longest, 1e-3)};
  latency.series = {{"calls", InMilliseconds(result.sensor_seconds)}};
  content.histograms.push_back(std::move(latency));
  content.options = FormatLiveOptions(options.live);
  // Makes the directory, too.
  if (absl::Status status = WriteReport(directory, content, ReportOptions());
      !status.ok()) {
    return status;
  }
  const std::filesystem::path path(directory);
  if (absl::Status status =
          WriteWholeFile((path / "nodes.csv").string(), NodesCsv(result));
      !status.ok()) {
    return status;
  }
  return WriteWholeFile((path / "run.json").string(),
                        RunJson(log, options, result).Format());
}

}  // namespace cartographer_sdf
