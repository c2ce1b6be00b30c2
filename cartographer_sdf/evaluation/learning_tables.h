// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The tables from which scripts/learn_score.py learns the weights of the score:
// the terms of the score, and whether the answer was right.

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
// query_index, score, and one for each term of the score, named like its weight
// (ScoreTermNames). For matches of Method::kSdf. Numbers have nine digits.
[[nodiscard]] absl::Status WriteScoreTerms(const std::string& path,
                                           const std::vector<Match>& matches);

// The same for the neighbourhood score (NeighbourhoodTermNames). Skips matches
// whose neighbourhood was not measured and those whose own score is below
// `min_pair_score`.
[[nodiscard]] absl::Status WriteNeighbourhoodTerms(
    const std::string& path, const NeighbourhoodOptions& options,
    const std::vector<Match>& matches);

// CSV with the columns reference_trajectory, reference_index, query_trajectory,
// query_index, overlap, positive (0 or 1), verdict (right, near, wrong),
// translation_error [m], rotation_error [rad]. Numbers have six decimals.
[[nodiscard]] absl::Status WriteAnswerLabels(
    const std::string& path, const std::vector<AnswerLabel>& labels);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_LEARNING_TABLES_H_
