// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/graph_submaps.h"

#include <algorithm>
#include <iterator>
#include <random>
#include <set>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::graph_submaps_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

TEST(GraphSubmapsTest, SaysOnceWhatIsGone) {
  GraphSubmaps submaps;
  EXPECT_THAT(submaps.Update(7, {0, 1, 2}, 3), IsEmpty());
  EXPECT_TRUE(submaps.Contains({7, 1}));
  EXPECT_FALSE(submaps.Contains({6, 1}));
  EXPECT_THAT(submaps.Update(7, {0, 2, 3}, 4), ElementsAre(1));
  EXPECT_FALSE(submaps.Contains({7, 1}));
  EXPECT_THAT(submaps.Update(7, {0, 2, 3}, 4), IsEmpty());
  EXPECT_THAT(submaps.Update(7, {}, 4), ElementsAre(0, 2, 3));
  EXPECT_THAT(submaps.Update(7, {}, 4), IsEmpty());
}

TEST(GraphSubmapsTest, FindsWhatNoUpdateHasShown) {
  GraphSubmaps submaps;
  EXPECT_THAT(submaps.Update(0, {0, 1}, 2), IsEmpty());
  EXPECT_THAT(submaps.Update(0, {5, 6}, 7),
              UnorderedElementsAre(0, 1, 2, 3, 4));
  // The trajectory ended with ten submaps.
  EXPECT_THAT(submaps.Update(0, {}, 10), UnorderedElementsAre(5, 6, 7, 8, 9));
}

TEST(GraphSubmapsTest, WaitsForThoseThatMayBeOnTheirWay) {
  GraphSubmaps submaps;
  // Loaded from a file with the last one first.
  EXPECT_THAT(submaps.Update(0, {}, 0), IsEmpty());
  EXPECT_THAT(submaps.Update(0, {2, 3}, 0), IsEmpty());
  EXPECT_THAT(submaps.Update(0, {3}, 0), ElementsAre(2));
  EXPECT_THAT(submaps.Update(0, {1, 3}, 4), ElementsAre(0));
  EXPECT_THAT(submaps.Update(0, {1}, 4), ElementsAre(3));
}

TEST(GraphSubmapsTest, IsUpToDateOnlyIfNothingWouldChange) {
  GraphSubmaps submaps;
  EXPECT_FALSE(submaps.IsUpToDate(0, 0, 0));
  (void)submaps.Update(0, {1, 2}, 2);
  EXPECT_TRUE(submaps.IsUpToDate(0, 2, 2));
  EXPECT_FALSE(submaps.IsUpToDate(0, 1, 2));
  EXPECT_FALSE(submaps.IsUpToDate(0, 2, 3));
}

// A graph in which submaps enter in order and leave in any, looked at now and
// then: none that lives or waits is called gone, and in the end all that left
// were.
TEST(GraphSubmapsTest, AgreesWithAGraphThatComesAndGoes) {
  std::mt19937 engine(42);
  int num_missed_by_looks = 0;
  for (int run = 0; run < 100; ++run) {
    GraphSubmaps submaps;
    std::set<int> in_graph, seen, left, gone;
    int num_entered = 0;
    const auto look = [&] {
      const std::vector<int> indices(in_graph.begin(), in_graph.end());
      seen.insert(indices.begin(), indices.end());
      const int num_known = indices.empty() ? 0 : indices.back() + 1;
      for (const int index : submaps.Update(0, indices, num_known)) {
        EXPECT_EQ(left.count(index), 1u);
        EXPECT_TRUE(gone.insert(index).second);
      }
    };
    for (int step = 0; step < 200; ++step) {
      const int action = testing::UniformInt(8, &engine);
      if (action < 4) in_graph.insert(num_entered++);
      if (action >= 4 && action < 7 && !in_graph.empty()) {
        const auto leaving = std::next(
            in_graph.begin(),
            testing::UniformInt(static_cast<int>(in_graph.size()), &engine));
        left.insert(*leaving);
        in_graph.erase(leaving);
      }
      if (action == 7) look();
    }
    for (const int index :
         submaps.Update(0, {in_graph.begin(), in_graph.end()}, num_entered)) {
      EXPECT_TRUE(gone.insert(index).second);
    }
    EXPECT_EQ(gone, left);
    num_missed_by_looks += static_cast<int>(
        std::count_if(left.begin(), left.end(),
                      [&](const int index) { return seen.count(index) == 0; }));
  }
  EXPECT_GT(num_missed_by_looks, 100);
}

}  // namespace
}  // namespace cartographer_sdf::graph_submaps_test
