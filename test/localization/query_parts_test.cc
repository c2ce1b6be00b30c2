// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/query_parts.h"

#include <map>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::query_parts_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsPoseNear;
using ::testing::SizeIs;

constexpr int kNumPlaces = 12;
constexpr double kStep = 3.;  // [m]

// Submaps every few metres along the x axis, in the map and in the query.
MapLayout StraightDrive(const int num_places) {
  PoseGraph graph;
  std::map<SubmapId, OdometryPose> odometry;
  for (int k = 0; k < num_places; ++k) {
    const Rigid2 pose(kStep * k, 0., 0.);
    graph.submap_poses[{0, k}] = pose;
    odometry[{0, k}] = {pose, kStep * k};
  }
  MapLayout layout = MakeMapLayout(graph, odometry, {});
  for (const auto& [id, pose] : graph.submap_poses) {
    layout.centroids[id] = Eigen::Vector2d::Zero();
    layout.diameters[id] = 8.;
  }
  return layout;
}

class QueryPartsTest : public ::testing::Test {
 protected:
  // The place of the query is seen from the map's submap of the same index, at
  // the pose that T_map_query gives it.
  void Vote(const int place, const Rigid2& T_map_query) {
    const SubmapId id{0, place};
    votes_.push_back({id, id,
                      map_.T_map_submap.at(id).Inverse() * T_map_query *
                          query_.T_map_submap.at(id),
                      8.});
  }
  [[nodiscard]] QueryParts Find() const {
    const MapPair maps{&map_, &query_};
    return FindQueryParts(options_, consistency_, maps, votes_,
                          FindPlacements(options_, consistency_, maps, votes_));
  }

  const PlacementOptions options_{};
  const ConsistencyOptions consistency_{};
  const MapLayout map_ = StraightDrive(kNumPlaces);
  const MapLayout query_ = StraightDrive(kNumPlaces);
  std::vector<PairPose> votes_;
};

TEST_F(QueryPartsTest, ARigidQueryIsOne) {
  for (int k = 0; k < kNumPlaces; ++k) Vote(k, Rigid2(1., 2., 0.1));
  const QueryParts found = Find();
  ASSERT_THAT(found.parts, SizeIs(1));
  EXPECT_EQ(found.parts[0].first, (SubmapId{0, 0}));
  EXPECT_EQ(found.parts[0].last, (SubmapId{0, kNumPlaces - 1}));
  EXPECT_THAT(found.parts[0].placement.T_map_query,
              IsPoseNear(Rigid2(1., 2., 0.1), 1e-6, 1e-6));
  EXPECT_THAT(found.jumps, IsEmpty());
  EXPECT_EQ(DescribeJumps(found.jumps), "");
}

TEST_F(QueryPartsTest, ARobotThatWasCarriedIsTwo) {
  const Rigid2 carried(5., 7., 0.5);
  // The second part is the better one, and yet comes second.
  for (int k = 0; k < 4; ++k) Vote(k, Rigid2());
  for (int k = 5; k < kNumPlaces; ++k) Vote(k, carried);
  const QueryParts found = Find();
  ASSERT_THAT(found.parts, SizeIs(2));
  EXPECT_EQ(found.parts[0].last, (SubmapId{0, 3}));
  EXPECT_EQ(found.parts[1].first, (SubmapId{0, 5}));
  EXPECT_THAT(found.parts[0].placement.T_map_query,
              IsPoseNear(Rigid2(), 1e-6, 1e-6));
  EXPECT_THAT(found.parts[1].placement.T_map_query,
              IsPoseNear(carried, 1e-6, 1e-6));
  ASSERT_THAT(found.jumps, SizeIs(1));
  EXPECT_EQ(found.jumps[0].before, (SubmapId{0, 3}));
  EXPECT_EQ(found.jumps[0].after, (SubmapId{0, 5}));
  const Eigen::Vector2d after(5. * kStep, 0.);
  EXPECT_NEAR(found.jumps[0].distance, (carried * after - after).norm(), 1e-6);
  EXPECT_THAT(DescribeJumps(found.jumps),
              HasSubstr("between its submaps 0,3 and 0,5 the query jumps by "));
}

TEST_F(QueryPartsTest, ASlipIsNoJump) {
  for (int k = 0; k < 6; ++k) Vote(k, Rigid2());
  for (int k = 6; k < kNumPlaces; ++k) Vote(k, Rigid2(2., 1.5, 0.));
  const QueryParts found = Find();
  EXPECT_THAT(found.parts, SizeIs(2));
  EXPECT_THAT(found.jumps, IsEmpty());
}

TEST_F(QueryPartsTest, ARivalForTheSamePlacesIsNone) {
  for (int k = 0; k < kNumPlaces; ++k) Vote(k, Rigid2());
  for (int k = 3; k < 7; ++k) Vote(k, Rigid2(5., 7., 0.5));
  const QueryParts found = Find();
  EXPECT_THAT(found.parts, SizeIs(1));
  EXPECT_THAT(found.jumps, IsEmpty());
}

TEST_F(QueryPartsTest, WhatIsUncertainIsNone) {
  for (int k = 0; k < 6; ++k) Vote(k, Rigid2());
  Vote(9, Rigid2(5., 7., 0.5));
  votes_.back().score = 4.;
  EXPECT_THAT(Find().parts, SizeIs(1));
}

}  // namespace
}  // namespace cartographer_sdf::query_parts_test
