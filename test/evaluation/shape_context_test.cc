// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/shape_context.h"

#include <cmath>

#include "cartographer_sdf/evaluation/random_pairs.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/recognition/match.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/shared_data.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

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

namespace cartographer_sdf::shape_context_test {
namespace {

using ::cartographer_sdf::testing::IsPoseNear;

void InOrder(const size_t n, const std::function<void(size_t)>& task) {
  for (size_t k = 0; k < n; ++k) task(k);
}

// What a lidar sees of the west room and the corridor, from several places.
SubmapCloud RoomCloud(const Rigid2& T_world_submap) {
  SubmapCloud cloud;
  for (const Eigen::Vector2d& viewpoint : testing::WestRoomViewpoints()) {
    const Rigid2 T_world_node(viewpoint, 0.);
    for (const SurfacePoint& point :
         testing::TakeScan(testing::TwoRooms(), T_world_node)) {
      cloud.push_back(T_world_submap.Inverse() *
                      (T_world_node * point.position));
    }
  }
  return DownsampleCloud(cloud, 0.05);
}

TEST(ShapeContextTest, HistogramsAreOfUnitLength) {
  const CloudPlaceOptions options;
  const FeatureSet set = DescribeByShapeContexts(options, RoomCloud({}));
  ASSERT_GT(set.features.size(), 10u);
  ASSERT_EQ(set.descriptors.rows(), 3 * 6);
  ASSERT_EQ(set.descriptors.cols(), static_cast<int>(set.features.size()));
  for (Eigen::Index k = 0; k < set.descriptors.cols(); ++k) {
    EXPECT_NEAR(set.descriptors.col(k).norm(), 1.f, 1e-5f);
    EXPECT_GE(set.descriptors.col(k).minCoeff(), 0.f);
  }
}

TEST(ShapeContextTest, DoesNotDependOnHowTheCloudIsTurned) {
  const CloudPlaceOptions options;
  const SubmapCloud cloud = RoomCloud({});
  const Rigid2 T_new_old(12., -7., 2.1);
  SubmapCloud moved;
  for (const Eigen::Vector2d& p : cloud) moved.push_back(T_new_old * p);
  const FeatureSet before = DescribeByShapeContexts(options, cloud);
  const FeatureSet after = DescribeByShapeContexts(options, moved);
  ASSERT_EQ(before.features.size(), after.features.size());
  for (size_t k = 0; k < before.features.size(); ++k) {
    EXPECT_LT((T_new_old * before.features[k].keypoint.position -
               after.features[k].keypoint.position)
                  .norm(),
              1e-3);
    EXPECT_NEAR(NormalizeAngle(after.features[k].orientation -
                               before.features[k].orientation - 2.1),
                0., 1e-3);
    // A point on the very edge of a ring may change sides by rounding.
    EXPECT_LT((before.descriptors.col(static_cast<int>(k)) -
               after.descriptors.col(static_cast<int>(k)))
                  .norm(),
              0.05f);
  }
}

TEST(ShapeContextTest, OnePointFallsIntoItsBin) {
  // A dense corner at the origin, whose opening looks along x, and one wall
  // point far out at 90 degrees.
  CloudPlaceOptions options;
  options.descriptor.orientation_radius_meters = 0.5;
  SubmapCloud cloud;
  for (double along = 0.; along <= 0.45; along += 0.05) {
    cloud.emplace_back(along, along);
    cloud.emplace_back(along, -along);
  }
  const FeatureSet corner = DescribeByShapeContexts(options, cloud);
  ASSERT_EQ(corner.features.size(), 1u);
  EXPECT_NEAR(corner.features[0].orientation, 0., 1e-6);
  const Eigen::Vector2d keypoint = corner.features[0].keypoint.position;
  // In the outermost ring, 60 degrees to the left: the middle of bin 1.
  cloud.push_back(keypoint + 1.5 * Eigen::Vector2d(std::cos(M_PI / 3.),
                                                   std::sin(M_PI / 3.)));
  const FeatureSet both = DescribeByShapeContexts(options, cloud);
  ASSERT_EQ(both.features.size(), 1u);
  const double share = 1. / static_cast<double>(cloud.size());
  const Eigen::VectorXf outer = both.descriptors.col(0).tail(6);
  EXPECT_NEAR(outer[1] * outer[1], share, 1e-3 * share);
  EXPECT_NEAR(outer.squaredNorm(), share, 1e-3 * share);
}

TEST(ShapeContextTest, MatchingFindsThePoseOfAnotherView) {
  const Rigid2 T_world_reference(1., -2., 0.4), T_world_query(3., 2., -1.9);
  Place reference, query;
  reference.id = {0, 1};
  query.id = {0, 9};
  reference.features =
      DescribeByShapeContexts({}, RoomCloud(T_world_reference));
  query.features = DescribeByShapeContexts({}, RoomCloud(T_world_query));
  const auto match = MatchPlaces(PaperMatchOptions(), reference, query);
  ASSERT_TRUE(match.has_value());
  EXPECT_GT(match->pair.score, 10.);
  EXPECT_THAT(
      match->pair.T_reference_query,
      IsPoseNear(T_world_reference.Inverse() * T_world_query, 0.1, 0.02));
}

TEST(ShapeContextTest, NothingYieldsNoFeatures) {
  const FeatureSet none = DescribeByShapeContexts({}, {});
  EXPECT_TRUE(none.features.empty());
  EXPECT_EQ(none.descriptors.rows(), 18);
  EXPECT_EQ(none.descriptors.cols(), 0);
}

TEST(ShapeContextTest, RefusesOptionsOutOfRange) {
  EXPECT_EQ(Validate(CloudPlaceOptions()), "");
  CloudPlaceOptions options;
  options.descriptor.num_angular_bins = 1;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.descriptor.radius_meters = -1.;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.cloud.voxel_size_meters = 0.;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.cloud.max_num_scans = 0;
  EXPECT_NE(Validate(options), "");
}

TEST(SubmapCloudTest, PointsOfOneSquareBecomeTheirMean) {
  const SubmapCloud cloud = DownsampleCloud({{0.01, 0.01},
                                             {0.03, 0.03},
                                             {0.06, 0.01},
                                             {-0.01, 0.},
                                             {std::nan(""), 0.},
                                             {1e300, 0.}},
                                            0.05);
  ASSERT_EQ(cloud.size(), 3u);
  EXPECT_LT((cloud[0] - Eigen::Vector2d(-0.01, 0.)).norm(), 1e-12);
  EXPECT_LT((cloud[1] - Eigen::Vector2d(0.02, 0.02)).norm(), 1e-12);
  EXPECT_LT((cloud[2] - Eigen::Vector2d(0.06, 0.01)).norm(), 1e-12);
}

TEST(SubmapCloudTest, WallsOfTheCloudAreThoseOfTheGrid) {
  SKIP_WITHOUT_SHARED_DATA("willow_1.pbstream");
  const std::string path = SharedDataPath("willow_1.pbstream");
  std::map<SubmapId, OccupancyGrid> grids;
  const auto state =
      ReadMap(path, {[&grids](const SubmapId& id, const SubmapSummary&,
                              const OccupancyGrid& grid) {
                if (id.index == 5) grids.emplace(id, grid);
              }});
  ASSERT_TRUE(state.ok()) << state.status();
  const auto clouds = ReadSubmapClouds({}, path, state->pose_graph);
  ASSERT_TRUE(clouds.ok()) << clouds.status();
  EXPECT_EQ(clouds->size(), state->submaps.size());
  ASSERT_EQ(grids.size(), 1u);
  const auto& [id, grid] = *grids.begin();
  const SubmapCloud& cloud = clouds->at(id);
  ASSERT_GT(cloud.size(), 500u);
  // Poses of nodes are optimised, grids are not: within three cells of a wall.
  int num_near_walls = 0;
  for (const Eigen::Vector2d& point : cloud) {
    const Eigen::Array2i centre = grid.geometry.CellAt(point);
    bool near = false;
    for (int dj = -3; dj <= 3; ++dj) {
      for (int di = -3; di <= 3; ++di) {
        const Eigen::Array2i cell = centre + Eigen::Array2i(di, dj);
        near = near || (grid.geometry.Contains(cell) &&
                        grid.known(cell.x(), cell.y()) &&
                        grid.probability(cell.x(), cell.y()) > 0.5f);
      }
    }
    num_near_walls += near;
  }
  EXPECT_GT(num_near_walls, 0.9 * static_cast<double>(cloud.size()));
}

TEST(SubmapCloudTest, ReadsASmallMap) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.Write(
      "a.pbstream", testing::Container(testing::SmallMap().Records()));
  const auto map = DescribeMapByShapeContexts({}, path, &InOrder);
  ASSERT_TRUE(map.ok()) << map.status();
  for (const auto& [id, place] : map->places) EXPECT_EQ(id, place.id);
  EXPECT_FALSE(
      DescribeMapByShapeContexts({}, directory.File("absent"), &InOrder).ok());
}

}  // namespace
}  // namespace cartographer_sdf::shape_context_test
