// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/match_table.h"

#include <fstream>
#include <iterator>

#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/file/whole_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::match_table_test {
namespace {

using ::testing::HasSubstr;

// What outside scripts rely on.
constexpr char kHeader[] =
    "reference_trajectory,reference_index,query_trajectory,query_index,"
    "accepted,score,x,y,yaw,verdict,inliers,overlap,hit_ratio,"
    "contradiction_ratio\n";

MatchRow SomeMatch() {
  MatchRow match;
  match.reference = {0, 3};
  match.query = {1, 14};
  match.accepted = true;
  match.score = -1.5;
  match.T_reference_query = Rigid2(1., -2.25, 3.);
  match.verdict = "accepted";
  match.inliers = 17;
  match.overlap = 0.75;
  match.hit_ratio = 0.5;
  match.contradiction_ratio = 0.0125;
  return match;
}

TEST(MatchTableTest, WritesTheColumnsThatWereAgreed) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("matches.csv");
  ASSERT_TRUE(WriteMatches(path, {SomeMatch()}).ok());
  std::ifstream file(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}),
            std::string(kHeader) +
                "0,3,1,14,1,-1.500000,1.000000,-2.250000,3.000000,accepted,17,"
                "0.750000,0.500000,0.012500\n");
}

TEST(MatchTableTest, ComesBackAsItWasWritten) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("matches.csv");
  MatchRow second = SomeMatch();
  second.reference = {0, 1};
  second.accepted = false;
  second.verdict = "";
  ASSERT_TRUE(WriteMatches(path, {SomeMatch(), second}).ok());
  const absl::StatusOr<std::vector<MatchRow>> matches = ReadMatches(path);
  ASSERT_TRUE(matches.ok()) << matches.status();
  ASSERT_EQ(matches->size(), 2u);
  const MatchRow& match = matches->front();
  EXPECT_EQ(match.reference, (SubmapId{0, 3}));
  EXPECT_EQ(match.query, (SubmapId{1, 14}));
  EXPECT_TRUE(match.accepted);
  EXPECT_EQ(match.score, -1.5);
  EXPECT_EQ(match.T_reference_query.translation(), Eigen::Vector2d(1., -2.25));
  EXPECT_EQ(match.T_reference_query.rotation(), 3.);
  EXPECT_EQ(match.verdict, "accepted");
  EXPECT_EQ(match.inliers, 17);
  EXPECT_EQ(match.overlap, 0.75);
  EXPECT_EQ(match.hit_ratio, 0.5);
  EXPECT_EQ(match.contradiction_ratio, 0.0125);
  EXPECT_EQ(matches->back().reference, (SubmapId{0, 1}));
  EXPECT_FALSE(matches->back().accepted);
  EXPECT_EQ(matches->back().verdict, "");
}

TEST(MatchTableTest, AnEmptyTableIsItsHeader) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("matches.csv");
  ASSERT_TRUE(WriteMatches(path, {}).ok());
  const absl::StatusOr<std::vector<MatchRow>> matches = ReadMatches(path);
  ASSERT_TRUE(matches.ok()) << matches.status();
  EXPECT_TRUE(matches->empty());
}

TEST(MatchTableTest, RefusesWhatMakesNoSense) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("matches.csv");
  ASSERT_TRUE(WriteWholeFile(
                  path, std::string(kHeader) + "0,3,1,14,2,1,1,1,3,a,1,1,1,1")
                  .ok());
  EXPECT_THAT(std::string(ReadMatches(path).status().message()),
              HasSubstr(":2: \"accepted\" is neither 0 nor 1"));
  ASSERT_TRUE(WriteWholeFile(path, "reference_trajectory\n0\n").ok());
  EXPECT_THAT(std::string(ReadMatches(path).status().message()),
              HasSubstr("0 columns named \"reference_index\""));
}

TEST(MatchTableDeathTest, AVerdictIsOneField) {
  MatchRow match = SomeMatch();
  match.verdict = "no, never";
  EXPECT_DEATH(static_cast<void>(WriteMatches("/dev/null", {match})),
               "no, never");
}

}  // namespace
}  // namespace cartographer_sdf::match_table_test
