// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Reads a configuration file in the host's manner: Lua 5.2 that builds a table
// and returns it, with `include "other.lua"` for what it builds upon. Whatever
// the file does, the answer is its table or one clear sentence: its memory and
// its number of instructions are limited, and nothing it can call reaches files
// other than by `include`, draws random numbers, or hides an error.

#ifndef CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_
#define CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"

namespace cartographer_sdf {

// std::monostate is a table, whose fields have entries of their own.
using LuaValue = std::variant<std::monostate, bool, double, std::string>;

struct LuaDictionary {
  // The path of the file, for error messages.
  std::string path;
  // By the keys that lead there, joined by dots: "TABLE.feature.radius_meters".
  // Numbers are finite.
  std::map<std::string, LuaValue> values;
};

// Looks for `basename` and for what it includes in the directories, in their
// order. A file that is included again is skipped, so that circles end. `name`
// is what the file calls the table that it returns. Tables are keyed by names
// without dots, there are no lists.
[[nodiscard]] absl::StatusOr<LuaDictionary> LoadLuaDictionary(
    const std::vector<std::string>& directories, const std::string& basename,
    const std::string& name);

// The text with control characters as spaces, cut where it is long.
[[nodiscard]] std::string PrintableLine(std::string_view text);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_
