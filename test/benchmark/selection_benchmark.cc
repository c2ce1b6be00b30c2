// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How the time to select consistent closures grows with their number: along
// drives that become longer, and in a room whose submaps become more.

#include <map>
#include <vector>

#include "benchmark/benchmark.h"
#include "cartographer_sdf/closing/consistency.h"

namespace cartographer_sdf {
namespace {

// Submaps every `spacing` metres along a straight line.
std::map<SubmapId, OdometryPose> Line(const int num_submaps,
                                      const double spacing) {
  std::map<SubmapId, OdometryPose> odometry;
  for (int i = 0; i < num_submaps; ++i) {
    odometry[{0, i}] = {Rigid2(spacing * i, 0., 0.), spacing * i};
  }
  return odometry;
}

// True, but every fifth.
PairPose Closure(const int reference, const int query, const double spacing,
                 const int number) {
  const double error = number % 5 == 0 ? 7. : 0.05;
  return {{0, reference},
          {0, query},
          Rigid2(spacing * (query - reference) + error, 0., 0.),
          5. + number % 7};
}

// The second half of a drive repeats the first, five closures to a submap.
void BM_SelectAlongADrive(benchmark::State& state) {
  const int half = static_cast<int>(state.range(0)) / 5;
  const auto odometry = Line(2 * half + 5, 5.);
  std::vector<PairPose> closures;
  for (int i = 0; i < half; ++i) {
    for (int k = 0; k < 5; ++k) {
      closures.push_back(
          Closure(i, i + half + k, 5., static_cast<int>(closures.size())));
    }
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(SelectConsistent({}, odometry, closures));
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BM_SelectAlongADrive)
    ->RangeMultiplier(4)
    ->Range(320, 20480)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

// All pairs of the submaps of one room, all within reach of each other.
void BM_SelectInARoom(benchmark::State& state) {
  const int num_submaps = static_cast<int>(state.range(0));
  const auto odometry = Line(num_submaps, 0.1);
  std::vector<PairPose> closures;
  for (int i = 0; i < num_submaps; ++i) {
    for (int k = 0; k < i; ++k) {
      closures.push_back(Closure(k, i, 0.1, static_cast<int>(closures.size())));
    }
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(SelectConsistent({}, odometry, closures));
  }
  state.SetComplexityN(static_cast<int64_t>(closures.size()));
  state.counters["closures"] = static_cast<double>(closures.size());
}
BENCHMARK(BM_SelectInARoom)
    ->RangeMultiplier(2)
    ->Range(16, 128)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace cartographer_sdf
