// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// relocalize --scan as a user runs it.

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/json.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/drawn_map.h"
#include "test/testing/program.h"
#include "test/testing/temporary_directory.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::scan_localization_test {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

const Rigid2 kTruth(12.2, 3.1, 1.);

std::string ScanText(const RobotScan& scan) {
  Json points = Json::array();
  for (const Eigen::Vector2f& point : scan.scan.returns) {
    points.push_back({point.x(), point.y()});
  }
  return Json{{"points", points}}.dump();
}

// As map_saver writes it, with the origin at the lower left.
std::string PgmText(const OccupancyGrid& grid) {
  const Eigen::Array2i& size = grid.geometry.size;
  std::string text = "P5\n" + std::to_string(size.x()) + " " +
                     std::to_string(size.y()) + "\n255\n";
  for (int j = size.y() - 1; j >= 0; --j) {
    for (int i = 0; i < size.x(); ++i) {
      text += static_cast<char>(!grid.known(i, j)               ? 205
                                : grid.probability(i, j) > 0.5f ? 0
                                                                : 254);
    }
  }
  return text;
}

class ScanLocalizationTest : public ::testing::Test {
 protected:
  ScanLocalizationTest() {
    const OccupancyGrid grid = testing::TwoRoomsGrid();
    const Eigen::Vector2d& origin = grid.geometry.T_submap_grid.translation();
    directory_.Write("rooms.pgm", PgmText(grid));
    map_ = directory_.Write("rooms.yaml",
                            "image: rooms.pgm\nresolution: 0.05\norigin: [" +
                                std::to_string(origin.x()) + ", " +
                                std::to_string(origin.y()) +
                                ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
                                "free_thresh: 0.196\n");
    scan_ = directory_.Write(
        "scan.json", ScanText(testing::ScanFrom(testing::TwoRooms(), kTruth)));
  }
  [[nodiscard]] std::string File(const std::string& name) const {
    return directory_.File(name);
  }
  [[nodiscard]] Json ParseFile(const std::string& name) const {
    return Json::parse(directory_.Read(name));
  }
  testing::TemporaryDirectory directory_;
  std::string map_, scan_;
};

TEST_F(ScanLocalizationTest, FindsTheRobotInAMapOfRos) {
  const ProgramResult result =
      RunTestProgram({"relocalize", "--map", map_, "--scan", scan_, "--result",
                      File("found.json"), "--report", File("report")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("localized: x 12."), HasSubstr("elsewhere")));
  const Json json = ParseFile("found.json")["scans"].at(0);
  EXPECT_TRUE(json["localized"]);
  EXPECT_NEAR(json["T_map_robot"]["x"], kTruth.translation().x(), 0.06);
  EXPECT_NEAR(json["T_map_robot"]["y"], kTruth.translation().y(), 0.06);
  EXPECT_NEAR(json["T_map_robot"]["yaw"], kTruth.rotation(), 0.02);
  EXPECT_THAT(json["candidates"], SizeIs(Ge(1u)));
  double sum = json["elsewhere_probability"];
  for (const Json& candidate : json["candidates"]) {
    sum += candidate["probability"].get<double>();
    EXPECT_THAT(candidate["covariance"], SizeIs(3));
  }
  EXPECT_NEAR(sum, 1., 1e-9);
  const std::string page = directory_.Read("report/index.html");
  EXPECT_THAT(page, AllOf(HasSubstr("scan.json"), HasSubstr("Candidate 1"),
                          HasSubstr("data:image/png;base64,")));
}

TEST_F(ScanLocalizationTest, SeveralFilesAreSeveralRobots) {
  const std::string other = directory_.Write(
      "other.json", ScanText(testing::ScanFrom(testing::BareRoom(2.5, 1.7),
                                               Rigid2(0.3, 0.2, 0.5))));
  const ProgramResult result =
      RunTestProgram({"relocalize", "--map", File("rooms.pgm"), "--scan",
                      scan_ + "," + other, "--result", File("found.json")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const Json json = ParseFile("found.json")["scans"];
  ASSERT_THAT(json, SizeIs(2));
  EXPECT_EQ(json[0]["scan"], scan_);
  EXPECT_TRUE(json[0]["localized"]);
  EXPECT_FALSE(json[1]["localized"]);
  EXPECT_TRUE(json[1]["T_map_robot"].is_null());
  EXPECT_THAT(result.output, HasSubstr("not localized: "));
}

TEST_F(ScanLocalizationTest, WhereTooLittleIsSeenNothingIsSaidOfElsewhere) {
  const std::string few =
      directory_.Write("few.json", R"({"points": [[1, 0], [0, 1]]})");
  const ProgramResult result = RunTestProgram(
      {"relocalize", map_, "--scan", few, "--result", File("few_found.json")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr("too_little_seen"));
  EXPECT_THAT(result.output, ::testing::Not(HasSubstr("elsewhere")));
  const Json json = ParseFile("few_found.json")["scans"].at(0);
  EXPECT_TRUE(json["elsewhere_probability"].is_null());
  EXPECT_TRUE(json["candidates"].empty());
}

TEST_F(ScanLocalizationTest, FindsTheRobotInAMapOfCartographer) {
  const std::string map = File("office.pbstream");
  const std::string drive = File("drive.pbstream");
  const FloorPlan plan = testing::MakeSmallOffice(1);
  testing::WriteShortDrive(plan, 1, map);
  testing::WriteShortDrive(plan, 2, drive);
  const auto clouds = ReadPointClouds(drive, {{0, 40}});
  ASSERT_TRUE(clouds.ok()) << clouds.status();
  RobotScan scan;
  scan.scan.returns = clouds->begin()->second;
  const std::string path = directory_.Write("node.json", ScanText(scan));
  const ProgramResult result = RunTestProgram(
      {"relocalize", "--map", map, "--scan", path, "--result", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const Json json = Json::parse(result.output)["scans"].at(0);
  EXPECT_THAT(json["verdict"], AnyOf("localized", "uncertain"));
  EXPECT_THAT(json["candidates"], SizeIs(Ge(1u)));
}

TEST_F(ScanLocalizationTest, MistakesAreErrorsOfOneLine) {
  const auto expect_error = [](const std::vector<std::string>& arguments,
                               const int exit_code, const std::string& part) {
    std::vector<std::string> all = {"relocalize"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult result = RunTestProgram(all);
    EXPECT_EQ(result.exit_code, exit_code) << result.error;
    EXPECT_THAT(result.error, HasSubstr(part));
    EXPECT_EQ(result.error.find('\n'), result.error.size() - 1) << result.error;
  };
  const std::string bad = directory_.Write("bad.json", "{\"points\": 3}");
  expect_error({"--map", map_}, 2, "--scan");
  expect_error({"--map", map_, "--scan", scan_, "--query", scan_}, 2,
               "--query does not go with --scan");
  expect_error({"--map", map_, "--scan", scan_, "--first_seconds", "3"}, 2,
               "--first_seconds does not go with --scan");
  expect_error({"--map", map_, "--scan", scan_ + "," + scan_, "--report",
                File("report")},
               2, "single --scan");
  expect_error({"--map", map_, "--scan", bad}, 1, "not a list");
  expect_error({"--map", map_, "--scan", File("absent")}, 1, "absent");
  expect_error({"--map", File("absent.yaml"), "--scan", scan_}, 1, "absent");
  expect_error({"--map", bad, "--scan", scan_}, 1, "bad.json");
  const std::string bare = directory_.Write(
      "bare.yaml", "image: bare.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  directory_.Write("bare.pgm", "P2\n2 2\n255\n254 254 254 254\n");
  expect_error({"--map", bare, "--scan", scan_}, 1, "no wall");
}

}  // namespace
}  // namespace cartographer_sdf::scan_localization_test
