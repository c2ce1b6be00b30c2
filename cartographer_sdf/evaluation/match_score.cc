// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/match_score.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <utility>

#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/evaluation/submap_cloud.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr double kCellSize = 0.2;                     // [m]
constexpr double kRightTranslation = 0.5;             // [m]
constexpr double kWrongTranslation = 1.;              // [m]
constexpr double kRightRotation = 10. * M_PI / 180.;  // [rad]
constexpr double kHighPrecision = 0.99;

using Area = std::vector<Square>;  // sorted, each once

Area ObservedArea(const Rigid2& T_world_submap, const ObservedPoints& points) {
  Area area;
  for (const Eigen::Vector2d& p_submap : points) {
    area.push_back(SquareAt(T_world_submap * p_submap, kCellSize));
  }
  std::sort(area.begin(), area.end());
  area.erase(std::unique(area.begin(), area.end()), area.end());
  return area;
}

struct SeenArea {
  SubmapId id;
  Rigid2 T_world_submap;
  Area area;
};

std::vector<SeenArea> SeenAreas(
    const std::map<SubmapId, ObservedPoints>& submaps, const Truth& truth) {
  std::vector<SeenArea> areas;
  for (const auto& [id, points] : submaps) {
    const auto pose = truth.T_world_submap.find(id);
    if (pose != truth.T_world_submap.end() && !points.empty()) {
      areas.push_back({id, pose->second, ObservedArea(pose->second, points)});
    }
  }
  return areas;
}

Eigen::Vector2d Centre(const Area& area) {
  int64_t sum_x = 0;
  int64_t sum_y = 0;
  for (const auto& [x, y] : area) {
    sum_x += x;
    sum_y += y;
  }
  const Eigen::Vector2d mean =
      Eigen::Vector2d(static_cast<double>(sum_x), static_cast<double>(sum_y)) /
      static_cast<double>(area.size());
  return kCellSize * (mean + Eigen::Vector2d::Constant(0.5));
}

PairTruth MakePairTruth(const SeenArea& reference, const SeenArea& query) {
  Area both;
  std::set_intersection(reference.area.begin(), reference.area.end(),
                        query.area.begin(), query.area.end(),
                        std::back_inserter(both));
  PairTruth pair;
  pair.overlap =
      static_cast<double>(both.size()) /
      static_cast<double>(std::min(reference.area.size(), query.area.size()));
  pair.is_positive = pair.overlap >= kPositiveOverlap;
  pair.T_reference_query =
      reference.T_world_submap.Inverse() * query.T_world_submap;
  pair.centre_query =
      query.T_world_submap.Inverse() * Centre(both.empty() ? query.area : both);
  return pair;
}

AnswerVerdict Judge(const double translation_error,
                    const double rotation_error) {
  if (translation_error < kRightTranslation &&
      rotation_error < kRightRotation) {
    return AnswerVerdict::kRight;
  }
  if (translation_error > kWrongTranslation ||
      rotation_error > kRightRotation) {
    return AnswerVerdict::kWrong;
  }
  return AnswerVerdict::kNear;
}

AnswerLabel MakeLabel(const PairTruth& pair, const MatchRow& match) {
  const Rigid2 T_true_found =
      pair.T_reference_query.Inverse() * match.T_reference_query;
  AnswerLabel label;
  label.reference = match.reference;
  label.query = match.query;
  label.score = match.score;
  label.overlap = pair.overlap;
  label.to_positive = pair.is_positive;
  label.translation_error =
      (T_true_found * pair.centre_query - pair.centre_query).norm();
  label.rotation_error = std::abs(T_true_found.rotation());
  label.verdict = Judge(label.translation_error, label.rotation_error);
  return label;
}

// `answers` are ordered by decreasing score.
void FollowPrecisionRecallCurve(std::vector<AnswerLabel> answers,
                                MatchScore* const score) {
  for (size_t k = 0; k < answers.size(); ++k) {
    score->num_wrong += answers[k].verdict == AnswerVerdict::kWrong;
    score->num_near += answers[k].verdict == AnswerVerdict::kNear;
    if (score->num_wrong == 0) score->threshold = answers[k].score;
    // Replaces scores by ranks, so that each answer has its own point of the
    // curve.
    answers[k].score = -static_cast<double>(k);
  }
  const PrecisionRecallCurve curve =
      JudgeAnswers(answers, score->num_positives, AnswerJudgement::kByPose);
  score->recall_at_precision_1 = curve.RecallAtPrecision1().value_or(0.);
  score->average_precision = curve.AveragePrecision().value_or(0.);
  for (const PrecisionRecallPoint& point : curve.points) {
    if (point.precision < kHighPrecision) continue;
    score->recall_at_precision_99 = point.recall;
  }
}

void SummarizeErrors(const std::vector<AnswerLabel>& answers,
                     MatchScore* const score) {
  std::vector<PoseError> errors;
  for (const AnswerLabel& answer : answers) {
    if (answer.verdict != AnswerVerdict::kRight) continue;
    errors.push_back({answer.translation_error, answer.rotation_error});
  }
  const std::optional<PoseErrorStatistics> statistics = SummarizePoses(errors);
  if (!statistics) return;
  score->median_translation_error = statistics->translation.median;
  score->median_rotation_error = statistics->rotation.median;
}

}  // namespace

ObservedPoints ThinnedObservedPoints(const OccupancyGrid& grid) {
  ObservedPoints points;
  const Eigen::Array2i& size = grid.geometry.size;
  for (int j = (size.y() + 1) % 2; j < size.y(); j += 2) {
    for (int i = (size.x() + 1) % 2; i < size.x(); i += 2) {
      if (grid.known(i, j)) {
        points.push_back(grid.geometry.CellCentre({i, j}));
      }
    }
  }
  return points;
}

PairTruths ComputePairTruths(const std::map<SubmapId, ObservedPoints>& submaps,
                             const Truth& truth, const int min_index_gap) {
  const std::vector<SeenArea> areas = SeenAreas(submaps, truth);
  PairTruths pairs;
  for (size_t j = 0; j < areas.size(); ++j) {
    for (size_t i = 0; i < j; ++i) {
      if (ShareScans(areas[i].id, areas[j].id, min_index_gap)) continue;
      pairs[{areas[i].id, areas[j].id}] = MakePairTruth(areas[i], areas[j]);
    }
  }
  return pairs;
}

PairTruths ComputePairTruths(
    const std::map<SubmapId, ObservedPoints>& reference_submaps,
    const Truth& reference_truth,
    const std::map<SubmapId, ObservedPoints>& query_submaps,
    const Truth& query_truth) {
  const std::vector<SeenArea> queries = SeenAreas(query_submaps, query_truth);
  PairTruths pairs;
  for (const SeenArea& reference :
       SeenAreas(reference_submaps, reference_truth)) {
    for (const SeenArea& query : queries) {
      pairs[{reference.id, query.id}] = MakePairTruth(reference, query);
    }
  }
  return pairs;
}

void MarkPositives(const double min_overlap, PairTruths* const pairs) {
  for (auto& [ids, pair] : *pairs) {
    pair.is_positive = pair.overlap >= min_overlap;
  }
}

const char* AnswerVerdictName(const AnswerVerdict verdict) {
  switch (verdict) {
    case AnswerVerdict::kRight:
      return "right";
    case AnswerVerdict::kNear:
      return "near";
    case AnswerVerdict::kWrong:
      return "wrong";
  }
  LOG(FATAL) << "not a verdict: " << static_cast<int>(verdict);
}

std::vector<AnswerLabel> LabelAnswers(const PairTruths& pairs,
                                      const std::vector<MatchRow>& matches) {
  std::vector<AnswerLabel> labels;
  std::set<std::pair<SubmapId, SubmapId>> seen;
  for (const MatchRow& match : matches) {
    const auto pair = pairs.find({match.reference, match.query});
    if (pair == pairs.end() || !seen.insert(pair->first).second) continue;
    labels.push_back(MakeLabel(pair->second, match));
  }
  return labels;
}

void OrderByIds(std::vector<MatchRow>* const matches) {
  for (MatchRow& match : *matches) {
    if (match.query < match.reference) {
      std::swap(match.reference, match.query);
      match.T_reference_query = match.T_reference_query.Inverse();
    }
  }
}

MatchScore ScoreAnswers(const PairTruths& pairs,
                        const std::vector<AnswerLabel>& labels) {
  MatchScore score;
  score.num_pairs = static_cast<int>(pairs.size());
  score.num_positives = static_cast<int>(
      std::count_if(pairs.begin(), pairs.end(),
                    [](const auto& pair) { return pair.second.is_positive; }));
  score.num_answers = static_cast<int>(labels.size());
  std::vector<AnswerLabel> answers = labels;
  std::stable_sort(answers.begin(), answers.end(),
                   [](const AnswerLabel& a, const AnswerLabel& b) {
                     return a.score > b.score;
                   });
  FollowPrecisionRecallCurve(answers, &score);
  SummarizeErrors(answers, &score);
  return score;
}

PrecisionRecallCurve JudgeAnswers(const std::vector<AnswerLabel>& labels,
                                  const int num_positives,
                                  const AnswerJudgement judgement) {
  std::vector<JudgedAnswer> answers;
  for (const AnswerLabel& label : labels) {
    if (judgement == AnswerJudgement::kByPair) {
      answers.push_back({label.score, label.to_positive});
    } else if (label.verdict == AnswerVerdict::kWrong) {
      answers.push_back({label.score, false});
    } else if (label.verdict == AnswerVerdict::kRight && label.to_positive) {
      answers.push_back({label.score, true});
    }
  }
  return MakePrecisionRecallCurve(std::move(answers), num_positives);
}

PlaceRecognitionScore ScorePlaceRecognition(
    const PairTruths& pairs, const std::vector<AnswerLabel>& labels,
    const std::vector<MatchRow>& matches) {
  PlaceRecognitionScore score;
  std::set<SubmapId> queries, positive, matched, right;
  for (const auto& [ids, truth] : pairs) {
    queries.insert(ids.second);
    if (truth.is_positive) positive.insert(ids.second);
  }
  std::set<std::pair<SubmapId, SubmapId>> accepted;
  for (const MatchRow& match : matches) {
    if (!match.accepted) continue;
    accepted.insert({match.reference, match.query});
    score.num_unknown += pairs.count({match.reference, match.query}) == 0;
  }
  for (const AnswerLabel& label : labels) {
    if (accepted.count({label.reference, label.query}) == 0) continue;
    score.num_right += label.verdict == AnswerVerdict::kRight;
    score.num_near += label.verdict == AnswerVerdict::kNear;
    score.num_wrong += label.verdict == AnswerVerdict::kWrong;
    matched.insert(label.query);
    if (label.verdict == AnswerVerdict::kRight) right.insert(label.query);
  }
  score.num_queries = static_cast<int>(queries.size());
  score.num_queries_with_positive = static_cast<int>(positive.size());
  score.num_queries_matched = static_cast<int>(matched.size());
  score.num_queries_right = static_cast<int>(right.size());
  return score;
}

}  // namespace cartographer_sdf
