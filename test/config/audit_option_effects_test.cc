// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// No option of the audit and of reports is without effect.

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/audit.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/reports.h"
#include "gtest/gtest.h"
#include "test/testing/option_effects.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::audit_option_effects_test {
namespace {

using testing::VisitedRooms;

constexpr double kVeryMuch = 1e9;

std::string Text(const Audit& audit) {
  std::ostringstream text;
  text.precision(17);
  for (const AuditedGroup& group : audit.groups) {
    text << group.group.reference << " " << group.group.query << " "
         << group.group.constraints.size() << " "
         << AuditVerdictName(group.verdict) << " " << group.claim.is_held
         << "\n";
  }
  for (const AuditedConstraint& constraint : audit.constraints) {
    text << constraint.constraint << " " << AuditVerdictName(constraint.verdict)
         << "\n";
  }
  return text.str();
}

class AuditOptionEffectsTest : public ::testing::Test {
 protected:
  AuditOptionEffectsTest() {
    PoseGraph graph = rooms_.map().state.pose_graph;
    // Where the node would be if it had been elsewhere in the world, and off by
    // `error` in its own frame.
    const auto add = [&](const SubmapId& submap, const int node,
                         const Rigid2& T_world_wrong, const Rigid2& error) {
      const NodeId id{0, node};
      graph.constraints.push_back({submap, id,
                                   rooms_.T_world_submap(submap).Inverse() *
                                       T_world_wrong * rooms_.T_world_node(id) *
                                       error,
                                   1.1e4, 1e5, Constraint::Tag::kInterSubmap});
    };
    constexpr int kWestNodes = 2 * VisitedRooms::kNodesPerSubmap;
    constexpr int kEastNodes = 3 * VisitedRooms::kNodesPerSubmap;
    for (const int k : {1, 5, 9}) {
      add(VisitedRooms::kWestFirst, kWestNodes + k, {}, {});
      add(VisitedRooms::kEastFirst, kEastNodes + k, {}, {});
    }
    // Somewhat wrong, which makes them groups of their own or not.
    add(VisitedRooms::kWestFirst, kWestNodes + 3, {}, Rigid2(0.3, 0., 0.));
    add(VisitedRooms::kEastFirst, kEastNodes + 3, {}, Rigid2(0., 0., 0.1));
    // Wrong: the east room over the west room.
    add(VisitedRooms::kWestFirst, kEastNodes + 6, Rigid2(-8.4, 0.8, 0.), {});
    const absl::Status status = WriteMap(rooms_.Path(), Path(), graph);
    CHECK(status.ok()) << status;
  }

  [[nodiscard]] std::string Path() const {
    return rooms_.directory().File("audited.pbstream");
  }
  [[nodiscard]] std::string AuditAs(
      const AuditOptions& options,
      const ConsistencyOptions& consistency = {}) const {
    LoopClosingOptions loop_closing;
    loop_closing.closing.consistency = consistency;
    const absl::StatusOr<Audit> audit =
        AuditMap(loop_closing, options, Path(), {}, MakeExecutor(1));
    CHECK(audit.ok()) << audit.status();
    return Text(*audit);
  }
  // Where nothing but the map speaks against a constraint.
  [[nodiscard]] std::string AuditByMap(AuditOptions options) const {
    options.max_contradiction_ratio = 1.;
    options.min_margin = -kVeryMuch;
    options.min_score = -kVeryMuch;
    options.max_agreeing_translation_meters = 0.;
    ConsistencyOptions consistency;
    consistency.max_cycle_sigma_meters = 1e-6;
    consistency.min_unsupported_score = -kVeryMuch;
    return AuditAs(options, consistency);
  }

  const VisitedRooms rooms_;
};

TEST_F(AuditOptionEffectsTest, NoneOfTheAuditIsWithout) {
  // Where every constraint is doubtful, unless the map agrees.
  const auto strict = [this](const AuditOptions& options) {
    AuditOptions changed = options;
    changed.min_score = kVeryMuch;
    return AuditAs(changed);
  };
  const std::vector<testing::Scenario<AuditOptions>> scenarios = {
      {"", [this](const AuditOptions& options) { return AuditAs(options); }},
      {"max_contradiction_ratio",
       [this](const AuditOptions& options) {
         // Where no cycle speaks against a constraint.
         ConsistencyOptions consistency;
         consistency.max_cycle_sigma_meters = 1e-6;
         return AuditAs(options, consistency);
       }},
      {"max_agreeing_", strict},
      {"outlier_rejection.max_num_rounds",
       [this](const AuditOptions& options) { return AuditByMap(options); }},
      {"outlier_rejection.max_translation_error_meters",
       [this](const AuditOptions& options) {
         AuditOptions changed = options;
         changed.outlier_rejection.max_rotation_error = kVeryMuch;
         return AuditByMap(changed);
       }},
      {"outlier_rejection.max_rotation_error",
       [this](const AuditOptions& options) {
         AuditOptions changed = options;
         changed.outlier_rejection.max_translation_error_meters = kVeryMuch;
         return AuditByMap(changed);
       }},
  };
  EXPECT_EQ(testing::OptionsWithoutEffect(AuditOptions(), scenarios), "");
}

TEST_F(AuditOptionEffectsTest, NoneOfReportsIsWithout) {
  LoopClosingResult result;
  result.state = rooms_.map().state;
  result.closed.pose_graph = result.state.pose_graph;
  result.closed.closures = MakeClosures(
      {rooms_.MakeMatch(VisitedRooms::kWestFirst, VisitedRooms::kWestAgain, 9.),
       rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kEastAgain,
                        9.)});
  ReportOptions base;
  base.map_picture_pixels = 100;
  base.submap_picture_pixels = 60;
  base.max_submap_pictures = 2;
  const std::vector<testing::Scenario<ReportOptions>> scenarios = {
      {"", [&](const ReportOptions& options) {
         const absl::Status status = WriteCloseLoopsReport(
             {rooms_.directory().path(), options, ""}, LoopClosingOptions(),
             "map", result, [this](const SubmapCallback& on_submap) {
               return ReadMap(rooms_.Path(), {on_submap, {}}).status();
             });
         CHECK(status.ok()) << status;
         return rooms_.directory().Read("index.html");
       }}};
  EXPECT_EQ(testing::OptionsWithoutEffect(base, scenarios), "");
}

}  // namespace
}  // namespace cartographer_sdf::audit_option_effects_test
