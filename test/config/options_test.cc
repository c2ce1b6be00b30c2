// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/options.h"

#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "cartographer_sdf/config/option_keys.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/paths.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::options_test {
namespace {

using ::testing::HasSubstr;

constexpr char kBasename[] = "sdf_global_constraints.lua";

TEST(OptionsTest, ShippedFileEqualsTheDefaults) {
  const auto options = LoadOptions({kTestConfigurationDirectory}, kBasename);
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(FormatOptions(*options), FormatOptions(Options()));
}

// The number of options that a file of configuration_files/ assigns; a failure
// for each that has no comment above it, its neighbours or its table.
int CountDocumentedOptions(const std::string& basename) {
  std::ifstream file(std::string(kTestConfigurationDirectory) + "/" + basename);
  EXPECT_TRUE(file.good()) << basename;
  int count = 0;
  bool has_comment = false;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos || line[begin] == '}') {
      has_comment = false;
    } else if (line.compare(begin, 2, "--") == 0) {
      has_comment = true;
    } else if (line.compare(begin, 6, "local ") != 0 &&
               line.find(" = ") != std::string::npos && line.back() != '{') {
      EXPECT_TRUE(has_comment) << basename << ":" << number;
      ++count;
    }
  }
  return count;
}

// The keys of the options, without those of the tables around them.
class LeafLister : public OptionVisitor {
 public:
  std::vector<std::string> keys;

 private:
  void Visit(const char* key, double&) override { keys.emplace_back(key); }
  void Visit(const char* key, int&) override { keys.emplace_back(key); }
  void Visit(const char* key, bool&) override { keys.emplace_back(key); }
  void VisitName(const char* key, const std::vector<std::string>&,
                 int&) override {
    keys.emplace_back(key);
  }
  bool Enter(const char*) override { return true; }
  void Leave(const std::string&) override {}
};

TEST(OptionsTest, EachIsInOneShippedFileAndDocumented) {
  Options options;
  LeafLister leaves;
  VisitOptions(leaves, options);
  const int num_for_users = CountDocumentedOptions(kBasename);
  EXPECT_EQ(num_for_users + CountDocumentedOptions("sdf_advanced_options.lua"),
            static_cast<int>(leaves.keys.size()));
  EXPECT_LE(num_for_users, 20);
}

TEST(OptionsTest, PaperPresetEqualsTheNamedDefaults) {
  const auto options = LoadOptions({kTestConfigurationDirectory}, "paper.lua");
  ASSERT_TRUE(options.ok()) << options.status();
  Options paper;
  paper.loop_closing.place = PaperPlaceOptions();
  paper.loop_closing.recognition.match = PaperMatchOptions();
  paper.loop_closing.recognition.use_retrieval = false;
  EXPECT_EQ(FormatOptions(*options), FormatOptions(paper));
}

// Sets the weight of one key to 1, all others to 0.
class OneWeight : public LeafLister {
 public:
  explicit OneWeight(const int wanted) : wanted_(wanted) {}

 private:
  void Visit(const char* const key, double& weight) override {
    weight = static_cast<int>(keys.size()) == wanted_ ? 1. : 0.;
    keys.emplace_back(key);
  }

  const int wanted_;
};

TEST(OptionsTest, TermsOfTheScoreAreCalledAsTheirWeights) {
  PairEvidence evidence;
  evidence.query_in_reference = {100., 90., 2., 0.};
  evidence.reference_in_query = {50., 40., 2., 0.};
  evidence.overlap_area = 49.;
  evidence.overlap = 0.7;
  evidence.tiles = {16., 0.95};
  evidence.normal_scatter = Eigen::Vector2d(0.16, 0.84).asDiagonal();
  const auto terms = ScoreTerms(evidence, 0.1);
  const auto names = ScoreTermNames();
  for (int k = 0; k != kNumScoreTerms; ++k) {
    ScoreWeights weights;
    OneWeight visit(k);
    VisitOptions(visit, weights);
    ASSERT_EQ(visit.keys.size(), kNumScoreTerms + 1u);
    EXPECT_EQ(names[k], visit.keys[k]);
    EXPECT_EQ(visit.keys.back(), "bias");
    EXPECT_EQ(Score(weights, evidence, 0.1), terms[k]) << names[k];
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

TEST(OptionsTest, ListsWhatDiffersFromTheDefaults) {
  EXPECT_TRUE(ChangedOptions(Options()).empty());
  Options options;
  options.report.map_picture_pixels = 777;
  options.loop_closing.recognition.use_retrieval = false;
  const std::vector<ChangedOption> changed = ChangedOptions(options);
  ASSERT_EQ(changed.size(), 2u);
  EXPECT_EQ(changed[0].name, "loop_closing.recognition.use_retrieval");
  EXPECT_EQ(changed[0].value, "false");
  EXPECT_EQ(changed[0].default_value, "true");
  EXPECT_EQ(changed[1].name, "report.map_picture_pixels");
  EXPECT_EQ(changed[1].value, "777");
}

TEST(OptionsTest, PlacesDoNotDependOnTheMemoryOfTheirFields) {
  PlaceOptions options;
  const std::string text = FormatPlaceOptions(options, MatchOptions());
  options.max_field_megabytes = 1.;
  EXPECT_EQ(FormatPlaceOptions(options, MatchOptions()), text);
  options.field.padding_meters = 1.;
  EXPECT_NE(FormatPlaceOptions(options, MatchOptions()), text);
}

TEST(OptionsTest, UsersOverrideTheShippedFile) {
  testing::TemporaryDirectory directory;
  directory.Write("mine.lua",
                  "include \"sdf_global_constraints.lua\"\n"
                  "SDF_GLOBAL_CONSTRAINTS.report.max_submap_pictures = -1\n"
                  "return SDF_GLOBAL_CONSTRAINTS\n");
  const auto options =
      LoadOptions({directory.path(), kTestConfigurationDirectory}, "mine.lua");
  ASSERT_FALSE(options.ok());
  EXPECT_THAT(std::string(options.status().message()),
              HasSubstr("mine.lua: SDF_GLOBAL_CONSTRAINTS.report."
                        "max_submap_pictures must not be negative"));
}

}  // namespace
}  // namespace cartographer_sdf::options_test
