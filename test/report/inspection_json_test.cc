// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspection_json.h"

#include <limits>

#include "absl/strings/escaping.h"
#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/inspected_rooms.h"

namespace cartographer_sdf::inspection_json_test {
namespace {

ReportRequest TestRequest() {
  ReportRequest request;
  request.changed_options = {{"a.b.min_score", "5", "4"}};
  request.run = {"cartographer_sdf",
                 "0.1.0",
                 "abc",
                 "close_loops",
                 {"map.pbstream"},
                 "2026-11-27T03:05:01Z",
                 {{"input", "map.pbstream", 12, "50b5"}}};
  return request;
}

TEST(InspectionJsonTest, SharesItsWordsWithTheFileOfResult) {
  const testing::InspectedRooms rooms;
  const Json json = ToJson(TestRequest(), rooms.inspection);
  EXPECT_EQ(json["schema"], "cartographer_sdf.inspection");
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_EQ(json["program"], Json({{"name", "cartographer_sdf"},
                                   {"version", "0.1.0"},
                                   {"commit", "abc"}}));
  EXPECT_EQ(json["command"]["name"], "close_loops");
  EXPECT_EQ(json["command"]["arguments"], Json({"map.pbstream"}));
  EXPECT_EQ(json["inputs"][0]["sha256"], "50b5");
  EXPECT_EQ(json["inputs"][0]["bytes"], 12);
  EXPECT_EQ(json["changed_options"][0]["default"], "4");
  EXPECT_EQ(json["verdict"]["sentence"], "They are joined.");
  EXPECT_EQ(json["verdict"]["tone"], "neutral");
}

TEST(InspectionJsonTest, HasTheMapInOneFrame) {
  testing::InspectedRooms rooms;
  ASSERT_TRUE(rooms.Draw().ok());
  const Json json = ToJson(TestRequest(), rooms.inspection);
  EXPECT_EQ(json["frame"]["width"], rooms.inspection.drawn.width);
  ASSERT_EQ(json["states"].size(), 2u);
  EXPECT_EQ(json["states"][1]["label"], "After");
  ASSERT_EQ(json["submaps"].size(), 2u);
  const Json& second = json["submaps"][1];
  EXPECT_EQ(second["trajectory"], 1);
  EXPECT_EQ(second["T_map_submap"][0]["x"], 9.);
  EXPECT_EQ(second["T_map_submap"][1]["x"], 4.1);
  std::string png;
  const auto data = second["picture"]["data"].get<std::string>();
  ASSERT_TRUE(absl::Base64Unescape(data.substr(data.find(',') + 1), &png));
  EXPECT_EQ(DecodePng(png).width, second["picture"]["width"]);
  ASSERT_EQ(json["paths"].size(), 2u);
  EXPECT_EQ(json["paths"][1]["seconds"], Json({0., 5.}));
  EXPECT_NE(json["paths"][0]["color"], json["paths"][1]["color"]);
  EXPECT_EQ(json["paths"][1]["positions"][0], Json({{9., 0.25}, {9.5, 0.25}}));
  EXPECT_EQ(json["paths"][1]["positions"][1], Json({{4.1, 0.25}, {4.6, 0.25}}));
}

TEST(InspectionJsonTest, HasEachNumberWithItsBound) {
  testing::InspectedRooms rooms;
  ASSERT_TRUE(rooms.Draw().ok());
  const Json json = ToJson(TestRequest(), rooms.inspection);
  const Json& table = json["tables"][0];
  const Json& measure = table["measures"][0];
  EXPECT_EQ(measure["bound"], "at_least");
  EXPECT_EQ(measure["threshold"], 4.);
  EXPECT_EQ(measure["option"], "a.b.min_score");
  const Json& row = table["rows"][0];
  EXPECT_EQ(row["status"], "in_graph");
  EXPECT_EQ(row["reference"], 0);
  EXPECT_EQ(row["query"], 1);
  EXPECT_EQ(row["T_reference_query"]["x"], 4.1);
  EXPECT_TRUE(row["p_reference_overlap"].is_array());
  // One digit more than it is shown with.
  EXPECT_EQ(row["values"], Json::array({12.35}));
  EXPECT_EQ(table["statuses"][0]["tone"], "good");
}

TEST(InspectionJsonTest, ConstraintsAreThoseOfTheList) {
  testing::InspectedRooms rooms;
  rooms.inspection.tables[0].rows[0].constraints = {7};
  rooms.inspection.constraints[7] = {{0, 3}, {1, 44}, true};
  const Json json = ToJson(TestRequest(), rooms.inspection);
  EXPECT_EQ(json["tables"][0]["rows"][0]["constraints"],
            Json::array({{{"constraint", 7},
                          {"submap_trajectory", 0},
                          {"submap_index", 3},
                          {"node_trajectory", 1},
                          {"node_index", 44},
                          {"dropped", true}}}));
}

TEST(InspectionJsonTest, NumbersThatAreNoneAreNull) {
  testing::InspectedRooms rooms;
  InspectedTable& table = rooms.inspection.tables[0];
  table.rows.push_back(table.rows[0]);
  table.rows[0].values = {std::nullopt};
  table.rows[1].values = {std::numeric_limits<double>::quiet_NaN()};
  rooms.after.submap_poses.erase({1, 0});
  const Json json = ToJson(TestRequest(), rooms.inspection);
  EXPECT_EQ(json["tables"][0]["rows"][0]["values"], Json::array({nullptr}));
  EXPECT_EQ(json["tables"][0]["rows"][1]["values"], Json::array({nullptr}));
  EXPECT_EQ(json["submaps"][1]["T_map_submap"][1], nullptr);
  EXPECT_EQ(json["frame"], nullptr);
}

TEST(InspectionJsonTest, LongPathsAreThinnedButKeepTheirEnds) {
  testing::InspectedRooms rooms;
  for (int k = 0; k < 50000; ++k) {
    rooms.after.nodes[{0, k}].T_map_node = Rigid2(0.01 * k, 0., 0.);
  }
  const Json json = ToJson(TestRequest(), rooms.inspection);
  const Json& positions = json["paths"][0]["positions"][1];
  EXPECT_LT(positions.size(), 7000u);
  EXPECT_GT(positions.size(), 3000u);
  EXPECT_EQ(positions.back()[0], 499.99);
  EXPECT_EQ(positions.size(), json["paths"][0]["seconds"].size());
}

TEST(InspectionJsonTest, ChangesAreThoseOfTheFileOfResult) {
  testing::InspectedRooms rooms;
  rooms.inspection.changes = {
      {"appeared",
       Eigen::AlignedBox2d(Eigen::Vector2d(1., 2.), Eigen::Vector2d(3., 4.)),
       0.5}};
  EXPECT_EQ(ToJson(TestRequest(), rooms.inspection)["changes"],
            Json::array({{{"kind", "appeared"},
                          {"x_min", 1.},
                          {"y_min", 2.},
                          {"x_max", 3.},
                          {"y_max", 4.},
                          {"wall_area", 0.5}}}));
}

TEST(InspectionJsonTest, PhasesAreThoseOfTheNodes) {
  testing::InspectedRooms rooms;
  rooms.inspection.phases = {{"searching", "located"},
                             {{{0, 0}, 0}, {{0, 1}, 1}}};
  const Json json = ToJson(TestRequest(), rooms.inspection);
  EXPECT_EQ(json["paths"][0]["phases"], Json({0, 1}));
  EXPECT_EQ(json["paths"][1]["phases"], Json::array());
}

}  // namespace
}  // namespace cartographer_sdf::inspection_json_test
