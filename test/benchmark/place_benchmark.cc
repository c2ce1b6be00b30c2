// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Time that describing a submap of 800 x 800 cells takes, stage by stage; and
// from grid to descriptors by the number of cells, which must be linear, and on
// the submaps of the maps that the environment variable
// CARTOGRAPHER_SDF_BENCHMARK_MAP names.

#include "benchmark/benchmark.h"
#include "cartographer_sdf/place/place.h"
#include "test/benchmark/real_submaps.h"
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

// All but the surface model, as in DescribePlace.
FeatureSet GridToDescriptors(const OccupancyGrid& grid) {
  const PlaceOptions options;
  const std::optional<DistanceField> field =
      MakeDistanceField(options.field, grid);
  if (!field) return {};
  const Eigen::ArrayXXf smoothed = SmoothFieldForPlace(options, *field);
  return DescribeKeypoints(options.descriptor, *field, smoothed,
                           DetectKeypoints(options.keypoint, *field, smoothed));
}

void BM_GridToDescriptors(benchmark::State& state) {
  const OccupancyGrid grid =
      testing::OfficeGrid(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(GridToDescriptors(grid));
  state.SetComplexityN(grid.known.size());
}
BENCHMARK(BM_GridToDescriptors)
    ->RangeMultiplier(2)
    ->Range(200, 1600)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

void BM_GridToDescriptorsOfSubmaps(benchmark::State& state) {
  const std::vector<OccupancyGrid>& submaps = benchmarks::RealSubmaps();
  if (submaps.empty()) return state.SkipWithError(benchmarks::kNoRealSubmaps);
  for (auto _ : state) {
    for (const OccupancyGrid& grid : submaps) {
      benchmark::DoNotOptimize(GridToDescriptors(grid));
    }
  }
  std::vector<BoolArray> cells;
  for (const OccupancyGrid& grid : submaps) cells.push_back(grid.known);
  benchmarks::CountSubmaps(cells, &state);
}
BENCHMARK(BM_GridToDescriptorsOfSubmaps)->Unit(benchmark::kMillisecond);

void BM_DescribePlace(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(DescribePlace({}, {}, Submap()));
  }
}
BENCHMARK(BM_DescribePlace)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cartographer_sdf
