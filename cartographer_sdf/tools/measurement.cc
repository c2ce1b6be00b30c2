// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/measurement.h"

#include <cmath>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/report/text.h"

namespace cartographer_sdf {
namespace {

std::string FormatNumber(const std::optional<double>& number) {
  if (!number.has_value()) return "-";
  return *number == std::round(*number) ? absl::StrFormat("%.0f", *number)
                                        : absl::StrFormat("%.3f", *number);
}

}  // namespace

std::string FormatMeasurements(const std::vector<Measurement>& measurements) {
  std::string text;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> header;
  for (const Measurement& measurement : measurements) {
    std::vector<std::string> names = {""};
    std::vector<std::string> row = {measurement.subject};
    for (const auto& [name, number] : measurement.numbers) {
      names.push_back(name);
      row.push_back(FormatNumber(number));
    }
    if (names != header) {
      text += FormatTable(rows);
      rows = {names};
      header = names;
    }
    rows.push_back(row);
  }
  return text + FormatTable(rows);
}

absl::Status WriteMeasurements(const std::string& path,
                               const std::vector<Measurement>& measurements) {
  std::string content = "subject,quantity,value\n";
  for (const Measurement& measurement : measurements) {
    for (const auto& [name, number] : measurement.numbers) {
      if (!number.has_value()) continue;
      absl::StrAppendFormat(&content, "%s,%s,%.9g\n", measurement.subject, name,
                            *number);
    }
  }
  return WriteWholeFile(path, content);
}

}  // namespace cartographer_sdf
