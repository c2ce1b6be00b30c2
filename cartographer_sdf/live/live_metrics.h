// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What is counted through the host's metrics, of all builders of the process
// together. Counts nothing before somebody registers.

#ifndef CARTOGRAPHER_SDF_LIVE_LIVE_METRICS_H_
#define CARTOGRAPHER_SDF_LIVE_LIVE_METRICS_H_

#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

void SetNumPlaces(double num_places);
void CountDescribedSubmap(double seconds);
void CountQuery(double seconds, double num_candidates);
void CountMatch(Verdict verdict);
// Called whenever a closure meets its fate.
void CountClosure(ClosureStatus status);
void CountConstraints(double num_constraints);
void CountLocalization(LocalizationVerdict verdict);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_LIVE_METRICS_H_
