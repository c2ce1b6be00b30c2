// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Time of the distance transform and of the field by the number of cells: both
// must be linear.

#include "benchmark/benchmark.h"
#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/field/distance_transform.h"
#include "test/testing/world.h"

namespace cartographer_sdf {
namespace {

using testing::OfficeGrid;

void BM_SquaredDistanceTransform(benchmark::State& state) {
  const OccupancyGrid grid = OfficeGrid(static_cast<int>(state.range(0)));
  const BoolArray walls = grid.known && grid.probability > 0.5f;
  for (auto _ : state) {
    benchmark::DoNotOptimize(SquaredDistanceTransform(walls));
  }
  state.SetComplexityN(walls.size());
}
BENCHMARK(BM_SquaredDistanceTransform)
    ->RangeMultiplier(2)
    ->Range(100, 1600)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

void BM_MakeDistanceField(benchmark::State& state) {
  const OccupancyGrid grid = OfficeGrid(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(MakeDistanceField({}, grid));
  }
  state.SetComplexityN(grid.known.size());
}
BENCHMARK(BM_MakeDistanceField)
    ->RangeMultiplier(2)
    ->Range(100, 1600)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace cartographer_sdf
