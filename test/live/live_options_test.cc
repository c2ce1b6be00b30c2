// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/live_options.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/paths.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::live_options_test {
namespace {

using ::testing::HasSubstr;

TEST(LiveOptionsTest, ShippedFileEqualsTheDefaults) {
  const auto options =
      LoadLiveOptions({kTestConfigurationDirectory}, "sdf_live.lua");
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(FormatLiveOptions(*options), FormatLiveOptions(LiveOptions()));
}

TEST(LiveOptionsTest, UsersOverrideTheShippedFile) {
  testing::TemporaryDirectory directory;
  directory.Write(
      "mine.lua",
      "include \"sdf_live.lua\"\nSDF_LIVE.enabled = false\n"
      "SDF_LIVE.localization.query_interval_meters = 9.\nreturn SDF_LIVE\n");
  const auto options = LoadLiveOptions(
      {directory.path(), kTestConfigurationDirectory}, "mine.lua");
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_FALSE(options->enabled);
  EXPECT_EQ(options->localization.query_interval_meters, 9.);
}

TEST(LiveOptionsTest, SaysWhatIsWrong) {
  testing::TemporaryDirectory directory;
  const auto error_of = [&directory](const std::string& line) {
    directory.Write("mine.lua", "include \"sdf_live.lua\"\n" + line +
                                    "\nreturn SDF_LIVE\n");
    const auto options = LoadLiveOptions(
        {directory.path(), kTestConfigurationDirectory}, "mine.lua");
    return std::string(options.status().message());
  };
  EXPECT_THAT(error_of("SDF_LIVE.enbled = true"), HasSubstr("enbled"));
  EXPECT_THAT(
      error_of("SDF_LIVE.localization.localizer.placement.min_lead = -1."),
      HasSubstr("min_lead must not be negative"));
  EXPECT_THAT(error_of("SDF_LIVE.match.method = \"paper\""),
              HasSubstr("match.method"));
  EXPECT_THAT(error_of("SDF_LIVE.min_index_gap = 0"),
              HasSubstr("min_index_gap must be positive"));
}

}  // namespace
}  // namespace cartographer_sdf::live_options_test
