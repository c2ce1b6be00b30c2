// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/text_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"

namespace cartographer_sdf {
namespace {

constexpr uintmax_t kMaxTableSize = uintmax_t{1} << 30;

// A field as error messages show it.
std::string Quoted(const absl::string_view field) {
  constexpr size_t kMaxLength = 40;
  return absl::StrCat("\"", absl::CHexEscape(field.substr(0, kMaxLength)),
                      field.size() > kMaxLength ? "...\"" : "\"");
}

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields = absl::StrSplit(line, ',');
  for (std::string& field : fields) {
    absl::StripAsciiWhitespace(&field);
  }
  return fields;
}

// Returns the position in the header of each requested column.
absl::StatusOr<std::vector<size_t>> FindColumns(
    const std::string& path, const std::vector<std::string>& header,
    const std::vector<CsvColumn>& columns) {
  std::vector<size_t> positions;
  for (const CsvColumn& column : columns) {
    const auto count = std::count(header.begin(), header.end(), column.name);
    if (count != 1) {
      return absl::InvalidArgumentError(
          absl::StrCat(path, " has ", count, " columns named \"", column.name,
                       "\" in its first line instead of one"));
    }
    positions.push_back(std::find(header.begin(), header.end(), column.name) -
                        header.begin());
  }
  return positions;
}

absl::Status AppendField(const std::string& path, const CsvColumn& column,
                         const std::string& field, CsvRow* const row) {
  if (column.type == CsvType::kWord) {
    row->fields.emplace_back(field);
  } else if (column.type == CsvType::kNumber) {
    const absl::StatusOr<double> value = ParseNumber(path, row->line, field);
    if (!value.ok()) return value.status();
    row->fields.emplace_back(*value);
  } else {
    int value = 0;
    if (!absl::SimpleAtoi(field, &value)) {
      return LineError(
          path, row->line,
          absl::StrCat(Quoted(field), " is not an integer number"));
    }
    row->fields.emplace_back(value);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::vector<TextLine>> ReadLines(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status =
      std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    return absl::NotFoundError(
        absl::StrCat("cannot read ", path, ": ", "there is no such file"));
  }
  if (!std::filesystem::is_regular_file(status)) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot read ", path, ": not a regular file"));
  }
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kMaxTableSize) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot read ", path, ": it is larger than 1 GiB"));
  }
  std::ifstream file(path, std::ios::binary);
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    absl::StripAsciiWhitespace(&text);
    if (!text.empty()) {
      lines.push_back(TextLine{number, text});
    }
  }
  if (file.bad() || !file.eof()) {
    return absl::UnavailableError(absl::StrCat("cannot read ", path));
  }
  return lines;
}

absl::Status LineError(const std::string& path, const int line,
                       const std::string& problem) {
  return absl::InvalidArgumentError(
      absl::StrCat(path, ":", line, ": ", problem));
}

absl::StatusOr<double> ParseNumber(const std::string& path, const int line,
                                   const std::string& field) {
  double value = 0.;
  if (!absl::SimpleAtod(field, &value) || !std::isfinite(value)) {
    return LineError(path, line,
                     absl::StrCat(Quoted(field), " is not a finite number"));
  }
  return value;
}

absl::StatusOr<std::vector<CsvRow>> ReadCsv(
    const std::string& path, const std::vector<CsvColumn>& columns) {
  absl::StatusOr<std::vector<TextLine>> lines = ReadLines(path);
  if (!lines.ok()) return lines.status();
  if (lines->empty()) {
    return absl::InvalidArgumentError(absl::StrCat(path, " is empty"));
  }
  const std::vector<std::string> header = Fields(lines->front().text);
  const absl::StatusOr<std::vector<size_t>> positions =
      FindColumns(path, header, columns);
  if (!positions.ok()) return positions.status();
  std::vector<CsvRow> rows;
  for (auto line = lines->begin() + 1; line != lines->end(); ++line) {
    const std::vector<std::string> fields = Fields(line->text);
    if (fields.size() != header.size()) {
      return LineError(
          path, line->number,
          absl::StrCat(fields.size(), " fields instead of ", header.size()));
    }
    CsvRow row;
    row.line = line->number;
    for (size_t k = 0; k != columns.size(); ++k) {
      const absl::Status status =
          AppendField(path, columns[k], fields[(*positions)[k]], &row);
      if (!status.ok()) return status;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace cartographer_sdf
