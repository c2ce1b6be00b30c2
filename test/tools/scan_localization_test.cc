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
using testing::Building;
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
  const auto clouds = ReadPointClouds(drive, {{0, 114}});
  ASSERT_TRUE(clouds.ok()) << clouds.status();
  RobotScan scan;
  scan.scan.returns = clouds->begin()->second;
  const std::string path = directory_.Write("node.json", ScanText(scan));
  const ProgramResult result = RunTestProgram(
      {"relocalize", "--map", map, "--scan", path, "--result", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const Json json = Json::parse(result.output)["scans"].at(0);
  EXPECT_THAT(json["verdict"], AnyOf("localized", "uncertain"));
  ASSERT_THAT(json["candidates"], SizeIs(Ge(1u)));
  EXPECT_GT(json["candidates"][0]["probability"], 0.5);
}

// Of a robot that drives, with odometry that has an origin of its own, and is
// then carried to another pose, which the odometry does not notice.
std::string DriveText(const Building& building,
                      const std::vector<Rigid2>& driven,
                      const std::vector<Rigid2>& carried) {
  Json scans = Json::array();
  const auto add = [&](const Rigid2& T_map_robot,
                       const Rigid2& T_map_odometry) {
    scans.push_back(
        Json::parse(ScanText(testing::ScanFrom(building, T_map_robot))));
    scans.back()["time"] = 100. + static_cast<double>(scans.size());
    scans.back()["odometry"] = ToJson(Rigid2(7., -3., 1.) * T_map_odometry);
  };
  for (const Rigid2& pose : driven) add(pose, pose);
  for (const Rigid2& pose : carried) add(pose, driven.back());
  return scans.dump();
}

TEST_F(ScanLocalizationTest, FollowsADriveAndFindsARobotThatIsCarriedAway) {
  std::vector<Rigid2> driven;
  for (const double x : {0., 0.3, 0.6, 0.6, 0.3, 0., 0.}) {
    driven.emplace_back(2. + x, 1.7, 0.3);
  }
  const std::vector<Rigid2> carried(8, Rigid2(12.2, 3.1, 1.));
  const std::string drive = directory_.Write(
      "drive.json", DriveText(testing::TwoRooms(), driven, carried));
  const ProgramResult result =
      RunTestProgram({"relocalize", "--map", map_, "--scan", drive, "--result",
                      File("found.json"), "--report", File("report")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const Json json = ParseFile("found.json")["scans"].at(0);
  EXPECT_TRUE(json["localized"]);
  EXPECT_EQ(json["state"], "located");
  EXPECT_NEAR(json["T_map_robot"]["x"], carried[0].translation().x(), 0.1);
  EXPECT_NEAR(json["T_map_robot"]["y"], carried[0].translation().y(), 0.1);
  EXPECT_THAT(json["history"], SizeIs(Ge(3u)));
  EXPECT_EQ(json["history"].at(0)["state"], "located");
  EXPECT_NEAR(json["history"].at(0)["T_map_robot"]["x"], 2., 0.1);
  bool was_carried = false;
  for (const Json& step : json["history"]) {
    was_carried |= step["use"] == "carried_away";
  }
  EXPECT_TRUE(was_carried);
  EXPECT_THAT(result.output, HasSubstr("located after 0.0 s and 0.0 m"));
}

TEST_F(ScanLocalizationTest, TakesPartsOfADriveOfCartographer) {
  const std::string map = File("office.pbstream");
  const std::string drive = File("drive.pbstream");
  const FloorPlan plan = testing::MakeSmallOffice(1);
  testing::WriteShortDrive(plan, 1, map);
  testing::WriteShortDrive(plan, 2, drive);
  const ProgramResult result = RunTestProgram(
      {"relocalize", "--map", map, "--scan", drive, "--first_seconds", "8",
       "--num_starts", "3", "--result", File("found.json")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const Json json = ParseFile("found.json")["scans"];
  ASSERT_THAT(json, SizeIs(3));
  EXPECT_EQ(json[0]["start_seconds"], 0.);
  EXPECT_GT(json[2]["start_seconds"], json[1]["start_seconds"]);
  for (const Json& start : json) {
    EXPECT_THAT(start["history"], SizeIs(Ge(1u)));
    for (const Json& step : start["history"]) EXPECT_LE(step["seconds"], 8.);
  }
}

TEST_F(ScanLocalizationTest, AnswersTheSameFromTheSavedPanoramas) {
  std::string map = File("office.pbstream");
  testing::WriteShortDrive(testing::MakeSmallOffice(1), 1, map);
  for (const std::string& any_map : {map_, map}) {
    const std::string places = File(any_map == map ? "a.places" : "b.places");
    const auto run = [&](const std::string& result) {
      const ProgramResult program =
          RunTestProgram({"relocalize", "--map", any_map, "--scan", scan_,
                          "--places", places, "--result", File(result)});
      EXPECT_EQ(program.exit_code, 0) << program.error;
      return program.error;
    };
    EXPECT_EQ(run("drawn.json"), "");
    ASSERT_TRUE(std::filesystem::exists(places));
    EXPECT_EQ(run("read.json"), "");
    const Json drawn = ParseFile("drawn.json")["scans"].at(0);
    const Json read = ParseFile("read.json")["scans"].at(0);
    EXPECT_EQ(drawn["candidates"], read["candidates"]);
    EXPECT_EQ(drawn["reason"], read["reason"]);
    // Broken, and made anew.
    const std::string name = std::filesystem::path(places).filename();
    std::string bytes = directory_.Read(name);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
    directory_.Write(name, bytes);
    EXPECT_THAT(run("again.json"), HasSubstr("--places: "));
    EXPECT_EQ(run("read.json"), "");
    EXPECT_EQ(ParseFile("read.json")["scans"].at(0)["candidates"],
              drawn["candidates"]);
  }
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
               "have no odometry");
  expect_error({"--map", map_, "--scan", scan_, "--output", File("o.pbstream")},
               2, "--output does not go with --scan");
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
