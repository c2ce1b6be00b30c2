// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/carmen_log.h"

#include <zlib.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/recording/recording.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::carmen_log_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kTolerance = 1e-9;

// A scan of three beams at a place of its own.
std::string Line(const std::string& time, const double x = 0.) {
  return absl::StrCat("FLASER 3 1.5 80 0.25 9 9 9 ", x, " 2 0.5 ", time,
                      " host 7\n");
}

class CarmenLogTest : public ::testing::Test {
 protected:
  absl::StatusOr<Recording> Read(const std::string& content,
                                 const CarmenLogOptions& options = {}) {
    return ReadCarmenLog(directory_.Write("some.log", content), options);
  }
  std::string Compress(const std::string& content) {
    const std::string path = directory_.File("some.log.gz");
    gzFile file = gzopen(path.c_str(), "wb");
    EXPECT_EQ(
        gzwrite(file, content.data(), static_cast<unsigned>(content.size())),
        static_cast<int>(content.size()));
    gzclose(file);
    return path;
  }

  testing::TemporaryDirectory directory_;
};

TEST_F(CarmenLogTest, ReadsScansAndPassesOverOtherLines) {
  const auto recording = Read(
      "# a comment\nPARAM laser 1\n\nFLASERS 1 2\n" + Line("1e9") +
      "ODOM 1 2 3\r\n" + Line("1000000000.5", 1.) + Line("1000000001", 4.));
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_TRUE(recording->has_clock);
  EXPECT_EQ(recording->num_dropped_scans, 0);
  ASSERT_EQ(recording->scans.size(), 3u);
  const LaserScan& scan = recording->scans[1];
  EXPECT_EQ(scan.time, 1000000000.5);
  EXPECT_THAT(scan.ranges, ElementsAre(1.5, 80., 0.25));
  // Not the pose of the laser, which comes before it.
  EXPECT_EQ(scan.T_odometry_robot.translation(), Eigen::Vector2d(1., 2.));
  EXPECT_EQ(scan.T_odometry_robot.rotation(), 0.5);
  EXPECT_THAT(MetersDriven(*recording), ElementsAre(0., 1., 4.));
}

TEST_F(CarmenLogTest, ReadsCompressedFiles) {
  const std::string content = Line("1e9") + Line("1000000000.5", 1.);
  const auto recording = ReadCarmenLog(Compress(content), {});
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_EQ(recording->scans.size(), 2u);
  EXPECT_EQ(recording->scans[1].time, 1000000000.5);
}

TEST_F(CarmenLogTest, NumbersOfScansAreNoClock) {
  const auto recording =
      Read(Line("7") + Line("8") + Line("10"), {std::nullopt, 0.2});
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_FALSE(recording->has_clock);
  EXPECT_NEAR(recording->scans[0].time, 1e9 + 1.4, 1e-6);
  EXPECT_NEAR(recording->scans[2].time, 1e9 + 2., 1e-6);
}

TEST_F(CarmenLogTest, AStandingClockIsNone) {
  const auto recording = Read(Line("5") + Line("5") + Line("5"));
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_FALSE(recording->has_clock);
  EXPECT_NEAR(recording->scans[2].time, 1e9 + 0.2, 1e-6);
}

TEST_F(CarmenLogTest, DropsScansThatAreNotLater) {
  const auto recording =
      Read(Line("3.5") + Line("4") + Line("4") + Line("3.9") + Line("5"));
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_EQ(recording->num_dropped_scans, 2);
  ASSERT_EQ(recording->scans.size(), 3u);
  EXPECT_EQ(recording->scans[2].time, 5.);
}

// Beam i of 180 lies at -90 + i degrees, of 361 at -135 + 0.75 i.
TEST_F(CarmenLogTest, KnowsTheAnglesOfUsualScanners) {
  for (const auto& [num_beams, first, increment] :
       std::vector<std::tuple<int, double, double>>{{180, -90., 1.},
                                                    {181, -90., 1.},
                                                    {360, -90., 0.5},
                                                    {361, -135., 0.75},
                                                    {1081, -135., 0.25}}) {
    std::string line = absl::StrCat("FLASER ", num_beams);
    for (int i = 0; i < num_beams; ++i) line += " 1";
    const auto recording = Read(line + " 0 0 0 0 0 0 1.5 host 0");
    ASSERT_TRUE(recording.ok()) << recording.status();
    EXPECT_NEAR(recording->first_angle, first * M_PI / 180., kTolerance);
    EXPECT_NEAR(recording->angle_increment, increment * M_PI / 180.,
                kTolerance);
  }
  const auto told = Read(Line("1.5"), {M_PI, 0.1});
  ASSERT_TRUE(told.ok()) << told.status();
  EXPECT_NEAR(told->first_angle, -M_PI / 2., kTolerance);
  EXPECT_NEAR(told->angle_increment, M_PI / 2., kTolerance);
}

TEST_F(CarmenLogTest, ErrorsNameTheFileAndTheLine) {
  for (const auto& [content, problem] :
       std::vector<std::pair<std::string, std::string>>{
           {"", "has no line that begins with FLASER"},
           {"ODOM 1 2\n", "has no line that begins with FLASER"},
           {"\nFLASER", ":2: the number of beams"},
           {"FLASER 0 0 0 0 0 0 0 1 h 0", ":1: the number of beams"},
           {"FLASER -3 1", "the number of beams"},
           {"FLASER 99999999999 1", "the number of beams"},
           {"FLASER 3 1 2 3 4", ":1: 6 fields instead of 14"},
           {"FLASER 1 -1 0 0 0 0 0 0 1 h 0", "a range is negative"},
           {"FLASER 1 nan 0 0 0 0 0 0 1 h 0", "not a finite number"},
           {"FLASER 1 1 0 0 0 1e400 0 0 1 h 0", "not a finite number"},
           {"FLASER 1 1 0 0 0 1e300 0 0 1 h 0", "the odometry is out of range"},
           {"FLASER 1 1 0 0 0 0 0 0 -1 h 0", "the time is out of range"},
           {Line("1") + "FLASER 1 1 0 0 0 0 0 0 2 h 0", ":2: 1 beams after 3"},
           {Line("1") + Line("2", 100.), ":2: the odometry jumps by 100 m"},
           {std::string(3 << 20, 'x'), "a line of more than"}}) {
    const auto recording = Read(content);
    ASSERT_FALSE(recording.ok()) << content.substr(0, 80);
    EXPECT_THAT(std::string(recording.status().message()),
                AllOf(HasSubstr("some.log"), HasSubstr(problem)));
  }
}

TEST_F(CarmenLogTest, RefusesWhatIsNoFile) {
  EXPECT_THAT(
      std::string(
          ReadCarmenLog(directory_.File("none"), {}).status().message()),
      AllOf(HasSubstr("none"), HasSubstr("no such file")));
  EXPECT_THAT(
      std::string(ReadCarmenLog(directory_.path(), {}).status().message()),
      HasSubstr("not a regular file"));
}

TEST_F(CarmenLogTest, RefusesTruncatedAndCorruptedCompressedFiles) {
  std::string content;
  for (int i = 0; i < 2000; ++i) content += Line(absl::StrCat(i), 0.001 * i);
  const std::string path = Compress(content);
  const std::string bytes = directory_.Read("some.log.gz");
  ASSERT_GT(bytes.size(), 200u);
  directory_.Write("some.log.gz", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(std::string(ReadCarmenLog(path, {}).status().message()),
              AllOf(HasSubstr("some.log.gz"), HasSubstr("truncated")));
  std::string corrupted = bytes;
  corrupted[bytes.size() / 2] = static_cast<char>(~corrupted[bytes.size() / 2]);
  directory_.Write("some.log.gz", corrupted);
  EXPECT_FALSE(ReadCarmenLog(path, {}).ok());
}

TEST_F(CarmenLogTest, RefusesOptionsOutOfRange) {
  for (const double field_of_view : {0., -1., 7., std::nan("")}) {
    EXPECT_THAT(Validate(CarmenLogOptions{field_of_view, 0.1}),
                HasSubstr("field_of_view"));
  }
  for (const double seconds : {0., -1., 1e9, std::nan("")}) {
    EXPECT_THAT(Validate(CarmenLogOptions{std::nullopt, seconds}),
                HasSubstr("seconds_per_scan"));
  }
  EXPECT_EQ(Validate(CarmenLogOptions{}), "");
}

TEST_F(CarmenLogTest, AnyBytesGiveARecordingOrAnError) {
  std::mt19937 engine(42);
  const std::string valid = Line("1") + Line("2") + Line("3");
  const std::string alphabet = std::string("FLASER 0123456789.-e\n") +
                               std::string("\0\r\xff\x1f\x8b", 5);
  int num_read = 0;
  for (int k = 0; k != 2000; ++k) {
    std::string content = valid;
    for (size_t changes = 1 + engine() % 4; changes != 0; --changes) {
      content[engine() % content.size()] = alphabet[engine() % alphabet.size()];
    }
    const auto recording = Read(content);
    EXPECT_TRUE(recording.ok() || !recording.status().message().empty());
    num_read += recording.ok() ? 1 : 0;
  }
  // Both happened.
  EXPECT_GT(num_read, 0);
  EXPECT_LT(num_read, 2000);
}

TEST_F(CarmenLogTest, ReadsARealLog) {
  SKIP_WITHOUT_SHARED_DATA("willow_2.log.gz");
  const auto recording = ReadCarmenLog(SharedDataPath("willow_2.log.gz"), {});
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_TRUE(recording->has_clock);
  EXPECT_EQ(recording->num_dropped_scans, 0);
  EXPECT_GT(recording->scans.size(), 3000u);
  EXPECT_EQ(recording->scans.front().ranges.size(), 361u);
}

}  // namespace
}  // namespace cartographer_sdf::carmen_log_test
