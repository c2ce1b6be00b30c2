// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_TEXT_TABLE_H_
#define CARTOGRAPHER_SDF_REPORT_TEXT_TABLE_H_

#include <string>
#include <vector>

namespace cartographer_sdf {

// Lines with aligned columns, indented by two: the first column to the left,
// others to the right. Rows may differ in length.
[[nodiscard]] std::string FormatTable(
    const std::vector<std::vector<std::string>>& rows);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_TEXT_TABLE_H_
