// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The submaps of the maps that the environment variable
// CARTOGRAPHER_SDF_BENCHMARK_MAP names; colons stand between several.

#ifndef TEST_BENCHMARK_REAL_SUBMAPS_H_
#define TEST_BENCHMARK_REAL_SUBMAPS_H_

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/benchmark.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf::benchmarks {

constexpr char kNoRealSubmaps[] =
    "CARTOGRAPHER_SDF_BENCHMARK_MAP names no readable map";

// Some thirty at most, evenly spaced; none, with a line that says why, where
// the map is absent.
[[nodiscard]] inline std::vector<OccupancyGrid> SomeSubmaps(
    const std::string& path) {
  std::vector<OccupancyGrid> submaps;
  const auto add = [&submaps](const SubmapId&, const SubmapSummary&,
                              OccupancyGrid grid) {
    submaps.push_back(std::move(grid));
  };
  const absl::StatusOr<MapState> map = ReadMap(path, {add});
  if (!map.ok()) {
    std::cerr << map.status().message() << "\n";
    return {};
  }
  constexpr size_t kMaxNumber = 30;
  const size_t step = submaps.size() / kMaxNumber + 1;
  for (size_t k = 0; k * step < submaps.size(); ++k) {
    std::swap(submaps[k], submaps[k * step]);
  }
  submaps.resize((submaps.size() + step - 1) / step);
  return submaps;
}

// Returns those of all maps that are named.
[[nodiscard]] inline const std::vector<OccupancyGrid>& RealSubmaps() {
  static const auto& submaps = *[] {
    auto* const all = new std::vector<OccupancyGrid>();
    const char* const paths = std::getenv("CARTOGRAPHER_SDF_BENCHMARK_MAP");
    if (paths == nullptr) return all;
    std::istringstream stream(paths);
    for (std::string path; std::getline(stream, path, ':');) {
      for (OccupancyGrid& grid : SomeSubmaps(path)) {
        all->push_back(std::move(grid));
      }
    }
    return all;
  }();
  return submaps;
}

// For benchmarks that treat all submaps in one iteration.
template <typename Cells>
void CountSubmaps(const std::vector<Cells>& submaps,
                  benchmark::State* const state) {
  double num_cells = 0.;
  for (const Cells& cells : submaps) {
    num_cells += static_cast<double>(cells.size());
  }
  const double number = static_cast<double>(submaps.size());
  state->counters["submaps"] = number;
  state->counters["cells"] = num_cells / number;
  state->counters["s/submap"] =
      benchmark::Counter(number, benchmark::Counter::kIsIterationInvariantRate |
                                     benchmark::Counter::kInvert);
}

}  // namespace cartographer_sdf::benchmarks

#endif  // TEST_BENCHMARK_REAL_SUBMAPS_H_
