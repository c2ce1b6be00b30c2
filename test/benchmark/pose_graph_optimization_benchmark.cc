// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// From how far and how fast a drive of 2 km with 10000 nodes is optimised, and
// whether it ends at the minimum that a start from the truth ends at:
// `excess_cost` is the final cost as a fraction of that minimum, minus one.

#include <cmath>

#include "benchmark/benchmark.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf {
namespace {

using testing::MakeRoundTrip;
using testing::RoundTrip;
using testing::RoundTripOptions;
using testing::SplitTrajectory;

RoundTripOptions LongDrive() {
  RoundTripOptions options;
  options.translation_noise = 0.003;
  options.yaw_noise = 3e-4;
  return options;
}

void Measure(const PoseGraph& start, PoseGraph from_truth,
             benchmark::State* const state) {
  const double minimum = Optimize({}, {}, &from_truth).final_cost;
  OptimizationSummary summary;
  for (auto _ : *state) {
    PoseGraph graph = start;
    summary = Optimize({}, {}, &graph);
    benchmark::DoNotOptimize(summary);
  }
  state->counters["iterations"] = summary.num_iterations;
  state->counters["excess_cost"] = summary.final_cost / minimum - 1.;
}

// Arguments: yaw drift over the whole drive [degrees], nodes between closures,
// false closures.
void BM_OpenLoop(benchmark::State& state) {
  RoundTripOptions options = LongDrive();
  options.yaw_bias =
      static_cast<double>(state.range(0)) * M_PI / 180. / options.num_nodes;
  options.nodes_between_closures = static_cast<int>(state.range(1));
  options.num_false_closures = static_cast<int>(state.range(2));
  const RoundTrip trip = MakeRoundTrip(options);
  const NodeId last = trip.truth.nodes.rbegin()->first;
  state.counters["metres_off"] =
      (trip.open_loop.nodes.at(last).T_map_node.translation() -
       trip.truth.nodes.at(last).T_map_node.translation())
          .norm();
  Measure(trip.open_loop, trip.truth, &state);
}
BENCHMARK(BM_OpenLoop)
    ->ArgsProduct({{0, 15, 90, 200}, {25, 250, 2000}, {0, 20}})
    ->ArgNames({"degrees", "between", "false"})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

// Arguments: by how much the second round, a trajectory of its own, is turned
// [degrees], nodes between closures, false closures.
void BM_TurnedTrajectory(benchmark::State& state) {
  RoundTripOptions options = LongDrive();
  options.nodes_between_submaps = 50;
  options.nodes_between_closures = static_cast<int>(state.range(1));
  options.num_false_closures = static_cast<int>(state.range(2));
  const RoundTrip trip = MakeRoundTrip(options);
  const Rigid2 T(50., 30., static_cast<double>(state.range(0)) * M_PI / 180.);
  Measure(SplitTrajectory(trip.open_loop, 100, 5000, T),
          SplitTrajectory(trip.truth, 100, 5000, Rigid2()), &state);
}
BENCHMARK(BM_TurnedTrajectory)
    ->ArgsProduct({{0, 90, 175, 180}, {25, 2000}, {0, 10}})
    ->ArgNames({"degrees", "between", "false"})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace cartographer_sdf
