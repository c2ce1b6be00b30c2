// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Time to fill the index of places, to ask it and to empty it, and its memory,
// by the number of submaps. The submaps are recombined (recombined_submaps.h)
// from those of the maps that the environment variable
// CARTOGRAPHER_SDF_BENCHMARK_MAP names.

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "benchmark/benchmark.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/place.h"
#include "test/benchmark/real_submaps.h"
#include "test/benchmark/recombined_submaps.h"

namespace cartographer_sdf::benchmarks {
namespace {

constexpr int kNumQueries = 64;

// Made of the submaps of real maps, where there are any.
const RecombinedSubmaps& Submaps() {
  static const auto& submaps = *[] {
    std::vector<std::vector<Feature>> real;
    for (const OccupancyGrid& grid : RealSubmaps()) {
      std::optional<Place> place = DescribePlace({}, {}, grid);
      if (place) real.push_back(std::move(place->features.features));
    }
    return new RecombinedSubmaps(std::move(real));
  }();
  return submaps;
}

// Seconds of work that are measured, without those of making submaps.
class Stopwatch {
 public:
  template <typename Work>
  void Time(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    seconds_ +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
            .count();
  }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  double seconds_ = 0.;
};

// Returns the seconds that adding takes.
double AddAll(const int num_submaps, PlaceIndex* const index) {
  Stopwatch stopwatch;
  for (int k = 0; k < num_submaps; ++k) {
    const FeatureSet features = Submaps().Make(k);
    stopwatch.Time([&] { index->Add({0, k}, features); });
  }
  return stopwatch.seconds();
}

// The index of that many submaps. The one of another number is forgotten.
const PlaceIndex& IndexOf(const int num_submaps) {
  static std::unique_ptr<PlaceIndex> index;
  if (!index || index->size() != static_cast<size_t>(num_submaps)) {
    index = std::make_unique<PlaceIndex>(RetrievalOptions());
    AddAll(num_submaps, index.get());
  }
  return *index;
}

// The time is that of adding.
void BM_FillAndEmpty(benchmark::State& state) {
  const auto num_submaps = static_cast<int>(state.range(0));
  double bytes = 0.;
  double seconds_to_add = 0.;
  Stopwatch removing;
  for (auto _ : state) {
    PlaceIndex index{RetrievalOptions()};
    const double seconds = AddAll(num_submaps, &index);
    state.SetIterationTime(seconds);
    seconds_to_add += seconds;
    bytes = static_cast<double>(index.MemoryUse());
    removing.Time([&index, num_submaps] {
      for (int k = 0; k < num_submaps; ++k) index.Remove({0, k});
    });
  }
  state.SetComplexityN(num_submaps);
  const double num_treated =
      static_cast<double>(state.iterations()) * num_submaps;
  state.counters["us/add"] = 1e6 * seconds_to_add / num_treated;
  state.counters["us/remove"] = 1e6 * removing.seconds() / num_treated;
  state.counters["bytes/submap"] = bytes / num_submaps;
}
BENCHMARK(BM_FillAndEmpty)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Complexity();

// Of submaps that are in the index, seen another time. `found`: the fraction of
// them that is the best candidate.
void BM_Query(benchmark::State& state) {
  const auto num_submaps = static_cast<int>(state.range(0));
  const PlaceIndex& index = IndexOf(num_submaps);
  std::vector<SubmapId> ids;
  std::vector<FeatureSet> queries;
  double num_found = 0.;
  double num_features = 0.;
  for (int k = 0; k < kNumQueries; ++k) {
    ids.push_back({0, k * (num_submaps / kNumQueries)});
    queries.push_back(Submaps().SeeAgain(ids.back().index));
    const std::vector<RetrievalCandidate> best =
        index.QueryBest(queries.back(), 1);
    if (!best.empty() && best[0].id == ids.back()) ++num_found;
    num_features += static_cast<double>(queries.back().features.size());
  }
  size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(index.Query(queries[k++ % queries.size()]));
  }
  state.SetComplexityN(num_submaps);
  state.counters["found"] = num_found / kNumQueries;
  state.counters["features"] = num_features / kNumQueries;
}
BENCHMARK(BM_Query)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace cartographer_sdf::benchmarks
