// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/learning_tables.h"

#include <string>

#include "cartographer_sdf/file/text_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::learning_tables_test {
namespace {

using ::testing::HasSubstr;

Match VerifiedMatch() {
  Match match;
  match.pair.reference = {0, 3};
  match.pair.query = {1, 2};
  match.pair.score = 4.5;
  match.pair_score = 4.5;
  match.margin = 0.125;
  match.evidence.query_in_reference = {100., 90., 2., 0.};
  match.evidence.reference_in_query = {50., 40., 2., 0.};
  match.evidence.overlap_area = 49.;
  match.evidence.overlap = 0.7;
  match.evidence.tiles = {16., 0.95};
  match.evidence.normal_scatter = Eigen::Vector2d(0.16, 0.84).asDiagonal();
  return match;
}

TEST(WriteScoreTermsTest, WritesWhatTheScoreIsMadeOf) {
  const testing::TemporaryDirectory directory;
  const Match match = VerifiedMatch();
  const std::string path = directory.File("terms.csv");
  ASSERT_TRUE(WriteScoreTerms(path, {match}).ok());
  std::vector<CsvColumn> columns = {{"reference_trajectory", CsvType::kInteger},
                                    {"reference_index", CsvType::kInteger},
                                    {"query_trajectory", CsvType::kInteger},
                                    {"query_index", CsvType::kInteger},
                                    {"score", CsvType::kNumber}};
  for (const char* const name : ScoreTermNames()) {
    columns.push_back({name, CsvType::kNumber});
  }
  const absl::StatusOr<std::vector<CsvRow>> rows = ReadCsv(path, columns);
  ASSERT_TRUE(rows.ok()) << rows.status();
  ASSERT_EQ(rows->size(), 1u);
  const CsvRow& row = rows->front();
  EXPECT_EQ(row.Integer(0), 0);
  EXPECT_EQ(row.Integer(1), 3);
  EXPECT_EQ(row.Integer(2), 1);
  EXPECT_EQ(row.Integer(3), 2);
  EXPECT_EQ(row.Number(4), 4.5);
  const auto terms = ScoreTerms(match.evidence, match.margin);
  for (int k = 0; k != kNumScoreTerms; ++k) {
    // Nine digits; terms are below 10.
    EXPECT_NEAR(row.Number(5 + k), terms[k], 1e-8) << columns[5 + k].name;
    EXPECT_NE(terms[k], 0.) << "tells nothing";
  }
}

TEST(WriteNeighbourhoodTermsTest, LeavesOutWhatWasNotMeasured) {
  const testing::TemporaryDirectory directory;
  const Match alone = VerifiedMatch();
  Match hopeless = VerifiedMatch();
  hopeless.neighbourhood = NeighbourhoodEvidence{};
  hopeless.pair_score = -6.;
  Match asked = VerifiedMatch();
  asked.neighbourhood = NeighbourhoodEvidence{};
  asked.pair.score = 2.5;
  ASSERT_TRUE(WriteNeighbourhoodTerms(directory.File("terms.csv"),
                                      NeighbourhoodOptions(),
                                      {alone, hopeless, asked})
                  .ok());
  EXPECT_EQ(directory.Read("terms.csv"),
            "reference_trajectory,reference_index,query_trajectory,"
            "query_index,score,pair_score,log_contradiction,"
            "log_confirmation\n"
            "0,3,1,2,2.5,4.5,0,0\n");
}

TEST(WriteAnswerLabelsTest, WritesOneRowPerAnswer) {
  const testing::TemporaryDirectory directory;
  AnswerLabel right;
  right.reference = {0, 1};
  right.query = {2, 3};
  right.overlap = 0.75;
  right.to_positive = true;
  right.verdict = AnswerVerdict::kRight;
  right.translation_error = 0.25;
  right.rotation_error = 0.125;
  AnswerLabel wrong = right;
  wrong.query = {2, 4};
  wrong.overlap = 0.;
  wrong.to_positive = false;
  wrong.verdict = AnswerVerdict::kWrong;
  ASSERT_TRUE(
      WriteAnswerLabels(directory.File("labels.csv"), {right, wrong}).ok());
  EXPECT_EQ(directory.Read("labels.csv"),
            "reference_trajectory,reference_index,query_trajectory,"
            "query_index,overlap,positive,verdict,translation_error,"
            "rotation_error\n"
            "0,1,2,3,0.750000,1,right,0.250000,0.125000\n"
            "0,1,2,4,0.000000,0,wrong,0.250000,0.125000\n");
}

TEST(LearningTablesTest, NamePathsThatCannotBeWritten) {
  EXPECT_THAT(std::string(WriteScoreTerms("/nowhere/t.csv", {}).message()),
              HasSubstr("/nowhere/t.csv"));
  EXPECT_THAT(std::string(WriteAnswerLabels("/nowhere/l.csv", {}).message()),
              HasSubstr("/nowhere/l.csv"));
}

}  // namespace
}  // namespace cartographer_sdf::learning_tables_test
