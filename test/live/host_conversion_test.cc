// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/host_conversion.h"

#include <cmath>
#include <memory>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_sdf/grid/scan_grid.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::host_conversion_test {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;
using cartographer::sensor::PointCloud;
using cartographer::sensor::RangeData;

constexpr double kResolution = 0.05;

// An L of walls, so that no axis can be mistaken for another one.
RangeData ScanOfAnL(const Eigen::Vector3f& origin) {
  RangeData range_data{origin, PointCloud(), PointCloud()};
  for (int k = 0; k < 60; ++k) {
    const float along = 0.05f * static_cast<float>(k);
    range_data.returns.push_back({{origin.x() + 2.f, origin.y() + along, 0.f}});
    if (k < 20) {
      range_data.returns.push_back(
          {{origin.x() + along, origin.y() - 1.f, 0.f}});
    }
  }
  range_data.misses.push_back({{origin.x() - 3.f, origin.y(), 0.f}});
  return range_data;
}

mapping::ProbabilityGridRangeDataInserter2D Inserter() {
  mapping::proto::ProbabilityGridRangeDataInserterOptions2D options;
  options.set_hit_probability(0.55);
  options.set_miss_probability(0.49);
  options.set_insert_free_space(true);
  return mapping::ProbabilityGridRangeDataInserter2D(options);
}

// Every known cell of the host is one of ours with the same probability at the
// same place, and ours has no others.
void ExpectSame(const mapping::ProbabilityGrid& host,
                const Rigid2& T_local_grid, const OccupancyGrid& grid) {
  int num_known = 0;
  const Eigen::Array2i& size = grid.geometry.size;
  for (int i = 0; i < size.x(); ++i) {
    for (int j = 0; j < size.y(); ++j) {
      const Eigen::Vector2d p_local =
          T_local_grid * grid.geometry.CellCentre({i, j});
      const Eigen::Array2i cell =
          host.limits().GetCellIndex(p_local.cast<float>());
      ASSERT_EQ(grid.known(i, j), host.IsKnown(cell)) << i << "," << j;
      if (!grid.known(i, j)) continue;
      ++num_known;
      // The table of the host has steps of 0.8 / 32766.
      EXPECT_NEAR(grid.probability(i, j), host.GetProbability(cell), 1e-4);
    }
  }
  int num_known_by_host = 0;
  const auto& limits = host.limits().cell_limits();
  for (int x = 0; x < limits.num_x_cells; ++x) {
    for (int y = 0; y < limits.num_y_cells; ++y) {
      num_known_by_host += host.IsKnown(Eigen::Array2i(x, y)) ? 1 : 0;
    }
  }
  EXPECT_EQ(num_known, num_known_by_host);
  EXPECT_GT(num_known, 1000);
}

TEST(HostConversionTest, SubmapsAreCopiedCellByCell) {
  for (const bool is_finished : {false, true}) {
    mapping::ValueConversionTables tables;
    const Eigen::Vector2f origin(3.21f, -7.65f);
    mapping::Submap2D submap(
        origin,
        std::make_unique<mapping::ProbabilityGrid>(
            mapping::MapLimits(
                kResolution,
                origin.cast<double>() + Eigen::Vector2d::Constant(2.5),
                mapping::CellLimits(100, 100)),
            &tables),
        &tables);
    const auto inserter = Inserter();
    submap.InsertRangeData(ScanOfAnL({4.f, -7.f, 0.f}), &inserter);
    submap.InsertRangeData(ScanOfAnL({4.5f, -7.2f, 0.f}), &inserter);
    if (is_finished) submap.Finish();
    const std::optional<OccupancyGrid> grid = CopyGrid(submap);
    ASSERT_TRUE(grid);
    ExpectSame(*static_cast<const mapping::ProbabilityGrid*>(submap.grid()),
               Rigid2(origin.x(), origin.y(), 0.), *grid);
  }
}

// Our grids of the host's scans, against the host's own.
TEST(HostConversionTest, ScansAreDrawnAsTheHostWouldDrawThem) {
  mapping::TrajectoryNode::Data node;
  // As with odometry: the gravity alignment holds the yaw, too.
  node.gravity_alignment = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX());
  node.local_pose =
      transform::Rigid3d({4., -7., 0.}, Eigen::Quaterniond::Identity()) *
      transform::Rigid3d::Rotation(node.gravity_alignment);
  ScanGridOptions options;
  options.resolution = kResolution;
  ScanGrid grid(options);
  mapping::ValueConversionTables tables;
  mapping::ProbabilityGrid host(
      mapping::MapLimits(kResolution, Eigen::Vector2d(6.5, -4.5),
                         mapping::CellLimits(100, 100)),
      &tables);
  const auto inserter = Inserter();
  // Neither points nor sensors on the border of a cell.
  for (const Eigen::Vector3f& origin : {Eigen::Vector3f(4.02f, -7.03f, 0.3f),
                                        Eigen::Vector3f(4.53f, -7.22f, 0.3f)}) {
    const DrivenScan scan =
        MakeDrivenScan({2, 3}, node, ScanOfAnL(origin), 1.5);
    EXPECT_EQ(scan.node, (NodeId{2, 3}));
    EXPECT_NEAR(scan.T_local_node.translation().x(), 4., 1e-9);
    EXPECT_NEAR(scan.T_local_node.rotation(), 0., 1e-9);
    EXPECT_EQ(scan.distance_driven, 1.5);
    EXPECT_TRUE(grid.Insert(scan.T_local_sensor, scan.scan));
    inserter.Insert(ScanOfAnL(origin), &host);
  }
  ExpectSame(host, Rigid2(), grid.Crop());
}

// What the host makes of a constraint in AddSerializedConstraints must be the
// pose of the gravity-aligned scan, and what it stores of a node is the pose of
// the tracking frame.
TEST(HostConversionTest, ConstraintsHoldTheGravityAlignment) {
  const Eigen::Quaterniond gravity_alignment(
      Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  const Constraint constraint{{1, 2}, {3, 4}, {5., 6., -0.4},
                              7.,     8.,     Constraint::Tag::kInterSubmap};
  const HostConstraint host = ToHost(constraint, gravity_alignment);
  EXPECT_EQ(host.submap_id, (mapping::SubmapId{1, 2}));
  EXPECT_EQ(host.node_id, (mapping::NodeId{3, 4}));
  EXPECT_EQ(host.tag, HostConstraint::INTER_SUBMAP);
  EXPECT_EQ(host.pose.translation_weight, 7.);
  EXPECT_EQ(host.pose.rotation_weight, 8.);
  const transform::Rigid2d as_optimised = transform::Project2D(
      host.pose.zbar_ij *
      transform::Rigid3d::Rotation(gravity_alignment.inverse()));
  EXPECT_NEAR(as_optimised.translation().x(), 5., 1e-12);
  EXPECT_NEAR(as_optimised.translation().y(), 6., 1e-12);
  EXPECT_NEAR(as_optimised.rotation().angle(), -0.4, 1e-12);

  mapping::TrajectoryNode::Data node;
  node.gravity_alignment = gravity_alignment;
  node.local_pose = host.pose.zbar_ij;
  const Rigid2 T_local_node = LocalNodePose(node);
  EXPECT_NEAR(T_local_node.translation().y(), 6., 1e-12);
  EXPECT_NEAR(T_local_node.rotation(), -0.4, 1e-12);
}

}  // namespace
}  // namespace cartographer_sdf::host_conversion_test
