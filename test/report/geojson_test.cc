// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/geojson.h"

#include <cmath>
#include <vector>

#include "cartographer_sdf/report/json.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::geojson_test {
namespace {

// Two nodes, 100 m apart along x, and a submap between them.
PoseGraph SmallGraph() {
  PoseGraph graph;
  graph.nodes[{2, 0}].T_map_node = Rigid2(0., 0., 1.);
  graph.nodes[{2, 1}].T_map_node = Rigid2(100., 0., 0.);
  graph.submap_poses[{2, 0}] = Rigid2(50., 10., 0.);
  Constraint constraint;
  constraint.submap = {2, 0};
  constraint.node = {2, 1};
  constraint.tag = Constraint::Tag::kIntraSubmap;
  graph.constraints.push_back(constraint);
  constraint.tag = Constraint::Tag::kInterSubmap;
  graph.constraints.push_back(constraint);
  constraint.node = {2, 7};  // that the graph lacks
  graph.constraints.push_back(constraint);
  return graph;
}

Json FeaturesOf(const PoseGraph& graph, const GeoOrigin& origin) {
  return Json::parse(FormatGeoJson(graph, origin))["features"];
}

TEST(GeoJsonTest, HasPathsAndClosures) {
  const Json features = FeaturesOf(SmallGraph(), {});
  ASSERT_EQ(features.size(), 2u);
  EXPECT_EQ(features[0]["properties"]["kind"], "path");
  EXPECT_EQ(features[0]["properties"]["trajectory"], 2);
  EXPECT_EQ(features[0]["properties"]["length_meters"], 100.);
  EXPECT_EQ(features[1]["properties"]["kind"], "closure");
  EXPECT_EQ(features[1]["properties"]["submap"]["index"], 0);
  EXPECT_EQ(features[1]["properties"]["node"]["index"], 1);
  EXPECT_TRUE(FeaturesOf({}, {}).empty());
}

// A degree of latitude is 110,574 m at the equator and 111,412 m at 60 degrees,
// one of longitude 111,320 m and 55,800 m; by the ellipsoid, to a metre.
TEST(GeoJsonTest, LiesOnTheEarth) {
  constexpr double kDegreeOfLatitude[] = {110574., 111412.};
  constexpr double kDegreeOfLongitude[] = {111320., 55800.};
  for (const int k : {0, 1}) {
    const double latitude = 60. * k;
    const Json east = FeaturesOf(SmallGraph(), {latitude, 10., 0.});
    const auto end = east[0]["geometry"]["coordinates"][1];
    EXPECT_NEAR((end[0].get<double>() - 10.) * kDegreeOfLongitude[k], 100.,
                1e-3);
    EXPECT_NEAR(end[1].get<double>(), latitude, 1e-9);
    const Json north = FeaturesOf(SmallGraph(), {latitude, 10., 90.});
    const auto up = north[0]["geometry"]["coordinates"][1];
    EXPECT_NEAR(up[0].get<double>(), 10., 1e-9);
    EXPECT_NEAR((up[1].get<double>() - latitude) * kDegreeOfLatitude[k], 100.,
                1e-3);
  }
}

}  // namespace
}  // namespace cartographer_sdf::geojson_test
