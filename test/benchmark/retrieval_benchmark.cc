// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Time to add a submap of 200 features to an index of so many, and to query it.
// Features are random: descriptors without structure, few votes for a pose. On
// real maps the votes cost about as much again (docs/results).

#include <random>

#include "benchmark/benchmark.h"
#include "cartographer_sdf/matching/place_index.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf {
namespace {

constexpr int kNumFeatures = 200;
constexpr int kDescriptorLength = 18;

FeatureSet RandomSubmap(std::mt19937* const engine) {
  return testing::RandomFeatures(kNumFeatures, 20., kDescriptorLength, engine);
}

PlaceIndex FilledIndex(const int num_submaps, std::mt19937* const engine) {
  PlaceIndex index{RetrievalOptions()};
  for (int k = 0; k < num_submaps; ++k) index.Add({0, k}, RandomSubmap(engine));
  return index;
}

void BM_AddAll(benchmark::State& state) {
  std::mt19937 engine(42);
  std::vector<FeatureSet> submaps;
  for (int k = 0; k < state.range(0); ++k) {
    submaps.push_back(RandomSubmap(&engine));
  }
  for (auto _ : state) {
    PlaceIndex index{RetrievalOptions()};
    int k = 0;
    for (const FeatureSet& features : submaps) index.Add({0, k++}, features);
    benchmark::DoNotOptimize(index.Contains({0, 0}));
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BM_AddAll)
    ->RangeMultiplier(4)
    ->Range(16, 1024)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

void BM_Query(benchmark::State& state) {
  std::mt19937 engine(42);
  const PlaceIndex index =
      FilledIndex(static_cast<int>(state.range(0)), &engine);
  const FeatureSet query = RandomSubmap(&engine);
  for (auto _ : state) benchmark::DoNotOptimize(index.Query(query));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BM_Query)
    ->RangeMultiplier(4)
    ->Range(16, 1024)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

void BM_Remove(benchmark::State& state) {
  std::mt19937 engine(42);
  PlaceIndex index = FilledIndex(static_cast<int>(state.range(0)), &engine);
  const FeatureSet features = RandomSubmap(&engine);
  for (auto _ : state) {
    state.PauseTiming();
    index.Add({1, 0}, features);
    state.ResumeTiming();
    benchmark::DoNotOptimize(index.Remove({1, 0}));
  }
}
BENCHMARK(BM_Remove)->Arg(128)->Arg(1024)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cartographer_sdf
