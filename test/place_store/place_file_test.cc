// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place_store/place_file.h"

#include <filesystem>
#include <functional>
#include <limits>
#include <random>

#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/place_index.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/random_number.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::place_file_test {
namespace {

using ::testing::HasSubstr;
using ProtoPlace = proto::place_index::Place;

Place Room(const SubmapId& id) {
  Place place = *DescribePlace(
      PlaceOptions(), id,
      testing::SeeFrom(testing::TwoRooms(), Rigid2(1., 2., 0.1 * id.index),
                       testing::WestRoomViewpoints()));
  place.surface.self_similar_poses = {Rigid2(1., -2., 3.)};
  return place;
}

void ExpectSame(const Rigid2& a, const Rigid2& b) {
  EXPECT_EQ(a.translation(), b.translation());
  EXPECT_EQ(a.rotation(), b.rotation());
}

void ExpectSame(const Place& a, const Place& b) {
  EXPECT_EQ(a.id, b.id);
  const CellGeometry &g = a.surface.geometry, &h = b.surface.geometry;
  ASSERT_TRUE((g.size == h.size).all());
  EXPECT_EQ(g.resolution, h.resolution);
  ExpectSame(g.T_submap_grid, h.T_submap_grid);
  const PinnedCells a_cells = a.surface.cells.Pin();
  const PinnedCells b_cells = b.surface.cells.Pin();
  ASSERT_EQ(a_cells->size(), b_cells->size());
  for (Eigen::Index k = 0; k < a_cells->size(); ++k) {
    const SurfaceCell& c = a_cells->data()[k];
    const SurfaceCell& d = b_cells->data()[k];
    ASSERT_EQ(c.distance, d.distance) << k;
    ASSERT_EQ(c.free, d.free) << k;
    ASSERT_EQ(c.observed, d.observed) << k;
  }
  ASSERT_EQ(a.surface.walls.size(), b.surface.walls.size());
  for (size_t k = 0; k < a.surface.walls.size(); ++k) {
    EXPECT_EQ(a.surface.walls[k].position, b.surface.walls[k].position);
    EXPECT_EQ(a.surface.walls[k].weight, b.surface.walls[k].weight);
  }
  EXPECT_EQ(a.surface.observed_points, b.surface.observed_points);
  EXPECT_EQ(a.surface.area_per_observed_point,
            b.surface.area_per_observed_point);
  ASSERT_EQ(a.surface.self_similar_poses.size(),
            b.surface.self_similar_poses.size());
  for (size_t k = 0; k < a.surface.self_similar_poses.size(); ++k) {
    ExpectSame(a.surface.self_similar_poses[k],
               b.surface.self_similar_poses[k]);
  }
  ASSERT_EQ(a.features.features.size(), b.features.features.size());
  for (size_t k = 0; k < a.features.features.size(); ++k) {
    const Feature &f = a.features.features[k], &g2 = b.features.features[k];
    EXPECT_EQ(f.keypoint.position, g2.keypoint.position);
    EXPECT_EQ(f.keypoint.clearance, g2.keypoint.clearance);
    EXPECT_EQ(f.keypoint.kind, g2.keypoint.kind);
    EXPECT_EQ(f.keypoint.strength, g2.keypoint.strength);
    EXPECT_EQ(f.orientation, g2.orientation);
  }
  EXPECT_EQ(a.features.descriptors, b.features.descriptors);
}

class PlaceFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const SubmapId& id : {SubmapId{0, 3}, SubmapId{1, 0}}) {
      places_.emplace(id, Room(id));
    }
    directory_.Write("map", std::string(200000, 'm') + "ap");
    const auto key = MakePlaceFileKey(directory_.File("map"), "options");
    ASSERT_TRUE(key.ok()) << key.status();
    key_ = *key;
  }

  void Write() const {
    const absl::Status status = WritePlaces(path_, key_, places_);
    ASSERT_TRUE(status.ok()) << status;
  }
  // Of reading the file, which fails.
  [[nodiscard]] std::string Error(const PlaceFileKey& key) const {
    const auto places = ReadPlaces(path_, key);
    if (places.ok()) return "";
    EXPECT_THAT(std::string(places.status().message()), HasSubstr(path_));
    return std::string(places.status().message());
  }

  testing::TemporaryDirectory directory_;
  const std::string path_ = directory_.File("places");
  std::map<SubmapId, Place> places_;
  PlaceFileKey key_;
};

TEST_F(PlaceFileTest, ReadsWhatWasWritten) {
  ASSERT_FALSE(places_.at({0, 3}).features.features.empty());
  Write();
  const auto read = ReadPlaces(path_, key_);
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->size(), 2u);
  for (const auto& [id, place] : places_) ExpectSame(read->at(id), place);
  const std::string bytes = directory_.Read("places");
  Write();
  EXPECT_EQ(directory_.Read("places"), bytes);
}

TEST_F(PlaceFileTest, KeepsPlacesWithoutFeaturesAndFilesWithoutPlaces) {
  places_.at({0, 3}).features = FeatureSet();
  Write();
  auto read = ReadPlaces(path_, key_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_TRUE(read->at({0, 3}).features.features.empty());
  places_.clear();
  Write();
  read = ReadPlaces(path_, key_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_TRUE(read->empty());
}

TEST_F(PlaceFileTest, RefusesWhatBelongsToSomethingElse) {
  EXPECT_TRUE(absl::IsNotFound(ReadPlaces(path_, key_).status()));
  Write();
  PlaceFileKey key = key_;
  key.options += " ";
  EXPECT_THAT(Error(key), HasSubstr("other options"));
  // The same size, one byte of the second block other.
  std::string map = directory_.Read("map");
  map[100000] = 'n';
  key = *MakePlaceFileKey(directory_.Write("other", map), "options");
  EXPECT_EQ(key.map_size, key_.map_size);
  EXPECT_THAT(Error(key), HasSubstr("another map"));
  key = key_;
  ++key.map_size;
  EXPECT_THAT(Error(key), HasSubstr("another map"));
}

// Without a look at most of its bytes.
TEST_F(PlaceFileTest, BelongsToTheRecordsOfAMap) {
  const auto key = [this](const std::vector<std::string>& records) {
    const std::string path =
        directory_.Write("map", testing::Container(records));
    const auto made = MakePlaceFileKey(path, "options");
    EXPECT_TRUE(made.ok()) << made.status();
    return made->map_hash;
  };
  const std::string grid(100000, 'g');
  std::string other = grid;
  other[50000] = 'h';
  const uint64_t hash = key({"header", "graph", grid, "node"});
  EXPECT_EQ(key({"header", "graph", grid, "node"}), hash);
  EXPECT_NE(key({"header", "graph", other, "node"}), hash);
  EXPECT_NE(key({"header", "graph", "node", grid}), hash);
  EXPECT_NE(key({"header", "graph", grid}), hash);
  // A file that was cut has a key, too.
  std::string cut = testing::Container({"header", "graph", grid, "node"});
  cut.pop_back();
  const auto made = MakePlaceFileKey(directory_.Write("cut", cut), "options");
  ASSERT_TRUE(made.ok()) << made.status();
  EXPECT_NE(made->map_hash, hash);
}

// Closing loops changes the pose graph alone, and no description.
TEST_F(PlaceFileTest, BelongsToAMapWhateverItsPoseGraph) {
  const auto key = [this](const std::string& graph, const std::string& grid,
                          const PoseGraphInKey pose_graph) {
    const std::string path = directory_.Write(
        "map", testing::Container({"header", graph, "options", grid}));
    const auto made = MakePlaceFileKey(path, "options", pose_graph);
    CHECK(made.ok()) << made.status();
    return std::make_pair(made->map_hash, made->map_size);
  };
  const std::string longer(1000, 'g');
  const auto hash = key("graph", "grid", PoseGraphInKey::kNo);
  EXPECT_EQ(key("other", "grid", PoseGraphInKey::kNo), hash);
  EXPECT_EQ(key(longer, "grid", PoseGraphInKey::kNo), hash);
  EXPECT_NE(key("graph", "gray", PoseGraphInKey::kNo), hash);
  EXPECT_NE(key("graph", longer, PoseGraphInKey::kNo), hash);
  const auto with_graph = key("graph", "grid", PoseGraphInKey::kYes);
  EXPECT_EQ(key("graph", "grid", PoseGraphInKey::kYes), with_graph);
  EXPECT_NE(key("other", "grid", PoseGraphInKey::kYes), with_graph);
  EXPECT_NE(key(longer, "grid", PoseGraphInKey::kYes), with_graph);
}

TEST_F(PlaceFileTest, NeedsAMapThatCanBeRead) {
  const auto key = MakePlaceFileKey(directory_.File("none"), "");
  ASSERT_FALSE(key.ok());
  EXPECT_THAT(std::string(key.status().message()), HasSubstr("none"));
}

TEST_F(PlaceFileTest, AnyDamageIsAnError) {
  Write();
  const std::string good = directory_.Read("places");
  // Everywhere near the ends and the records' seams, and here and there.
  std::mt19937 engine(42);
  for (int round = 0; round < 300; ++round) {
    const size_t at = round < 100
                          ? static_cast<size_t>(round)
                          : static_cast<size_t>(testing::UniformInt(
                                static_cast<int>(good.size()), &engine));
    directory_.Write("places", good.substr(0, at));
    EXPECT_NE(Error(key_), "") << "cut at " << at;
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << round % 8));
    directory_.Write("places", bad);
    const auto read = ReadPlaces(path_, key_);
    if (!read.ok()) continue;
    // Bytes of gzip's header that mean nothing.
    for (const auto& [id, place] : places_) ExpectSame(read->at(id), place);
  }
  directory_.Write("places", good + "x");
  EXPECT_NE(Error(key_), "");
  directory_.Write("places", "");
  EXPECT_NE(Error(key_), "");
  std::filesystem::remove(path_);
  std::filesystem::create_directory(path_);
  EXPECT_NE(Error(key_), "");
}

// Sound containers with contents that are not.
TEST_F(PlaceFileTest, RecordsMustMatchTheHeader) {
  Write();
  std::vector<std::string> records;
  {
    auto reader = RecordReader::Open(path_);
    ASSERT_TRUE(reader.ok());
    std::string record;
    while (*reader->Read(&record)) records.push_back(record);
  }
  ASSERT_EQ(records.size(), 3u);
  const auto error = [this](const std::vector<std::string>& written) {
    auto writer = RecordWriter::Open(path_);
    for (const std::string& record : written) {
      EXPECT_TRUE(writer->Write(record).ok());
    }
    EXPECT_TRUE(writer->Commit().ok());
    return Error(key_);
  };
  EXPECT_EQ(error(records), "");
  EXPECT_THAT(error({}), HasSubstr("header"));
  EXPECT_THAT(error({records[0]}), HasSubstr("0 places of 2"));
  EXPECT_THAT(error({records[0], records[1]}), HasSubstr("1 places of 2"));
  EXPECT_THAT(error({records[0], records[1], records[1]}),
              HasSubstr("has a duplicate place"));
  EXPECT_THAT(error({records[1], records[1], records[2]}),
              ::testing::Not(::testing::IsEmpty()));
  EXPECT_THAT(error({records[0], records[1], "nonsense"}),
              HasSubstr("record 3 is not a place"));
  ProtoPlace place;
  ASSERT_TRUE(place.ParseFromString(records[2]));
  place.mutable_descriptors()->Resize(
      place.descriptors_size() / 2 / static_cast<int>(place.kinds().size()) *
          static_cast<int>(place.kinds().size()),
      0.f);
  EXPECT_THAT(error({records[0], records[1], place.SerializeAsString()}),
              HasSubstr("another length"));
  proto::place_index::Header header;
  ASSERT_TRUE(header.ParseFromString(records[0]));
  header.set_version(77);
  EXPECT_THAT(error({header.SerializeAsString(), records[1], records[2]}),
              HasSubstr("version 77"));
  header.set_kind("poems");
  EXPECT_THAT(error({header.SerializeAsString(), records[1], records[2]}),
              HasSubstr("not a place file"));
}

TEST(PlaceCodecTest, ImpossiblePlacesAreErrors) {
  const std::string good = EncodePlace(Room({0, 3}));
  ASSERT_TRUE(DecodePlace(good).ok());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  using Change = std::function<void(ProtoPlace*)>;
  const std::vector<std::pair<const char*, Change>> changes = {
      {"negative", [](ProtoPlace* p) { p->set_index(-1); }},
      {"size", [](ProtoPlace* p) { p->set_num_cells_x(0); }},
      {"size", [](ProtoPlace* p) { p->set_num_cells_y(-5); }},
      {"size", [](ProtoPlace* p) { p->set_num_cells_y(1 << 30); }},
      {"size", [](ProtoPlace* p) { p->set_num_cells_x(1 << 20); }},
      {"cells", [](ProtoPlace* p) { p->set_num_cells_x(1 << 15); }},
      {"cells", [](ProtoPlace* p) { p->mutable_runs()->pop_back(); }},
      {"cells", [](ProtoPlace* p) { p->mutable_runs()->resize(10); }},
      {"cells",
       [](ProtoPlace* p) {
         (*p->mutable_runs())[0] = static_cast<char>(0xff);
         (*p->mutable_runs())[1] |= 1;
       }},
      {"no wall",
       [](ProtoPlace* p) {
         // One run of unknown cells, as many as there are.
         const uint32_t n = static_cast<uint32_t>(p->num_cells_x()) *
                            static_cast<uint32_t>(p->num_cells_y());
         std::string runs = {0, static_cast<char>(127 << 1)};
         for (int k = 0; k < 4; ++k) {
           runs.push_back(static_cast<char>(n >> 8 * k & 0xff));
         }
         p->set_runs(runs);
       }},
      {"resolution", [](ProtoPlace* p) { p->set_resolution(0.); }},
      {"resolution", [nan](ProtoPlace* p) { p->set_resolution(nan); }},
      {"pose",
       [infinity](ProtoPlace* p) {
         p->mutable_t_submap_grid()->set_x(infinity);
       }},
      {"pose",
       [](ProtoPlace* p) { p->mutable_t_submap_grid()->set_rotation(1e9); }},
      {"walls", [](ProtoPlace* p) { p->clear_walls(); }},
      {"walls", [](ProtoPlace* p) { p->add_walls(1.); }},
      {"wall", [nan](ProtoPlace* p) { p->set_walls(3, nan); }},
      {"wall", [](ProtoPlace* p) { p->set_walls(2, 0.); }},
      {"observed points", [](ProtoPlace* p) { p->clear_observed_points(); }},
      {"observed points", [](ProtoPlace* p) { p->add_observed_points(1.); }},
      {"observed point",
       [](ProtoPlace* p) { p->set_observed_points(1, -1e300); }},
      {"area", [](ProtoPlace* p) { p->set_area_per_observed_point(-1.); }},
      {"self-similar",
       [nan](ProtoPlace* p) { p->mutable_self_similar_poses(0)->set_y(nan); }},
      {"features", [](ProtoPlace* p) { p->add_features(1.); }},
      {"features", [](ProtoPlace* p) { p->mutable_kinds()->push_back(0); }},
      {"descriptors", [](ProtoPlace* p) { p->add_descriptors(1.f); }},
      {"descriptors", [](ProtoPlace* p) { p->clear_descriptors(); }},
      {"feature", [](ProtoPlace* p) { (*p->mutable_kinds())[0] = 3; }},
      {"feature", [nan](ProtoPlace* p) { p->set_features(0, nan); }},
      {"feature", [](ProtoPlace* p) { p->set_features(2, 1e20); }},
      {"feature", [nan](ProtoPlace* p) { p->set_features(4, nan); }},
      {"descriptor", [](ProtoPlace* p) {
         p->set_descriptors(1, std::numeric_limits<float>::quiet_NaN());
       }}};
  for (size_t k = 0; k < changes.size(); ++k) {
    ProtoPlace proto;
    ASSERT_TRUE(proto.ParseFromString(good));
    changes[k].second(&proto);
    const auto place = DecodePlace(proto.SerializeAsString());
    ASSERT_FALSE(place.ok()) << k;
    EXPECT_THAT(std::string(place.status().message()),
                HasSubstr(changes[k].first))
        << k;
  }
}

}  // namespace
}  // namespace cartographer_sdf::place_file_test
