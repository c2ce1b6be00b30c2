// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/execution/progress.h"

#include <algorithm>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::progress_test {
namespace {

using ::testing::ElementsAre;

TEST(TaskProgressTest, GoesFromBeginToEnd) {
  std::vector<double> fractions;
  const ProgressCallback on_progress = [&fractions](const double fraction) {
    fractions.push_back(fraction);
  };
  TaskProgress progress(on_progress, 2, 0.5, 0.75);
  progress.TaskIsDone();
  progress.TaskIsDone();
  EXPECT_THAT(fractions, ElementsAre(0.625, 0.75));
}

TEST(TaskProgressTest, IncreasesWhateverThreadsRun) {
  constexpr size_t kNumTasks = 500;
  std::vector<double> fractions;
  const ProgressCallback on_progress = [&fractions](const double fraction) {
    fractions.push_back(fraction);
  };
  TaskProgress progress(on_progress, kNumTasks);
  MakeExecutor(4)(kNumTasks, [&progress](size_t) { progress.TaskIsDone(); });
  ASSERT_EQ(fractions.size(), kNumTasks);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.);
}

}  // namespace
}  // namespace cartographer_sdf::progress_test
