// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/torn_submaps.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/shared_data.h"
#include "test/testing/slipped_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::torn_submaps_test {
namespace {

// The submaps of a file that are torn.
std::map<SubmapId, Tear> TornIn(const std::string& path,
                                const int num_threads) {
  std::map<NodeId, PointCloud2> scans;
  const absl::StatusOr<MapState> state =
      ReadMap(path, {{}, [&scans](const NodeId& id, PointCloud2 scan) {
                       scans.emplace(id, std::move(scan));
                     }});
  CHECK(state.ok()) << state.status();
  return FindTornSubmaps(TearOptions(), state->pose_graph, scans,
                         MakeExecutor(num_threads));
}

class SlippedMapTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory;
    testing::WriteOffice(testing::Slip::kNone, Path("whole"));
    testing::WriteOffice(testing::Slip::kInSubmaps8And9, Path("slipped"));
  }
  static void TearDownTestSuite() { delete directory_; }

  static std::string Path(const std::string& name) {
    return directory_->File(name + ".pbstream");
  }
  static std::map<SubmapId, Tear> Torn(const std::string& name,
                                       const int num_threads) {
    return TornIn(Path(name), num_threads);
  }
  // Where no support is enough, and any score is.
  static LoopClosingResult Close(const bool detect_torn_submaps) {
    LoopClosingOptions options;
    options.closing.detect_torn_submaps = detect_torn_submaps;
    options.closing.consistency.min_support = 1e6;
    options.closing.consistency.min_unsupported_score = 1.;
    absl::StatusOr<LoopClosingResult> result =
        CloseLoops(options, Path("slipped"), {}, MakeExecutor(2));
    CHECK(result.ok()) << result.status();
    return *std::move(result);
  }

  static testing::TemporaryDirectory* directory_;
};
testing::TemporaryDirectory* SlippedMapTest::directory_;

// What takes walls seen after the slip to where they were seen before, in the
// frame of a submap.
Rigid2 TrueTear(const std::string& path, const SubmapId& id) {
  const absl::StatusOr<MapState> state = ReadMap(path);
  CHECK(state.ok()) << state.status();
  const Rigid2 T_local_after =
      *state->pose_graph.nodes.at({0, testing::kSlippedNode}).T_local_node;
  const Rigid2 T_true_drawn =
      T_local_after * testing::SlipPose().Inverse() * T_local_after.Inverse();
  const Rigid2 T_local_submap = state->submaps.at(id).T_local_submap;
  return T_local_submap.Inverse() * T_true_drawn * T_local_submap;
}

TEST_F(SlippedMapTest, FindsTheSubmapsThatHoldTheSlip) {
  EXPECT_TRUE(Torn("whole", 2).empty());
  const std::map<SubmapId, Tear> torn = Torn("slipped", 2);
  std::vector<SubmapId> ids;
  for (const auto& [id, tear] : torn) ids.push_back(id);
  EXPECT_THAT(ids, ::testing::ElementsAre(SubmapId{0, 8}, SubmapId{0, 9}));
  for (const auto& [id, tear] : torn) {
    EXPECT_THAT(tear.T_first_second,
                testing::IsPoseNear(TrueTear(Path("slipped"), id), 0.1, 0.01))
        << id;
    // 30 of 120 scans before or after the slip.
    EXPECT_LE(tear.first_part, id.index == 8 ? 4 : 1);
    EXPECT_GE(tear.second_part, id.index == 8 ? 4 : 1);
  }
}

TEST_F(SlippedMapTest, DoesNotDependOnThreads) {
  const std::map<SubmapId, Tear> one = Torn("slipped", 1);
  const std::map<SubmapId, Tear> three = Torn("slipped", 3);
  ASSERT_EQ(one.size(), three.size());
  for (const auto& [id, tear] : one) {
    const Tear& other = three.at(id);
    EXPECT_EQ(tear.T_first_second.translation(),
              other.T_first_second.translation());
    EXPECT_EQ(tear.T_first_second.rotation(), other.T_first_second.rotation());
    EXPECT_EQ(tear.agreement_as_placed, other.agreement_as_placed);
  }
}

// Their closures have no weight of their own.
TEST_F(SlippedMapTest, TornSubmapsNeedSupport) {
  const LoopClosingResult weighed = Close(false);
  EXPECT_TRUE(weighed.closed.torn_submaps.empty());
  const LoopClosingResult with_detection = Close(true);
  EXPECT_EQ(with_detection.closed.torn_submaps.size(), 2u);
  ASSERT_EQ(weighed.closed.closures.size(),
            with_detection.closed.closures.size());
  int num_weighed = 0, num_whole = 0;
  for (size_t k = 0; k < with_detection.closed.closures.size(); ++k) {
    const Closure& outcome = with_detection.closed.closures[k];
    const PairPose& closure = outcome.match.pair;
    // The score that is reported stays that of the match.
    EXPECT_EQ(closure.score, weighed.closed.closures[k].match.pair.score);
    if (with_detection.closed.torn_submaps.count(closure.reference) +
            with_detection.closed.torn_submaps.count(closure.query) ==
        0) {
      if (outcome.status == ClosureStatus::kInGraph) ++num_whole;
      continue;
    }
    EXPECT_NE(outcome.status, ClosureStatus::kInGraph) << closure.query;
    if (weighed.closed.closures[k].status == ClosureStatus::kInGraph)
      ++num_weighed;
  }
  EXPECT_GE(num_weighed, 5);
  EXPECT_GE(num_whole, 20);
}

TEST(FindTornSubmapsTest, NodesWithoutAScanAreLeftOut) {
  PoseGraph pose_graph;
  pose_graph.constraints.push_back(
      {{0, 0}, {0, 0}, Rigid2(), 1., 1., Constraint::Tag::kIntraSubmap});
  EXPECT_TRUE(
      FindTornSubmaps(TearOptions(), pose_graph, {}, MakeExecutor(1)).empty());
}

TEST(DescribeTearTest, IsOneLine) {
  const Tear tear{1, 4, Rigid2(0.5, 0., -0.0314), 0.576, 0., 0., 0.};
  EXPECT_EQ(DescribeTear({0, 15}, tear),
            "0,15: part 5 against part 2 off by 0.58 m, 1.8 deg");
}

// The true poses of its nodes disagree too, by 0.4 m. That is less than the
// 0.5 m from which the data's labels call a submap torn.
TEST(RealMapTest, FindsTheTearOfAces) {
  SKIP_WITHOUT_SHARED_DATA("aces_open_loop.pbstream");
  const std::map<SubmapId, Tear> torn =
      TornIn(SharedDataPath("aces_open_loop.pbstream"), 2);
  ASSERT_EQ(torn.size(), 1u);
  EXPECT_EQ(torn.begin()->first, (SubmapId{0, 15}));
  EXPECT_NEAR(torn.begin()->second.translation, 0.5, 0.15);
}

}  // namespace
}  // namespace cartographer_sdf::torn_submaps_test
