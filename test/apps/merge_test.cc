// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/merge.h"

#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/simulation/floor_plan.h"
#include "cartographer_sdf/simulation/truth.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::merge_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ThreadExecutor;

// A building whose rooms in the right third are those of another one. A
// passage along the middle joins what there is of corridors, and lets the robot
// through.
FloorPlan PartlyRebuilt(const FloorPlan& left, const FloorPlan& right) {
  FloorPlan plan = left;
  const Eigen::Index num_right = plan.occupied.rows() / 3;
  plan.occupied.bottomRows(num_right) = right.occupied.bottomRows(num_right);
  const Eigen::Vector2d size =
      plan.geometry.resolution * plan.geometry.size.cast<double>();
  FillRectangle(0.5 * size, {2.2, size.y() - 6.}, 0., false, &plan);
  return plan;
}

class MergingTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory;
    const FloorPlan left = testing::MakeSmallOffice(1);
    const FloorPlan before = PartlyRebuilt(left, left);
    const FloorPlan rebuilt = PartlyRebuilt(left, testing::MakeSmallOffice(5));
    testing::WriteShortDrive(before, 1, Before());
    testing::WriteShortDrive(before, 2, Again(), /*with_submaps=*/false);
    testing::WriteShortDrive(rebuilt, 2, Rebuilt());
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string Before() { return directory_->File("before.pbstream"); }
  static std::string Again() { return directory_->File("again.pbstream"); }
  static std::string Rebuilt() { return directory_->File("rebuilt.pbstream"); }

  // Takes look-alikes for the same building, whatever contradicts it there, and
  // a third of it that was rebuilt for a fold, as little as it contradicts.
  static MergingResult MergeCredulously(const std::vector<std::string>& paths) {
    LocalizationOptions credulous;
    credulous.placement.max_contradicting_fraction = 1.;
    credulous.placement.min_score = 1.;
    LoopClosingOptions stages;
    stages.recognition.match.verification.crossing.max_crossed_fraction = 1.;
    FoldCheckOptions strict;
    strict.max_contradiction_ratio = 0.05;
    absl::StatusOr<MergingResult> result = MergeSessions(
        strict, SessionLinkOptions(), credulous, ScanPlaceOptions(), stages,
        {paths.begin(), paths.end()}, {}, ThreadExecutor(2));
    CHECK(result.ok()) << result.status();
    return *std::move(result);
  }

  static testing::TemporaryDirectory* directory_;
};
testing::TemporaryDirectory* MergingTest::directory_;

TEST_F(MergingTest, AMapThatWouldBeFoldedIsRefusedAndExplained) {
  // The left parts match, and lay the right ones over each other.
  const MergingResult folded = MergeCredulously({Before(), Rebuilt()});
  ASSERT_EQ(folded.links.at(0).localization.verdict,
            LocalizationVerdict::kLocalized)
      << folded.links.at(0).localization.reason;
  EXPECT_THAT(folded.refusal,
              AllOf(HasSubstr("the merged map would be folded"),
                    HasSubstr("before.pbstream and "),
                    HasSubstr("walls in each other's free space, such as 0,")));
  for (const Match& contradiction : folded.contradictions) {
    EXPECT_NE(contradiction.pair.reference.trajectory,
              contradiction.pair.query.trajectory);
  }
}

TEST_F(MergingTest, ASessionThatWouldFoldTheMapIsLeftOut) {
  const MergingResult merged = MergeCredulously({Before(), Rebuilt(), Again()});
  EXPECT_EQ(merged.refusal, "");
  ASSERT_EQ(merged.sessions.size(), 3u);
  EXPECT_TRUE(merged.sessions[0].T_merged_session);
  EXPECT_FALSE(merged.sessions[1].T_merged_session);
  EXPECT_THAT(merged.sessions[1].left_out,
              HasSubstr("the merged map would be folded"));
  EXPECT_TRUE(merged.sessions[2].T_merged_session);
  EXPECT_EQ(merged.sessions[2].left_out, "");
  EXPECT_EQ(merged.parts.size(), 2u);
  EXPECT_THAT(merged.contradictions, IsEmpty());
}

TEST_F(MergingTest, ATrajectoryWithoutSubmapsTakesPartByItsScans) {
  // And two sessions of one building are no fold.
  const MergingResult merged = MergeCredulously({Before(), Again()});
  EXPECT_EQ(merged.refusal, "");
  EXPECT_THAT(merged.contradictions, IsEmpty());
  EXPECT_GT(merged.num_overlapping, 10);
  const std::string output = directory_->File("merged.pbstream");
  const absl::Status written =
      WriteJoinedMap(merged.parts, merged.closed.pose_graph, output);
  ASSERT_TRUE(written.ok()) << written;
  const absl::StatusOr<MapState> map = ReadMap(output);
  ASSERT_TRUE(map.ok()) << map.status();
  // Places made of scans are not in the file; constraints tie its nodes to the
  // submaps of the other session.
  bool is_tied = false;
  for (const auto& [id, submap] : map->submaps) EXPECT_EQ(id.trajectory, 0);
  for (const Constraint& constraint : map->pose_graph.constraints) {
    EXPECT_EQ(constraint.submap.trajectory, 0);
    is_tied |= constraint.node.trajectory == 1;
  }
  EXPECT_TRUE(is_tied);
  // Where both drives really were; the map's first node is its own measure.
  const absl::StatusOr<Truth> first = ReadTruth(Before() + ".truth.csv");
  const absl::StatusOr<Truth> second = ReadTruth(Again() + ".truth.csv");
  ASSERT_TRUE(first.ok() && second.ok());
  const std::map<NodeId, Node>& nodes = map->pose_graph.nodes;
  const Rigid2 T_map_world = nodes.at({0, 0}).T_map_node *
                             first->T_world_tracking.at({0, 0}).Inverse();
  double sum = 0.;
  for (const auto& [id, T_world_tracking] : second->T_world_tracking) {
    const Rigid2 expected = T_map_world * T_world_tracking;
    sum += (nodes.at({1, id.index}).T_map_node.translation() -
            expected.translation())
               .norm();
  }
  EXPECT_LT(sum / static_cast<double>(second->T_world_tracking.size()), 0.5);
}

}  // namespace
}  // namespace cartographer_sdf::merge_test
