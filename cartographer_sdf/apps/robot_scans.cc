// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/robot_scans.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/localization/scan_places.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/recording/carmen_log.h"
#include "cartographer_sdf/recording/recording.h"

namespace cartographer_sdf {
namespace {

absl::StatusOr<ScanRecording> ReadDriveOfMap(const MapSource& source) {
  const absl::StatusOr<DescribedMap> map = ReadMapWithScans(source);
  if (!map.ok()) return map.status();
  if (map->point_clouds.empty()) {
    return absl::FailedPreconditionError(
        absl::StrCat(source.path, " has no node with a scan"));
  }
  return ScanRecording{
      true, OdometryScansOf(*map, map->point_clouds.begin()->first.trajectory)};
}

}  // namespace

absl::StatusOr<ScanRecording> ReadRobotScans(const MapSource& source) {
  if (absl::EndsWith(source.path, ".pbstream")) return ReadDriveOfMap(source);
  for (const char* const suffix : {".log", ".log.gz", ".clf", ".clf.gz"}) {
    if (!absl::EndsWith(source.path, suffix)) continue;
    const absl::StatusOr<Recording> log = ReadCarmenLog(source.path, {});
    if (!log.ok()) return log.status();
    return ScanRecording{true, OdometryScansOf(*log)};
  }
  return ReadScanRecording(source.path);
}

}  // namespace cartographer_sdf
