// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/ros_map.h"

#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::ros_map_test {
namespace {

using ::testing::HasSubstr;

// Cells of 0.5 m, three along x and two along y: a wall at the lower left, free
// space at the upper right, the rest unknown.
OccupancyGrid SmallGrid() {
  OccupancyGrid grid = UnknownGrid({{3, 2}, 0.5, Rigid2(0., 0., 0.)});
  grid.known(0, 0) = grid.known(2, 1) = true;
  grid.probability(0, 0) = 0.9f;
  grid.probability(2, 1) = 0.1f;
  return grid;
}

TEST(RosMapTest, IsWhatTheMapServerReads) {
  const OccupancyGrid grid = SmallGrid();
  const Rigid2 T_map_submap(10., 20., 0.);
  absl::StatusOr<MapPainter> painter =
      MapPainter::WithPixelSize({{grid.geometry, T_map_submap}}, 0.5);
  ASSERT_TRUE(painter.ok()) << painter.status();
  painter->AddSubmap(grid, T_map_submap);
  const RosMap map = MakeRosMap(*painter, "a \"map\".pgm");
  // A margin of 0.5 m on every side.
  const std::string header = "P5\n# Cartographer map; 0.5 m/pixel\n5 4\n255\n";
  ASSERT_EQ(map.pgm.substr(0, header.size()), header);
  const std::string u = "\xcd", f = "\xfe";
  const std::string w(1, '\0');
  // Rows from the top.
  EXPECT_EQ(map.pgm.substr(header.size()),
            u + u + u + u + u +      //
                u + u + u + f + u +  //
                u + w + u + u + u +  //
                u + u + u + u + u);
  EXPECT_EQ(map.num_occupied, 1);
  EXPECT_EQ(map.num_free, 1);
  EXPECT_EQ(map.num_unknown, 18);
  EXPECT_THAT(map.yaml, HasSubstr("image: \"a \\\"map\\\".pgm\"\n"));
  EXPECT_THAT(map.yaml, HasSubstr("resolution: 0.5\n"));
  EXPECT_THAT(map.yaml, HasSubstr("origin: [9.5, 19.5, 0.0]\n"));
}

TEST(RosMapTest, PixelsHaveASize) {
  const CellGeometry geometry{{4, 4}, 0.05f, Rigid2()};
  const std::vector<PlacedGrid> grids = {{geometry, Rigid2()}};
  EXPECT_FALSE(MapPainter::WithPixelSize({}, 0.).ok());
  EXPECT_FALSE(MapPainter::WithPixelSize(grids, 0.04).ok());
  EXPECT_TRUE(MapPainter::WithPixelSize(grids, 0.05).ok());
  EXPECT_TRUE(MapPainter::WithPixelSize(grids, 0.2).ok());
  // That of a cell, to the micrometre.
  const absl::StatusOr<MapPainter> own = MapPainter::WithPixelSize(grids, 0.);
  ASSERT_TRUE(own.ok());
  EXPECT_DOUBLE_EQ(own->frame().pixels_per_meter, 20.);
  const std::vector<PlacedGrid> far = {{geometry, Rigid2()},
                                       {geometry, Rigid2(1000., 0., 0.)}};
  EXPECT_FALSE(MapPainter::WithPixelSize(far, 0.05).ok());
  EXPECT_TRUE(MapPainter::WithPixelSize(far, 0.5).ok());
}

}  // namespace
}  // namespace cartographer_sdf::ros_map_test
