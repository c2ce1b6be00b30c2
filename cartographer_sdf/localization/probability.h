// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Scores as probabilities. A score is the log-odds of being right.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_PROBABILITY_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_PROBABILITY_H_

#include <optional>
#include <string>

namespace cartographer_sdf {

[[nodiscard]] double ProbabilityOf(double score);

// Of an answer and its best rival at most one is right; each score is against
// neither being right.
[[nodiscard]] double ProbabilityOf(double score,
                                   const std::optional<double>& rival_score);

// "97.3 %", "more than 99.9 %", "less than 0.1 %".
[[nodiscard]] std::string FormatProbability(double probability);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_PROBABILITY_H_
