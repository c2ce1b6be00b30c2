// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer itself loads what is written, and aborts on what is refused.

#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::written_maps_test {
namespace {

namespace mapping = ::cartographer::mapping;

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::SmallMap;

class WrittenMapsTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const SmallMap& map) {
    return directory_.Write(name, Container(map.Records()));
  }

  // Loads and optimises it; returns the number of its nodes.
  static size_t Load(const std::string& path, const bool is_frozen) {
    const auto stock = testing::MakeStockOptions("");
    const auto host = mapping::CreateMapBuilder(stock.map_builder);
    host->LoadStateFromFile(path, is_frozen);
    host->pose_graph()->RunFinalOptimization();
    return host->pose_graph()->GetTrajectoryNodes().size();
  }

  static SmallMap CutMap() {
    SmallMap map;
    map.nodes.resize(2);
    return map;
  }

  const testing::TemporaryDirectory directory_;
};

TEST_F(WrittenMapsTest, RepairedMapsLoad) {
  const MapSource source(Write("cut.pbstream", CutMap()),
                         MissingRecords::kDrop);
  const std::string output = directory_.File("repaired.pbstream");
  const absl::StatusOr<MapState> map = ReadMap(source);
  ASSERT_TRUE(map.ok()) << map.status();
  ASSERT_TRUE(WriteMap(source, output, map->pose_graph).ok());
  for (const bool is_frozen : {false, true}) {
    EXPECT_EQ(Load(output, is_frozen), 2u);
  }
}

TEST_F(WrittenMapsTest, JoinedMapsLoad) {
  const std::string whole = Write("whole.pbstream", SmallMap());
  const std::string cut = Write("cut.pbstream", CutMap());
  const std::string output = directory_.File("joined.pbstream");
  const absl::StatusOr<MapState> first = ReadMap(whole);
  const absl::StatusOr<MapState> second = ReadMap({cut, MissingRecords::kDrop});
  ASSERT_TRUE(first.ok() && second.ok());
  const std::vector<MapPart> parts =
      NumberTrajectories({whole, cut}, {&*first, &*second});
  MapState joined;
  AppendMap(parts[0], *first, &joined);
  AppendMap(parts[1], *second, &joined);
  ASSERT_TRUE(WriteJoinedMap(parts, joined.pose_graph, output).ok());
  for (const bool is_frozen : {false, true}) {
    EXPECT_EQ(Load(output, is_frozen), 6u);
  }
}

// That the checks are about something.
TEST_F(WrittenMapsTest, WhatIsRefusedWouldAbortCartographer) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string cut = Write("cut.pbstream", CutMap());
  EXPECT_FALSE(ReadMap(cut).ok());
  EXPECT_DEATH(Load(cut, false), "");
  SmallMap twice;
  *twice.pose_graph.add_constraint() = twice.pose_graph.constraint(0);
  const std::string repeated = Write("twice.pbstream", twice);
  EXPECT_FALSE(ReadMap(repeated).ok());
  EXPECT_DEATH(Load(repeated, false), "");
}

}  // namespace
}  // namespace cartographer_sdf::written_maps_test
