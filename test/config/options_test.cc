// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/options.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf {
namespace {

using ::testing::HasSubstr;

constexpr char kBasename[] = "sdf_global_constraints.lua";

TEST(OptionsTest, ShippedFileEqualsTheDefaults) {
  const auto options = LoadOptions({TEST_CONFIGURATION_DIRECTORY}, kBasename);
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(FormatOptions(*options), FormatOptions(Options()));
}

TEST(OptionsTest, PaperPresetEqualsTheNamedDefaults) {
  const auto options = LoadOptions({TEST_CONFIGURATION_DIRECTORY}, "paper.lua");
  ASSERT_TRUE(options.ok()) << options.status();
  Options paper;
  paper.loop_closing.place = PaperPlaceOptions();
  paper.loop_closing.match = PaperMatchOptions();
  EXPECT_EQ(FormatOptions(*options), FormatOptions(paper));
}

TEST(OptionsTest, ReadsWhatItWrites) {
  Options options;
  options.report.map_picture_pixels = 777;
  testing::TemporaryDirectory directory;
  directory.Write("mine.lua", FormatOptions(options));
  const auto read = LoadOptions({directory.path()}, "mine.lua");
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->report.map_picture_pixels, 777);
}

TEST(OptionsTest, UsersOverrideTheShippedFile) {
  testing::TemporaryDirectory directory;
  directory.Write("mine.lua",
                  "include \"sdf_global_constraints.lua\"\n"
                  "SDF_GLOBAL_CONSTRAINTS.report.max_closure_pictures = -1\n"
                  "return SDF_GLOBAL_CONSTRAINTS\n");
  const auto options =
      LoadOptions({directory.path(), TEST_CONFIGURATION_DIRECTORY}, "mine.lua");
  ASSERT_FALSE(options.ok());
  EXPECT_THAT(std::string(options.status().message()),
              HasSubstr("mine.lua: SDF_GLOBAL_CONSTRAINTS.report."
                        "max_closure_pictures must not be negative"));
}

}  // namespace
}  // namespace cartographer_sdf
