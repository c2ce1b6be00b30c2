// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/match_score.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <set>
#include <utility>

#include "cartographer_sdf/evaluation/error_statistics.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr double kCellSize = 0.2;                     // [m]
constexpr double kRightTranslation = 0.5;             // [m]
constexpr double kWrongTranslation = 1.;              // [m]
constexpr double kRightRotation = 10. * M_PI / 180.;  // [rad]
constexpr double kHighPrecision = 0.99;

using Cell = std::pair<int64_t, int64_t>;
using Area = std::vector<Cell>;  // sorted, each once

Area ObservedArea(const Rigid2& T_world_submap, const ObservedPoints& points) {
  Area area;
  for (const Eigen::Vector2d& p_submap : points) {
    const Eigen::Vector2d p_world = T_world_submap * p_submap;
    area.emplace_back(
        static_cast<int64_t>(std::floor(p_world.x() / kCellSize)),
        static_cast<int64_t>(std::floor(p_world.y() / kCellSize)));
  }
  std::sort(area.begin(), area.end());
  area.erase(std::unique(area.begin(), area.end()), area.end());
  return area;
}

std::map<SubmapId, Area> ObservedAreas(
    const std::map<SubmapId, ObservedPoints>& submaps, const Truth& truth) {
  std::map<SubmapId, Area> areas;
  for (const auto& [id, points] : submaps) {
    const auto T_world_submap = truth.T_world_submap.find(id);
    if (T_world_submap != truth.T_world_submap.end() && !points.empty()) {
      areas[id] = ObservedArea(T_world_submap->second, points);
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

PairTruth MakePairTruth(const Area& reference, const Area& query) {
  Area both;
  std::set_intersection(reference.begin(), reference.end(), query.begin(),
                        query.end(), std::back_inserter(both));
  PairTruth pair;
  pair.overlap = static_cast<double>(both.size()) /
                 static_cast<double>(std::min(reference.size(), query.size()));
  pair.centre_world = Centre(both.empty() ? query : both);
  pair.is_positive = pair.overlap >= kPositiveOverlap;
  return pair;
}

bool AreNeighbours(const SubmapId& a, const SubmapId& b,
                   const int min_index_gap) {
  return a.trajectory == b.trajectory &&
         std::abs(a.index - b.index) < min_index_gap;
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

AnswerLabel MakeLabel(const PairTruth& pair, const Rigid2& T_world_reference,
                      const Rigid2& T_world_query, const MatchRow& match) {
  const Rigid2 T_true_found =
      (T_world_reference.Inverse() * T_world_query).Inverse() *
      match.T_reference_query;
  const Eigen::Vector2d centre_query =
      T_world_query.Inverse() * pair.centre_world;
  AnswerLabel label;
  label.reference = match.reference;
  label.query = match.query;
  label.score = match.score;
  label.overlap = pair.overlap;
  label.to_positive = pair.is_positive;
  label.translation_error = (T_true_found * centre_query - centre_query).norm();
  label.rotation_error = std::abs(T_true_found.rotation());
  label.verdict = Judge(label.translation_error, label.rotation_error);
  return label;
}

int CountPositives(const PairTruths& pairs) {
  return static_cast<int>(
      std::count_if(pairs.begin(), pairs.end(),
                    [](const auto& pair) { return pair.second.is_positive; }));
}

// `answers` by falling score.
void FollowPrecisionRecallCurve(const std::vector<AnswerLabel>& answers,
                                MatchScore* const score) {
  const double num_positives = std::max(1, score->num_positives);
  int num_right = 0;
  double sum_of_precisions = 0.;
  for (const AnswerLabel& answer : answers) {
    const bool is_right_positive =
        answer.verdict == AnswerVerdict::kRight && answer.to_positive;
    num_right += is_right_positive;
    score->num_wrong += answer.verdict == AnswerVerdict::kWrong;
    score->num_near += answer.verdict == AnswerVerdict::kNear;
    const double precision =
        static_cast<double>(num_right) /
        static_cast<double>(std::max(1, num_right + score->num_wrong));
    if (score->num_wrong == 0) {
      score->recall_at_precision_1 = num_right / num_positives;
      score->threshold = answer.score;
    }
    if (precision >= kHighPrecision) {
      score->recall_at_precision_99 = num_right / num_positives;
    }
    if (is_right_positive) sum_of_precisions += precision;
  }
  score->average_precision = sum_of_precisions / num_positives;
}

void SummarizeErrors(const std::vector<AnswerLabel>& answers,
                     MatchScore* const score) {
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const AnswerLabel& answer : answers) {
    if (answer.verdict != AnswerVerdict::kRight) continue;
    translations.push_back(answer.translation_error);
    rotations.push_back(answer.rotation_error);
  }
  if (translations.empty()) return;
  score->median_translation_error = Summarize(std::move(translations))->median;
  score->median_rotation_error = Summarize(std::move(rotations))->median;
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
  const std::map<SubmapId, Area> areas = ObservedAreas(submaps, truth);
  PairTruths pairs;
  for (auto reference = areas.begin(); reference != areas.end(); ++reference) {
    for (auto query = std::next(reference); query != areas.end(); ++query) {
      if (AreNeighbours(reference->first, query->first, min_index_gap)) {
        continue;
      }
      pairs[{reference->first, query->first}] =
          MakePairTruth(reference->second, query->second);
    }
  }
  return pairs;
}

PairTruths ComputePairTruths(
    const std::map<SubmapId, ObservedPoints>& reference_submaps,
    const Truth& reference_truth,
    const std::map<SubmapId, ObservedPoints>& query_submaps,
    const Truth& query_truth) {
  const std::map<SubmapId, Area> query_areas =
      ObservedAreas(query_submaps, query_truth);
  PairTruths pairs;
  for (const auto& [reference, reference_area] :
       ObservedAreas(reference_submaps, reference_truth)) {
    for (const auto& [query, query_area] : query_areas) {
      pairs[{reference, query}] = MakePairTruth(reference_area, query_area);
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
                                      const Truth& truth,
                                      const std::vector<MatchRow>& matches) {
  std::vector<MatchRow> ordered = matches;
  for (MatchRow& match : ordered) {
    if (match.query < match.reference) {
      std::swap(match.reference, match.query);
      match.T_reference_query = match.T_reference_query.Inverse();
    }
  }
  return LabelAnswers(pairs, truth, truth, ordered);
}

std::vector<AnswerLabel> LabelAnswers(const PairTruths& pairs,
                                      const Truth& reference_truth,
                                      const Truth& query_truth,
                                      const std::vector<MatchRow>& matches) {
  std::vector<AnswerLabel> labels;
  std::set<std::pair<SubmapId, SubmapId>> seen;
  for (const MatchRow& match : matches) {
    const auto pair = pairs.find({match.reference, match.query});
    if (pair == pairs.end() || !seen.insert(pair->first).second) continue;
    labels.push_back(MakeLabel(
        pair->second, reference_truth.T_world_submap.at(match.reference),
        query_truth.T_world_submap.at(match.query), match));
  }
  return labels;
}

MatchScore ScoreAnswers(const PairTruths& pairs,
                        const std::vector<AnswerLabel>& labels) {
  MatchScore score;
  score.num_pairs = static_cast<int>(pairs.size());
  score.num_positives = CountPositives(pairs);
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

PrecisionRecallCurve JudgeAnswers(const PairTruths& pairs,
                                  const std::vector<AnswerLabel>& labels) {
  std::vector<JudgedAnswer> answers;
  for (const AnswerLabel& label : labels) {
    if (label.verdict == AnswerVerdict::kWrong) {
      answers.push_back({label.score, false});
    } else if (label.verdict == AnswerVerdict::kRight && label.to_positive) {
      answers.push_back({label.score, true});
    }
  }
  return MakePrecisionRecallCurve(std::move(answers), CountPositives(pairs));
}

MatchScore ScoreMatches(const PairTruths& pairs, const Truth& truth,
                        const std::vector<MatchRow>& matches) {
  return ScoreAnswers(pairs, LabelAnswers(pairs, truth, matches));
}

MatchScore ScoreMatches(const PairTruths& pairs, const Truth& reference_truth,
                        const Truth& query_truth,
                        const std::vector<MatchRow>& matches) {
  return ScoreAnswers(
      pairs, LabelAnswers(pairs, reference_truth, query_truth, matches));
}

}  // namespace cartographer_sdf
