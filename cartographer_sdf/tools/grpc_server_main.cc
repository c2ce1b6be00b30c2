// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// cartographer_sdf_grpc_server: Cartographer's server for a fleet of robots,
// with the searcher around its map builder.

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer/cloud/map_builder_server_interface.h"
#include "cartographer/cloud/map_builder_server_options.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer_sdf/live/client_guard.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/live/save_state.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/host_messages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"
#include "glog/logging.h"

DEFINE_string(sdf_configuration_basename, "sdf_live.lua",
              "Name of the searcher's configuration file.");
DEFINE_string(address, "",
              "Address and port to listen at, such as localhost:50051. If "
              "empty, that of Cartographer's configuration file.");

namespace cartographer_sdf {
namespace {

namespace cloud = cartographer::cloud;
namespace common = cartographer::common;
namespace mapping = cartographer::mapping;
using TrajectoryState = mapping::PoseGraphInterface::TrajectoryState;

constexpr char kServerProgram[] = "cartographer_sdf_grpc_server";

absl::StatusOr<cloud::proto::MapBuilderServerOptions> LoadServerOptions() {
  auto resolver = std::make_unique<common::ConfigurationFileResolver>(
      ConfigurationDirectories());
  const std::string code =
      resolver->GetFileContentOrDie(FLAGS_configuration_basename);
  common::LuaParameterDictionary dictionary(code, std::move(resolver));
  cloud::proto::MapBuilderServerOptions options =
      cloud::CreateMapBuilderServerOptions(&dictionary);
  if (!FLAGS_address.empty()) options.set_server_address(FLAGS_address);
  if (!options.map_builder_options().use_trajectory_builder_2d()) {
    return absl::InvalidArgumentError(
        absl::StrCat(FLAGS_configuration_basename,
                     ": MAP_BUILDER.use_trajectory_builder_2d is not true, and "
                     "3D is not supported"));
  }
  if (!options.map_builder_options().collate_by_trajectory()) {
    return absl::InvalidArgumentError(
        absl::StrCat(FLAGS_configuration_basename,
                     ": MAP_BUILDER.collate_by_trajectory is not true, and the "
                     "robots would have to wait for each other"));
  }
  return options;
}

// Blocks the signals that end the server, in all threads to come.
sigset_t BlockEndingSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

// Robots that are still connected may go on sending: it is dropped.
absl::Status FinishAndSave(mapping::MapBuilderInterface* const map_builder) {
  for (const auto& [id, state] :
       map_builder->pose_graph()->GetTrajectoryStates()) {
    if (state == TrajectoryState::ACTIVE) map_builder->FinishTrajectory(id);
  }
  if (FLAGS_output.empty()) return absl::OkStatus();
  map_builder->pose_graph()->RunFinalOptimization();
  return SaveState(FLAGS_output, map_builder);
}

absl::Status ServeOfFlags(RunRecord* const /*record*/) {
  if (absl::Status status = CheckConfigurationDirectories(); !status.ok()) {
    return status;
  }
  const absl::StatusOr<LiveOptions> live = LoadLiveOptions(
      ConfigurationDirectories(), FLAGS_sdf_configuration_basename);
  if (!live.ok()) return live.status();
  const auto options = LoadServerOptions();
  if (!options.ok()) return options.status();
  const sigset_t signals = BlockEndingSignals();
  std::unique_ptr<mapping::MapBuilderInterface> map_builder =
      GuardAgainstClients(CreateMapBuilder(
          mapping::CreateMapBuilder(options->map_builder_options()), *live));
  mapping::MapBuilderInterface* const shared = map_builder.get();
  const std::unique_ptr<cloud::MapBuilderServerInterface> server =
      cloud::CreateMapBuilderServer(*options, std::move(map_builder));
  server->Start();
  LOG(INFO) << "listening at " << options->server_address();
  int signal = 0;
  sigwait(&signals, &signal);
  const absl::Status status = FinishAndSave(shared);
  if (!status.ok()) LOG(ERROR) << status.message();
  // Cartographer's server would wait for robots that are still connected.
  std::_Exit(status.ok() ? EXIT_SUCCESS : EXIT_FAILURE);
}

Subcommand ServerCommand() {
  return {
      "",
      "serve robots that map a building together",
      "--configuration_basename cartographer_server.lua [--output B.pbstream]",
      "Cartographer's gRPC server, for robots with cartographer_grpc_node: "
      "they send scans and odometry, and share a pose graph. The searcher "
      "joins their trajectories wherever one comes to where another has "
      "been, without a common frame to begin with.\n\n"
      "Runs until it gets SIGINT or SIGTERM. Then all trajectories are "
      "finished, and the map is optimised and written to --output.",
      {{"configuration_basename",
        FileUse::kNone,
        {},
        "Name of Cartographer's configuration file; it may include others."}},
      {{"configuration_directory",
        FileUse::kNone,
        {},
        "Directories of configuration files, separated by commas, searched "
        "before those installed with this program and with Cartographer."},
       "sdf_configuration_basename",
       "address",
       {"output", FileUse::kWriteMap, {}, "Map to write, a .pbstream."}},
      &ServeOfFlags,
      kServerProgram,
      {}};
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  cartographer_sdf::KeepFreedMemory();
  google::InitGoogleLogging(argc > 0 ? argv[0]
                                     : cartographer_sdf::kServerProgram);
  const cartographer_sdf::HostMessages messages(
      cartographer_sdf::kServerProgram,
      [](const google::LogSeverity /*severity*/) { return true; });
  return cartographer_sdf::RunSubcommand(
      cartographer_sdf::ServerCommand(),
      std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
}
