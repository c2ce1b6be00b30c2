// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/host_options.h"

#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/mapping/trajectory_builder_interface.h"

namespace cartographer_sdf {
namespace {

// The reader wants every key of the returned table to be used. What belongs to
// ROS is not ours to use, and what the two tables hold should stay checked.
// Line numbers in messages stay right.
std::string OnlyWhatIsUsed(const std::string& code) {
  return absl::StrCat("local function file() ", code,
                      "\nend\nlocal options = file()\nreturn {\n"
                      "map_builder = options.map_builder,\n"
                      "trajectory_builder = options.trajectory_builder }\n");
}

}  // namespace

absl::StatusOr<HostOptions> LoadHostOptions(
    const std::vector<std::string>& directories, const std::string& basename) {
  auto resolver =
      std::make_unique<cartographer::common::ConfigurationFileResolver>(
          directories);
  const std::string code = resolver->GetFileContentOrDie(basename);
  cartographer::common::LuaParameterDictionary dictionary(OnlyWhatIsUsed(code),
                                                          std::move(resolver));
  HostOptions options;
  options.map_builder = cartographer::mapping::CreateMapBuilderOptions(
      dictionary.GetDictionary("map_builder").get());
  options.trajectory_builder =
      cartographer::mapping::CreateTrajectoryBuilderOptions(
          dictionary.GetDictionary("trajectory_builder").get());
  if (!options.map_builder.use_trajectory_builder_2d()) {
    return absl::InvalidArgumentError(
        absl::StrCat(basename,
                     ": MAP_BUILDER.use_trajectory_builder_2d is not "
                     "true, and 3D cannot be done"));
  }
  return options;
}

}  // namespace cartographer_sdf
