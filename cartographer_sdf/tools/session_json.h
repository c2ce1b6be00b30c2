// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Results about sessions as JSON, for scripts. Metres and radians; what there
// is not is null.

#ifndef CARTOGRAPHER_SDF_TOOLS_SESSION_JSON_H_
#define CARTOGRAPHER_SDF_TOOLS_SESSION_JSON_H_

#include <string>
#include <string_view>

#include "cartographer_sdf/sessions/merging.h"
#include "cartographer_sdf/sessions/relocalization.h"

namespace cartographer_sdf {

// A string in quotation marks. Bytes that are not UTF-8 become question marks.
[[nodiscard]] std::string QuoteJson(std::string_view text);

// The R.json of relocalize.
[[nodiscard]] std::string FormatRelocalization(const Relocalization& result);

// What became of each session, and of each pair.
[[nodiscard]] std::string FormatMerging(const MergingResult& result);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_SESSION_JSON_H_
