// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/place_recognition.h"

#include <algorithm>
#include <set>
#include <utility>

namespace cartographer_sdf {
namespace {

using IdPair = std::pair<SubmapId, SubmapId>;

// The accepted ones among the judged pairs. Labels name a pair of one map in
// the order of its ids, the table need not.
std::set<IdPair> AcceptedPairs(const std::vector<AnswerLabel>& labels,
                               const std::vector<MatchRow>& matches,
                               int* const num_unknown) {
  std::set<IdPair> judged;
  for (const AnswerLabel& label : labels) {
    judged.insert({label.reference, label.query});
  }
  std::set<IdPair> accepted;
  for (const MatchRow& match : matches) {
    if (!match.accepted) continue;
    const IdPair pair{match.reference, match.query};
    const IdPair turned{match.query, match.reference};
    if (judged.count(pair) > 0) {
      accepted.insert(pair);
    } else if (judged.count(turned) > 0) {
      accepted.insert(turned);
    } else {
      ++*num_unknown;
    }
  }
  return accepted;
}

}  // namespace

PlaceRecognitionScore ScorePlaceRecognition(
    const PairTruths& pairs, const std::vector<AnswerLabel>& labels,
    const std::vector<MatchRow>& matches) {
  PlaceRecognitionScore score;
  std::set<SubmapId> queries, positive, matched, right;
  for (const auto& [ids, truth] : pairs) {
    queries.insert(ids.second);
    if (truth.is_positive) positive.insert(ids.second);
  }
  const std::set<IdPair> accepted =
      AcceptedPairs(labels, matches, &score.num_unknown);
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
