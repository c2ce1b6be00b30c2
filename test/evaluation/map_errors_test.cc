// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/map_errors.h"

#include <cmath>
#include <cstdint>

#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::error_statistics_test {
namespace {

TEST(SummarizeTest, InterpolatesBetweenSortedValues) {
  const std::optional<ErrorStatistics> odd = Summarize({5., 1., 3.});
  ASSERT_TRUE(odd.has_value());
  EXPECT_EQ(odd->count, 3);
  EXPECT_DOUBLE_EQ(odd->mean, 3.);
  EXPECT_DOUBLE_EQ(odd->median, 3.);
  EXPECT_DOUBLE_EQ(odd->percentile_90, 3. + 0.8 * 2.);
  EXPECT_DOUBLE_EQ(odd->max, 5.);
  const std::optional<ErrorStatistics> even = Summarize({8., 0., 2., 1.});
  ASSERT_TRUE(even.has_value());
  EXPECT_DOUBLE_EQ(even->mean, 2.75);
  EXPECT_DOUBLE_EQ(even->median, 1.5);
  EXPECT_DOUBLE_EQ(even->percentile_90, 2. + 0.7 * 6.);
}

TEST(SummarizeTest, OfOneIsThatOne) {
  const std::optional<ErrorStatistics> one = Summarize({7.});
  ASSERT_TRUE(one.has_value());
  EXPECT_EQ(one->count, 1);
  EXPECT_EQ(one->mean, 7.);
  EXPECT_EQ(one->median, 7.);
  EXPECT_EQ(one->percentile_90, 7.);
  EXPECT_EQ(one->max, 7.);
}

TEST(SummarizeTest, NoneOfNone) { EXPECT_FALSE(Summarize({}).has_value()); }

}  // namespace
}  // namespace cartographer_sdf::error_statistics_test

namespace cartographer_sdf::trajectory_error_test {
namespace {

// A square of 4 m.
Truth Square() {
  Truth truth;
  truth.T_world_tracking[{0, 0}] = Rigid2(0., 0., 0.);
  truth.T_world_tracking[{0, 1}] = Rigid2(4., 0., M_PI_2);
  truth.T_world_tracking[{0, 2}] = Rigid2(4., 4., M_PI);
  truth.T_world_tracking[{0, 3}] = Rigid2(0., 4., -M_PI_2);
  return truth;
}

PoseGraph MapOf(const Truth& truth, const Rigid2& T_map_world) {
  PoseGraph graph;
  for (const auto& [id, T_world_tracking] : truth.T_world_tracking) {
    graph.nodes[id].T_map_node = T_map_world * T_world_tracking;
  }
  return graph;
}

TEST(EvaluateTrajectoryTest, ARigidMotionIsNoError) {
  const Rigid2 T_map_world(100., -30., 2.5);
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(MapOf(Square(), T_map_world), Square());
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->errors.translation.count, 4);
  EXPECT_NEAR(error->errors.translation.max, 0., 1e-12);
  EXPECT_NEAR(error->errors.rotation.max, 0., 1e-12);
  EXPECT_EQ(error->num_skipped, 0);
  EXPECT_NEAR(error->T_world_map.rotation(), -2.5, 1e-12);
}

TEST(EvaluateTrajectoryTest, MeasuresWhatNoMotionExplains) {
  // Opposite corners move out by 1 m along the diagonal: no motion helps.
  PoseGraph graph = MapOf(Square(), Rigid2(3., 4., 1.));
  const double step = std::sqrt(0.5);
  graph.nodes[{0, 0}].T_map_node =
      Rigid2(3., 4., 1.) * Rigid2(-step, -step, 0.1);
  graph.nodes[{0, 2}].T_map_node =
      Rigid2(3., 4., 1.) * Rigid2(4. + step, 4. + step, M_PI + 0.3);
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(graph, Square());
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->errors.translation.mean, 0.5, 1e-12);
  EXPECT_NEAR(error->errors.translation.median, 0.5, 1e-12);
  EXPECT_NEAR(error->errors.translation.max, 1., 1e-12);
  EXPECT_NEAR(error->errors.rotation.mean, 0.1, 1e-12);
  EXPECT_NEAR(error->errors.rotation.max, 0.3, 1e-12);
}

TEST(EvaluateTrajectoryTest, RotationsAreOfTheTrackingFrame) {
  PoseGraph graph = MapOf(Square(), Rigid2(3., 4., 1.));
  double yaw = 0.5;
  for (auto& [id, node] : graph.nodes) {
    node.gravity_alignment = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    node.T_map_node = node.T_map_node * Rigid2(0., 0., -yaw);
    yaw += 1.;
  }
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(graph, Square());
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->errors.rotation.max, 0., 1e-12);
}

TEST(EvaluateTrajectoryTest, SkipsAndCountsWhatTheTruthDoesNotKnow) {
  PoseGraph graph = MapOf(Square(), Rigid2());
  graph.nodes[{0, 4}].T_map_node = Rigid2(1000., 0., 0.);
  graph.nodes[{1, 0}].T_map_node = Rigid2(1000., 0., 0.);
  Truth truth = Square();
  truth.T_world_tracking[{7, 7}] = Rigid2();
  const std::optional<TrajectoryError> error = EvaluateTrajectory(graph, truth);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->num_skipped, 2);
  EXPECT_EQ(error->errors.translation.count, 4);
  EXPECT_NEAR(error->errors.translation.max, 0., 1e-12);
}

// Nodes half a metre apart, on a circle of the given radius.
Truth Circle(const double radius) {
  Truth truth;
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.5 * k / radius;
    truth.T_world_tracking[{0, k}] = Rigid2(
        radius * std::sin(angle), radius - radius * std::cos(angle), angle);
  }
  return truth;
}

TEST(CheckIsTruthOfTest, KnowsADriveByItsShape) {
  PoseGraph graph = MapOf(Circle(8.), Rigid2(3., 4., 1.));
  // A map that is wrong by far, of a local SLAM that drifts, is of this drive.
  for (auto& [id, node] : graph.nodes) {
    node.T_local_node =
        node.T_map_node * Rigid2(0.01 * id.index, 0., 1e-3 * id.index);
    node.T_map_node = Rigid2(5. * id.index, 0., 0.);
  }
  EXPECT_TRUE(CheckIsTruthOf("map", graph, "truth", Circle(8.)).ok());
  const absl::Status status =
      CheckIsTruthOf("a.pbstream", graph, "b.csv", Circle(5.));
  EXPECT_THAT(std::string(status.message()),
              ::testing::AllOf(
                  ::testing::StartsWith("b.csv is the truth of another map"),
                  ::testing::HasSubstr("elsewhere in a.pbstream")));
  // Of 99.5 m, one begins at every third node, as long as 10 m are left.
  EXPECT_EQ(CompareDrives(graph, Circle(8.)).num_stretches, 60);
}

// Submaps every 2 m, each with its first node; the truth has submaps only.
TEST(CheckIsTruthOfTest, KnowsADriveByItsSubmaps) {
  constexpr int kNodesPerSubmap = 4;
  PoseGraph graph = MapOf(Circle(8.), Rigid2(3., 4., 1.));
  const Rigid2 T_submap_node(0.5, -0.2, 0.3);
  for (auto& [id, node] : graph.nodes) {
    node.T_local_node = node.T_map_node;
    if (id.index % kNodesPerSubmap != 0) continue;
    const SubmapId submap{0, id.index / kNodesPerSubmap};
    graph.submap_poses[submap] = Rigid2();
    graph.constraints.push_back(
        {submap, id, T_submap_node, 1., 1., Constraint::Tag::kIntraSubmap});
  }
  const auto submaps_of = [&](const Truth& nodes) {
    Truth truth;
    for (const auto& [id, pose] : nodes.T_world_tracking) {
      if (id.index % kNodesPerSubmap != 0) continue;
      truth.T_world_submap[{0, id.index / kNodesPerSubmap}] =
          pose * T_submap_node.Inverse();
    }
    return truth;
  };
  EXPECT_GT(CompareDrives(graph, submaps_of(Circle(8.))).num_stretches, 20);
  EXPECT_TRUE(
      CheckIsTruthOf("map", graph, "truth", submaps_of(Circle(8.))).ok());
  EXPECT_FALSE(
      CheckIsTruthOf("map", graph, "truth", submaps_of(Circle(5.))).ok());
}

TEST(CheckIsTruthOfTest, TakesWhatItCannotTell) {
  // Too short, or without nodes.
  EXPECT_TRUE(
      CheckIsTruthOf("map", MapOf(Square(), Rigid2()), "truth", Circle(8.))
          .ok());
  EXPECT_TRUE(
      CheckIsTruthOf("map", MapOf(Circle(8.), Rigid2()), "truth", Truth())
          .ok());
}

TEST(EvaluateTrajectoryTest, NoneWhereTheMotionIsUndetermined) {
  EXPECT_FALSE(EvaluateTrajectory(PoseGraph{}, Square()).has_value());
  EXPECT_FALSE(
      EvaluateTrajectory(MapOf(Square(), Rigid2()), Truth{}).has_value());
  Truth one = Square();
  one.T_world_tracking.erase(++one.T_world_tracking.begin(),
                             one.T_world_tracking.end());
  EXPECT_FALSE(EvaluateTrajectory(MapOf(Square(), Rigid2()), one).has_value());
}

}  // namespace
}  // namespace cartographer_sdf::trajectory_error_test

namespace cartographer_sdf::relations_test {
namespace {

using ::testing::HasSubstr;

constexpr double kSecondsPerScan = 0.1;

// Stamps are exact to 100 ns, which at 1 m/s is 1e-7 m.
constexpr double kTolerance = 1e-6;

void AddNode(const int index, const double seconds, const Rigid2& T_map_node,
             PoseGraph* const graph) {
  Node& node = graph->nodes[{0, index}];
  node.time = (int64_t{719162} * 86400 + 1000000000) * 10000000 +
              static_cast<int64_t>(std::llround(seconds * 1e7));
  node.T_map_node = T_map_node;
}

// 1 m/s along x, turning through 180 degrees between 10 s and 12 s.
PoseGraph Drive() {
  PoseGraph graph;
  AddNode(0, 0., Rigid2(0., 0., 3.), &graph);
  AddNode(1, 10., Rigid2(10., 0., 3.), &graph);
  AddNode(2, 12., Rigid2(12., 0., -3.), &graph);
  AddNode(3, 100., Rigid2(100., 0., -3.), &graph);
  return graph;
}

TEST(EvaluateRelationsTest, InterpolatesPosesAndTakesTheShortTurn) {
  // Scan 110 is at 11 s: x = 11 m, yaw = pi. Scan 50 at 5 s.
  const Rigid2 T_true = Rigid2(5., 0., 3.).Inverse() * Rigid2(11., 0., M_PI);
  const RelationErrors errors =
      EvaluateRelations(Drive(),
                        {{50., 110., T_true, 0., 10.},
                         {50., 110., T_true * Rigid2(0.3, 0.4, 0.2), 0., 10.}},
                        kSecondsPerScan);
  ASSERT_TRUE(errors.all.has_value());
  EXPECT_FALSE(errors.loops.has_value());
  EXPECT_EQ(errors.all->translation.count, 2);
  EXPECT_NEAR(errors.all->translation.mean, 0.25, kTolerance);
  EXPECT_NEAR(errors.all->translation.median, 0.25, kTolerance);
  EXPECT_NEAR(errors.all->translation.percentile_90, 0.45, kTolerance);
  EXPECT_NEAR(errors.all->translation.max, 0.5, kTolerance);
  EXPECT_NEAR(errors.all->rotation.max, 0.2, kTolerance);
}

TEST(EvaluateRelationsTest, RelationsAreOfTheTrackingFrame) {
  PoseGraph graph = Drive();
  double yaw = 0.5;
  for (auto& [id, node] : graph.nodes) {
    node.gravity_alignment = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX());
    node.T_map_node = node.T_map_node * Rigid2(0., 0., -yaw);
    yaw += 1.;
  }
  const RelationErrors errors = EvaluateRelations(
      graph,
      {{50., 110., Rigid2(5., 0., 3.).Inverse() * Rigid2(11., 0., M_PI), 0.,
        1.}},
      kSecondsPerScan);
  ASSERT_TRUE(errors.all.has_value());
  EXPECT_NEAR(errors.all->translation.max, 0., kTolerance);
  EXPECT_NEAR(errors.all->rotation.max, 0., kTolerance);
}

TEST(EvaluateRelationsTest, LoopsAreApartByTheClockOfTheRecording) {
  const RelationErrors errors =
      EvaluateRelations(Drive(),
                        {{0., 10., Rigid2(), 100., 130.},
                         {0., 10., Rigid2(), 130.5, 100.},
                         {0., 900., Rigid2(), 100., 101.}},
                        kSecondsPerScan);
  ASSERT_TRUE(errors.loops.has_value());
  EXPECT_EQ(errors.loops->translation.count, 1);
  EXPECT_NEAR(errors.loops->translation.max, 1., kTolerance);
  EXPECT_EQ(errors.all->translation.count, 3);
}

TEST(EvaluateRelationsTest, SkipsScansOutsideTheMap) {
  const RelationErrors errors =
      EvaluateRelations(Drive(),
                        {{-9., 0., Rigid2(), 0., 1.},
                         {-11., 0., Rigid2(), 0., 1.},
                         {1009., 1000., Rigid2(), 0., 1.},
                         {0., 1011., Rigid2(), 0., 1.}},
                        kSecondsPerScan);
  EXPECT_EQ(errors.num_skipped, 2);
  ASSERT_TRUE(errors.all.has_value());
  // Beyond the ends, poses stay.
  EXPECT_EQ(errors.all->translation.count, 2);
  EXPECT_NEAR(errors.all->translation.max, 0., kTolerance);
}

TEST(EvaluateRelationsTest, SecondsPerScanScaleTheIndices) {
  const std::vector<Relation> relations = {
      {0., 20., Rigid2(0., 0., 0.), 0., 1.}};
  EXPECT_NEAR(EvaluateRelations(Drive(), relations, 0.1).all->translation.max,
              2., kTolerance);
  EXPECT_NEAR(EvaluateRelations(Drive(), relations, 0.5).all->translation.max,
              10., kTolerance);
}

TEST(EvaluateRelationsTest, NoneOfAnEmptyMap) {
  const RelationErrors errors = EvaluateRelations(
      PoseGraph{}, {{0., 1., Rigid2(), 0., 1.}}, kSecondsPerScan);
  EXPECT_FALSE(errors.all.has_value());
  EXPECT_FALSE(errors.loops.has_value());
  EXPECT_EQ(errors.num_skipped, 1);
}

TEST(ReadRelationsTest, ReadsNumbersAndSkipsComments) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("a.relations");
  ASSERT_TRUE(WriteWholeFile(path,
                             "# i j x y theta t1 t2 dt1 dt2\n"
                             "240 279  -0.05\t-0.12 -1.5 100.5 131 -0.1 0.08\n"
                             "\n1 2 3 4 5 6 7 # said by hand\n")
                  .ok());
  const absl::StatusOr<std::vector<Relation>> relations = ReadRelations(path);
  ASSERT_TRUE(relations.ok()) << relations.status();
  ASSERT_EQ(relations->size(), 2u);
  const Relation& relation = relations->front();
  EXPECT_EQ(relation.first_scan, 240.);
  EXPECT_EQ(relation.second_scan, 279.);
  EXPECT_EQ(relation.T_first_second.translation(),
            Eigen::Vector2d(-0.05, -0.12));
  EXPECT_EQ(relation.T_first_second.rotation(), -1.5);
  EXPECT_EQ(relation.first_time, 100.5);
  EXPECT_EQ(relation.second_time, 131.);
}

TEST(ReadRelationsTest, ErrorsNameTheLine) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("a.relations");
  ASSERT_TRUE(WriteWholeFile(path, "# comment\n1 2 3 4 5 6\n").ok());
  EXPECT_THAT(std::string(ReadRelations(path).status().message()),
              HasSubstr("a.relations:2: 6 numbers instead of 7 or more"));
  ASSERT_TRUE(WriteWholeFile(path, "1 2 3 four 5 6 7\n").ok());
  EXPECT_THAT(std::string(ReadRelations(path).status().message()),
              HasSubstr(":1: \"four\" is not a finite number"));
}

// What an independent tool prints for these maps, to its last digit.
struct PublishedErrors {
  int count;
  double mean;
  double median;
  double percentile_90;
  double mean_rotation_degrees;
  double median_rotation_degrees;
};

void ExpectAgreement(const PoseErrorStatistics& actual,
                     const PublishedErrors& expected) {
  constexpr double kDegree = M_PI / 180.;
  constexpr double kLastDigit = 0.0005 + 1e-9;
  EXPECT_EQ(actual.translation.count, expected.count);
  EXPECT_NEAR(actual.translation.mean, expected.mean, kLastDigit);
  EXPECT_NEAR(actual.translation.median, expected.median, kLastDigit);
  EXPECT_NEAR(actual.translation.percentile_90, expected.percentile_90,
              kLastDigit);
  EXPECT_NEAR(actual.rotation.mean / kDegree, expected.mean_rotation_degrees,
              10. * kLastDigit);
  EXPECT_NEAR(actual.rotation.median / kDegree,
              expected.median_rotation_degrees, 10. * kLastDigit);
}

void ExpectAgreementOnMap(const std::string& map, const std::string& relations,
                          const PublishedErrors& all,
                          const PublishedErrors& loops) {
  const absl::StatusOr<MapState> state = ReadMap(SharedDataPath(map));
  ASSERT_TRUE(state.ok()) << state.status();
  const absl::StatusOr<std::vector<Relation>> read =
      ReadRelations(SharedDataPath(relations));
  ASSERT_TRUE(read.ok()) << read.status();
  const RelationErrors errors =
      EvaluateRelations(state->pose_graph, *read, kSecondsPerScan);
  ASSERT_TRUE(errors.all.has_value());
  ASSERT_TRUE(errors.loops.has_value());
  ExpectAgreement(*errors.all, all);
  ExpectAgreement(*errors.loops, loops);
}

TEST(RealRelationsTest, AgreesOnIntel) {
  SKIP_WITHOUT_SHARED_DATA("intel_stock.pbstream");
  ExpectAgreementOnMap("intel_stock.pbstream", "intel.relations",
                       {2984, 0.069, 0.050, 0.149, 1.39, 0.57},
                       {1211, 0.083, 0.065, 0.167, 1.17, 0.59});
}

TEST(RealRelationsTest, AgreesOnKillian) {
  SKIP_WITHOUT_SHARED_DATA("mit_killian_open_loop.pbstream");
  ExpectAgreementOnMap("mit_killian_open_loop.pbstream",
                       "mit_killian.relations",
                       {4677, 5.340, 0.028, 32.681, 6.10, 0.53},
                       {965, 25.777, 32.072, 45.948, 25.97, 30.59});
}

}  // namespace
}  // namespace cartographer_sdf::relations_test
