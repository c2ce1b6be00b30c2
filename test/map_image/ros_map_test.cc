// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/map_image/ros_map.h"

#include <cmath>
#include <string>

#include "cartographer_sdf/map_image/grey_image.h"
#include "cartographer_sdf/report/picture.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::ros_map_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Three pixels wide, two high: a wall, unknown, free over free, free, wall.
constexpr char kImage[] = "P2\n3 2\n255\n0 205 254\n254 254 0\n";
constexpr char kYaml[] =
    "image: map.pgm\nresolution: 0.1\norigin: [1.0, 2.0, 0.0]\n"
    "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

class RosMapTest : public ::testing::Test {
 protected:
  RosMapTest() { directory_.Write("map.pgm", kImage); }
  absl::StatusOr<OccupancyGrid> Read(const std::string& yaml) {
    return ReadRosMap(directory_.Write("map.yaml", yaml));
  }
  void ExpectError(const std::string& yaml, const std::string& part) {
    const auto grid = Read(yaml);
    ASSERT_FALSE(grid.ok()) << yaml;
    EXPECT_THAT(std::string(grid.status().message()), HasSubstr(part));
    EXPECT_THAT(std::string(grid.status().message()), Not(HasSubstr("\n")));
  }
  // '#', '.' or ' ' at a point of the map frame.
  static char At(const OccupancyGrid& grid, const double x, const double y) {
    const Eigen::Array2i cell = grid.geometry.CellAt({x, y});
    if (!grid.geometry.Contains(cell)) return '?';
    if (!grid.known(cell.x(), cell.y())) return ' ';
    return grid.probability(cell.x(), cell.y()) > 0.5f ? '#' : '.';
  }
  testing::TemporaryDirectory directory_;
};

TEST_F(RosMapTest, IsWhereItsOriginSays) {
  const auto grid = Read(kYaml);
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(At(*grid, 1.05, 2.15), '#');
  EXPECT_EQ(At(*grid, 1.15, 2.15), ' ');
  EXPECT_EQ(At(*grid, 1.25, 2.15), '.');
  EXPECT_EQ(At(*grid, 1.05, 2.05), '.');
  EXPECT_EQ(At(*grid, 1.25, 2.05), '#');
  EXPECT_EQ(At(*grid, 0.95, 2.05), '?');
}

TEST_F(RosMapTest, MayBeTurned) {
  const auto grid = Read(
      "image: map.pgm\nresolution: 0.1\norigin:\n- 1.0\n- 2.0\n"
      "- 1.5707963267948966\n");
  ASSERT_TRUE(grid.ok()) << grid.status();
  // Of the lower line the third pixel, straight up from the origin.
  EXPECT_EQ(At(*grid, 0.95, 2.25), '#');
}

TEST_F(RosMapTest, IsFoundByTheNameOfItsImage) {
  ASSERT_TRUE(Read(kYaml).ok());
  EXPECT_TRUE(ReadRosMap(directory_.File("map.pgm")).ok());
  directory_.Write("lonely.pgm", kImage);
  const auto lonely = ReadRosMap(directory_.File("lonely.pgm"));
  ASSERT_FALSE(lonely.ok());
  EXPECT_THAT(std::string(lonely.status().message()),
              HasSubstr("lonely.yaml is missing"));
  EXPECT_TRUE(IsRosMapName("a/map.YAML"));
  EXPECT_TRUE(IsRosMapName("map.png"));
  EXPECT_FALSE(IsRosMapName("map.pbstream"));
  EXPECT_FALSE(IsRosMapName("yaml"));
}

TEST_F(RosMapTest, HasTheModesOfMapServer) {
  directory_.Write("map.pgm", "P2\n4 1\n255\n0 100 128 254\n");
  const std::string yaml =
      "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nmode: ";
  const auto row = [&](const std::string& rest) {
    const auto grid = Read(yaml + rest);
    EXPECT_TRUE(grid.ok()) << grid.status();
    std::string text;
    for (int k = 0; k < 4; ++k) text += At(*grid, 0.1 * k + 0.05, 0.05);
    return text;
  };
  EXPECT_EQ(row("trinary\n"), "#  .");
  EXPECT_EQ(row("scale\n"), "##..");
  EXPECT_EQ(row("raw\n"), ".#  ");
  EXPECT_EQ(row("trinary\nnegate: 1\n"), ".  #");
  EXPECT_EQ(row("trinary\noccupied_thresh: 0.55\n"), "## .");
}

TEST_F(RosMapTest, ReadsPngImages) {
  Picture picture(3, 2, kWhite);
  picture.BlendPixel(0, 0, kBlack);
  directory_.Write("map.png", picture.EncodePng());
  const auto grid =
      Read("image: map.png\nresolution: 0.1\norigin: [0, 0, 0]\n");
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(grid->geometry.size.x(), 3);
  EXPECT_EQ(At(*grid, 0.05, 0.15), '#');
  EXPECT_EQ(At(*grid, 0.15, 0.15), '.');
  EXPECT_EQ(At(*grid, 0.05, 0.05), '.');
}

TEST_F(RosMapTest, BadDescriptionsAreErrorsOfOneLine) {
  EXPECT_FALSE(ReadRosMap(directory_.File("absent.yaml")).ok());
  ExpectError("", "no members");
  ExpectError("a: [", "map.yaml");
  ExpectError("\t- : {", "map.yaml");
  ExpectError("image: map.pgm\n", "resolution");
  ExpectError("image: map.pgm\nresolution: 0.1\n", "origin");
  ExpectError("image: map.pgm\nresolution: no\norigin: [0, 0, 0]\n",
              "map.yaml");
  ExpectError("image: map.pgm\nresolution: -1\norigin: [0, 0, 0]\n",
              "resolution");
  ExpectError("image: map.pgm\nresolution: .nan\norigin: [0, 0, 0]\n",
              "resolution");
  ExpectError("image: map.pgm\nresolution: 0.1\norigin: 3\n", "origin");
  ExpectError("image: map.pgm\nresolution: 0.1\norigin: [.inf, 0, 0]\n",
              "origin");
  ExpectError(std::string(kYaml) + "mode: fancy\n", "mode");
  ExpectError(
      "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nfree_thresh: 2\n",
      "thresh");
  ExpectError("image: gone.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n",
              "gone.pgm");
  ExpectError(std::string(20000, '['), "map.yaml");
  ExpectError(std::string(100000, ' '), "too large");
}

TEST_F(RosMapTest, BadImagesAreErrorsOfOneLine) {
  const auto read = [&](const std::string& content) {
    return ReadPngImage(directory_.Write("bad.png", content));
  };
  Picture picture(30, 20, kWhite);
  const std::string png = picture.EncodePng();
  EXPECT_TRUE(read(png).ok());
  EXPECT_FALSE(read("").ok());
  EXPECT_FALSE(read("no image").ok());
  EXPECT_FALSE(read(png.substr(0, 30)).ok());
  EXPECT_FALSE(read(png.substr(0, png.size() / 2)).ok());
  std::string huge = png;
  huge[16] = 0x7f;  // the width
  const auto refused = read(huge);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("too large"));
  EXPECT_FALSE(ReadPngImage(directory_.File("absent.png")).ok());
}

}  // namespace
}  // namespace cartographer_sdf::ros_map_test
