// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/trajectory_links.h"

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::trajectory_links_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::SlippedVisit;
using testing::TwoVisits;

TrajectoryLinks LinksOf(const SlippedVisit& visit,
                        const TrajectoryLinkOptions& options = {}) {
  return {options, VerificationOptions(), visit.Places(), MakeExecutor(1)};
}

TEST(TrajectoryLinksTest, WallsThatAgreeHold) {
  const TwoVisits visits;
  // Registration makes up for what local SLAM drifts between two submaps.
  EXPECT_THAT(LinksOf(SlippedVisit(visits, Rigid2())).broken(), IsEmpty());
  EXPECT_THAT(LinksOf(SlippedVisit(visits, Rigid2(0.15, -0.1, 0.03))).broken(),
              IsEmpty());
  // Rooms side by side have too little in common to tell.
  EXPECT_THAT(TrajectoryLinks({}, VerificationOptions(), visits.Places(),
                              MakeExecutor(1))
                  .broken(),
              IsEmpty());
}

TEST(TrajectoryLinksTest, WallsInFreeSpaceBreakALink) {
  const TwoVisits visits;
  EXPECT_THAT(LinksOf(SlippedVisit(visits)).broken(),
              ElementsAre(TwoVisits::kWestAgain));
}

TEST(TrajectoryLinksTest, OnlyLinksBetweenTheTwoCount) {
  const TwoVisits visits;
  // From {0, 10} to {0, 12}.
  const TrajectoryLinks links = LinksOf(SlippedVisit(visits));
  EXPECT_TRUE(links.IsBrokenBetween({0, 10}, {0, 12}));
  EXPECT_TRUE(links.IsBrokenBetween({0, 12}, {0, 10}));
  EXPECT_TRUE(links.IsBrokenBetween({0, 3}, {0, 40}));
  // The one submap between them may lie on either side of the slip.
  EXPECT_FALSE(links.IsBrokenBetween({0, 10}, {0, 11}));
  EXPECT_FALSE(links.IsBrokenBetween({0, 11}, {0, 12}));
  EXPECT_FALSE(links.IsBrokenBetween({0, 0}, {0, 11}));
  EXPECT_FALSE(links.IsBrokenBetween({0, 12}, {0, 40}));
  EXPECT_FALSE(links.IsBrokenBetween({0, 10}, {0, 10}));
  EXPECT_FALSE(links.IsBrokenBetween({1, 3}, {1, 40}));
  EXPECT_FALSE(links.IsBrokenBetween({0, 3}, {1, 40}));
}

TEST(TrajectoryLinksTest, OptionsDecideWhatIsBroken) {
  const TwoVisits visits;
  TrajectoryLinkOptions options;
  options.max_contradiction_ratio = 0.9;
  EXPECT_THAT(LinksOf(SlippedVisit(visits), options).broken(), IsEmpty());
  options = {};
  options.min_overlap_area = 1e3;
  EXPECT_THAT(LinksOf(SlippedVisit(visits), options).broken(), IsEmpty());
  options = {};
  options.index_step = 3;
  EXPECT_THAT(LinksOf(SlippedVisit(visits), options).broken(), IsEmpty());
}

TEST(TrajectoryLinkOptionsTest, SaysWhatIsWrong) {
  TrajectoryLinkOptions options;
  EXPECT_EQ(Validate(options), "");
  options.index_step = 0;
  EXPECT_THAT(Validate(options), HasSubstr("index_step"));
  options = {};
  options.max_contradiction_ratio = -0.1;
  EXPECT_THAT(Validate(options), HasSubstr("max_contradiction_ratio"));
}

}  // namespace
}  // namespace cartographer_sdf::trajectory_links_test
