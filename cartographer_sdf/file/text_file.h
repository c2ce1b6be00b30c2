// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Tables in text files: lines of fields. Any bytes give a table or one clear
// sentence that names the file and, where there is one, the line.

#ifndef CARTOGRAPHER_SDF_FILE_TEXT_FILE_H_
#define CARTOGRAPHER_SDF_FILE_TEXT_FILE_H_

#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace cartographer_sdf {

struct TextLine {
  int number = 0;  // from 1
  std::string text;
};

// The lines that are not blank, without surrounding white space.
[[nodiscard]] absl::StatusOr<std::vector<TextLine>> ReadLines(
    const std::string& path);

// "path:line: problem"
[[nodiscard]] absl::Status LineError(const std::string& path, int line,
                                     const std::string& problem);

// A finite number, or an error of that line.
[[nodiscard]] absl::StatusOr<double> ParseNumber(const std::string& path,
                                                 int line,
                                                 const std::string& field);

enum class CsvType { kInteger, kNumber, kWord };
struct CsvColumn {
  std::string name;
  CsvType type;
};

struct CsvRow {
  int line = 0;
  // In the order of the columns asked for.
  std::vector<std::variant<int, double, std::string>> fields;

  [[nodiscard]] int Integer(int column) const {
    return std::get<int>(fields[column]);
  }
  [[nodiscard]] double Number(int column) const {
    return std::get<double>(fields[column]);
  }
  [[nodiscard]] const std::string& Word(int column) const {
    return std::get<std::string>(fields[column]);
  }
};

// A file with a header line; columns are found by name, others are ignored.
// Numbers are finite. There are no quotes: a field cannot hold a comma.
[[nodiscard]] absl::StatusOr<std::vector<CsvRow>> ReadCsv(
    const std::string& path, const std::vector<CsvColumn>& columns);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FILE_TEXT_FILE_H_
