// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a robot would have got from a table of matches ([Millane2019], Sec.
// V-C): accepted matches, true and false, and how many of its submaps were
// recognised at all.

#ifndef CARTOGRAPHER_SDF_EVALUATION_PLACE_RECOGNITION_H_
#define CARTOGRAPHER_SDF_EVALUATION_PLACE_RECOGNITION_H_

#include <vector>

#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/report/match_table.h"

namespace cartographer_sdf {

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

#endif  // CARTOGRAPHER_SDF_EVALUATION_PLACE_RECOGNITION_H_
