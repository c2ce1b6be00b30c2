// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/trajectory_record.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::trajectory_record_test {
namespace {

proto::SerializedData Parse(const std::string& record) {
  proto::SerializedData data;
  EXPECT_TRUE(data.ParseFromString(record));
  return data;
}

std::string Renumbered(const std::string& record, const int trajectory) {
  return WithTrajectory(record, Parse(record), trajectory);
}

// Bytes are written out: tag, length and content, as the host would write them.
TEST(WithTrajectoryTest, ReplacesTheNumberInPlace) {
  // A node (field 4): its id (1) with trajectory (1) 2 and index (2) 9; an
  // unknown field (1000); node data (5) that is empty.
  const std::string record(
      "\x22\x0c\x0a\x04\x08\x02\x10\x09\xc2\x3e\x01x\x2a\x00", 14);
  const std::string expected(
      "\x22\x0d\x0a\x05\x08\xac\x02\x10\x09\xc2\x3e\x01x\x2a\x00", 15);
  EXPECT_EQ(*TrajectoryOfRecord(Parse(record)), 2);
  EXPECT_EQ(Renumbered(record, 300), expected);
  EXPECT_EQ(Renumbered(expected, 2), record);
  EXPECT_EQ(Renumbered(record, 2), record);
}

TEST(WithTrajectoryTest, AddsANumberThatWasZero) {
  // IMU data (field 6) of trajectory 0 with an unknown field (2).
  const std::string imu("\x32\x04\x12\x02xy", 6);
  EXPECT_EQ(*TrajectoryOfRecord(Parse(imu)), 0);
  EXPECT_EQ(Renumbered(imu, 7), std::string("\x32\x06\x08\x07\x12\x02xy", 8));
  // A submap (field 3) without an id.
  const std::string submap("\x1a\x02\x12\x00", 4);
  const proto::SerializedData renumbered = Parse(Renumbered(submap, 7));
  EXPECT_EQ(renumbered.submap().submap_id().trajectory_id(), 7);
  EXPECT_TRUE(renumbered.submap().has_submap_2d());
}

TEST(WithTrajectoryTest, KnowsWhatCountsWhereAFieldOccursTwice) {
  // Landmark data (field 9) in two parts: to a reader the last number counts.
  const std::string record("\x4a\x02\x08\x01\x4a\x04\x08\x02\x08\x03", 10);
  EXPECT_EQ(*TrajectoryOfRecord(Parse(record)), 3);
  EXPECT_EQ(*TrajectoryOfRecord(Parse(Renumbered(record, 5))), 5);
  // A number of the wrong type is no number.
  const std::string wrong("\x4a\x03\x0a\x01z", 5);
  EXPECT_EQ(*TrajectoryOfRecord(Parse(wrong)), 0);
  EXPECT_EQ(*TrajectoryOfRecord(Parse(Renumbered(wrong, 5))), 5);
}

TEST(TrajectoryOfRecordTest, NoneForWhatHasNone) {
  proto::SerializedData data;
  EXPECT_FALSE(TrajectoryOfRecord(data));
  data.mutable_pose_graph();
  EXPECT_FALSE(TrajectoryOfRecord(data));
  data.mutable_all_trajectory_builder_options();
  EXPECT_FALSE(TrajectoryOfRecord(data));
}

}  // namespace
}  // namespace cartographer_sdf::trajectory_record_test
