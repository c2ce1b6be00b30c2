// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <iostream>
#include <string>

#include "cartographer_sdf/simulation/office.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_double(map_resolution, 0.05, "Side of a pixel of --map [m].");
DEFINE_uint32(plan_seed, 1, "Random seed of the random office.");
DEFINE_double(plan_width, 40., "Width of the random office [m].");
DEFINE_double(plan_height, 30., "Height of the random office [m].");
DEFINE_double(plan_wall_thickness, 0.15,
              "Wall thickness of the random office [m].");
DEFINE_double(
    plan_furniture, 0.14,
    "Pieces of furniture per square metre of room in the random office.");
DEFINE_double(glass_fronts, 0.,
              "Fraction of the rooms of the random office whose wall to the "
              "corridor is glass.");
DEFINE_double(glass_echo, 0.3,
              "Fraction of the beams on glass that return from it.");
DEFINE_double(open_tables, 0.,
              "Fraction of the tables in the random office of which the lidar "
              "sees only the four legs.");
DEFINE_int32(walking_people, 0,
             "Number of people who walk through the building all the time.");
DEFINE_int32(standing_people, 0,
             "Number of people who stand in one place for two minutes, then in "
             "another.");
DEFINE_double(lidar_range, 20.,
              "Range of the lidar [m]; farther echoes are lost.");
DEFINE_double(
    lidar_field_of_view, 270.,
    "Field of view of the lidar, centred on the direction of travel [deg].");
DEFINE_int32(lidar_beams, 360, "Number of beams of the lidar.");
DEFINE_double(lidar_noise, 0.015,
              "Standard deviation of the lidar's ranges [m].");
DEFINE_double(length, 360., "Length of the drive [m].");
DEFINE_uint32(seed, 1, "Random seed.");

namespace cartographer_sdf {
namespace {

// The plan of --map, or a random office.
absl::StatusOr<FloorPlan> PlanOfFlags() {
  if (!FLAGS_map.empty()) return ReadPgm(FLAGS_map, FLAGS_map_resolution);
  OfficeOptions office;
  office.width = FLAGS_plan_width;
  office.height = FLAGS_plan_height;
  office.wall_thickness = FLAGS_plan_wall_thickness;
  office.furniture_density = FLAGS_plan_furniture;
  office.glass_fronts = FLAGS_glass_fronts;
  office.open_tables = FLAGS_open_tables;
  if (const std::string error = Validate(office); !error.empty()) {
    return absl::InvalidArgumentError(error);
  }
  return MakeOffice(office, FLAGS_plan_seed);
}

absl::Status WriteMapOfFlags(RunRecord* const record) {
  SimulationOptions options;
  options.drive.length = FLAGS_length;
  options.lidar.glass_echo = FLAGS_glass_echo;
  options.lidar.max_range = FLAGS_lidar_range;
  options.lidar.num_beams = FLAGS_lidar_beams;
  options.lidar.range_noise = FLAGS_lidar_noise;
  options.lidar.field_of_view = FLAGS_lidar_field_of_view * M_PI / 180.;
  options.people.num_walking = FLAGS_walking_people;
  options.people.num_standing = FLAGS_standing_people;
  StageProgress progress(record);
  const absl::StatusOr<FloorPlan> plan = PlanOfFlags();
  if (!plan.ok()) return plan.status();
  const absl::StatusOr<SimulatedMap> map =
      Simulate(*plan, options, FLAGS_seed, progress.Begin("simulate"));
  if (!map.ok()) return map.status();
  record->Count("submaps", map->submaps.size());
  record->Count("nodes", map->nodes.size());
  return WriteSimulatedMap(*map, FLAGS_output, FLAGS_truth);
}

absl::Status RunSimulate(RunRecord* const record) {
  const absl::Status status = WriteMapOfFlags(record);
  if (status.ok()) std::cout << FLAGS_output << "\n" << FLAGS_truth << "\n";
  return status;
}

}  // namespace

// Long: a description, with all flags.
Subcommand SimulateSubcommand() {
  Subcommand subcommand{
      "simulate",
      "make a map with unclosed loops and its true poses",
      "--output A.pbstream --truth T.csv [--map plan.pgm] [--seed N] "
      "[--result R.json]",
      "Drives a robot with a ray-cast lidar and drifting odometry through a "
      "building. Writes the map that Cartographer would have saved without "
      "loop closing, and the true poses of its submaps and nodes.",
      {{"output", FileUse::kWriteMap, {}, "Map to write, a .pbstream."},
       {"truth",
        FileUse::kWriteText,
        {},
        "CSV file to write the true poses to, with lines of "
        "kind,trajectory,index,x,y,yaw [m, rad]."}},
      {{"map",
        FileUse::kRead,
        {},
        "Floor plan to drive through, a PGM with dark walls. If empty, a "
        "random office."},
       "map_resolution",
       "plan_seed",
       "plan_width",
       "plan_height",
       "plan_wall_thickness",
       "plan_furniture",
       "glass_fronts",
       "glass_echo",
       "open_tables",
       "walking_people",
       "standing_people",
       "lidar_range",
       "lidar_field_of_view",
       "lidar_beams",
       "lidar_noise",
       "length",
       {"seed",
        FileUse::kNone,
        {},
        "Random seed of the drive, its drift and the noise: two sessions in "
        "one building differ only in this seed."}},
      &RunSimulate};
  return subcommand;
}

}  // namespace cartographer_sdf
