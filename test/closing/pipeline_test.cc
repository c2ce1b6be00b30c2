// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/pipeline.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::pipeline_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two laps of ten submaps along a straight way, 5 m apart.
std::map<SubmapId, OdometryPose> Laps() {
  std::map<SubmapId, OdometryPose> odometry;
  for (int i = 0; i < 20; ++i) {
    odometry[{0, i}] = {Rigid2(5. * (i % 10), 0., 0.), 5. * i};
  }
  return odometry;
}

Closure BetweenLaps(const int index, const double error, const double score,
                    const ClosureStatus status = ClosureStatus::kSelected) {
  Closure closure;
  closure.match.pair = {
      {0, index}, {0, index + 10}, Rigid2(error, 0., 0.), score};
  closure.status = status;
  return closure;
}

std::vector<ClosureStatus> Statuses(const std::vector<Closure>& closures) {
  std::vector<ClosureStatus> statuses;
  for (const Closure& closure : closures) statuses.push_back(closure.status);
  return statuses;
}

TEST(SelectClosuresTest, EachStatusHasItsReason) {
  std::vector<Closure> closures = {
      BetweenLaps(0, 0., 5.), BetweenLaps(1, 0., 5.), BetweenLaps(2, 0., 5.),
      BetweenLaps(3, 8., 9.)};
  EXPECT_THAT(SelectClosures(ConsistencyOptions(), Laps(), {}, &closures),
              IsEmpty());
  EXPECT_THAT(
      Statuses(closures),
      ElementsAre(ClosureStatus::kSelected, ClosureStatus::kSelected,
                  ClosureStatus::kSelected, ClosureStatus::kInconsistent));
  closures = {BetweenLaps(0, 0., 4.)};
  EXPECT_THAT(SelectClosures(ConsistencyOptions(), Laps(), {}, &closures),
              IsEmpty());
  EXPECT_THAT(Statuses(closures), ElementsAre(ClosureStatus::kUnsupported));
}

TEST(SelectClosuresTest, TornSubmapsHaveNoWeight) {
  const std::map<SubmapId, Tear> torn = {{{0, 3}, Tear{}}};
  // Outweighs two others, if it counts.
  std::vector<Closure> closures = {
      BetweenLaps(0, 0., 5.), BetweenLaps(1, 0., 5.), BetweenLaps(3, 8., 20.)};
  std::vector<Closure> same = closures;
  (void)SelectClosures(ConsistencyOptions(), Laps(), {}, &same);
  EXPECT_EQ(same[2].status, ClosureStatus::kSelected);
  EXPECT_EQ(same[0].status, ClosureStatus::kInconsistent);
  (void)SelectClosures(ConsistencyOptions(), Laps(), torn, &closures);
  EXPECT_EQ(closures[2].status, ClosureStatus::kInconsistent);
  EXPECT_EQ(closures[0].status, ClosureStatus::kSelected);
}

TEST(SelectClosuresTest, WhatIsDecidedStaysAndIsReportedWhereContradicted) {
  std::vector<Closure> closures = {
      BetweenLaps(0, 0., 5.), BetweenLaps(1, 0., 5.), BetweenLaps(2, 0., 5.),
      BetweenLaps(3, 8., 9., ClosureStatus::kInGraph),
      BetweenLaps(4, 8., 99., ClosureStatus::kOutlier)};
  EXPECT_THAT(SelectClosures(ConsistencyOptions(), Laps(), {}, &closures),
              ElementsAre(3u));
  EXPECT_THAT(Statuses(closures),
              ElementsAre(ClosureStatus::kSelected, ClosureStatus::kSelected,
                          ClosureStatus::kSelected, ClosureStatus::kInGraph,
                          ClosureStatus::kOutlier));
}

// The first visit and the second one to the same rooms; the pose graph has no
// closure yet.
class CloseGraphTest : public ::testing::Test {
 protected:
  CloseGraphTest() {
    // Nothing but intra-submap constraints: the visits are apart.
    int node = 0;
    for (const auto& [id, pose] : *visits_.Places().odometry) {
      odometry_[id] = pose;
      graph_.submap_poses[id] = pose.T_local_submap;
      for (int k = 0; k < 4; ++k, ++node) {
        const Rigid2 T_submap_node(0.3 * k, 0.1, 0.2);
        Node& added = graph_.nodes[{id.index / 10, node}];
        added.T_map_node = pose.T_local_submap * T_submap_node;
        added.T_local_node = added.T_map_node;
        graph_.constraints.push_back({id,
                                      {id.index / 10, node},
                                      T_submap_node,
                                      1e5,
                                      1e5,
                                      Constraint::Tag::kIntraSubmap});
      }
    }
  }

  [[nodiscard]] Match TrueMatch(const double score) const {
    Match match;
    match.pair = {testing::TwoVisits::kWestFirst,
                  testing::TwoVisits::kWestAgain,
                  visits_.T_west_first_west_again(), score};
    match.verdict = Verdict::kAccepted;
    return match;
  }
  [[nodiscard]] ClosedGraph Close(std::vector<Match> matches) const {
    std::vector<std::pair<std::string, double>> seconds;
    StageClock clock({}, &seconds);
    return CloseGraph(options_,
                      {&graph_, &odometry_, visits_.Places().places, &clouds_},
                      std::move(matches), {}, MakeExecutor(1), &clock);
  }

  const testing::TwoVisits visits_;
  std::map<SubmapId, OdometryPose> odometry_;
  std::map<NodeId, PointCloud2> clouds_;
  PoseGraph graph_;
  ClosingOptions options_;
};

TEST_F(CloseGraphTest, AMatchBecomesConstraintsAndMovesTheMap) {
  const ClosedGraph closed = Close({TrueMatch(9.)});
  EXPECT_THAT(Statuses(closed.closures), ElementsAre(ClosureStatus::kInGraph));
  // All nodes of both submaps, there being fewer than num_nodes_per_submap.
  EXPECT_EQ(closed.closures[0].constraints.size(), 8u);
  EXPECT_EQ(closed.pose_graph.constraints.size(),
            graph_.constraints.size() + 8u);
  const auto& poses = closed.pose_graph.submap_poses;
  EXPECT_THAT(
      poses.at(testing::TwoVisits::kWestFirst).Inverse() *
          poses.at(testing::TwoVisits::kWestAgain),
      testing::IsPoseNear(visits_.T_west_first_west_again(), 1e-3, 1e-4));
  EXPECT_EQ(closed.optimizations.size(), 1u);
}

TEST_F(CloseGraphTest, TooFewConstraintsAreNoClosure) {
  options_.constraints.min_num_constraints = 9;
  const ClosedGraph closed = Close({TrueMatch(9.)});
  EXPECT_THAT(Statuses(closed.closures),
              ElementsAre(ClosureStatus::kScansDisagree));
  EXPECT_THAT(closed.closures[0].constraints, IsEmpty());
  EXPECT_EQ(closed.pose_graph.constraints.size(), graph_.constraints.size());
}

TEST_F(CloseGraphTest, WhatIsNotAcceptedIsNoClosure) {
  Match refused = TrueMatch(9.);
  refused.verdict = Verdict::kAmbiguous;
  const ClosedGraph closed = Close({refused, TrueMatch(3.)});
  EXPECT_THAT(Statuses(closed.closures),
              ElementsAre(ClosureStatus::kUnsupported));
  EXPECT_EQ(closed.pose_graph.constraints.size(), graph_.constraints.size());
}

}  // namespace
}  // namespace cartographer_sdf::pipeline_test
