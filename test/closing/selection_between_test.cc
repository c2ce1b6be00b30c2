// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <limits>

#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::selection_between_test {
namespace {

constexpr int kNumSubmaps = 10;
constexpr double kSpacing = 5.;  // [m]

// Adds a straight drive: submap and node i at i * kSpacing along the way, seen
// from a local frame of its own.
void AddDrive(const int trajectory, const Rigid2& T_local_way,
              MapState* const state) {
  for (int i = 0; i != kNumSubmaps; ++i) {
    const Rigid2 pose = T_local_way * Rigid2(kSpacing * i, 0., 0.);
    state->submaps[{trajectory, i}].T_local_submap = pose;
    const NodeId node{trajectory, i};
    state->pose_graph.nodes[node].T_local_node = pose;
    Constraint constraint;
    constraint.submap = {trajectory, i};
    constraint.node = node;
    constraint.tag = Constraint::Tag::kIntraSubmap;
    state->pose_graph.constraints.push_back(constraint);
  }
}

// Of the same way in both maps; true but for `error`.
PairPose Closure(const SubmapId& reference, const SubmapId& query,
                 const double error = 0.) {
  PairPose closure;
  closure.reference = reference;
  closure.query = query;
  closure.T_reference_query =
      Rigid2(kSpacing * (query.index - reference.index) + error, 0., 0.);
  closure.score = 5.;
  return closure;
}

const Rigid2 kWay(3., 4., 1.);
const Rigid2 kOtherWay(-30., 7., -2.);

std::vector<PairPose> Closures(const int reference, const int query) {
  return {Closure({reference, 0}, {query, 1}),
          Closure({reference, 1}, {query, 1}),
          Closure({reference, 2}, {query, 3}),
          Closure({reference, 2}, {query, 2}, 4.),
          Closure({reference, 3}, {query, 2})};
}

// As if both drives were in one file.
std::vector<SelectionResult> Expected() {
  MapState both;
  AddDrive(0, kWay, &both);
  AddDrive(1, kOtherWay, &both);
  return SelectConsistent(ConsistencyOptions(), OdometryPoses(both),
                          Closures(0, 1));
}

TEST(SelectConsistentBetweenTest, RefusesTheOneThatOthersContradict) {
  const std::vector<SelectionResult> expected = Expected();
  for (size_t k = 0; k != expected.size(); ++k) {
    EXPECT_EQ(expected[k].selection,
              k == 3 ? Selection::kInconsistent : Selection::kSelected);
  }
}

TEST(SelectConsistentBetweenTest, IdsOfTheTwoMapsDoNotMix) {
  const std::vector<SelectionResult> expected = Expected();
  constexpr int kLast = std::numeric_limits<int>::max();
  for (const auto& [reference, query] : std::vector<std::pair<int, int>>{
           {0, 0}, {0, 1}, {7, 3}, {kLast, kLast}}) {
    MapState reference_map, query_map;
    AddDrive(reference, kWay, &reference_map);
    AddDrive(query, kOtherWay, &query_map);
    const std::vector<SelectionResult> results = SelectConsistentBetween(
        ConsistencyOptions(), OdometryPoses(reference_map),
        OdometryPoses(query_map), Closures(reference, query));
    ASSERT_EQ(results.size(), expected.size());
    for (size_t k = 0; k != results.size(); ++k) {
      EXPECT_EQ(results[k].selection, expected[k].selection) << k;
      EXPECT_EQ(results[k].support, expected[k].support) << k;
      EXPECT_EQ(results[k].contradiction, expected[k].contradiction) << k;
    }
  }
}

TEST(SelectConsistentBetweenTest, DrivesOfOneMapAreDifferentOnes) {
  MapState reference_map, query_map;
  AddDrive(0, kWay, &reference_map);
  AddDrive(1, kOtherWay, &reference_map);
  AddDrive(0, kWay, &query_map);
  // No odometry joins two drives: neither supports the other.
  const std::vector<SelectionResult> results = SelectConsistentBetween(
      ConsistencyOptions(), OdometryPoses(reference_map),
      OdometryPoses(query_map),
      {Closure({0, 0}, {0, 0}), Closure({1, 1}, {0, 1})});
  for (const SelectionResult& result : results) {
    EXPECT_EQ(result.support, 0.);
    EXPECT_EQ(result.contradiction, 0.);
  }
}

TEST(SelectConsistentBetweenTest, NoClosures) {
  EXPECT_TRUE(
      SelectConsistentBetween(ConsistencyOptions(), {}, {}, {}).empty());
}

}  // namespace
}  // namespace cartographer_sdf::selection_between_test
