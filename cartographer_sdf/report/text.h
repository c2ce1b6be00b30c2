// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_TEXT_H_
#define CARTOGRAPHER_SDF_REPORT_TEXT_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cartographer_sdf {

// Escapes the text for HTML or SVG, in elements and in quoted attributes. Bytes
// that are not UTF-8 become U+FFFD, as in json.h; control characters become
// question marks.
[[nodiscard]] std::string EscapeMarkup(std::string_view text);

// Lines with aligned columns, indented by two: the first column is
// left-aligned, the others are right-aligned. Rows may differ in length; none
// is empty.
[[nodiscard]] std::string FormatTable(
    const std::vector<std::vector<std::string>>& rows);

// "12.3", or "none".
[[nodiscard]] std::string FormatScore(const std::optional<double>& score);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_TEXT_H_
