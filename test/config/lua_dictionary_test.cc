// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/lua_dictionary.h"

#include <cmath>
#include <map>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::lua_dictionary_test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

class LuaDictionaryTest : public ::testing::Test {
 protected:
  absl::StatusOr<LuaDictionary> Load(const std::string& code) {
    directory_.Write("main.lua", code);
    return LoadLuaDictionary({directory_.path()}, "main.lua", "TABLE");
  }
  std::map<std::string, LuaValue> LoadValues(const std::string& code) {
    const absl::StatusOr<LuaDictionary> dictionary = Load(code);
    EXPECT_TRUE(dictionary.ok()) << dictionary.status();
    return dictionary.ok() ? dictionary->values
                           : std::map<std::string, LuaValue>();
  }
  // Checks what all errors share; returns what follows the path of the file.
  std::string LoadError(const std::string& code) {
    const absl::StatusOr<LuaDictionary> dictionary = Load(code);
    EXPECT_FALSE(dictionary.ok()) << code.substr(0, 100);
    if (dictionary.ok()) return "";
    const std::string message(dictionary.status().message());
    EXPECT_THAT(message, Not(HasSubstr("\n")));
    const std::string prefix =
        "configuration file " + directory_.File("main.lua") + ": ";
    EXPECT_THAT(message, StartsWith(prefix));
    EXPECT_LT(message.size(), prefix.size() + 400);
    return message.size() < prefix.size() ? "" : message.substr(prefix.size());
  }

  testing::TemporaryDirectory directory_;
};

TEST_F(LuaDictionaryTest, ReadsAllTypes) {
  const std::map<std::string, LuaValue> values = LoadValues(R"(
      return { angle = math.rad(180.), name = "a" .. "b", yes = true,
               nested = { deeper = { seven = 7 } }, empty = {} })");
  EXPECT_THAT(values, UnorderedElementsAre(
                          Pair("TABLE", LuaValue()),
                          Pair("TABLE.angle", LuaValue(std::acos(-1.))),
                          Pair("TABLE.name", LuaValue(std::string("ab"))),
                          Pair("TABLE.yes", LuaValue(true)),
                          Pair("TABLE.nested", LuaValue()),
                          Pair("TABLE.nested.deeper", LuaValue()),
                          Pair("TABLE.nested.deeper.seven", LuaValue(7.)),
                          Pair("TABLE.empty", LuaValue())));
}

TEST_F(LuaDictionaryTest, IncludesAndOverrides) {
  directory_.Write("base.lua", "BASE = { a = 1, b = { c = 2 } } return BASE");
  const auto values =
      LoadValues("include \"base.lua\"\nBASE.b.c = 3\nreturn BASE");
  EXPECT_EQ(values.at("TABLE.a"), LuaValue(1.));
  EXPECT_EQ(values.at("TABLE.b.c"), LuaValue(3.));
}

TEST_F(LuaDictionaryTest, IncludesEachFileOnce) {
  directory_.Write("a.lua", "include 'b.lua' N = N + 1");
  directory_.Write("b.lua", "include 'a.lua' include 'main.lua' N = N + 10");
  const auto values =
      LoadValues("N = 0 include 'a.lua' include 'a.lua' return {n = N}");
  EXPECT_EQ(values.at("TABLE.n"), LuaValue(11.));
}

TEST_F(LuaDictionaryTest, SearchesDirectoriesInTheirOrder) {
  testing::TemporaryDirectory other;
  directory_.Write("x.lua", "return {x = 1}");
  other.Write("x.lua", "return {x = 2}");
  other.Write("y.lua", "include 'x.lua' return {y = 1}");
  const auto x =
      LoadLuaDictionary({directory_.path(), other.path()}, "x.lua", "X");
  ASSERT_TRUE(x.ok());
  EXPECT_EQ(x->path, directory_.File("x.lua"));
  EXPECT_EQ(x->values.at("X.x"), LuaValue(1.));
  const auto y =
      LoadLuaDictionary({directory_.path(), other.path()}, "y.lua", "Y");
  ASSERT_TRUE(y.ok());
  EXPECT_EQ(y->path, other.File("y.lua"));
}

TEST_F(LuaDictionaryTest, NamesMissingFiles) {
  const auto missing = LoadLuaDictionary({"/nowhere", directory_.path()},
                                         "missing.lua", "TABLE");
  EXPECT_EQ(missing.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(missing.status().message()),
              AllOf(HasSubstr("'missing.lua'"), HasSubstr("/nowhere"),
                    HasSubstr(directory_.path())));
  EXPECT_THAT(LoadError("\ninclude 'missing.lua'"),
              AllOf(HasSubstr("main.lua:2:"), HasSubstr("'missing.lua'")));
}

TEST_F(LuaDictionaryTest, StaysInItsDirectories) {
  EXPECT_THAT(LoadError("include '/etc/passwd'"), HasSubstr("plain name"));
  EXPECT_THAT(LoadError("include '../main.lua'"), HasSubstr("plain name"));
  EXPECT_THAT(LoadError("include '..'"), HasSubstr("in none of"));
  EXPECT_THAT(LoadError("include ''"), HasSubstr("plain name"));
  EXPECT_THAT(LoadError("include {}"), HasSubstr("string expected"));
}

TEST_F(LuaDictionaryTest, ExplainsSyntaxAndRuntimeErrors) {
  EXPECT_THAT(LoadError("return {\n a = = 1 }"), HasSubstr("main.lua:2:"));
  EXPECT_THAT(LoadError("return { a = nothing.b }"), HasSubstr("nothing"));
  EXPECT_THAT(LoadError("error('two\\nlines')"), HasSubstr("two lines"));
  EXPECT_THAT(LoadError("error({})"), HasSubstr("error()"));
  EXPECT_THAT(LoadError("error(12)"), EndsWith("12"));
  EXPECT_THAT(
      LoadError("error(('x'):lower() .. '" + std::string(5000, 'x') + "')"),
      HasSubstr("xxx"));
  directory_.Write("broken.lua", "\n\n)");
  EXPECT_THAT(LoadError("include 'broken.lua'"), HasSubstr("broken.lua:3:"));
}

TEST_F(LuaDictionaryTest, RefusesWhatIsNoTable) {
  for (const std::string code :
       {"", "return", "return 3", "return 'x'", "x = {}", "return nil, {}",
        "return print", "return {}, 1 --[[ fine ]] .. nil"}) {
    LoadError(code);
  }
  EXPECT_THAT(LoadError("return 1"), HasSubstr("return TABLE"));
}

TEST_F(LuaDictionaryTest, RefusesBytesThatAreNoText) {
  LoadError(std::string("\x1bLua\x52\x00\x01\x04\x08\x04\x08\x00", 12));
  LoadError(std::string(1000, '\0'));
  LoadError("\xff\xfe\xfd");
  LoadError(std::string(1 << 21, ' '));
}

TEST_F(LuaDictionaryTest, NamesThePathOfBadValues) {
  EXPECT_EQ(LoadError("return { a = { b = 0/0 } }"),
            "TABLE.a.b must be a finite number");
  EXPECT_THAT(LoadError("return { a = math.huge }"), StartsWith("TABLE.a "));
  EXPECT_THAT(LoadError("return { a = { f = function() end } }"),
              AllOf(StartsWith("TABLE.a.f "), EndsWith("function")));
  EXPECT_THAT(LoadError("return { a = { [true] = 1 } }"),
              AllOf(StartsWith("TABLE.a "), HasSubstr("boolean")));
  EXPECT_THAT(LoadError("return { a = { [2] = 1 } }"), StartsWith("TABLE.a "));
  EXPECT_THAT(LoadError("return { a = { 1, 2, b = 3 } }"),
              StartsWith("TABLE.a has a key that is a number"));
  EXPECT_THAT(LoadError("return { a = { ['b.c'] = 1 } }"),
              AllOf(StartsWith("TABLE.a.b.c "), EndsWith("without dots")));
  EXPECT_THAT(LoadError("return { ['a\\nb'] = 0/0 }"),
              StartsWith("TABLE.a b "));
}

TEST_F(LuaDictionaryTest, EndsWhatWouldNotEnd) {
  EXPECT_THAT(LoadError("while true do end"), HasSubstr("instructions"));
  EXPECT_THAT(LoadError("local function f() return f() end f()"),
              HasSubstr("instructions"));
  EXPECT_THAT(LoadError("local function f() return 1 + f() end f()"),
              HasSubstr("memory"));
  // Nothing may catch the error that ends the loop.
  LoadError("while true do pcall(function() while true do end end) end");
  LoadError("setmetatable({}, {__gc = function() while true do end end})");
  LoadError("x = ('a'):rep(30):find(('a-'):rep(30) .. 'b')");
}

TEST_F(LuaDictionaryTest, LimitsMemory) {
  EXPECT_THAT(LoadError("x = 'x' while true do x = x .. x end"),
              HasSubstr("memory"));
  // Garbage counts.
  const std::string kilobyte(1000, 'x');
  EXPECT_THAT(LoadError("i = 0 while true do i = i + 1 s = '" + kilobyte +
                        "' .. i end"),
              HasSubstr("memory"));
  LoadError("return " + std::string(100000, '{') + std::string(100000, '}'));
}

TEST_F(LuaDictionaryTest, RefusesTablesWithoutEnd) {
  EXPECT_THAT(LoadError("t = {} t.t = t return t"), HasSubstr("nested"));
  EXPECT_THAT(LoadError("t = {} t.u = {t = t} return t"), HasSubstr("nested"));
  // 2^15 tables of 15; and a long string a thousand times.
  EXPECT_THAT(LoadError("t = {} for i = 1, 15 do t = {a = t, b = t} end "
                        "return t"),
              HasSubstr("too much"));
  EXPECT_THAT(
      LoadError("s = 'xxxxxxxx' for i = 1, 10 do s = s .. s end "
                "t = {} for i = 1, 1000 do t['k' .. i] = s end return t"),
      HasSubstr("too much"));
}

TEST_F(LuaDictionaryTest, OffersNothingDangerous) {
  for (const std::string name : {"io",
                                 "os",
                                 "package",
                                 "debug",
                                 "coroutine",
                                 "require",
                                 "module",
                                 "load",
                                 "loadstring",
                                 "loadfile",
                                 "dofile",
                                 "pcall",
                                 "xpcall",
                                 "setmetatable",
                                 "getmetatable",
                                 "rawset",
                                 "collectgarbage",
                                 "print",
                                 "_G",
                                 "math.random",
                                 "math.randomseed",
                                 "string.dump",
                                 "string.rep",
                                 "string.find",
                                 "string.gsub",
                                 "bit32"}) {
    EXPECT_EQ(LoadValues("return { n = " + name + " == nil }").at("TABLE.n"),
              LuaValue(true))
        << name;
  }
}

}  // namespace
}  // namespace cartographer_sdf::lua_dictionary_test
