// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A robot that drives round and round for a server, until it is killed:
//   fleet_robot ADDRESS

#include "cartographer/cloud/client/map_builder_stub.h"
#include "glog/logging.h"
#include "test/live/host.h"
#include "test/live/small_room.h"

int main(int argc, char** argv) {
  using namespace cartographer_sdf::testing;  // NOLINT: of this function alone
  CHECK_EQ(argc, 2);
  cartographer::cloud::MapBuilderStub server(argv[1], "robot");
  const int id = server.AddTrajectoryBuilder(
      SensorIds(), MakeStockOptions(SmallSubmapsLua(3)).trajectory_builder,
      nullptr);
  for (int k = 0;; ++k) FeedScanOfARoom(&server, id, 0., k);
}
