// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/method_options.h"

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/config/option_keys.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

namespace cartographer_sdf {

inline void VisitOptions(OptionVisitor& visit, SubmapCloudOptions& options) {
  visit("max_num_scans", options.max_num_scans);
  visit("voxel_size_meters", options.voxel_size_meters);
}

inline void VisitOptions(OptionVisitor& visit,
                         CurvatureClusterOptions& options) {
  visit("scatter_radius_meters", options.scatter_radius_meters);
  visit("min_num_neighbours", options.min_num_neighbours);
  visit("detection_threshold", options.detection_threshold);
  visit("cluster_radius_meters", options.cluster_radius_meters);
  visit("min_num_points", options.min_num_points);
}

inline void VisitOptions(OptionVisitor& visit, ShapeContextOptions& options) {
  visit("radius_meters", options.radius_meters);
  visit("num_radial_bins", options.num_radial_bins);
  visit("num_angular_bins", options.num_angular_bins);
  visit("orientation_radius_meters", options.orientation_radius_meters);
}

inline void VisitOptions(OptionVisitor& visit, CloudPlaceOptions& options) {
  visit("cloud", options.cloud);
  visit("keypoint", options.keypoint);
  visit("descriptor", options.descriptor);
}

inline void VisitOptions(OptionVisitor& visit, MethodOptions& options) {
  VisitOptions(visit, options.options);
  if (options.describes_clouds) visit("shape_context", options.shape_context);
}

inline std::string Validate(const MethodOptions&) { return ""; }

absl::StatusOr<MethodOptions> LoadOptionsOfMethod(const std::string& method) {
  if (!method.empty() && method != "sdf" && method != "paper" &&
      method != "shape_context") {
    return UsageError(absl::StrCat(
        "the method must be sdf, paper or shape_context, it is ", method));
  }
  const bool is_default =
      gflags::GetCommandLineFlagInfoOrDie("configuration_basename").is_default;
  const std::string basename = is_default && !method.empty() && method != "sdf"
                                   ? absl::StrCat(method, ".lua")
                                   : FLAGS_configuration_basename;
  if (absl::Status status = CheckConfigurationDirectories(); !status.ok()) {
    return status;
  }
  MethodOptions defaults;
  defaults.describes_clouds = method == "shape_context";
  absl::StatusOr<MethodOptions> result =
      LoadTable(ConfigurationDirectories(), basename, kOptionsTable, defaults);
  if (!result.ok()) return result.status();
  if (!method.empty()) {
    result->options.loop_closing.recognition.match.method =
        method == "sdf" ? Method::kSdf : Method::kPaper;
  }
  return result;
}

std::string FormatOptions(const MethodOptions& options) {
  return FormatFile(kOptionsTable, options);
}

}  // namespace cartographer_sdf
