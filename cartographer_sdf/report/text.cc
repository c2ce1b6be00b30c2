// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/text.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "nlohmann/json.hpp"

namespace cartographer_sdf {
namespace {

std::string EscapeCharacter(const char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      break;
  }
  const bool is_control = absl::ascii_iscntrl(static_cast<unsigned char>(c));
  return std::string(1, is_control && c != '\n' && c != '\t' ? '?' : c);
}

}  // namespace

std::string EscapeMarkup(const std::string_view text) {
  using Json = nlohmann::json;
  // Replaces bytes that are not UTF-8.
  const std::string utf8 =
      Json::parse(Json(std::string(text))
                      .dump(-1, ' ', false, Json::error_handler_t::replace))
          .get<std::string>();
  std::string escaped;
  for (const char c : utf8) escaped += EscapeCharacter(c);
  return escaped;
}

std::string FormatTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<int> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], static_cast<int>(row[i].size()));
    }
  }
  std::string table;
  for (const std::vector<std::string>& row : rows) {
    std::string line = absl::StrFormat("  %-*s", widths[0], row[0]);
    for (size_t i = 1; i < row.size(); ++i) {
      absl::StrAppendFormat(&line, "  %*s", widths[i], row[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    absl::StrAppend(&table, line, "\n");
  }
  return table;
}

std::string FormatScore(const std::optional<double>& score) {
  return score ? absl::StrFormat("%.1f", *score) : "none";
}

}  // namespace cartographer_sdf
