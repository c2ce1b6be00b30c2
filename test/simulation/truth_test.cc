// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/truth.h"

#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/file/whole_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::truth_test {
namespace {

using ::testing::HasSubstr;

constexpr double kWrittenPrecision = 0.5e-9 + 1e-12;

TEST(TruthTest, ComesBackAsItWasWritten) {
  const testing::TemporaryDirectory directory;
  Truth truth;
  truth.T_world_submap[{0, 0}] = Rigid2(1.25, -2.5, 0.1234567);
  truth.T_world_submap[{1, 12}] = Rigid2(-1e5, 1e-7, -3.1);
  truth.T_world_tracking[{1, 12}] = Rigid2(3., 4., 3.1415926);
  const std::string path = directory.File("truth.csv");
  ASSERT_TRUE(WriteTruth(path, truth).ok());
  const absl::StatusOr<Truth> read = ReadTruth(path);
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->T_world_submap.size(), 2u);
  ASSERT_EQ(read->T_world_tracking.size(), 1u);
  for (const auto& [id, pose] : truth.T_world_submap) {
    const Rigid2& actual = read->T_world_submap.at(id);
    EXPECT_NEAR(actual.translation().x(), pose.translation().x(),
                kWrittenPrecision);
    EXPECT_NEAR(actual.translation().y(), pose.translation().y(),
                kWrittenPrecision);
    EXPECT_NEAR(actual.rotation(), pose.rotation(), kWrittenPrecision);
  }
  EXPECT_NEAR(read->T_world_tracking.at({1, 12}).translation().y(), 4., 1e-12);
}

TEST(TruthTest, RefusesWhatMakesNoSense) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("truth.csv");
  for (const auto& [rows, problem] :
       std::vector<std::pair<std::string, std::string>>{
           {"wall,0,0,1,2,3\n", ":2: the kind is neither"},
           {"node,0,0,1,2,3\nnode,0,0,1,2,3\n",
            ":3: there is a second pose of node 0,0"},
           {"submap,0,0,1e10,2,3\n", ":2: the position is beyond"},
           {"submap,0,0,1,2,inf\n", ":2: \"inf\" is not a finite number"}}) {
    ASSERT_TRUE(
        WriteWholeFile(path, "kind,trajectory,index,x,y,yaw\n" + rows).ok());
    EXPECT_THAT(std::string(ReadTruth(path).status().message()),
                HasSubstr(problem));
  }
}

TEST(TruthTest, ReadsTheTruthOfARealMap) {
  SKIP_WITHOUT_SHARED_DATA("aces.truth.csv");
  const absl::StatusOr<Truth> truth =
      ReadTruth(SharedDataPath("aces.truth.csv"));
  ASSERT_TRUE(truth.ok()) << truth.status();
  // One of 37 is torn.
  EXPECT_EQ(truth->T_world_submap.size(), 36u);
  EXPECT_EQ(truth->T_world_submap.count({0, 19}), 0u);
  EXPECT_EQ(truth->T_world_submap.at({0, 1}).translation().y(), -1.83647);
}

}  // namespace
}  // namespace cartographer_sdf::truth_test
