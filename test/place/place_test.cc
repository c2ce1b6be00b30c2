// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place/place.h"

#include <optional>

#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::place_test {
namespace {

std::optional<Place> Describe(const OccupancyGrid& grid) {
  return DescribePlace(PlaceOptions(), {1, 2}, grid);
}

OccupancyGrid Empty(const int width, const int height) {
  CellGeometry geometry;
  geometry.size = {width, height};
  return UnknownGrid(geometry);
}

TEST(DescribePlaceTest, DescribesARoom) {
  const std::optional<Place> place = Describe(testing::SeeFrom(
      testing::TwoRooms(), Rigid2(3., 2., 0.4), testing::WestRoomViewpoints()));
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->id, (SubmapId{1, 2}));
  EXPECT_GT(place->surface.walls.size(), 300u);
  EXPECT_GT(place->features.features.size(), 30u);
  EXPECT_EQ(place->features.descriptors.cols(),
            static_cast<int>(place->features.features.size()));
  // Within what was seen: 7 m x 5 m, and through the door.
  for (const Feature& feature : place->features.features) {
    const Eigen::Vector2d p_world =
        Rigid2(3., 2., 0.4) * feature.keypoint.position;
    EXPECT_GT(p_world.x(), -4.);
    EXPECT_LT(p_world.x(), 17.);
    EXPECT_GT(p_world.y(), -1.);
    EXPECT_LT(p_world.y(), 8.);
  }
}

// The field is smoothed near observed cells alone.
TEST(DescribePlaceTest, HasTheFeaturesOfTheWholeField) {
  PlaceOptions options;
  options.descriptor.radius_meters = 1.5;
  const OccupancyGrid grid = testing::SeeFrom(
      testing::TwoRooms(), Rigid2(3., 2., 0.4), testing::WestRoomViewpoints());
  const std::optional<Place> place = DescribePlace(options, {1, 2}, grid);
  ASSERT_TRUE(place.has_value());
  const DistanceField field = *MakeDistanceField(options.field, grid);
  const Eigen::ArrayXXf smoothed =
      SmoothField(field, options.keypoint.smoothing_sigma_cells);
  const FeatureSet expected =
      DescribeKeypoints(options.descriptor, field, smoothed,
                        DetectKeypoints(options.keypoint, field, smoothed));
  EXPECT_TRUE(place->features.descriptors == expected.descriptors);
}

TEST(DescribePlaceTest, NoneForDegenerateGrids) {
  EXPECT_FALSE(Describe(OccupancyGrid()).has_value());
  EXPECT_FALSE(Describe(Empty(1, 1)).has_value());
  EXPECT_FALSE(Describe(Empty(40, 30)).has_value());
  OccupancyGrid free = Empty(40, 30);
  free.known.setConstant(true);
  free.probability.setConstant(0.2f);
  EXPECT_FALSE(Describe(free).has_value());
}

TEST(DescribePlaceTest, FewFeaturesOfFewWalls) {
  // Everything is wall.
  OccupancyGrid solid = Empty(40, 30);
  solid.known.setConstant(true);
  solid.probability.setConstant(0.8f);
  EXPECT_TRUE(Describe(solid).has_value());
  // One wall cell in free space.
  OccupancyGrid post = Empty(40, 30);
  post.known.setConstant(true);
  post.probability.setConstant(0.2f);
  post.probability(20, 15) = 0.8f;
  const std::optional<Place> place = Describe(post);
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->surface.walls.size(), 1u);
  // A single cell, all there is.
  OccupancyGrid cell = Empty(1, 1);
  cell.known.setConstant(true);
  cell.probability.setConstant(0.8f);
  EXPECT_TRUE(Describe(cell).has_value());
}

TEST(PlaceOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(PlaceOptions()), "");
  PlaceOptions field, keypoint, descriptor;
  field.field.occupied_probability = 2.;
  keypoint.keypoint.detection_threshold = -1.;
  descriptor.descriptor.num_bins = 0;
  EXPECT_NE(Validate(field), "");
  EXPECT_NE(Validate(keypoint), "");
  EXPECT_NE(Validate(descriptor), "");
}

}  // namespace
}  // namespace cartographer_sdf::place_test
