// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/closure_table.h"

#include <set>

#include "cartographer_sdf/config/option_binding.h"
#include "cartographer_sdf/config/option_keys.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::closure_table_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

std::set<std::string> OptionPaths() {
  std::set<std::string> paths;
  for (const auto& [path, value] : ListOptions(Options())) paths.insert(path);
  return paths;
}

Closure MakeClosure(const ClosureStatus status, const double score) {
  Closure closure;
  closure.status = status;
  closure.match.pair = {{0, 1}, {0, 9}, Rigid2(), score};
  closure.match.verdict = Verdict::kAccepted;
  closure.graph_error = {0.25, 0.1};
  return closure;
}

Match MakeRefused(const Verdict verdict, const double score) {
  Match match;
  match.pair = {{0, 2}, {0, 8}, Rigid2(), score};
  match.verdict = verdict;
  return match;
}

std::vector<std::string> StatusesOf(const InspectedTable& table) {
  std::vector<std::string> statuses;
  for (const InspectedRow& row : table.rows) statuses.push_back(row.status);
  return statuses;
}

TEST(ClosureTableTest, EveryOptionThatItNamesExists) {
  const InspectedTable table = MakeClosureTable({}, {}, {});
  const std::set<std::string> paths = OptionPaths();
  for (const Measure& measure : table.measures) {
    if (measure.bound == Measure::Bound::kNone) continue;
    EXPECT_THAT(paths, Contains(measure.option)) << measure.name;
  }
  for (const RowStatus& status : table.statuses) {
    if (status.option.empty()) continue;
    EXPECT_THAT(paths, Contains(status.option)) << status.name;
  }
}

TEST(ClosureTableTest, EveryStatusOfAMapHasWords) {
  std::set<std::string> names;
  for (const RowStatus& status : MakeClosureTable({}, {}, {}).statuses) {
    EXPECT_TRUE(names.insert(status.name).second) << status.name;
    EXPECT_NE(status.label, "");
    EXPECT_NE(status.meaning, "");
  }
  for (const ClosureStatus status :
       {ClosureStatus::kInGraph, ClosureStatus::kInconsistent,
        ClosureStatus::kUnsupported, ClosureStatus::kScansDisagree,
        ClosureStatus::kOutlier, ClosureStatus::kAlreadyInGraph,
        ClosureStatus::kRedundant}) {
    EXPECT_THAT(names, Contains(ClosureStatusName(status)));
  }
  for (const Verdict verdict :
       {Verdict::kTooLittleOverlap, Verdict::kContradicted, Verdict::kUnlikely,
        Verdict::kDegenerate, Verdict::kAmbiguous}) {
    EXPECT_THAT(names, Contains(VerdictName(verdict)));
  }
}

TEST(ClosureTableTest, WhatDeservesALookComesFirst) {
  const InspectedTable table =
      MakeClosureTable({},
                       {MakeClosure(ClosureStatus::kRedundant, 5.),
                        MakeClosure(ClosureStatus::kInGraph, 9.),
                        MakeClosure(ClosureStatus::kInGraph, 6.),
                        MakeClosure(ClosureStatus::kUnsupported, 5.),
                        MakeClosure(ClosureStatus::kOutlier, 12.)},
                       {MakeRefused(Verdict::kUnlikely, -3.),
                        MakeRefused(Verdict::kUnlikely, 1.)});
  EXPECT_THAT(StatusesOf(table),
              ElementsAre("outlier", "unsupported", "in_graph", "in_graph",
                          "redundant", "unlikely", "unlikely"));
  // The least certain closure, the most likely of what was refused.
  EXPECT_EQ(table.rows[2].pair->score, 6.);
  EXPECT_EQ(table.rows[5].pair->score, 1.);
}

TEST(ClosureTableTest, EachNumberHasItsMeasure) {
  const InspectedTable table =
      MakeClosureTable({}, {MakeClosure(ClosureStatus::kOutlier, 0.)},
                       {MakeRefused(Verdict::kUnlikely, 0.)});
  const auto value = [&table](const size_t row, const std::string& name) {
    for (size_t k = 0; k < table.measures.size(); ++k) {
      if (table.measures[k].name == name) return table.rows[row].values.at(k);
    }
    return std::optional<double>();
  };
  for (const InspectedRow& row : table.rows) {
    EXPECT_EQ(row.values.size(), table.measures.size());
  }
  EXPECT_DOUBLE_EQ(value(0, "probability").value(), 50.);
  EXPECT_DOUBLE_EQ(value(0, "error").value(), 0.25);
  EXPECT_NEAR(value(0, "rotation_error").value(), 5.73, 0.01);
  // What is not in a graph has no error there.
  EXPECT_FALSE(value(1, "error").has_value());
  EXPECT_FALSE(value(1, "confirming").has_value());
}

TEST(ClosureTableTest, LimitsItsRows) {
  const std::vector<Match> refused(kMaxTableRows + 5,
                                   MakeRefused(Verdict::kUnlikely, 0.));
  const InspectedTable table =
      MakeClosureTable({}, {MakeClosure(ClosureStatus::kOutlier, 0.)}, refused);
  EXPECT_EQ(table.rows.size(), kMaxTableRows);
  EXPECT_EQ(table.num_unlisted, 6u);
}

TEST(ClosureTableTest, WallDistanceIsOfClosuresInTheGraph) {
  EXPECT_FALSE(WallDistanceInGraph({MakeClosure(ClosureStatus::kOutlier, 0.)})
                   .has_value());
  Closure closure = MakeClosure(ClosureStatus::kInGraph, 0.);
  closure.match.evidence.query_in_reference = {64., 60., 0., 60. * 0.04 * 0.04};
  closure.match.evidence.reference_in_query =
      closure.match.evidence.query_in_reference;
  EXPECT_NEAR(WallDistanceInGraph({closure, closure}).value(), 0.04, 1e-9);
}

}  // namespace
}  // namespace cartographer_sdf::closure_table_test
