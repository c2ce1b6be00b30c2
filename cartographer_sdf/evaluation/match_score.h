// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Quality of submap matches against the truth.
//
// A pair of submaps is positive if at least half of the smaller observed area
// lies in the other under the true poses (on 0.2 m cells). The error of an
// answer is measured at the centre of the true overlap (of the query's area if
// there is none). The answer is right within 0.5 m and 10 degrees; wrong, for
// any pair, beyond 1 m or 10 degrees; and near in between, because maps and
// their truth are distorted by that much. Pairs of submaps of one trajectory
// that are at most two apart share scans and are left out, as are pairs without
// a truth.

#ifndef CARTOGRAPHER_SDF_EVALUATION_MATCH_SCORE_H_
#define CARTOGRAPHER_SDF_EVALUATION_MATCH_SCORE_H_

#include <Eigen/Core>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/evaluation/precision_recall.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/simulation/truth.h"

namespace cartographer_sdf {

// Centres of observed cells in the submap frame [m].
using ObservedPoints = std::vector<Eigen::Vector2d>;

// Every second known cell along both axes, counted from the last cell as in the
// host: 0.1 m apart for cells of 0.05 m.
[[nodiscard]] ObservedPoints ThinnedObservedPoints(const OccupancyGrid& grid);

struct PairTruth {
  // Common area as a fraction of the smaller one's.
  double overlap = 0.;
  // Whether the overlap is large enough to expect an answer.
  bool is_positive = false;
  Rigid2 T_reference_query;
  // Centre of the common area; of the query's area if there is none [m].
  Eigen::Vector2d centre_query = Eigen::Vector2d::Zero();
};
using PairTruths = std::map<std::pair<SubmapId, SubmapId>, PairTruth>;

// Pairs whose common area is at least this fraction of the smaller area are
// positive, unless MarkPositives changes it.
constexpr double kPositiveOverlap = 0.5;
// Submaps of one trajectory whose indices differ by less share scans.
constexpr int kLeastIndexGap = 3;

// Pairs (reference, query) of submaps of one map, with reference < query;
// within one trajectory, their indices differ by at least `min_index_gap`.
[[nodiscard]] PairTruths ComputePairTruths(
    const std::map<SubmapId, ObservedPoints>& submaps, const Truth& truth,
    int min_index_gap = kLeastIndexGap);
// Pairs of each submap of the reference map with each of the query map; both
// truths are in one world frame.
[[nodiscard]] PairTruths ComputePairTruths(
    const std::map<SubmapId, ObservedPoints>& reference_submaps,
    const Truth& reference_truth,
    const std::map<SubmapId, ObservedPoints>& query_submaps,
    const Truth& query_truth);

// Makes exactly the pairs positive whose overlap is at least `min_overlap`.
void MarkPositives(double min_overlap, PairTruths* pairs);

enum class AnswerVerdict { kRight, kNear, kWrong };
// "right", "near", "wrong"
[[nodiscard]] const char* AnswerVerdictName(AnswerVerdict verdict);

// A match compared with the truth.
struct AnswerLabel {
  SubmapId reference;
  SubmapId query;
  double score = 0.;
  // The pair's common area as a fraction of the smaller area, and whether the
  // pair is positive.
  double overlap = 0.;
  bool to_positive = false;
  AnswerVerdict verdict = AnswerVerdict::kWrong;
  double translation_error = 0.;  // [m]
  double rotation_error = 0.;     // not negative [rad]
};

// The first answer to each pair of `pairs`, in the order of the table.
[[nodiscard]] std::vector<AnswerLabel> LabelAnswers(
    const PairTruths& pairs, const std::vector<MatchRow>& matches);

// Inverts answers for (i, j) with i > j of matches of one map: labels and
// scores are of pairs in the order of their ids.
void OrderByIds(std::vector<MatchRow>* matches);

struct MatchScore {
  int num_pairs = 0;
  int num_positives = 0;
  // Distinct pairs with an answer that can be judged.
  int num_answers = 0;
  int num_wrong = 0;
  int num_near = 0;
  // Answers are ordered by decreasing score, ties in the order of the table.
  // Recall is right answers to positive pairs over all positive pairs: before
  // the first wrong answer, and the most at a precision of 0.99. Average
  // precision is the area under the precision-recall curve.
  double recall_at_precision_1 = 0.;
  double recall_at_precision_99 = 0.;
  double average_precision = 0.;
  // The last score before the first wrong answer; none if the first answer is
  // wrong.
  std::optional<double> threshold;
  // Errors of right answers; none if there are none.
  std::optional<double> median_translation_error;  // [m]
  std::optional<double> median_rotation_error;     // [rad]
};

// `labels` are the result of LabelAnswers for the same pairs.
[[nodiscard]] MatchScore ScoreAnswers(const PairTruths& pairs,
                                      const std::vector<AnswerLabel>& labels);

enum class AnswerJudgement {
  // As in the paper: an answer to a positive pair is right, whatever its pose.
  kByPair,
  // As in ScoreAnswers: right if its pose is right (AnswerVerdict) and the pair
  // is positive, wrong if its pose is wrong, otherwise neither.
  kByPose,
};

// The same as a curve over the threshold. Answers with equal scores count
// together, so unlike above the order of the table does not matter.
[[nodiscard]] PrecisionRecallCurve JudgeAnswers(
    const std::vector<AnswerLabel>& labels, int num_positives,
    AnswerJudgement judgement);

// Place recognition by a table of matches ([Millane2019], Sec. V-C): true and
// false accepted matches, and the number of submaps that were recognised.
struct PlaceRecognitionScore {
  // Accepted matches of pairs that can be judged, by verdict.
  int num_right = 0;
  int num_near = 0;
  int num_wrong = 0;
  // Accepted, but one of the submaps has no truth, or they share scans.
  int num_unknown = 0;
  // Query submaps with a pair that can be judged; with a positive pair, that
  // is, with something to recognise; with an accepted match that can be judged;
  // and with a right match. In pairs of one map, the later submap is the query.
  int num_queries = 0;
  int num_queries_with_positive = 0;
  int num_queries_matched = 0;
  int num_queries_right = 0;
};

// `labels` are the result of LabelAnswers for `pairs` and `matches`.
[[nodiscard]] PlaceRecognitionScore ScorePlaceRecognition(
    const PairTruths& pairs, const std::vector<AnswerLabel>& labels,
    const std::vector<MatchRow>& matches);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_MATCH_SCORE_H_
