// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/office.h"

#include "cartographer_sdf/simulation/path_planner.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::office_test {
namespace {

double ReachableArea(const FloorPlan& plan) {
  const NavigationGrid grid = MakeNavigationGrid(plan, 0.4);
  return static_cast<double>(grid.reachable.count()) *
         grid.geometry.resolution * grid.geometry.resolution;
}

TEST(OfficeTest, IsEnclosed) {
  const OfficeOptions options;
  const FloorPlan plan = MakeOffice(options, 42);
  const Eigen::Index width = plan.occupied.rows();
  const Eigen::Index height = plan.occupied.cols();
  EXPECT_EQ(width, 1600);
  EXPECT_EQ(height, 1200);
  EXPECT_TRUE(plan.occupied.row(0).all());
  EXPECT_TRUE(plan.occupied.row(width - 1).all());
  EXPECT_TRUE(plan.occupied.col(0).all());
  EXPECT_TRUE(plan.occupied.col(height - 1).all());
}

TEST(OfficeTest, MostOfItCanBeReached) {
  // Of 1200 m^2, walls with 0.4 m on both sides take about 300 m^2, furniture
  // and locked rooms another 300 m^2.
  for (uint32_t seed = 0; seed != 8; ++seed) {
    const double area = ReachableArea(MakeOffice({}, seed));
    EXPECT_GT(area, 400.) << seed;
    EXPECT_LT(area, 800.) << seed;
  }
}

TEST(OfficeTest, ClosedDoorsLeaveOnlyTheCorridors) {
  OfficeOptions options;
  options.furniture_density = 0.;
  options.closed_doors = 0.;
  const double open = ReachableArea(MakeOffice(options, 42));
  options.closed_doors = 1.;
  const double closed = ReachableArea(MakeOffice(options, 42));
  // Some 115 m of corridor, of which 2.2 m - 0.15 m - 2 * 0.4 m can be driven.
  EXPECT_GT(closed, 90.);
  EXPECT_LT(closed, 180.);
  EXPECT_GT(open, 4. * closed);
}

TEST(OfficeTest, SameSeedSameBuildingOtherSeedOther) {
  const FloorPlan plan = MakeOffice({}, 42);
  EXPECT_TRUE((plan.occupied == MakeOffice({}, 42).occupied).all());
  const FloorPlan other = MakeOffice({}, 43);
  EXPECT_GT((plan.occupied != other.occupied).count(),
            plan.occupied.count() / 4);
}

TEST(OfficeTest, GlassAndOpenTablesStopRobotsAsBefore) {
  const FloorPlan plain = MakeOffice({}, 42);
  EXPECT_EQ(plain.glass.size(), 0);
  EXPECT_EQ(plain.unseen.size(), 0);
  OfficeOptions options;
  options.glass_fronts = 1.;
  options.open_tables = 1.;
  const FloorPlan plan = MakeOffice(options, 42);
  EXPECT_TRUE((plan.occupied == plain.occupied).all());
  EXPECT_TRUE((!plan.glass || plan.occupied).all());
  EXPECT_TRUE((!plan.unseen || plan.occupied).all());
  // Some 92 m of walls outside and 44 m inside of the corridor, less 25 doors
  // of 1.1 m, 0.15 m thick.
  const double cell = options.resolution * options.resolution;
  EXPECT_NEAR(static_cast<double>(plan.glass.count()) * cell, 16.3, 3.);
  EXPECT_GT(static_cast<double>(plan.unseen.count()) * cell, 10.);
  options.glass_fronts = 0.5;
  const double half =
      static_cast<double>(MakeOffice(options, 42).glass.count());
  const double all = static_cast<double>(plan.glass.count());
  EXPECT_GT(half, 0.25 * all);
  EXPECT_LT(half, 0.75 * all);
  options.glass_fronts = 1.5;
  EXPECT_NE(Validate(options), "");
  options = OfficeOptions{};
  options.open_tables = -0.1;
  EXPECT_NE(Validate(options), "");
}

TEST(OfficeTest, EachOptionIsReadAndValidated) {
  EXPECT_EQ(Validate(OfficeOptions{}), "");
  const FloorPlan plan = MakeOffice({}, 42);
  const auto check = [&](double OfficeOptions::*field, double valid,
                         double invalid) {
    OfficeOptions options;
    options.*field = valid;
    EXPECT_EQ(Validate(options), "");
    const FloorPlan other = MakeOffice(options, 42);
    EXPECT_TRUE(other.occupied.rows() != plan.occupied.rows() ||
                other.occupied.cols() != plan.occupied.cols() ||
                (other.occupied != plan.occupied).any());
    options.*field = invalid;
    EXPECT_NE(Validate(options), "");
  };
  check(&OfficeOptions::width, 45., 10.);
  check(&OfficeOptions::height, 35., 1e9);
  check(&OfficeOptions::wall_thickness, 0.2, -1.);
  check(&OfficeOptions::closed_doors, 0.5, 1.1);
  check(&OfficeOptions::furniture_density, 0.3, -0.1);
  check(&OfficeOptions::resolution, 0.05, 0.);
}

}  // namespace
}  // namespace cartographer_sdf::office_test
