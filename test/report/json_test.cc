// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/json.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_sdf::json_test {
namespace {

TEST(JsonTest, IndentsAndKeepsTheOrder) {
  const Json json = {{"b", 1},
                     {"a", {{"list", {1, "x"}}, {"yes", true}}},
                     {"none", nullptr},
                     {"empty", Json::array()}};
  EXPECT_EQ(FormatJson(json),
            "{\n"
            "  \"b\": 1,\n"
            "  \"a\": {\n"
            "    \"list\": [\n"
            "      1,\n"
            "      \"x\"\n"
            "    ],\n"
            "    \"yes\": true\n"
            "  },\n"
            "  \"none\": null,\n"
            "  \"empty\": []\n"
            "}\n");
}

TEST(JsonTest, TextInUtf8StaysAsItIs) {
  // Of two, three and four bytes, in values and in names.
  EXPECT_EQ(FormatJson("B\xc3\xbcro \xe6\x97\xa5 \xf0\x9f\x97\xba.pbstream"),
            "\"B\xc3\xbcro \xe6\x97\xa5 \xf0\x9f\x97\xba.pbstream\"\n");
  EXPECT_EQ(FormatJson({{"gr\xc3\xbc\xc3\x9f", 1}}),
            "{\n  \"gr\xc3\xbc\xc3\x9f\": 1\n}\n");
}

TEST(JsonTest, OtherBytesBecomeReplacementCharacters) {
  // Not a first byte; cut off; overlong; a surrogate.
  EXPECT_EQ(FormatJson("a\xff.log"), "\"a\xef\xbf\xbd.log\"\n");
  EXPECT_EQ(FormatJson("\xc3"), "\"\xef\xbf\xbd\"\n");
  for (const char* const text : {"\xc0\xaf", "\xed\xa0\x80"}) {
    const std::string formatted = FormatJson(text);
    EXPECT_NE(formatted.find("\xef\xbf\xbd"), std::string::npos) << formatted;
    EXPECT_TRUE(Json::accept(formatted)) << formatted;
  }
}

TEST(JsonTest, QuotesAndControlCharactersAreEscaped) {
  const std::string text("a\"b\\c\n\t\x01\0d", 10);
  const std::string formatted = FormatJson(text);
  EXPECT_EQ(formatted, "\"a\\\"b\\\\c\\n\\t\\u0001\\u0000d\"\n");
  EXPECT_EQ(Json::parse(formatted), text);
}

TEST(JsonTest, NumbersAreExactOrNull) {
  for (const double number : {0.1, -3., 1e9 + 0.25, M_PI, 1e-300, 5e-324,
                              std::numeric_limits<double>::max()}) {
    EXPECT_EQ(Json::parse(FormatJson(number)).get<double>(), number);
  }
  EXPECT_EQ(FormatJson(0.5), "0.5\n");
  EXPECT_EQ(FormatJson(int64_t{9007199254740993}), "9007199254740993\n");
  EXPECT_EQ(FormatJson(std::nan("")), "null\n");
  EXPECT_EQ(FormatJson(INFINITY), "null\n");
  EXPECT_EQ(FormatJson({{"yaw", -INFINITY}}), "{\n  \"yaw\": null\n}\n");
}

TEST(JsonTest, WritesPosesIdsAndWhatMayBeAbsent) {
  EXPECT_EQ(ToJson(Rigid2(1., -2.5, 0.25)).dump(),
            R"({"x":1.0,"y":-2.5,"yaw":0.25})");
  EXPECT_EQ(ToJson(SubmapId{1, 7}).dump(), R"({"trajectory":1,"index":7})");
  EXPECT_EQ(ToJson(std::make_optional(Rigid2(1., -2.5, 0.25))),
            ToJson(Rigid2(1., -2.5, 0.25)));
  EXPECT_EQ(ToJson(std::make_optional(0.5)), 0.5);
  EXPECT_EQ(ToJson(std::make_optional<std::string>("x")), "x");
  EXPECT_EQ(ToJson(std::optional<Rigid2>()), nullptr);
  EXPECT_EQ(ToJson(std::optional<double>()), nullptr);
}

TEST(JsonTest, WhatWasNotComparedIsNotKnown) {
  const Json nothing = ToJson(MapQuality());
  EXPECT_EQ(nothing["pairs"], 0);
  for (const char* const name :
       {"hit_ratio", "contradiction_ratio", "wall_distance"}) {
    EXPECT_TRUE(nothing[name].is_null()) << name;
  }
  const Json some = ToJson(MapQuality{3, 0.9, 0.01, 0.04});
  EXPECT_EQ(some["pairs"], 3);
  EXPECT_EQ(some["hit_ratio"], 0.9);
  EXPECT_EQ(some["contradiction_ratio"], 0.01);
  EXPECT_EQ(some["wall_distance"], 0.04);
  // Nor has anything changed or stayed where the query was not found.
  EXPECT_TRUE(ToJson(Localization())["changed_area"].is_null());
}

}  // namespace
}  // namespace cartographer_sdf::json_test
