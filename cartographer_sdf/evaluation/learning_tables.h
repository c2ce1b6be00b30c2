// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The tables that scripts/learn_score.py learns the score's weights from: what
// the score is made of, and whether the answer was right.

#ifndef CARTOGRAPHER_SDF_EVALUATION_LEARNING_TABLES_H_
#define CARTOGRAPHER_SDF_EVALUATION_LEARNING_TABLES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

// CSV with the columns reference_trajectory, reference_index, query_trajectory,
// query_index, score, and one for each term of the score, called as its weight
// (ScoreTermNames). Of matches of Method::kSdf. To nine digits.
[[nodiscard]] absl::Status WriteScoreTerms(const std::string& path,
                                           const std::vector<Match>& matches);

// The same of the score in the neighbourhood (NeighbourhoodTermNames). Matches
// whose neighbourhood was not measured have no row, nor those whose own score
// is below `min_pair_score`.
[[nodiscard]] absl::Status WriteNeighbourhoodTerms(
    const std::string& path, const NeighbourhoodOptions& options,
    const std::vector<Match>& matches);

// CSV with the columns reference_trajectory, reference_index, query_trajectory,
// query_index, overlap, positive (0 or 1), verdict (right, near, wrong),
// translation_error [m], rotation_error [rad]. To six decimals.
[[nodiscard]] absl::Status WriteAnswerLabels(
    const std::string& path, const std::vector<AnswerLabel>& labels);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_LEARNING_TABLES_H_
