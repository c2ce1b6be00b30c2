// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the host's trimmers remove is forgotten, whenever it happens.

#include <iterator>

#include "cartographer_sdf/live/map_builder.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/live/small_room.h"

namespace cartographer_sdf::trimmed_places_test {
namespace {

namespace mapping = ::cartographer::mapping;

// The host trims before the searcher's round, so that submaps that are made and
// trimmed between two rounds are in none.
TEST(TrimmedPlacesTest, ForgetsSubmapsThatNoRoundHasSeen) {
  testing::StockOptions stock =
      testing::MakeStockOptions(testing::SmallSubmapsLua(/*every_n_nodes=*/40));
  stock.trajectory_builder.mutable_pure_localization_trimmer()
      ->set_max_submaps_to_keep(3);
  const auto builder =
      CreateMapBuilder(mapping::CreateMapBuilder(stock.map_builder),
                       testing::EagerOptions(), nullptr);
  LiveMapBuilder* const live = AsLiveMapBuilder(builder.get());
  const int id = builder->AddTrajectoryBuilder(
      testing::SensorIds(), stock.trajectory_builder, nullptr);
  for (int k = 0; k < 120; ++k) {
    testing::FeedScanOfARoom(builder.get(), id, 0., k);
  }
  live->WaitUntilIdle();
  const auto submaps = builder->pose_graph()->GetAllSubmapPoses();
  ASSERT_FALSE(submaps.empty());
  EXPECT_GT((*std::prev(submaps.end())).id.submap_index, 20);
  builder->FinishTrajectory(id);
  builder->pose_graph()->RunFinalOptimization();
  live->WaitUntilIdle();
  EXPECT_TRUE(builder->pose_graph()->GetAllSubmapData().empty());
  EXPECT_EQ(live->GetSummary().num_places, 0);
}

}  // namespace
}  // namespace cartographer_sdf::trimmed_places_test
