// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/operator_desk.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cartographer/mapping/map_builder.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/live/small_room.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::operator_desk_test {
namespace {

namespace mapping = cartographer::mapping;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::FeedScanOfARoom;
using ::testing::IsEmpty;
using ::testing::Pair;
using testing::SensorIds;

// A robot that is localised in the map of a small room, by a searcher that is
// easily convinced.
class OperatorDeskTest : public ::testing::Test {
 protected:
  OperatorDeskTest()
      : stock_(testing::MakeStockOptions(testing::SmallSubmapsLua(3))) {
    const auto mapper = mapping::CreateMapBuilder(stock_.map_builder);
    const int id = mapper->AddTrajectoryBuilder(
        SensorIds(), stock_.trajectory_builder, nullptr);
    for (int k = 0; k < 20; ++k) FeedScanOfARoom(mapper.get(), id, 0., k);
    mapper->FinishTrajectory(id);
    mapper->pose_graph()->RunFinalOptimization();
    const std::string path = directory_.File("map.pbstream");
    CHECK(mapper->SerializeStateToFile(true, path));
    map_builder_ = CreateMapBuilder(
        mapping::CreateMapBuilder(stock_.map_builder), testing::EagerOptions(),
        [this](const LocalizationResult& result) {
          desk_.OnLocalization(result);
        });
    desk_.SetMapBuilder(map_builder_.get());
    live_ = AsLiveMapBuilder(map_builder_.get());
    map_builder_->LoadStateFromFile(path, /*load_frozen_state=*/true);
    live_->WaitUntilIdle();
  }
  ~OperatorDeskTest() override {
    if (const auto id = desk_.NewestTrajectory()) {
      map_builder_->FinishTrajectory(*id);
    }
    map_builder_->pose_graph()->RunFinalOptimization();
  }

  int Start() {
    k_ = 0;
    return map_builder_->AddTrajectoryBuilder(
        SensorIds(), stock_.trajectory_builder, nullptr);
  }
  // Returns the first certain result.
  std::optional<LocalizationResult> DriveUntilFound(const int trajectory_id) {
    for (const int end = k_ + 40; k_ < end;) {
      FeedScanOfARoom(map_builder_.get(), trajectory_id, 1., k_++);
      live_->WaitUntilIdle();
      for (const LocalizationResult& result : desk_.TakeResults()) {
        if (result.localized) return result;
      }
    }
    return std::nullopt;
  }
  TrajectoryActions Actions() {
    return {[this](const int trajectory_id) {
              finished_.push_back(trajectory_id);
              map_builder_->FinishTrajectory(trajectory_id);
              return true;
            },
            [this] { Start(); }};
  }

  testing::TemporaryDirectory directory_;
  testing::StockOptions stock_;
  OperatorDesk desk_;
  std::unique_ptr<mapping::MapBuilderInterface> map_builder_;
  LiveMapBuilder* live_ = nullptr;
  int k_ = 0;
  std::vector<int> finished_;
};

TEST_F(OperatorDeskTest, ACarriedAwayRobotGoesOnInANewTrajectory) {
  const int id = Start();
  EXPECT_EQ(desk_.NewestTrajectory(), id);
  ASSERT_TRUE(DriveUntilFound(id));
  EXPECT_EQ(StateOf(desk_.GetLocalization(id)), SearchState::kLocated);
  EXPECT_FALSE(desk_.SearchAgain(id + 1, Actions()));
  EXPECT_FALSE(desk_.SearchAgain(0, Actions()));  // frozen
  EXPECT_THAT(finished_, IsEmpty());

  EXPECT_EQ(desk_.SearchAgain(id, Actions()), id + 1);
  EXPECT_THAT(finished_, ElementsAre(id));
  EXPECT_EQ(desk_.NewestTrajectory(), id + 1);
  EXPECT_EQ(StateOf(desk_.GetLocalization(id + 1)), SearchState::kLost);
  EXPECT_FALSE(desk_.SearchAgain(id, Actions()));
  const std::optional<LocalizationResult> found = DriveUntilFound(id + 1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->trajectory_id, id + 1);
  EXPECT_EQ(StateOf(desk_.GetLocalization(id + 1)), SearchState::kLocated);
  // For the pose graph it is a trajectory like any other, and tied to the map.
  EXPECT_FALSE(found->was_localized);
  map_builder_->FinishTrajectory(id + 1);
  map_builder_->pose_graph()->RunFinalOptimization();
  int num_ties = 0;
  for (const auto& constraint : map_builder_->pose_graph()->constraints()) {
    if (constraint.submap_id.trajectory_id == 0 &&
        constraint.node_id.trajectory_id == id + 1) {
      ++num_ties;
    }
  }
  EXPECT_GT(num_ties, 0);
}

TEST_F(OperatorDeskTest, WithoutTheWishItStaysInItsTrajectory) {
  const int id = Start();
  ASSERT_TRUE(DriveUntilFound(id));
  EXPECT_EQ(desk_.SearchForAll(std::nullopt), 1);
  EXPECT_EQ(StateOf(desk_.GetLocalization(id)), SearchState::kLost);
  const std::optional<LocalizationResult> again = DriveUntilFound(id);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->was_localized);
  EXPECT_THAT(finished_, IsEmpty());
  EXPECT_TRUE(desk_.GetStartPose(id));
}

TEST_F(OperatorDeskTest, ShowsMatchesAndStatus) {
  const int id = Start();
  ASSERT_TRUE(DriveUntilFound(id));
  size_t num_segments = 0;
  for (const SegmentGroup& group : desk_.DrawMatches()) {
    num_segments += group.segments.size();
  }
  EXPECT_GE(num_segments, 1u);
  const NodeStatus status = desk_.DescribeStatus();
  EXPECT_TRUE(status.is_fine);
  EXPECT_THAT(status.values, Contains(Pair("state", "located")));
  EXPECT_THAT(status.values, Contains(Pair("trajectory", std::to_string(id))));
}

TEST(DisabledOperatorDeskTest, SaysThatThereIsNoSearcher) {
  LiveOptions options;
  options.enabled = false;
  const auto map_builder = CreateMapBuilder(
      mapping::CreateMapBuilder(testing::MakeStockOptions("").map_builder),
      options);
  OperatorDesk desk;
  desk.SetMapBuilder(map_builder.get());
  EXPECT_FALSE(desk.IsEnabled());
  EXPECT_FALSE(desk.NewestTrajectory());
  EXPECT_FALSE(desk.SearchAgain(0, std::nullopt));
  EXPECT_EQ(desk.SearchForAll(std::nullopt), 0);
  EXPECT_FALSE(desk.GetLocalization(0));
  EXPECT_FALSE(desk.GetStartPose(0));
  EXPECT_THAT(desk.DrawMatches(), IsEmpty());
  EXPECT_EQ(desk.DescribeStatus().message, "the searcher is not enabled");
}

}  // namespace
}  // namespace cartographer_sdf::operator_desk_test
