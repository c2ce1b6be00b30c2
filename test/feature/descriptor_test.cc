// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/feature/descriptor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/rotation_repeatability.h"
#include "test/testing/world.h"

namespace cartographer_sdf::descriptor_test {
namespace {

using testing::CentredGeometry;
using testing::Rasterise;
using testing::World;

// Angles and weights of single precision, in a histogram of unit length.
constexpr double kRounding = 1e-5;

Keypoint At(const double x, const double y) {
  return {{x, y}, 0., KeypointKind::kMaximum, 1.};
}

FeatureSet Describe(const DistanceField& field,
                    const std::vector<Keypoint>& keypoints,
                    const DescriptorOptions& options = {}) {
  return DescribeKeypoints(options, field, SmoothField(field, 3.), keypoints);
}

DistanceField FieldOf(const World& world, const double angle = 0.) {
  return *MakeDistanceField(
      {}, Rasterise(world, CentredGeometry(120, 0.05, angle), {}, {10., 10.}));
}

double AngleBetween(const double a, const double b) {
  return std::abs(NormalizeAngle(a - b));
}

// A straight wall below, whose field grows upwards everywhere.
DistanceField WallBelow(const double angle = 0.) {
  return FieldOf(testing::SolidHalfPlane(M_PI_2, -0.5), angle);
}

// The definition, without haste: the histogram about a given direction and the
// mean distance.
Eigen::VectorXd BruteForce(const DescriptorOptions& options,
                           const DistanceField& field, const Eigen::ArrayXXf& f,
                           const Feature& feature) {
  const double sigma = options.gaussian_sigma_ratio * options.radius_meters;
  Eigen::VectorXd histogram = Eigen::VectorXd::Zero(options.num_bins);
  double sum = 0., total = 0.;
  for (int j = 1; j + 1 < f.cols(); ++j) {
    for (int i = 1; i + 1 < f.rows(); ++i) {
      const double distance =
          (field.geometry.CellCentre({i, j}) - feature.keypoint.position)
              .norm();
      if (distance > options.radius_meters) continue;
      const double weight = std::exp(-0.5 * std::pow(distance / sigma, 2));
      const Eigen::Vector2d gradient =
          0.5 *
          Eigen::Vector2d(f(i + 1, j) - f(i - 1, j), f(i, j + 1) - f(i, j - 1));
      const double turned = std::atan2(gradient.y(), gradient.x()) +
                            field.geometry.T_submap_grid.rotation() -
                            feature.orientation;
      // From 0 to 1 turn, then bins that are centred on their angle.
      const double bin = options.num_bins * (turned / (2. * M_PI) -
                                             std::floor(turned / (2. * M_PI)));
      const int low = static_cast<int>(bin);
      histogram[low % options.num_bins] +=
          (low + 1 - bin) * weight * gradient.norm();
      histogram[(low + 1) % options.num_bins] +=
          (bin - low) * weight * gradient.norm();
      sum += weight * field.distance(i, j);
      total += weight;
    }
  }
  Eigen::VectorXd descriptor(options.num_bins + 1);
  descriptor << histogram.normalized(),
      options.distance_weight * 1000. * sum / total;
  return descriptor;
}

TEST(DescribeKeypointsTest, EqualsBruteForce) {
  for (const double angle : {0., 0.7}) {
    OccupancyGrid grid = testing::OfficeGrid(200);
    grid.geometry.T_submap_grid =
        Rigid2(1., 2., angle) * grid.geometry.T_submap_grid;
    const DistanceField field = *MakeDistanceField({}, grid);
    const Eigen::ArrayXXf smoothed = SmoothField(field, 3.);
    DescriptorOptions options;
    for (const int num_bins : {17, 4}) {
      options.num_bins = num_bins;
      options.secondary_orientation_ratio = num_bins == 17 ? 1. : 0.7;
      const FeatureSet set = DescribeKeypoints(
          options, field, smoothed, DetectKeypoints({}, field, smoothed));
      ASSERT_GT(set.features.size(), 10u);
      ASSERT_EQ(set.descriptors.rows(), num_bins + 1);
      ASSERT_EQ(set.descriptors.cols(),
                static_cast<Eigen::Index>(set.features.size()));
      for (size_t k = 0; k < set.features.size(); ++k) {
        EXPECT_LT((set.descriptors.col(k).cast<double>() -
                   BruteForce(options, field, smoothed, set.features[k]))
                      .norm(),
                  kRounding);
      }
    }
  }
}

TEST(DescribeKeypointsTest, EndsWithTwiceTheMeanDistanceInMetres) {
  const FeatureSet set = Describe(WallBelow(), {At(0., 1.2), At(0.5, 0.7)});
  ASSERT_EQ(set.features.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(set.descriptors.col(k).head(17).norm(), 1., 1e-6);
    EXPECT_GE(set.descriptors.col(k).head(17).minCoeff(), 0.f);
  }
  // The mean over a symmetric window of a linear field.
  EXPECT_NEAR(set.descriptors(17, 0), 2. * (1.2 + 0.5), 1e-6);
  EXPECT_NEAR(set.descriptors(17, 1), 2. * (0.7 + 0.5), 1e-6);
  DescriptorOptions options;
  options.distance_weight = 0.;
  EXPECT_EQ(Describe(WallBelow(), {At(0., 1.2)}, options).descriptors(17, 0),
            0.f);
}

TEST(DescribeKeypointsTest, OrientationIsTheDirectionAwayFromTheWall) {
  for (const double angle : {0., 0.3, M_PI_2, 3., -2.}) {
    // The grid's direction does not matter to what is found in the submap.
    const FeatureSet set = Describe(WallBelow(angle), {At(0.1, 0.6)});
    ASSERT_EQ(set.features.size(), 1u);
    // A tenth of an orientation bin, for the raster of a slanting wall.
    EXPECT_LT(AngleBetween(set.features[0].orientation, M_PI_2), 0.017);
    Eigen::Index strongest;
    set.descriptors.col(0).head(17).maxCoeff(&strongest);
    EXPECT_EQ(strongest, 0);
  }
}

// A place without any symmetry.
World Corner() {
  return testing::Furnished({testing::SolidHalfPlane(M_PI_2, -1.),
                             testing::SolidHalfPlane(0.3, -1.6),
                             testing::SolidDisc({0.9, 0.4}, 0.2)});
}

TEST(DescribeKeypointsTest, TurnsWithTheWorldAndLooksTheSame) {
  // Medians of features of a turned floor are in rotation_invariance_test; this
  // is one place, described at the same point.
  // Half a cell nearer to a wall or farther is 0.05 in the last entry; the
  // histogram changes by as much when it turns by an eighth of a bin.
  constexpr double kLargestTurn = 0.05, kLargestDistance = 0.1;
  const FeatureSet still = Describe(FieldOf(Corner()), {At(0.1, -0.2)});
  ASSERT_EQ(still.features.size(), 1u);
  for (int degrees = 0; degrees < 360; degrees += 7) {
    const Rigid2 T_new_old(0.013, 0.031, degrees * M_PI / 180.);
    const Eigen::Vector2d p = T_new_old * Eigen::Vector2d(0.1, -0.2);
    const FeatureSet turned = Describe(
        FieldOf(testing::Moved(T_new_old, Corner())), {At(p.x(), p.y())});
    ASSERT_EQ(turned.features.size(), 1u);
    EXPECT_LT(
        AngleBetween(turned.features[0].orientation,
                     still.features[0].orientation + T_new_old.rotation()),
        kLargestTurn)
        << degrees;
    EXPECT_LT((turned.descriptors - still.descriptors).norm(), kLargestDistance)
        << degrees;
  }
}

TEST(DescribeKeypointsTest, MovesWithTheSubmap) {
  OccupancyGrid grid = Rasterise(Corner(), CentredGeometry(120));
  const FeatureSet before =
      Describe(*MakeDistanceField({}, grid), {At(0.1, -0.2)});
  const Rigid2 T_new_old(100., -50., 3.);
  grid.geometry.T_submap_grid = T_new_old * grid.geometry.T_submap_grid;
  const Eigen::Vector2d p = T_new_old * Eigen::Vector2d(0.1, -0.2);
  const FeatureSet after =
      Describe(*MakeDistanceField({}, grid), {At(p.x(), p.y())});
  ASSERT_EQ(before.features.size(), 1u);
  ASSERT_EQ(after.features.size(), 1u);
  EXPECT_LT(AngleBetween(after.features[0].orientation,
                         before.features[0].orientation + 3.),
            1e-6);
  EXPECT_LT((after.descriptors - before.descriptors).norm(), kRounding);
}

TEST(DescribeKeypointsTest, OtherPeaksGiveFeaturesOfTheirOwn) {
  // Off the middle of a corridor: most gradients point away from the near wall.
  const DistanceField field = FieldOf(testing::Corridor(2.));
  const Keypoint keypoint = At(0.02, -0.07);
  const FeatureSet one = Describe(field, {keypoint});
  ASSERT_EQ(one.features.size(), 1u);
  EXPECT_LT(AngleBetween(one.features[0].orientation, M_PI_2), 1e-6);
  DescriptorOptions options;
  options.secondary_orientation_ratio = 0.5;
  const FeatureSet two = Describe(field, {keypoint, keypoint}, options);
  ASSERT_EQ(two.features.size(), 4u);
  for (const int k : {0, 2}) {
    EXPECT_LT(AngleBetween(two.features[k].orientation, M_PI_2), 1e-6);
    EXPECT_LT(AngleBetween(two.features[k + 1].orientation, -M_PI_2), 1e-6);
    EXPECT_EQ(two.features[k].keypoint.position,
              two.features[k + 1].keypoint.position);
    EXPECT_EQ(two.descriptors.col(k), one.descriptors.col(0));
    EXPECT_EQ(two.descriptors(17, k), two.descriptors(17, k + 1));
  }
  options.secondary_orientation_ratio = 0.95;
  EXPECT_EQ(Describe(field, {keypoint}, options).features.size(), 1u);
}

TEST(DescribeKeypointsTest, KeepsTheOrderOfTheKeypoints) {
  const DistanceField field = FieldOf(Corner());
  const std::vector<Keypoint> keypoints = {At(0.1, -0.2), At(-0.5, 0.5),
                                           At(0.3, 0.9)};
  const FeatureSet all = Describe(field, keypoints);
  ASSERT_EQ(all.features.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const FeatureSet alone = Describe(field, {keypoints[k]});
    ASSERT_EQ(alone.features.size(), 1u);
    EXPECT_EQ(all.features[k].keypoint.position, keypoints[k].position);
    EXPECT_EQ(all.features[k].orientation, alone.features[0].orientation);
    EXPECT_EQ(all.descriptors.col(k), alone.descriptors.col(0));
  }
}

TEST(DescribeKeypointsTest, DegenerateInput) {
  const DistanceField field = FieldOf(Corner());
  const FeatureSet none = Describe(field, {});
  EXPECT_TRUE(none.features.empty());
  EXPECT_EQ(none.descriptors.rows(), 18);
  EXPECT_EQ(none.descriptors.cols(), 0);
  // Beyond the field there is no gradient, at its corner a quarter of them.
  EXPECT_TRUE(Describe(field, {At(50., 0.)}).features.empty());
  const FeatureSet corner = Describe(field, {At(3.5, 3.5)});
  ASSERT_EQ(corner.features.size(), 1u);
  EXPECT_TRUE(corner.descriptors.allFinite());
  DistanceField flat = field;
  flat.distance = 1.f;
  EXPECT_TRUE(DescribeKeypoints({}, flat, flat.distance, {At(0., 0.)})
                  .features.empty());
  for (const int size : {1, 2, 3}) {
    DistanceField tiny;
    tiny.geometry.size = {size, size};
    tiny.distance = Eigen::ArrayXXf::Constant(size, size, 1.f);
    tiny.observed = BoolArray::Constant(size, size, true);
    EXPECT_TRUE(DescribeKeypoints({}, tiny, tiny.distance, {At(0.02, 0.02)})
                    .features.empty());
  }
}

TEST(DescriptorOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(DescriptorOptions()), "");
  const auto error = [](const auto member, const auto value) {
    DescriptorOptions options;
    options.*member = value;
    return Validate(options);
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(error(&DescriptorOptions::radius_meters, 0.),
              HasSubstr("radius_meters"));
  EXPECT_THAT(error(&DescriptorOptions::num_bins, 1), HasSubstr("num_bins"));
  EXPECT_THAT(error(&DescriptorOptions::num_orientation_bins, 3),
              HasSubstr("num_orientation_bins"));
  EXPECT_THAT(error(&DescriptorOptions::distance_weight, std::nan("")),
              HasSubstr("distance_weight"));
  EXPECT_THAT(error(&DescriptorOptions::gaussian_sigma_ratio, -1.),
              HasSubstr("gaussian_sigma_ratio"));
  EXPECT_THAT(error(&DescriptorOptions::secondary_orientation_ratio, 1.1),
              HasSubstr("secondary_orientation_ratio"));
}

}  // namespace
}  // namespace cartographer_sdf::descriptor_test
