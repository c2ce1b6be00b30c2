// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/location.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf {
namespace {

using ::testing::ElementsAre;

TEST(LocationTest, AddsUpWhatAgrees) {
  const std::optional<Location> location =
      FindLocation(LocalizationOptions(), {{{1., 2., 0.5}, 3., true},
                                           {{1.2, 2.1, 0.45}, 5., true},
                                           {{9., 9., 0.5}, 6., true}});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->score, 8.);
  EXPECT_EQ(location->runner_up_score, 6.);
  EXPECT_THAT(location->supporters, ElementsAre(1u, 0u));
  EXPECT_EQ(location->T_map_query.translation().x(), 1.2);
}

TEST(LocationTest, RefusedMatchesRivalButDoNotSupport) {
  const LocalizationOptions options;
  EXPECT_FALSE(FindLocation(options, {{{1., 2., 0.}, 4., false}}));
  const std::optional<Location> location =
      FindLocation(options, {{{1., 2., 0.}, 4., true},
                             {{1., 2., 0.}, 2., false},
                             {{5., 5., 0.}, 3., false},
                             {{5., 5., 0.1}, 2., false}});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->score, 4.);
  EXPECT_EQ(location->runner_up_score, 5.);
}

TEST(LocationTest, LikelyMatchesSupportAnAcceptedOne) {
  const LocalizationOptions options;
  const PoseVote likely{{1., 2., 0.}, 2., false, true};
  EXPECT_FALSE(FindLocation(options, {likely, likely}));
  const std::optional<Location> location =
      FindLocation(options, {likely, {{1., 2.1, 0.}, 4., true}, likely});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->score, 8.);
  EXPECT_THAT(location->supporters, ElementsAre(1u, 0u, 2u));
  EXPECT_EQ(location->T_map_query.translation().y(), 2.1);
}

TEST(LocationTest, TurnedPosesAreDistinct) {
  const std::optional<Location> location =
      FindLocation(LocalizationOptions(),
                   {{{1., 2., 0.}, 4., true}, {{1., 2., 3.}, 3., true}});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->score, 4.);
  EXPECT_EQ(location->runner_up_score, 3.);
}

TEST(LocationTest, PosesBetweenAreNeitherSameNorDistinct) {
  const std::optional<Location> location =
      FindLocation(LocalizationOptions(),
                   {{{1., 2., 0.}, 4., true}, {{1.7, 2., 0.}, 3., true}});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->score, 4.);
  EXPECT_EQ(location->runner_up_score, 0.);
}

TEST(LocationTest, AnglesWrap) {
  const std::optional<Location> location =
      FindLocation(LocalizationOptions(),
                   {{{1., 2., 3.12}, 4., true}, {{1., 2., -3.12}, 3., true}});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->score, 7.);
}

TEST(LocationTest, NothingFromNothing) {
  EXPECT_FALSE(FindLocation(LocalizationOptions(), {}));
}

}  // namespace
}  // namespace cartographer_sdf
