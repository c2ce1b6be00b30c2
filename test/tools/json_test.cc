// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/json.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_sdf {
namespace {

TEST(JsonTest, FormatsValues) {
  EXPECT_EQ(Json(0.5).Format(), "0.5\n");
  EXPECT_EQ(Json(1e9 + 0.25).Format(), "1000000000.25\n");
  EXPECT_EQ(Json(-3).Format(), "-3\n");
  EXPECT_EQ(Json(true).Format(), "true\n");
  EXPECT_EQ(Json::Null().Format(), "null\n");
  EXPECT_EQ(Json(std::nan("")).Format(), "null\n");
  EXPECT_EQ(Json(INFINITY).Format(), "null\n");
  // Not a boolean.
  EXPECT_EQ(Json("text").Format(), "\"text\"\n");
  EXPECT_EQ(Json(std::string("a\"\\\n\xff\x7f")).Format(),
            "\"a\\\"\\\\\\u000a??\"\n");
}

TEST(JsonTest, KeepsTheOrderAndBreaksLongLines) {
  const Json small =
      Json::Object({{"b", 1}, {"a", Json::Array({Json(1), Json("x")})}});
  EXPECT_EQ(small.Format(), "{\"b\": 1, \"a\": [1, \"x\"]}\n");
  EXPECT_EQ(Json::Array({}).Format(), "[]\n");
  EXPECT_EQ(Json::Object({}).Format(), "{}\n");
  const std::string text(99, 'y');
  EXPECT_EQ(Json::Object({{"k", small}, {"l", text}}).Format(),
            "{\n  \"k\": {\"b\": 1, \"a\": [1, \"x\"]},\n  \"l\": \"" + text +
                "\"\n}\n");
}

}  // namespace
}  // namespace cartographer_sdf
