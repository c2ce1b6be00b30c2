// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_MARKUP_H_
#define CARTOGRAPHER_SDF_REPORT_MARKUP_H_

#include <string>
#include <string_view>

namespace cartographer_sdf {

// The text for HTML or SVG, in elements and in quoted attributes. Bytes that
// are not UTF-8 and control characters become question marks.
[[nodiscard]] std::string EscapeMarkup(std::string_view text);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MARKUP_H_
