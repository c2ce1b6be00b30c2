// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <string>

#include "cartographer_sdf/report/json.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::export_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::SmallMap;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class ExportTest : public ::testing::Test {
 protected:
  ExportTest()
      : map_(directory_.Write("a.pbstream", Container(SmallMap().Records()))) {}

  ProgramResult Run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"export", map_});
    return RunTestProgram(arguments);
  }
  std::string File(const std::string& name) { return directory_.File(name); }

  const testing::TemporaryDirectory directory_;
  const std::string map_;
};

TEST_F(ExportTest, WritesAMapForRos) {
  const ProgramResult result = Run({"--map_filestem", File("m")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(directory_.Read("m.pgm"), StartsWith("P5\n"));
  EXPECT_THAT(directory_.Read("m.yaml"),
              AllOf(StartsWith("image: \"m.pgm\"\n"), HasSubstr("origin: ["),
                    HasSubstr("negate: 0\n")));
  EXPECT_EQ(Run({"--pgm", File("n.pgm"), "--yaml", File("o")}).exit_code, 0);
  EXPECT_EQ(directory_.Read("n.pgm"), directory_.Read("m.pgm"));
  EXPECT_THAT(directory_.Read("o"), StartsWith("image: \"n.pgm\"\n"));
  EXPECT_EQ(Run({"--png", File("m.png")}).exit_code, 0);
  EXPECT_THAT(directory_.Read("m.png"), StartsWith("\x89PNG"));
}

TEST_F(ExportTest, WritesGeoJson) {
  const ProgramResult result =
      Run({"--geojson", "-", "--geojson_origin", "47.5,11.1,90"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const Json json = Json::parse(result.output);
  EXPECT_EQ(json["type"], "FeatureCollection");
  EXPECT_EQ(json["features"][0]["properties"]["kind"], "path");
}

TEST_F(ExportTest, SaysWhatItCannotDo) {
  EXPECT_EQ(Run({}).exit_code, 2);
  EXPECT_EQ(Run({"--pgm", "-"}).exit_code, 2);
  EXPECT_EQ(Run({"--yaml", File("y"), "--png", File("p")}).exit_code, 2);
  EXPECT_EQ(Run({"--geojson", "-", "--geojson_origin", "95,0"}).exit_code, 2);
  EXPECT_EQ(Run({"--geojson", "-", "--geojson_origin", "x"}).exit_code, 2);
  const ProgramResult fine =
      Run({"--pgm", File("m.pgm"), "--resolution", "0.0001"});
  EXPECT_EQ(fine.exit_code, 1);
  EXPECT_THAT(fine.error, HasSubstr("finer than the cells"));
  // The YAML file is checked as all others.
  directory_.Write("b.yaml", Container(SmallMap().Records()));
  const ProgramResult lost = Run({"--pgm", File("b.pgm")});
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.error, HasSubstr("it is a map"));
}

}  // namespace
}  // namespace cartographer_sdf::export_test
