// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a stock Cartographer, with its defaults, does to a closed map that it
// loads unfrozen.

#include "cartographer_sdf/pose_graph/host_motion.h"

#include <algorithm>
#include <optional>
#include <string>

#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/testing/node_motion.h"
#include "test/testing/temporary_directory.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::host_motion_test {
namespace {

namespace mapping = ::cartographer::mapping;

class HostMotionTest : public ::testing::Test {
 protected:
  // Odometry turns ten times as much as local SLAM lets pass.
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory;
    DriftOptions drift;
    drift.odometry_yaw_bias = 0.01;
    drift.local_slam_fraction = 0.05;
    testing::WriteShortDrive(testing::MakeSmallOffice(1), 1, OpenMap(),
                             /*with_submaps=*/true, drift);
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string OpenMap() { return directory_->File("open.pbstream"); }

  // Closes its loops and writes it.
  static LoopClosingResult Close(
      const MapSource& source, const std::string& output,
      const LoopClosingOptions& options = LoopClosingOptions()) {
    absl::StatusOr<LoopClosingResult> result =
        CloseLoops(options, source, {}, MakeExecutor(2));
    CHECK(result.ok()) << result.status();
    const absl::Status written =
        WriteMap(source, output, result->closed.pose_graph);
    CHECK(written.ok()) << written;
    return *std::move(result);
  }

  // The largest motion of a node in a final optimisation [m].
  static double MotionByStock(const std::string& path, const PoseGraph& graph) {
    const auto stock = testing::MakeStockOptions("");
    const auto host = mapping::CreateMapBuilder(stock.map_builder);
    host->LoadStateFromFile(path, /*load_frozen_state=*/false);
    host->pose_graph()->RunFinalOptimization();
    double motion = 0.;
    for (const auto& node : host->pose_graph()->GetTrajectoryNodes()) {
      const Rigid2& before =
          graph.nodes.at({node.id.trajectory_id, node.id.node_index})
              .T_map_node;
      const Eigen::Vector2d after =
          node.data.global_pose.translation().head<2>();
      motion = std::max(motion, (after - before.translation()).norm());
    }
    return motion;
  }

  static std::optional<HostMotion> Predict(const LoopClosingResult& result) {
    return PredictHostMotion(OptimizationOptions(), result.optimization,
                             result.closed.pose_graph);
  }

  static testing::TemporaryDirectory* directory_;
};
testing::TemporaryDirectory* HostMotionTest::directory_;

TEST_F(HostMotionTest, OdometryBendsAMapAsPredicted) {
  const std::string output = directory_->File("closed.pbstream");
  const LoopClosingResult result = Close(OpenMap(), output);
  const std::optional<HostMotion> predicted = Predict(result);
  ASSERT_TRUE(predicted.has_value());
  const double motion = MotionByStock(output, result.closed.pose_graph);
  // More than the program is silent about.
  EXPECT_GT(motion, 0.1);
  EXPECT_NEAR(predicted->max_translation, motion, 0.02 * motion);
}

TEST_F(HostMotionTest, WithoutOdometryAMapKeepsItsShape) {
  const MapSource source(OpenMap(), MissingRecords::kRefuse,
                         OdometryRecords::kDrop);
  const std::string output = directory_->File("without.pbstream");
  const LoopClosingResult result = Close(source, output);
  EXPECT_FALSE(Predict(result).has_value());
  EXPECT_LT(MotionByStock(output, result.closed.pose_graph), 0.002);
}

// Odometry has shaped the map, and no closure is new.
TEST_F(HostMotionTest, WithoutOdometryAMapKeepsItsShapeThoughNothingIsClosed) {
  LoopClosingOptions trusting;
  trusting.closing.infer_odometry_weights = false;
  const std::string shaped = directory_->File("shaped.pbstream");
  Close(OpenMap(), shaped, trusting);
  LoopClosingOptions strict;
  strict.recognition.match.verification.judgement.min_score = 1e6;
  const MapSource source(shaped, MissingRecords::kRefuse,
                         OdometryRecords::kDrop);
  const std::string output = directory_->File("settled.pbstream");
  const LoopClosingResult result = Close(source, output, strict);
  EXPECT_TRUE(result.closed.closures.empty());
  EXPECT_EQ(DescribeWithoutClosures(result),
            "the map was optimised without its odometry");
  EXPECT_GT(
      testing::LargestMotion(result.state.pose_graph, result.closed.pose_graph),
      0.1);
  EXPECT_LT(MotionByStock(output, result.closed.pose_graph), 0.002);
}

}  // namespace
}  // namespace cartographer_sdf::host_motion_test
