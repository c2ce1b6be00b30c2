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
// Of all scans together: 2 GB, two days of a laser of 180 beams at 10 Hz.
constexpr size_t kMaxRanges = size_t{1} << 28;
// No robot on earth is farther from where it started [m].
constexpr double kMaxLogCoordinate = 1e7;
// No robot with a laser drives farther between two scans [m]; Cartographer
// would make a submap of the size of the jump.
constexpr double kMaxStep = 20.;
constexpr double kMaxTime = 1e11;
// A number of scans beyond this is the seconds of a date.
constexpr double kMaxScanNumber = 1e8;
constexpr double kTimeOfFirstScan = 1e9;
// Shorter, Cartographer's ticks of 0.1 us would fall together.
constexpr double kMinSecondsBetweenScans = 1e-5;

using GzipFile = std::unique_ptr<gzFile_s, int (*)(gzFile_s*)>;

// Lines of a file that may be compressed. Memory is one line's.
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

absl::Status ParseNumber(const LineReader& reader,
                         const absl::string_view field, double* const value) {
  if (!absl::SimpleAtod(field, value) || !std::isfinite(*value)) {
    return reader.Error(absl::StrCat("field of ", field.size(),
                                     " characters is no finite number"));
  }
  return absl::OkStatus();
}

absl::Status ParseRanges(const LineReader& reader,
                         const std::vector<absl::string_view>& fields,
                         std::vector<double>* const ranges) {
  ranges->reserve(fields.size());
  for (const absl::string_view field : fields) {
    double range = 0.;
    if (absl::Status status = ParseNumber(reader, field, &range);
        !status.ok()) {
      return status;
    }
    if (range < 0.) return reader.Error("a range is negative");
    // More is no return either.
    ranges->push_back(std::min(range, kMaxLogCoordinate));
  }
  return absl::OkStatus();
}

// Of odometry's pose and the time.
absl::Status ParseOdometry(const LineReader& reader,
                           const std::vector<absl::string_view>& fields,
                           LaserScan* const scan) {
  std::array<double, kNumOdometryFields> numbers;
  for (int k = 0; k < kNumOdometryFields; ++k) {
    if (absl::Status status = ParseNumber(reader, fields[k], &numbers[k]);
        !status.ok()) {
      return status;
    }
  }
  const auto& [x, y, theta, time] = numbers;
  if (std::max({std::abs(x), std::abs(y), std::abs(theta)}) >
      kMaxLogCoordinate) {
    return reader.Error("the odometry is off this world");
  }
  if (time < 0. || time > kMaxTime) return reader.Error("the time is no time");
  scan->T_odometry_robot = Rigid2(x, y, theta);
  scan->time = time;
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
        absl::StrCat("the number of beams is none from 1 to ", kMaxBeams));
  }
  const int num_expected = 2 + num_beams + kNumFieldsAfterRanges;
  if (static_cast<int>(fields.size()) != num_expected) {
    return reader.Error(absl::StrCat(fields.size(), " fields instead of ",
                                     num_expected, " for ", num_beams,
                                     " beams"));
  }
  LaserScan scan;
  const auto pose_begin = fields.begin() + 2 + num_beams;
  if (absl::Status status =
          ParseRanges(reader, {fields.begin() + 2, pose_begin}, &scan.ranges);
      !status.ok()) {
    return status;
  }
  // The laser's pose comes before odometry's.
  if (absl::Status status = ParseOdometry(
          reader, {pose_begin + 3, pose_begin + 3 + kNumOdometryFields}, &scan);
      !status.ok()) {
    return status;
  }
  return scan;
}

// True where the times only count the scans.
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

// The keyword as a word of its own.
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
    if (absl::Status status = CheckAgainstLast(*reader, scans, *scan);
        !status.ok()) {
      return status;
    }
    scans.push_back(*std::move(scan));
  }
}

}  // namespace

std::string Validate(const CarmenLogOptions& options) {
  if (options.field_of_view.has_value() &&
      !(*options.field_of_view > 0. && *options.field_of_view <= 2. * M_PI)) {
    return "field_of_view must be above 0 and at most a full turn";
  }
  // 1e-4 s: 10 kHz; 1e4 s: a scan in three hours.
  if (!(options.seconds_per_scan >= 1e-4 && options.seconds_per_scan <= 1e4)) {
    return "seconds_per_scan must be from 1e-4 to 1e4";
  }
  return "";
}

double UsualFieldOfView(const int num_beams) {
  const bool is_half_turn =
      num_beams == 180 || num_beams == 181 || num_beams == 360;
  return is_half_turn ? M_PI : 1.5 * M_PI;
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
                     ", so it is no CARMEN log or has no laser"));
  }
  Recording recording;
  recording.scans = *std::move(scans);
  const auto num_beams =
      static_cast<int>(recording.scans.front().ranges.size());
  const double field_of_view =
      options.field_of_view.value_or(UsualFieldOfView(num_beams));
  recording.first_angle = -field_of_view / 2.;
  recording.angle_increment =
      field_of_view / std::max(1, num_beams - num_beams % 2);
  SetTimes(options.seconds_per_scan, &recording);
  DropWhatIsNotLater(&recording);
  return recording;
}

}  // namespace cartographer_sdf
