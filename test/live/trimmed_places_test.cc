// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the host's trimmers remove is forgotten, whenever it happens; what the
// host still has, or has in its queue, is not.

#include <atomic>
#include <iterator>
#include <map>
#include <memory>
#include <string>

#include "absl/synchronization/notification.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/pose_graph_trimmer.h"
#include "cartographer_sdf/live/map_builder.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/live/small_room.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::trimmed_places_test {
namespace {

namespace mapping = ::cartographer::mapping;

std::unique_ptr<mapping::MapBuilderInterface> MakeBuilder(
    const testing::StockOptions& stock) {
  return CreateMapBuilder(mapping::CreateMapBuilder(stock.map_builder),
                          testing::EagerOptions(), nullptr);
}

// The host trims before the searcher's round, so that submaps that are made and
// trimmed between two rounds are in none.
TEST(TrimmedPlacesTest, ForgetsSubmapsThatNoRoundHasSeen) {
  testing::StockOptions stock =
      testing::MakeStockOptions(testing::SmallSubmapsLua(/*every_n_nodes=*/40));
  stock.trajectory_builder.mutable_pure_localization_trimmer()
      ->set_max_submaps_to_keep(3);
  const auto builder = MakeBuilder(stock);
  LiveMapBuilder* const live = AsLiveMapBuilder(builder.get());
  const int id = builder->AddTrajectoryBuilder(
      testing::SensorIds(), stock.trajectory_builder, nullptr);
  for (int k = 0; k < 120; ++k) {
    testing::FeedScanOfARoom(builder.get(), id, 0., k);
    live->WaitUntilIdle();
  }
  const auto submaps = builder->pose_graph()->GetAllSubmapPoses();
  ASSERT_FALSE(submaps.empty());
  EXPECT_GT((*std::prev(submaps.end())).id.submap_index, 20);
  EXPECT_GT(live->GetSummary().num_submaps, 20);
  builder->FinishTrajectory(id);
  builder->pose_graph()->RunFinalOptimization();
  live->WaitUntilIdle();
  EXPECT_TRUE(builder->pose_graph()->GetAllSubmapData().empty());
  EXPECT_EQ(live->GetSummary().num_places, 0);
}

// Those that wait in the host's queue in a round are in no list of it.
TEST(TrimmedPlacesTest, KeepsSubmapsThatWaitInTheQueue) {
  const testing::StockOptions stock =
      testing::MakeStockOptions(testing::SmallSubmapsLua(/*every_n_nodes=*/5));
  const auto builder = MakeBuilder(stock);
  LiveMapBuilder* const live = AsLiveMapBuilder(builder.get());
  // The host calls it between an optimisation and its trimmers.
  absl::Notification may_go_on;
  std::atomic<int> num_rounds{0};
  builder->pose_graph()->SetGlobalSlamOptimizationCallback(
      [&](const std::map<int, mapping::SubmapId>&,
          const std::map<int, mapping::NodeId>&) {
        ++num_rounds;
        may_go_on.WaitForNotification();
      });
  const int id = builder->AddTrajectoryBuilder(
      testing::SensorIds(), stock.trajectory_builder, nullptr);
  for (int k = 0; k < 60; ++k) {
    testing::FeedScanOfARoom(builder.get(), id, 0., k);
  }
  live->WaitUntilIdle();
  EXPECT_LE(num_rounds, 1);
  const int num_before = live->GetSummary().num_places;
  EXPECT_GT(num_before, 20);
  may_go_on.Notify();
  builder->FinishTrajectory(id);
  builder->pose_graph()->RunFinalOptimization();
  live->WaitUntilIdle();
  EXPECT_GT(num_rounds, 3);
  EXPECT_EQ(live->GetSummary().num_places,
            static_cast<int>(builder->pose_graph()->GetAllSubmapData().size()));
  EXPECT_GE(live->GetSummary().num_places, num_before);
}

// Trims a submap as soon as it can.
class OneSubmapTrimmer : public mapping::PoseGraphTrimmer {
 public:
  explicit OneSubmapTrimmer(const mapping::SubmapId& id) : id_(id) {}
  void Trim(mapping::Trimmable* const graph) override {
    if (!graph->GetOptimizedSubmapData().Contains(id_)) return;
    graph->TrimSubmap(id_);
    is_finished_ = true;
  }
  bool IsFinished() override { return is_finished_; }

 private:
  const mapping::SubmapId id_;
  bool is_finished_ = false;
};

TEST(TrimmedPlacesTest, ForgetsLoadedSubmapsThatNoRoundHasSeen) {
  const testing::TemporaryDirectory directory;
  const testing::StockOptions stock =
      testing::MakeStockOptions(testing::SmallSubmapsLua(/*every_n_nodes=*/5));
  const auto drive = [&stock](mapping::MapBuilderInterface* const builder) {
    const int id = builder->AddTrajectoryBuilder(
        testing::SensorIds(), stock.trajectory_builder, nullptr);
    for (int k = 0; k < 12; ++k) testing::FeedScanOfARoom(builder, id, 0., k);
    builder->FinishTrajectory(id);
    builder->pose_graph()->RunFinalOptimization();
  };
  const std::string map_path = directory.File("map.pbstream");
  {
    const auto host = mapping::CreateMapBuilder(stock.map_builder);
    drive(host.get());
    ASSERT_TRUE(host->SerializeStateToFile(true, map_path));
  }
  const auto builder = MakeBuilder(stock);
  LiveMapBuilder* const live = AsLiveMapBuilder(builder.get());
  constexpr int kMap = 1;
  for (const int index : {1, 4}) {
    dynamic_cast<mapping::PoseGraph*>(builder->pose_graph())
        ->AddTrimmer(
            std::make_unique<OneSubmapTrimmer>(mapping::SubmapId{kMap, index}));
  }
  // Until its rounds, the searcher looks at the graph before these trimmers,
  // too.
  drive(builder.get());
  live->WaitUntilIdle();
  const int num_driven = live->GetSummary().num_places;
  ASSERT_EQ(builder->LoadStateFromFile(map_path, true).at(0), kMap);
  live->WaitUntilIdle();
  const int num_loaded = live->GetSummary().num_places - num_driven;
  EXPECT_GE(num_loaded, 5);
  drive(builder.get());
  live->WaitUntilIdle();
  const auto submaps = builder->pose_graph()->GetAllSubmapData();
  EXPECT_EQ(static_cast<int>(submaps.SizeOfTrajectoryOrZero(kMap)),
            num_loaded - 2);
  EXPECT_EQ(live->GetSummary().num_places, static_cast<int>(submaps.size()));
}

}  // namespace
}  // namespace cartographer_sdf::trimmed_places_test
