// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/curvature_clusters.h"

#include <cmath>

#include "cartographer_sdf/geometry/rigid2.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::curvature_clusters_test {
namespace {

constexpr double kSpacing = 0.05;  // between points of a wall [m]

void AddWall(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
             SubmapCloud* const cloud) {
  const double length = (to - from).norm();
  for (double along = 0.; along <= length; along += kSpacing) {
    cloud->push_back(from + along / length * (to - from));
  }
}

SubmapCloud Moved(const Rigid2& T_new_old, const SubmapCloud& cloud) {
  SubmapCloud moved;
  for (const Eigen::Vector2d& p_old : cloud) moved.push_back(T_new_old * p_old);
  return moved;
}

TEST(CurvatureClustersTest, StraightWallsHaveNoCurvature) {
  SubmapCloud cloud;
  AddWall({0., 0.}, {5., 3.}, &cloud);
  for (const double curvature : Curvatures({}, cloud)) {
    EXPECT_NEAR(curvature, 0., 1e-9);
  }
  EXPECT_TRUE(FindCurvatureClusters({}, cloud).empty());
}

TEST(CurvatureClustersTest, RoundClutterIsCurvedAlike) {
  // Scatter of a disc is the same in all directions.
  SubmapCloud cloud;
  for (double x = -2.; x <= 2.; x += kSpacing) {
    for (double y = -2.; y <= 2.; y += kSpacing) cloud.emplace_back(x, y);
  }
  CurvatureClusterOptions options;
  // No points of the raster lie on its rim, where rounding would decide.
  options.scatter_radius_meters = 0.42;
  const std::vector<double> curvatures = Curvatures(options, cloud);
  for (size_t k = 0; k < cloud.size(); ++k) {
    // On the raster, the scatter is isotropic to rounding.
    if (cloud[k].cwiseAbs().maxCoeff() < 1.5) {
      EXPECT_NEAR(curvatures[k], 0.5, 1e-6);
    }
  }
}

TEST(CurvatureClustersTest, CornersAreKeypointsWhereverTheyLie) {
  SubmapCloud room;
  const std::vector<Eigen::Vector2d> corners = {
      {0., 0.}, {4., 0.}, {4., 3.}, {0., 3.}};
  for (int k = 0; k < 4; ++k) AddWall(corners[k], corners[(k + 1) % 4], &room);
  const CurvatureClusterOptions options;
  for (const Rigid2& T_new_old :
       {Rigid2(), Rigid2(30., -20., 0.7), Rigid2(-5., 2., -2.5)}) {
    const std::vector<CurvatureCluster> clusters =
        FindCurvatureClusters(options, Moved(T_new_old, room));
    ASSERT_EQ(clusters.size(), 4u);
    for (const Eigen::Vector2d& corner : corners) {
      double nearest = 1e9;
      for (const CurvatureCluster& cluster : clusters) {
        nearest =
            std::min(nearest, (cluster.position - T_new_old * corner).norm());
        EXPECT_GT(cluster.curvature, options.detection_threshold);
        EXPECT_LE(cluster.curvature, 0.5);
      }
      // The bend is seen from within the scatter's radius on both walls, so
      // that the cluster's middle lies somewhat inside of the corner.
      EXPECT_LT(nearest, 0.5 * options.scatter_radius_meters);
    }
  }
}

TEST(CurvatureClustersTest, ThresholdAndSizeLeaveOutTheFaint) {
  SubmapCloud cloud;
  AddWall({0., 0.}, {3., 0.}, &cloud);
  AddWall({3., 0.}, {6., 1.}, &cloud);  // a bend of 18 degrees
  AddWall({0., 0.}, {0., 3.}, &cloud);  // a corner
  CurvatureClusterOptions options;
  options.detection_threshold = 0.1;
  const auto clusters = FindCurvatureClusters(options, cloud);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_LT(clusters[0].position.norm(), 0.2);
  options.detection_threshold = 0.005;
  EXPECT_EQ(FindCurvatureClusters(options, cloud).size(), 2u);
  options.min_num_points = 1000;
  EXPECT_TRUE(FindCurvatureClusters(options, cloud).empty());
}

TEST(CurvatureClustersTest, LonelyPointsAreNoSurface) {
  EXPECT_TRUE(FindCurvatureClusters({}, {}).empty());
  const SubmapCloud few = {{0., 0.}, {0.1, 0.}, {0., 0.1}, {50., 50.}};
  EXPECT_THAT(Curvatures({}, few), ::testing::Each(0.));
  // Of one place many times there is no scatter.
  const SubmapCloud same(20, Eigen::Vector2d(1., 2.));
  EXPECT_THAT(Curvatures({}, same), ::testing::Each(0.));
}

TEST(CurvatureClustersTest, RefusesOptionsOutOfRange) {
  EXPECT_EQ(Validate(CurvatureClusterOptions()), "");
  CurvatureClusterOptions options;
  options.detection_threshold = 0.6;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.scatter_radius_meters = std::nan("");
  EXPECT_NE(Validate(options), "");
  options = {};
  options.cluster_radius_meters = 0.;
  EXPECT_NE(Validate(options), "");
}

}  // namespace
}  // namespace cartographer_sdf::curvature_clusters_test
