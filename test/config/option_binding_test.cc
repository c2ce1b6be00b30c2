// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/option_binding.h"

#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::option_binding_test {
namespace {

enum class Method { kSdf, kPaper };

std::vector<std::string> OptionNames(Method) { return {"sdf", "paper"}; }

struct FeatureOptions {
  double radius_meters = 1.5;
  int num_bins = 16;
};

void VisitOptions(OptionVisitor& visit, FeatureOptions& options) {
  visit("radius_meters", options.radius_meters);
  visit("num_bins", options.num_bins);
}

std::string Validate(const FeatureOptions& options) {
  return options.radius_meters > 0. ? "" : "radius_meters must be positive";
}

struct TestOptions {
  FeatureOptions feature;
  bool enabled = true;
  Method method = Method::kSdf;
};

void VisitOptions(OptionVisitor& visit, TestOptions& options) {
  visit("feature", options.feature);
  visit("enabled", options.enabled);
  visit("method", options.method);
}

std::string Validate(const TestOptions& options) {
  return options.feature.num_bins < 100 || options.enabled
             ? ""
             : "enabled must be true with so many bins";
}

constexpr char kGood[] = R"(
    T = { feature = { radius_meters = 2.5, num_bins = 8 },
          enabled = false, method = "paper" }
    )";

class OptionBindingTest : public ::testing::Test {
 protected:
  absl::StatusOr<TestOptions> Read(const std::string& code) {
    directory_.Write("t.lua", code);
    return LoadTable<TestOptions>({directory_.path()}, "t.lua", "T");
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
  EXPECT_FALSE(options->enabled);
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
  EXPECT_EQ(ErrorOf("T.feature.zzz = {a = {}}"),
            "T.feature.zzz is not an option");
  EXPECT_EQ(ErrorOf("T.radius_meters = 1"), "T.radius_meters is not an option");
  EXPECT_EQ(ErrorOf("T = {1, 2}"),
            "T has a key that is a number; keys must be names");
  EXPECT_EQ(ErrorOf("T['feature.num_bins'] = 8"),
            "T.feature.num_bins is no option: keys must be names without dots");
}

TEST_F(OptionBindingTest, NamesWrongTypes) {
  EXPECT_EQ(ErrorOf("T.feature.radius_meters = true"),
            "T.feature.radius_meters must be a number, it is a boolean");
  EXPECT_EQ(ErrorOf("T.feature.radius_meters = '2'"),
            "T.feature.radius_meters must be a number, it is a string");
  EXPECT_EQ(ErrorOf("T.feature.num_bins = 3.5"),
            "T.feature.num_bins must be an integer, it is 3.5");
  EXPECT_EQ(ErrorOf("T.feature.num_bins = 1e10"),
            "T.feature.num_bins must lie between -1e9 and 1e9, it is 1e+10");
  EXPECT_EQ(ErrorOf("T.enabled = 1"),
            "T.enabled must be true or false, it is a number");
  EXPECT_EQ(ErrorOf("T.method = {}"),
            "T.method must be a string, it is a table");
  EXPECT_EQ(ErrorOf("T.feature = 3"),
            "T.feature must be a table, it is a number");
}

TEST_F(OptionBindingTest, NamesWrongValues) {
  EXPECT_EQ(ErrorOf("T.method = 'papr'"),
            "T.method must be one of 'sdf', 'paper', it is 'papr'");
  EXPECT_EQ(ErrorOf("T.feature.radius_meters = 0"),
            "T.feature.radius_meters must be positive");
  EXPECT_EQ(ErrorOf("T.feature.num_bins = 100"),
            "T.enabled must be true with so many bins");
}

TEST_F(OptionBindingTest, WritesWhatItReads) {
  TestOptions options;
  options.feature.radius_meters = 0.1 + 0.2;
  options.method = Method::kPaper;
  const std::string text = FormatFile("T", options);
  const auto read = Read(text);
  ASSERT_TRUE(read.ok()) << read.status() << text;
  EXPECT_EQ(read->feature.radius_meters, options.feature.radius_meters);
  EXPECT_EQ(read->method, options.method);
  EXPECT_EQ(FormatFile("T", *read), text);
}

TEST_F(OptionBindingTest, WritesLuaForPeople) {
  EXPECT_EQ(FormatTable("T", TestOptions()), R"(T = {
  feature = {
    radius_meters = 1.5,
    num_bins = 16,
  },
  enabled = true,
  method = "sdf",
}
)");
}

}  // namespace
}  // namespace cartographer_sdf::option_binding_test
