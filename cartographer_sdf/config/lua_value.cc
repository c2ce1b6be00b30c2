// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/lua_value.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

extern "C" {
#include <lua.h>
}

namespace cartographer_sdf {
namespace {

constexpr int kMaxDepth = 16;
// Of all values with their paths, in characters: tables and strings that occur
// in several places count as often.
constexpr size_t kMaxSize = 1000000;
constexpr size_t kMaxLineLength = 300;

// Converts Lua values by calls that cannot raise. A path is that of the value
// in work, to be named in an error.
class Converter {
 public:
  explicit Converter(lua_State* const lua) : lua_(lua) {}

  // Converts the value on top of the stack.
  [[nodiscard]] bool Convert(const std::string& path, LuaValue* value);
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  bool Fail(const std::string& path, const std::string& reason) {
    error_ = absl::StrCat(PrintableLine(path), " ", reason);
    return false;
  }
  bool ConvertTable(const std::string& path, LuaTable* table);
  bool ConvertField(const std::string& path, LuaTable* table);
  bool ConvertElements(const std::string& path, LuaTable* table);

  lua_State* const lua_;
  int depth_ = 0;
  size_t size_ = 0;
  std::string error_;
};

bool Converter::Convert(const std::string& path, LuaValue* const value) {
  size_ += 1 + path.size();
  if (size_ > kMaxSize) return Fail(path, "is too much to be a configuration");
  switch (lua_type(lua_, -1)) {
    case LUA_TBOOLEAN:
      *value = lua_toboolean(lua_, -1) != 0;
      return true;
    case LUA_TNUMBER: {
      const double number = lua_tonumber(lua_, -1);
      *value = number;
      return std::isfinite(number) || Fail(path, "must be a finite number");
    }
    case LUA_TSTRING: {
      size_t size = 0;
      const char* const text = lua_tolstring(lua_, -1, &size);
      if (size > kMaxSize) return Fail(path, "is too long a text");
      size_ += size;
      *value = std::string(text, size);
      return true;
    }
    case LUA_TTABLE: {
      LuaTable table;
      if (!ConvertTable(path, &table)) return false;
      *value = std::move(table);
      return true;
    }
    default:
      return Fail(path, absl::StrCat("must not be a ",
                                     lua_typename(lua_, lua_type(lua_, -1))));
  }
}

bool Converter::ConvertTable(const std::string& path, LuaTable* const table) {
  if (depth_ == kMaxDepth || !lua_checkstack(lua_, 4)) {
    return Fail(path, "is nested too deeply or contains itself");
  }
  ++depth_;
  bool ok = true;
  if (lua_rawlen(lua_, -1) > 0) {
    ok = ConvertElements(path, table);
  } else {
    lua_pushnil(lua_);
    while (ok && lua_next(lua_, -2) != 0) {
      ok = ConvertField(path, table);
      lua_pop(lua_, 1);
    }
  }
  --depth_;
  // Lua's own order changes from run to run.
  std::sort(table->fields.begin(), table->fields.end(),
            [](const LuaField& a, const LuaField& b) { return a.key < b.key; });
  return ok;
}

// The key lies below the value, which is on top of the stack.
bool Converter::ConvertField(const std::string& path, LuaTable* const table) {
  if (lua_type(lua_, -2) != LUA_TSTRING) {
    return Fail(path, absl::StrCat("has a key that is a ",
                                   lua_typename(lua_, lua_type(lua_, -2)),
                                   "; keys must be names"));
  }
  size_t size = 0;
  const char* const key = lua_tolstring(lua_, -2, &size);
  if (size > kMaxSize) return Fail(path, "has too long a key");
  table->fields.push_back(LuaField{std::string(key, size), {}});
  return Convert(absl::StrCat(path, ".", table->fields.back().key),
                 &table->fields.back().value);
}

bool Converter::ConvertElements(const std::string& path,
                                LuaTable* const table) {
  const size_t size = lua_rawlen(lua_, -1);
  size_t num_keys = 0;
  lua_pushnil(lua_);
  while (lua_next(lua_, -2) != 0) {
    ++num_keys;
    lua_pop(lua_, 1);
  }
  if (num_keys != size) return Fail(path, "mixes a list with other keys");
  bool ok = true;
  for (size_t i = 1; ok && i <= size; ++i) {
    lua_rawgeti(lua_, -1, static_cast<int>(i));
    table->elements.emplace_back();
    ok = Convert(absl::StrCat(path, "[", i, "]"), &table->elements.back());
    lua_pop(lua_, 1);
  }
  return ok;
}

}  // namespace

std::string PrintableLine(std::string_view text) {
  std::string line(text.substr(0, kMaxLineLength));
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text.size() > kMaxLineLength ? line + "..." : line;
}

const LuaValue* LuaTable::Find(const std::string& key) const {
  const auto it =
      std::lower_bound(fields.begin(), fields.end(), key,
                       [](const LuaField& field, const std::string& k) {
                         return field.key < k;
                       });
  return it != fields.end() && it->key == key ? &it->value : nullptr;
}

absl::StatusOr<LuaTable> PopLuaTable(lua_State* const lua,
                                     const std::string& name) {
  Converter converter(lua);
  LuaValue value;
  const bool ok = converter.Convert(name, &value);
  lua_pop(lua, 1);
  if (!ok) return absl::InvalidArgumentError(converter.error());
  if (!std::holds_alternative<LuaTable>(value)) {
    return absl::InvalidArgumentError(absl::StrCat(name, " must be a table"));
  }
  return std::get<LuaTable>(std::move(value));
}

}  // namespace cartographer_sdf
