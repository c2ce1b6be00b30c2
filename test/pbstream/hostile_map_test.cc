// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Files that are damaged, foreign or malicious: an error that names the file,
// never a crash. Run it with sanitizers, too.

#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pbstream/trajectory_record.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::hostile_map_test {
namespace {

using ::cartographer_sdf::testing::SmallMap;
using ::cartographer_sdf::testing::TemporaryDirectory;
using ::cartographer_sdf::testing::WriteFile;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

const std::set<NodeId>& AllNodes() {
  static const std::set<NodeId>* const kNodes =
      new std::set<NodeId>{{SmallMap::kTrajectory, 0},
                           {SmallMap::kTrajectory, 1},
                           {SmallMap::kTrajectory, 2},
                           {SmallMap::kTrajectory, 3}};
  return *kNodes;
}

// As testing::Container(), but it compresses a record only once.
std::string Container(const std::vector<std::string>& records) {
  static auto& compressed_records = *new std::map<std::string, std::string>;
  std::string bytes = testing::MagicNumber();
  for (const std::string& record : records) {
    std::string& compressed = compressed_records[record];
    if (compressed.empty()) compressed = testing::Gzipped(record);
    bytes += testing::LittleEndian(compressed.size()) + compressed;
  }
  return bytes;
}

class HostileMapTest : public ::testing::Test {
 protected:
  // What ReadMap() says of these bytes, nothing if it is content.
  std::string ErrorOf(const std::string& bytes) {
    WriteFile(path_, bytes);
    const absl::StatusOr<MapState> state = ReadMap(path_);
    // The content of clouds is none of ReadMap()'s business, unless somebody
    // wants it.
    (void)ReadPointClouds(path_, AllNodes());
    if (state.ok()) return "";
    EXPECT_THAT(std::string(state.status().message()), HasSubstr(path_));
    EXPECT_FALSE(WriteMap(path_, path_ + ".out", PoseGraph{}).ok());
    return std::string(state.status().message());
  }

  std::string ErrorOfChanged(const std::function<void(SmallMap*)>& change) {
    SmallMap map;
    change(&map);
    return ErrorOf(Container(map.Records()));
  }

  std::string ErrorOfRecords(
      const std::function<void(std::vector<std::string>*)>& change) {
    std::vector<std::string> records = SmallMap().Records();
    change(&records);
    return ErrorOf(Container(records));
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.File("map.pbstream");
};

TEST_F(HostileMapTest, TheSmallMapIsValid) {
  EXPECT_EQ(ErrorOfChanged([](SmallMap*) {}), "");
}

TEST_F(HostileMapTest, Truncated) {
  const SmallMap map;
  const std::vector<std::string> records = map.Records();
  const std::string bytes = Container(records);
  // Behind the last node, a file that ends between records is whole, as far as
  // one can tell.
  const size_t num_mandatory = 3 + map.submaps.size() + map.nodes.size();
  std::set<size_t> ends;
  for (size_t i = num_mandatory; i <= records.size(); ++i) {
    ends.insert(
        Container({records.begin(), records.begin() + static_cast<long>(i)})
            .size());
  }
  for (size_t size = 0; size <= bytes.size(); ++size) {
    EXPECT_EQ(ErrorOf(bytes.substr(0, size)).empty(), ends.count(size) == 1)
        << size;
  }
}

TEST_F(HostileMapTest, FlippedBytes) {
  const std::string bytes = Container(SmallMap().Records());
  int num_undetected = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    for (const int mask : {0x01, 0xff}) {
      std::string flipped = bytes;
      flipped[i] = static_cast<char>(flipped[i] ^ mask);
      num_undetected += ErrorOf(flipped).empty();
    }
  }
  // Six bytes of a gzip header (time, flags, system) do not matter, nor does
  // the flag that says that it is text.
  EXPECT_LE(num_undetected, static_cast<int>(13 * SmallMap().Records().size()));
}

TEST_F(HostileMapTest, Header) {
  EXPECT_EQ(ErrorOfRecords([](auto* records) { records->clear(); }),
            path_ + " is truncated: it ends before its header");
  EXPECT_EQ(
      ErrorOfChanged([](SmallMap* map) { map->header.set_format_version(3); }),
      path_ +
          " has format version 3, but only versions 1 and 2 are supported; "
          "Cartographer's `pbstream migrate` converts older files");
  EXPECT_THAT(
      ErrorOfRecords([](auto* records) { records->erase(records->begin()); }),
      HasSubstr("has format version 0"));
  EXPECT_THAT(ErrorOfRecords([](auto* records) { (*records)[0] = "\xff"; }),
              HasSubstr("record 1 is not a header"));
}

TEST_F(HostileMapTest, OrderOfRecords) {
  EXPECT_EQ(ErrorOfRecords([](auto* records) { records->resize(1); }),
            path_ + " is truncated: it ends before its pose graph");
  EXPECT_THAT(ErrorOfRecords([](auto* records) { records->resize(2); }),
              HasSubstr("it ends before its options of trajectory builders"));
  EXPECT_THAT(ErrorOfRecords([](auto* records) {
                std::swap((*records)[1], (*records)[3]);
              }),
              HasSubstr("is corrupted: record 2 is of the kind submap where "
                        "the pose graph must be"));
  EXPECT_THAT(
      ErrorOfRecords([](auto* records) { records->push_back((*records)[1]); }),
      HasSubstr("is a second pose graph"));
  EXPECT_THAT(
      ErrorOfRecords([](auto* records) { records->push_back((*records)[2]); }),
      HasSubstr("is a second list of options"));
  EXPECT_THAT(ErrorOfRecords([](auto* records) { (*records)[4] = "\x1a\x7f"; }),
              HasSubstr("record 5 is not a valid protocol buffer"));
}

TEST_F(HostileMapTest, NumberOfTrajectories) {
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->options.add_options_with_sensor_ids();
              }),
              HasSubstr("its pose graph has 1 trajectories, but it has options "
                        "for 2 of them"));
}

TEST_F(HostileMapTest, ThreeDimensions) {
  EXPECT_EQ(ErrorOfChanged([](SmallMap* map) {
              map->submaps[0].clear_submap_2d();
              map->submaps[0].mutable_submap_3d();
            }),
            path_ + " is a 3D map; only 2D maps are supported");
}

TEST_F(HostileMapTest, Submaps) {
  EXPECT_THAT(
      ErrorOfChanged([](SmallMap* map) { map->submaps[0].clear_submap_2d(); }),
      HasSubstr("record 4 (submap 5,0) is empty"));
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->submaps[1].mutable_submap_id()->set_index(0);
              }),
              HasSubstr("record 5 is the second of submap 5,0"));
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->submaps[1].mutable_submap_id()->set_index(7);
              }),
              HasSubstr("(submap 5,7) is not in the pose graph"));
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->submaps[1].mutable_submap_2d()->clear_local_pose();
              }),
              HasSubstr("(submap 5,1) has no rotation"));
  EXPECT_THAT(
      ErrorOfChanged([](SmallMap* map) {
        map->submaps[1].mutable_submap_2d()->mutable_grid()->add_cells(1);
      }),
      HasSubstr("(submap 5,1) has a grid of 3 x 2 cells with 7"));
}

TEST_F(HostileMapTest, Nodes) {
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->nodes[1].mutable_node_id()->set_index(0);
              }),
              HasSubstr("(node 5,0) is the second of this node"));
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->nodes[1].mutable_node_id()->set_trajectory_id(4);
              }),
              HasSubstr("is of trajectory 4, which is not in the pose graph"));
  EXPECT_THAT(
      ErrorOfChanged([](SmallMap* map) {
        map->nodes[1].mutable_node_data()->mutable_gravity_alignment()->Clear();
      }),
      HasSubstr("(node 5,1) has a rotation that is not a quaternion"));
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->nodes[1]
                    .mutable_node_data()
                    ->mutable_local_pose()
                    ->mutable_rotation()
                    ->set_x(kNaN);
              }),
              HasSubstr("(node 5,1) has a rotation that is not a quaternion"));
}

TEST_F(HostileMapTest, NodesWithoutData) {
  EXPECT_THAT(
      ErrorOfChanged([](SmallMap* map) { map->nodes[1].clear_node_data(); }),
      HasSubstr("(node 5,1) has no data"));
}

// The host looks up the trajectory of each record, and aborts.
TEST_F(HostileMapTest, RecordsOfUnknownTrajectories) {
  int num_records = 0;
  const std::vector<std::string> records = SmallMap().Records();
  for (size_t k = 3; k < records.size(); ++k) {
    proto::SerializedData data;
    ASSERT_TRUE(data.ParseFromString(records[k]));
    if (!TrajectoryOfRecord(data)) continue;
    ++num_records;
    std::vector<std::string> changed = records;
    changed[k] = WithTrajectory(records[k], data, 6);
    EXPECT_THAT(ErrorOf(Container(changed)),
                HasSubstr(absl::StrCat("record ", k + 1,
                                       " is of trajectory 6, which is not in "
                                       "the pose graph")));
  }
  EXPECT_EQ(num_records, 2 + 4 + 1 + 2 + 7 + 1);
}

TEST_F(HostileMapTest, SensorDataOutOfOrder) {
  const auto add = [](const int64_t first, const int64_t second,
                      const bool is_imu) {
    return [first, second, is_imu](std::vector<std::string>* records) {
      for (const int64_t time : {first, second}) {
        proto::SerializedData data;
        proto::SensorData& sensor = is_imu
                                        ? *data.mutable_imu_data()
                                        : *data.mutable_fixed_frame_pose_data();
        sensor.set_trajectory_id(SmallMap::kTrajectory);
        sensor.mutable_data()->set_timestamp(time);
        records->push_back(data.SerializeAsString());
      }
    };
  };
  const int64_t later = SmallMap::NodeTime(100);
  for (const bool is_imu : {false, true}) {
    EXPECT_EQ(ErrorOfRecords(add(later, later + 1, is_imu)), "");
    EXPECT_THAT(ErrorOfRecords(add(later, later, is_imu)),
                HasSubstr("that is not in time order"));
  }
}

TEST_F(HostileMapTest, Odometry) {
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                std::swap(map->odometry[2], map->odometry[3]);
              }),
              HasSubstr("has odometry that is not in time order"));
  EXPECT_THAT(ErrorOfChanged([](SmallMap* map) {
                map->odometry[2].mutable_odometry_data()->clear_pose();
              }),
              HasSubstr("has no rotation"));
}

TEST_F(HostileMapTest, PoseGraphs) {
  const auto error = [this](const auto& change) {
    const std::string message =
        ErrorOfChanged([&](SmallMap* map) { change(&map->pose_graph); });
    EXPECT_THAT(message, StartsWith(path_ + " is corrupted: record 2 has "));
    return message;
  };
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                *graph->add_trajectory() = graph->trajectory(0);
              }),
              HasSubstr("trajectory 5 twice"));
  EXPECT_THAT(
      error([](proto::PoseGraph* graph) {
        graph->mutable_trajectory(0)->mutable_node(1)->set_node_index(0);
      }),
      HasSubstr("node 5,0 twice"));
  EXPECT_THAT(
      error([](proto::PoseGraph* graph) {
        graph->mutable_trajectory(0)->mutable_submap(1)->set_submap_index(-1);
      }),
      HasSubstr("invalid id of a submap 5,-1"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_trajectory(0)->mutable_node(1)->clear_pose();
              }),
              HasSubstr("node 5,1 without a pose"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_trajectory(0)
                    ->mutable_node(1)
                    ->mutable_pose()
                    ->clear_rotation();
              }),
              HasSubstr("node 5,1, which has no rotation"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_trajectory(0)
                    ->mutable_submap(0)
                    ->mutable_pose()
                    ->mutable_translation()
                    ->set_y(kNaN);
              }),
              HasSubstr("submap 5,0, which has a translation that is not"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_trajectory(0)->mutable_node(2)->set_timestamp(
                    std::numeric_limits<int64_t>::min());
              }),
              HasSubstr("a node with time -9223372036854775808"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_constraint(2)->mutable_node_id()->set_index(9);
              }),
              HasSubstr("a constraint of submap 5,1 and node 5,9, which are "
                        "not both in it"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                *graph->add_constraint() = graph->constraint(1);
              }),
              HasSubstr("has the intra-submap constraint of submap 5,0 and "
                        "node 5,1 twice"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_constraint(2)->set_tag(2);
              }),
              HasSubstr("unknown tag 2"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_constraint(2)->set_rotation_weight(-1.);
              }),
              HasSubstr("with the weight -1"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_constraint(2)->clear_relative_pose();
              }),
              HasSubstr("node 5,2, which has no rotation"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                *graph->add_landmark_poses() = graph->landmark_poses(0);
              }),
              HasSubstr("a landmark twice"));
  EXPECT_THAT(error([](proto::PoseGraph* graph) {
                graph->mutable_landmark_poses(0)->clear_global_pose();
              }),
              HasSubstr("a landmark, which has no rotation"));
}

TEST_F(HostileMapTest, PointClouds) {
  SmallMap map;
  map.nodes[1]
      .mutable_node_data()
      ->mutable_filtered_gravity_aligned_point_cloud()
      ->set_num_points(2);
  WriteFile(path_, Container(map.Records()));
  EXPECT_THAT(
      std::string(ReadPointClouds(path_, AllNodes()).status().message()),
      HasSubstr(path_ +
                " is corrupted: record 7 (node 5,1) has a point cloud"));
  EXPECT_TRUE(ReadMap(path_).ok());
  map = SmallMap();
  map.nodes[1].mutable_node_id()->set_index(0);
  WriteFile(path_, Container(map.Records()));
  EXPECT_THAT(
      std::string(ReadPointClouds(path_, AllNodes()).status().message()),
      HasSubstr("(node 5,0) is the second of this node"));
}

// Changes bytes behind the compression, so that the damage gets past the
// checksums and into the protocol buffers.
class Mutator {
 public:
  explicit Mutator(const uint32_t seed) : engine_(seed) {}

  void Mutate(std::vector<std::string>* const records) {
    const size_t num_changes = 1 + Below(3);
    for (size_t i = 0; i < num_changes; ++i) {
      const size_t choice = Below(20);
      if (choice == 0) {
        std::swap((*records)[Below(records->size())],
                  (*records)[Below(records->size())]);
      } else if (choice == 1) {
        records->push_back((*records)[Below(records->size())]);
      } else {
        // The pose graph has the most to offer.
        MutateBytes(&(*records)[Below(2) == 0 ? 1 : Below(records->size())]);
      }
    }
  }

 private:
  size_t Below(const size_t limit) { return engine_() % limit; }

  void MutateBytes(std::string* const bytes) {
    if (bytes->empty()) return;
    const size_t position = Below(bytes->size());
    switch (Below(5)) {
      case 0:
        (*bytes)[position] =
            static_cast<char>((*bytes)[position] ^ 1 << Below(8));
        break;
      case 1:
        (*bytes)[position] = static_cast<char>(Below(256));
        break;
      case 2:
        bytes->erase(position, 1 + Below(4));
        break;
      case 3:
        bytes->insert(position, 1 + Below(4), static_cast<char>(Below(256)));
        break;
      default:
        // An infinite or NaN double, or a varint at its limits.
        for (size_t i = position; i < bytes->size() && i < position + 8; ++i) {
          (*bytes)[i] = static_cast<char>(0xff);
        }
    }
  }

  std::mt19937 engine_;
};

TEST_F(HostileMapTest, MutatedRecords) {
  constexpr int kNumMutants = 3000;
  const std::vector<std::string> original = SmallMap().Records();
  int num_valid = 0;
  for (int seed = 0; seed < kNumMutants; ++seed) {
    std::vector<std::string> records = original;
    Mutator(static_cast<uint32_t>(seed)).Mutate(&records);
    if (!ErrorOf(Container(records)).empty()) continue;
    ++num_valid;
    // What is read must be fit for use.
    absl::StatusOr<MapState> state = ReadMap(path_);
    ASSERT_TRUE(state.ok());
    for (auto& [id, node] : state->pose_graph.nodes) {
      ASSERT_TRUE(node.T_map_node.translation().allFinite());
      ASSERT_TRUE(std::isfinite(node.T_map_node.rotation()));
      node.T_map_node = node.T_map_node * Rigid2(0.1, 0., 0.);
    }
    // Writing waits for the disk.
    if (num_valid % 10 != 0) continue;
    const absl::Status status =
        WriteMap(path_, path_ + ".out", state->pose_graph);
    // Only what nobody looked at so far.
    ASSERT_EQ(status.ok(), ReadPointClouds(path_, AllNodes()).ok())
        << status << " with seed " << seed;
    ASSERT_TRUE(!status.ok() || ReadMap(path_ + ".out").ok());
  }
  // Otherwise the mutations are too harmless or too harsh to tell anything.
  EXPECT_GT(num_valid, kNumMutants / 20);
  EXPECT_LT(num_valid, kNumMutants * 19 / 20);
}

}  // namespace
}  // namespace cartographer_sdf::hostile_map_test
