// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/scan_file.h"

#include <cmath>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::scan_file_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ScanFileTest : public ::testing::Test {
 protected:
  absl::StatusOr<std::vector<RobotScan>> Read(const std::string& content) {
    return ReadScanFile(directory_.Write("scan", content));
  }
  void ExpectError(const std::string& content, const std::string& part) {
    const auto scans = Read(content);
    ASSERT_FALSE(scans.ok()) << content;
    EXPECT_THAT(std::string(scans.status().message()), HasSubstr(part));
    EXPECT_THAT(std::string(scans.status().message()), Not(HasSubstr("\n")));
  }
  testing::TemporaryDirectory directory_;
};

TEST_F(ScanFileTest, ReadsALaserScan) {
  const auto scans = Read(
      R"({"header": {"frame_id": "laser"}, "angle_min": -1.5707963267948966,
          "angle_increment": 1.5707963267948966, "range_min": 0.1,
          "range_max": 10.0, "ranges": [2.0, 3.0, Infinity, 0.05, NaN, null],
          "sensor": {"x": 0.2, "y": 0, "yaw": 3.0}})");
  ASSERT_TRUE(scans.ok()) << scans.status();
  ASSERT_EQ(scans->size(), 1u);
  const RobotScan& scan = scans->front();
  EXPECT_NEAR(scan.T_robot_sensor.translation().x(), 0.2, 1e-9);
  EXPECT_NEAR(scan.T_robot_sensor.rotation(), 3., 1e-9);
  ASSERT_EQ(scan.scan.returns.size(), 2u);
  EXPECT_NEAR(scan.scan.returns[0].y(), -2., 1e-5);
  EXPECT_NEAR(scan.scan.returns[1].x(), 3., 1e-5);
  // Nothing was met in the range of the sensor.
  ASSERT_EQ(scan.scan.misses.size(), 1u);
  EXPECT_NEAR(scan.scan.misses[0].y(), 10., 1e-5);
}

TEST_F(ScanFileTest, ReadsPointsAndSeveralScans) {
  for (const char* const content :
       {R"({"scans": [{"points": [[1, 2], [3, 4, 0]]}, {"points": [[5, 6]]}]})",
        R"([{"points": [[1, 2], [3, 4, 0]]}, {"points": [[5, 6]]}])"}) {
    const auto scans = Read(content);
    ASSERT_TRUE(scans.ok()) << scans.status();
    ASSERT_EQ(scans->size(), 2u);
    ASSERT_EQ((*scans)[0].scan.returns.size(), 2u);
    EXPECT_EQ((*scans)[0].scan.returns[1], Eigen::Vector2f(3.f, 4.f));
    EXPECT_EQ((*scans)[1].scan.returns[0], Eigen::Vector2f(5.f, 6.f));
  }
}

TEST_F(ScanFileTest, ReadsTables) {
  const auto points = Read("x,y\n1,2\n3,4\n");
  ASSERT_TRUE(points.ok()) << points.status();
  ASSERT_EQ(points->front().scan.returns.size(), 2u);
  EXPECT_EQ(points->front().scan.returns[1], Eigen::Vector2f(3.f, 4.f));
  const auto ranges = Read("angle,range\n0,2\n1.5707963267948966,3\n1,0\n");
  ASSERT_TRUE(ranges.ok()) << ranges.status();
  ASSERT_EQ(ranges->front().scan.returns.size(), 2u);
  EXPECT_NEAR(ranges->front().scan.returns[1].y(), 3., 1e-5);
}

TEST_F(ScanFileTest, BadFilesAreErrorsOfOneLine) {
  EXPECT_FALSE(ReadScanFile(directory_.File("absent")).ok());
  EXPECT_FALSE(ReadScanFile(directory_.path()).ok());
  ExpectError("", "empty");
  ExpectError("{", "not JSON");
  ExpectError("[]", "no beam");
  ExpectError("{}", "either");
  ExpectError("[1]", "not an object");
  ExpectError(R"({"scans": 3})", "not an object");
  ExpectError(R"({"points": 3})", "not a list");
  ExpectError(R"({"points": [[1]]})", "point 0");
  ExpectError(R"({"points": [[1, "a"]]})", "point 0");
  ExpectError(R"({"points": [[1, 1e300]]})", "far away");
  ExpectError(R"({"points": []})", "no beam");
  ExpectError(R"({"points": [[1, 2]], "ranges": [1]})", "either");
  ExpectError(R"({"points": [[1, 2]], "sensor": 1})", "sensor");
  ExpectError(R"({"points": [[1, 2]], "sensor": {"x": 1e200}})", "absurd");
  ExpectError(R"({"ranges": [1, 2]})", "angle_min");
  ExpectError(R"({"ranges": [1], "angle_min": "a"})", "angle_min");
  ExpectError(R"({"ranges": [1], "angle_min": 0, "angle_increment": 0})",
              "radians");
  ExpectError(
      R"({"ranges": [1], "angle_min": 0, "angle_increment": 1, "range_max": 0})",
      "range_max");
  ExpectError(R"({"ranges": ["a"], "angle_min": 0, "angle_increment": 1})",
              "range 0");
  ExpectError("a,b\n1,2\n", "columns");
  ExpectError("x,y\n1\n", "fields");
  ExpectError("x,y\n1,a\n", "number");
  ExpectError("x,y\n1,1e9\n", "far away");
}

TEST_F(ScanFileTest, DeepNestingIsNoMatter) {
  ExpectError(std::string(200000, '['), "not JSON");
  ExpectError(std::string(1000, '[') + std::string(1000, ']'), "not an object");
}

TEST_F(ScanFileTest, ReadsADrive) {
  const auto drive = ReadScanRecording(directory_.Write("drive", R"([
      {"time": 5, "odometry": {"x": 1, "y": 2, "yaw": 0.5}, "points": [[1, 2]]},
      {"time": 5, "odometry": {"x": 1, "y": 2, "yaw": 0.5}, "points": [[3, 4]],
       "sensor": {"yaw": 3}},
      {"time": 6.5, "odometry": {"x": 1.5}, "points": [[5, 6]]}])"));
  ASSERT_TRUE(drive.ok()) << drive.status();
  EXPECT_TRUE(drive->is_drive);
  ASSERT_EQ(drive->scans.size(), 2u);
  // Two lidars at the same time.
  ASSERT_EQ(drive->scans[0].scans.size(), 2u);
  EXPECT_EQ(drive->scans[0].time, 5.);
  EXPECT_NEAR(drive->scans[0].scans[1].T_robot_sensor.rotation(), 3., 1e-9);
  EXPECT_NEAR(drive->scans[0].T_odometry_robot.rotation(), 0.5, 1e-9);
  EXPECT_EQ(drive->scans[1].time, 6.5);
  EXPECT_NEAR(drive->scans[1].T_odometry_robot.translation().x(), 1.5, 1e-9);
}

TEST_F(ScanFileTest, ScansWithoutOdometryAreOfAStandingRobot) {
  const auto standing = ReadScanRecording(directory_.Write(
      "scans", R"([{"points": [[1, 2]]}, {"points": [[5, 6]], "time": 3}])"));
  ASSERT_TRUE(standing.ok()) << standing.status();
  EXPECT_FALSE(standing->is_drive);
  ASSERT_EQ(standing->scans.size(), 1u);
  EXPECT_EQ(standing->scans[0].scans.size(), 2u);
}

TEST_F(ScanFileTest, RefusesBrokenDrives) {
  const auto expect_error = [&](const std::string& content,
                                const std::string& part) {
    const auto drive = ReadScanRecording(directory_.Write("drive", content));
    ASSERT_FALSE(drive.ok()) << content;
    EXPECT_THAT(std::string(drive.status().message()), HasSubstr(part));
  };
  expect_error(R"({"odometry": {"x": 1}, "points": [[1, 2]]})", "\"time\"");
  expect_error(R"({"odometry": {"x": "1"}, "time": 1, "points": [[1, 2]]})",
               "finite");
  expect_error(R"({"odometry": {"x": NaN, "y": 1e300}, "time": 1,
                   "points": [[1, 2]]})",
               "absurd");
  expect_error(R"({"odometry": [1, 2, 3], "time": 1, "points": [[1, 2]]})",
               "\"odometry\"");
  for (const char* const content :
       {R"([{"odometry": {}, "time": 1, "points": [[1, 2]]},
            {"points": [[1, 2]]}])",
        R"([{"points": [[1, 2]]},
            {"odometry": {}, "time": 1, "points": [[1, 2]]}])"}) {
    expect_error(content, "others have not");
  }
}

}  // namespace
}  // namespace cartographer_sdf::scan_file_test
