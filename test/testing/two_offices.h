// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Three simulated maps with their truth: two sessions in one office, and one in
// another.

#ifndef TEST_TESTING_TWO_OFFICES_H_
#define TEST_TESTING_TWO_OFFICES_H_

#include <cstdint>
#include <string>

#include "cartographer_sdf/evaluation/truth.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/simulation/office.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "cartographer_sdf/tools/parallel_for.h"
#include "glog/logging.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::testing {

inline Executor ThreadExecutor(const int num_threads) {
  return
      [num_threads](const size_t n, const std::function<void(size_t)>& task) {
        ParallelFor(static_cast<int>(n), num_threads,
                    [&task](const int i) { task(static_cast<size_t>(i)); });
      };
}

class TwoOffices {
 public:
  TwoOffices() {
    Write(Morning(), /*plan_seed=*/1, /*drive_seed=*/1);
    Write(Evening(), /*plan_seed=*/1, /*drive_seed=*/2);
    Write(Elsewhere(), /*plan_seed=*/5, /*drive_seed=*/3);
  }

  [[nodiscard]] std::string Morning() const { return File("morning.pbstream"); }
  [[nodiscard]] std::string Evening() const { return File("evening.pbstream"); }
  [[nodiscard]] std::string Elsewhere() const {
    return File("elsewhere.pbstream");
  }
  [[nodiscard]] std::string File(const std::string& name) const {
    return directory_.File(name);
  }
  [[nodiscard]] std::string Read(const std::string& name) const {
    return directory_.Read(name);
  }
  [[nodiscard]] Truth TruthOf(const std::string& map) const {
    absl::StatusOr<Truth> truth = ReadTruth(map + ".truth.csv");
    CHECK(truth.ok()) << truth.status();
    return *std::move(truth);
  }
  // How far a closure of two maps is from the truth.
  [[nodiscard]] Rigid2 ErrorOf(const LoopClosure& closure,
                               const std::string& reference_map,
                               const std::string& query_map) const {
    const Rigid2 T_reference_query =
        TruthOf(reference_map).T_world_submap.at(closure.reference).Inverse() *
        TruthOf(query_map).T_world_submap.at(closure.query);
    return T_reference_query.Inverse() * closure.T_reference_query;
  }

 private:
  void Write(const std::string& path, const uint32_t plan_seed,
             const uint32_t drive_seed) const {
    SimulationOptions simulation;
    simulation.drive.length = 140.;
    const absl::StatusOr<SimulatedMap> map = Simulate(
        MakeOffice(OfficeOptions(), plan_seed), simulation, drive_seed);
    CHECK(map.ok()) << map.status();
    const absl::Status written =
        WriteSimulatedMap(*map, path, path + ".truth.csv");
    CHECK(written.ok()) << written;
  }

  TemporaryDirectory directory_;
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_TWO_OFFICES_H_
