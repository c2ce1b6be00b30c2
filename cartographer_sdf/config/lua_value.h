// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_CONFIG_LUA_VALUE_H_
#define CARTOGRAPHER_SDF_CONFIG_LUA_VALUE_H_

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"

struct lua_State;

namespace cartographer_sdf {

struct LuaField;
struct LuaValue;

// A Lua table is either keyed by names or a list; `{}` is both.
struct LuaTable {
  std::vector<LuaField> fields;  // sorted by key
  std::vector<LuaValue> elements;

  // Null where there is no such field.
  [[nodiscard]] const LuaValue* Find(const std::string& key) const;
};

// Numbers are finite.
struct LuaValue : std::variant<bool, double, std::string, LuaTable> {
  using variant::variant;
};

struct LuaField {
  std::string key;
  LuaValue value;
};

// Takes the table from the top of Lua's stack; errors begin with the path of
// the offending value, e.g. "`name`.feature.radius_meters". Calls nothing that
// raises Lua errors.
[[nodiscard]] absl::StatusOr<LuaTable> PopLuaTable(lua_State* lua,
                                                   const std::string& name);

// The text with control characters as spaces, cut where it is long.
[[nodiscard]] std::string PrintableLine(std::string_view text);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_LUA_VALUE_H_
