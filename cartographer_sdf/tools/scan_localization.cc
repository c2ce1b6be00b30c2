// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/scan_localization.h"

#include <algorithm>
#include <ctime>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/apps/map_grid.h"
#include "cartographer_sdf/apps/robot_scans.h"
#include "cartographer_sdf/localization/panorama_file.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/scan_session.h"
#include "cartographer_sdf/map_image/ros_map.h"
#include "cartographer_sdf/recording/scan_file.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/file_flags.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(
    scan, "",
    "Scans of a robot, in place of --query: of one that stands still, as JSON "
    "or CSV, or of one that drives, as JSON with odometry, a log of CARMEN "
    "(.log, .log.gz, .clf, .clf.gz) or a .pbstream. A list of files, separated "
    "by commas, is several robots: each file is localised by itself.");
DECLARE_double(first_seconds);
DECLARE_double(start_seconds);
DECLARE_int32(num_starts);

namespace cartographer_sdf {
namespace {

constexpr double kMinShownProbability = 0.01;

absl::StatusOr<MapGrid> ReadGridOfMap(const ProgressCallback& on_progress) {
  if (!IsRosMapName(FLAGS_map)) {
    return ReadMapGrid(SourceOfFlags(FLAGS_map), on_progress);
  }
  absl::StatusOr<OccupancyGrid> grid = ReadRosMap(FLAGS_map);
  if (!grid.ok()) return grid.status();
  return MapGrid{*std::move(grid), {}};
}

absl::StatusOr<DrawnMap> DrawMap(const ViewpointOptions& options, MapGrid map) {
  std::optional<PanoramaMap> panoramas =
      MakePanoramaMap(options, map.grid, map.driven_positions);
  if (!panoramas) {
    return absl::FailedPreconditionError(absl::StrCat(
        FLAGS_map, " has no wall, or no free space for a robot to stand in"));
  }
  return DrawnMap{std::move(map.grid), *std::move(panoramas)};
}

// A map of ROS is several files, and quickly read. Of a .pbstream, poses count:
// panoramas are drawn of the whole map.
absl::StatusOr<PlaceFileKey> KeyOfMap(const std::string& options_text,
                                      const std::optional<MapGrid>& ros_map) {
  return ros_map
             ? absl::StatusOr<PlaceFileKey>(
                   MakeGridKey(ros_map->grid, options_text))
             : MakePlaceFileKey(FLAGS_map, options_text, PoseGraphInKey::kYes);
}

// From the file of --places, which is written where it does not fit.
absl::StatusOr<DrawnMap> ReadOrDrawMap(const ViewpointOptions& options,
                                       const ProgressCallback& on_progress,
                                       RunRecord* const record) {
  std::optional<MapGrid> map;
  if (FLAGS_places.empty() || IsRosMapName(FLAGS_map)) {
    absl::StatusOr<MapGrid> read = ReadGridOfMap(on_progress);
    if (!read.ok()) return read.status();
    map = *std::move(read);
  }
  if (FLAGS_places.empty()) return DrawMap(options, *std::move(map));
  const absl::StatusOr<PlaceFileKey> key =
      KeyOfMap(FormatPanoramaOptions(options), map);
  if (!key.ok()) return key.status();
  absl::StatusOr<DrawnMap> drawn = ReadPanoramas(FLAGS_places, *key);
  if (drawn.ok()) return drawn;
  std::string complaint;
  if (!absl::IsNotFound(drawn.status()))
    complaint = std::string(drawn.status().message());
  if (!map) {
    absl::StatusOr<MapGrid> read = ReadGridOfMap(on_progress);
    if (!read.ok()) return read.status();
    map = *std::move(read);
  }
  drawn = DrawMap(options, *std::move(map));
  if (!drawn.ok()) return drawn;
  const absl::Status status = WritePanoramas(FLAGS_places, *key, *drawn);
  if (!status.ok()) complaint = std::string(status.message());
  if (!complaint.empty()) {
    std::cerr << "--places: " << complaint << "\n";
    record->Warn(RunWarning::kPlacesNotUsed, complaint);
  }
  return drawn;
}

// The scans of a robot that stands still (one OdometryScan) or drives.
struct ScanQuery {
  std::string path;
  ScanRecording recording;
};

absl::StatusOr<std::vector<ScanQuery>> ReadScanQueries() {
  std::vector<ScanQuery> queries;
  for (const std::string& path : SplitPaths(FLAGS_scan)) {
    absl::StatusOr<ScanRecording> recording =
        ReadRobotScans(SourceOfFlags(path));
    if (!recording.ok()) return recording.status();
    if (FLAGS_first_seconds > 0. && !recording->is_drive) {
      return UsageError(
          absl::StrCat("--first_seconds needs a drive, and the scans of ", path,
                       " have no odometry"));
    }
    queries.push_back({path, *std::move(recording)});
  }
  return queries;
}

// When the drives to localise begin, in seconds after the first scan.
std::vector<double> StartsOf(const std::vector<OdometryScan>& scans) {
  if (FLAGS_num_starts == 1) return {FLAGS_start_seconds};
  const double latest = std::max(
      0., scans.back().time - scans.front().time - FLAGS_first_seconds);
  std::vector<double> starts;
  for (int k = 0; k < FLAGS_num_starts; ++k) {
    starts.push_back(latest * k / (FLAGS_num_starts - 1));
  }
  return starts;
}

std::vector<OdometryScan> ScansFrom(const std::vector<OdometryScan>& scans,
                                    const double start) {
  const double begin = scans.front().time + start;
  std::vector<OdometryScan> window;
  for (const OdometryScan& scan : scans) {
    if (scan.time < begin) continue;
    if (FLAGS_first_seconds > 0. && scan.time > begin + FLAGS_first_seconds) {
      continue;
    }
    window.push_back(scan);
  }
  return window;
}

void PrintCandidates(const ScanLocalization& result) {
  std::cout << "  " << result.reason << "\n";
  for (const ScanCandidate& candidate : result.candidates) {
    if (candidate.probability < kMinShownProbability) continue;
    std::cout << absl::StrFormat("  %6.4f  %s\n", candidate.probability,
                                 FormatPose(candidate.T_map_robot));
  }
  if (!result.elsewhere_probability) return;
  std::cout << absl::StrFormat("  %6.4f  elsewhere\n",
                               *result.elsewhere_probability);
}

void PrintAnswer(const std::string& name,
                 const std::optional<Rigid2>& T_map_robot,
                 const ScanLocalization& result) {
  std::cout << name << ": "
            << (T_map_robot
                    ? absl::StrCat("localized: ", FormatPose(*T_map_robot))
                    : absl::StrCat("not localized: ",
                                   LocalizationVerdictName(result.verdict)))
            << "\n";
  PrintCandidates(result);
}

double MillisecondsSince(const std::clock_t begin) {
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

Json StepJson(const SessionAnswer& answer, const double seconds,
              const double meters, const double milliseconds) {
  const ScanLocalization& found = answer.localization;
  Json step = {{"seconds", seconds},
               {"meters", meters},
               {"state", ScanSearchStateName(answer.state)},
               {"use", ScanUseName(answer.use)},
               {"T_map_robot", ToJson(answer.T_map_robot)},
               {"elsewhere_probability", ToJson(found.elsewhere_probability)},
               {"best_T_map_robot", Json()},
               {"best_probability", Json()},
               {"cpu_milliseconds", milliseconds}};
  if (!found.candidates.empty()) {
    step["best_T_map_robot"] = ToJson(found.candidates.front().T_map_robot);
    step["best_probability"] = found.candidates.front().probability;
  }
  return step;
}

struct LocalizedDrive {
  SessionAnswer answer;
  Json history = Json::array();
  double milliseconds = 0.;
};

// Adds the scans one by one, and prints when the robot is located or lost.
LocalizedDrive LocalizeDrive(const Options& options, const PanoramaMap& map,
                             const std::string& name,
                             const std::vector<OdometryScan>& scans) {
  LocalizedDrive drive;
  ScanSession session(options.scan_localization, options.scan_session, map);
  ScanSearchState state = ScanSearchState::kSearching;
  double meters = 0.;
  std::optional<Rigid2> T_odometry_last;
  for (const OdometryScan& scan : scans) {
    const std::clock_t begin = std::clock();
    const SessionAnswer& answer = session.Add(scan);
    drive.milliseconds += MillisecondsSince(begin);
    const double seconds = scan.time - scans.front().time;
    if (T_odometry_last) {
      meters += (T_odometry_last->Inverse() * scan.T_odometry_robot)
                    .translation()
                    .norm();
    }
    T_odometry_last = scan.T_odometry_robot;
    if (answer.state != state) {
      state = answer.state;
      std::cout << absl::StrFormat("%s: %s after %.1f s and %.1f m", name,
                                   ScanSearchStateName(state), seconds, meters);
      if (answer.T_map_robot) {
        std::cout << ": " << FormatPose(*answer.T_map_robot);
      }
      std::cout << "\n";
    } else if (answer.use == ScanUse::kNotMoved) {
      continue;
    }
    drive.history.push_back(
        StepJson(answer, seconds, meters, drive.milliseconds));
  }
  drive.answer = session.answer();
  return drive;
}

// Refused if any robot was not localised, with the reason of the first.
void RecordScans(Json results, RunRecord* const record) {
  size_t num_localized = 0;
  for (const Json& result : results) {
    if (result.at("localized").get<bool>()) {
      ++num_localized;
    } else if (record->outcome == Outcome::kDone) {
      record->End(Outcome::kRefused, result.at("reason").get<std::string>());
    }
  }
  record->Count("scans", results.size());
  record->Count("scans_localized", num_localized);
  record->answer["scans"] = std::move(results);
}

absl::Status WriteReportOf(const Options& options, const DrawnMap& map,
                           const ScanQuery& query,
                           const std::vector<RobotScan>& scans,
                           const ScanLocalization& result,
                           const RunDescription& run) {
  if (FLAGS_report.empty()) return absl::OkStatus();
  return WriteScanReport(ReportRequestOfFlags(options, run),
                         options.scan_localization, FileName(FLAGS_map),
                         FileName(query.path), map.grid, scans, result);
}

absl::Status LocalizeStanding(const Options& options, const DrawnMap& map,
                              const ScanQuery& query, const RunDescription& run,
                              Json* const results) {
  const std::vector<RobotScan>& scans = query.recording.scans.front().scans;
  const std::clock_t begin = std::clock();
  const ScanLocalization result =
      LocalizeScans(options.scan_localization, map.panoramas, scans);
  const double milliseconds = MillisecondsSince(begin);
  std::optional<Rigid2> T_map_robot;
  if (result.verdict == LocalizationVerdict::kLocalized) {
    T_map_robot = result.candidates.front().T_map_robot;
  }
  PrintAnswer(query.path, T_map_robot, result);
  results->push_back({{"scan", query.path}});
  results->back().update(ToJson(result));
  results->back()["cpu_milliseconds"] = milliseconds;
  return WriteReportOf(options, map, query, scans, result, run);
}

absl::Status LocalizeDriving(const Options& options, const DrawnMap& map,
                             const ScanQuery& query, const RunDescription& run,
                             Json* const results) {
  for (const double start : StartsOf(query.recording.scans)) {
    const std::vector<OdometryScan> scans =
        ScansFrom(query.recording.scans, start);
    if (scans.empty()) {
      return absl::FailedPreconditionError(
          absl::StrFormat("%s has no scan from %g s on", query.path, start));
    }
    const std::string name =
        FLAGS_num_starts == 1
            ? query.path
            : absl::StrFormat("%s from %.1f s on", query.path, start);
    LocalizedDrive drive = LocalizeDrive(options, map.panoramas, name, scans);
    PrintAnswer(name, drive.answer.T_map_robot, drive.answer.localization);
    results->push_back({{"scan", query.path}, {"start_seconds", start}});
    results->back().update(ToJson(drive.answer));
    results->back()["cpu_milliseconds"] = drive.milliseconds;
    results->back()["history"] = std::move(drive.history);
    const absl::Status status =
        WriteReportOf(options, map, query, scans.back().scans,
                      drive.answer.localization, run);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

// Prints the results, and writes the report of the single one.
absl::StatusOr<Json> LocalizeQueries(const Options& options,
                                     const DrawnMap& map,
                                     const std::vector<ScanQuery>& queries,
                                     const RunDescription& run) {
  Json results = Json::array();
  for (const ScanQuery& query : queries) {
    const absl::Status status =
        query.recording.is_drive
            ? LocalizeDriving(options, map, query, run, &results)
            : LocalizeStanding(options, map, query, run, &results);
    if (!status.ok()) return status;
  }
  return results;
}

}  // namespace

absl::Status RunScanLocalization(RunRecord* const record) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  // First, as it takes no time to find that they are broken.
  const absl::StatusOr<std::vector<ScanQuery>> queries = ReadScanQueries();
  if (!queries.ok()) return queries.status();
  StageProgress progress(record);
  const absl::StatusOr<DrawnMap> map = ReadOrDrawMap(
      options->scan_localization.viewpoints, progress.Begin("read"), record);
  if (!map.ok()) return map.status();
  absl::StatusOr<Json> results =
      LocalizeQueries(*options, *map, *queries, record->run);
  if (!results.ok()) return results.status();
  RecordScans(*std::move(results), record);
  PrintPaths();
  return absl::OkStatus();
}

}  // namespace cartographer_sdf
