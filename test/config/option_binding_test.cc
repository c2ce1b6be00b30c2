// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/option_binding.h"

#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::option_binding_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

enum class Method { kSdf, kPaper };

std::vector<std::pair<std::string, Method>> OptionNames(Method) {
  return {{"sdf", Method::kSdf}, {"paper", Method::kPaper}};
}

struct FeatureOptions {
  double radius_meters = 1.5;
  int num_bins = 16;
  std::vector<double> rings = {0.5, 1.};
};

template <typename Visitor>
void VisitOptions(Visitor& visit, FeatureOptions& options) {
  visit("radius_meters", options.radius_meters);
  visit("num_bins", options.num_bins);
  visit("rings", options.rings);
}

std::string Validate(const FeatureOptions& options) {
  return options.radius_meters > 0. ? "" : "radius_meters must be positive";
}

struct TestOptions {
  FeatureOptions feature;
  bool enabled = true;
  std::string name = "x";
  Method method = Method::kSdf;
};

template <typename Visitor>
void VisitOptions(Visitor& visit, TestOptions& options) {
  visit("feature", options.feature);
  visit("enabled", options.enabled);
  visit("name", options.name);
  visit("method", options.method);
}

std::string Validate(const TestOptions& options) {
  return options.name.empty() ? "name must not be empty" : "";
}

constexpr char kGood[] = R"(
    T = { feature = { radius_meters = 2.5, num_bins = 8, rings = {1, 2, 3} },
          enabled = false, name = "hello", method = "paper" }
    )";

class OptionBindingTest : public ::testing::Test {
 protected:
  absl::StatusOr<TestOptions> Read(const std::string& code) {
    directory_.Write("t.lua", code);
    const auto dictionary =
        LoadLuaDictionary({directory_.path()}, "t.lua", "T");
    EXPECT_TRUE(dictionary.ok()) << dictionary.status();
    if (!dictionary.ok()) return dictionary.status();
    return ReadOptions<TestOptions>(*dictionary);
  }
  // Without the path of the file, of a good table that is changed by `change`.
  std::string ErrorOf(const std::string& change) {
    const auto options = Read(kGood + change + " return T");
    EXPECT_FALSE(options.ok()) << change;
    const std::string message(options.status().message());
    const std::string prefix =
        "configuration file " + directory_.File("t.lua") + ": ";
    EXPECT_EQ(message.substr(0, prefix.size()), prefix);
    return message.substr(prefix.size());
  }

  testing::TemporaryDirectory directory_;
};

TEST_F(OptionBindingTest, ReadsEveryType) {
  const auto options = Read(std::string(kGood) + "return T");
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(options->feature.radius_meters, 2.5);
  EXPECT_EQ(options->feature.num_bins, 8);
  EXPECT_THAT(options->feature.rings, ElementsAre(1., 2., 3.));
  EXPECT_FALSE(options->enabled);
  EXPECT_EQ(options->name, "hello");
  EXPECT_EQ(options->method, Method::kPaper);
}

TEST_F(OptionBindingTest, NamesMissingKeys) {
  EXPECT_EQ(ErrorOf("T.feature.num_bins = nil"),
            "T.feature.num_bins is missing");
  EXPECT_EQ(ErrorOf("T.feature = nil"), "T.feature is missing");
}

TEST_F(OptionBindingTest, NamesUnknownKeys) {
  EXPECT_EQ(ErrorOf("T.feature.zzz = 1"), "T.feature.zzz is not an option");
  EXPECT_EQ(ErrorOf("T.feature.num_bin = 8 T.feature.num_bins = nil"),
            "T.feature.num_bin is not an option, did you mean 'num_bins'?");
  EXPECT_EQ(ErrorOf("T = {1, 2}"), "T must have named keys, it is a list");
}

TEST_F(OptionBindingTest, NamesWrongTypes) {
  EXPECT_EQ(ErrorOf("T.feature.radius_meters = true"),
            "T.feature.radius_meters must be a number, it is a boolean");
  EXPECT_EQ(ErrorOf("T.feature.radius_meters = '2'"),
            "T.feature.radius_meters must be a number, it is a string");
  EXPECT_EQ(ErrorOf("T.feature.num_bins = 3.5"),
            "T.feature.num_bins must be an integer, it is 3.5");
  EXPECT_EQ(ErrorOf("T.feature.num_bins = 1e10"),
            "T.feature.num_bins must be an integer, it is 1e+10");
  EXPECT_EQ(ErrorOf("T.enabled = 1"),
            "T.enabled must be true or false, it is a number");
  EXPECT_EQ(ErrorOf("T.name = {}"), "T.name must be a string, it is a table");
  EXPECT_EQ(ErrorOf("T.feature = 3"),
            "T.feature must be a table, it is a number");
  EXPECT_EQ(ErrorOf("T.feature.rings = {1, 'x'}"),
            "T.feature.rings[2] must be a number, it is a string");
  EXPECT_EQ(ErrorOf("T.feature.rings = {a = 1}"),
            "T.feature.rings must be a list of numbers");
}

TEST_F(OptionBindingTest, NamesWrongValues) {
  EXPECT_EQ(ErrorOf("T.method = 'papr'"),
            "T.method must be one of 'sdf', 'paper', it is 'papr'");
  EXPECT_EQ(ErrorOf("T.feature.radius_meters = 0"),
            "T.feature.radius_meters must be positive");
  EXPECT_EQ(ErrorOf("T.name = ''"), "T.name must not be empty");
}

TEST_F(OptionBindingTest, WritesWhatItReads) {
  TestOptions options;
  options.feature.radius_meters = 0.1 + 0.2;
  options.feature.rings = {};
  options.name =
      "quote \" back \\ line\nNUL \001"
      "9 umlaut \xc3\xbc";
  options.method = Method::kPaper;
  const std::string text = FormatOptions("T", options);
  const auto read = Read(text + "return T");
  ASSERT_TRUE(read.ok()) << read.status() << text;
  EXPECT_EQ(read->feature.radius_meters, options.feature.radius_meters);
  EXPECT_EQ(read->name, options.name);
  EXPECT_EQ(FormatOptions("T", *read), text);
}

TEST_F(OptionBindingTest, WritesLuaForPeople) {
  EXPECT_EQ(FormatOptions("T", TestOptions()), R"(T = {
  feature = {
    radius_meters = 1.5,
    num_bins = 16,
    rings = {0.5, 1},
  },
  enabled = true,
  name = "x",
  method = "sdf",
}
)");
}

}  // namespace
}  // namespace cartographer_sdf::option_binding_test
