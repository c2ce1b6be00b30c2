// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/scan_file.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "cartographer_sdf/file/text_file.h"
#include "nlohmann/json.hpp"

namespace cartographer_sdf {
namespace {

using ScanJson = nlohmann::json;

constexpr uintmax_t kMaxScanFileSize = 64'000'000;
constexpr size_t kMaxNumBeams = 1'000'000;
// Farther points, and ranges, are mistakes [m].
constexpr double kMaxScanCoordinate = 1e4;

absl::Status ScanFileError(const std::string& path,
                           const std::string& problem) {
  return absl::InvalidArgumentError(absl::StrCat(path, ": ", problem));
}

Eigen::Vector2f PointAt(const double angle, const double range) {
  return (range * Eigen::Vector2d(std::cos(angle), std::sin(angle)))
      .cast<float>();
}

// --- JSON. ---

// A finite member; `fallback` if there is none.
absl::StatusOr<double> NumberOf(const std::string& path, const ScanJson& object,
                                const char* const name,
                                const std::optional<double> fallback) {
  const auto member = object.find(name);
  if (member == object.end() || member->is_null()) {
    if (fallback) return *fallback;
    return ScanFileError(path,
                         absl::StrCat("a scan has no number \"", name, "\""));
  }
  if (!member->is_number() || !std::isfinite(member->get<double>())) {
    return ScanFileError(path,
                         absl::StrCat("\"", name, "\" is not a finite number"));
  }
  return member->get<double>();
}

// A member that is a pose; none if there is no such member.
absl::StatusOr<std::optional<Rigid2>> PoseMember(const std::string& path,
                                                 const ScanJson& object,
                                                 const char* const name) {
  const auto member = object.find(name);
  if (member == object.end()) return std::nullopt;
  if (!member->is_object()) {
    return ScanFileError(
        path,
        absl::StrCat("\"", name, "\" is not an object with x, y and yaw"));
  }
  double values[3];
  const char* const names[3] = {"x", "y", "yaw"};
  for (int k = 0; k < 3; ++k) {
    const absl::StatusOr<double> value = NumberOf(path, *member, names[k], 0.);
    if (!value.ok()) return value.status();
    if (std::abs(*value) > kMaxScanCoordinate) {
      return ScanFileError(path,
                           absl::StrCat("the pose \"", name, "\" is absurd"));
    }
    values[k] = *value;
  }
  return Rigid2(values[0], values[1], values[2]);
}

absl::StatusOr<Scan> ScanOfPoints(const std::string& path,
                                  const ScanJson& points) {
  if (!points.is_array())
    return ScanFileError(path, "\"points\" is not a list");
  Scan scan;
  for (const ScanJson& point : points) {
    if (!point.is_array() || point.size() < 2 || !point[0].is_number() ||
        !point[1].is_number()) {
      return ScanFileError(path, absl::StrCat("point ", scan.returns.size(),
                                              " is not a list of two numbers"));
    }
    const Eigen::Vector2d p(point[0].get<double>(), point[1].get<double>());
    if (!(p.cwiseAbs().maxCoeff() <= kMaxScanCoordinate)) {
      return ScanFileError(path, absl::StrCat("point ", scan.returns.size(),
                                              " is absurdly far away"));
    }
    scan.returns.push_back(p.cast<float>());
  }
  return scan;
}

// What the header of a scan says of its beams.
struct BeamGeometry {
  double first_angle = 0.;
  double angle_increment = 0.;
  double min_range = 0.;
  double max_range = 0.;
};

absl::StatusOr<BeamGeometry> GeometryOf(const std::string& path,
                                        const ScanJson& scan) {
  const absl::StatusOr<double> first =
      NumberOf(path, scan, "angle_min", std::nullopt);
  const absl::StatusOr<double> increment =
      NumberOf(path, scan, "angle_increment", std::nullopt);
  const absl::StatusOr<double> min_range =
      NumberOf(path, scan, "range_min", 0.);
  const absl::StatusOr<double> max_range =
      NumberOf(path, scan, "range_max", kMaxScanCoordinate);
  for (const auto* const value : {&first, &increment, &min_range, &max_range}) {
    if (!value->ok()) return value->status();
  }
  if (std::abs(*first) > 100. || std::abs(*increment) > M_PI ||
      *increment == 0.) {
    return ScanFileError(path,
                         "\"angle_min\" or \"angle_increment\" is no angle in "
                         "radians");
  }
  if (!(*max_range > 0.))
    return ScanFileError(path, "\"range_max\" is not positive");
  return BeamGeometry{*first, *increment, *min_range, *max_range};
}

absl::StatusOr<Scan> ScanOfRanges(const std::string& path,
                                  const ScanJson& object,
                                  const ScanJson& ranges) {
  if (!ranges.is_array())
    return ScanFileError(path, "\"ranges\" is not a list");
  const absl::StatusOr<BeamGeometry> geometry = GeometryOf(path, object);
  if (!geometry.ok()) return geometry.status();
  Scan scan;
  for (size_t k = 0; k < ranges.size(); ++k) {
    // What is no number says nothing.
    if (ranges[k].is_null()) continue;
    if (!ranges[k].is_number()) {
      return ScanFileError(path, absl::StrCat("range ", k, " is not a number"));
    }
    const double range = ranges[k].get<double>();
    const double angle = geometry->first_angle +
                         static_cast<double>(k) * geometry->angle_increment;
    if (range < geometry->min_range || range <= 0.) continue;
    if (range <= geometry->max_range && range <= kMaxScanCoordinate) {
      scan.returns.push_back(PointAt(angle, range));
    } else if (geometry->max_range < kMaxScanCoordinate) {
      scan.misses.push_back(PointAt(angle, geometry->max_range));
    }
  }
  return scan;
}

// What a file says of a scan.
struct ScanOfFile {
  RobotScan scan;
  std::optional<Rigid2> T_odometry_robot;
  double time = 0.;  // only with odometry
};

absl::StatusOr<ScanOfFile> ScanOfJson(const std::string& path,
                                      const ScanJson& object) {
  if (!object.is_object())
    return ScanFileError(path, "a scan is not an object");
  const absl::StatusOr<std::optional<Rigid2>> sensor =
      PoseMember(path, object, "sensor");
  if (!sensor.ok()) return sensor.status();
  const absl::StatusOr<std::optional<Rigid2>> odometry =
      PoseMember(path, object, "odometry");
  if (!odometry.ok()) return odometry.status();
  const absl::StatusOr<double> time =
      odometry->has_value() ? NumberOf(path, object, "time", std::nullopt)
                            : absl::StatusOr<double>(0.);
  if (!time.ok()) return time.status();
  const auto ranges = object.find("ranges");
  const auto points = object.find("points");
  if ((ranges == object.end()) == (points == object.end())) {
    return ScanFileError(path, "a scan needs either \"ranges\" or \"points\"");
  }
  absl::StatusOr<Scan> scan = ranges != object.end()
                                  ? ScanOfRanges(path, object, *ranges)
                                  : ScanOfPoints(path, *points);
  if (!scan.ok()) return scan.status();
  return ScanOfFile{
      {sensor->value_or(Rigid2()), *std::move(scan)}, *odometry, *time};
}

absl::StatusOr<std::vector<ScanOfFile>> ScansOfJson(const std::string& path,
                                                    const std::string& text) {
  // As Python writes them; JSON knows neither.
  const std::string plain = absl::StrReplaceAll(
      text, {{"-Infinity", "null"}, {"Infinity", "1e300"}, {"NaN", "null"}});
  const ScanJson json =
      ScanJson::parse(plain, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return ScanFileError(path, "this is not JSON");
  const bool has_list = json.is_object() && json.contains("scans");
  const ScanJson& content = has_list ? json["scans"] : json;
  const ScanJson list =
      content.is_array() ? content : ScanJson::array({content});
  std::vector<ScanOfFile> scans;
  for (const ScanJson& object : list) {
    absl::StatusOr<ScanOfFile> scan = ScanOfJson(path, object);
    if (!scan.ok()) return scan.status();
    scans.push_back(*std::move(scan));
  }
  return scans;
}

// --- CSV. ---

absl::StatusOr<std::vector<ScanOfFile>> ScansOfCsv(const std::string& path,
                                                   const bool has_points) {
  const absl::StatusOr<std::vector<CsvRow>> rows =
      ReadCsv(path, {{has_points ? "x" : "angle", CsvType::kNumber},
                     {has_points ? "y" : "range", CsvType::kNumber}});
  if (!rows.ok()) return rows.status();
  RobotScan scan;
  for (const CsvRow& row : *rows) {
    const double a = row.Number(0), b = row.Number(1);
    if (std::abs(a) > kMaxScanCoordinate || std::abs(b) > kMaxScanCoordinate) {
      return LineError(path, row.line, "this is absurdly far away");
    }
    if (has_points) {
      scan.scan.returns.push_back(Eigen::Vector2d(a, b).cast<float>());
    } else if (b > 0.) {
      scan.scan.returns.push_back(PointAt(a, b));
    }
  }
  return std::vector<ScanOfFile>{{std::move(scan), std::nullopt, 0.}};
}

absl::StatusOr<std::vector<ScanOfFile>> ReadAnyScans(const std::string& path) {
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kMaxScanFileSize) {
    return ScanFileError(path, "a file of scans has at most 64 MB");
  }
  const absl::StatusOr<std::vector<TextLine>> lines = ReadLines(path);
  if (!lines.ok()) return lines.status();
  if (lines->empty()) return ScanFileError(path, "the file is empty");
  const std::string& first = lines->front().text;
  if (first[0] != '{' && first[0] != '[') {
    return ScansOfCsv(path, !absl::StrContains(first, "angle"));
  }
  std::string text;
  for (const TextLine& line : *lines) absl::StrAppend(&text, line.text, "\n");
  return ScansOfJson(path, text);
}

absl::Status CheckNumBeams(const std::string& path,
                           const std::vector<ScanOfFile>& scans) {
  size_t num_beams = 0;
  for (const ScanOfFile& scan : scans) {
    num_beams += scan.scan.scan.returns.size() + scan.scan.scan.misses.size();
  }
  if (num_beams == 0) return ScanFileError(path, "there is no beam in it");
  if (num_beams > kMaxNumBeams) {
    return ScanFileError(path, "scans have at most a million beams");
  }
  return absl::OkStatus();
}

// Scans with the same time belong together.
absl::StatusOr<std::vector<OdometryScan>> DriveOf(
    const std::string& path, std::vector<ScanOfFile> scans) {
  std::vector<OdometryScan> drive;
  for (ScanOfFile& scan : scans) {
    if (!scan.T_odometry_robot) {
      return ScanFileError(path,
                           "some scans have \"odometry\", and others have not");
    }
    if (drive.empty() || drive.back().time != scan.time) {
      drive.push_back({scan.time, *scan.T_odometry_robot, {}});
    }
    drive.back().scans.push_back(std::move(scan.scan));
  }
  return drive;
}

}  // namespace

absl::StatusOr<std::vector<RobotScan>> ReadScanFile(const std::string& path) {
  absl::StatusOr<std::vector<ScanOfFile>> scans = ReadAnyScans(path);
  if (!scans.ok()) return scans.status();
  const absl::Status status = CheckNumBeams(path, *scans);
  if (!status.ok()) return status;
  std::vector<RobotScan> robot_scans;
  for (ScanOfFile& scan : *scans) robot_scans.push_back(std::move(scan.scan));
  return robot_scans;
}

absl::StatusOr<ScanRecording> ReadScanRecording(const std::string& path) {
  absl::StatusOr<std::vector<ScanOfFile>> scans = ReadAnyScans(path);
  if (!scans.ok()) return scans.status();
  const absl::Status status = CheckNumBeams(path, *scans);
  if (!status.ok()) return status;
  if (!scans->front().T_odometry_robot) {
    OdometryScan standing;
    for (ScanOfFile& scan : *scans) {
      if (scan.T_odometry_robot) {
        return ScanFileError(
            path, "some scans have \"odometry\", and others have not");
      }
      standing.scans.push_back(std::move(scan.scan));
    }
    return ScanRecording{false, {std::move(standing)}};
  }
  absl::StatusOr<std::vector<OdometryScan>> drive =
      DriveOf(path, *std::move(scans));
  if (!drive.ok()) return drive.status();
  return ScanRecording{true, *std::move(drive)};
}

}  // namespace cartographer_sdf
