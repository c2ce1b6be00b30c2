// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place/surface_cells.h"

#include <cstring>
#include <map>
#include <optional>
#include <thread>
#include <vector>

#include "cartographer_sdf/place/field_memory.h"
#include "cartographer_sdf/place/place.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::surface_cells_test {
namespace {

bool AreSame(const SurfaceCellArray& a, const SurfaceCellArray& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(),
                     sizeof(SurfaceCell) * static_cast<size_t>(a.size())) == 0;
}

OccupancyGrid RandomGrid(const int width, const int height,
                         const double resolution, const double known) {
  std::mt19937 engine(static_cast<uint32_t>(1000 * width + height));
  CellGeometry geometry;
  geometry.size = {width, height};
  geometry.resolution = resolution;
  geometry.T_submap_grid = Rigid2(1., -2., 0.3);
  OccupancyGrid grid = UnknownGrid(geometry);
  for (Eigen::Index k = 0; k < grid.known.size(); ++k) {
    grid.known(k) = testing::Uniform(0., 1., &engine) < known;
    grid.probability(k) =
        static_cast<float>(testing::Uniform(0.1, 0.9, &engine));
  }
  return grid;
}

SurfaceModel ModelOf(const OccupancyGrid& grid, const double padding = 0.6) {
  FieldOptions options;
  options.padding_meters = padding;
  std::optional<SurfaceModel> model = MakeSurfaceModel(options, grid);
  CHECK(model.has_value());
  return *std::move(model);
}

TEST(SurfaceCellsTest, AreMadeAgainAsTheyWere) {
  const std::vector<SurfaceModel> models = {
      ModelOf(RandomGrid(40, 70, 0.05, 0.7)),
      ModelOf(RandomGrid(300, 20, 0.05, 0.02)),
      ModelOf(RandomGrid(31, 17, 0.2, 1.), 0.),
      // Half a cell is less than a millimetre.
      ModelOf(RandomGrid(40, 40, 0.0005, 0.9), 0.01),
      testing::SurfaceSeenFrom(testing::TwoRooms(), Rigid2(1., 2., 0.7),
                               testing::EastRoomViewpoints())};
  for (const SurfaceModel& model : models) {
    const CellPack pack =
        PackCells(*model.cells.Pin(), model.geometry.resolution);
    ASSERT_TRUE(IsValid(pack));
    EXPECT_TRUE(AreSame(UnpackCells(pack), *model.cells.Pin()));
  }
  // The last one: as submaps are.
  const SurfaceModel& room = models.back();
  EXPECT_LT(20 * room.cells.Pack().runs.size() * sizeof(uint16_t),
            room.cells.NumBytes());
}

TEST(SurfaceCellsTest, PacksOfOtherBytesAreInvalid) {
  const SurfaceModel model = ModelOf(RandomGrid(30, 20, 0.05, 0.5));
  const CellPack good = model.cells.Pack();
  ASSERT_TRUE(IsValid(good));
  CellPack bad = good;
  ++bad.size.x();
  EXPECT_FALSE(IsValid(bad));
  bad = good;
  bad.size.y() = 0;
  EXPECT_FALSE(IsValid(bad));
  bad = good;
  bad.runs.pop_back();
  EXPECT_FALSE(IsValid(bad));
  bad = good;
  bad.runs.push_back(127 << 9);  // a length that is cut off
  EXPECT_FALSE(IsValid(bad));
  bad = good;
  bad.runs.front() |= 511;  // no such state
  EXPECT_FALSE(IsValid(bad));
  bad = good;
  for (uint16_t& word : bad.runs) {
    if ((word & 511) == 1) word ^= 3;  // free instead of occupied
  }
  EXPECT_FALSE(IsValid(bad)) << "no wall, no distance";
}

std::map<SubmapId, Place> Rooms(const int count) {
  std::map<SubmapId, Place> places;
  for (int k = 0; k < count; ++k) {
    const SubmapId id{0, k};
    places.emplace(
        id, *DescribePlace(
                PlaceOptions(), id,
                testing::SeeFrom(testing::TwoRooms(), Rigid2(1., 2., 0.4 * k),
                                 testing::WestRoomViewpoints())));
  }
  return places;
}

PlaceOptions WithBound(const double num_bytes) {
  PlaceOptions options;
  options.max_field_megabytes = 1e-6 * num_bytes;
  return options;
}

TEST(FieldMemoryTest, DropsNothingThatFits) {
  std::map<SubmapId, Place> places = Rooms(3);
  double sum = 0.;
  for (const auto& [id, place] : places) {
    sum += static_cast<double>(place.surface.cells.NumBytes());
  }
  FieldMemory memory(WithBound(sum + 1.));
  const SurfaceCellArray* const cells = &*places.at({0, 0}).surface.cells.Pin();
  memory.Add(&places);
  EXPECT_EQ(memory.NumBytes(), sum);
  EXPECT_EQ(&*places.at({0, 0}).surface.cells.Pin(), cells);
}

TEST(FieldMemoryTest, KeepsToItsBoundAndChangesNothing) {
  const std::map<SubmapId, Place> expected = Rooms(6);
  std::map<SubmapId, Place> first = Rooms(4), second = Rooms(6);
  for (int k = 0; k < 4; ++k) second.erase({0, k});
  const double largest =
      1.1 * static_cast<double>(expected.at({0, 0}).surface.cells.NumBytes());
  FieldMemory memory(WithBound(2.5 * largest));
  memory.Add(&first);
  memory.Add(&second);
  first.merge(second);
  EXPECT_LE(static_cast<double>(memory.NumBytes()), 2.5 * largest);
  EXPECT_GT(static_cast<double>(memory.NumBytes()), 0.5 * largest);
  for (int round = 0; round < 3; ++round) {
    for (const auto& [id, place] : expected) {
      const SurfaceCells& cells = first.at(id).surface.cells;
      const SurfaceCells copy = cells;
      ASSERT_TRUE(AreSame(*copy.Pin(), *place.surface.cells.Pin())) << id;
      EXPECT_LE(static_cast<double>(memory.NumBytes()), 2.5 * largest);
    }
  }
  // What is in use stays, whatever is looked at meanwhile.
  const PinnedCells pinned = first.at({0, 0}).surface.cells.Pin();
  for (const auto& [id, place] : first) (void)place.surface.cells.Pin();
  EXPECT_TRUE(AreSame(*pinned, *expected.at({0, 0}).surface.cells.Pin()));
  // What no longer exists takes no memory.
  first.clear();
  EXPECT_EQ(memory.NumBytes(), 0u);
}

TEST(FieldMemoryTest, ServesSeveralThreads) {
  const std::map<SubmapId, Place> expected = Rooms(4);
  std::map<SubmapId, Place> places = Rooms(4);
  FieldMemory memory(WithBound(0.));
  memory.Add(&places);
  std::vector<std::thread> threads;
  std::vector<int> num_same(4, 0);
  for (size_t t = 0; t < num_same.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int k = 0; k < 12; ++k) {
        const SubmapId id{0, static_cast<int>(k * (t + 1)) % 4};
        num_same[t] += AreSame(*places.at(id).surface.cells.Pin(),
                               *expected.at(id).surface.cells.Pin());
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(num_same, ::testing::Each(12));
}

}  // namespace
}  // namespace cartographer_sdf::surface_cells_test
