// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/simulated_map.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cartographer_sdf/simulation/office.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::simulated_map_test {
namespace {

using ::testing::HasSubstr;

// Of the default simulation, made once.
const SimulatedMap& DefaultMap() {
  static const SimulatedMap* const kMap =
      new SimulatedMap(*Simulate(MakeOffice({}, 42), SimulationOptions{}, 42));
  return *kMap;
}

// A quick one: a drive of 30 m in 6 m x 6 m.
absl::StatusOr<SimulatedMap> SmallMap(const uint32_t seed) {
  SimulationOptions options;
  options.drive.length = 30.;
  options.num_range_data = 20;
  return Simulate(EmptyFloorPlan({6., 6.}, 0.05), options, seed);
}

// Of the pose in the map that starts at the true first pose: (node by truth <-
// node by local SLAM).
Rigid2 Error(const SimulatedMap& map, const SimulatedNode& node) {
  const Rigid2 T_world_local =
      map.nodes[0].T_world_node * map.nodes[0].T_local_node.Inverse();
  return node.T_world_node.Inverse() * T_world_local * node.T_local_node;
}

std::string ReadFile(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

TEST(SimulatedMapTest, HasTheShapeOfAStockMap) {
  const SimulatedMap& map = DefaultMap();
  EXPECT_GE(map.submaps.size(), 20u);
  EXPECT_LE(map.submaps.size(), 35u);
  ASSERT_EQ(map.nodes.size(), 60 * (map.submaps.size() + 1));
  for (size_t k = 0; k != map.submaps.size(); ++k) {
    EXPECT_EQ(map.submaps[k].first_node, 60 * static_cast<int>(k));
    EXPECT_EQ(map.submaps[k].end_node, 60 * static_cast<int>(k) + 120);
    EXPECT_EQ(map.submaps[k].T_local_submap.rotation(), 0.);
    // 25 m^2.
    EXPECT_GT(map.submaps[k].grid.known.count(), 10000);
  }
  for (size_t k = 1; k != map.nodes.size(); ++k) {
    const double seconds =
        1e-7 * static_cast<double>(map.nodes[k].time - map.nodes[k - 1].time);
    EXPECT_GE(seconds, 0.05);
    EXPECT_LE(seconds, 1.);
    const Rigid2 T_previous_node =
        map.nodes[k - 1].T_world_node.Inverse() * map.nodes[k].T_world_node;
    // The motion filter, and one time step more.
    EXPECT_LE(T_previous_node.translation().norm(), 0.2 + 0.5 * 0.05);
    EXPECT_LE(std::abs(T_previous_node.rotation()),
              10. * M_PI / 180. + 0.8 * 0.05);
    EXPECT_GE(map.nodes[k].points.size(), 50u);
    EXPECT_LE(map.nodes[k].points.size(), 360u);
  }
  EXPECT_LE(map.odometry.front().time, map.nodes.front().time);
  EXPECT_GE(map.odometry.back().time, map.nodes.back().time);
  for (size_t k = 1; k != map.odometry.size(); ++k) {
    EXPECT_GT(map.odometry[k].time, map.odometry[k - 1].time);
  }
}

TEST(SimulatedMapTest, DriftsByMetresOverTheDriveButNotWithinASubmap) {
  for (const uint32_t seed : {42, 43}) {
    const SimulatedMap map =
        seed == 42 ? DefaultMap()
                   : *Simulate(MakeOffice({}, seed), SimulationOptions{}, seed);
    double largest = 0., yaw = 0.;
    for (const SimulatedNode& node : map.nodes) {
      const Rigid2 error = Error(map, node);
      largest = std::max(largest, error.translation().norm());
      yaw = std::max(yaw, std::abs(error.rotation()));
    }
    EXPECT_GT(largest, 1.5) << seed;
    EXPECT_LT(largest, 6.) << seed;
    // 0.5 mrad/m over 350 m, and three sigmas of its random walk.
    EXPECT_NEAR(yaw, 0.175, 0.03) << seed;

    std::vector<double> errors;
    for (const SimulatedSubmap& submap : map.submaps) {
      const SimulatedNode& middle =
          map.nodes[(submap.first_node + submap.end_node) / 2];
      for (int k = submap.first_node; k != submap.end_node; ++k) {
        errors.push_back(
            ((middle.T_local_node.Inverse() * map.nodes[k].T_local_node)
                 .translation() -
             (middle.T_world_node.Inverse() * map.nodes[k].T_world_node)
                 .translation())
                .norm());
      }
    }
    std::sort(errors.begin(), errors.end());
    // A cell.
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.05) << seed;
    EXPECT_GT(errors[errors.size() / 2], 0.004) << seed;
  }
}

TEST(SimulatedMapTest, LoopsAreVisiblyOpen) {
  // Nodes at one place more than two minutes apart: where the map shows them.
  const SimulatedMap& map = DefaultMap();
  double largest = 0.;
  for (size_t a = 0; a < map.nodes.size(); a += 5) {
    for (size_t b = a; b < map.nodes.size(); b += 5) {
      const SimulatedNode &first = map.nodes[a], &second = map.nodes[b];
      const Rigid2 T_first_second =
          first.T_world_node.Inverse() * second.T_world_node;
      if (second.time - first.time < 1'200'000'000 ||
          T_first_second.translation().norm() > 1.) {
        continue;
      }
      const Eigen::Vector2d mapped =
          (first.T_local_node.Inverse() * second.T_local_node).translation();
      largest =
          std::max(largest, (mapped - T_first_second.translation()).norm());
    }
  }
  EXPECT_GT(largest, 1.);
  EXPECT_LT(largest, 8.);
}

TEST(SimulatedMapTest, SubmapsFitThePlanAtTheirTruePoses) {
  const FloorPlan plan = MakeOffice({}, 42);
  for (const SimulatedSubmap& submap : DefaultMap().submaps) {
    const OccupancyGrid& grid = submap.grid;
    int walls = 0, on_wall = 0, free = 0, in_free = 0;
    for (int j = 0; j != grid.geometry.size.y(); ++j) {
      for (int i = 0; i != grid.geometry.size.x(); ++i) {
        if (!grid.known(i, j)) continue;
        const Eigen::Array2i centre = plan.geometry.CellAt(
            submap.T_world_submap * grid.geometry.CellCentre({i, j}));
        // 0.15 m: what a submap bends by, half a cell and the noise.
        bool near_wall = false;
        for (int y = -6; y <= 6; ++y) {
          for (int x = -6; x <= 6; ++x) {
            const Eigen::Array2i cell = centre + Eigen::Array2i(x, y);
            near_wall |= plan.geometry.Contains(cell) &&
                         plan.occupied(cell.x(), cell.y());
          }
        }
        if (grid.probability(i, j) > 0.6f) {
          ++walls;
          on_wall += near_wall;
        } else if (grid.probability(i, j) < 0.4f) {
          ++free;
          in_free += plan.geometry.Contains(centre) &&
                     !plan.occupied(centre.x(), centre.y());
        }
      }
    }
    EXPECT_GT(walls, 200);
    EXPECT_GT(on_wall, 0.97 * walls);
    EXPECT_GT(in_free, 0.97 * free);
  }
}

TEST(SimulatedMapTest, IntraConstraintsAgreeWithPoses) {
  const SimulatedMap& map = DefaultMap();
  const std::string path = ::testing::TempDir() + "constraints.pbstream";
  ASSERT_TRUE(WriteSimulatedMap(map, path, path + ".truth.csv").ok());
  const absl::StatusOr<MapState> state = ReadMap(path);
  ASSERT_TRUE(state.ok()) << state.status();
  const std::vector<Constraint>& constraints = state->pose_graph.constraints;
  ASSERT_EQ(constraints.size(), 120 * map.submaps.size());
  std::vector<int> num_submaps(map.nodes.size());
  for (const Constraint& constraint : constraints) {
    EXPECT_EQ(constraint.tag, Constraint::Tag::kIntraSubmap);
    EXPECT_EQ(constraint.translation_weight, 500.);
    EXPECT_EQ(constraint.rotation_weight, 1600.);
    const SimulatedSubmap& submap = map.submaps[constraint.submap.index];
    const SimulatedNode& node = map.nodes[constraint.node.index];
    const Rigid2 error =
        (submap.T_local_submap * constraint.T_submap_node).Inverse() *
        node.T_local_node;
    EXPECT_NEAR(error.translation().norm(), 0., 1e-9);
    EXPECT_NEAR(error.rotation(), 0., 1e-9);
    ++num_submaps[constraint.node.index];
  }
  EXPECT_EQ(*std::min_element(num_submaps.begin(), num_submaps.end()), 1);
  EXPECT_EQ(*std::max_element(num_submaps.begin(), num_submaps.end()), 2);
  for (const SimulatedSubmap& submap : map.submaps) {
    const SimulatedNode& first = map.nodes[submap.first_node];
    // The first node is where its submap is, in the map and in the world.
    EXPECT_NEAR(
        (submap.T_world_submap.translation() - first.T_world_node.translation())
            .norm(),
        0., 1e-9);
    EXPECT_NEAR(NormalizeAngle(first.T_world_node.rotation() -
                               submap.T_world_submap.rotation() -
                               first.T_local_node.rotation()),
                0., 1e-9);
  }
}

TEST(SimulatedMapTest, ReadsBackAsWritten) {
  const SimulatedMap& map = DefaultMap();
  const std::string path = ::testing::TempDir() + "simulated_map.pbstream";
  const std::string truth_path = ::testing::TempDir() + "simulated_map.csv";
  ASSERT_TRUE(WriteSimulatedMap(map, path, truth_path).ok());
  int num_grids = 0;
  const absl::StatusOr<MapState> state =
      ReadMap(path, {[&](const SubmapId& id, const SubmapSummary& summary,
                         const OccupancyGrid& grid) {
                ++num_grids;
                const SimulatedSubmap& submap = map.submaps[id.index];
                EXPECT_TRUE(summary.finished);
                EXPECT_EQ(summary.num_range_data, 120);
                ASSERT_EQ(grid.known.rows(), submap.grid.known.rows());
                ASSERT_EQ(grid.known.cols(), submap.grid.known.cols());
                EXPECT_TRUE((grid.known == submap.grid.known).all());
                // The file's step of probability.
                EXPECT_LT((grid.known.cast<float>() *
                           (grid.probability - submap.grid.probability))
                              .abs()
                              .maxCoeff(),
                          0.8f / 32766.f);
                EXPECT_NEAR((grid.geometry.CellCentre({0, 0}) -
                             submap.grid.geometry.CellCentre({0, 0}))
                                .norm(),
                            0., 1e-6);
              }});
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(num_grids, static_cast<int>(map.submaps.size()));
  EXPECT_EQ(state->format_version, 2);
  EXPECT_EQ(state->trajectories.size(), 1u);
  EXPECT_EQ(state->num_records.at("odometry_data"),
            static_cast<int>(map.odometry.size()));
  EXPECT_EQ(state->pose_graph.submap_poses.size(), map.submaps.size());
  EXPECT_EQ(state->pose_graph.constraints.size(), 120 * map.submaps.size());
  ASSERT_EQ(state->pose_graph.nodes.size(), map.nodes.size());
  for (const auto& [id, node] : state->pose_graph.nodes) {
    const SimulatedNode& expected = map.nodes[id.index];
    EXPECT_EQ(node.time, expected.time);
    for (const Rigid2& T : {node.T_map_node, *node.T_local_node}) {
      const Rigid2 error = expected.T_local_node.Inverse() * T;
      EXPECT_NEAR(error.translation().norm(), 0., 1e-9);
      EXPECT_NEAR(error.rotation(), 0., 1e-9);
    }
    EXPECT_EQ(node.T_previous_node_by_odometry.has_value(), id.index != 0);
  }
  const NodeId some_node{0, 100};
  const auto clouds = ReadPointClouds(path, {some_node});
  ASSERT_TRUE(clouds.ok()) << clouds.status();
  EXPECT_EQ(clouds->at(some_node).size(), map.nodes[100].points.size());
}

TEST(SimulatedMapTest, WritesTheTruth) {
  const absl::StatusOr<SimulatedMap> map = SmallMap(42);
  ASSERT_TRUE(map.ok()) << map.status();
  const std::string truth_path = ::testing::TempDir() + "truth.csv";
  ASSERT_TRUE(WriteSimulatedMap(*map, ::testing::TempDir() + "truth.pbstream",
                                truth_path)
                  .ok());
  std::ifstream file(truth_path);
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "kind,trajectory,index,x,y,yaw");
  size_t num_submaps = 0, num_nodes = 0;
  while (std::getline(file, line)) {
    int index = 0;
    double x = 0., y = 0., yaw = 0.;
    Rigid2 expected;
    if (std::sscanf(line.c_str(), "submap,0,%d,%lf,%lf,%lf", &index, &x, &y,
                    &yaw) == 4) {
      ASSERT_EQ(index, num_submaps);
      expected = map->submaps[num_submaps++].T_world_submap;
    } else {
      ASSERT_EQ(std::sscanf(line.c_str(), "node,0,%d,%lf,%lf,%lf", &index, &x,
                            &y, &yaw),
                4);
      ASSERT_EQ(index, num_nodes);
      expected = map->nodes[num_nodes++].T_world_node;
    }
    EXPECT_NEAR(x, expected.translation().x(), 1e-8);
    EXPECT_NEAR(y, expected.translation().y(), 1e-8);
    EXPECT_NEAR(yaw, expected.rotation(), 1e-8);
  }
  EXPECT_EQ(num_submaps, map->submaps.size());
  EXPECT_EQ(num_nodes, map->nodes.size());
}

TEST(SimulatedMapTest, SameSeedSameBytesOtherSeedOther) {
  const std::string directory = ::testing::TempDir();
  std::string maps[3], truths[3];
  for (int k = 0; k != 3; ++k) {
    const absl::StatusOr<SimulatedMap> map = SmallMap(k == 2 ? 7 : 42);
    ASSERT_TRUE(map.ok()) << map.status();
    const std::string name = directory + "bytes_" + std::to_string(k);
    ASSERT_TRUE(
        WriteSimulatedMap(*map, name + ".pbstream", name + ".csv").ok());
    maps[k] = ReadFile(name + ".pbstream");
    truths[k] = ReadFile(name + ".csv");
  }
  EXPECT_GT(maps[0].size(), 1000u);
  EXPECT_TRUE(maps[0] == maps[1]);
  EXPECT_TRUE(truths[0] == truths[1]);
  EXPECT_FALSE(maps[0] == maps[2]);
  EXPECT_FALSE(truths[0] == truths[2]);
}

TEST(SimulatedMapTest, FailedWritesLeaveNothingBehind) {
  const absl::StatusOr<SimulatedMap> map = SmallMap(42);
  ASSERT_TRUE(map.ok()) << map.status();
  const std::string directory = ::testing::TempDir() + "failed_writes";
  std::filesystem::remove_all(directory);
  std::filesystem::create_directory(directory);
  const std::string missing = directory + "/missing/file";
  EXPECT_THAT(
      std::string(WriteSimulatedMap(*map, directory + "/a.pbstream", missing)
                      .message()),
      HasSubstr(missing));
  EXPECT_THAT(
      std::string(
          WriteSimulatedMap(*map, missing, directory + "/a.csv").message()),
      HasSubstr(missing));
  EXPECT_FALSE(
      WriteSimulatedMap(*map, directory + "/a", directory + "/a").ok());
  EXPECT_TRUE(std::filesystem::is_empty(directory));
}

TEST(SimulatedMapTest, ReportsProgress) {
  SimulationOptions options;
  options.drive.length = 30.;
  options.num_range_data = 20;
  double last = 0.;
  ASSERT_TRUE(Simulate(EmptyFloorPlan({6., 6.}, 0.05), options, 42,
                       [&](double fraction) {
                         EXPECT_GE(fraction, last);
                         last = fraction;
                       })
                  .ok());
  EXPECT_EQ(last, 1.);
}

TEST(SimulatedMapTest, RefusesWhatCannotBeSimulated) {
  const FloorPlan plan = EmptyFloorPlan({6., 6.}, 0.05);
  SimulationOptions options;
  options.drive.length = 5.;
  EXPECT_THAT(std::string(Simulate(plan, options, 1).status().message()),
              HasSubstr("nodes"));
  options = SimulationOptions{};
  options.lidar.num_beams = 0;
  EXPECT_THAT(std::string(Simulate(plan, options, 1).status().message()),
              HasSubstr("num_beams"));
  EXPECT_FALSE(Simulate(EmptyFloorPlan({0.5, 0.5}, 0.05), {}, 1).ok());
  options = SimulationOptions{};
  options.num_range_data = 0;
  EXPECT_NE(Validate(options), "");
}

}  // namespace
}  // namespace cartographer_sdf::simulated_map_test
