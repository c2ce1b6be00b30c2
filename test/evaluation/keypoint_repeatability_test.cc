// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "test/testing/keypoint_repeatability.h"

#include "gtest/gtest.h"
#include "test/testing/ascii_grid.h"
#include "test/testing/world.h"

namespace cartographer_sdf::keypoint_repeatability_test {
namespace {

using OfKind = testing::KeypointRepeatability::OfKind;

// A room with two pillars, seen from where it is turned by `angle`.
Place RoomFrom(const double angle) {
  const testing::World world =
      testing::Furnished({testing::Room({0., 0.}, {5., 4.}),
                          testing::SolidBox({1., 0.8}, {.5, .3}),
                          testing::SolidDisc({-1.2, -0.4}, 0.3)});
  return *DescribePlace({}, {0, 0},
                        testing::Rasterise(world, testing::CentredGeometry(140),
                                           Rigid2(0., 0., angle)));
}

TEST(KeypointRepeatabilityTest, APlaceHasAllOfItself) {
  const Place place = RoomFrom(0.);
  testing::KeypointRepeatability repeatability;
  testing::AddKeypointRepeatability(place, place, Rigid2(), &repeatability);
  const OfKind total = repeatability.Total();
  // Both ways.
  EXPECT_EQ(total.num_judged,
            2 * static_cast<int>(place.features.features.size()));
  EXPECT_GT(total.num_judged, 20);
  EXPECT_EQ(total.num_found, total.num_judged);
  EXPECT_EQ(total.num_oriented, total.num_judged);
  EXPECT_LT(total.num_found_by_chance, total.num_judged_by_chance / 2);
}

TEST(KeypointRepeatabilityTest, TurnsAndWrongPosesAreTold) {
  const Place place = RoomFrom(0.), turned = RoomFrom(0.5);
  testing::KeypointRepeatability right, wrong;
  // Rasterise() takes the pose of the submap in the world.
  const Rigid2 T_place_turned(0., 0., 0.5);
  testing::AddKeypointRepeatability(place, turned, T_place_turned, &right);
  testing::AddKeypointRepeatability(place, turned, Rigid2(0.5, 0.5, -0.5),
                                    &wrong);
  EXPECT_GT(right.Total().num_found, 0.7 * right.Total().num_judged);
  EXPECT_LT(wrong.Total().num_found, 0.5 * wrong.Total().num_judged);
}

}  // namespace
}  // namespace cartographer_sdf::keypoint_repeatability_test
