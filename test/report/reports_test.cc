// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/reports.h"

#include "gtest/gtest.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::reports_test {
namespace {

// Two rooms beside each other, of two trajectories.
class DrawPicturesTest : public ::testing::Test {
 protected:
  DrawPicturesTest() {
    for (const int trajectory : {0, 1}) {
      const SubmapId id{trajectory, 0};
      state_.submaps[id].geometry = room_.geometry;
      state_.pose_graph.submap_poses[id] = Rigid2(8. * trajectory, 0., 0.);
      state_.pose_graph.nodes[{trajectory, 0}].T_map_node =
          Rigid2(8. * trajectory, 0., 0.);
      ReportedClosure closure;
      closure.match.pair = {{0, 0}, {1, 0}, Rigid2(), 1. - trajectory};
      content_.closures.push_back(closure);
    }
    options_.map_picture_pixels = 300;
    options_.closure_picture_pixels = 100;
  }

  absl::Status Draw(const MapPicture& map) {
    return DrawPictures(
        {map},
        [this](const SubmapCallback& on_submap) {
          ++num_readings_;
          for (const auto& [id, submap] : state_.submaps) {
            on_submap(id, submap, room_);
          }
          return absl::OkStatus();
        },
        options_, &content_);
  }

  const OccupancyGrid room_ = RectangularRoom(
      4., 3., 0.1, CellGeometry{{100, 80}, 0.05, Rigid2(-2.5, -2., 0.)});
  MapState state_;
  ReportOptions options_;
  ReportContent content_;
  int num_readings_ = 0;
};

TEST_F(DrawPicturesTest, DrawsAsManyPairsAsAskedFor) {
  options_.max_closure_pictures = 1;
  ASSERT_TRUE(Draw({"map", &state_, &state_.pose_graph}).ok());
  EXPECT_EQ(num_readings_, 1);
  ASSERT_EQ(content_.maps.size(), 1u);
  EXPECT_EQ(content_.maps[0].caption, "map");
  EXPECT_FALSE(content_.closures[0].png.empty());
  EXPECT_TRUE(content_.closures[1].png.empty());
  EXPECT_EQ(content_.num_undrawn, 1);
}

TEST_F(DrawPicturesTest, DrawsLinksAndLayersWhereTheyAreWanted) {
  content_.closures[0].link = Color{1., 0., 0.};
  const MapPicture plain{"plain", &state_, &state_.pose_graph};
  MapPicture linked = plain;
  linked.shows_links = true;
  MapPicture layered = plain;
  layered.layers = {{0, 0}, {1, 1}};
  for (const MapPicture& map : {plain, plain, linked, layered}) {
    ASSERT_TRUE(Draw(map).ok());
  }
  EXPECT_EQ(content_.maps[0].png, content_.maps[1].png);
  EXPECT_NE(content_.maps[0].png, content_.maps[2].png);
  EXPECT_NE(content_.maps[0].png, content_.maps[3].png);
}

TEST_F(DrawPicturesTest, LeavesOutWhatHasNoPose) {
  state_.pose_graph.submap_poses.erase({1, 0});
  content_.closures[0].link = Color{1., 0., 0.};
  EXPECT_TRUE(Draw({"map", &state_, &state_.pose_graph, true}).ok());
}

TEST(SortByInterestTest, RefusedOnesFirstThenTheLeastCertain) {
  std::vector<ReportedClosure> closures(3);
  closures[0].accepted = true;
  closures[1].match.pair.score = 2.;
  closures[2].match.pair.score = 1.;
  SortByInterest(&closures);
  EXPECT_EQ(closures[0].match.pair.score, 1.);
  EXPECT_EQ(closures[1].match.pair.score, 2.);
  EXPECT_TRUE(closures[2].accepted);
}

}  // namespace
}  // namespace cartographer_sdf::reports_test
