// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/match_score.h"

#include <cmath>
#include <random>
#include <set>
#include <string>

#include "cartographer_sdf/pbstream/map_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::match_score_test {
namespace {

using ::cartographer_sdf::testing::NormalNumbers;
using ::testing::ElementsAre;

// Centres of the cells of a rectangle with a corner at the origin.
ObservedPoints Rectangle(const double width, const double height) {
  ObservedPoints points;
  for (double x = 0.05; x < width; x += 0.1) {
    for (double y = 0.05; y < height; y += 0.1) {
      points.emplace_back(x, y);
    }
  }
  return points;
}

// Submaps 0, 3, 6, 9, 12, each of 4 m x 2 m and further along x. All numbers
// are multiples of cells: 3 overlaps 0 by 3/4, 6 by 1/2, 9 not at all.
constexpr double kPositions[] = {0., 1., 2., 4., 50.};

Truth Row() {
  Truth truth;
  for (int k = 0; k != 5; ++k) {
    truth.T_world_submap[{0, 3 * k}] = Rigid2(kPositions[k], 10., 0.);
  }
  return truth;
}

std::map<SubmapId, ObservedPoints> RowOfRectangles() {
  std::map<SubmapId, ObservedPoints> submaps;
  for (int k = 0; k != 5; ++k) {
    submaps[{0, 3 * k}] = Rectangle(4., 2.);
  }
  return submaps;
}

MatchRow Answer(const int reference, const int query, const double score,
                const Rigid2& error = Rigid2()) {
  const Truth truth = Row();
  MatchRow match;
  match.reference = {0, reference};
  match.query = {0, query};
  match.score = score;
  match.T_reference_query = truth.T_world_submap.at(match.reference).Inverse() *
                            truth.T_world_submap.at(match.query) * error;
  return match;
}

// Of matches of one map.
MatchScore ScoreMatches(const PairTruths& pairs,
                        std::vector<MatchRow> matches) {
  OrderByIds(&matches);
  return ScoreAnswers(pairs, LabelAnswers(pairs, matches));
}

MatchScore Score(const std::vector<MatchRow>& matches) {
  return ScoreMatches(ComputePairTruths(RowOfRectangles(), Row()), matches);
}

const Rigid2 kNear(0.75, 0., 0.);
const Rigid2 kWrong(5., 0., 0.);

TEST(ComputePairTruthsTest, MeasuresTheCommonArea) {
  const PairTruths pairs = ComputePairTruths(RowOfRectangles(), Row());
  EXPECT_EQ(pairs.size(), 10u);
  const PairTruth& pair = pairs.at({{0, 0}, {0, 3}});
  EXPECT_NEAR(pair.overlap, 0.75, 1e-12);
  EXPECT_NEAR(pair.T_reference_query.translation().x(), 1., 1e-12);
  EXPECT_NEAR(pair.centre_query.x(), 2.5 - kPositions[1], 1e-12);
  EXPECT_NEAR(pair.centre_query.y(), 1., 1e-12);
  EXPECT_NEAR(pairs.at({{0, 0}, {0, 6}}).overlap, 0.5, 1e-12);
  // Nothing in common: the centre of the query.
  EXPECT_EQ(pairs.at({{0, 0}, {0, 9}}).overlap, 0.);
  EXPECT_NEAR(pairs.at({{0, 0}, {0, 9}}).centre_query.x(), 2., 1e-12);
}

TEST(ComputePairTruthsTest, IsAFractionOfTheSmallerArea) {
  std::map<SubmapId, ObservedPoints> submaps;
  submaps[{0, 0}] = Rectangle(10., 10.);
  submaps[{0, 3}] = Rectangle(2., 1.);
  Truth truth;
  truth.T_world_submap[{0, 0}] = Rigid2(-5., -5., 0.);
  // Turned by 90 degrees it lies from x = 4 to 5 and from y = 4 to 6.
  truth.T_world_submap[{0, 3}] = Rigid2(5., 4., M_PI_2);
  const PairTruths pairs = ComputePairTruths(submaps, truth);
  EXPECT_NEAR(pairs.at({{0, 0}, {0, 3}}).overlap, 0.5, 1e-12);
  // Of the two metres that it is long, the first lies in the other.
  EXPECT_NEAR(pairs.at({{0, 0}, {0, 3}}).centre_query.x(), 0.5, 1e-12);
}

TEST(ComputePairTruthsTest, AgreesWithSetsOfCellsOnRandomPoints) {
  NormalNumbers normal(42);
  for (int k = 0; k != 20; ++k) {
    std::map<SubmapId, ObservedPoints> submaps;
    Truth truth;
    std::set<std::pair<int, int>> cells[2];
    for (const int i : {0, 1}) {
      const SubmapId id{i, 0};
      truth.T_world_submap[id] = Rigid2(normal(1.), normal(1.), normal(2.));
      for (int n = 0; n != 300; ++n) {
        const double x = normal(2.);
        submaps[id].emplace_back(x, normal(2.));
        const Eigen::Vector2d p =
            truth.T_world_submap.at(id) * submaps[id].back();
        cells[i].emplace(static_cast<int>(std::floor(p.x() * 5.)),
                         static_cast<int>(std::floor(p.y() * 5.)));
      }
    }
    int num_common = 0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const auto& [x, y] : cells[0]) {
      if (cells[1].count({x, y}) != 0) {
        ++num_common;
        sum += Eigen::Vector2d(x + 0.5, y + 0.5) / 5.;
      }
    }
    const PairTruth pair =
        ComputePairTruths(submaps, truth).at({{0, 0}, {1, 0}});
    EXPECT_NEAR(pair.overlap,
                num_common / static_cast<double>(
                                 std::min(cells[0].size(), cells[1].size())),
                1e-12);
    EXPECT_LT(
        (truth.T_world_submap.at({1, 0}) * pair.centre_query - sum / num_common)
            .norm(),
        1e-9);
  }
}

TEST(ComputePairTruthsTest, LeavesOutWhatSharesScansOrHasNoTruth) {
  std::map<SubmapId, ObservedPoints> submaps;
  Truth truth;
  for (const SubmapId& id : {SubmapId{0, 0}, SubmapId{0, 2}, SubmapId{0, 3},
                             SubmapId{1, 0}, SubmapId{1, 1}}) {
    submaps[id] = Rectangle(1., 1.);
    truth.T_world_submap[id] = Rigid2();
  }
  truth.T_world_submap.erase({1, 1});
  std::vector<std::string> names;
  for (const auto& [pair, pair_truth] : ComputePairTruths(submaps, truth)) {
    names.push_back(std::to_string(pair.first.trajectory) +
                    std::to_string(pair.first.index) + "-" +
                    std::to_string(pair.second.trajectory) +
                    std::to_string(pair.second.index));
  }
  EXPECT_THAT(names, ElementsAre("00-03", "00-10", "02-10", "03-10"));
  // Of two maps, all pairs count, also of the same ids.
  EXPECT_EQ(ComputePairTruths(submaps, truth, submaps, truth).size(), 16u);
}

TEST(ThinnedObservedPointsTest, TakesEverySecondKnownCellFromTheLastOn) {
  CellGeometry geometry;
  geometry.size = Eigen::Array2i(4, 5);
  geometry.resolution = 0.5;
  OccupancyGrid grid = UnknownGrid(geometry);
  EXPECT_TRUE(ThinnedObservedPoints(grid).empty());
  grid.known.setConstant(true);
  grid.known(3, 4) = false;
  // i in {1, 3}, j in {0, 2, 4}.
  const ObservedPoints points = ThinnedObservedPoints(grid);
  ASSERT_EQ(points.size(), 5u);
  EXPECT_EQ(points.front(), Eigen::Vector2d(0.75, 0.25));
  EXPECT_EQ(points.back(), Eigen::Vector2d(0.75, 2.25));
}

TEST(LabelAnswersTest, SaysWhatTheTruthSays) {
  MatchRow reversed = Answer(0, 6, 1., Rigid2(0.1, 0., 0.05));
  std::swap(reversed.reference, reversed.query);
  reversed.T_reference_query = reversed.T_reference_query.Inverse();
  MatchRow unknown = Answer(0, 3, 5.);
  unknown.query = {7, 7};
  std::vector<MatchRow> matches = {Answer(3, 9, 2., kNear), reversed, unknown,
                                   Answer(0, 12, 9., kWrong), Answer(0, 6, 3.)};
  OrderByIds(&matches);
  const std::vector<AnswerLabel> labels =
      LabelAnswers(ComputePairTruths(RowOfRectangles(), Row()), matches);
  // In the order of the table, the repetition and the unknown pair left out.
  ASSERT_EQ(labels.size(), 3u);
  EXPECT_EQ(labels[0].reference, (SubmapId{0, 3}));
  EXPECT_EQ(labels[0].query, (SubmapId{0, 9}));
  EXPECT_NEAR(labels[0].overlap, 0.25, 1e-12);
  EXPECT_FALSE(labels[0].to_positive);
  EXPECT_EQ(labels[0].verdict, AnswerVerdict::kNear);
  EXPECT_NEAR(labels[0].translation_error, 0.75, 1e-12);
  EXPECT_NEAR(labels[0].rotation_error, 0., 1e-12);
  EXPECT_EQ(labels[1].reference, (SubmapId{0, 0}));
  EXPECT_EQ(labels[1].query, (SubmapId{0, 6}));
  EXPECT_TRUE(labels[1].to_positive);
  EXPECT_EQ(labels[1].verdict, AnswerVerdict::kRight);
  EXPECT_NEAR(labels[1].rotation_error, 0.05, 1e-12);
  EXPECT_EQ(labels[2].verdict, AnswerVerdict::kWrong);
  EXPECT_EQ(labels[2].overlap, 0.);
  EXPECT_EQ(labels[2].score, 9.);
}

TEST(AnswerVerdictTest, HasANameForEach) {
  EXPECT_STREQ(AnswerVerdictName(AnswerVerdict::kRight), "right");
  EXPECT_STREQ(AnswerVerdictName(AnswerVerdict::kNear), "near");
  EXPECT_STREQ(AnswerVerdictName(AnswerVerdict::kWrong), "wrong");
}

TEST(ScoreMatchesTest, PerfectAnswersScorePerfectly) {
  // Positive are 0-3, 0-6, 3-6, 6-9 (1/2); 3-9 overlaps by 1/4.
  const MatchScore score = Score(
      {Answer(0, 3, 5.), Answer(0, 6, 4.), Answer(3, 6, 3.), Answer(6, 9, 2.)});
  EXPECT_EQ(score.num_pairs, 10);
  EXPECT_EQ(score.num_positives, 4);
  EXPECT_EQ(score.num_answers, 4);
  EXPECT_EQ(score.num_wrong, 0);
  EXPECT_EQ(score.num_near, 0);
  EXPECT_EQ(score.recall_at_precision_1, 1.);
  EXPECT_EQ(score.recall_at_precision_99, 1.);
  EXPECT_EQ(score.average_precision, 1.);
  EXPECT_EQ(score.threshold, 2.);
  ASSERT_TRUE(score.median_translation_error.has_value());
  EXPECT_NEAR(*score.median_translation_error, 0., 1e-9);
}

TEST(ScoreMatchesTest, OneFalseAnswerAtTheTopLeavesNoRecall) {
  const MatchScore score =
      Score({Answer(0, 12, 9., kWrong), Answer(0, 3, 5.), Answer(0, 6, 4.),
             Answer(3, 6, 3.), Answer(6, 9, 2.)});
  EXPECT_EQ(score.recall_at_precision_1, 0.);
  EXPECT_EQ(score.recall_at_precision_99, 0.);
  EXPECT_EQ(score.num_wrong, 1);
  EXPECT_FALSE(score.threshold.has_value());
  EXPECT_NEAR(score.average_precision,
              (1. / 2. + 2. / 3. + 3. / 4. + 4. / 5.) / 4., 1e-12);
}

TEST(ScoreMatchesTest, AWrongPoseOfAPositivePairIsWrong) {
  const MatchScore score =
      Score({Answer(0, 3, 5.), Answer(0, 6, 4., kWrong), Answer(3, 6, 3.)});
  EXPECT_EQ(score.num_wrong, 1);
  EXPECT_EQ(score.recall_at_precision_1, 0.25);
  EXPECT_EQ(score.threshold, 5.);
  EXPECT_NEAR(score.average_precision, (1. + 2. / 3.) / 4., 1e-12);
}

TEST(ScoreMatchesTest, NearAnswersAndSmallOverlapsCountForNothing) {
  const MatchScore score =
      Score({Answer(0, 3, 5., kNear), Answer(3, 9, 4.), Answer(0, 6, 3.)});
  EXPECT_EQ(score.num_near, 1);
  EXPECT_EQ(score.num_wrong, 0);
  EXPECT_EQ(score.recall_at_precision_1, 0.25);
  EXPECT_EQ(score.average_precision, 0.25);
  EXPECT_EQ(score.threshold, 3.);
}

TEST(MarkPositivesTest, AsksForSmallerOverlapsToo) {
  PairTruths pairs = ComputePairTruths(RowOfRectangles(), Row());
  const std::vector<MatchRow> matches = {Answer(0, 3, 5.), Answer(0, 6, 3.)};
  // Overlaps are 0.75 twice, 0.5 twice, 0.25 once, and else 0.
  MarkPositives(0.6, &pairs);
  EXPECT_EQ(ScoreMatches(pairs, matches).num_positives, 2);
  EXPECT_EQ(ScoreMatches(pairs, matches).recall_at_precision_1, 1. / 2.);
  MarkPositives(0.2, &pairs);
  EXPECT_EQ(ScoreMatches(pairs, matches).num_positives, 5);
  EXPECT_EQ(ScoreMatches(pairs, matches).recall_at_precision_1, 2. / 5.);
}

TEST(ScoreMatchesTest, TiesAreTakenInTheOrderOfTheTable) {
  const MatchRow right = Answer(0, 3, 5.);
  const MatchRow wrong = Answer(0, 12, 5., kWrong);
  EXPECT_EQ(Score({right, wrong}).recall_at_precision_1, 0.25);
  EXPECT_EQ(Score({wrong, right}).recall_at_precision_1, 0.);
}

TEST(ScoreMatchesTest, RotationAloneMakesAnAnswerWrong) {
  const auto turned = [](const double degrees) {
    // About the centre of the overlap, which lies at (1.5, 1) of the query.
    const Rigid2 T(1.5, 1., 0.);
    return Score({Answer(
        0, 3, 5., T * Rigid2(0., 0., degrees * M_PI / 180.) * T.Inverse())});
  };
  EXPECT_EQ(turned(9.9).num_wrong, 0);
  EXPECT_EQ(turned(9.9).recall_at_precision_1, 0.25);
  EXPECT_NEAR(*turned(9.9).median_translation_error, 0., 1e-9);
  EXPECT_NEAR(*turned(9.9).median_rotation_error, 9.9 * M_PI / 180., 1e-9);
  EXPECT_EQ(turned(-10.1).num_wrong, 1);
}

TEST(ScoreMatchesTest, BoundsOfTheTranslation) {
  const auto shifted = [](const double x) {
    return Score({Answer(0, 3, 5., Rigid2(x, 0., 0.))});
  };
  EXPECT_EQ(shifted(0.49).recall_at_precision_1, 0.25);
  EXPECT_EQ(shifted(0.51).recall_at_precision_1, 0.);
  EXPECT_EQ(shifted(0.51).num_near, 1);
  EXPECT_EQ(shifted(0.99).num_near, 1);
  EXPECT_EQ(shifted(1.01).num_wrong, 1);
}

TEST(ScoreMatchesTest, InvertsReversedAnswersAndDropsRepetitions) {
  MatchRow reversed = Answer(0, 3, 5., Rigid2(0.1, 0.2, 0.1));
  const MatchScore straight_score = Score({reversed});
  std::swap(reversed.reference, reversed.query);
  reversed.T_reference_query = reversed.T_reference_query.Inverse();
  const MatchScore score = Score({reversed, Answer(0, 3, 9., kWrong)});
  EXPECT_EQ(score.num_answers, 1);
  EXPECT_EQ(score.num_wrong, 0);
  EXPECT_EQ(score.recall_at_precision_1, 0.25);
  EXPECT_NEAR(*score.median_translation_error,
              *straight_score.median_translation_error, 1e-12);
  EXPECT_GT(*score.median_translation_error, 0.1);
}

TEST(ScoreMatchesTest, AnswersWithoutATruthAreNotJudged) {
  MatchRow unknown = Answer(0, 3, 5.);
  unknown.query = {7, 7};
  MatchRow neighbours = Answer(0, 3, 5.);
  neighbours.query = {0, 1};
  EXPECT_EQ(Score({unknown, neighbours}).num_answers, 0);
}

TEST(ScoreMatchesTest, NoAnswers) {
  const MatchScore score = Score({});
  EXPECT_EQ(score.num_positives, 4);
  EXPECT_EQ(score.recall_at_precision_1, 0.);
  EXPECT_EQ(score.average_precision, 0.);
  EXPECT_FALSE(score.threshold.has_value());
  EXPECT_FALSE(score.median_translation_error.has_value());
  EXPECT_FALSE(score.median_rotation_error.has_value());
}

TEST(ScoreMatchesTest, NoPositives) {
  std::map<SubmapId, ObservedPoints> submaps = RowOfRectangles();
  for (const int index : {3, 6, 9}) {
    submaps.erase({0, index});
  }
  const MatchScore score =
      ScoreMatches(ComputePairTruths(submaps, Row()),
                   {Answer(0, 12, 1.), Answer(0, 12, 2., kWrong)});
  EXPECT_EQ(score.num_pairs, 1);
  EXPECT_EQ(score.num_positives, 0);
  EXPECT_EQ(score.num_answers, 1);
  EXPECT_EQ(score.recall_at_precision_1, 0.);
  EXPECT_EQ(score.average_precision, 0.);
  EXPECT_FALSE(std::isnan(score.average_precision));
}

// Numbers of pairs and positives that an independent tool finds.
struct PublishedPairs {
  int num_pairs;
  int num_positives;
};

class RealPairs {
 public:
  explicit RealPairs(const std::string& name) {
    const absl::StatusOr<MapState> state =
        ReadMap(SharedDataPath(name + ".pbstream"),
                {[this](const SubmapId& id, const SubmapSummary&,
                        const OccupancyGrid& grid) {
                  submaps[id] = ThinnedObservedPoints(grid);
                }});
    const absl::StatusOr<Truth> read = ReadTruth(
        SharedDataPath(name.substr(0, name.find("_open")) + ".truth.csv"));
    EXPECT_TRUE(state.ok()) << state.status();
    EXPECT_TRUE(read.ok()) << read.status();
    if (read.ok()) truth = *read;
  }

  std::map<SubmapId, ObservedPoints> submaps;
  Truth truth;
};

void ExpectPairs(const PairTruths& pairs, const PublishedPairs& expected) {
  const MatchScore score = ScoreAnswers(pairs, {});
  EXPECT_EQ(score.num_pairs, expected.num_pairs);
  EXPECT_EQ(score.num_positives, expected.num_positives);
}

TEST(RealPairsTest, CountsThePairsOfAces) {
  SKIP_WITHOUT_SHARED_DATA("aces_open_loop.pbstream");
  const RealPairs aces("aces_open_loop");
  ExpectPairs(ComputePairTruths(aces.submaps, aces.truth), {563, 65});
}

TEST(RealPairsTest, CountsThePairsOfTwoSessions) {
  SKIP_WITHOUT_SHARED_DATA("willow_1.pbstream");
  SKIP_WITHOUT_SHARED_DATA("willow_2.pbstream");
  const RealPairs first("willow_1");
  const RealPairs second("willow_2");
  ExpectPairs(ComputePairTruths(first.submaps, first.truth), {630, 153});
  ExpectPairs(ComputePairTruths(first.submaps, first.truth, second.submaps,
                                second.truth),
              {1406, 391});
}

}  // namespace
}  // namespace cartographer_sdf::match_score_test

namespace cartographer_sdf::place_recognition_test {
namespace {

class PlaceRecognitionTest : public ::testing::Test {
 protected:
  // The overlap of a pair, and how its answer is judged.
  void Add(const SubmapId& reference, const SubmapId& query,
           const double overlap, const AnswerVerdict verdict,
           const bool accepted) {
    PairTruth& truth = pairs_[{reference, query}];
    truth.overlap = overlap;
    truth.is_positive = overlap >= kPositiveOverlap;
    AnswerLabel label;
    label.reference = reference;
    label.query = query;
    label.verdict = verdict;
    labels_.push_back(label);
    MatchRow match;
    match.reference = reference;
    match.query = query;
    match.accepted = accepted;
    matches_.push_back(match);
  }
  PlaceRecognitionScore Score() const {
    return ScorePlaceRecognition(pairs_, labels_, matches_);
  }

  PairTruths pairs_;
  std::vector<AnswerLabel> labels_;
  std::vector<MatchRow> matches_;
};

TEST_F(PlaceRecognitionTest, CountsMatchesAndQueries) {
  Add({0, 0}, {0, 5}, 0.9, AnswerVerdict::kRight, true);
  Add({0, 1}, {0, 5}, 0.6, AnswerVerdict::kRight, true);
  Add({0, 0}, {0, 6}, 0.7, AnswerVerdict::kRight, false);
  Add({0, 0}, {0, 7}, 0., AnswerVerdict::kWrong, true);
  Add({0, 0}, {0, 8}, 0.4, AnswerVerdict::kNear, true);
  // A pair without an answer.
  pairs_[{{0, 0}, {0, 9}}].is_positive = true;
  const PlaceRecognitionScore score = Score();
  EXPECT_EQ(score.num_right, 2);
  EXPECT_EQ(score.num_near, 1);
  EXPECT_EQ(score.num_wrong, 1);
  EXPECT_EQ(score.num_unknown, 0);
  EXPECT_EQ(score.num_queries, 5);
  EXPECT_EQ(score.num_queries_with_positive, 3);
  EXPECT_EQ(score.num_queries_matched, 3);
  EXPECT_EQ(score.num_queries_right, 1);
}

TEST_F(PlaceRecognitionTest, CountsPairsWithoutTruth) {
  Add({0, 0}, {0, 5}, 0.9, AnswerVerdict::kRight, true);
  MatchRow stranger;
  stranger.reference = {3, 0};
  stranger.query = {3, 1};
  stranger.accepted = true;
  matches_.push_back(stranger);
  const PlaceRecognitionScore score = Score();
  EXPECT_EQ(score.num_right, 1);
  EXPECT_EQ(score.num_unknown, 1);
}

TEST_F(PlaceRecognitionTest, OfNothingAllIsZero) {
  const PlaceRecognitionScore score = Score();
  EXPECT_EQ(score.num_queries, 0);
  EXPECT_EQ(score.num_right + score.num_wrong + score.num_unknown, 0);
}

}  // namespace
}  // namespace cartographer_sdf::place_recognition_test
