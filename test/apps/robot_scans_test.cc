// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/robot_scans.h"

#include <string>

#include "cartographer_sdf/place_store/described_map.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::robot_scans_test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

class RobotScansTest : public ::testing::Test {
 protected:
  testing::TemporaryDirectory directory_;
};

TEST_F(RobotScansTest, AMapIsADrive) {
  const std::string path = directory_.File("map.pbstream");
  testing::WriteShortDrive(testing::MakeSmallOffice(1), 1, path);
  const absl::StatusOr<ScanRecording> drive = ReadRobotScans(path);
  ASSERT_TRUE(drive.ok()) << drive.status();
  EXPECT_TRUE(drive->is_drive);
  const absl::StatusOr<DescribedMap> map = ReadMapWithScans(path);
  ASSERT_TRUE(map.ok()) << map.status();
  ASSERT_THAT(drive->scans, SizeIs(map->point_clouds.size()));
  for (size_t k = 1; k < drive->scans.size(); ++k) {
    EXPECT_GT(drive->scans[k].time, drive->scans[k - 1].time);
  }
}

TEST_F(RobotScansTest, ALogIsADriveByItsName) {
  const std::string line =
      "FLASER 3 1.0 2.0 3.0 0 0 0 0.5 0 0 1000.5 host 1000.5\n"
      "FLASER 3 1.0 2.0 3.0 0 0 0 0.6 0 0 1000.6 host 1000.6\n";
  for (const char* const name : {"drive.log", "drive.clf"}) {
    const absl::StatusOr<ScanRecording> drive =
        ReadRobotScans(directory_.Write(name, line));
    ASSERT_TRUE(drive.ok()) << drive.status();
    EXPECT_TRUE(drive->is_drive);
    EXPECT_THAT(drive->scans, SizeIs(2));
  }
}

TEST_F(RobotScansTest, AScanWithoutOdometryIsNone) {
  const absl::StatusOr<ScanRecording> scan = ReadRobotScans(
      directory_.Write("scan.json", R"({"points": [[1, 2], [3, 4]]})"));
  ASSERT_TRUE(scan.ok()) << scan.status();
  EXPECT_FALSE(scan->is_drive);
  EXPECT_THAT(scan->scans, SizeIs(1));
}

TEST_F(RobotScansTest, FailsWithTheName) {
  for (const char* const name : {"a.pbstream", "a.log", "a.json"}) {
    const absl::StatusOr<ScanRecording> scans =
        ReadRobotScans(directory_.File(name));
    ASSERT_FALSE(scans.ok());
    EXPECT_THAT(std::string(scans.status().message()), HasSubstr(name));
  }
}

}  // namespace
}  // namespace cartographer_sdf::robot_scans_test
