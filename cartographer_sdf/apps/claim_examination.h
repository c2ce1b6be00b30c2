// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Examines what the constraints of a map claim, pair by pair of submaps: how
// the two look at the claimed pose, beside the best pose that recognition
// finds.

#ifndef CARTOGRAPHER_SDF_APPS_CLAIM_EXAMINATION_H_
#define CARTOGRAPHER_SDF_APPS_CLAIM_EXAMINATION_H_

#include <map>
#include <vector>

#include "cartographer_sdf/apps/audit.h"
#include "cartographer_sdf/closing/constraint_groups.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

// Fills in groups and claims, in the order of the groups.
[[nodiscard]] std::vector<AuditedGroup> ExamineGroups(
    const MatchOptions& match_options, const AuditOptions& options,
    const std::map<SubmapId, Place>& places,
    const std::vector<ConstraintGroup>& groups, const Executor& executor,
    const ProgressCallback& on_progress);

// Judges a claim by how the pair looks, whatever other constraints say.
[[nodiscard]] AuditVerdict JudgeLooks(const AuditOptions& options,
                                      const ClaimEvidence& claim);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_CLAIM_EXAMINATION_H_
