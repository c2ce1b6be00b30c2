// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/option_binding.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/config/nearest_name.h"

namespace cartographer_sdf {
namespace {

const char* TypeName(const LuaValue& value) {
  static constexpr const char* kNames[] = {"a boolean", "a number", "a string",
                                           "a table"};
  return kNames[value.index()];
}

// The shortest text that reads back as the same number.
std::string FormatNumber(const double number) {
  CHECK(std::isfinite(number));
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof(text), number);
  CHECK(error == std::errc());
  return std::string(text, end);
}

std::string Quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      absl::StrAppend(&quoted, "\\", std::string(1, c));
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      absl::StrAppendFormat(&quoted, "\\%03d", static_cast<int>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

}  // namespace

std::string OptionReader::PathOf(const std::string& key) const {
  return absl::StrCat(path_, ".", PrintableLine(key));
}

void OptionReader::AddError(const std::string& error) {
  if (error_.empty()) error_ = error;
}

// A misspelt key is also a missing one; it is the better one to name.
std::string OptionReader::Error() const {
  if (!table_.elements.empty()) {
    return absl::StrCat(path_, " must have named keys, it is a list");
  }
  for (const LuaField& field : table_.fields) {
    if (std::find(visited_.begin(), visited_.end(), field.key) !=
        visited_.end()) {
      continue;
    }
    const std::optional<std::string> nearest = NearestName(field.key, visited_);
    return absl::StrCat(PathOf(field.key), " is not an option",
                        nearest.has_value()
                            ? absl::StrCat(", did you mean '", *nearest, "'?")
                            : "");
  }
  return error_;
}

template <typename T>
const T* OptionReader::Find(const char* const key,
                            const char* const type_name) {
  visited_.push_back(key);
  const LuaValue* const value = table_.Find(key);
  if (value == nullptr) {
    AddError(absl::StrCat(PathOf(key), " is missing"));
    return nullptr;
  }
  const T* const found = std::get_if<T>(value);
  if (found == nullptr) {
    AddError(absl::StrCat(PathOf(key), " must be ", type_name, ", it is ",
                          TypeName(*value)));
  }
  return found;
}

const LuaTable* OptionReader::FindTable(const char* const key) {
  return Find<LuaTable>(key, "a table");
}

void OptionReader::operator()(const char* const key, double& option) {
  const double* const value = Find<double>(key, "a number");
  if (value != nullptr) option = *value;
}

void OptionReader::operator()(const char* const key, int& option) {
  const double* const value = Find<double>(key, "an integer");
  if (value == nullptr) return;
  if (*value != std::floor(*value) ||
      *value < std::numeric_limits<int>::min() ||
      *value > std::numeric_limits<int>::max()) {
    AddError(absl::StrCat(PathOf(key), " must be an integer, it is ",
                          FormatNumber(*value)));
    return;
  }
  option = static_cast<int>(*value);
}

void OptionReader::operator()(const char* const key, bool& option) {
  const bool* const value = Find<bool>(key, "true or false");
  if (value != nullptr) option = *value;
}

void OptionReader::operator()(const char* const key, std::string& option) {
  const std::string* const value = Find<std::string>(key, "a string");
  if (value != nullptr) option = *value;
}

void OptionReader::operator()(const char* const key,
                              std::vector<double>& option) {
  const LuaTable* const value = Find<LuaTable>(key, "a list of numbers");
  if (value == nullptr) return;
  if (!value->fields.empty()) {
    AddError(absl::StrCat(PathOf(key), " must be a list of numbers"));
    return;
  }
  option.clear();
  for (const LuaValue& element : value->elements) {
    const double* const number = std::get_if<double>(&element);
    if (number == nullptr) {
      AddError(absl::StrCat(PathOf(key), "[", option.size() + 1,
                            "] must be a number, it is ", TypeName(element)));
      return;
    }
    option.push_back(*number);
  }
}

size_t OptionReader::FindName(const char* const key,
                              const std::vector<std::string>& names) {
  CHECK(!names.empty());
  const std::string* const value = Find<std::string>(key, "a string");
  if (value == nullptr) return 0;
  const auto it = std::find(names.begin(), names.end(), *value);
  if (it != names.end()) return static_cast<size_t>(it - names.begin());
  AddError(absl::StrCat(PathOf(key), " must be one of '",
                        absl::StrJoin(names, "', '"), "', it is '",
                        PrintableLine(*value), "'"));
  return 0;
}

void OptionWriter::Write(const char* const key, const std::string& value) {
  absl::StrAppend(&text_, std::string(static_cast<size_t>(2 * depth_), ' '),
                  key, " = ", value, depth_ > 0 ? ",\n" : "\n");
}

void OptionWriter::Open(const char* const key) {
  absl::StrAppend(&text_, std::string(static_cast<size_t>(2 * depth_), ' '),
                  key, " = {\n");
  ++depth_;
}

void OptionWriter::Close() {
  --depth_;
  absl::StrAppend(&text_, std::string(static_cast<size_t>(2 * depth_), ' '),
                  depth_ > 0 ? "},\n" : "}\n");
}

void OptionWriter::operator()(const char* const key, double& option) {
  Write(key, FormatNumber(option));
}

void OptionWriter::operator()(const char* const key, int& option) {
  Write(key, absl::StrCat(option));
}

void OptionWriter::operator()(const char* const key, bool& option) {
  Write(key, option ? "true" : "false");
}

void OptionWriter::operator()(const char* const key, std::string& option) {
  Write(key, Quote(option));
}

void OptionWriter::operator()(const char* const key,
                              std::vector<double>& option) {
  std::string list = "{";
  for (const double number : option) {
    absl::StrAppend(&list, list.size() > 1 ? ", " : "", FormatNumber(number));
  }
  Write(key, list + "}");
}

}  // namespace cartographer_sdf
