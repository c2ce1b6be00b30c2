// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Three simulated maps with their truth: two sessions in one office, and one in
// another.

#ifndef TEST_TESTING_TWO_OFFICES_H_
#define TEST_TESTING_TWO_OFFICES_H_

#include <cstdint>
#include <string>

#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/simulation/office.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "cartographer_sdf/simulation/truth.h"
#include "glog/logging.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::testing {

inline Executor ThreadExecutor(const int num_threads) {
  return MakeExecutor(num_threads);
}

// As small as buildings and drives may be for places to be told apart, so that
// sanitizers get through them.
inline FloorPlan MakeSmallOffice(const uint32_t seed) {
  OfficeOptions options;
  options.width = 30.;
  options.height = 26.;
  options.resolution = 0.05;
  return MakeOffice(options, seed);
}

// Without submaps only the nodes are kept, as where Cartographer trimmed all.
inline void WriteShortDrive(const FloorPlan& plan, const uint32_t seed,
                            const std::string& path,
                            const bool with_submaps = true,
                            const DriftOptions& drift = DriftOptions()) {
  SimulationOptions options;
  options.drift = drift;
  options.drive.length = 100.;
  options.drive.time_step = 0.1;
  options.lidar.num_beams = 240;
  absl::StatusOr<SimulatedMap> map = Simulate(plan, options, seed);
  CHECK(map.ok()) << map.status();
  if (!with_submaps) map->submaps.clear();
  const absl::Status written =
      WriteSimulatedMap(*map, path, path + ".truth.csv");
  CHECK(written.ok()) << written;
}

class TwoOffices {
 public:
  TwoOffices() {
    WriteShortDrive(MakeSmallOffice(1), 1, Morning());
    WriteShortDrive(MakeSmallOffice(1), 2, Evening());
    WriteShortDrive(MakeSmallOffice(5), 3, Elsewhere());
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
  [[nodiscard]] Rigid2 ErrorOf(const PairPose& pair,
                               const std::string& reference_map,
                               const std::string& query_map) const {
    const Rigid2 T_reference_query =
        TruthOf(reference_map).T_world_submap.at(pair.reference).Inverse() *
        TruthOf(query_map).T_world_submap.at(pair.query);
    return T_reference_query.Inverse() * pair.T_reference_query;
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_TWO_OFFICES_H_
