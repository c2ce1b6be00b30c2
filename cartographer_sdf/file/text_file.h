// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Reads tables from text files: lines of fields. Any input yields a table or a
// one-sentence error that names the file and, where there is one, the line.

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

// Returns the non-blank lines, with surrounding white space removed.
[[nodiscard]] absl::StatusOr<std::vector<TextLine>> ReadLines(
    const std::string& path);

// Returns an error with the message "path:line: problem".
[[nodiscard]] absl::Status LineError(const std::string& path, int line,
                                     const std::string& problem);

// Parses a finite number; an error names the line.
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
  // In the order of the requested columns.
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

// Reads a file with a header line. Columns are found by name; others are
// ignored. Numbers must be finite. Quoting is not supported: a field cannot
// contain a comma.
[[nodiscard]] absl::StatusOr<std::vector<CsvRow>> ReadCsv(
    const std::string& path, const std::vector<CsvColumn>& columns);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FILE_TEXT_FILE_H_
