// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/feature/keypoint.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/ascii_grid.h"
#include "test/testing/random_number.h"
#include "test/testing/world.h"

namespace cartographer_sdf::keypoint_test {
namespace {

using testing::CentredGeometry;
using testing::Furnished;
using testing::Joined;
using testing::Moved;
using testing::Rasterise;
using testing::Room;
using testing::SolidBox;
using testing::SolidDisc;
using testing::Uniform;
using testing::World;

constexpr double kResolution = 0.05;
constexpr double kHalfCell = 0.5 * kResolution;

DistanceField FieldOf(const OccupancyGrid& grid) {
  std::optional<DistanceField> field = MakeDistanceField({}, grid);
  EXPECT_TRUE(field.has_value());
  return *std::move(field);
}

// A field that is given by its values in cells.
DistanceField FieldOf(const Eigen::ArrayXXf& cells) {
  DistanceField field;
  field.geometry.resolution = kResolution;
  field.geometry.size = {static_cast<int>(cells.rows()),
                         static_cast<int>(cells.cols())};
  field.distance = static_cast<float>(kResolution) * cells;
  field.observed = BoolArray::Constant(cells.rows(), cells.cols(), true);
  return field;
}

std::vector<Keypoint> Detect(const DistanceField& field,
                             const KeypointOptions& options = {}) {
  return DetectKeypoints(options, field,
                         SmoothField(field, options.smoothing_sigma_cells));
}

std::vector<Keypoint> DetectIn(const World& world, const double angle = 0.) {
  return Detect(
      FieldOf(Rasterise(world, CentredGeometry(130), Rigid2(0., 0., angle))));
}

std::vector<Keypoint> OfKind(const std::vector<Keypoint>& keypoints,
                             const KeypointKind kind) {
  std::vector<Keypoint> result;
  for (const Keypoint& keypoint : keypoints) {
    if (keypoint.kind == kind) result.push_back(keypoint);
  }
  return result;
}

// How many keypoints of that kind lie within the box around a point.
int CountNear(const std::vector<Keypoint>& keypoints, const KeypointKind kind,
              const Eigen::Vector2d& place, const Eigen::Vector2d& tolerance) {
  int count = 0;
  for (const Keypoint& keypoint : OfKind(keypoints, kind)) {
    const Eigen::Array2d apart = (keypoint.position - place).array().abs();
    count += (apart <= tolerance.array()).all();
  }
  return count;
}

int CountNear(const std::vector<Keypoint>& keypoints, const KeypointKind kind,
              const Eigen::Vector2d& place, const double tolerance) {
  return CountNear(keypoints, kind, place,
                   Eigen::Vector2d::Constant(tolerance));
}

// --- Smoothing.
// ---------------------------------------------------------------

Eigen::ArrayXXf RandomArray(const int rows, const int cols) {
  std::mt19937 engine(42);
  Eigen::ArrayXXf values(rows, cols);
  for (float& value : values.reshaped()) {
    value = static_cast<float>(Uniform(-3., 30., &engine));
  }
  return values;
}

// Directly in two dimensions, in double precision.
Eigen::ArrayXXd BruteForceSmoothing(const Eigen::ArrayXXf& values,
                                    const double sigma) {
  const int radius = static_cast<int>(std::ceil(3. * sigma));
  const int rows = static_cast<int>(values.rows());
  const int cols = static_cast<int>(values.cols());
  Eigen::ArrayXXd smoothed(rows, cols);
  for (int j = 0; j < cols; ++j) {
    for (int i = 0; i < rows; ++i) {
      double sum = 0., total = 0.;
      for (int b = -radius; b <= radius; ++b) {
        for (int a = -radius; a <= radius; ++a) {
          const double weight =
              std::exp(-0.5 * (a * a + b * b) / (sigma * sigma));
          total += weight;
          sum += weight * values(std::clamp(i + a, 0, rows - 1),
                                 std::clamp(j + b, 0, cols - 1));
        }
      }
      smoothed(i, j) = sum / total;
    }
  }
  return smoothed;
}

TEST(SmoothFieldTest, EqualsBruteForce) {
  const std::pair<int, int> shapes[] = {
      {1, 1}, {1, 9}, {9, 1}, {3, 4}, {40, 25}};
  for (const auto& [rows, cols] : shapes) {
    for (const double sigma : {0.3, 1., 3., 5.5}) {
      const Eigen::ArrayXXf values = RandomArray(rows, cols);
      const Eigen::ArrayXXf smoothed = SmoothField(FieldOf(values), sigma);
      // Single precision of values up to 30.
      EXPECT_LT((smoothed.cast<double>() - BruteForceSmoothing(values, sigma))
                    .abs()
                    .maxCoeff(),
                1e-4);
    }
  }
}

TEST(SmoothFieldTest, IsTheSameNearObservedCells) {
  DistanceField field = FieldOf(RandomArray(150, 90));
  field.observed.setConstant(false);
  field.observed(0, 20) = field.observed(70, 50) = field.observed(149, 89) =
      true;
  const Eigen::ArrayXXf smoothed = SmoothField(field, 2.);
  for (const int reach : {0, 3, 25}) {
    const Eigen::ArrayXXf near = SmoothFieldNearObserved(field, 2., reach);
    for (const Eigen::Array2i& cell :
         {Eigen::Array2i(0, 20), Eigen::Array2i(70, 50),
          Eigen::Array2i(149, 89)}) {
      for (int j = std::max(cell.y() - reach, 0);
           j <= std::min(cell.y() + reach, 89); ++j) {
        for (int i = std::max(cell.x() - reach, 0);
             i <= std::min(cell.x() + reach, 149); ++i) {
          ASSERT_EQ(near(i, j), smoothed(i, j)) << i << ", " << j;
        }
      }
    }
  }
}

TEST(SmoothFieldTest, PreservesLinearFunctionsAwayFromTheRim) {
  Eigen::ArrayXXf linear(40, 50);
  for (int j = 0; j < 50; ++j) {
    for (int i = 0; i < 40; ++i) {
      linear(i, j) =
          7.f + 0.5f * static_cast<float>(i) - 0.25f * static_cast<float>(j);
    }
  }
  const Eigen::ArrayXXf smoothed = SmoothField(FieldOf(linear), 3.);
  EXPECT_LT((smoothed - linear).block(9, 9, 22, 32).abs().maxCoeff(), 1e-4f);
  const Eigen::ArrayXXf constant = Eigen::ArrayXXf::Constant(20, 10, 4.f);
  EXPECT_LT((SmoothField(FieldOf(constant), 3.) - constant).abs().maxCoeff(),
            1e-5f);
}

// --- The definition, cell by cell.
// --------------------------------------------

Eigen::Matrix2d SobelHessian(const Eigen::ArrayXXf& f, const int i,
                             const int j) {
  const double smooth[] = {1., 2., 1.}, first[] = {-1., 0., 1.},
               second[] = {1., -2., 1.};
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  for (int b = 0; b < 3; ++b) {
    for (int a = 0; a < 3; ++a) {
      const double value = f(i + a - 1, j + b - 1);
      hessian(0, 0) += 0.25 * second[a] * smooth[b] * value;
      hessian(1, 1) += 0.25 * smooth[a] * second[b] * value;
      hessian(0, 1) += 0.25 * first[a] * first[b] * value;
    }
  }
  hessian(1, 0) = hessian(0, 1);
  return hessian;
}

bool MeetsUnobserved(const DistanceField& field, const int i, const int j,
                     const double radius) {
  const auto free = [&field](const int a, const int b) {
    return field.observed(a, b) && field.distance(a, b) > 0.f;
  };
  for (int b = 1; b + 1 < field.observed.cols(); ++b) {
    for (int a = 1; a + 1 < field.observed.rows(); ++a) {
      if (!field.observed(a, b) && std::hypot(a - i, b - j) <= radius &&
          (free(a - 1, b) || free(a + 1, b) || free(a, b - 1) ||
           free(a, b + 1))) {
        return true;
      }
    }
  }
  return false;
}

struct CellKeypoint {
  int i, j;
  KeypointKind kind;
  double strength;
};

std::vector<CellKeypoint> BruteForceKeypoints(const KeypointOptions& options,
                                              const DistanceField& field,
                                              const Eigen::ArrayXXf& smoothed) {
  const int rows = static_cast<int>(smoothed.rows());
  const int cols = static_cast<int>(smoothed.cols());
  const int reach = options.non_maximum_suppression_cells;
  Eigen::ArrayXXd magnitude = Eigen::ArrayXXd::Zero(rows, cols);
  for (int j = 1; j + 1 < cols; ++j) {
    for (int i = 1; i + 1 < rows; ++i) {
      magnitude(i, j) = std::abs(SobelHessian(smoothed, i, j).determinant());
    }
  }
  std::vector<CellKeypoint> keypoints;
  for (int j = reach; j + reach < cols; ++j) {
    for (int i = reach; i + reach < rows; ++i) {
      const double value = magnitude(i, j);
      const auto around =
          magnitude.block(i - reach, j - reach, 2 * reach + 1, 2 * reach + 1);
      if (value <= options.detection_threshold || !field.observed(i, j) ||
          value < around.maxCoeff() ||
          MeetsUnobserved(field, i, j, options.unobserved_border_cells)) {
        continue;
      }
      const Eigen::Vector2d eigenvalues =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
              SobelHessian(smoothed, i, j))
              .eigenvalues();
      keypoints.push_back({i, j,
                           eigenvalues[1] < 0.   ? KeypointKind::kMaximum
                           : eigenvalues[0] > 0. ? KeypointKind::kMinimum
                                                 : KeypointKind::kSaddle,
                           value});
    }
  }
  return keypoints;
}

void ExpectAsBruteForce(const KeypointOptions& options,
                        const DistanceField& field, const int least_number) {
  const Eigen::ArrayXXf smoothed =
      SmoothField(field, options.smoothing_sigma_cells);
  const std::vector<CellKeypoint> expected =
      BruteForceKeypoints(options, field, smoothed);
  const std::vector<Keypoint> actual =
      DetectKeypoints(options, field, smoothed);
  EXPECT_GE(static_cast<int>(expected.size()), least_number);
  ASSERT_EQ(actual.size(), expected.size());
  const Rigid2 T_grid_submap = field.geometry.T_submap_grid.Inverse();
  for (size_t k = 0; k < expected.size(); ++k) {
    const Eigen::Vector2d p_grid = T_grid_submap * actual[k].position;
    const Eigen::Array2d off = field.geometry.GridToCells(p_grid).array() -
                               Eigen::Array2d(expected[k].i, expected[k].j);
    EXPECT_LE(off.abs().maxCoeff(), 0.5 + 1e-9);
    EXPECT_EQ(actual[k].kind, expected[k].kind);
    // Second differences of values up to 60 in single precision.
    EXPECT_NEAR(actual[k].strength, expected[k].strength, 1e-5);
    EXPECT_NEAR(actual[k].clearance, SampleField(field, p_grid)->distance,
                1e-9);
  }
}

TEST(DetectKeypointsTest, EqualsBruteForceOnAFloor) {
  OccupancyGrid grid = Rasterise(testing::OfficeFloor(1, 1),
                                 CentredGeometry(90), Rigid2(0., 0., 0.4));
  // A part that the lidar did not reach.
  grid.known.block(20, 55, 20, 15) = false;
  for (const double border : {0., 1.5, 6.}) {
    KeypointOptions options;
    options.unobserved_border_cells = border;
    ExpectAsBruteForce(options, FieldOf(grid), 10);
  }
}

TEST(DetectKeypointsTest, EqualsBruteForceOnNoise) {
  KeypointOptions options;
  options.smoothing_sigma_cells = 2.;
  for (const int reach : {1, 2, 7}) {
    options.non_maximum_suppression_cells = reach;
    ExpectAsBruteForce(options, FieldOf(RandomArray(70, 40)), 5);
  }
}

// --- What is found where.
// -----------------------------------------------------

// Two walls of 0.2 m that meet have their middle line, where the field is
// lowest, within this of the corner in either direction.
constexpr double kWall = 0.2;
// Smoothing moves what is not symmetric by some fraction of its reach.
constexpr double kReach = 3. * 3. * kResolution;

TEST(DetectKeypointsTest, TheCentreOfARoomIsAMaximumItsCornersAreMinima) {
  const World room = Room({0.11, -0.23}, {3., 3.});
  for (const double angle : {0., 0.2, 0.5, M_PI / 4., 2.}) {
    std::vector<Keypoint> keypoints = DetectIn(room, angle);
    for (Keypoint& keypoint : keypoints) {
      keypoint.position = Rigid2(0., 0., angle) * keypoint.position;
    }
    EXPECT_EQ(OfKind(keypoints, KeypointKind::kMaximum).size(), 1u);
    EXPECT_EQ(
        CountNear(keypoints, KeypointKind::kMaximum, {0.11, -0.23}, kHalfCell),
        1)
        << angle;
    EXPECT_EQ(OfKind(keypoints, KeypointKind::kMinimum).size(), 4u);
    for (const double x : {-1.5, 1.5}) {
      for (const double y : {-1.5, 1.5}) {
        EXPECT_EQ(CountNear(keypoints, KeypointKind::kMinimum,
                            {x + 0.11, y - 0.23}, kWall + kHalfCell),
                  1);
      }
    }
  }
}

TEST(DetectKeypointsTest, ClearanceIsTheDistanceToTheWalls) {
  for (const Keypoint& keypoint : DetectIn(Room({0., 0.}, {3., 3.}))) {
    if (keypoint.kind != KeypointKind::kMaximum) continue;
    // Between the four middle cells, half a cell from each.
    EXPECT_NEAR(keypoint.clearance, 1.5 - kHalfCell, 1e-6);
  }
}

TEST(DetectKeypointsTest, ACrossingIsAMaximumBetweenFourSaddles) {
  const World corridor = testing::Corridor(1.5);
  const std::vector<Keypoint> keypoints =
      DetectIn(Joined({corridor, Moved(Rigid2(0., 0., M_PI_2), corridor)}));
  EXPECT_EQ(OfKind(keypoints, KeypointKind::kMaximum).size(), 1u);
  EXPECT_EQ(CountNear(keypoints, KeypointKind::kMaximum, {0., 0.}, kHalfCell),
            1);
  EXPECT_EQ(OfKind(keypoints, KeypointKind::kSaddle).size(), 4u);
  for (const double side : {-0.75, 0.75}) {
    // Where the corridors begin, on their axes.
    EXPECT_EQ(CountNear(keypoints, KeypointKind::kSaddle, {side, 0.},
                        {kReach, kHalfCell}),
              1);
    EXPECT_EQ(CountNear(keypoints, KeypointKind::kSaddle, {0., side},
                        {kHalfCell, kReach}),
              1);
    for (const double other : {-0.75, 0.75}) {
      EXPECT_EQ(
          CountNear(keypoints, KeypointKind::kMinimum, {side, other}, kWall),
          1);
    }
  }
}

TEST(DetectKeypointsTest, ACorridorHasNoKeypointsAlongIt) {
  for (const Keypoint& keypoint : DetectIn(testing::Corridor(2.))) {
    EXPECT_EQ(keypoint.kind, KeypointKind::kMinimum);
    EXPECT_GT(std::abs(keypoint.position.x()), 3.);
  }
}

TEST(DetectKeypointsTest, ADoorwayHasASaddleOnEitherSide) {
  const std::vector<Keypoint> keypoints =
      DetectIn(Joined({Room({-1.1, 0.}, {2., 4.}), Room({1.1, 0.}, {2., 4.}),
                       Room({0., 0.3}, {0.5, 1.})}));
  for (const double side : {-0.1, 0.1}) {
    EXPECT_EQ(CountNear(keypoints, KeypointKind::kSaddle, {side, 0.3},
                        {0.1, kHalfCell}),
              1);
  }
  for (const double jamb : {-0.2 - 0.05, 0.8 + 0.05}) {
    EXPECT_EQ(CountNear(keypoints, KeypointKind::kMinimum, {0., jamb}, 0.05),
              1);
  }
}

TEST(DetectKeypointsTest, PillarsAndCornersOfFurnitureAreMinima) {
  const std::vector<Keypoint> keypoints =
      DetectIn(Furnished({Room({0., 0.}, {5., 5.}), SolidDisc({1.2, 1.3}, 0.15),
                          SolidBox({-0.8, -0.6}, {1., 0.6}, 0.4)}));
  EXPECT_EQ(CountNear(keypoints, KeypointKind::kMinimum, {1.2, 1.3}, kHalfCell),
            1);
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.3, 0.3}) {
      EXPECT_EQ(
          CountNear(keypoints, KeypointKind::kMinimum,
                    Rigid2(-0.8, -0.6, 0.4) * Eigen::Vector2d(x, y), kWall),
          1);
    }
  }
}

TEST(DetectKeypointsTest, AHigherThresholdLeavesTheStrongerOnes) {
  const DistanceField field = FieldOf(testing::OfficeGrid(200));
  const std::vector<Keypoint> all = Detect(field);
  KeypointOptions options;
  options.detection_threshold = 0.02;
  const std::vector<Keypoint> strong = Detect(field, options);
  size_t expected = 0;
  for (const Keypoint& keypoint : all) expected += keypoint.strength > 0.02;
  EXPECT_EQ(strong.size(), expected);
  EXPECT_GT(strong.size(), 0u);
  EXPECT_LT(strong.size(), all.size());
  for (const Keypoint& keypoint : strong) EXPECT_GT(keypoint.strength, 0.02);
}

TEST(DetectKeypointsTest, KeypointsFarFromWallsCanBeLeftOut) {
  const DistanceField field = FieldOf(testing::OfficeGrid(200));
  const std::vector<Keypoint> all = Detect(field);
  KeypointOptions options;
  size_t last = all.size();
  for (const double clearance : {1., 0.5, 0.2}) {
    options.max_clearance_meters = clearance;
    const std::vector<Keypoint> near = Detect(field, options);
    size_t expected = 0;
    for (const Keypoint& keypoint : all) {
      expected += std::abs(keypoint.clearance) <= clearance;
    }
    EXPECT_EQ(near.size(), expected);
    EXPECT_LT(near.size(), last);
    EXPECT_GT(near.size(), 0u);
    last = near.size();
  }
}

TEST(DetectKeypointsTest, NoneWhereFreeSpaceMeetsTheUnobserved) {
  // A room of which only a part is seen.
  OccupancyGrid grid =
      Rasterise(Room({0., 0.}, {3., 3.}), CentredGeometry(100));
  const auto centre_and_corners = [](const std::vector<Keypoint>& keypoints) {
    return std::make_pair(
        CountNear(keypoints, KeypointKind::kMaximum, {0., 0.}, kHalfCell),
        OfKind(keypoints, KeypointKind::kMinimum).size());
  };
  KeypointOptions options;
  options.unobserved_border_cells = 4.;
  EXPECT_EQ(centre_and_corners(Detect(FieldOf(grid), options)),
            std::make_pair(1, size_t{4}));
  // The centre is cell 49 or 50: five cells away is allowed, three are not.
  grid.known.block(55, 30, 3, 40) = false;
  EXPECT_EQ(centre_and_corners(Detect(FieldOf(grid), options)),
            std::make_pair(1, size_t{4}));
  grid.known.block(53, 30, 3, 40) = false;
  EXPECT_EQ(centre_and_corners(Detect(FieldOf(grid), options)),
            std::make_pair(0, size_t{4}));
  options.unobserved_border_cells = 1.;
  EXPECT_EQ(centre_and_corners(Detect(FieldOf(grid), options)),
            std::make_pair(1, size_t{4}));
}

TEST(DetectKeypointsTest, FollowsTheWorldByFractionsOfACell) {
  // Neither is along the cells, so that a shift changes the raster gradually;
  // each cell is still one or the other, for walls of some twenty cells.
  constexpr double kTolerance = 0.4 * kResolution;
  const World world =
      Furnished({Moved(Rigid2(0., 0., 0.5), Room({0., 0.}, {3., 3.}))});
  double squared_error = 0.;
  for (int step = 0; step < 20; ++step) {
    const Eigen::Vector2d shift =
        kResolution * Eigen::Vector2d(0.05 * step, 0.35 * step);
    const std::vector<Keypoint> maxima = OfKind(
        DetectIn(Moved(Rigid2(shift, 0.), world)), KeypointKind::kMaximum);
    ASSERT_EQ(maxima.size(), 1u);
    const Eigen::Vector2d error = maxima[0].position - shift;
    EXPECT_LE(error.cwiseAbs().maxCoeff(), kTolerance) << step;
    squared_error += error.squaredNorm() / 20.;
  }
  // A cell's own rounding would be sqrt(1 / 6) = 0.41.
  EXPECT_LE(std::sqrt(squared_error), 0.25 * kResolution);
}

TEST(DetectKeypointsTest, MovesWithTheSubmapAndRepeatsItself) {
  OccupancyGrid grid = testing::OfficeGrid(200);
  const std::vector<Keypoint> first = Detect(FieldOf(grid));
  const Rigid2 T_new_old(3., -4., 2.5);
  grid.geometry.T_submap_grid = T_new_old * grid.geometry.T_submap_grid;
  const std::vector<Keypoint> second = Detect(FieldOf(grid));
  ASSERT_EQ(first.size(), second.size());
  ASSERT_GT(first.size(), 0u);
  for (size_t k = 0; k < first.size(); ++k) {
    EXPECT_LT((T_new_old * first[k].position - second[k].position).norm(),
              1e-9);
    EXPECT_EQ(first[k].kind, second[k].kind);
    EXPECT_EQ(first[k].strength, second[k].strength);
    EXPECT_NEAR(first[k].clearance, second[k].clearance, 1e-9);
  }
}

TEST(DetectKeypointsTest, NoneInTinyOrFlatFields) {
  for (const int rows : {1, 2, 3, 8, 9}) {
    for (const int cols : {1, 3, 9, 30}) {
      EXPECT_TRUE(
          Detect(FieldOf(Eigen::ArrayXXf::Constant(rows, cols, 1.f))).empty());
    }
  }
  EXPECT_TRUE(Detect(FieldOf(Eigen::ArrayXXf(0, 0))).empty());
  EXPECT_NO_FATAL_FAILURE((void)Detect(FieldOf(testing::AsciiGrid({"#"}))));
  EXPECT_NO_FATAL_FAILURE(
      (void)Detect(FieldOf(testing::AsciiGrid({".#.", "...", "#.."}))));
}

TEST(DetectKeypointsTest, NoneWhereNothingIsObserved) {
  DistanceField field = FieldOf(testing::OfficeGrid(150));
  ASSERT_FALSE(Detect(field).empty());
  field.observed = false;
  EXPECT_TRUE(Detect(field).empty());
}

TEST(KeypointOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(KeypointOptions()), "");
  const auto error = [](const auto member, const auto value) {
    KeypointOptions options;
    options.*member = value;
    return Validate(options);
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(error(&KeypointOptions::smoothing_sigma_cells, 0.),
              HasSubstr("smoothing_sigma_cells"));
  EXPECT_THAT(error(&KeypointOptions::detection_threshold, std::nan("")),
              HasSubstr("detection_threshold"));
  EXPECT_THAT(error(&KeypointOptions::non_maximum_suppression_cells, 0),
              HasSubstr("non_maximum_suppression_cells"));
  EXPECT_THAT(error(&KeypointOptions::unobserved_border_cells, -1.),
              HasSubstr("unobserved_border_cells"));
  EXPECT_THAT(error(&KeypointOptions::max_clearance_meters, 0.),
              HasSubstr("max_clearance_meters"));
}

}  // namespace
}  // namespace cartographer_sdf::keypoint_test
