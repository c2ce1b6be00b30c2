// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// `evaluate --random_pairs`: the paper's protocol, with its baseline and its
// ablation ([Millane2019], Sec. V-A and V-B).

#ifndef CARTOGRAPHER_SDF_TOOLS_EVALUATE_RANDOM_PAIRS_H_
#define CARTOGRAPHER_SDF_TOOLS_EVALUATE_RANDOM_PAIRS_H_

#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/evaluation/precision_recall.h"
#include "cartographer_sdf/simulation/truth.h"
#include "cartographer_sdf/tools/measurement.h"
#include "cartographer_sdf/tools/progress.h"

namespace cartographer_sdf {

// Whether the flags ask for it; a UsageError if they are invalid.
[[nodiscard]] bool WantsRandomPairs();
[[nodiscard]] absl::Status CheckRandomPairFlags();

// Adds measurements, and curves with AnswerJudgement::kByPair.
[[nodiscard]] absl::Status MeasureRandomPairs(
    const Truth& truth, StageProgress* progress,
    std::vector<Measurement>* measurements, std::vector<NamedCurve>* curves);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_EVALUATE_RANDOM_PAIRS_H_
