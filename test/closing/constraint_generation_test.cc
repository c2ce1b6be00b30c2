// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/constraint_generation.h"

#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::constraint_generation_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::IsPoseNear;
using ::testing::SizeIs;

constexpr double kDegree = M_PI / 180.;
constexpr SubmapId kReference{0, 0}, kQuery{0, 9};

// Two submaps of the west room with ten nodes each: those of the reference are
// 0 to 9, those of the query 90 to 99. The closure is true.
struct Room {
  testing::Building building = testing::TwoRooms();
  Rigid2 T_world_reference{3., 2., 0.4};
  Rigid2 T_world_query{4., 3., -1.};
  SurfaceModel reference = testing::SurfaceSeenFrom(
      building, T_world_reference, testing::WestRoomViewpoints());
  SurfaceModel query = testing::SurfaceSeenFrom(
      building, T_world_query, {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}});
  PoseGraph pose_graph;
  PairPose closure;

  // By how far local SLAM has misplaced the nodes in their submaps.
  explicit Room(const Rigid2& error = Rigid2()) {
    for (const SubmapId& submap : {kReference, kQuery}) {
      for (int k = 0; k < 10; ++k) {
        const NodeId node{0, 10 * submap.index + k};
        pose_graph.constraints.push_back(
            {submap, node,
             T_world(submap).Inverse() * T_world_node(node) * error, 5e2, 1.6e3,
             Constraint::Tag::kIntraSubmap});
      }
    }
    // The host's own closures do not make nodes part of a submap.
    pose_graph.constraints.push_back(
        {kReference, {0, 50}, Rigid2(), 1., 1., Constraint::Tag::kInterSubmap});
    closure.reference = kReference;
    closure.query = kQuery;
    closure.T_reference_query = T_world_reference.Inverse() * T_world_query;
  }

  [[nodiscard]] Rigid2 T_world(const SubmapId& submap) const {
    return submap == kReference ? T_world_reference : T_world_query;
  }
  [[nodiscard]] Rigid2 T_world_node(const NodeId& node) const {
    const double k = node.index % 10;
    return node.index < 50 ? Rigid2(1. + 0.3 * k, 2.2, 0.1 * k)
                           : Rigid2(5.5 - 0.1 * k, 4.2 - 0.2 * k, 2. - 0.1 * k);
  }
  [[nodiscard]] PointCloud2 ScanAt(const Rigid2& T_world_node) const {
    PointCloud2 scan;
    for (const SurfacePoint& point :
         testing::TakeScan(building, T_world_node)) {
      scan.push_back(point.position.cast<float>());
    }
    return scan;
  }
  [[nodiscard]] ScansByNode Scans() const {
    ScansByNode scans;
    for (const Constraint& constraint : pose_graph.constraints) {
      scans[constraint.node] = ScanAt(T_world_node(constraint.node));
    }
    return scans;
  }
  [[nodiscard]] Rigid2 Truth(const Constraint& constraint) const {
    return T_world(constraint.submap).Inverse() * T_world_node(constraint.node);
  }
  [[nodiscard]] std::vector<Constraint> Generate(
      const ScansByNode& scans, const ConstraintOptions& options = {}) const {
    return GenerateConstraints(options, closure, FindInsertedNodes(pose_graph),
                               reference, query, scans);
  }
};

TEST(ChooseNodesTest, AreEvenlySpaced) {
  const Room room;
  std::map<SubmapId, InsertedNodes> inserted =
      FindInsertedNodes(room.pose_graph);
  EXPECT_EQ(inserted.size(), 2u);
  const auto indices = [&inserted](const int count, const SubmapId& submap) {
    ConstraintOptions options;
    options.num_nodes_per_submap = count;
    std::vector<int> result;
    for (const auto& [node, pose] : ChooseNodes(options, inserted[submap])) {
      EXPECT_EQ(node.trajectory, 0);
      result.push_back(node.index);
    }
    return result;
  };
  EXPECT_THAT(indices(5, kReference), ElementsAre(1, 3, 5, 7, 9));
  EXPECT_THAT(indices(3, kReference), ElementsAre(1, 5, 8));
  EXPECT_THAT(indices(1, kQuery), ElementsAre(95));
  EXPECT_THAT(indices(100, kQuery),
              ElementsAre(90, 91, 92, 93, 94, 95, 96, 97, 98, 99));
  EXPECT_THAT(indices(5, {0, 4}), IsEmpty());
}

TEST(GenerateConstraintsTest, ComposesPosesWithoutScans) {
  const Rigid2 error(0.05, -0.02, 0.01);
  Room room(error);
  // Not the true one.
  room.closure.T_reference_query = Rigid2(7., -3., 2.);
  const std::vector<Constraint> constraints = room.Generate({});
  ASSERT_THAT(constraints, SizeIs(10));
  for (size_t k = 0; k < constraints.size(); ++k) {
    const Constraint& constraint = constraints[k];
    const bool forward = k < 5;
    EXPECT_EQ(constraint.submap, forward ? kReference : kQuery);
    EXPECT_EQ(constraint.node.index, forward ? 91 + 2 * static_cast<int>(k)
                                             : 1 + 2 * static_cast<int>(k - 5));
    EXPECT_EQ(constraint.tag, Constraint::Tag::kInterSubmap);
    EXPECT_EQ(constraint.translation_weight, 1.1e4);
    EXPECT_EQ(constraint.rotation_weight, 1e5);
    // (submap <- other submap) (other submap <- node)
    const Rigid2 T_other_node =
        room.T_world(forward ? kQuery : kReference).Inverse() *
        room.T_world_node(constraint.node) * error;
    const Rigid2 expected = forward
                                ? Rigid2(7., -3., 2.) * T_other_node
                                : Rigid2(7., -3., 2.).Inverse() * T_other_node;
    EXPECT_THAT(constraint.T_submap_node, IsPoseNear(expected, 1e-9, 1e-9));
  }
}

TEST(GenerateConstraintsTest, ScansCorrectLocalSlam) {
  const Room room(Rigid2(0.04, -0.03, 0.015));
  const std::vector<Constraint> constraints = room.Generate(room.Scans());
  ASSERT_THAT(constraints, SizeIs(10));
  for (const Constraint& constraint : constraints) {
    EXPECT_THAT(constraint.T_submap_node,
                IsPoseNear(room.Truth(constraint), 0.02, 0.3 * kDegree));
  }
  // Without, they are as wrong as local SLAM.
  for (const Constraint& constraint : room.Generate({})) {
    EXPECT_THAT(constraint.T_submap_node,
                ::testing::Not(IsPoseNear(room.Truth(constraint), 0.04, 1.)));
  }
}

TEST(GenerateConstraintsTest, NodesWithoutAScanStayAsTheyWere) {
  const Rigid2 error(0.04, -0.03, 0.015);
  const Room room(error);
  ScansByNode scans = room.Scans();
  scans.erase({0, 93});
  const std::vector<Constraint> constraints = room.Generate(scans);
  ASSERT_THAT(constraints, SizeIs(10));
  for (const Constraint& constraint : constraints) {
    const bool refined = constraint.node != NodeId{0, 93};
    EXPECT_THAT(
        constraint.T_submap_node,
        IsPoseNear(room.Truth(constraint) * (refined ? Rigid2() : error),
                   refined ? 0.02 : 1e-9, refined ? 0.01 : 1e-9));
  }
}

TEST(GenerateConstraintsTest, ScansThatDisagreeGiveNoConstraint) {
  Room room;
  ScansByNode scans = room.Scans();
  // A scan of another room: few points are on walls.
  scans[{0, 93}] = room.ScanAt(Rigid2(13.5, 3.4, 0.));
  EXPECT_THAT(room.Generate(scans), SizeIs(9));
  // A false closure: no scan fits, or it moves too far.
  room.closure.T_reference_query =
      Rigid2(0.9, -0.7, 0.2) * room.closure.T_reference_query;
  EXPECT_THAT(room.Generate(room.Scans()), IsEmpty());
}

TEST(GenerateConstraintsTest, ARegistrationMustStayNear) {
  Room room;
  // 0.35 m, where three sigmas are 0.3 m.
  room.closure.T_reference_query =
      room.closure.T_reference_query * Rigid2(0.35, 0., 0.);
  EXPECT_THAT(room.Generate(room.Scans()), IsEmpty());
  ConstraintOptions options;
  options.max_num_sigmas = 6.;
  EXPECT_THAT(room.Generate(room.Scans(), options), SizeIs(10));
}

TEST(GenerateConstraintsTest, NothingOfSubmapsWithoutNodes) {
  Room room;
  room.pose_graph.constraints.clear();
  EXPECT_THAT(room.Generate(room.Scans()), IsEmpty());
}

TEST(ConstraintOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(ConstraintOptions()), "");
  const auto error = [](const std::function<void(ConstraintOptions*)>& set) {
    ConstraintOptions options;
    set(&options);
    return Validate(options);
  };
  EXPECT_NE(error([](auto* o) { o->num_nodes_per_submap = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->min_num_constraints = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->min_num_constraints = 11; }), "");
  EXPECT_NE(error([](auto* o) { o->translation_weight = 0.; }), "");
  EXPECT_NE(error([](auto* o) { o->rotation_sigma = NAN; }), "");
  EXPECT_NE(error([](auto* o) { o->min_hit_ratio = 1.1; }), "");
}

}  // namespace
}  // namespace cartographer_sdf::constraint_generation_test
