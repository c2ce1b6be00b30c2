// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/option_binding.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/config/nearest_name.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// So that twice an option, and some more, is an int, too.
constexpr double kMaxInteger = 1e9;

const char* TypeName(const LuaValue& value) {
  static constexpr const char* kNames[] = {"a table", "a boolean", "a number",
                                           "a string"};
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

}  // namespace

std::string OptionReader::PathOf(const char* const key) const {
  return absl::StrJoin(tables_, ".") + (tables_.empty() ? "" : ".") + key;
}

void OptionReader::AddError(const std::string& path,
                            const std::string& problem) {
  if (error_.empty()) error_ = absl::StrCat(path, " ", problem);
}

// A misspelt key is also a missing key; naming the misspelt one helps more.
absl::Status OptionReader::Result() const {
  std::string error = error_;
  for (const auto& [path, value] : dictionary_.values) {
    if (std::find(visited_.begin(), visited_.end(), path) != visited_.end()) {
      continue;
    }
    const size_t table = path.rfind('.') + 1;
    std::vector<std::string> keys;
    for (const std::string& known : visited_) {
      if (known.rfind('.') + 1 == table &&
          known.compare(0, table, path, 0, table) == 0) {
        keys.push_back(known.substr(table));
      }
    }
    const std::optional<std::string> nearest =
        NearestName(path.substr(table), keys);
    error = absl::StrCat(
        PrintableLine(path), " is not an option",
        nearest ? absl::StrCat(", did you mean '", *nearest, "'?") : "");
    break;
  }
  if (error.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("configuration file ", dictionary_.path, ": ", error));
}

template <typename T>
const T* OptionReader::Find(const char* const key,
                            const char* const type_name) {
  const std::string path = PathOf(key);
  visited_.push_back(path);
  const auto entry = dictionary_.values.find(path);
  if (entry == dictionary_.values.end()) {
    AddError(path, "is missing");
    return nullptr;
  }
  const T* const found = std::get_if<T>(&entry->second);
  if (found == nullptr) {
    AddError(path, absl::StrCat("must be ", type_name, ", it is ",
                                TypeName(entry->second)));
  }
  return found;
}

void OptionReader::Visit(const char* const key, double& option) {
  const double* const value = Find<double>(key, "a number");
  if (value != nullptr) option = *value;
}

void OptionReader::Visit(const char* const key, int& option) {
  const double* const value = Find<double>(key, "an integer");
  if (value == nullptr) return;
  if (*value != std::floor(*value)) {
    AddError(PathOf(key),
             absl::StrCat("must be an integer, it is ", FormatNumber(*value)));
    return;
  }
  if (std::abs(*value) > kMaxInteger) {
    AddError(PathOf(key), absl::StrCat("must lie between -1e9 and 1e9, it is ",
                                       FormatNumber(*value)));
    return;
  }
  option = static_cast<int>(*value);
}

void OptionReader::Visit(const char* const key, bool& option) {
  const bool* const value = Find<bool>(key, "true or false");
  if (value != nullptr) option = *value;
}

void OptionReader::VisitName(const char* const key,
                             const std::vector<std::string>& names,
                             int& index) {
  const std::string* const value = Find<std::string>(key, "a string");
  if (value == nullptr) return;
  const auto it = std::find(names.begin(), names.end(), *value);
  if (it == names.end()) {
    AddError(PathOf(key),
             absl::StrCat("must be one of '", absl::StrJoin(names, "', '"),
                          "', it is '", PrintableLine(*value), "'"));
    return;
  }
  index = static_cast<int>(it - names.begin());
}

bool OptionReader::Enter(const char* const key) {
  if (Find<std::monostate>(key, "a table") == nullptr) return false;
  tables_.push_back(key);
  return true;
}

void OptionReader::Leave(const std::string& problem) {
  if (!problem.empty() && error_.empty()) error_ = PathOf(problem.c_str());
  tables_.pop_back();
}

void OptionWriter::WriteLine(const std::string& line) {
  absl::StrAppend(&text_, std::string(static_cast<size_t>(2 * depth_), ' '),
                  line, "\n");
}

void OptionWriter::Visit(const char* const key, double& option) {
  WriteLine(absl::StrCat(key, " = ", FormatNumber(option), ","));
}

void OptionWriter::Visit(const char* const key, int& option) {
  WriteLine(absl::StrCat(key, " = ", option, ","));
}

void OptionWriter::Visit(const char* const key, bool& option) {
  WriteLine(absl::StrCat(key, " = ", option ? "true" : "false", ","));
}

void OptionWriter::VisitName(const char* const key,
                             const std::vector<std::string>& names,
                             int& index) {
  WriteLine(absl::StrCat(key, " = \"", names.at(index), "\","));
}

bool OptionWriter::Enter(const char* const key) {
  WriteLine(absl::StrCat(key, " = {"));
  ++depth_;
  return true;
}

void OptionWriter::Leave(const std::string&) {
  --depth_;
  WriteLine(depth_ > 0 ? "}," : "}");
}

void OptionLister::Add(const char* const key, const std::string& value) {
  std::vector<std::string> path = tables_;
  path.push_back(key);
  options_.emplace_back(absl::StrJoin(path, "."), value);
}

void OptionLister::Visit(const char* const key, double& option) {
  Add(key, FormatNumber(option));
}

void OptionLister::Visit(const char* const key, int& option) {
  Add(key, absl::StrCat(option));
}

void OptionLister::Visit(const char* const key, bool& option) {
  Add(key, option ? "true" : "false");
}

void OptionLister::VisitName(const char* const key,
                             const std::vector<std::string>& names,
                             int& index) {
  Add(key, absl::StrCat("\"", names.at(static_cast<size_t>(index)), "\""));
}

bool OptionLister::Enter(const char* const key) {
  tables_.push_back(key);
  return true;
}

void OptionLister::Leave(const std::string&) { tables_.pop_back(); }

}  // namespace cartographer_sdf
