// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/audit/audit.h"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/audit/false_constraints.h"
#include "cartographer_sdf/evaluation/trajectory_error.h"
#include "cartographer_sdf/evaluation/truth.h"
#include "cartographer_sdf/tools/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/slipped_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf {
namespace {

Executor Threads(const int num_threads) {
  return
      [num_threads](const size_t n, const std::function<void(size_t)>& task) {
        ParallelFor(static_cast<int>(n), num_threads,
                    [&task](const int i) { task(static_cast<size_t>(i)); });
      };
}

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
    LOG(INFO) << "submap " << constraint.submap << ", node " << constraint.node
              << ": " << AuditVerdictName(audited.verdict);
  }
  const absl::Status status = WriteMap(input, output, audit->pose_graph);
  if (!status.ok()) return status;
  return audit->num_doubtful;
}

class AuditTest : public ::testing::Test {
 protected:
  // An office with its loops closed, and the same with wrong constraints: once
  // for all tests.
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory();
    testing::WriteOffice(testing::Slip::kNone, File("open.pbstream"));
    const absl::StatusOr<LoopClosingResult> closed =
        CloseLoops(LoopClosingOptions(), File("open.pbstream"), {}, Threads(2));
    ASSERT_TRUE(closed.ok()) << closed.status();
    ASSERT_TRUE(WriteMap(File("open.pbstream"), File("good.pbstream"),
                         closed->pose_graph)
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
  }
  static void TearDownTestSuite() {
    delete false_constraints_;
    delete directory_;
  }
  static std::string File(const std::string& name) {
    return directory_->File(name);
  }
  static double MeanNodeError(const std::string& name) {
    const absl::StatusOr<MapState> map = ReadMap(File(name));
    const absl::StatusOr<Truth> truth =
        ReadTruth(File("open.pbstream.truth.csv"));
    CHECK(map.ok() && truth.ok());
    return EvaluateTrajectory(map->pose_graph, *truth)->errors.translation.mean;
  }

  static testing::TemporaryDirectory* directory_;
  static std::vector<FalseConstraint>* false_constraints_;
};

testing::TemporaryDirectory* AuditTest::directory_ = nullptr;
std::vector<FalseConstraint>* AuditTest::false_constraints_ = nullptr;

TEST_F(AuditTest, LeavesAGoodMapAsItIs) {
  const absl::StatusOr<size_t> num_doubtful =
      RemoveDoubtful(File("good.pbstream"), File("same.pbstream"));
  ASSERT_TRUE(num_doubtful.ok()) << num_doubtful.status();
  EXPECT_EQ(*num_doubtful, 0u);
  EXPECT_EQ(directory_->Read("same.pbstream"),
            directory_->Read("good.pbstream"));
}

TEST_F(AuditTest, FindsWrongConstraintsOfEachKind) {
  std::set<FalseKind> kinds;
  std::set<size_t> wrong;
  for (const FalseConstraint& label : *false_constraints_) {
    kinds.insert(label.kind);
    wrong.insert(label.constraint);
  }
  ASSERT_EQ(kinds.size(), AllFalseKinds().size());
  const absl::StatusOr<Audit> audit =
      AuditMap(LoopClosingOptions(), AuditOptions(), File("bad.pbstream"), {},
               Threads(2));
  ASSERT_TRUE(audit.ok()) << audit.status();
  size_t num_good_doubted = 0;
  for (const AuditedConstraint& audited : audit->constraints) {
    if (wrong.count(audited.constraint) > 0) {
      EXPECT_TRUE(IsDoubtful(audited.verdict))
          << audited.constraint << ": " << AuditVerdictName(audited.verdict);
    } else if (IsDoubtful(audited.verdict)) {
      ++num_good_doubted;
    }
  }
  EXPECT_LE(num_good_doubted, audit->constraints.size() / 50);
  EXPECT_EQ(audit->num_doubtful, wrong.size() + num_good_doubted);
  EXPECT_EQ(audit->pose_graph.constraints.size() + audit->num_doubtful,
            audit->state.pose_graph.constraints.size());
}

TEST_F(AuditTest, StraightensTheMap) {
  ASSERT_TRUE(
      RemoveDoubtful(File("bad.pbstream"), File("mended.pbstream")).ok());
  const double good = MeanNodeError("good.pbstream");
  // Else the test shows nothing.
  EXPECT_GT(MeanNodeError("bad.pbstream"), good + 0.1);
  EXPECT_LT(MeanNodeError("mended.pbstream"), good + 0.02);
}

TEST_F(AuditTest, IsTheSameForAnyNumberOfThreads) {
  for (const int num_threads : {1, 3}) {
    const absl::StatusOr<Audit> audit =
        AuditMap(LoopClosingOptions(), AuditOptions(), File("bad.pbstream"), {},
                 Threads(num_threads));
    ASSERT_TRUE(audit.ok()) << audit.status();
    ASSERT_TRUE(WriteMap(File("bad.pbstream"),
                         File(std::to_string(num_threads) + ".pbstream"),
                         audit->pose_graph)
                    .ok());
  }
  EXPECT_EQ(directory_->Read("1.pbstream"), directory_->Read("3.pbstream"));
  EXPECT_NE(directory_->Read("1.pbstream"), directory_->Read("bad.pbstream"));
}

TEST_F(AuditTest, ThresholdsAct) {
  const auto count = [](const AuditOptions& options) {
    const absl::StatusOr<Audit> audit = AuditMap(
        LoopClosingOptions(), options, File("bad.pbstream"), {}, Threads(2));
    CHECK(audit.ok()) << audit.status();
    std::map<AuditVerdict, size_t> verdicts;
    for (const AuditedConstraint& audited : audit->constraints) {
      ++verdicts[audited.verdict];
    }
    return verdicts;
  };
  AuditOptions options;
  options.max_contradiction_ratio = 1.;
  EXPECT_EQ(count(options).count(AuditVerdict::kContradicted), 0u);
  options = AuditOptions();
  options.max_contradiction_ratio = 0.;
  options.max_agreeing_translation_meters = 0.;
  EXPECT_GT(count(options)[AuditVerdict::kContradicted], 20u);
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
}  // namespace cartographer_sdf
