// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/carmen_log.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"

namespace cartographer_sdf {
namespace {

constexpr absl::string_view kScanKeyword = "FLASER";
// x y theta, odometry_x odometry_y odometry_theta, time, host, time.
constexpr int kNumFieldsAfterRanges = 9;
constexpr int kNumOdometryFields = 4;  // with the time
constexpr int kMaxBeams = 100000;
// Lines of kMaxBeams ranges with a few digits each.
constexpr size_t kMaxLineLength = size_t{1} << 21;
// For all scans together: 2 GB, two days of a 180-beam laser at 10 Hz.
constexpr size_t kMaxRanges = size_t{1} << 28;
// No robot on Earth is farther from its start [m].
constexpr double kMaxLogCoordinate = 1e7;
// No robot with a laser drives farther between two scans [m]; Cartographer
// would create a submap the size of the jump.
constexpr double kMaxStep = 20.;
constexpr double kMaxLogTime = 1e11;
// A whole number above this is a date in seconds, not a scan number.
constexpr double kMaxScanNumber = 1e8;
constexpr double kTimeOfFirstScan = 1e9;
// At shorter intervals, times would coincide in Cartographer's 0.1 us ticks.
constexpr double kMinSecondsBetweenScans = 1e-5;

using GzipFile = std::unique_ptr<gzFile_s, int (*)(gzFile_s*)>;

// Reads lines of a file that may be compressed, one line in memory at a time.
class LineReader {
 public:
  static absl::StatusOr<LineReader> Open(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status =
        std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
      return absl::NotFoundError(
          absl::StrCat("cannot read ", path, ": there is no such file"));
    }
    if (!std::filesystem::is_regular_file(status)) {
      return absl::InvalidArgumentError(
          absl::StrCat("cannot read ", path, ": not a regular file"));
    }
    GzipFile file(gzopen(path.c_str(), "rb"), gzclose_r);
    if (file == nullptr) {
      return absl::UnavailableError(
          absl::StrCat("cannot read ", path, ": ", std::strerror(errno)));
    }
    return LineReader(path, std::move(file));
  }

  // False at the end.
  absl::StatusOr<bool> Read(std::string* const line) {
    line->clear();
    ++number_;
    while (true) {
      const char* const begin = buffer_.data() + begin_;
      const auto* const newline =
          static_cast<const char*>(std::memchr(begin, '\n', end_ - begin_));
      const size_t length = newline == nullptr
                                ? end_ - begin_
                                : static_cast<size_t>(newline - begin);
      if (line->size() + length > kMaxLineLength) {
        return Error(absl::StrCat("a line of more than ", kMaxLineLength,
                                  " characters"));
      }
      line->append(begin, length);
      begin_ += length + (newline == nullptr ? 0 : 1);
      if (newline != nullptr) return true;
      const absl::StatusOr<bool> filled = Fill();
      if (!filled.ok()) return filled.status();
      if (!*filled) return !line->empty();
    }
  }

  [[nodiscard]] absl::Status Error(const absl::string_view problem) const {
    return absl::InvalidArgumentError(
        absl::StrCat(path_, ":", number_, ": ", problem));
  }

 private:
  LineReader(std::string path, GzipFile file)
      : path_(std::move(path)), file_(std::move(file)) {}

  absl::StatusOr<bool> Fill() {
    const int count = gzread(file_.get(), buffer_.data(),
                             static_cast<unsigned>(buffer_.size()));
    int code = Z_OK;
    const char* const message = gzerror(file_.get(), &code);
    // A truncated file ends with Z_BUF_ERROR, after its last bytes.
    if (count < 0 || (count == 0 && code != Z_OK)) {
      return absl::DataLossError(absl::StrCat(
          "cannot read ", path_, " beyond line ", number_ - 1, ": ",
          code == Z_BUF_ERROR ? "the compressed file is truncated" : message));
    }
    begin_ = 0;
    end_ = static_cast<size_t>(count);
    return count > 0;
  }

  std::string path_;
  GzipFile file_;
  std::array<char, size_t{1} << 16> buffer_;
  size_t begin_ = 0;
  size_t end_ = 0;
  int number_ = 0;
};

absl::StatusOr<std::vector<double>> ParseNumbers(
    const LineReader& reader, const absl::string_view* const fields,
    const int count) {
  std::vector<double> numbers(static_cast<size_t>(count));
  for (int k = 0; k < count; ++k) {
    if (!absl::SimpleAtod(fields[k], &numbers[k]) ||
        !std::isfinite(numbers[k])) {
      return reader.Error(absl::StrCat("field of ", fields[k].size(),
                                       " characters is not a finite number"));
    }
  }
  return numbers;
}

// Parses the odometry pose and the time.
absl::Status ParseOdometry(const LineReader& reader,
                           const absl::string_view* const fields,
                           LaserScan* const scan) {
  const absl::StatusOr<std::vector<double>> numbers =
      ParseNumbers(reader, fields, kNumOdometryFields);
  if (!numbers.ok()) return numbers.status();
  const double x = (*numbers)[0], y = (*numbers)[1], theta = (*numbers)[2];
  if (std::max({std::abs(x), std::abs(y), std::abs(theta)}) >
      kMaxLogCoordinate) {
    return reader.Error("the odometry is out of range");
  }
  scan->T_odometry_robot = Rigid2(x, y, theta);
  scan->time = (*numbers)[3];
  if (scan->time < 0. || scan->time > kMaxLogTime) {
    return reader.Error("the time is out of range");
  }
  return absl::OkStatus();
}

absl::StatusOr<LaserScan> ParseScan(const LineReader& reader,
                                    const std::string& line) {
  const std::vector<absl::string_view> fields =
      absl::StrSplit(line, absl::ByAnyChar(" \t\r"), absl::SkipEmpty());
  int num_beams = 0;
  if (fields.size() < 2 || !absl::SimpleAtoi(fields[1], &num_beams) ||
      num_beams < 1 || num_beams > kMaxBeams) {
    return reader.Error(
        absl::StrCat("the number of beams must be from 1 to ", kMaxBeams));
  }
  const int num_expected = 2 + num_beams + kNumFieldsAfterRanges;
  if (static_cast<int>(fields.size()) != num_expected) {
    return reader.Error(absl::StrCat(fields.size(), " fields instead of ",
                                     num_expected, " for ", num_beams,
                                     " beams"));
  }
  LaserScan scan;
  absl::StatusOr<std::vector<double>> ranges =
      ParseNumbers(reader, &fields[2], num_beams);
  if (!ranges.ok()) return ranges.status();
  scan.ranges = *std::move(ranges);
  for (double& range : scan.ranges) {
    if (range < 0.) return reader.Error("a range is negative");
    // A larger range is no return either.
    range = std::min(range, kMaxLogCoordinate);
  }
  // The laser pose precedes the odometry pose.
  const absl::Status status =
      ParseOdometry(reader, &fields[2 + num_beams + 3], &scan);
  if (!status.ok()) return status;
  return scan;
}

// Returns whether the times are merely scan numbers.
bool AreScanNumbers(const std::vector<LaserScan>& scans) {
  for (size_t i = 0; i < scans.size(); ++i) {
    const double time = scans[i].time;
    if (time != std::floor(time) || time > kMaxScanNumber) return false;
    if (i > 0 && time <= scans[i - 1].time) return false;
  }
  return true;
}

bool AreAllTheSame(const std::vector<LaserScan>& scans) {
  return std::all_of(scans.begin(), scans.end(), [&](const LaserScan& scan) {
    return scan.time == scans.front().time;
  });
}

void SetTimes(const double seconds_per_scan, Recording* const recording) {
  std::vector<LaserScan>& scans = recording->scans;
  const bool are_numbers = AreScanNumbers(scans);
  if (!are_numbers && !AreAllTheSame(scans)) {
    recording->has_clock = true;
    return;
  }
  for (size_t i = 0; i < scans.size(); ++i) {
    const double number = are_numbers ? scans[i].time : static_cast<double>(i);
    scans[i].time = kTimeOfFirstScan + seconds_per_scan * number;
  }
}

void DropWhatIsNotLater(Recording* const recording) {
  std::vector<LaserScan> kept;
  for (LaserScan& scan : recording->scans) {
    if (kept.empty() ||
        scan.time >= kept.back().time + kMinSecondsBetweenScans) {
      kept.push_back(std::move(scan));
    } else {
      ++recording->num_dropped_scans;
    }
  }
  recording->scans = std::move(kept);
}

absl::Status CheckAgainstLast(const LineReader& reader,
                              const std::vector<LaserScan>& scans,
                              const LaserScan& scan) {
  if (scans.empty()) return absl::OkStatus();
  const LaserScan& last = scans.back();
  if (scan.ranges.size() != last.ranges.size()) {
    return reader.Error(absl::StrCat(scan.ranges.size(), " beams after ",
                                     last.ranges.size(), " before"));
  }
  const double step = (scan.T_odometry_robot.translation() -
                       last.T_odometry_robot.translation())
                          .norm();
  if (step > kMaxStep) {
    return reader.Error(absl::StrCat("the odometry jumps by ", step,
                                     " m from the scan before"));
  }
  if ((scans.size() + 1) * scan.ranges.size() > kMaxRanges) {
    return reader.Error(
        absl::StrCat("there are more than ", kMaxRanges, " ranges"));
  }
  return absl::OkStatus();
}

// Returns whether the line begins with the keyword as a whole word.
bool IsScan(const std::string& line) {
  return absl::StartsWith(line, kScanKeyword) &&
         (line.size() == kScanKeyword.size() ||
          absl::ascii_isspace(
              static_cast<unsigned char>(line[kScanKeyword.size()])));
}

absl::StatusOr<std::vector<LaserScan>> ReadScans(const std::string& path) {
  absl::StatusOr<LineReader> reader = LineReader::Open(path);
  if (!reader.ok()) return reader.status();
  std::vector<LaserScan> scans;
  std::string line;
  while (true) {
    const absl::StatusOr<bool> read = reader->Read(&line);
    if (!read.ok()) return read.status();
    if (!*read) return scans;
    if (!IsScan(line)) continue;
    absl::StatusOr<LaserScan> scan = ParseScan(*reader, line);
    if (!scan.ok()) return scan.status();
    const absl::Status status = CheckAgainstLast(*reader, scans, *scan);
    if (!status.ok()) return status;
    scans.push_back(*std::move(scan));
  }
}

}  // namespace

std::string Validate(const CarmenLogOptions& options) {
  if (options.field_of_view.has_value() &&
      !(*options.field_of_view > 0. && *options.field_of_view <= 2. * M_PI)) {
    return "field_of_view must be above 0 and at most a full turn";
  }
  // 1e-4 s: 10 kHz; 1e4 s: one scan in about three hours.
  if (!(options.seconds_per_scan >= 1e-4 && options.seconds_per_scan <= 1e4)) {
    return "seconds_per_scan must be from 1e-4 to 1e4";
  }
  return "";
}

absl::StatusOr<Recording> ReadCarmenLog(const std::string& path,
                                        const CarmenLogOptions& options) {
  if (const std::string problem = Validate(options); !problem.empty()) {
    return absl::InvalidArgumentError(problem);
  }
  absl::StatusOr<std::vector<LaserScan>> scans = ReadScans(path);
  if (!scans.ok()) return scans.status();
  if (scans->empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, " has no line that begins with ", kScanKeyword,
                     ", so it is not a CARMEN log or has no laser"));
  }
  Recording recording;
  recording.scans = *std::move(scans);
  const auto num_beams =
      static_cast<int>(recording.scans.front().ranges.size());
  const bool is_half_turn =
      num_beams == 180 || num_beams == 181 || num_beams == 360;
  const double field_of_view =
      options.field_of_view.value_or(is_half_turn ? M_PI : 1.5 * M_PI);
  recording.first_angle = -field_of_view / 2.;
  recording.angle_increment =
      field_of_view / std::max(1, num_beams - num_beams % 2);
  SetTimes(options.seconds_per_scan, &recording);
  DropWhatIsNotLater(&recording);
  return recording;
}

}  // namespace cartographer_sdf
