// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What glass, thin walls, table legs, people and the unknown do to the field
// and its keypoints, and that a place with them is recognised all the same: a
// test map for each. How often on whole drives: scripts/measure_hard_places.py.

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "cartographer_sdf/grid/scan_grid.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/simulation/floor_plan.h"
#include "cartographer_sdf/simulation/lidar.h"
#include "cartographer_sdf/simulation/people.h"
#include "gtest/gtest.h"
#include "test/testing/keypoint_repeatability.h"

namespace cartographer_sdf::hard_places_test {
namespace {

using Eigen::Vector2d;

constexpr double kPartition = 7.;  // x of the wall between the rooms [m]

// Two rooms of 6 m and 5 m x 6 m, without furniture symmetries; the wall
// between them has a door and the given thickness.
FloorPlan TwoRooms(const double thickness = 0.15) {
  FloorPlan plan = EmptyFloorPlan({13., 8.}, 0.025);
  FillRectangle({6.5, 4.}, {14., 9.}, 0., true, &plan);
  FillRectangle({6.5, 4.}, {11., 6.}, 0., false, &plan);
  FillRectangle({kPartition, 4.}, {thickness, 6.}, 0., true, &plan);
  FillRectangle({kPartition, 5.6}, {1., 1.1}, 0., false, &plan);
  FillRectangle({1.5, 3.}, {0.6, 1.4}, 0., true, &plan);
  FillRectangle({4.6, 1.3}, {1.6, 0.5}, 0., true, &plan);
  FillRectangle({10.2, 6.7}, {2., 0.5}, 0., true, &plan);
  FillDisc({9.4, 2.8}, 0.35, &plan);
  return plan;
}

using PeopleAtScan = std::function<std::vector<Person>(int)>;

// What a robot saw that went from the west room through the door, or back, in
// its own frame: that of the start.
struct Drive {
  Rigid2 T_world_submap;
  OccupancyGrid grid;
};

Drive GoThrough(const FloorPlan& plan, const bool back, const uint32_t seed,
                const LidarOptions& lidar = {},
                const PeopleAtScan& people_at = {}) {
  const std::vector<Vector2d> way = {
      {3.4, 3.}, {4.8, 5.4}, {8.4, 5.5}, {10.6, 3.6}};
  constexpr int kScansPerLeg = 20;
  RandomNumbers random(seed, RandomStream::kLidar);
  std::vector<Rigid2> poses;
  for (size_t leg = 0; leg + 1 != way.size(); ++leg) {
    const Vector2d step = (way[leg + 1] - way[leg]) / kScansPerLeg;
    for (int k = 0; k != kScansPerLeg; ++k) {
      poses.emplace_back(way[leg] + k * step + Vector2d(0., back ? 0.13 : 0.),
                         std::atan2(step.y(), step.x()) + (back ? M_PI : 0.));
    }
  }
  Drive drive;
  drive.T_world_submap = back ? poses.back() : poses.front();
  std::vector<PlacedScan> scans;
  for (size_t k = 0; k != poses.size(); ++k) {
    scans.push_back({drive.T_world_submap.Inverse() * poses[k],
                     TakeScan(plan,
                              people_at ? people_at(static_cast<int>(k))
                                        : std::vector<Person>(),
                              poses[k], lidar, &random)});
  }
  drive.grid = DrawScans(ScanGridOptions(), scans);
  return drive;
}

Place Describe(const Drive& drive, const int index) {
  return *DescribePlace(PlaceOptions(), {0, index}, drive.grid);
}

double OccupancyAt(const Drive& drive, const Vector2d& p_world) {
  const Eigen::Array2i cell =
      drive.grid.geometry.CellAt(drive.T_world_submap.Inverse() * p_world);
  if (!drive.grid.geometry.Contains(cell) ||
      !drive.grid.known(cell.x(), cell.y())) {
    return std::nan("");
  }
  return drive.grid.probability(cell.x(), cell.y());
}

// Most of the cells across the partition south of the door, where it is surely
// seen.
double PartitionOccupancy(const Drive& drive) {
  double sum = 0.;
  int rows = 0;
  for (double y = 2.; y < 4.; y += 0.05, ++rows) {
    double most = 0.;
    for (double x = kPartition - 0.15; x < kPartition + 0.15; x += 0.025) {
      most = std::fmax(most, OccupancyAt(drive, {x, y}));
    }
    sum += most;
  }
  return sum / rows;
}

struct Recognition {
  double repeatability = 0.;
  bool accepted = false;
  double translation_error = 0.;  // [m]
  double rotation_error = 0.;     // [rad]
};

Recognition Recognise(const Drive& there, const Drive& back) {
  const Place reference = Describe(there, 0), query = Describe(back, 9);
  const Rigid2 T_reference_query =
      there.T_world_submap.Inverse() * back.T_world_submap;
  testing::KeypointRepeatability repeatability;
  testing::AddKeypointRepeatability(reference, query, T_reference_query,
                                    &repeatability);
  Recognition result;
  result.repeatability = static_cast<double>(repeatability.Total().num_found) /
                         repeatability.Total().num_judged;
  const std::optional<Match> match =
      MatchPlaces(MatchOptions(), reference, query);
  if (!match.has_value()) return result;
  result.accepted = match->verdict == Verdict::kAccepted;
  const Rigid2 error =
      T_reference_query.Inverse() * match->pair.T_reference_query;
  result.translation_error = error.translation().norm();
  result.rotation_error = std::abs(error.rotation());
  return result;
}

void ExpectRecognised(const Recognition& recognition,
                      const double least_repeatability) {
  EXPECT_GT(recognition.repeatability, least_repeatability);
  EXPECT_TRUE(recognition.accepted);
  // Two cells, and what they are at the rooms' far ends.
  EXPECT_LT(recognition.translation_error, 0.1);
  EXPECT_LT(recognition.rotation_error, 0.02);
}

TEST(HardPlacesTest, PlainRoomsAreRecognised) {
  const FloorPlan plan = TwoRooms();
  const Drive there = GoThrough(plan, false, 1);
  EXPECT_GT(PartitionOccupancy(there), 0.7);
  ExpectRecognised(Recognise(there, GoThrough(plan, true, 2)), 0.6);
}

TEST(HardPlacesTest, ThinWallsStayWalls) {
  // One cell of the map, and seen from both sides.
  const FloorPlan plan = TwoRooms(0.05);
  const Drive there = GoThrough(plan, false, 1);
  EXPECT_GT(PartitionOccupancy(there), 0.6);
  ExpectRecognised(Recognise(there, GoThrough(plan, true, 2)), 0.5);
}

TEST(HardPlacesTest, GlassFadesWithItsEcho) {
  FloorPlan plan = TwoRooms();
  MakeGlass({kPartition, 4.}, {0.2, 6.}, 0., &plan);
  LidarOptions lidar;
  lidar.glass_echo = 0.5;
  const Drive there = GoThrough(plan, false, 1, lidar);
  EXPECT_GT(PartitionOccupancy(there), 0.5);
  ExpectRecognised(Recognise(there, GoThrough(plan, true, 2, lidar)), 0.5);
  // Nearly clear: free space where the pane is, for all that the map knows.
  lidar.glass_echo = 0.02;
  const Drive clear = GoThrough(plan, false, 1, lidar);
  EXPECT_LT(PartitionOccupancy(clear), 0.5);
  ExpectRecognised(Recognise(clear, GoThrough(plan, true, 2, lidar)), 0.5);
}

TEST(HardPlacesTest, TableLegsAreSmallWalls) {
  FloorPlan plan = TwoRooms();
  const std::vector<Vector2d> legs = {{8.4, 4.},  {8.4, 2.8},  {5.6, 2.6},
                                      {5.6, 3.8}, {10.6, 2.2}, {3., 5.4}};
  for (const Vector2d& leg : legs) {
    FillRectangle(leg, {0.05, 0.05}, 0., true, &plan);
  }
  const Drive there = GoThrough(plan, false, 1);
  int num_kept = 0;
  for (const Vector2d& leg : legs) {
    double most = 0.;
    for (const double x : {-0.05, 0., 0.05}) {
      for (const double y : {-0.05, 0., 0.05}) {
        most = std::fmax(most, OccupancyAt(there, leg + Vector2d(x, y)));
      }
    }
    num_kept += most > 0.5;
  }
  EXPECT_GE(num_kept, 4);
  ExpectRecognised(Recognise(there, GoThrough(plan, true, 2)), 0.5);
}

TEST(HardPlacesTest, WalkersLeaveNoTraceStandersDo) {
  const FloorPlan plan = TwoRooms();
  const Vector2d place(9.6, 4.6);
  // Across the east room, five times.
  const auto walker = [](const int scan) {
    return std::vector<Person>{
        {{8. + 0.2 * (scan % 12), 3.4 + 0.1 * (scan % 12)}, 0.2}};
  };
  const auto stander = [&](int) { return std::vector<Person>{{place, 0.2}}; };
  const Drive walked = GoThrough(plan, false, 1, {}, walker);
  const Drive stood = GoThrough(plan, false, 1, {}, stander);
  double most_walked = 0., most_stood = 0.;
  for (double angle = 0.; angle < 2. * M_PI; angle += 0.2) {
    const Vector2d rim =
        place + 0.19 * Vector2d(std::cos(angle), std::sin(angle));
    most_walked = std::fmax(most_walked, OccupancyAt(walked, rim));
    most_stood = std::fmax(most_stood, OccupancyAt(stood, rim));
  }
  EXPECT_LT(most_walked, 0.5);
  EXPECT_GT(most_stood, 0.6);
  // Who stood there is gone on the way back.
  const Drive back = GoThrough(plan, true, 2);
  ExpectRecognised(Recognise(walked, back), 0.5);
  ExpectRecognised(Recognise(stood, back), 0.5);
}

TEST(HardPlacesTest, NoKeypointLiesInTheUnknown) {
  // Who sees 2.5 m and 120 degrees leaves pockets.
  const FloorPlan plan = TwoRooms();
  LidarOptions lidar;
  lidar.max_range = 2.5;
  lidar.field_of_view = 2. * M_PI / 3.;
  const Drive there = GoThrough(plan, false, 1, lidar);
  const Drive all = GoThrough(plan, false, 2);
  EXPECT_LT(5 * there.grid.known.count(), 4 * all.grid.known.count());
  const Place place = Describe(there, 0);
  const SurfaceModel& surface = place.surface;
  ASSERT_GT(place.features.features.size(), 10u);
  for (const Feature& feature : place.features.features) {
    const Eigen::Array2i cell =
        surface.geometry.CellAt(feature.keypoint.position);
    ASSERT_TRUE(surface.geometry.Contains(cell));
    EXPECT_TRUE((*surface.cells.Pin())(cell.x(), cell.y()).observed);
  }
  // Half of what one sees of a place may be all that there is to go by: no
  // promise but that the answer, if accepted, is right.
  const Recognition recognition = Recognise(there, all);
  if (recognition.accepted) ExpectRecognised(recognition, 0.2);
  EXPECT_GT(recognition.repeatability, 0.2);
}

}  // namespace
}  // namespace cartographer_sdf::hard_places_test
