// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/redundancy.h"

#include <algorithm>
#include <map>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::redundancy_test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

PairPose Pair(const SubmapId& reference, const SubmapId& query,
              const double score) {
  return {reference, query, Rigid2(), score};
}

// All pairs of submaps of sessions that saw one room; better within a session.
std::vector<PairPose> OneRoom(const int num_sessions, const int num_submaps) {
  std::vector<PairPose> pairs;
  std::vector<SubmapId> ids;
  for (int session = 0; session < num_sessions; ++session) {
    for (int i = 0; i < num_submaps; ++i) ids.push_back({session, i});
  }
  for (size_t a = 0; a < ids.size(); ++a) {
    for (size_t b = a + 1; b < ids.size(); ++b) {
      const double within = ids[a].trajectory == ids[b].trajectory ? 5. : 0.;
      pairs.push_back(
          Pair(ids[a], ids[b],
               5. + within + static_cast<double>((7 * a + 11 * b) % 13)));
    }
  }
  return pairs;
}

int CountKept(const std::vector<bool>& keep) {
  return static_cast<int>(std::count(keep.begin(), keep.end(), true));
}

TEST(KeepTiesTest, GrowsLinearlyWithTheSessions) {
  const RedundancyOptions options;
  for (const int num_sessions : {1, 2, 4, 8}) {
    const std::vector<PairPose> pairs = OneRoom(num_sessions, 24);
    const int num_kept = CountKept(KeepTies(options, pairs));
    EXPECT_LE(num_kept, options.min_num_ties * (24 * num_sessions - 1));
    EXPECT_GE(num_kept, std::min<int>(static_cast<int>(pairs.size()),
                                      9 * (24 * num_sessions - 1)));
  }
}

TEST(KeepTiesTest, EnoughStayBetweenAnyTwoParts) {
  RedundancyOptions options;
  options.min_num_ties = 4;
  const std::vector<PairPose> pairs = OneRoom(3, 6);
  const std::vector<bool> keep = KeepTies(options, pairs);
  // All ways to divide 18 submaps in two.
  for (int part = 1; part < (1 << 17); ++part) {
    const auto is_in = [part](const SubmapId& id) {
      return (part >> (6 * id.trajectory + id.index)) & 1;
    };
    int num_pairs = 0, num_kept = 0;
    for (size_t k = 0; k < pairs.size(); ++k) {
      if (is_in(pairs[k].reference) == is_in(pairs[k].query)) continue;
      ++num_pairs;
      num_kept += keep[k];
    }
    ASSERT_GE(num_kept, std::min(num_pairs, 4)) << part;
  }
}

TEST(KeepTiesTest, FewAllStayAndTheBestOfMany) {
  RedundancyOptions options;
  options.min_num_ties = 2;
  const SubmapId a{0, 0}, b{0, 5}, c{1, 0};
  EXPECT_THAT(KeepTies(options, {Pair(a, b, 1.), Pair(b, c, -3.)}), Each(true));
  EXPECT_THAT(KeepTies(options, {Pair(a, b, 1.), Pair(b, a, 3.), Pair(a, c, 0.),
                                 Pair(a, b, 2.)}),
              ElementsAre(false, true, true, true));
  EXPECT_TRUE(KeepTies(options, {}).empty());
}

TEST(KeepTiesTest, DoesNotDependOnTheOrder) {
  RedundancyOptions options;
  options.min_num_ties = 3;
  std::vector<PairPose> pairs = OneRoom(2, 8);
  const std::vector<bool> expected = KeepTies(options, pairs);
  std::reverse(pairs.begin(), pairs.end());
  std::vector<bool> reversed = KeepTies(options, pairs);
  std::reverse(reversed.begin(), reversed.end());
  EXPECT_EQ(reversed, expected);
}

TEST(RedundancyOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(RedundancyOptions()), "");
  EXPECT_NE(Validate(RedundancyOptions{0}), "");
  EXPECT_NE(Validate(RedundancyOptions{1001}), "");
}

// Two submaps with four nodes each, the second 2 m ahead of the first.
class AreInGraphTest : public ::testing::Test {
 protected:
  AreInGraphTest() {
    for (int k = 0; k < 4; ++k) {
      for (const SubmapId& id : {kFirst, kSecond}) {
        nodes_[id][{0, 10 * id.index + k}] = Rigid2(0.5 * k, 0.1, 0.3);
      }
    }
  }

  // Of node k of the second submap in the first, wrong by `error`.
  void Constrain(const int k, const Rigid2& error,
                 const Constraint::Tag tag = Constraint::Tag::kInterSubmap) {
    const NodeId node{0, 10 + k};
    graph_.constraints.push_back(
        {kFirst, node, T_ * nodes_[kSecond][node] * error, 1., 1., tag});
  }
  [[nodiscard]] bool IsInGraph(const PairPose& pair) const {
    return AreInGraph({}, nodes_, graph_, {pair})[0];
  }

  const SubmapId kFirst{0, 0};
  const SubmapId kSecond{0, 1};
  const Rigid2 T_{2., 0., 0.2};
  std::map<SubmapId, InsertedNodes> nodes_;
  PoseGraph graph_;
};

TEST_F(AreInGraphTest, ThreeThatAgreeSufficeInEitherDirection) {
  const PairPose pair{kFirst, kSecond, T_, 5.};
  const PairPose inverse{kSecond, kFirst, T_.Inverse(), 5.};
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(IsInGraph(pair));
    EXPECT_FALSE(IsInGraph(inverse));
    // Within three sigmas of constraint generation.
    Constrain(k, Rigid2(0.2, -0.2, 0.05));
  }
  EXPECT_TRUE(IsInGraph(pair));
  EXPECT_TRUE(IsInGraph(inverse));
  EXPECT_FALSE(IsInGraph({kFirst, {0, 2}, T_, 5.}));
}

TEST_F(AreInGraphTest, ConstraintsThatDisagreeDoNotCount) {
  const PairPose pair{kFirst, kSecond, T_, 5.};
  for (int k = 0; k < 4; ++k) Constrain(k, Rigid2(0.31, 0., 0.));
  for (int k = 0; k < 4; ++k) Constrain(k, Rigid2(0., 0., 0.07));
  EXPECT_FALSE(IsInGraph(pair));
}

TEST_F(AreInGraphTest, NorDoThoseOfInsertion) {
  for (int k = 0; k < 4; ++k) {
    Constrain(k, Rigid2(), Constraint::Tag::kIntraSubmap);
  }
  EXPECT_FALSE(IsInGraph({kFirst, kSecond, T_, 5.}));
}

}  // namespace
}  // namespace cartographer_sdf::redundancy_test
