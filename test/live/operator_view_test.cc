// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/operator_view.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::operator_view_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

const SegmentGroup& GroupNamed(const std::vector<SegmentGroup>& groups,
                               const std::string& name) {
  const auto found =
      std::find_if(groups.begin(), groups.end(),
                   [&name](const SegmentGroup& g) { return g.name == name; });
  CHECK(found != groups.end()) << name;
  return *found;
}

ClosureRecord MakeClosure(const int reference, const int query,
                          const ClosureStatus status) {
  ClosureRecord closure;
  closure.pair.reference = {0, reference};
  closure.pair.query = {0, query};
  closure.pair.T_reference_query = Rigid2(1., 2., 0.);
  closure.status = status;
  return closure;
}

TEST(OperatorViewTest, DrawsEachClosureInTheGroupOfItsStatus) {
  const std::map<SubmapId, Rigid2> T_map_submap = {
      {{0, 1}, Rigid2(10., 0., M_PI / 2.)}, {{0, 2}, Rigid2(0., 20., 0.)}};
  RefusedMatch refused;
  refused.pair.reference = {0, 2};
  refused.pair.query = {0, 1};
  const std::vector<SegmentGroup> groups =
      DrawMatches({MakeClosure(1, 2, ClosureStatus::kInGraph),
                   MakeClosure(1, -1, ClosureStatus::kReady),
                   MakeClosure(7, 2, ClosureStatus::kInconsistent)},
                  {refused}, T_map_submap);
  const auto& in_graph = GroupNamed(groups, "in_graph").segments;
  ASSERT_THAT(in_graph, SizeIs(1));
  EXPECT_EQ(in_graph[0].begin, Eigen::Vector2d(10., 0.));
  EXPECT_EQ(in_graph[0].end, Eigen::Vector2d(0., 20.));
  // A growing submap has no pose in the graph.
  const auto& ready = GroupNamed(groups, "ready").segments;
  ASSERT_THAT(ready, SizeIs(1));
  EXPECT_NEAR((ready[0].end - Eigen::Vector2d(8., 1.)).norm(), 0., 1e-12);
  EXPECT_THAT(GroupNamed(groups, "inconsistent").segments, IsEmpty());
  const SegmentGroup& thin = GroupNamed(groups, "refused");
  EXPECT_THAT(thin.segments, SizeIs(1));
  EXPECT_LT(thin.width, GroupNamed(groups, "in_graph").width / 3.);
}

TEST(OperatorViewTest, ShowsEveryStatusInItsColour) {
  const std::vector<SegmentGroup> groups = DrawMatches({}, {}, {});
  std::set<std::string> names;
  std::set<std::vector<float>> colors;
  for (const SegmentGroup& group : groups) {
    names.insert(group.name);
    colors.insert({group.color.red, group.color.green, group.color.blue});
    EXPECT_GT(group.color.alpha, 0.f);
  }
  EXPECT_EQ(names.size(), groups.size());
  EXPECT_EQ(colors.size(), groups.size());
  // All that the searcher gives a closure.
  for (const ClosureStatus status :
       {ClosureStatus::kInGraph, ClosureStatus::kReady,
        ClosureStatus::kDetectedOnly, ClosureStatus::kUnsupported,
        ClosureStatus::kInconsistent, ClosureStatus::kScansDisagree,
        ClosureStatus::kGone}) {
    EXPECT_THAT(names, Contains(ClosureStatusName(status)));
  }
}

TEST(OperatorViewTest, ProbabilityOfThisTheOtherOrNeither) {
  LocalizationResult result;
  EXPECT_EQ(ProbabilitiesOf(result).best, 0.);
  result.T_map_tracking = Rigid2();
  result.score = std::log(9.);
  EXPECT_NEAR(ProbabilitiesOf(result).best, 0.9, 1e-12);
  EXPECT_EQ(ProbabilitiesOf(result).runner_up, 0.);
  result.T_map_runner_up = Rigid2(5., 0., 0.);
  result.score = std::log(6.);
  result.runner_up_score = std::log(3.);
  EXPECT_NEAR(ProbabilitiesOf(result).best, 0.6, 1e-12);
  EXPECT_NEAR(ProbabilitiesOf(result).runner_up, 0.3, 1e-12);
}

TEST(OperatorViewTest, TellsStatesApart) {
  EXPECT_EQ(StateOf(std::nullopt), SearchState::kMapping);
  LocalizationResult result;
  result.verdict = LocalizationVerdict::kNoMap;
  EXPECT_EQ(StateOf(result), SearchState::kMapping);
  result.verdict = LocalizationVerdict::kUncertain;
  EXPECT_EQ(StateOf(result), SearchState::kSearching);
  result.was_localized = true;
  EXPECT_EQ(StateOf(result), SearchState::kLost);
  result.localized = true;
  EXPECT_EQ(StateOf(result), SearchState::kLocated);
}

TEST(OperatorViewTest, DescribesTheStatus) {
  LiveSummary summary;
  summary.num_places = 7;
  summary.num_waiting_tasks = 3;
  LocalizationResult result;
  result.was_localized = true;
  result.verdict = LocalizationVerdict::kAmbiguous;
  result.distance_driven = 4.;
  const NodeStatus lost = DescribeStatus(summary, result, 0.25);
  EXPECT_FALSE(lost.is_fine);
  EXPECT_THAT(lost.message, AllOf(HasSubstr("lost"), HasSubstr("4.0 m"),
                                  HasSubstr("ambiguous")));
  EXPECT_THAT(lost.values,
              AllOf(Contains(Pair("state", "lost")),
                    Contains(Pair("places", "7")), Contains(Pair("queue", "3")),
                    Contains(Pair("CPU share", "0.250"))));
  result.localized = true;
  result.score = 10.;
  result.T_map_tracking = Rigid2();
  result.covariance = Eigen::Vector3d(0.25, 0.01, 1e-4).asDiagonal();
  const NodeStatus located = DescribeStatus(summary, result, 0.);
  EXPECT_TRUE(located.is_fine);
  EXPECT_THAT(located.message, HasSubstr("probability 1.0000"));
  EXPECT_THAT(located.values,
              AllOf(Contains(Pair("deviation x, y [m]", "0.50, 0.10")),
                    Contains(Pair("deviation yaw [rad]", "0.010"))));
  EXPECT_TRUE(DescribeStatus(summary, std::nullopt, 0.).is_fine);
}

}  // namespace
}  // namespace cartographer_sdf::operator_view_test
