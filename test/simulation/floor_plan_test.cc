// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/floor_plan.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"

namespace cartographer_sdf::floor_plan_test {
namespace {

using ::testing::HasSubstr;

std::string WriteFile(const std::string& content) {
  const std::string path = ::testing::TempDir() + "floor_plan_test.pgm";
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

absl::StatusOr<FloorPlan> Read(const std::string& content) {
  return ReadPgm(WriteFile(content), 0.05);
}

TEST(FloorPlanTest, EmptyPlanCoversItsSize) {
  const FloorPlan plan = EmptyFloorPlan({2., 1.01}, 0.1);
  EXPECT_EQ(plan.geometry.size.x(), 20);
  EXPECT_EQ(plan.geometry.size.y(), 11);
  EXPECT_EQ(plan.occupied.count(), 0);
}

TEST(FloorPlanTest, FillsShapes) {
  constexpr double kResolution = 0.02;
  // Area of a ring of one cell around a shape of this perimeter: the most that
  // rasterising can err.
  const auto tolerance = [](double perimeter) { return perimeter * 0.02; };
  FloorPlan plan = EmptyFloorPlan({6., 6.}, kResolution);
  FillRectangle({3., 3.}, {2., 1.}, 0.7, true, &plan);
  EXPECT_NEAR(
      static_cast<double>(plan.occupied.count()) * kResolution * kResolution,
      2., tolerance(6.));
  // A point that is in the rotated rectangle but not in an unrotated one.
  const Eigen::Array2i corner =
      plan.geometry.CellAt(Rigid2(3., 3., 0.7) * Eigen::Vector2d(0.9, 0.));
  EXPECT_TRUE(plan.occupied(corner.x(), corner.y()));
  FillRectangle({3., 3.}, {9., 9.}, 0., false, &plan);
  EXPECT_EQ(plan.occupied.count(), 0);
  FillDisc({3., 3.}, 1., &plan);
  EXPECT_NEAR(
      static_cast<double>(plan.occupied.count()) * kResolution * kResolution,
      M_PI, tolerance(2. * M_PI));
  FillDisc({-0.9, 0.}, 1., &plan);  // Clipped.
  FillDisc({20., 20.}, 1., &plan);
}

TEST(FloorPlanTest, ReadsTextFromTheTopLeft) {
  const absl::StatusOr<FloorPlan> plan =
      Read("P2\n# a comment\n3 2 # another\n255\n0 254 254\n205 254 255\n");
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->geometry.size.x(), 3);
  EXPECT_EQ(plan->geometry.size.y(), 2);
  EXPECT_EQ(plan->geometry.resolution, 0.05);
  EXPECT_TRUE(plan->occupied(0, 1));  // Black, top left.
  EXPECT_TRUE(plan->occupied(0, 0));  // Grey is unknown.
  EXPECT_EQ(plan->occupied.count(), 2);
}

TEST(FloorPlanTest, ReadsBinaryOfOneAndTwoBytes) {
  // A pixel that looks like white space or a comment is still a pixel.
  const absl::StatusOr<FloorPlan> one =
      Read(std::string("P5 2 2 255\n\n#\xff\xff"));
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_TRUE(one->occupied(0, 1));
  EXPECT_TRUE(one->occupied(1, 1));
  EXPECT_FALSE(one->occupied(0, 0));
  const absl::StatusOr<FloorPlan> two =
      Read(std::string("P5 2 1 1000\n\x03\xe7\x00\xff", 16));
  ASSERT_TRUE(two.ok()) << two.status();
  EXPECT_FALSE(two->occupied(0, 0));
  EXPECT_TRUE(two->occupied(1, 0));
}

TEST(FloorPlanTest, RefusesWhatIsNoImage) {
  const std::string hostile[] = {
      "",
      "P",
      "P6 1 1 255\nabc",
      "P5",
      "P5 2",
      "P5 2 2 255",
      "P5 2 2 255\nabc",
      "P5 0 2 255\n",
      "P5 -1 2 255\nab",
      "P5 2 2 0\nabcd",
      "P5 2 2 70000\nabcdefgh",
      "P5 99999 99999 255\nab",
      "P5 99999999999999999999 1 255\nab",
      "P5 4294967297 4294967297 255\nab",
      "P5 5000 5000 255\nab",
      "P5 2 1 100\na\xff",
      "P2 2 1 255\n1",
      "P2 2 1 255\n1 256",
      "P2 2 1 255\n1 -1",
      "P2 2 1 255\n1 x",
      "P2 # endless comment",
  };
  for (const std::string& content : hostile) {
    const absl::StatusOr<FloorPlan> plan = Read(content);
    ASSERT_FALSE(plan.ok()) << content;
    EXPECT_THAT(std::string(plan.status().message()),
                HasSubstr("floor_plan_test.pgm"));
  }
}

TEST(FloorPlanTest, RefusesMissingFilesDirectoriesAndOddResolutions) {
  EXPECT_FALSE(ReadPgm(::testing::TempDir() + "missing.pgm", 0.05).ok());
  EXPECT_FALSE(ReadPgm(::testing::TempDir(), 0.05).ok());
  const std::string path = WriteFile("P2 1 1 255\n255\n");
  EXPECT_TRUE(ReadPgm(path, 0.05).ok());
  for (const double resolution :
       {0., -0.05, 1e-9, 1e9, std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(ReadPgm(path, resolution).ok()) << resolution;
  }
}

TEST(FloorPlanTest, ReadsARealPlan) {
  SKIP_WITHOUT_SHARED_DATA("willow_garage.pgm");
  const absl::StatusOr<FloorPlan> plan =
      ReadPgm(SharedDataPath("willow_garage.pgm"), 0.05);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->geometry.size.x(), 1165);
  EXPECT_EQ(plan->geometry.size.y(), 945);
  const double free_area =
      static_cast<double>((!plan->occupied).count()) * 0.05 * 0.05;
  EXPECT_GT(free_area, 800.);
  EXPECT_LT(free_area, 2000.);
}

}  // namespace
}  // namespace cartographer_sdf::floor_plan_test
