// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// No option of closing loops is without effect.

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/closing/pipeline.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "gtest/gtest.h"
#include "test/testing/option_effects.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::closing_option_effects_test {
namespace {

using testing::VisitedRooms;

constexpr double kVeryMuch = 1e9;

std::ostream& operator<<(std::ostream& out, const Tear& tear) {
  return out << tear.first_part << " " << tear.second_part << " "
             << tear.translation << " " << tear.agreement_as_placed << " "
             << tear.agreement_as_registered << " " << tear.num_points;
}

std::string Text(const ClosedGraph& closed) {
  std::ostringstream text;
  text.precision(17);
  for (const auto& [id, tear] : closed.torn_submaps) {
    text << "torn " << id << " " << tear << "\n";
  }
  for (const Closure& closure : closed.closures) {
    text << closure.match.pair.reference << " " << closure.match.pair.query
         << " " << ClosureStatusName(closure.status) << " "
         << closure.constraints.size() << " " << closure.graph_error.translation
         << " " << closure.graph_error.rotation << "\n";
  }
  for (const Constraint& constraint : closed.pose_graph.constraints) {
    text << constraint.T_submap_node.translation().x() << " "
         << constraint.translation_weight << " " << constraint.rotation_weight
         << "\n";
  }
  for (const auto& [id, node] : closed.pose_graph.nodes) {
    text << node.T_map_node.translation().transpose() << " "
         << node.T_map_node.rotation() << "\n";
  }
  return text.str();
}

class ClosingOptionEffectsTest : public ::testing::Test {
 protected:
  // As close_loops does it: two true closures, one of the last submap, which is
  // torn; a false one, and one that is right but hardly certain.
  [[nodiscard]] std::string Close(const ClosingOptions& options) const {
    const std::vector<Match> matches = {
        rooms_.MakeMatch(VisitedRooms::kWestFirst, VisitedRooms::kWestAgain,
                         9.),
        rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kEastAgain,
                         4.5),
        rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kEastAgain, 4.,
                         Rigid2(1.8, 1., 0.12)),
        rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kEastAgain, 3.,
                         Rigid2(0.05, 0., 0.))};
    const DescribedMap& map = rooms_.map();
    ClosingOptions in_force = options;
    in_force.optimization = OptimizationInForce(options, map.state.pose_graph);
    std::vector<std::pair<std::string, double>> seconds;
    StageClock clock({}, &seconds);
    return Text(CloseGraph(
        in_force,
        {&map.state.pose_graph, &map.odometry, &map.places, &map.point_clouds},
        matches, {}, MakeExecutor(1), &clock));
  }

  const VisitedRooms rooms_{Rigid2(0.35, 0.3, 0.05)};
};

TEST_F(ClosingOptionEffectsTest, NoneIsWithout) {
  ClosingOptions base;
  // Few parts, which is faster; and only where the tear is what matters.
  base.detect_torn_submaps = false;
  base.tear.num_parts = 2;
  base.tear.min_agreement = 0.5;
  const auto with = [this](void (*set)(ClosingOptions*)) {
    return [this, set](const ClosingOptions& options) {
      ClosingOptions changed = options;
      set(&changed);
      return Close(changed);
    };
  };
  const auto all_enter = [](ClosingOptions* const options) {
    options->consistency.max_cycle_sigma_meters = 1e-6;
    options->consistency.min_unsupported_score = -kVeryMuch;
    options->constraints.max_num_sigmas = 1e3;
    options->constraints.min_hit_ratio = 0.;
  };
  const std::vector<testing::Scenario<ClosingOptions>> scenarios = {
      {"", [this](const ClosingOptions& options) { return Close(options); }},
      {"constraints.min_num_constraints", with([](ClosingOptions* options) {
         options->constraints.num_nodes_per_submap = 4;
       })},
      {"tear.", with([](ClosingOptions* options) {
         options->detect_torn_submaps = true;
       })},
      // The tear reaches either of the two: so that one is left.
      {"tear.min_translation_meters", with([](ClosingOptions* options) {
         options->detect_torn_submaps = true;
         options->tear.min_rotation = kVeryMuch;
       })},
      {"tear.min_rotation", with([](ClosingOptions* options) {
         options->detect_torn_submaps = true;
         options->tear.min_translation_meters = kVeryMuch;
       })},
      {"optimization.odometry_", with([](ClosingOptions* options) {
         options->infer_odometry_weights = false;
       })},
      // Of the size of local SLAM's noise here.
      {"optimization.min_slip_angle", with([](ClosingOptions* options) {
         options->optimization.min_slip_angle *= 0.01;
       })},
      {"outlier_rejection.max_num_rounds", with(all_enter)},
      {"outlier_rejection.max_translation_error_meters",
       [this, all_enter](const ClosingOptions& options) {
         ClosingOptions changed = options;
         all_enter(&changed);
         changed.outlier_rejection.max_rotation_error = kVeryMuch;
         return Close(changed);
       }},
      {"outlier_rejection.max_rotation_error",
       [this, all_enter](const ClosingOptions& options) {
         ClosingOptions changed = options;
         all_enter(&changed);
         changed.outlier_rejection.max_translation_error_meters = kVeryMuch;
         return Close(changed);
       }},
  };
  EXPECT_EQ(testing::OptionsWithoutEffect(base, scenarios), "");
}

}  // namespace
}  // namespace cartographer_sdf::closing_option_effects_test
