// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Stands between robots that send over a network and a map builder:
// Cartographer ends its process where data are out of order or not numbers,
// which is right for a robot's own node, and wrong for a server that others
// need.

#ifndef CARTOGRAPHER_SDF_LIVE_CLIENT_GUARD_H_
#define CARTOGRAPHER_SDF_LIVE_CLIENT_GUARD_H_

#include <memory>

#include "cartographer/mapping/map_builder_interface.h"

namespace cartographer_sdf {

// Returns a map builder that drops, with a line in the log, and otherwise does
// as `host`:
// - sensor data of a sensor that the trajectory does not have, no later than
//   the sensor's last ones, or with values that are not finite;
// - local SLAM results for a trajectory with local SLAM of its own;
// - an initial pose relative to a trajectory without nodes;
// - the end of a trajectory that is not active;
// - a state that is not a whole map: there are no trajectories of it.
// Not checked are options of trajectories, calls of the pose graph, and data of
// trajectories without local SLAM, whose results another server sends. All
// methods may be called from any thread.
[[nodiscard]] std::unique_ptr<cartographer::mapping::MapBuilderInterface>
GuardAgainstClients(
    std::unique_ptr<cartographer::mapping::MapBuilderInterface> host);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_CLIENT_GUARD_H_
