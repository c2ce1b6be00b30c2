// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/stages.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/pending_file.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pose_graph/host_motion.h"
#include "cartographer_sdf/report/map_summary.h"
#include "cartographer_sdf/tools/file_flags.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/map_picture.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(picture, "",
              "PNG file to draw the map as it becomes to, with the driven "
              "paths. None if empty.");
DEFINE_int32(picture_pixels, 1600,
             "Longer side of --picture at most [pixels]; no pixel is smaller "
             "than a cell.");

namespace cartographer_sdf {
namespace {

// Motions that are not worth a warning [m].
constexpr double kMinHostMotion = 0.1;

// If the map is changed in place, keeps the old one first. At every moment
// there is a whole map under the name of the input.
absl::Status CommitOutput(RecordWriter* const output) {
  const std::string backup = FLAGS_in_place ? BackupPath(FLAGS_input) : "";
  if (backup.empty()) return output->Commit();
  absl::Status status = KeepAs(FLAGS_input, backup);
  if (!status.ok()) return status;
  status = output->Commit();
  std::error_code ignored;
  if (!status.ok()) std::filesystem::remove(backup, ignored);
  return status;
}

// Also paints each submap.
SubmapCallback PaintToo(const PoseGraph& pose_graph, MapPainter* const painter,
                        const SubmapCallback& on_submap) {
  return [&pose_graph, painter, on_submap](const SubmapId& id,
                                           const SubmapSummary& summary,
                                           OccupancyGrid grid) {
    const auto pose = pose_graph.submap_poses.find(id);
    if (pose != pose_graph.submap_poses.end()) {
      painter->AddSubmap(grid, pose->second);
    }
    if (on_submap) on_submap(id, summary, std::move(grid));
  };
}

// Reads the map, and prepares `output` where there is one.
absl::Status ReadAndPrepare(const PoseGraph& pose_graph,
                            const SubmapCallback& on_submap,
                            StageProgress* const progress,
                            std::optional<RecordWriter>* const output) {
  if (FLAGS_output.empty()) {
    return ReadMap(SourceOfFlags(FLAGS_input), {on_submap, {}},
                   progress->Begin("report"))
        .status();
  }
  absl::StatusOr<RecordWriter> map =
      PrepareMap(SourceOfFlags(FLAGS_input), FLAGS_output, pose_graph,
                 {on_submap, {}}, progress->Begin("write"));
  if (!map.ok()) return map.status();
  output->emplace(*std::move(map));
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckPictureFlags() {
  if (FLAGS_picture_pixels < 16 || FLAGS_picture_pixels > 8192) {
    return UsageError("--picture_pixels must be from 16 to 8192");
  }
  return absl::OkStatus();
}

absl::StatusOr<MapTask> MapTaskOfFlags(const std::string& subcommand) {
  absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  if (options->loop_closing.recognition.match.method != Method::kSdf) {
    return absl::InvalidArgumentError(
        absl::StrCat(subcommand,
                     " needs match.method = \"sdf\": counting inliers does not "
                     "verify a match"));
  }
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  absl::StatusOr<std::set<int>> frozen = FrozenTrajectoriesOfFlags();
  if (!frozen.ok()) return frozen.status();
  return MapTask{*std::move(options), MakeExecutor(*num_threads),
                 *std::move(frozen)};
}

absl::StatusOr<DescribedMap> DescribeOrRemember(
    const LoopClosingOptions& options, const MapSource& source,
    const std::string& places_path, const Executor& executor,
    const PointClouds point_clouds, const ProgressCallback& on_progress,
    RunRecord* const record) {
  const MatchOptions& match = options.recognition.match;
  if (places_path.empty()) {
    return DescribeMap(options.place, match, source, executor, on_progress,
                       point_clouds);
  }
  absl::StatusOr<RememberedMap> remembered = RememberMap(
      options.place, match, FormatPlaceOptions(options.place, match), source,
      places_path, executor, on_progress, point_clouds);
  if (!remembered.ok()) return remembered.status();
  if (!remembered->complaint.empty()) {
    std::cerr << "--places: " << remembered->complaint << "\n";
    record->Warn(RunWarning::kPlacesNotUsed, remembered->complaint);
  }
  return std::move(remembered->map);
}

MapDescriber DescriberOfFlags(const MapTask& task,
                              const std::vector<std::string>& maps,
                              RunRecord* const record) {
  std::map<std::string, std::string> places_of_map;
  const std::vector<std::string> places = SplitPaths(FLAGS_places);
  for (size_t k = 0; k < std::min(maps.size(), places.size()); ++k) {
    places_of_map[maps[k]] = places[k];
  }
  return [&task, places_of_map, record](const MapSource& source,
                                        const ProgressCallback& on_progress) {
    const auto found = places_of_map.find(source.path);
    return DescribeOrRemember(task.options.loop_closing, source,
                              found == places_of_map.end() ? "" : found->second,
                              task.executor, PointClouds::kKeep, on_progress,
                              record);
  };
}

absl::Status WriteMapAndReport(
    const MapState& state, const PoseGraph& pose_graph,
    const std::function<absl::Status(const SubmapsReader&)>& write_report,
    StageProgress* const progress) {
  std::optional<RecordWriter> output;
  std::optional<MapPainter> painter;
  if (!FLAGS_picture.empty()) {
    painter.emplace(PlaceGrids(state, pose_graph), FLAGS_picture_pixels);
  }
  const auto read_and_write = [&](const SubmapCallback& on_submap) {
    return ReadAndPrepare(
        pose_graph,
        painter ? PaintToo(pose_graph, &*painter, on_submap) : on_submap,
        progress, &output);
  };
  absl::Status status;
  if (!FLAGS_report.empty()) {
    status = write_report(read_and_write);
  } else if (!FLAGS_output.empty() || painter) {
    status = read_and_write({});
  }
  if (status.ok() && painter) {
    status = WriteWholeFile(FLAGS_picture,
                            PaintWithPaths(*painter, pose_graph).EncodePng());
  }
  return status.ok() && output ? CommitOutput(&*output) : status;
}

std::map<std::string, int> CountStatuses(const std::vector<Closure>& closures) {
  std::map<std::string, int> counts;
  for (const Closure& closure : closures) {
    ++counts[ClosureStatusName(closure.status)];
  }
  return counts;
}

void RecordTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps,
                       RunRecord* const record) {
  record->Count("torn_submaps", torn_submaps.size());
  Json ids = Json::array();
  for (const auto& [id, tear] : torn_submaps) ids.push_back(ToJson(id));
  record->answer["torn_submaps"] = std::move(ids);
  if (torn_submaps.empty()) return;
  record->Warn(
      RunWarning::kTornSubmaps,
      absl::StrFormat("%d submaps are torn inside", torn_submaps.size()));
}

void RecordSlips(const Slips& slips, const PoseGraph& pose_graph,
                 RunRecord* const record) {
  record->Count("slips", slips.size());
  Json steps = Json::array();
  for (const auto& [node, angle] : slips) {
    steps.push_back({{"trajectory", node.trajectory},
                     {"node", node.index},
                     {"angle", angle}});
  }
  record->answer["slips"] = std::move(steps);
  if (slips.empty()) return;
  record->Warn(RunWarning::kSlips, DescribeSlips(slips, pose_graph));
}

void PrintStages(const std::vector<std::pair<std::string, double>>& seconds) {
  for (const auto& [stage, duration] : seconds) {
    std::cout << absl::StrFormat("  %7.2f s %s\n", duration, stage);
  }
}

void PrintStatuses(const std::string& prefix,
                   const std::vector<Closure>& closures) {
  std::map<ClosureStatus, int> counts;
  for (const Closure& closure : closures) ++counts[closure.status];
  for (const auto& [status, count] : counts) {
    std::cout << absl::StrFormat("  %5d %s%s\n", count, prefix,
                                 ClosureStatusName(status));
  }
}

void PrintConvergence(const std::vector<OptimizationSummary>& summaries) {
  if (summaries.empty() || summaries.back().converged) return;
  std::cout << "The optimisation did not converge: " << summaries.back().message
            << "\n";
}

void WarnOfHostMotion(const ClosingOptions& closing,
                      const OptimizationOptions& in_force,
                      const PoseGraph& pose_graph, RunRecord* const record) {
  const std::optional<HostMotion> motion =
      PredictHostMotion(closing.optimization, in_force, pose_graph);
  if (!motion || motion->max_translation < kMinHostMotion) return;
  const auto format = [](const OdometryWeights& weights) {
    return absl::StrFormat("%.3g and %.3g", weights.translation,
                           weights.rotation);
  };
  std::string sentence = absl::StrFormat(
      "Cartographer would move nodes by up to %.1f m if it loaded this map "
      "unfrozen, with its odometry weights of %s; those of the map are %s",
      motion->max_translation, format(motion->host_weights),
      format(motion->map_weights));
  if (motion->num_slips > 0) {
    absl::StrAppend(&sentence,
                    ", and it does not give way where local SLAM "
                    "slipped");
  }
  record->Warn(RunWarning::kOdometryBends, sentence);
  std::cout << sentence << ".\n  Load it frozen"
            << (motion->num_slips > 0
                    ? ".\n"
                    : ", set odometry_translation_weight and "
                      "odometry_rotation_weight of "
                      "POSE_GRAPH.optimization_problem to those of the map, or "
                      "write it with --drop_odometry.\n");
}

absl::Status CheckDropOdometry() {
  if (!FLAGS_drop_odometry || !FLAGS_output.empty() || FLAGS_in_place) {
    return absl::OkStatus();
  }
  return UsageError("--drop_odometry needs a map to write: --output");
}

void PrintPaths() {
  if (!FLAGS_output.empty()) std::cout << FLAGS_output << "\n";
  if (FLAGS_in_place && FLAGS_backup) {
    std::cout << BackupPath(FLAGS_input) << " (the old map)\n";
  }
  if (!FLAGS_report.empty()) std::cout << FLAGS_report << "/index.html\n";
}

}  // namespace cartographer_sdf
