// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How a program, or a ROS service, uses the library: the example that
// docs/sessions.md points at, and what it finds.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/merge.h"
#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_offices.h"

// --- The example.
// -------------------------------------------------------------

namespace example {

using namespace cartographer_sdf;  // NOLINT: as a user may write

// Tasks run wherever the caller likes: here, one after the other.
void RunInOrder(const size_t n, const std::function<void(size_t)>& task) {
  for (size_t k = 0; k < n; ++k) task(k);
}

// A service that knows a map and is asked where drives are in it.
class RelocalizationService {
 public:
  // The map is read and described once, which takes the most time.
  static absl::StatusOr<RelocalizationService> Open(const std::string& map) {
    RelocalizationService service;
    absl::StatusOr<DescribedMap> described =
        DescribeMap(service.stages_.place, service.stages_.recognition.match,
                    map, &RunInOrder);
    if (!described.ok()) return described.status();
    service.map_ = *std::move(described);
    return service;
  }

  // The pose of the drive's map frame in the map, from its first seconds. None
  // where that is not certain; then `reason` says why.
  absl::StatusOr<std::optional<Rigid2>> WhereIs(const std::string& drive,
                                                const double first_seconds,
                                                std::string* const reason) {
    const absl::StatusOr<Session> query =
        DescribeSession(stages_, scan_places_, drive,
                        TimeWindow{0., first_seconds}, &RunInOrder);
    if (!query.ok()) return query.status();
    const Localization result =
        LocalizeIn(options_, stages_, map_, query->map, &RunInOrder);
    *reason = result.reason;
    return result.T_map_query;
  }

 private:
  LocalizationOptions options_;
  ScanPlaceOptions scan_places_;
  LoopClosingOptions stages_;
  DescribedMap map_;
};

// Writes one map from several. What could not be connected is left out: the
// result's sessions without a pose.
absl::StatusOr<MergingResult> Merge(const std::vector<std::string>& maps,
                                    const std::string& output) {
  absl::StatusOr<MergingResult> result = MergeSessions(
      FoldCheckOptions(), SessionLinkOptions(), LocalizationOptions(),
      ScanPlaceOptions(), LoopClosingOptions(), {maps.begin(), maps.end()}, {},
      &RunInOrder);
  if (!result.ok()) return result.status();
  if (!result->refusal.empty()) {
    return absl::FailedPreconditionError(result->refusal);
  }
  const absl::Status status =
      WriteJoinedMap(result->parts, result->closed.pose_graph, output);
  if (!status.ok()) return status;
  return result;
}

}  // namespace example

// ------------------------------------------------------------------------------

namespace cartographer_sdf::sessions_example_test {
namespace {

class ExampleTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { offices_ = new testing::TwoOffices; }
  static void TearDownTestSuite() { delete offices_; }
  static testing::TwoOffices* offices_;
};
testing::TwoOffices* ExampleTest::offices_;

TEST_F(ExampleTest, FindsADriveInItsBuildingOnly) {
  absl::StatusOr<example::RelocalizationService> service =
      example::RelocalizationService::Open(offices_->Morning());
  ASSERT_TRUE(service.ok()) << service.status();
  std::string reason;
  const auto here = service->WhereIs(offices_->Evening(), 120., &reason);
  ASSERT_TRUE(here.ok()) << here.status();
  ASSERT_TRUE(here->has_value()) << reason;
  // Both drives begin in their local frames; the first nodes tell where. What
  // the map has drifted until the place that was recognised comes on top.
  const Rigid2 truth =
      offices_->TruthOf(offices_->Morning())
          .T_world_tracking.at({0, 0})
          .Inverse() *
      offices_->TruthOf(offices_->Evening()).T_world_tracking.at({0, 0});
  const Rigid2 error = truth.Inverse() * **here;
  EXPECT_LT(error.translation().norm(), 1.5);
  EXPECT_LT(std::abs(error.rotation()), 0.1);

  const auto elsewhere = service->WhereIs(offices_->Elsewhere(), 120., &reason);
  ASSERT_TRUE(elsewhere.ok()) << elsewhere.status();
  EXPECT_FALSE(elsewhere->has_value());
  EXPECT_NE(reason, "");
  EXPECT_FALSE(service->WhereIs("no file", 30., &reason).ok());
}

TEST_F(ExampleTest, MergesWhatIsConnected) {
  const std::string output = offices_->File("merged.pbstream");
  const auto result = example::Merge(
      {offices_->Morning(), offices_->Elsewhere(), offices_->Evening()},
      output);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->sessions[0].T_merged_session.has_value());
  EXPECT_FALSE(result->sessions[1].T_merged_session.has_value());
  EXPECT_TRUE(result->sessions[2].T_merged_session.has_value());
  const absl::StatusOr<MapState> merged = ReadMap(output);
  ASSERT_TRUE(merged.ok()) << merged.status();
  EXPECT_EQ(merged->trajectories.size(), 2u);

  // Every node is where it belongs, in the frame of the first map's first node.
  const Truth morning = offices_->TruthOf(offices_->Morning());
  const Truth evening = offices_->TruthOf(offices_->Evening());
  const Rigid2 T_map_world = merged->pose_graph.nodes.at({0, 0}).T_map_node *
                             morning.T_world_tracking.at({0, 0}).Inverse();
  double sum = 0.;
  for (const auto& [id, node] : merged->pose_graph.nodes) {
    const Rigid2& T_world_node = (id.trajectory == 0 ? morning : evening)
                                     .T_world_tracking.at({0, id.index});
    sum += (node.T_map_node.translation() -
            (T_map_world * T_world_node).translation())
               .norm();
  }
  // Not aligned: the first node's own error swings the map by some decimetres.
  EXPECT_LT(sum / static_cast<double>(merged->pose_graph.nodes.size()), 0.5);
}

TEST_F(ExampleTest, SaysWhyNothingIsMerged) {
  const auto result =
      example::Merge({offices_->Morning(), offices_->Elsewhere()},
                     offices_->File("none.pbstream"));
  EXPECT_THAT(std::string(result.status().message()),
              ::testing::HasSubstr("no two of the maps are connected"));
}

}  // namespace
}  // namespace cartographer_sdf::sessions_example_test
