// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/execution/parallel_for.h"

#include <algorithm>
#include <set>
#include <thread>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::parallel_for_test {
namespace {

TEST(ParallelForTest, CallsEachIndexOnce) {
  for (const int n : {0, 1, 2, 7, 1000}) {
    for (const int num_threads : {1, 2, 8, 2000}) {
      if (n == 1000 && num_threads == 2000) continue;
      std::vector<int> calls(static_cast<size_t>(n), 0);
      ParallelFor(n, num_threads, [&calls](const int i) {
        calls[static_cast<size_t>(i)] += 1 + i;
      });
      for (int i = 0; i < n; ++i) {
        EXPECT_EQ(calls[static_cast<size_t>(i)], 1 + i);
      }
    }
  }
}

TEST(ParallelForTest, OneThreadIsTheCallers) {
  std::set<std::thread::id> threads;
  ParallelFor(50, 1,
              [&threads](int) { threads.insert(std::this_thread::get_id()); });
  EXPECT_THAT(threads, testing::ElementsAre(std::this_thread::get_id()));
}

TEST(ParallelForTest, RunsAtTheSameTime) {
  // Each call waits for the other one: with a single thread it would not end.
  std::atomic<int> num_arrived{0};
  ParallelFor(2, 2, [&num_arrived](int) {
    ++num_arrived;
    while (num_arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(num_arrived, 2);
}

TEST(ParallelForTest, ReportsIncreasingProgress) {
  for (const int num_threads : {1, 4}) {
    std::vector<double> fractions;
    ParallelFor(
        200, num_threads, [](int) {},
        [&fractions](const double fraction) { fractions.push_back(fraction); });
    ASSERT_EQ(fractions.size(), 200u);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_DOUBLE_EQ(fractions.front(), 1. / 200.);
    EXPECT_DOUBLE_EQ(fractions.back(), 1.);
  }
}

}  // namespace
}  // namespace cartographer_sdf::parallel_for_test
