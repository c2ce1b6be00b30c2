// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/options.h"

#include <array>
#include <string>
#include <vector>

#include "cartographer_sdf/config/option_keys.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/paths.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf {
namespace {

using ::testing::HasSubstr;

constexpr char kBasename[] = "sdf_global_constraints.lua";

TEST(OptionsTest, ShippedFileEqualsTheDefaults) {
  const auto options = LoadOptions({kTestConfigurationDirectory}, kBasename);
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(FormatOptions(*options), FormatOptions(Options()));
}

TEST(OptionsTest, PaperPresetEqualsTheNamedDefaults) {
  const auto options = LoadOptions({kTestConfigurationDirectory}, "paper.lua");
  ASSERT_TRUE(options.ok()) << options.status();
  Options paper;
  paper.loop_closing.place = PaperPlaceOptions();
  paper.loop_closing.match = PaperMatchOptions();
  EXPECT_EQ(FormatOptions(*options), FormatOptions(paper));
}

// Sets the weight of one key to 1, all others to 0.
struct OneWeight {
  int wanted;
  std::vector<std::string> keys;
  void operator()(const char* const key, double& weight) {
    weight = static_cast<int>(keys.size()) == wanted ? 1. : 0.;
    keys.emplace_back(key);
  }
};

TEST(OptionsTest, TermsOfTheScoreAreCalledAsTheirWeights) {
  Agreement agreement;
  agreement.query_in_reference = {100., 90., 2., 0.};
  agreement.reference_in_query = {50., 40., 2., 0.};
  agreement.overlap_area = 49.;
  agreement.overlap = 0.7;
  agreement.tiles = {16., 0.95};
  agreement.min_scatter_eigenvalue = 0.16;
  const auto terms = ScoreTerms(agreement, 0.1);
  const auto names = ScoreTermNames();
  for (int k = 0; k != kNumScoreTerms; ++k) {
    ScoreWeights weights;
    OneWeight visit{k, {}};
    VisitOptions(visit, weights);
    ASSERT_EQ(visit.keys.size(), kNumScoreTerms + 1u);
    EXPECT_EQ(names[k], visit.keys[k]);
    EXPECT_EQ(visit.keys.back(), "bias");
    EXPECT_EQ(Score(weights, agreement, 0.1), terms[k]) << names[k];
  }
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
      LoadOptions({directory.path(), kTestConfigurationDirectory}, "mine.lua");
  ASSERT_FALSE(options.ok());
  EXPECT_THAT(std::string(options.status().message()),
              HasSubstr("mine.lua: SDF_GLOBAL_CONSTRAINTS.report."
                        "max_closure_pictures must not be negative"));
}

}  // namespace
}  // namespace cartographer_sdf
