// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/audit.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/evaluation/false_constraints.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/slipped_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::audit_test {
namespace {

using ::testing::HasSubstr;

Executor Threads(const int num_threads) { return MakeExecutor(num_threads); }

// As documentation shows it: lists the doubtful constraints of a map and writes
// it without them. Returns their number.
absl::StatusOr<size_t> RemoveDoubtful(const std::string& input,
                                      const std::string& output) {
  // One after the other; a program of many threads would share them out.
  const Executor executor = [](const size_t n,
                               const std::function<void(size_t)>& task) {
    for (size_t k = 0; k < n; ++k) task(k);
  };
  const absl::StatusOr<Audit> audit =
      AuditMap(LoopClosingOptions(), AuditOptions(), input, {}, executor);
  if (!audit.ok()) return audit.status();
  for (const AuditedConstraint& audited : audit->constraints) {
    if (!IsDoubtful(audited.verdict)) continue;
    const Constraint& constraint =
        audit->state.pose_graph.constraints[audited.constraint];
    VLOG(1) << "submap " << constraint.submap << ", node " << constraint.node
            << ": " << AuditVerdictName(audited.verdict);
  }
  const absl::Status status = WriteMap(input, output, audit->pose_graph);
  if (!status.ok()) return status;
  return audit->num_doubtful;
}

// An office with its loops closed, the same with wrong constraints, and the
// audit of that: once for all tests.
class AuditTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory();
    testing::WriteOffice(testing::Slip::kNone, File("open.pbstream"));
    const absl::StatusOr<LoopClosingResult> closed =
        CloseLoops(LoopClosingOptions(), File("open.pbstream"), {}, Threads(2));
    ASSERT_TRUE(closed.ok()) << closed.status();
    ASSERT_TRUE(WriteMap(File("open.pbstream"), File("good.pbstream"),
                         closed->closed.pose_graph)
                    .ok());
    FalsificationOptions options;
    options.num_pairs = 2;
    const absl::StatusOr<FalsifiedMap> falsified = FalsifyMap(
        LoopClosingOptions(), options, File("good.pbstream"), {}, Threads(2));
    ASSERT_TRUE(falsified.ok()) << falsified.status();
    false_constraints_ =
        new std::vector<FalseConstraint>(falsified->false_constraints);
    ASSERT_TRUE(WriteMap(File("good.pbstream"), File("bad.pbstream"),
                         falsified->pose_graph)
                    .ok());
    absl::StatusOr<Audit> audit =
        AuditMap(LoopClosingOptions(), AuditOptions(), File("bad.pbstream"), {},
                 Threads(2));
    ASSERT_TRUE(audit.ok()) << audit.status();
    audit_ = new Audit(*std::move(audit));
  }
  static void TearDownTestSuite() {
    delete audit_;
    delete false_constraints_;
    delete directory_;
  }
  static std::string File(const std::string& name) {
    return directory_->File(name);
  }

  static testing::TemporaryDirectory* directory_;
  static std::vector<FalseConstraint>* false_constraints_;
  static Audit* audit_;
};

testing::TemporaryDirectory* AuditTest::directory_ = nullptr;
std::vector<FalseConstraint>* AuditTest::false_constraints_ = nullptr;
Audit* AuditTest::audit_ = nullptr;

TEST_F(AuditTest, LeavesAGoodMapAsItIs) {
  const absl::StatusOr<size_t> num_doubtful =
      RemoveDoubtful(File("good.pbstream"), File("same.pbstream"));
  ASSERT_TRUE(num_doubtful.ok()) << num_doubtful.status();
  EXPECT_EQ(*num_doubtful, 0u);
  EXPECT_EQ(directory_->Read("same.pbstream"),
            directory_->Read("good.pbstream"));
}

TEST_F(AuditTest, FindsWrongConstraints) {
  std::set<FalseKind> kinds;
  std::set<size_t> wrong;
  for (const FalseConstraint& label : *false_constraints_) {
    kinds.insert(label.kind);
    wrong.insert(label.constraint);
  }
  // An office this small has no different places that look alike.
  EXPECT_GE(kinds.size(), 4u);
  size_t num_right_doubted = 0;
  for (const AuditedConstraint& audited : audit_->constraints) {
    if (wrong.count(audited.constraint) > 0) {
      EXPECT_TRUE(IsDoubtful(audited.verdict))
          << audited.constraint << ": " << AuditVerdictName(audited.verdict);
    } else if (IsDoubtful(audited.verdict)) {
      ++num_right_doubted;
    }
  }
  EXPECT_LE(num_right_doubted, audit_->constraints.size() / 50);
  EXPECT_EQ(audit_->num_doubtful, wrong.size() + num_right_doubted);
  EXPECT_EQ(audit_->pose_graph.constraints.size() + audit_->num_doubtful,
            audit_->state.pose_graph.constraints.size());
}

TEST_F(AuditTest, MakesTheMapOfTheOthers) {
  const absl::StatusOr<MapState> good = ReadMap(File("good.pbstream"));
  ASSERT_TRUE(good.ok()) << good.status();
  double largest = 0.;
  for (const auto& [id, node] : audit_->pose_graph.nodes) {
    const Rigid2& T_map_node = good->pose_graph.nodes.at(id).T_map_node;
    largest = std::max(
        largest,
        (node.T_map_node.translation() - T_map_node.translation()).norm());
  }
  // Right constraints that were dropped may matter by centimetres.
  EXPECT_LT(largest, 0.05);
}

TEST_F(AuditTest, IsTheSameForAnyNumberOfThreads) {
  const absl::StatusOr<Audit> alone =
      AuditMap(LoopClosingOptions(), AuditOptions(), File("bad.pbstream"), {},
               Threads(1));
  ASSERT_TRUE(alone.ok()) << alone.status();
  ASSERT_TRUE(
      WriteMap(File("bad.pbstream"), File("one.pbstream"), alone->pose_graph)
          .ok());
  ASSERT_TRUE(
      WriteMap(File("bad.pbstream"), File("two.pbstream"), audit_->pose_graph)
          .ok());
  EXPECT_EQ(directory_->Read("one.pbstream"), directory_->Read("two.pbstream"));
  EXPECT_NE(directory_->Read("one.pbstream"), directory_->Read("bad.pbstream"));
}

TEST_F(AuditTest, ThresholdsAct) {
  AuditOptions options;
  options.max_contradiction_ratio = 0.;
  options.max_agreeing_translation_meters = 0.;
  const absl::StatusOr<Audit> strict = AuditMap(
      LoopClosingOptions(), options, File("bad.pbstream"), {}, Threads(2));
  ASSERT_TRUE(strict.ok()) << strict.status();
  EXPECT_GT(strict->num_doubtful, audit_->num_doubtful + 20);
}

TEST_F(AuditTest, SaysWhatIsWrongWithTheFile) {
  directory_->Write("broken.pbstream", "not a map");
  const absl::StatusOr<Audit> audit =
      AuditMap(LoopClosingOptions(), AuditOptions(), File("broken.pbstream"),
               {}, Threads(1));
  ASSERT_FALSE(audit.ok());
  EXPECT_THAT(std::string(audit.status().message()),
              ::testing::HasSubstr("broken.pbstream"));
}

// The walls of the spoilt map agree nearly as well as those of the good one: a
// robust loss keeps the wrong constraints from bending it.
// The constraints of the map, as a list to drop.
std::vector<ListedConstraint> ListOf(const PoseGraph& pose_graph,
                                     const std::set<size_t>& indices) {
  std::vector<ListedConstraint> list;
  for (const size_t k : indices) {
    list.push_back(
        {k, pose_graph.constraints[k].submap, pose_graph.constraints[k].node});
  }
  return list;
}

TEST_F(AuditTest, DropsWhatAListSaysAndNothingElse) {
  const PoseGraph& before = audit_->state.pose_graph;
  ASSERT_GT(audit_->num_doubtful, 2u);
  EXPECT_EQ(audit_->dropped.size(), audit_->num_doubtful);
  // One that is doubtful is kept, one that is not is dropped.
  std::set<size_t> chosen = audit_->dropped;
  chosen.erase(chosen.begin());
  for (const AuditedConstraint& audited : audit_->constraints) {
    if (IsDoubtful(audited.verdict)) continue;
    chosen.insert(audited.constraint);
    break;
  }
  const auto audit_with = [](const std::vector<ListedConstraint>& list) {
    return AuditMap(LoopClosingOptions(), AuditOptions(), File("bad.pbstream"),
                    {}, Threads(2), {}, list);
  };
  const absl::StatusOr<Audit> listed = audit_with(ListOf(before, chosen));
  ASSERT_TRUE(listed.ok()) << listed.status();
  EXPECT_EQ(listed->dropped, chosen);
  EXPECT_EQ(listed->pose_graph.constraints.size(),
            before.constraints.size() - chosen.size());
  // What is judged is the same.
  EXPECT_EQ(listed->num_doubtful, audit_->num_doubtful);
  for (size_t k = 0; k < listed->constraints.size(); ++k) {
    EXPECT_EQ(listed->constraints[k].verdict, audit_->constraints[k].verdict);
  }
  // The reader's choice is not refused.
  EXPECT_EQ(listed->refusal, "");
  const absl::StatusOr<Audit> nothing = audit_with({});
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(nothing->pose_graph.constraints.size(), before.constraints.size());
  EXPECT_EQ(nothing->optimizations.size(), audit_->optimizations.size() - 1);
}

TEST_F(AuditTest, RefusesListsOfOtherMaps) {
  const PoseGraph& before = audit_->state.pose_graph;
  const size_t doubtful = *audit_->dropped.begin();
  const std::vector<ListedConstraint> good = ListOf(before, {doubtful});
  const auto error_of = [](const std::vector<ListedConstraint>& list) {
    const absl::StatusOr<Audit> audit =
        AuditMap(LoopClosingOptions(), AuditOptions(), File("bad.pbstream"), {},
                 Threads(2), {}, list);
    return audit.ok() ? "" : std::string(audit.status().message());
  };
  EXPECT_THAT(error_of({good[0], good[0]}), HasSubstr("listed twice"));
  std::vector<ListedConstraint> wrong(4, good[0]);
  wrong[0].constraint = before.constraints.size();
  wrong[1].node.index += 1;
  wrong[2].submap.trajectory = -5;
  wrong[3].constraint = std::numeric_limits<size_t>::max();
  for (const ListedConstraint& one : wrong) {
    EXPECT_THAT(error_of({one}), HasSubstr("made for another map"));
  }
  // An intra-submap constraint is what a submap is made of.
  for (size_t k = 0; k < before.constraints.size(); ++k) {
    if (before.constraints[k].tag == Constraint::Tag::kInterSubmap) continue;
    EXPECT_THAT(error_of(ListOf(before, {k})), HasSubstr("another map"));
    break;
  }
}

TEST_F(AuditTest, MeasuresWalls) {
  const MapQuality& spoilt = audit_->quality_before;
  const MapQuality& mended = audit_->quality_after;
  EXPECT_GT(spoilt.num_pairs, 10u);
  EXPECT_GT(mended.num_pairs, 10u);
  EXPECT_LT(mended.contradiction_ratio, 0.01);
  EXPECT_NEAR(spoilt.contradiction_ratio, mended.contradiction_ratio, 0.001);
  EXPECT_LT(mended.wall_distance, 0.05);
  EXPECT_EQ(audit_->refusal, "");
}

// All constraints are doubted, and drift returns.
TEST(DriftingMapAuditTest, RefusesAMapThatIsWorseThanTheOneRead) {
  const testing::TemporaryDirectory directory;
  testing::WriteOffice(testing::Slip::kNone, directory.File("open.pbstream"));
  PoseGraph graph;
  {
    const absl::StatusOr<LoopClosingResult> closed = CloseLoops(
        LoopClosingOptions(), directory.File("open.pbstream"), {}, Threads(2));
    ASSERT_TRUE(closed.ok()) << closed.status();
    graph = closed->closed.pose_graph;
  }
  ASSERT_TRUE(WriteMap(directory.File("open.pbstream"),
                       directory.File("good.pbstream"), graph)
                  .ok());
  AuditOptions options;
  options.min_score = 1e3;
  options.max_agreeing_translation_meters = 0.;
  const absl::StatusOr<Audit> audit =
      AuditMap(LoopClosingOptions(), options, directory.File("good.pbstream"),
               {}, Threads(2));
  ASSERT_TRUE(audit.ok()) << audit.status();
  EXPECT_EQ(audit->num_doubtful, audit->constraints.size());
  EXPECT_GT(audit->quality_after.contradiction_ratio,
            audit->quality_before.contradiction_ratio + 0.002);
  EXPECT_THAT(audit->refusal, ::testing::HasSubstr("free space"));
}

// Poor wheel odometry with a large weight: each constraint that went let it
// pull farther, until 62 of 150 right ones were gone.
TEST(RealMapAuditTest, OdometryIsNoWitness) {
  SKIP_WITHOUT_SHARED_DATA("field/poor_odometry.pbstream");
  const absl::StatusOr<Audit> audit =
      AuditMap(LoopClosingOptions(), AuditOptions(),
               SharedDataPath("field/poor_odometry.pbstream"), {}, Threads(2));
  ASSERT_TRUE(audit.ok()) << audit.status();
  EXPECT_EQ(audit->constraints.size(), 150u);
  EXPECT_EQ(audit->num_doubtful, 0u);
  EXPECT_LT(audit->quality_before.contradiction_ratio, 0.01);
}

// Users' maps have no truth; this one has no constraint that looks wrong.
TEST(RealMapAuditTest, LeavesTheArenaAsItIs) {
  SKIP_WITHOUT_SHARED_DATA("user_map_arena.pbstream");
  const absl::StatusOr<Audit> audit =
      AuditMap(LoopClosingOptions(), AuditOptions(),
               SharedDataPath("user_map_arena.pbstream"), {}, Threads(2));
  ASSERT_TRUE(audit.ok()) << audit.status();
  EXPECT_EQ(audit->constraints.size(), 10838u);
  EXPECT_EQ(audit->num_doubtful, 0u);
}

}  // namespace
}  // namespace cartographer_sdf::audit_test
