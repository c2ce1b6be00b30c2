// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspection_maps.h"

#include <cmath>

#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/inspected_rooms.h"

namespace cartographer_sdf::inspection_maps_test {
namespace {

Rgb PixelAt(const DecodedPng& png, const PixelFrame& frame, const double x,
            const double y) {
  const Eigen::Vector2d pixel = frame.ToPixels({x, y});
  return png.At(static_cast<int>(std::floor(pixel.x())),
                static_cast<int>(std::floor(pixel.y())));
}

TEST(InspectionMapsTest, AllStatesHaveOneFrameAndScale) {
  testing::InspectedRooms rooms;
  ASSERT_TRUE(rooms.Draw().ok());
  EXPECT_EQ(rooms.num_readings, 1);
  const DrawnMaps& drawn = rooms.inspection.drawn;
  ASSERT_EQ(drawn.states.size(), 2u);
  const DecodedPng before = DecodePng(drawn.states[0].png);
  const DecodedPng after = DecodePng(drawn.states[1].png);
  for (const DecodedPng* const png : {&before, &after}) {
    EXPECT_EQ(png->width, drawn.width);
    EXPECT_EQ(png->height, drawn.height);
    // The first submap is the same place in both.
    EXPECT_EQ(PixelAt(*png, drawn.frame, 0., 0.), (Rgb{255, 255, 255}));
  }
  // The second is where each state has it.
  EXPECT_EQ(PixelAt(before, drawn.frame, 10.5, 0.), (Rgb{255, 255, 255}));
  EXPECT_EQ(PixelAt(after, drawn.frame, 10.5, 0.), (Rgb{0, 0, 0}));
  EXPECT_EQ(drawn.states[0].session_pngs.size(), 0u);
}

TEST(InspectionMapsTest, MovesTheFirstStateOntoTheLast) {
  testing::InspectedRooms rooms;
  const Rigid2 T_elsewhere_map(100., 50., 2.);
  for (auto& [id, pose] : rooms.before.submap_poses) {
    pose = T_elsewhere_map * pose;
  }
  ASSERT_TRUE(rooms.Draw().ok());
  const DrawnMaps& drawn = rooms.inspection.drawn;
  EXPECT_LT(drawn.width / drawn.frame.pixels_per_meter, 20.);
  const DecodedPng before = DecodePng(drawn.states[0].png);
  EXPECT_EQ(PixelAt(before, drawn.frame, 0., 0.), (Rgb{255, 255, 255}));
  EXPECT_EQ(PixelAt(before, drawn.frame, 10.5, 0.), (Rgb{255, 255, 255}));
}

TEST(InspectionMapsTest, RowsLieWhereTheirWallsOverlap) {
  testing::InspectedRooms rooms;
  ASSERT_TRUE(rooms.Draw().ok());
  const auto& overlap = rooms.inspection.tables[0].rows[0].p_reference_overlap;
  ASSERT_TRUE(overlap.has_value());
  EXPECT_NEAR(overlap->x(), 2.05, 0.15);
  EXPECT_NEAR(overlap->y(), 0., 0.15);
}

TEST(InspectionMapsTest, PicturesAsManySubmapsAsAskedFor) {
  testing::InspectedRooms all, none;
  ASSERT_TRUE(all.Draw().ok());
  EXPECT_EQ(all.inspection.drawn.submaps.size(), 2u);
  EXPECT_LE(all.inspection.drawn.submaps.at({0, 0}).width, 50);
  // A pair needs both.
  none.options.max_submap_pictures = 1;
  ASSERT_TRUE(none.Draw().ok());
  EXPECT_EQ(none.inspection.drawn.submaps.size(), 0u);
  EXPECT_FALSE(
      none.inspection.tables[0].rows[0].p_reference_overlap.has_value());
  EXPECT_EQ(none.inspection.drawn.states[1].png,
            all.inspection.drawn.states[1].png);
}

TEST(InspectionMapsTest, SessionsHavePicturesOfTheirOwn) {
  testing::InspectedRooms rooms;
  rooms.inspection.sessions = {{"first"}, {"second"}};
  rooms.inspection.submaps.at({1, 0}).session = 1;
  ASSERT_TRUE(rooms.Draw().ok());
  const DrawnMaps& drawn = rooms.inspection.drawn;
  for (const StatePicture& state : drawn.states) {
    ASSERT_EQ(state.session_pngs.size(), 2u);
    const DecodedPng first = DecodePng(state.session_pngs[0]);
    EXPECT_EQ(PixelAt(first, drawn.frame, 0., 0.), (Rgb{255, 255, 255}));
    const DecodedPng second = DecodePng(state.session_pngs[1]);
    EXPECT_EQ(PixelAt(second, drawn.frame, 0., 0.), (Rgb{0, 0, 0}));
  }
}

TEST(InspectionMapsTest, LeavesOutWhatHasNoPose) {
  testing::InspectedRooms rooms;
  rooms.after.submap_poses.erase({1, 0});
  EXPECT_TRUE(rooms.Draw().ok());
  EXPECT_EQ(rooms.inspection.drawn.states.size(), 2u);
  testing::InspectedRooms empty;
  empty.inspection.submaps.clear();
  EXPECT_TRUE(empty.Draw().ok());
  EXPECT_EQ(empty.inspection.drawn.states.size(), 0u);
}

}  // namespace
}  // namespace cartographer_sdf::inspection_maps_test
