// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Lua reports errors by longjmp, which must not skip destructors: functions
// that call Lua functions that may raise hold no C++ objects; these live in
// `Loader`.

#include "cartographer_sdf/config/lua_dictionary.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

extern "C" {
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>
}

namespace cartographer_sdf {
namespace {

// A configuration of thousands of options needs a hundredth of each. As no
// available function does unbounded work on bounded memory, together these
// limits also bound the time.
constexpr size_t kMaxFileSize = size_t{1} << 20;
constexpr size_t kMaxAllocated = size_t{16} << 20;
constexpr int kMaxInstructions = 1000000;
constexpr int kMaxDepth = 16;
// Total size of all values with their paths, in characters; tables and strings
// that occur in several places count each time.
constexpr size_t kMaxConfigurationSize = 1000000;
constexpr size_t kMaxMessageLength = 300;

// Functions that configuration files may call. Deliberately absent: files (io,
// os, load, dofile), randomness (math.random), catching the errors that enforce
// the limits (pcall), finalizers (setmetatable), and functions that take long
// on short strings (patterns, string.rep).
constexpr std::string_view kBaseFunctions[] = {"assert",   "error",    "ipairs",
                                               "next",     "pairs",    "select",
                                               "tonumber", "tostring", "type"};
constexpr std::string_view kMathFunctions[] = {
    "abs", "acos",  "asin", "atan", "atan2", "ceil", "cos", "deg",
    "exp", "floor", "fmod", "huge", "log",   "max",  "min", "modf",
    "pi",  "pow",   "rad",  "sin",  "sqrt",  "tan"};
constexpr std::string_view kStringFunctions[] = {"format", "len", "lower",
                                                 "sub", "upper"};
constexpr std::string_view kTableFunctions[] = {"concat", "insert", "remove",
                                                "unpack"};

struct Loader {
  std::vector<std::string> directories;
  std::string basename;

  size_t allocated = 0;
  std::set<std::string> loaded;
  std::string path;
  std::string content;
  std::string error;

  bool IsLoaded(const char* name) const { return loaded.count(name) != 0; }
  // Returns false and sets an error.
  bool Find(const std::string& name);
  bool ReadFile(const std::string& name);
  // Pushes the chunk of the file, or nothing.
  bool Load(lua_State* lua, const char* name);
};

bool Loader::Find(const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos) {
    error = absl::StrCat("'", PrintableLine(name),
                         "' is not the plain name of a configuration file");
    return false;
  }
  for (const std::string& directory : directories) {
    path = (std::filesystem::path(directory) / name).string();
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored)) return true;
  }
  error = absl::StrCat("configuration file '", PrintableLine(name),
                       "' is in none of the directories [",
                       absl::StrJoin(directories, ", "), "]");
  return false;
}

bool Loader::ReadFile(const std::string& name) {
  if (!Find(name)) return false;
  std::ifstream file(path, std::ios::binary);
  content.resize(kMaxFileSize + 1);
  if (file) file.read(content.data(), static_cast<int64_t>(content.size()));
  content.resize(static_cast<size_t>(std::max<int64_t>(0, file.gcount())));
  if (file.bad() || !file.eof()) {
    error = content.size() > kMaxFileSize
                ? absl::StrCat(path, " is larger than 1 MB")
                : absl::StrCat(path, " cannot be read");
    return false;
  }
  return true;
}

bool Loader::Load(lua_State* const lua, const char* const name) {
  if (!ReadFile(name)) return false;
  loaded.insert(name);
  const std::string chunk_name = absl::StrCat("@", name);
  // Text only: the interpreter does not verify byte code.
  if (luaL_loadbufferx(lua, content.data(), content.size(), chunk_name.c_str(),
                       "t") == LUA_OK) {
    return true;
  }
  error = lua_type(lua, -1) == LUA_TSTRING ? lua_tostring(lua, -1) : "";
  lua_pop(lua, 1);
  return false;
}

// Counts all memory ever allocated, not memory in use, to bound the time too.
void* Allocate(void* const user_data, void* const block, const size_t old_size,
               const size_t new_size) {
  if (new_size == 0) {
    std::free(block);
    return nullptr;
  }
  if (block == nullptr || new_size > old_size) {
    Loader& loader = *static_cast<Loader*>(user_data);
    if (new_size > kMaxAllocated - loader.allocated) return nullptr;
    loader.allocated += new_size;
  }
  return std::realloc(block, new_size);
}

void StopRunning(lua_State* const lua, lua_Debug*) {
  luaL_error(lua, "runs for more than %d instructions", kMaxInstructions);
}

// `include "other.lua"`
int Include(lua_State* const lua) {
  Loader* const loader =
      static_cast<Loader*>(lua_touserdata(lua, lua_upvalueindex(1)));
  luaL_checktype(lua, 1, LUA_TSTRING);
  const char* const name = lua_tostring(lua, 1);
  if (loader->IsLoaded(name)) return 0;
  if (!loader->Load(lua, name)) {
    return luaL_error(lua, "%s", loader->error.c_str());
  }
  lua_call(lua, 0, 0);
  return 0;
}

// Removes all other keys from the table on top of the stack, and pops it.
template <size_t kSize>
void KeepOnly(lua_State* const lua, const std::string_view (&names)[kSize]) {
  lua_pushnil(lua);
  while (lua_next(lua, -2) != 0) {
    lua_pop(lua, 1);
    if (std::find(std::begin(names), std::end(names), lua_tostring(lua, -1)) ==
        std::end(names)) {
      lua_pushvalue(lua, -1);
      lua_pushnil(lua);
      lua_rawset(lua, -4);
    }
  }
  lua_pop(lua, 1);
}

// Runs in protected mode; leaves the file's result on the stack.
int RunFile(lua_State* const lua) {
  Loader* const loader = static_cast<Loader*>(lua_touserdata(lua, 1));
  luaL_requiref(lua, "_G", luaopen_base, 1);
  KeepOnly(lua, kBaseFunctions);
  luaL_requiref(lua, "math", luaopen_math, 1);
  KeepOnly(lua, kMathFunctions);
  luaL_requiref(lua, "string", luaopen_string, 1);
  KeepOnly(lua, kStringFunctions);
  luaL_requiref(lua, "table", luaopen_table, 1);
  KeepOnly(lua, kTableFunctions);
  lua_pushlightuserdata(lua, loader);
  lua_pushcclosure(lua, Include, 1);
  lua_setglobal(lua, "include");

  if (!loader->Load(lua, loader->basename.c_str())) {
    lua_pushstring(lua, loader->error.c_str());
    return lua_error(lua);
  }
  lua_sethook(lua, StopRunning, LUA_MASKCOUNT, kMaxInstructions);
  lua_call(lua, 0, 1);
  return 1;
}

std::string DescribeError(lua_State* const lua, const int status) {
  if (status == LUA_ERRMEM) return "needs more than 16 MB of memory";
  if (lua_type(lua, -1) != LUA_TSTRING) return "calls error() without a text";
  return PrintableLine(lua_tostring(lua, -1));
}

// Converts Lua values with calls that cannot raise.
class Converter {
 public:
  explicit Converter(lua_State* const lua) : lua_(lua) {}

  // Adds the value on top of the stack under `path`.
  [[nodiscard]] bool Add(const std::string& path);

  std::map<std::string, LuaValue> values;
  std::string error;

 private:
  bool AddFields(const std::string& path);
  bool Fail(const std::string& path, const std::string& reason) {
    error = absl::StrCat(PrintableLine(path), " ", reason);
    return false;
  }

  lua_State* const lua_;
  int depth_ = 0;
  size_t size_ = 0;
};

bool Converter::Add(const std::string& path) {
  size_ += 1 + path.size();
  if (size_ > kMaxConfigurationSize)
    return Fail(path, "is too much to be a configuration");
  LuaValue& value = values[path];
  switch (lua_type(lua_, -1)) {
    case LUA_TBOOLEAN:
      value = lua_toboolean(lua_, -1) != 0;
      return true;
    case LUA_TNUMBER: {
      const double number = lua_tonumber(lua_, -1);
      value = number;
      return std::isfinite(number) || Fail(path, "must be a finite number");
    }
    case LUA_TSTRING: {
      size_t size = 0;
      const char* const text = lua_tolstring(lua_, -1, &size);
      if (size > kMaxConfigurationSize) return Fail(path, "is too long a text");
      size_ += size;
      value = std::string(text, size);
      return true;
    }
    case LUA_TTABLE:
      return AddFields(path);
    default:
      return Fail(path, absl::StrCat("must not be a ",
                                     lua_typename(lua_, lua_type(lua_, -1))));
  }
}

bool Converter::AddFields(const std::string& path) {
  if (depth_ == kMaxDepth || !lua_checkstack(lua_, 4)) {
    return Fail(path, "is nested too deeply or contains itself");
  }
  ++depth_;
  lua_pushnil(lua_);
  while (lua_next(lua_, -2) != 0) {
    if (lua_type(lua_, -2) != LUA_TSTRING) {
      return Fail(path, absl::StrCat("has a key that is a ",
                                     lua_typename(lua_, lua_type(lua_, -2)),
                                     "; keys must be names"));
    }
    size_t size = 0;
    const char* const key = lua_tolstring(lua_, -2, &size);
    if (size > kMaxConfigurationSize) return Fail(path, "has too long a key");
    const std::string name(key, size);
    const std::string field = absl::StrCat(path, ".", name);
    if (name.find('.') != std::string::npos) {
      return Fail(field, "is no option: keys must be names without dots");
    }
    if (!Add(field)) return false;
    lua_pop(lua_, 1);
  }
  --depth_;
  return true;
}

}  // namespace

std::string PrintableLine(const std::string_view text) {
  std::string line(text.substr(0, kMaxMessageLength));
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text.size() > kMaxMessageLength ? line + "..." : line;
}

absl::StatusOr<LuaDictionary> LoadLuaDictionary(
    const std::vector<std::string>& directories, const std::string& basename,
    const std::string& name) {
  Loader loader;
  loader.directories = directories;
  loader.basename = basename;
  if (!loader.Find(basename)) return absl::NotFoundError(loader.error);
  const std::string path = loader.path;
  const std::string prefix = absl::StrCat("configuration file ", path, ": ");

  const std::unique_ptr<lua_State, decltype(&lua_close)> lua(
      lua_newstate(Allocate, &loader), &lua_close);
  if (lua == nullptr) return absl::ResourceExhaustedError("no memory for Lua");
  lua_pushcfunction(lua.get(), RunFile);
  lua_pushlightuserdata(lua.get(), &loader);
  const int status = lua_pcall(lua.get(), 1, 1, 0);
  if (status != LUA_OK) {
    return absl::InvalidArgumentError(prefix +
                                      DescribeError(lua.get(), status));
  }
  if (lua_type(lua.get(), -1) != LUA_TTABLE) {
    return absl::InvalidArgumentError(
        absl::StrCat(prefix, "must return a table, e.g. `return ", name, "`"));
  }
  Converter converter(lua.get());
  if (!converter.Add(name)) {
    return absl::InvalidArgumentError(prefix + converter.error);
  }
  return LuaDictionary{path, std::move(converter.values)};
}

}  // namespace cartographer_sdf
