// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/placement_covariance.h"

#include <cmath>
#include <map>
#include <vector>

#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "gtest/gtest.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::placement_covariance_test {
namespace {

constexpr SubmapId kFirst{0, 0}, kSecond{0, 1}, kQuery{1, 0};

CellGeometry GeometryOf(const double width, const double height) {
  CellGeometry geometry;
  geometry.resolution = 0.05;
  geometry.size = Eigen::Array2i(static_cast<int>(width / 0.05),
                                 static_cast<int>(height / 0.05));
  geometry.T_submap_grid = Rigid2(-0.5 * width, -0.5 * height, 0.);
  return geometry;
}

MapLayout EmptyLayout() { return {{}, {}, {}, DrivenDistances({}, {})}; }

// A query in a map of two submaps, all of which show the same walls.
class PlacementCovarianceTest : public ::testing::Test {
 protected:
  // Submaps at these poses in the map, the query at the first.
  void SetUpMap(const OccupancyGrid& grid, const Rigid2& T_map_first,
                const Rigid2& T_map_second) {
    SetUpMap(grid, grid, T_map_first, T_map_second);
  }
  void SetUpMap(const OccupancyGrid& grid, const OccupancyGrid& query_grid,
                const Rigid2& T_map_first, const Rigid2& T_map_second) {
    PoseGraph map_graph, query_graph;
    map_graph.submap_poses = {{kFirst, T_map_first}, {kSecond, T_map_second}};
    query_graph.submap_poses = {{kQuery, Rigid2()}};
    for (const SubmapId& id : {kFirst, kSecond}) {
      map_places_[id] = *DescribePlace(PlaceOptions(), id, grid);
    }
    query_places_[kQuery] = *DescribePlace(PlaceOptions(), kQuery, query_grid);
    map_ = MakeMapLayout(map_graph, {}, map_places_);
    query_ = MakeMapLayout(query_graph, {}, query_places_);
    T_map_query_ = T_map_first;
  }
  // The query where it is, as each submap of the map sees it.
  [[nodiscard]] PairPose Vote(const SubmapId& reference,
                              const Rigid2& T_query_voted = Rigid2()) const {
    return {reference, kQuery,
            map_.T_map_submap.at(reference).Inverse() * T_map_query_ *
                T_query_voted,
            5.};
  }
  [[nodiscard]] Eigen::Matrix3d Measure(
      const std::vector<PairPose>& votes,
      const Rigid2& T_query_robot = Rigid2()) const {
    return PlacementCovariance(map_places_, query_places_, {&map_, &query_},
                               votes, T_map_query_, T_query_robot);
  }

  std::map<SubmapId, Place> map_places_, query_places_;
  MapLayout map_ = EmptyLayout(), query_ = EmptyLayout();
  Rigid2 T_map_query_;
};

// Walls of a corridor that slants in the grid, of this length: what is beyond
// has not been seen.
OccupancyGrid Corridor(const double length, const double slant) {
  OccupancyGrid grid = UnknownGrid(GeometryOf(length, length));
  const Rigid2 T_corridor_submap(0., 0., -slant);
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      const Eigen::Vector2d p =
          T_corridor_submap * grid.geometry.CellCentre({i, j});
      if (std::abs(p.x()) > 0.5 * length || std::abs(p.y()) > 1.1) continue;
      grid.known(i, j) = true;
      grid.probability(i, j) = std::abs(p.y()) > 1. ? 0.9f : 0.1f;
    }
  }
  return grid;
}

TEST_F(PlacementCovarianceTest, WallsAllRoundHoldThePose) {
  SetUpMap(RectangularRoom(6., 4., 0.1, GeometryOf(7., 5.)), Rigid2(3., 4., 1.),
           Rigid2(3.5, 4., 1.2));
  const Eigen::Matrix3d covariance = Measure({Vote(kFirst)});
  EXPECT_TRUE(covariance.isApprox(covariance.transpose()));
  EXPECT_LT(std::sqrt(covariance(0, 0)), 0.05);
  EXPECT_LT(std::sqrt(covariance(1, 1)), 0.05);
  EXPECT_LT(std::sqrt(covariance(2, 2)), 0.01);
}

TEST_F(PlacementCovarianceTest, ACorridorLeavesItFreeAlong) {
  for (const double slant : {0., 0.1, 0.35, 0.7}) {
    SetUpMap(Corridor(16., slant), Corridor(10., slant), Rigid2(3., 4., 1.),
             Rigid2(3.2, 4.1, 1.));
    const Eigen::Matrix3d covariance = Measure({Vote(kFirst)});
    const double yaw = 1. + slant;
    const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0.);
    const Eigen::Vector3d across(-std::sin(yaw), std::cos(yaw), 0.);
    EXPECT_GT(std::sqrt(along.dot(covariance * along)), 0.5) << slant;
    EXPECT_LT(std::sqrt(across.dot(covariance * across)), 0.05) << slant;
    EXPECT_LT(std::sqrt(covariance(2, 2)), 0.02) << slant;
  }
}

TEST_F(PlacementCovarianceTest, OverlappingSubmapsSayTheSameOnce) {
  SetUpMap(RectangularRoom(6., 4., 0.1, GeometryOf(7., 5.)), Rigid2(3., 4., 1.),
           Rigid2(3., 4., 1.));
  EXPECT_TRUE(
      Measure({Vote(kFirst), Vote(kSecond)}).isApprox(Measure({Vote(kFirst)})));
}

TEST_F(PlacementCovarianceTest, VotesThatDisagreeMakeItLarger) {
  SetUpMap(RectangularRoom(6., 4., 0.1, GeometryOf(7., 5.)), Rigid2(3., 4., 0.),
           Rigid2(3., 4., 0.));
  const Eigen::Matrix3d agreed = Measure({Vote(kFirst), Vote(kSecond)});
  const Eigen::Matrix3d disagreed = Measure(
      {Vote(kFirst, Rigid2(0.3, 0., 0.)), Vote(kSecond, Rigid2(-0.3, 0., 0.))});
  EXPECT_GT(std::sqrt(disagreed(0, 0)), 0.3);
  EXPECT_LT(std::sqrt(disagreed(0, 0)), 0.35);
  EXPECT_NEAR(std::sqrt(disagreed(1, 1)), std::sqrt(agreed(1, 1)), 0.02);
}

TEST_F(PlacementCovarianceTest, FarFromTheWallsTheHeadingCounts) {
  SetUpMap(RectangularRoom(6., 4., 0.1, GeometryOf(7., 5.)), Rigid2(3., 4., 0.),
           Rigid2(3., 4., 0.));
  const Eigen::Matrix3d near = Measure({Vote(kFirst)});
  const Eigen::Matrix3d far = Measure({Vote(kFirst)}, Rigid2(50., 0., 0.));
  EXPECT_GT(far(1, 1), 2. * near(1, 1));
  EXPECT_NEAR(far(2, 2), near(2, 2), 0.01 * near(2, 2));
}

}  // namespace
}  // namespace cartographer_sdf::placement_covariance_test
