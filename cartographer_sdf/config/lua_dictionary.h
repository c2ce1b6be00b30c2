// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Reads a configuration file as the host does: Lua 5.2 that builds and returns
// a table, with `include "other.lua"` for the files it builds on. Whatever the
// file does, the result is its table or one clear sentence: its memory and its
// number of instructions are limited, and it cannot access files other than by
// `include`, draw random numbers, or hide an error.

#ifndef CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_
#define CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"

namespace cartographer_sdf {

// std::monostate is a table, whose fields have separate entries.
using LuaValue = std::variant<std::monostate, bool, double, std::string>;

struct LuaDictionary {
  // The path of the file, for error messages.
  std::string path;
  // Values by path, that is, keys joined by dots:
  // "TABLE.feature.radius_meters". Numbers are finite.
  std::map<std::string, LuaValue> values;
};

// Looks for `basename` and the files it includes in the directories, in order.
// Skips files that were included before, so that circular includes end. `name`
// is the name of the returned table in the file. Table keys must be names
// without dots; lists are not allowed.
[[nodiscard]] absl::StatusOr<LuaDictionary> LoadLuaDictionary(
    const std::vector<std::string>& directories, const std::string& basename,
    const std::string& name);

// Replaces control characters by spaces and truncates long texts.
[[nodiscard]] std::string PrintableLine(std::string_view text);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_
