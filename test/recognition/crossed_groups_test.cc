// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/crossed_groups.h"

#include <map>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gtest/gtest.h"
#include "test/testing/divided_hall.h"

namespace cartographer_sdf::crossed_groups_test {
namespace {

using testing::DividedHall;

Verdict VerdictOf(const DividedHall& halls, const Match& match,
                  const VerificationOptions& options = {}) {
  std::vector<Match> matches = {match};
  RefuseCrossedGroups(options, NeighbourhoodOptions(), MatchSupportOptions(),
                      halls.Maps(), MakeExecutor(1), &matches);
  return matches[0].verdict;
}

// Of the submap that was made before the hall was divided.
Match MatchOfBefore() {
  Match match = DividedHall::MakeMatch(9.);
  match.pair.query = DividedHall::kBefore;
  return match;
}

TEST(RefuseCrossedGroupsTest, ALongWallRefutesTheMatch) {
  EXPECT_EQ(VerdictOf(DividedHall(6.), DividedHall::MakeMatch(9.)),
            Verdict::kContradicted);
}

TEST(RefuseCrossedGroupsTest, AShortOneMayBeFurniture) {
  EXPECT_EQ(VerdictOf(DividedHall(2.), DividedHall::MakeMatch(9.)),
            Verdict::kAccepted);
}

TEST(RefuseCrossedGroupsTest, AsDoesOneInAPairAroundIt) {
  EXPECT_EQ(VerdictOf(DividedHall(6.), MatchOfBefore()),
            Verdict::kContradicted);
  EXPECT_EQ(VerdictOf(DividedHall(2.), MatchOfBefore()), Verdict::kAccepted);
}

TEST(RefuseCrossedGroupsTest, AFewOfManyDoNot) {
  VerificationOptions options;
  // One of two is crossed.
  options.crossing.max_crossed_fraction = 0.5;
  EXPECT_EQ(VerdictOf(DividedHall(6.), MatchOfBefore(), options),
            Verdict::kAccepted);
  options.crossing.max_crossed_fraction = 0.49;
  EXPECT_EQ(VerdictOf(DividedHall(6.), MatchOfBefore(), options),
            Verdict::kContradicted);
}

TEST(RefuseCrossedGroupsTest, InOneMapTrajectoriesAreCompared) {
  const DividedHall halls(6.);
  std::map<SubmapId, Place> places = halls.hall.places;
  std::map<SubmapId, OdometryPose> odometry = halls.hall.odometry;
  places.insert(halls.divided.places.begin(), halls.divided.places.end());
  odometry.insert(halls.divided.odometry.begin(), halls.divided.odometry.end());
  // Places in the divided hall as seen by the first trajectory.
  const SubmapId again{0, 10};
  places.insert({again, places.at(DividedHall::kDivided)});
  odometry.insert({again, odometry.at(DividedHall::kDivided)});
  const TrajectoryPlaces map{&places, &odometry};
  std::vector<Match> matches(2, DividedHall::MakeMatch(9.));
  matches[1].pair.query = again;
  RefuseCrossedGroups(VerificationOptions(), NeighbourhoodOptions(),
                      MatchSupportOptions(), {map, map, 3}, MakeExecutor(1),
                      &matches);
  EXPECT_EQ(matches[0].verdict, Verdict::kContradicted);
  EXPECT_EQ(matches[1].verdict, Verdict::kAccepted);
}

TEST(RefuseCrossedGroupsTest, WhatWasNotAcceptedKeepsItsReason) {
  Match match = DividedHall::MakeMatch(2.);
  match.verdict = Verdict::kUnlikely;
  EXPECT_EQ(VerdictOf(DividedHall(6.), match), Verdict::kUnlikely);
}

}  // namespace
}  // namespace cartographer_sdf::crossed_groups_test
