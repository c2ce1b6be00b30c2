// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Results about sessions as JSON, see json.h.

#ifndef CARTOGRAPHER_SDF_REPORT_SESSION_JSON_H_
#define CARTOGRAPHER_SDF_REPORT_SESSION_JSON_H_

#include "cartographer_sdf/apps/merge.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/report/json.h"

namespace cartographer_sdf {

// The R.json of relocalize.
[[nodiscard]] Json ToJson(const Localization& result);

// What became of each session, and of each pair.
[[nodiscard]] Json ToJson(const MergingResult& result);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SESSION_JSON_H_
