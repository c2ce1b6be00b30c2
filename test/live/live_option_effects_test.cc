// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// No option of the searcher is without effect. Of the tables that it shares
// with the offline programs, whose options test/config/ walks through, one
// option each shows that the table arrives.

#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cartographer/mapping/map_builder.h"
#include "cartographer_sdf/live/background_search.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/live/map_builder.h"
#include "glog/logging.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/live/small_room.h"
#include "test/testing/building.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::live_option_effects_test {
namespace {

namespace mapping = cartographer::mapping;

// --- What the searcher's worker finds, without a host. ---

struct SeenSubmap {
  SubmapId id;
  Rigid2 T_world_submap;
  testing::Viewpoints viewpoints;
};

// Two rooms, one after the other, and later both again.
const std::vector<SeenSubmap>& Seen() {
  static const auto* const kSeen = new std::vector<SeenSubmap>{
      {{0, 0}, Rigid2(3., 2., 0.4), testing::WestRoomViewpoints()},
      {{0, 2}, Rigid2(12., 2., 1.4), testing::EastRoomViewpoints()},
      {{0, 10},
       Rigid2(4., 3., -1.),
       {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}}},
      {{0, 12},
       Rigid2(13., 1., 0.2),
       {{10.8, 2.4}, {11.2, -0.6}, {13.8, 1.}, {13.3, 3.2}}}};
  return *kSeen;
}

NodeData TakeNode(const Rigid2& T_world_node) {
  auto data = std::make_shared<mapping::TrajectoryNode::Data>();
  data->gravity_alignment = Eigen::Quaterniond::Identity();
  std::vector<cartographer::sensor::RangefinderPoint> points;
  for (const SurfacePoint& point :
       testing::TakeScan(testing::TwoRooms(), T_world_node)) {
    points.push_back(
        {Eigen::Vector3f(static_cast<float>(point.position.x()),
                         static_cast<float>(point.position.y()), 0.f)});
  }
  data->filtered_gravity_aligned_point_cloud =
      cartographer::sensor::PointCloud(points);
  return data;
}

// Matches, and constraints of those that are accepted.
std::string Recognize(const LiveOptions& options) {
  BackgroundSearch search(options);
  std::map<SubmapId, OdometryPose> odometry;
  std::map<SubmapId, std::vector<SubmapNode>> nodes;
  std::ostringstream text;
  text.precision(17);
  std::vector<Match> matches;
  for (const SeenSubmap& seen : Seen()) {
    std::optional<Place> place = search.Describe(
        seen.id, testing::SeeFrom(testing::TwoRooms(), seen.T_world_submap,
                                  seen.viewpoints));
    if (!place) continue;
    text << seen.id << " " << place->features.features.size() << "\n";
    search.Remember(*std::move(place));
    odometry[seen.id] = {seen.T_world_submap, 10. * seen.id.index};
    for (const Eigen::Vector2d& p_world : seen.viewpoints) {
      const Rigid2 T_world_node(p_world, 0.3);
      nodes[seen.id].push_back(
          {{0, 10 * seen.id.index + static_cast<int>(nodes[seen.id].size())},
           seen.T_world_submap.Inverse() * T_world_node,
           TakeNode(T_world_node)});
    }
    const PlaceRecognizer::Recognition found =
        search.Recognize(seen.id, odometry);
    text << found.num_candidates << "\n";
    for (const Match& match : found.matches) {
      text << match.pair.reference << " " << match.pair.score << "\n";
      matches.push_back(match);
    }
  }
  std::vector<Closure> closures = MakeClosures(matches);
  search.GenerateConstraints(nodes, &closures);
  for (const Closure& closure : closures) {
    for (const Constraint& constraint : closure.constraints) {
      text << constraint.translation_weight << " "
           << constraint.T_submap_node.translation().transpose() << "\n";
    }
  }
  return text.str();
}

// Where a robot is that sees the west room again, query by query.
std::string Locate(const LiveOptions& options) {
  constexpr int kTrajectory = 5;
  BackgroundSearch search(options);
  MapLayout layout{{}, {}, {}, DrivenDistances({}, {})};
  PoseGraph graph;
  std::map<SubmapId, OdometryPose> odometry;
  for (const SeenSubmap& seen : {Seen()[0], Seen()[1]}) {
    search.Remember(*search.Describe(
        seen.id, testing::SeeFrom(testing::TwoRooms(), seen.T_world_submap,
                                  seen.viewpoints)));
    graph.submap_poses[seen.id] = seen.T_world_submap;
    odometry[seen.id] = {seen.T_world_submap, 10. * seen.id.index};
  }
  layout = MakeMapLayout(graph, odometry, search.places());
  search.StartLocalizing(kTrajectory);
  std::ostringstream text;
  text.precision(17);
  int index = 0;
  for (const Eigen::Vector2d& p_world : Seen()[2].viewpoints) {
    const Rigid2 T_world_node(p_world, 0.1 * index);
    const NodeData data = TakeNode(T_world_node);
    Scan scan;
    for (const auto& point : data->filtered_gravity_aligned_point_cloud) {
      scan.returns.push_back(point.position.head<2>());
    }
    search.AddScans(kTrajectory, {{data,
                                   {{kTrajectory, index},
                                    T_world_node,
                                    T_world_node,
                                    scan,
                                    2.5 * index}}});
    const BackgroundSearch::Query query = search.Localize(kTrajectory, layout);
    text << query.localization.reason << " "
         << query.localization.score.value_or(-1.) << " " << query.num_certain
         << " " << query.num_candidates << " " << query.closures.size() << "\n";
    ++index;
  }
  return text.str();
}

// --- What a host with a searcher does. ---

// Counts the lines about closures.
class ClosureLines : public google::LogSink {
 public:
  ClosureLines() { google::AddLogSink(this); }
  ~ClosureLines() override { google::RemoveLogSink(this); }
  void send(google::LogSeverity, const char*, const char*, int, const tm*,
            const char* const message, const size_t length) override {
    if (std::string(message, length).rfind("closure of submap", 0) == 0) {
      ++count_;
    }
  }
  [[nodiscard]] int count() const { return count_; }

 private:
  int count_ = 0;
};

// Whether there are closures, constraints and queries, and what else is left:
// how many depends on threads.
std::string DriveInARoom(const LiveOptions& options) {
  constexpr int kNumScans = 30;
  const testing::TemporaryDirectory directory;
  const auto stock = testing::MakeStockOptions(testing::SmallSubmapsLua(3));
  const std::string map_path = directory.File("map.pbstream");
  {
    const auto host = mapping::CreateMapBuilder(stock.map_builder);
    const int id = host->AddTrajectoryBuilder(
        testing::SensorIds(), stock.trajectory_builder, nullptr);
    for (int k = 0; k < 12; ++k) {
      testing::FeedScanOfARoom(host.get(), id, 0., k);
    }
    host->FinishTrajectory(id);
    host->pose_graph()->RunFinalOptimization();
    CHECK(host->SerializeStateToFile(true, map_path));
  }
  ClosureLines lines;
  const auto map_builder =
      CreateMapBuilder(mapping::CreateMapBuilder(stock.map_builder), options);
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder.get());
  if (live == nullptr) return "no searcher";
  map_builder->LoadStateFromFile(map_path, true);
  live->WaitUntilIdle();
  const int id = map_builder->AddTrajectoryBuilder(
      testing::SensorIds(), stock.trajectory_builder, nullptr);
  for (int k = 0; k < kNumScans; ++k) {
    testing::FeedScanOfARoom(map_builder.get(), id, 1., k);
    live->WaitUntilIdle();
  }
  std::ostringstream text;
  const std::optional<LocalizationResult> localization =
      live->GetLocalization(id);
  text << "searched for " << localization.has_value() << "\n";
  if (localization) text << "queries " << (localization->num_queries > 0);
  map_builder->FinishTrajectory(id);
  map_builder->pose_graph()->RunFinalOptimization();
  const LiveSummary summary = live->GetSummary();
  text << "closures " << (summary.num_closures > 0) << " constraints "
       << (summary.num_constraints > 0) << " lines " << (lines.count() > 0)
       << " place file " << std::ifstream(map_path + ".places").good();
  bool is_any_unsupported = false;
  for (const ClosureRecord& closure : live->GetClosures()) {
    is_any_unsupported =
        is_any_unsupported || closure.status == ClosureStatus::kUnsupported;
  }
  text << " unsupported " << is_any_unsupported << " looks "
       << summary.num_looks;
  return text.str();
}

// Where an option shows: what is done, and beside which other options.
struct Situation {
  std::string (*outcome)(const LiveOptions&);
  LiveOptions (*base)();
};
constexpr Situation kRoom{&DriveInARoom, &testing::EagerOptions};
constexpr Situation kRoomWithoutSupport{&DriveInARoom, [] {
                                          LiveOptions options =
                                              testing::EagerOptions();
                                          options.consistency.min_support = 1e9;
                                          return options;
                                        }};
constexpr Situation kRoomOfScans{&DriveInARoom, [] {
                                   LiveOptions options =
                                       testing::EagerOptions();
                                   options.localization.compare_scans = true;
                                   return options;
                                 }};
constexpr Situation kMatches{&Recognize, [] { return LiveOptions(); }};
constexpr Situation kBestMatches{&Recognize, [] {
                                   LiveOptions options;
                                   options.retrieval.min_num_candidates = 1;
                                   return options;
                                 }};
constexpr Situation kNeighbours{&Recognize, [] {
                                  LiveOptions options;
                                  options.verify_neighbourhoods = true;
                                  return options;
                                }};
constexpr Situation kQueries{&Locate, [] { return LiveOptions(); }};

struct Probe {
  std::string path;
  std::string value;
  const Situation* situation;
};
const std::vector<Probe>& Probes() {
  static const auto* const kProbes = new std::vector<Probe>{
      {"enabled", "false", &kRoom},
      {"inject_constraints", "false", &kRoom},
      {"log_closures", "true", &kRoom},
      {"use_place_files", "false", &kRoom},
      {"consistency.min_unsupported_score", "1e9", &kRoomWithoutSupport},
      {"localization.enabled", "false", &kRoom},
      {"localization.query_interval_meters", "1e3", &kRoom},
      {"min_index_gap", "100", &kMatches},
      {"verify_neighbourhoods", "true", &kMatches},
      {"place.keypoint.detection_threshold", "0.02", &kMatches},
      {"match.verification.judgement.score_weights.bias", "-4.", &kMatches},
      {"retrieval.max_num_candidates", "1", &kBestMatches},
      {"neighbourhood.weights.bias", "1.", &kNeighbours},
      {"constraints.translation_weight", "7.", &kMatches},
      {"localization.window_meters", "1.", &kQueries},
      {"localization.resolution_meters", "0.1", &kQueries},
      {"localization.max_num_candidates", "1", &kQueries},
      {"localization.localizer.placement.min_observed_area", "1e6", &kQueries},
      {"localization.min_num_queries", "4", &kQueries},
      {"localization.max_translation_difference_meters", "1e-9", &kQueries},
      {"localization.max_rotation_difference", "1e-9", &kQueries},
      {"localization.compare_scans", "false", &kRoomOfScans},
      {"localization.scan_localization.min_num_beams", "360", &kRoomOfScans},
      {"localization.scan_session.look_rotation", "3.", &kRoomOfScans},
  };
  return *kProbes;
}
const char* const kSharedTables[] = {"place.",
                                     "match.",
                                     "retrieval.",
                                     "neighbourhood.",
                                     "consistency.",
                                     "constraints.",
                                     "localization.localizer.",
                                     "localization.scan_localization.",
                                     "localization.scan_session."};

// As a user would change it.
LiveOptions Changed(const LiveOptions& options, const std::string& path,
                    const std::string& value) {
  testing::TemporaryDirectory directory;
  directory.Write("base.lua", FormatLiveOptions(options));
  directory.Write("changed.lua", "include \"base.lua\"\nSDF_LIVE." + path +
                                     " = " + value + "\nreturn SDF_LIVE\n");
  const absl::StatusOr<LiveOptions> changed =
      LoadLiveOptions({directory.path()}, "changed.lua");
  CHECK(changed.ok()) << changed.status();
  return *changed;
}

// The paths of all options, as Lua names them.
std::vector<std::string> AllPaths() {
  std::vector<std::string> paths, tables;
  std::istringstream text(FormatLiveOptions(LiveOptions()));
  std::string key, equals, value;
  while (text >> key && key != "return") {
    if (key[0] == '}') {
      tables.pop_back();
      continue;
    }
    CHECK(text >> equals >> value && equals == "=") << key;
    if (value == "{") {
      tables.push_back(key);
      continue;
    }
    std::string path;
    for (size_t k = 1; k < tables.size(); ++k) path += tables[k] + ".";
    paths.push_back(path + key);
  }
  return paths;
}

bool BeginsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

TEST(LiveOptionEffectsTest, EveryOptionOrItsTableIsProbed) {
  const std::vector<std::string> paths = AllPaths();
  EXPECT_GT(paths.size(), 100u);
  for (const std::string& path : paths) {
    std::string wanted = path;
    for (const std::string table : kSharedTables) {
      if (BeginsWith(path, table)) wanted = table;
    }
    bool is_probed = false;
    for (const Probe& probe : Probes()) {
      is_probed = is_probed || probe.path == wanted ||
                  (wanted.back() == '.' && BeginsWith(probe.path, wanted));
    }
    EXPECT_TRUE(is_probed) << path;
  }
}

TEST(LiveOptionEffectsTest, EachProbeChangesWhatComesOut) {
  std::map<const Situation*, std::string> before;
  for (const Probe& probe : Probes()) {
    const Situation& situation = *probe.situation;
    const LiveOptions base = situation.base();
    const auto [entry, is_new] = before.try_emplace(&situation);
    if (is_new) entry->second = situation.outcome(base);
    EXPECT_NE(situation.outcome(Changed(base, probe.path, probe.value)),
              entry->second)
        << probe.path;
  }
}

}  // namespace
}  // namespace cartographer_sdf::live_option_effects_test
