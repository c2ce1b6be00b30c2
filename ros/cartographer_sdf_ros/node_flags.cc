// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf_ros/node_flags.h"

#include "glog/logging.h"

DEFINE_bool(collect_metrics, false,
            "Collect metrics, to be had by the services /read_metrics "
            "(Cartographer's) and /sdf_read_metrics (the searcher's).");
DEFINE_string(configuration_directory, "",
              "First directory to look for configuration files in.");
DEFINE_string(configuration_basename, "", "Cartographer's configuration file.");
DEFINE_string(sdf_configuration_basename, "sdf_live.lua",
              "The searcher's configuration file.");
DEFINE_string(load_state_filename, "", "A .pbstream to load; none if empty.");
DEFINE_bool(load_frozen_state, true, "Whether what is loaded stays as it is.");
DEFINE_bool(start_trajectory_with_default_topics, true,
            "Start the first trajectory at once.");
DEFINE_string(save_state_filename, "",
              "Where the map goes before the node ends; nowhere if empty.");

namespace cartographer_sdf {

LiveOptions LoadOptionsOrDie() {
  const absl::StatusOr<LiveOptions> options = LoadLiveOptions(
      {FLAGS_configuration_directory, CARTOGRAPHER_SDF_CONFIGURATION_DIRECTORY},
      FLAGS_sdf_configuration_basename);
  CHECK(options.ok()) << options.status().message();
  return *options;
}

}  // namespace cartographer_sdf
