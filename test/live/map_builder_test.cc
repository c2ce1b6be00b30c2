// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/map_builder.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/transform/transform.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/live/office_robot.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::map_builder_test {
namespace {

namespace mapping = cartographer::mapping;
using testing::FeedOdometry;
using testing::FeedScan;
using ::testing::IsEmpty;
using testing::kStep;
using testing::kTimeStep;
using testing::kWithoutOwnSearch;
using testing::MakeStockOptions;
using ::testing::Not;
using testing::PoseAt;
using testing::Robot;
using testing::SensorIds;
using ::testing::SizeIs;
using testing::TheDrivenOffice;
using testing::TimeOf;

// The host drops the first scan, which is its frame nevertheless, and some of
// the others.
Rigid2 TruePose(const mapping::TrajectoryNode& node) {
  return PoseAt(TheDrivenOffice().poses, node.time());
}

bool IsNear(const Rigid2& a, const Rigid2& b, const double meters,
            const double radians) {
  const Rigid2 T_a_b = a.Inverse() * b;
  return T_a_b.translation().norm() <= meters &&
         std::abs(T_a_b.rotation()) <= radians;
}

void ExpectNear(const Rigid2& a, const Rigid2& b, const double meters,
                const double radians) {
  const Rigid2 T_a_b = a.Inverse() * b;
  EXPECT_LE(T_a_b.translation().norm(), meters) << a << " and " << b;
  EXPECT_LE(std::abs(T_a_b.rotation()), radians) << a << " and " << b;
}

TEST(MapBuilderTest, DisabledItIsTheHostItself) {
  auto host = mapping::CreateMapBuilder(MakeStockOptions("").map_builder);
  auto* const address = host.get();
  LiveOptions options;
  options.enabled = false;
  const auto map_builder = CreateMapBuilder(std::move(host), options);
  EXPECT_EQ(map_builder.get(), address);
  EXPECT_EQ(AsLiveMapBuilder(map_builder.get()), nullptr);
}

TEST(MapBuilderTest, ClosesLoops) {
  const auto stock = MakeStockOptions(kWithoutOwnSearch);
  const auto map_builder = CreateMapBuilder(
      mapping::CreateMapBuilder(stock.map_builder), LiveOptions());
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  ASSERT_NE(live, nullptr);
  // The user's own callback is served, too.
  int num_results = 0;
  const int trajectory_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder,
      [&num_results](
          int, cartographer::common::Time,
          const cartographer::transform::Rigid3d&,
          const cartographer::sensor::RangeData&,
          std::unique_ptr<
              const mapping::TrajectoryBuilderInterface::InsertionResult>) {
        ++num_results;
      });
  const std::vector<Rigid2>& poses = TheDrivenOffice().poses;
  Robot robot(map_builder.get(), trajectory_id, 1);
  robot.Drive(poses);
  map_builder->FinishTrajectory(trajectory_id);
  map_builder->pose_graph()->RunFinalOptimization();
  EXPECT_GE(num_results, static_cast<int>(poses.size()) - 1);

  const LiveSummary summary = live->GetSummary();
  // All are indexed, those that were left unfinished as well.
  const auto submaps = map_builder->pose_graph()->GetAllSubmapData();
  EXPECT_EQ(summary.num_submaps, static_cast<int>(submaps.size()));
  EXPECT_GE(summary.num_injected, 3);
  EXPECT_EQ(summary.num_waiting_tasks, 0u);
  EXPECT_LT(summary.callback_p99_seconds, 1e-3);
  const std::vector<RefusedMatch> refused = live->GetRefusedMatches();
  EXPECT_THAT(refused, Not(IsEmpty()));
  EXPECT_LE(refused.size(), 200u);
  for (const RefusedMatch& match : refused) {
    EXPECT_NE(match.verdict, Verdict::kAccepted);
    EXPECT_NE(match.verdict, Verdict::kTooLittleOverlap);
  }
  int num_inter = 0;
  double sum_of_errors = 0.;
  const auto nodes = map_builder->pose_graph()->GetTrajectoryNodes();
  const auto constraints = map_builder->pose_graph()->constraints();
  for (const auto& constraint : constraints) {
    if (constraint.tag != HostConstraint::INTER_SUBMAP) continue;
    ++num_inter;
    // Seen from that node of the submap which was nearest: submaps bend.
    const Rigid2& T_world_node = TruePose(nodes.at(constraint.node_id));
    std::optional<Rigid2> T_submap_nearest, T_nearest_node;
    for (const auto& other : constraints) {
      if (other.tag != HostConstraint::INTRA_SUBMAP ||
          other.submap_id != constraint.submap_id) {
        continue;
      }
      const Rigid2 T_other_node =
          TruePose(nodes.at(other.node_id)).Inverse() * T_world_node;
      if (T_nearest_node && T_nearest_node->translation().norm() <=
                                T_other_node.translation().norm()) {
        continue;
      }
      T_nearest_node = T_other_node;
      T_submap_nearest = FromHost(other.pose.zbar_ij);
    }
    ASSERT_TRUE(T_nearest_node);
    const Rigid2 T_submap_node = *T_submap_nearest * *T_nearest_node;
    ExpectNear(FromHost(constraint.pose.zbar_ij), T_submap_node, 0.5, 0.06);
    sum_of_errors += (FromHost(constraint.pose.zbar_ij).translation() -
                      T_submap_node.translation())
                         .norm();
  }
  EXPECT_LT(sum_of_errors, 0.15 * num_inter);
  EXPECT_EQ(num_inter, summary.num_constraints);
  EXPECT_GT(num_inter, 10);
}

TEST(MapBuilderTest, DetectsWithoutInjectingOnRequest) {
  const auto stock = MakeStockOptions(kWithoutOwnSearch);
  LiveOptions options;
  options.inject_constraints = false;
  const auto map_builder =
      CreateMapBuilder(mapping::CreateMapBuilder(stock.map_builder), options);
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  const int trajectory_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder, nullptr);
  Robot robot(map_builder.get(), trajectory_id, 1);
  robot.Drive(TheDrivenOffice().poses);
  map_builder->FinishTrajectory(trajectory_id);
  map_builder->pose_graph()->RunFinalOptimization();
  EXPECT_GE(live->GetSummary().num_closures, 3);
  EXPECT_EQ(live->GetSummary().num_constraints, 0);
  for (const auto& constraint : map_builder->pose_graph()->constraints()) {
    EXPECT_EQ(constraint.tag, HostConstraint::INTRA_SUBMAP);
  }
}

TEST(MapBuilderTest, ReportsClosuresOfDeletedTrajectories) {
  const auto stock = MakeStockOptions(kWithoutOwnSearch);
  const auto map_builder = CreateMapBuilder(
      mapping::CreateMapBuilder(stock.map_builder), LiveOptions());
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  const int trajectory_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder, nullptr);
  Robot robot(map_builder.get(), trajectory_id, 1);
  robot.Drive(TheDrivenOffice().poses);
  map_builder->FinishTrajectory(trajectory_id);
  map_builder->pose_graph()->RunFinalOptimization();
  const std::vector<ClosureRecord> before = live->GetClosures();
  ASSERT_GE(before.size(), 3u);
  EXPECT_EQ(live->GetSummary().num_closures, static_cast<int>(before.size()));

  map_builder->pose_graph()->DeleteTrajectory(trajectory_id);
  live->WaitUntilIdle();
  const std::vector<ClosureRecord> after = live->GetClosures();
  EXPECT_EQ(live->GetSummary().num_closures, static_cast<int>(before.size()));
  ASSERT_EQ(after.size(), before.size());
  int num_in_graph = 0;
  for (const ClosureRecord& closure : before) {
    const auto same = std::find_if(
        after.begin(), after.end(), [&closure](const ClosureRecord& other) {
          return other.pair.reference == closure.pair.reference &&
                 other.pair.query == closure.pair.query;
        });
    ASSERT_NE(same, after.end());
    EXPECT_EQ(same->pair.score, closure.pair.score);
    EXPECT_EQ(same->num_inliers, closure.num_inliers);
    if (closure.status != ClosureStatus::kInGraph) continue;
    EXPECT_EQ(same->status, ClosureStatus::kInGraph);
    EXPECT_EQ(same->num_constraints, closure.num_constraints);
    ++num_in_graph;
  }
  EXPECT_GE(num_in_graph, 3);
}

class LocalizationTest : public ::testing::Test {
 protected:
  // The map's frame is that of the first pose.
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory;
    const auto stock = MakeStockOptions(kWithoutOwnSearch);
    const auto map_builder = mapping::CreateMapBuilder(stock.map_builder);
    const int trajectory_id = map_builder->AddTrajectoryBuilder(
        SensorIds(), stock.trajectory_builder, nullptr);
    Robot robot(map_builder.get(), trajectory_id, 1);
    const std::vector<Rigid2>& poses = TheDrivenOffice().poses;
    robot.Drive({poses.begin(), poses.begin() + NumMapped()});
    map_builder->FinishTrajectory(trajectory_id);
    map_builder->pose_graph()->RunFinalOptimization();
    ASSERT_TRUE(map_builder->SerializeStateToFile(true, MapPath()));
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::ptrdiff_t NumMapped() {
    return static_cast<std::ptrdiff_t>(TheDrivenOffice().poses.size() * 4 / 9);
  }
  static std::string MapPath() { return directory_->path() + "/map.pbstream"; }
  static Rigid2 TrueMapPose(const Rigid2& T_world_robot) {
    return TheDrivenOffice().poses.front().Inverse() * T_world_robot;
  }

  static testing::TemporaryDirectory* directory_;
};
testing::TemporaryDirectory* LocalizationTest::directory_ = nullptr;

TEST_F(LocalizationTest, LocatesFromAnyYaw) {
  const std::vector<Rigid2>& all = TheDrivenOffice().poses;
  for (const bool is_frozen : {true, false}) {
    for (const bool is_reversed : {false, true}) {
      const auto stock = MakeStockOptions(kWithoutOwnSearch);
      absl::Mutex mutex;
      std::vector<LocalizationResult> results;
      const auto map_builder = CreateMapBuilder(
          mapping::CreateMapBuilder(stock.map_builder), LiveOptions(),
          [&mutex, &results](const LocalizationResult& result) {
            const absl::MutexLock lock(&mutex);
            results.push_back(result);
          });
      LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
      const auto ids = map_builder->LoadStateFromFile(MapPath(), is_frozen);
      ASSERT_THAT(ids, SizeIs(1));
      const int trajectory_id = map_builder->AddTrajectoryBuilder(
          SensorIds(), stock.trajectory_builder, nullptr);
      // From the middle of the round trip on, as driven or looking back.
      std::vector<Rigid2> poses(all.begin() + NumMapped() / 2,
                                all.begin() + NumMapped() / 2 + 80);
      if (is_reversed) {
        std::reverse(poses.begin(), poses.end());
        for (Rigid2& pose : poses) pose = pose * Rigid2(0., 0., M_PI);
      }
      live->WaitUntilIdle();
      Robot robot(map_builder.get(), trajectory_id, 7);
      size_t num_driven = 0;
      std::optional<size_t> num_until_localized;
      robot.Drive(poses, [&] {
        ++num_driven;
        live->WaitUntilIdle();
        if (!num_until_localized &&
            live->GetLocalization(trajectory_id)->localized) {
          num_until_localized = num_driven;
        }
        if (!num_until_localized) return false;
        // Until the constraints are there, and used. A robot would take longer.
        absl::SleepFor(absl::Milliseconds(50));
        return IsNear(
            FromHost(map_builder->pose_graph()->GetLocalToGlobalTransform(
                trajectory_id)),
            TrueMapPose(poses.front()), 0.3, 0.05);
      });
      ASSERT_TRUE(num_until_localized) << LocalizationVerdictName(
          live->GetLocalization(trajectory_id)->verdict);
      const LocalizationResult result = *live->GetLocalization(trajectory_id);
      EXPECT_EQ(result.verdict, LocalizationVerdict::kLocalized);
      EXPECT_GE(result.num_queries, 2);
      EXPECT_LT(result.distance_driven, 10.);
      ExpectNear(*result.T_map_local, TrueMapPose(poses.front()), 0.3, 0.05);
      ExpectNear(*result.T_map_tracking,
                 TrueMapPose(PoseAt(poses, result.time)), 0.3, 0.05);
      // Walls all round hold the pose.
      const Eigen::Vector3d deviations =
          result.covariance.diagonal().cwiseSqrt();
      EXPECT_GE(deviations.minCoeff(), 0.005);
      EXPECT_LT(deviations.maxCoeff(), 0.3);
      {
        const absl::MutexLock lock(&mutex);
        ASSERT_THAT(results, SizeIs(1));
        EXPECT_TRUE(results.front().localized);
      }
      // The pose graph has been told, and agrees.
      EXPECT_GE(live->GetSummary().num_injected, 1);
      ExpectNear(FromHost(map_builder->pose_graph()->GetLocalToGlobalTransform(
                     trajectory_id)),
                 TrueMapPose(poses.front()), 0.3, 0.05);
      // Kidnapped, as it may think.
      EXPECT_FALSE(result.was_localized);
      for (int k = 0; k < 2; ++k) {
        live->Localize(trajectory_id);
        EXPECT_FALSE(live->GetLocalization(trajectory_id)->localized);
        EXPECT_TRUE(live->GetLocalization(trajectory_id)->was_localized);
      }
      map_builder->FinishTrajectory(trajectory_id);
      // While the loaded map's places are read from the file that was left.
      EXPECT_TRUE(std::ifstream(MapPath() + ".places").good());
    }
  }
}

// As after a kidnapping: the next trajectory goes on where the robot is.
TEST_F(LocalizationTest, NextTrajectoryStartsWhereItWasFound) {
  auto stock = MakeStockOptions(std::string(kWithoutOwnSearch) +
                                "MAP_BUILDER.collate_by_trajectory = true\n");
  const auto map_builder = CreateMapBuilder(
      mapping::CreateMapBuilder(stock.map_builder), LiveOptions());
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  const int map_id = map_builder->LoadStateFromFile(MapPath(), true).at(0);
  const int trajectory_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder, nullptr);
  EXPECT_FALSE(live->GetStartPose(trajectory_id));
  const std::vector<Rigid2>& all = TheDrivenOffice().poses;
  const std::vector<Rigid2> poses(all.begin() + NumMapped() / 2,
                                  all.begin() + NumMapped() / 2 + 80);
  size_t num_driven = 0;
  size_t num_after = 0;
  Robot(map_builder.get(), trajectory_id, 7).Drive(poses, [&] {
    ++num_driven;
    live->WaitUntilIdle();
    // It is asked for later than the robot was found, while it drives straight
    // on: local SLAM lags behind turns.
    if (live->GetLocalization(trajectory_id)->localized) ++num_after;
    return num_after >= 5 &&
           IsNear(poses[num_driven - 3], poses[num_driven - 1], 1., 0.01);
  });
  ASSERT_GE(num_after, 5u);
  const std::optional<StartPose> start = live->GetStartPose(trajectory_id);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->to_trajectory_id, map_id);
  ExpectNear(FromHost(map_builder->pose_graph()
                          ->GetTrajectoryNodePoses()
                          .BeginOfTrajectory(map_id)
                          ->data.global_pose *
                      start->relative_pose),
             TrueMapPose(PoseAt(poses, start->time)), 0.3, 0.05);
  map_builder->FinishTrajectory(trajectory_id);

  auto* const initial =
      stock.trajectory_builder.mutable_initial_trajectory_pose();
  initial->set_to_trajectory_id(start->to_trajectory_id);
  *initial->mutable_relative_pose() =
      cartographer::transform::ToProto(start->relative_pose);
  initial->set_timestamp(0);
  const int next_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder, nullptr);
  ExpectNear(
      FromHost(map_builder->pose_graph()->GetLocalToGlobalTransform(next_id)),
      TrueMapPose(poses.at(num_driven - 1)), 0.3, 0.05);
  EXPECT_FALSE(live->GetStartPose(next_id));
  map_builder->FinishTrajectory(next_id);
}

LiveOptions WithComparedScans() {
  LiveOptions options;
  options.localization.compare_scans = true;
  return options;
}

// How far the robot drives until it is found [m], and where that is.
TEST_F(LocalizationTest, ComparedScansFindItSooner) {
  const auto stock = MakeStockOptions(kWithoutOwnSearch);
  const std::vector<Rigid2>& all = TheDrivenOffice().poses;
  std::map<bool, double> sum_of_distances;
  for (const bool is_frozen : {true, false}) {
    for (const bool compares_scans : {false, true}) {
      const auto map_builder = CreateMapBuilder(
          mapping::CreateMapBuilder(stock.map_builder),
          compares_scans ? WithComparedScans() : LiveOptions());
      LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
      map_builder->LoadStateFromFile(MapPath(), is_frozen);
      const int trajectory_id = map_builder->AddTrajectoryBuilder(
          SensorIds(), stock.trajectory_builder, nullptr);
      const std::vector<Rigid2> poses(all.begin() + NumMapped() / 3,
                                      all.begin() + NumMapped() / 3 + 80);
      live->WaitUntilIdle();
      Robot(map_builder.get(), trajectory_id, 7).Drive(poses, [&] {
        live->WaitUntilIdle();
        return live->GetLocalization(trajectory_id)->localized;
      });
      const LocalizationResult result = *live->GetLocalization(trajectory_id);
      ASSERT_TRUE(result.localized);
      sum_of_distances[compares_scans] += result.distance_driven;
      EXPECT_EQ(live->GetSummary().num_looks > 0, compares_scans);
      EXPECT_EQ(live->GetSummary().num_dropped_scans, 0);
      ExpectNear(*result.T_map_tracking,
                 TrueMapPose(PoseAt(poses, result.time)), 0.3, 0.05);
      EXPECT_GE(live->GetClosures().size(), 1u);
      EXPECT_GE(live->GetClosures().back().num_constraints, 3);
      map_builder->FinishTrajectory(trajectory_id);
      map_builder->pose_graph()->RunFinalOptimization();
      EXPECT_GE(live->GetSummary().num_injected, 1);
      ExpectNear(FromHost(map_builder->pose_graph()->GetLocalToGlobalTransform(
                     trajectory_id)),
                 TrueMapPose(poses.front()), 0.3, 0.05);
    }
  }
  EXPECT_LT(sum_of_distances[true], sum_of_distances[false] - 1.);
  EXPECT_LT(sum_of_distances[true], 4.);
}

// Carried to another room between two scans, while the wheels say nothing of
// it.
TEST_F(LocalizationTest, ComparedScansNoticeThatItIsLost) {
  const auto stock = MakeStockOptions(kWithoutOwnSearch);
  absl::Mutex mutex;
  std::vector<LocalizationResult> results;
  const auto map_builder =
      CreateMapBuilder(mapping::CreateMapBuilder(stock.map_builder),
                       WithComparedScans(), [&](const LocalizationResult& one) {
                         const absl::MutexLock lock(&mutex);
                         results.push_back(one);
                       });
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  map_builder->LoadStateFromFile(MapPath(), true);
  const int trajectory_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder, nullptr);
  live->WaitUntilIdle();
  const std::vector<Rigid2>& all = TheDrivenOffice().poses;
  const size_t num_mapped = static_cast<size_t>(NumMapped());
  LidarOptions lidar;
  lidar.num_beams = 240;
  RandomNumbers random(3);
  constexpr size_t kNumBefore = 30, kNumAfter = 20;
  for (size_t k = 0; k < kNumBefore + kNumAfter; ++k) {
    const size_t odometry = num_mapped / 3 + k;
    const size_t seen = k < kNumBefore ? odometry : k - kNumBefore;
    const double seconds = kTimeStep * static_cast<double>(k + 1);
    FeedOdometry(map_builder.get(), trajectory_id, seconds,
                 all[num_mapped / 3].Inverse() * all[odometry]);
    FeedScan(map_builder.get(), trajectory_id, seconds,
             TakeScan(TheDrivenOffice().plan, {}, all[seen], lidar, &random));
    live->WaitUntilIdle();
    const absl::MutexLock lock(&mutex);
    EXPECT_LE(results.size(), k < kNumBefore ? 1u : 3u);
  }
  const absl::MutexLock lock(&mutex);
  ASSERT_GE(results.size(), 2u);
  EXPECT_TRUE(results[0].localized);
  EXPECT_FALSE(results[1].localized);
  EXPECT_TRUE(results[1].was_localized);
  EXPECT_EQ(results[1].verdict, LocalizationVerdict::kContradicted);
  EXPECT_GT(results[1].time, TimeOf(kTimeStep * kNumBefore));
  // Constraints of one place would pull against those of the other.
  const int num_constraints = live->GetSummary().num_constraints;
  map_builder->FinishTrajectory(trajectory_id);
  EXPECT_EQ(live->GetSummary().num_constraints, num_constraints);
}

TEST_F(LocalizationTest, DropsScansWhileTheWorkerIsBusy) {
  const auto stock = MakeStockOptions(kWithoutOwnSearch);
  absl::Notification may_go_on;
  const auto map_builder = CreateMapBuilder(
      mapping::CreateMapBuilder(stock.map_builder), WithComparedScans(),
      [&](const LocalizationResult&) { may_go_on.WaitForNotification(); });
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  map_builder->LoadStateFromFile(MapPath(), true);
  live->WaitUntilIdle();
  const int trajectory_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder, nullptr);
  const std::vector<Rigid2>& all = TheDrivenOffice().poses;
  // The worker holds on as soon as the robot is found, and says so.
  Robot robot(map_builder.get(), trajectory_id, 7);
  size_t num_driven = 0, num_after = 0;
  robot.Drive({all.begin() + NumMapped() / 3, all.end()}, [&] {
    ++num_driven;
    while (!live->GetLocalization(trajectory_id)->localized &&
           live->GetSummary().num_waiting_tasks > 0) {
      absl::SleepFor(absl::Milliseconds(1));
    }
    if (live->GetLocalization(trajectory_id)->localized) ++num_after;
    return num_after >= 60;
  });
  EXPECT_GE(live->GetSummary().num_dropped_scans, 20);
  may_go_on.Notify();
  live->WaitUntilIdle();
  EXPECT_LT(live->GetSummary().num_dropped_scans,
            static_cast<int>(num_driven) - 20);
  map_builder->FinishTrajectory(trajectory_id);
}

TEST_F(LocalizationTest, SaysThatItIsNotInTheMap) {
  const auto stock = MakeStockOptions(kWithoutOwnSearch);
  const auto map_builder = CreateMapBuilder(
      mapping::CreateMapBuilder(stock.map_builder), WithComparedScans());
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  const int trajectory_id = map_builder->AddTrajectoryBuilder(
      SensorIds(), stock.trajectory_builder, nullptr);
  EXPECT_EQ(live->GetLocalization(trajectory_id)->verdict,
            LocalizationVerdict::kNoMap);
  EXPECT_FALSE(live->GetLocalization(17));
  map_builder->LoadStateFromFile(MapPath(), true);
  live->WaitUntilIdle();
  EXPECT_EQ(live->GetLocalization(trajectory_id)->verdict,
            LocalizationVerdict::kTooLittleSeen);
  // A corridor without ends, of more than the least area, is everywhere and
  // nowhere.
  Scan corridor;
  for (int k = -120; k <= 120; ++k) {
    const float x = 0.1f * static_cast<float>(k);
    corridor.returns.emplace_back(x, 0.9f);
    corridor.returns.emplace_back(x, -0.9f);
  }
  for (int k = 0; k < 20; ++k) {
    FeedOdometry(map_builder.get(), trajectory_id, 0.5 * k,
                 Rigid2(kStep * k, 0., 0.));
    FeedScan(map_builder.get(), trajectory_id, 0.5 * k, corridor);
    live->WaitUntilIdle();
  }
  const LocalizationResult result = *live->GetLocalization(trajectory_id);
  EXPECT_FALSE(result.localized);
  EXPECT_GE(result.num_queries, 3);
  EXPECT_GT(live->GetSummary().num_looks, 3);
  EXPECT_NE(result.verdict, LocalizationVerdict::kTooLittleSeen);
  map_builder->FinishTrajectory(trajectory_id);
  EXPECT_EQ(live->GetLocalization(trajectory_id)->verdict,
            LocalizationVerdict::kFinished);
}

}  // namespace
}  // namespace cartographer_sdf::map_builder_test
