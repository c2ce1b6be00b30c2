// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The flags of both nodes, those of cartographer_node and some more, so that
// launch files carry over, and the searcher's options that they name.

#ifndef ROS_CARTOGRAPHER_SDF_ROS_NODE_FLAGS_H_
#define ROS_CARTOGRAPHER_SDF_ROS_NODE_FLAGS_H_

#include "cartographer_sdf/live/live_options.h"
#include "gflags/gflags.h"

DECLARE_bool(collect_metrics);
DECLARE_string(configuration_directory);
DECLARE_string(configuration_basename);
DECLARE_string(sdf_configuration_basename);
DECLARE_string(load_state_filename);
DECLARE_bool(load_frozen_state);
DECLARE_bool(start_trajectory_with_default_topics);
DECLARE_string(save_state_filename);

namespace cartographer_sdf {

// Ends the node with a line that says why if they cannot be loaded.
[[nodiscard]] LiveOptions LoadOptionsOrDie();

}  // namespace cartographer_sdf

#endif  // ROS_CARTOGRAPHER_SDF_ROS_NODE_FLAGS_H_
