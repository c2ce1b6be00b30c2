// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_ROUND_STEP_H_
#define CARTOGRAPHER_SDF_REPORT_ROUND_STEP_H_

namespace cartographer_sdf {

// The least 1, 2 or 5 times a power of ten that is not less than `step` > 0.
[[nodiscard]] double RoundStep(double step);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_ROUND_STEP_H_
