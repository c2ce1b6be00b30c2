// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/torn_submaps.h"

#include <string>
#include <vector>

#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/tools/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/slipped_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf {
namespace {

using ::testing::HasSubstr;

Executor Threads(const int num_threads) {
  return
      [num_threads](const size_t n, const std::function<void(size_t)>& task) {
        ParallelFor(static_cast<int>(n), num_threads,
                    [&task](const int i) { task(static_cast<size_t>(i)); });
      };
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
    const absl::StatusOr<MapState> state = ReadMap(Path(name));
    CHECK(state.ok()) << state.status();
    const absl::StatusOr<std::map<SubmapId, Tear>> torn = FindTornSubmaps(
        TearOptions(), Path(name), state->pose_graph, Threads(num_threads));
    CHECK(torn.ok()) << torn.status();
    return *torn;
  }
  // Where no support is enough, and any score is.
  static LoopClosingResult Close(const bool silence_torn_submaps) {
    LoopClosingOptions options;
    options.silence_torn_submaps = silence_torn_submaps;
    options.consistency.min_support = 1e6;
    options.consistency.min_unsupported_score = 1.;
    absl::StatusOr<LoopClosingResult> result =
        CloseLoops(options, Path("slipped"), {}, Threads(2));
    CHECK(result.ok()) << result.status();
    return *std::move(result);
  }

  static testing::TemporaryDirectory* directory_;
};
testing::TemporaryDirectory* SlippedMapTest::directory_;

TEST_F(SlippedMapTest, FindsTheSubmapsThatHoldTheSlip) {
  EXPECT_TRUE(Torn("whole", 2).empty());
  const std::map<SubmapId, Tear> torn = Torn("slipped", 2);
  std::vector<SubmapId> ids;
  for (const auto& [id, tear] : torn) ids.push_back(id);
  EXPECT_THAT(ids, ::testing::ElementsAre(SubmapId{0, 8}, SubmapId{0, 9}));
  for (const auto& [id, tear] : torn) {
    // 0.64 m at the robot, and 0.05 rad times some metres from there.
    EXPECT_NEAR(tear.translation, 0.64, 0.35) << id;
    EXPECT_NEAR(tear.T_first_second.rotation(), -0.05, 0.02) << id;
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
  const LoopClosingResult heard = Close(false);
  EXPECT_TRUE(heard.torn_submaps.empty());
  const LoopClosingResult silenced = Close(true);
  EXPECT_EQ(silenced.torn_submaps.size(), 2u);
  ASSERT_EQ(heard.closures.size(), silenced.closures.size());
  int num_heard = 0, num_whole = 0;
  for (size_t k = 0; k < silenced.closures.size(); ++k) {
    const ClosureOutcome& outcome = silenced.closures[k];
    const LoopClosure& closure = outcome.match.closure;
    // The score that is reported stays that of the match.
    EXPECT_EQ(closure.score, heard.closures[k].match.closure.score);
    if (silenced.torn_submaps.count(closure.reference) +
            silenced.torn_submaps.count(closure.query) ==
        0) {
      if (outcome.fate == Fate::kInGraph) ++num_whole;
      continue;
    }
    EXPECT_NE(outcome.fate, Fate::kInGraph) << closure.query;
    if (heard.closures[k].fate == Fate::kInGraph) ++num_heard;
  }
  EXPECT_GE(num_heard, 5);
  EXPECT_GE(num_whole, 20);
}

TEST(FindTornSubmapsTest, FailsWithoutAMap) {
  PoseGraph pose_graph;
  pose_graph.constraints.push_back(
      {{0, 0}, {0, 0}, Rigid2(), 1., 1., Constraint::Tag::kIntraSubmap});
  const absl::StatusOr<std::map<SubmapId, Tear>> torn = FindTornSubmaps(
      TearOptions(), "/nowhere.pbstream", pose_graph, Threads(1));
  ASSERT_FALSE(torn.ok());
  EXPECT_THAT(std::string(torn.status().message()),
              HasSubstr("/nowhere.pbstream"));
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
  const std::string path = SharedDataPath("aces_open_loop.pbstream");
  const absl::StatusOr<MapState> state = ReadMap(path);
  ASSERT_TRUE(state.ok()) << state.status();
  const absl::StatusOr<std::map<SubmapId, Tear>> torn =
      FindTornSubmaps(TearOptions(), path, state->pose_graph, Threads(2));
  ASSERT_TRUE(torn.ok()) << torn.status();
  ASSERT_EQ(torn->size(), 1u);
  EXPECT_EQ(torn->begin()->first, (SubmapId{0, 15}));
  EXPECT_NEAR(torn->begin()->second.translation, 0.5, 0.15);
}

}  // namespace
}  // namespace cartographer_sdf
