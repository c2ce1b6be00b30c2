// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/scan_localization.h"

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
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/map_image/ros_map.h"
#include "cartographer_sdf/recording/scan_file.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/file_flags.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/stages.h"

DEFINE_string(
    scan, "",
    "Scans of a robot that stands still, as JSON or CSV, in place of --query. "
    "A list of files, separated by commas, is several robots: each file is "
    "localised by itself.");

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

struct ScanFile {
  std::string path;
  std::vector<RobotScan> scans;
};

absl::StatusOr<std::vector<ScanFile>> ReadScanFiles() {
  std::vector<ScanFile> files;
  for (const std::string& path : SplitPaths(FLAGS_scan)) {
    absl::StatusOr<std::vector<RobotScan>> scans = ReadScanFile(path);
    if (!scans.ok()) return scans.status();
    files.push_back({path, *std::move(scans)});
  }
  return files;
}

void PrintScanResult(const ScanFile& file, const ScanLocalization& result) {
  if (result.verdict == LocalizationVerdict::kLocalized) {
    std::cout << file.path << ": localized: "
              << FormatPose(result.candidates.front().T_map_robot) << "\n";
  } else {
    std::cout << file.path
              << ": not localized: " << LocalizationVerdictName(result.verdict)
              << "\n";
  }
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

// Prints the results, and writes the report of the single one.
absl::StatusOr<Json> LocalizeFiles(const Options& options, const MapGrid& map,
                                   const PanoramaMap& panoramas,
                                   const std::vector<ScanFile>& files,
                                   const RunDescription& run) {
  Json results = Json::array();
  for (const ScanFile& file : files) {
    const std::clock_t begin = std::clock();
    const ScanLocalization result =
        LocalizeScans(options.scan_localization, panoramas, file.scans);
    const double milliseconds =
        1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    PrintScanResult(file, result);
    results.push_back({{"scan", file.path}});
    results.back().update(ToJson(result));
    results.back()["cpu_milliseconds"] = milliseconds;
    if (FLAGS_report.empty()) continue;
    const absl::Status status = WriteScanReport(
        ReportRequestOfFlags(options, run), options.scan_localization,
        FileName(FLAGS_map), FileName(file.path), map.grid, file.scans, result);
    if (!status.ok()) return status;
  }
  return results;
}

}  // namespace

absl::Status RunScanLocalization(RunRecord* const record) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  // First, as it takes no time to find that they are broken.
  const absl::StatusOr<std::vector<ScanFile>> files = ReadScanFiles();
  if (!files.ok()) return files.status();
  StageProgress progress(record);
  const absl::StatusOr<MapGrid> map = ReadGridOfMap(progress.Begin("read"));
  if (!map.ok()) return map.status();
  const std::optional<PanoramaMap> panoramas = MakePanoramaMap(
      options->scan_localization.viewpoints, map->grid, map->driven_positions);
  if (!panoramas) {
    return absl::FailedPreconditionError(absl::StrCat(
        FLAGS_map, " has no wall, or no free space for a robot to stand in"));
  }
  absl::StatusOr<Json> results =
      LocalizeFiles(*options, *map, *panoramas, *files, record->run);
  if (!results.ok()) return results.status();
  RecordScans(*std::move(results), record);
  PrintPaths();
  return absl::OkStatus();
}

}  // namespace cartographer_sdf
