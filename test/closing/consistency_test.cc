// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/consistency.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::consistency_test {
namespace {

constexpr int kLap = 10;  // submaps

// A robot drives the same straight way in laps, jumping back at the end: submap
// i is `spacing` * (i % kLap) along the way.
std::map<SubmapId, OdometryPose> Laps(const double spacing,
                                      const int trajectory = 0) {
  std::map<SubmapId, OdometryPose> odometry;
  for (int i = 0; i < 3 * kLap; ++i) {
    odometry[{trajectory, i}] = {Rigid2(spacing * (i % kLap), 0., 0.),
                                 spacing * i};
  }
  return odometry;
}

// Between the laps; true but for `error`.
PairPose Closure(const int reference, const int query,
                 const Rigid2& error = Rigid2(), const double score = 5.) {
  PairPose closure;
  closure.reference = {0, reference};
  closure.query = {0, query};
  closure.T_reference_query = error;
  closure.score = score;
  return closure;
}

PairPose Inverse(PairPose closure) {
  std::swap(closure.reference, closure.query);
  closure.T_reference_query = closure.T_reference_query.Inverse();
  return closure;
}

CycleVerdict Check(const double spacing, const PairPose& a, const PairPose& b) {
  return CheckCycle(ConsistencyOptions(), Laps(spacing), a, b);
}

// The cycle 0 -> 10 -> 11 -> 1 -> 0 with d metres of odometry twice. Along the
// way no rotation has a lever, so the variance of the closing error is twice
//   0.15^2                           a closure
//   + (0.01 d)^2                     slip
//   + (0.01 sqrt(d) * d)^2 / 3       swing
// d = 10: 0.0225 + 0.01 + 0.0333, together 0.13167, 4.03 sigmas are 1.462 m.
TEST(CheckCycleTest, AllowsWhatOdometryGathersOnTheWay) {
  const PairPose a = Closure(0, 10);
  EXPECT_EQ(Check(10., a, Closure(1, 11)), CycleVerdict::kConsistent);
  for (const double sign : {-1., 1.}) {
    EXPECT_EQ(Check(10., a, Closure(1, 11, Rigid2(sign * 1.44, 0., 0.))),
              CycleVerdict::kConsistent);
    EXPECT_EQ(Check(10., a, Closure(1, 11, Rigid2(sign * 1.48, 0., 0.))),
              CycleVerdict::kInconsistent);
  }
}

// d = 15: 0.0225 + 0.0225 + 0.1125, together 0.315, 4.03 sigmas are 2.262 m.
TEST(CheckCycleTest, AllowsMoreTheFartherOneDrives) {
  const PairPose a = Closure(0, 10);
  EXPECT_EQ(Check(15., a, Closure(1, 11, Rigid2(2.24, 0., 0.))),
            CycleVerdict::kConsistent);
  EXPECT_EQ(Check(15., a, Closure(1, 11, Rigid2(2.28, 0., 0.))),
            CycleVerdict::kInconsistent);
}

// Rotation alone, at one place (d = 0): two closures of 0.02 rad each,
// 4.03 * sqrt(2) * 0.02 = 0.114 rad.
TEST(CheckCycleTest, ComparesRotations) {
  const PairPose a = Closure(0, 10);
  EXPECT_EQ(Check(0., a, Closure(1, 11, Rigid2(0., 0., 0.11))),
            CycleVerdict::kConsistent);
  EXPECT_EQ(Check(0., a, Closure(1, 11, Rigid2(0., 0., -0.11))),
            CycleVerdict::kConsistent);
  EXPECT_EQ(Check(0., a, Closure(1, 11, Rigid2(0., 0., 0.118))),
            CycleVerdict::kInconsistent);
}

TEST(CheckCycleTest, ALongWayTellsNothing) {
  // 60 m swing by 0.01 * sqrt(60) * 60 / sqrt(3) = 2.7 m.
  EXPECT_EQ(Check(10., Closure(0, 10), Closure(6, 16, Rigid2(9., 9., 1.))),
            CycleVerdict::kUninformative);
}

TEST(CheckCycleTest, DirectionsDoNotMatter) {
  // Frames that lie far from each other, around the limit, where every
  // difference shows.
  const PairPose a = Closure(0, 12, Rigid2(20., 0.2, 0.01));
  int num_consistent = 0;
  constexpr int kNumErrors = 600;
  for (int k = 0; k < kNumErrors; ++k) {
    const PairPose b = Closure(2, 11, Rigid2(-10.3, 0.01 * k, 0.05));
    const CycleVerdict verdict = Check(10., a, b);
    num_consistent += verdict == CycleVerdict::kConsistent;
    EXPECT_EQ(Check(10., b, a), verdict) << k;
    EXPECT_EQ(Check(10., a, Inverse(b)), verdict) << k;
    EXPECT_EQ(Check(10., Inverse(a), b), verdict) << k;
    EXPECT_EQ(Check(10., Inverse(b), Inverse(a)), verdict) << k;
  }
  EXPECT_THAT(num_consistent,
              ::testing::AllOf(::testing::Gt(50), ::testing::Lt(550)));
}

TEST(CheckCycleTest, TakesTheMoreCertainOfTwoWays) {
  // Out on submaps 0 to 4, back on 5 to 9: the ends that are near by odometry
  // are 0 and 1, 9 and 8.
  std::map<SubmapId, OdometryPose> odometry;
  for (int i = 0; i < 10; ++i) {
    odometry[{0, i}] = {Rigid2(5. * (i < 5 ? i : 9 - i), 0., i < 5 ? 0. : M_PI),
                        5. * i};
  }
  const Rigid2 turn(0., 0., M_PI);
  const PairPose a = Closure(0, 9, turn);
  for (const PairPose& b :
       {Closure(1, 8, turn), Inverse(Closure(1, 8, turn))}) {
    EXPECT_EQ(CheckCycle(ConsistencyOptions(), odometry, a, b),
              CycleVerdict::kConsistent);
  }
  for (const PairPose& b : {Closure(1, 8, Rigid2(2., 0., M_PI)),
                            Inverse(Closure(1, 8, Rigid2(2., 0., M_PI)))}) {
    EXPECT_EQ(CheckCycle(ConsistencyOptions(), odometry, a, b),
              CycleVerdict::kInconsistent);
  }
}

TEST(CheckCycleTest, JoinsTwoTrajectories) {
  std::map<SubmapId, OdometryPose> odometry = Laps(10., 0);
  odometry.merge(Laps(10., 1));
  odometry.merge(Laps(10., 2));
  const auto closure = [](const SubmapId& reference, const SubmapId& query,
                          const double x) {
    PairPose closure = Closure(0, 0, Rigid2(x, 0., 0.));
    closure.reference = reference;
    closure.query = query;
    return closure;
  };
  const auto check = [&odometry](const PairPose& a, const PairPose& b) {
    return CheckCycle(ConsistencyOptions(), odometry, a, b);
  };
  // Their frames are 7 m apart.
  const PairPose a = closure({0, 3}, {1, 3}, 7.);
  EXPECT_EQ(check(a, closure({0, 4}, {1, 4}, 7.)), CycleVerdict::kConsistent);
  EXPECT_EQ(check(a, closure({1, 4}, {0, 4}, -7.)), CycleVerdict::kConsistent);
  EXPECT_EQ(check(a, closure({0, 4}, {1, 4}, 0.)), CycleVerdict::kInconsistent);
  EXPECT_EQ(check(a, closure({1, 4}, {0, 4}, 7.)), CycleVerdict::kInconsistent);
  // No odometry between their ends.
  EXPECT_EQ(check(a, closure({0, 4}, {2, 4}, 7.)),
            CycleVerdict::kUninformative);
  EXPECT_EQ(check(a, closure({1, 3}, {1, 14}, 0.)),
            CycleVerdict::kUninformative);
}

std::vector<SelectionResult> Select(const std::vector<PairPose>& closures) {
  return SelectConsistent(ConsistencyOptions(), Laps(5.), closures);
}

TEST(SelectConsistentTest, NothingOfNothing) {
  EXPECT_TRUE(Select({}).empty());
}

TEST(SelectConsistentTest, OneAloneNeedsAHighScore) {
  EXPECT_EQ(Select({Closure(0, 10, Rigid2(), 4.9)})[0].selection,
            Selection::kUnsupported);
  EXPECT_EQ(Select({Closure(0, 10, Rigid2(), 5.1)})[0].selection,
            Selection::kSelected);
}

TEST(SelectConsistentTest, ThreeThatAgreeSupportEachOther) {
  const std::vector<SelectionResult> results =
      Select({Closure(0, 10, Rigid2(), 4.), Closure(1, 11, Rigid2(), 4.5),
              Closure(2, 12, Rigid2(), 4.)});
  for (const SelectionResult& result : results) {
    EXPECT_EQ(result.selection, Selection::kSelected);
    EXPECT_EQ(result.contradiction, 0.);
  }
  EXPECT_EQ(results[0].support, 8.5);
  EXPECT_EQ(results[1].support, 8.);
  EXPECT_EQ(results[2].support, 8.5);
}

// Look-alikes come in pairs too, of neighbouring submaps that share scans.
TEST(SelectConsistentTest, TwoThatAgreeAreTooFew) {
  const std::vector<SelectionResult> results =
      Select({Closure(0, 10, Rigid2(), 3.5), Closure(1, 11, Rigid2(), 4.)});
  EXPECT_EQ(results[0].selection, Selection::kUnsupported);
  EXPECT_EQ(results[1].selection, Selection::kUnsupported);
  EXPECT_EQ(results[0].support, 4.);
  EXPECT_EQ(results[1].support, 3.5);
}

TEST(SelectConsistentTest, OneThatManyContradictIsOut) {
  const std::vector<SelectionResult> results =
      Select({Closure(0, 10), Closure(1, 11, Rigid2(5., 0., 0.), 9.),
              Closure(2, 12), Closure(3, 13)});
  EXPECT_EQ(results[0].selection, Selection::kSelected);
  EXPECT_EQ(results[1].selection, Selection::kInconsistent);
  EXPECT_EQ(results[2].selection, Selection::kSelected);
  EXPECT_EQ(results[3].selection, Selection::kSelected);
  EXPECT_EQ(results[1].support, 0.);
  EXPECT_EQ(results[1].contradiction, 15.);
  EXPECT_EQ(results[2].support, 10.);
}

// Look-alikes agree with each other, but they are fewer. Odd ones are false.
std::vector<PairPose> TwoClusters() {
  const Rigid2 false_pose(-6., 4., 0.3);
  return {Closure(0, 10), Closure(0, 11, false_pose, 6.),
          Closure(1, 11), Closure(1, 12, false_pose, 6.5),
          Closure(2, 12), Closure(3, 14, false_pose, 0.1)};
}

TEST(SelectConsistentTest, TheLesserOfTwoClustersIsOut) {
  const std::vector<PairPose> closures = TwoClusters();
  const std::vector<SelectionResult> results = Select(closures);
  for (size_t k = 0; k < closures.size(); ++k) {
    EXPECT_EQ(results[k].selection,
              k % 2 == 1 ? Selection::kInconsistent : Selection::kSelected)
        << k;
  }
}

TEST(SelectConsistentTest, FarOnesDoNotContradict) {
  // 45 m on, nothing can be said.
  const std::vector<SelectionResult> results = SelectConsistent(
      ConsistencyOptions(), Laps(10.),
      {Closure(0, 10), Closure(9, 19, Rigid2(5., 5., 0.), 5.5)});
  EXPECT_EQ(results[0].selection, Selection::kSelected);
  EXPECT_EQ(results[1].selection, Selection::kSelected);
}

TEST(SelectConsistentTest, DoesNotDependOnTheOrder) {
  std::vector<PairPose> closures = TwoClusters();
  // Scores whose sum depends on the order of the summands.
  const double scores[] = {5.1, 6.7, 5.3, 6.9, 5.7, 0.1};
  for (size_t k = 0; k < closures.size(); ++k) closures[k].score = scores[k];
  const std::vector<SelectionResult> expected = Select(closures);
  std::vector<size_t> order = {0, 1, 2, 3, 4, 5};
  do {
    std::vector<PairPose> permuted;
    for (const size_t k : order) permuted.push_back(closures[k]);
    const std::vector<SelectionResult> results = Select(permuted);
    for (size_t k = 0; k < order.size(); ++k) {
      ASSERT_EQ(results[k].selection, expected[order[k]].selection);
      ASSERT_EQ(results[k].support, expected[order[k]].support);
      ASSERT_EQ(results[k].contradiction, expected[order[k]].contradiction);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(ConsistencyOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(ConsistencyOptions()), "");
  const auto error = [](const std::function<void(ConsistencyOptions*)>& set) {
    ConsistencyOptions options;
    set(&options);
    return Validate(options);
  };
  EXPECT_NE(error([](auto* o) { o->rotation_sigma_per_sqrt_meter = -1.; }), "");
  EXPECT_NE(error([](auto* o) { o->closure_rotation_sigma = 0.; }), "");
  EXPECT_NE(error([](auto* o) { o->max_mahalanobis_distance = NAN; }), "");
  EXPECT_NE(error([](auto* o) { o->max_cycle_sigma_meters = 0.; }), "");
}

}  // namespace
}  // namespace cartographer_sdf::consistency_test
