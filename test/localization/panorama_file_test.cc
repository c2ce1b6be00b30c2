// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/panorama_file.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/drawn_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::panorama_file_test {
namespace {

using ::testing::HasSubstr;

class PanoramaFileTest : public ::testing::Test {
 protected:
  PanoramaFileTest()
      : map_{testing::TwoRoomsGrid(),
             *MakePanoramaMap({}, testing::TwoRoomsGrid(), {})},
        key_(MakeGridKey(map_.grid, FormatPanoramaOptions({}))),
        path_(directory_.File("map.places")) {}

  testing::TemporaryDirectory directory_;
  const DrawnMap map_;
  const PlaceFileKey key_;
  const std::string path_;
};

TEST_F(PanoramaFileTest, GivesBackWhatWasWritten) {
  ASSERT_TRUE(WritePanoramas(path_, key_, map_).ok());
  EXPECT_TRUE(IsPlaceFile(path_));
  const absl::StatusOr<DrawnMap> read = ReadPanoramas(path_, key_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_TRUE((read->grid.probability == map_.grid.probability).all());
  EXPECT_TRUE((read->grid.known == map_.grid.known).all());
  const Viewpoints& before = map_.panoramas.viewpoints;
  const Viewpoints& after = read->panoramas.viewpoints;
  EXPECT_EQ(after.positions, before.positions);
  EXPECT_EQ(after.ranges, before.ranges);
  EXPECT_EQ(after.masks, before.masks);
  EXPECT_EQ(after.step, before.step);
  EXPECT_TRUE((read->panoramas.rays.steps == map_.panoramas.rays.steps).all());
  EXPECT_TRUE((read->panoramas.rays.field.distance ==
               map_.panoramas.rays.field.distance)
                  .all());
}

TEST_F(PanoramaFileTest, BelongsToItsMapAndOptions) {
  EXPECT_TRUE(absl::IsNotFound(ReadPanoramas(path_, key_).status()));
  ASSERT_TRUE(WritePanoramas(path_, key_, map_).ok());
  ViewpointOptions options;
  options.step_meters = 0.4;
  OccupancyGrid changed = map_.grid;
  changed.probability(3, 3) = 0.7f;
  for (const PlaceFileKey& key :
       {MakeGridKey(map_.grid, FormatPanoramaOptions(options)),
        MakeGridKey(changed, key_.options)}) {
    const absl::Status status = ReadPanoramas(path_, key).status();
    EXPECT_TRUE(absl::IsFailedPrecondition(status)) << status;
  }
  // Places of submaps, and this: neither is taken for the other.
  EXPECT_TRUE(absl::IsFailedPrecondition(ReadPlaces(path_, key_).status()));
  ASSERT_TRUE(WritePlaces(path_, key_, {}).ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(ReadPanoramas(path_, key_).status()));
}

TEST_F(PanoramaFileTest, AnyBytesAreAnErrorOfOneLine) {
  ASSERT_TRUE(WritePanoramas(path_, key_, map_).ok());
  const std::string good = directory_.Read("map.places");
  const auto expect_error = [&](const std::string& bytes) {
    directory_.Write("map.places", bytes);
    const absl::Status status = ReadPanoramas(path_, key_).status();
    EXPECT_FALSE(status.ok());
    EXPECT_EQ(std::string(status.message()).find('\n'), std::string::npos);
    EXPECT_THAT(std::string(status.message()), HasSubstr("map.places"));
  };
  expect_error("");
  expect_error("nothing of the kind");
  for (const double part : {0.01, 0.3, 0.6, 0.99}) {
    expect_error(good.substr(
        0, static_cast<size_t>(part * static_cast<double>(good.size()))));
  }
  int num_harmless = 0;
  for (size_t k = 20; k < good.size(); k += good.size() / 50) {
    std::string bytes = good;
    bytes[k] = static_cast<char>(bytes[k] ^ 0x5a);
    directory_.Write("map.places", bytes);
    const absl::StatusOr<DrawnMap> read = ReadPanoramas(path_, key_);
    if (!read.ok()) {
      expect_error(bytes);
      continue;
    }
    // Compressed records begin with a few bytes that no checksum covers, such
    // as the time, and that change nothing.
    ++num_harmless;
    EXPECT_TRUE((read->grid.probability == map_.grid.probability).all());
    EXPECT_EQ(read->panoramas.viewpoints.ranges,
              map_.panoramas.viewpoints.ranges);
    EXPECT_EQ(read->panoramas.viewpoints.masks,
              map_.panoramas.viewpoints.masks);
  }
  EXPECT_LE(num_harmless, 3);
  expect_error(good + good.substr(8));
}

}  // namespace
}  // namespace cartographer_sdf::panorama_file_test
