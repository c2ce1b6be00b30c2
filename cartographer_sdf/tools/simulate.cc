// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/simulate.h"

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/simulation/floor_plan.h"
#include "cartographer_sdf/simulation/simulated_map.h"

namespace cartographer_sdf {

absl::Status RunSimulate(const SimulateArguments& arguments,
                         const ProgressCallback& on_progress) {
  if (const std::string error = Validate(arguments.office);
      !arguments.plan_path && !error.empty()) {
    return absl::InvalidArgumentError(error);
  }
  SimulationOptions options;
  options.drive.length = arguments.length;
  options.lidar = arguments.lidar;
  options.people = arguments.people;
  const absl::StatusOr<FloorPlan> plan =
      arguments.plan_path
          ? ReadPgm(*arguments.plan_path, arguments.plan_resolution)
          : MakeOffice(arguments.office, arguments.plan_seed);
  if (!plan.ok()) return plan.status();
  const absl::StatusOr<SimulatedMap> map =
      Simulate(*plan, options, arguments.drive_seed, on_progress);
  if (!map.ok()) return map.status();
  return WriteSimulatedMap(*map, arguments.output_path, arguments.truth_path);
}

}  // namespace cartographer_sdf
