// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Time that describing a submap of 800 x 800 cells takes, stage by stage.

#include "benchmark/benchmark.h"
#include "cartographer_sdf/place/place.h"
#include "test/testing/world.h"

namespace cartographer_sdf {
namespace {

const OccupancyGrid& Submap() {
  static const auto& grid = *new OccupancyGrid(testing::OfficeGrid(800));
  return grid;
}

void BM_MakeDistanceField(benchmark::State& state) {
  (void)Submap();
  for (auto _ : state) {
    benchmark::DoNotOptimize(MakeDistanceField({}, Submap()));
  }
}
BENCHMARK(BM_MakeDistanceField)->Unit(benchmark::kMillisecond);

void BM_MakeSurfaceModel(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(MakeSurfaceModel({}, Submap()));
  }
}
BENCHMARK(BM_MakeSurfaceModel)->Unit(benchmark::kMillisecond);

void BM_SmoothField(benchmark::State& state) {
  const DistanceField field = *MakeDistanceField({}, Submap());
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        SmoothField(field, KeypointOptions().smoothing_sigma_cells));
  }
}
BENCHMARK(BM_SmoothField)->Unit(benchmark::kMillisecond);

void BM_DetectKeypoints(benchmark::State& state) {
  const DistanceField field = *MakeDistanceField({}, Submap());
  const Eigen::ArrayXXf smoothed =
      SmoothField(field, KeypointOptions().smoothing_sigma_cells);
  for (auto _ : state) {
    benchmark::DoNotOptimize(DetectKeypoints({}, field, smoothed));
  }
}
BENCHMARK(BM_DetectKeypoints)->Unit(benchmark::kMillisecond);

void BM_DescribeKeypoints(benchmark::State& state) {
  const DistanceField field = *MakeDistanceField({}, Submap());
  const Eigen::ArrayXXf smoothed =
      SmoothField(field, KeypointOptions().smoothing_sigma_cells);
  const std::vector<Keypoint> keypoints = DetectKeypoints({}, field, smoothed);
  for (auto _ : state) {
    benchmark::DoNotOptimize(DescribeKeypoints({}, field, smoothed, keypoints));
  }
  state.counters["keypoints"] = static_cast<double>(keypoints.size());
}
BENCHMARK(BM_DescribeKeypoints)->Unit(benchmark::kMillisecond);

void BM_DescribePlace(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(DescribePlace({}, {}, Submap()));
  }
}
BENCHMARK(BM_DescribePlace)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cartographer_sdf
