// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Reads a configuration file in the host's manner: Lua 5.2 that builds a table
// and returns it, with `include "other.lua"` for what it builds upon. Whatever
// the file does, the answer is its table or one clear sentence: its memory and
// its number of instructions are limited, and nothing it can call reaches files
// other than by `include`, draws random numbers, or hides an error.

#ifndef CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_
#define CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/config/lua_value.h"

namespace cartographer_sdf {

struct LuaDictionary {
  // The path of the file and the name of its table, for error messages.
  std::string path;
  std::string name;
  LuaTable table;
};

// Looks for `basename` and for what it includes in the directories, in their
// order. A file that is included again is skipped, so that circles end. `name`
// is what the file calls the table that it returns.
[[nodiscard]] absl::StatusOr<LuaDictionary> LoadLuaDictionary(
    const std::vector<std::string>& directories, const std::string& basename,
    const std::string& name);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_LUA_DICTIONARY_H_
