// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How good matches of submaps are, against the truth.
//
// A pair of submaps counts as positive where at least half of the smaller
// observed area lies in the other under the true poses (on 0.2 m cells). The
// error of an answer is that at the centre of the true overlap (of the query's
// area where there is none): right within 0.5 m and 10 degrees; wrong, wherever
// the pair lies, beyond 1 m or 10 degrees; near between, because maps and their
// truth bend that much. Pairs of submaps of one trajectory that are at most two
// apart share scans and are left out, and so are those without a truth.

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

// Of every second known cell along both axes, counted as the host does from the
// last cell on: 0.1 m apart where cells have 0.05 m.
[[nodiscard]] ObservedPoints ThinnedObservedPoints(const OccupancyGrid& grid);

struct PairTruth {
  // Common area as a fraction of the smaller one's.
  double overlap = 0.;
  // Whether the overlap is enough to ask for an answer.
  bool is_positive = false;
  Rigid2 T_reference_query;
  // Centre of the common area; of the query's where there is none [m].
  Eigen::Vector2d centre_query = Eigen::Vector2d::Zero();
};
using PairTruths = std::map<std::pair<SubmapId, SubmapId>, PairTruth>;

// Pairs with a common area of this fraction of the smaller one's or more are
// positive, unless MarkPositives says otherwise.
constexpr double kPositiveOverlap = 0.5;
// Submaps of one trajectory share scans below this difference of indices.
constexpr int kLeastIndexGap = 3;

// Of the submaps of one map: pairs (reference, query) with reference < query;
// of one trajectory, with indices that differ by `min_index_gap` or more.
[[nodiscard]] PairTruths ComputePairTruths(
    const std::map<SubmapId, ObservedPoints>& submaps, const Truth& truth,
    int min_index_gap = kLeastIndexGap);
// Of each submap of the reference map with each of the query map; both truths
// are in one world frame.
[[nodiscard]] PairTruths ComputePairTruths(
    const std::map<SubmapId, ObservedPoints>& reference_submaps,
    const Truth& reference_truth,
    const std::map<SubmapId, ObservedPoints>& query_submaps,
    const Truth& query_truth);

// Makes those pairs positive whose overlap is `min_overlap` or more.
void MarkPositives(double min_overlap, PairTruths* pairs);

enum class AnswerVerdict { kRight, kNear, kWrong };
// "right", "near", "wrong"
[[nodiscard]] const char* AnswerVerdictName(AnswerVerdict verdict);

// What the truth says of a match.
struct AnswerLabel {
  SubmapId reference;
  SubmapId query;
  double score = 0.;
  // Of the pair: common area as a fraction of the smaller one's, and whether
  // that is enough to count.
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
  // Answers are taken by falling score, of equal ones in the order of the
  // table. Right answers to positive pairs over all positive pairs: before the
  // first wrong answer, the most at a precision of 0.99, and the area below the
  // precision-recall curve.
  double recall_at_precision_1 = 0.;
  double recall_at_precision_99 = 0.;
  double average_precision = 0.;
  // The last score before the first wrong answer; none where the first answer
  // is wrong.
  std::optional<double> threshold;
  // Of right answers; none where there are none.
  std::optional<double> median_translation_error;  // [m]
  std::optional<double> median_rotation_error;     // [rad]
};

// `labels` are LabelAnswers' for the same pairs.
[[nodiscard]] MatchScore ScoreAnswers(const PairTruths& pairs,
                                      const std::vector<AnswerLabel>& labels);

enum class AnswerJudgement {
  // An answer to a positive pair is right, whatever its pose: the paper's.
  kByPair,
  // As ScoreAnswers: right where its pose is (AnswerVerdict) and the pair is
  // positive, wrong where its pose is, and else neither.
  kByPose,
};

// The same over the threshold, answers of one score together: unlike above, the
// order of the table does not matter.
[[nodiscard]] PrecisionRecallCurve JudgeAnswers(
    const std::vector<AnswerLabel>& labels, int num_positives,
    AnswerJudgement judgement);

// What a robot would have got from a table of matches ([Millane2019], Sec.
// V-C): accepted matches, true and false, and how many of its submaps were
// recognised at all.
struct PlaceRecognitionScore {
  // Accepted matches of pairs that can be judged, by what the truth says.
  int num_right = 0;
  int num_near = 0;
  int num_wrong = 0;
  // Accepted, but one of the submaps has no truth, or they are neighbours.
  int num_unknown = 0;
  // Query submaps that have a pair that can be judged; those with a positive
  // one, that is, with something to recognise; those with an accepted match
  // that can be judged; and with one that is right. Of pairs of one map, the
  // later submap is the query.
  int num_queries = 0;
  int num_queries_with_positive = 0;
  int num_queries_matched = 0;
  int num_queries_right = 0;
};

// `labels` are LabelAnswers' of `matches` to `pairs`.
[[nodiscard]] PlaceRecognitionScore ScorePlaceRecognition(
    const PairTruths& pairs, const std::vector<AnswerLabel>& labels,
    const std::vector<MatchRow>& matches);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_MATCH_SCORE_H_
