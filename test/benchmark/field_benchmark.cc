// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Time of the distance transform, beside OpenCV's where it was found, and of
// the field: all must be linear in the number of cells. On floors of offices of
// as many cells a side as the argument says, and on the submaps of the maps
// that the environment variable CARTOGRAPHER_SDF_BENCHMARK_MAP names.

#include <map>

#include "benchmark/benchmark.h"
#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/field/distance_transform.h"
#include "test/benchmark/real_submaps.h"
#include "test/testing/world.h"
#ifdef BENCHMARK_OPENCV
#include <opencv2/imgproc.hpp>
#endif

namespace cartographer_sdf {
namespace {

// Made once: drawing a large one takes seconds.
const OccupancyGrid& Office(const int64_t side) {
  static auto& grids = *new std::map<int64_t, OccupancyGrid>();
  const auto known = grids.find(side);
  if (known != grids.end()) return known->second;
  return grids.emplace(side, testing::OfficeGrid(static_cast<int>(side)))
      .first->second;
}

BoolArray Walls(const OccupancyGrid& grid) {
  const int margin = 12;  // as the field's
  BoolArray walls = BoolArray::Constant(grid.known.rows() + 2 * margin,
                                        grid.known.cols() + 2 * margin, false);
  walls.block(margin, margin, grid.known.rows(), grid.known.cols()) =
      grid.known && grid.probability > 0.5f;
  return walls;
}

std::vector<BoolArray> RealWalls() {
  std::vector<BoolArray> walls;
  for (const OccupancyGrid& grid : benchmarks::RealSubmaps()) {
    if ((grid.known && grid.probability > 0.5f).any()) {
      walls.push_back(Walls(grid));
    }
  }
  return walls;
}

void BM_SquaredDistanceTransform(benchmark::State& state) {
  const BoolArray walls = Walls(Office(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(SquaredDistanceTransform(walls));
  }
  state.SetComplexityN(walls.size());
}
BENCHMARK(BM_SquaredDistanceTransform)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(4000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

void BM_SquaredDistanceTransformOfSubmaps(benchmark::State& state) {
  const std::vector<BoolArray> submaps = RealWalls();
  if (submaps.empty()) return state.SkipWithError(benchmarks::kNoRealSubmaps);
  for (auto _ : state) {
    for (const BoolArray& walls : submaps) {
      benchmark::DoNotOptimize(SquaredDistanceTransform(walls));
    }
  }
  benchmarks::CountSubmaps(submaps, &state);
}
BENCHMARK(BM_SquaredDistanceTransformOfSubmaps)->Unit(benchmark::kMillisecond);

#ifdef BENCHMARK_OPENCV
// Columns become OpenCV's rows; zero where the distance is measured to.
cv::Mat Image(const BoolArray& walls) {
  cv::Mat image(static_cast<int>(walls.cols()), static_cast<int>(walls.rows()),
                CV_8U);
  for (int j = 0; j < image.rows; ++j) {
    for (int i = 0; i < image.cols; ++i) {
      image.at<uchar>(j, i) = walls(i, j) ? 0 : 1;
    }
  }
  return image;
}

void TransformByOpenCv(const cv::Mat& image) {
  cv::Mat distances;
  cv::distanceTransform(image, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  benchmark::DoNotOptimize(distances.data);
}

void BM_OpenCvDistanceTransform(benchmark::State& state) {
  cv::setNumThreads(1);
  const cv::Mat image = Image(Walls(Office(state.range(0))));
  for (auto _ : state) TransformByOpenCv(image);
  state.SetComplexityN(static_cast<int64_t>(image.total()));
}
BENCHMARK(BM_OpenCvDistanceTransform)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(4000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

void BM_OpenCvDistanceTransformOfSubmaps(benchmark::State& state) {
  cv::setNumThreads(1);
  const std::vector<BoolArray> submaps = RealWalls();
  if (submaps.empty()) return state.SkipWithError(benchmarks::kNoRealSubmaps);
  std::vector<cv::Mat> images;
  for (const BoolArray& walls : submaps) images.push_back(Image(walls));
  for (auto _ : state) {
    for (const cv::Mat& image : images) TransformByOpenCv(image);
  }
  benchmarks::CountSubmaps(submaps, &state);
}
BENCHMARK(BM_OpenCvDistanceTransformOfSubmaps)->Unit(benchmark::kMillisecond);
#endif

void BM_MakeDistanceField(benchmark::State& state) {
  const OccupancyGrid& grid = Office(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(MakeDistanceField({}, grid));
  }
  state.SetComplexityN(grid.known.size());
}
BENCHMARK(BM_MakeDistanceField)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(4000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

}  // namespace
}  // namespace cartographer_sdf
