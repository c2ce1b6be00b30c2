// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/method_options.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

namespace cartographer_sdf {

absl::StatusOr<MethodOptions> LoadOptionsOfMethod(const std::string& method) {
  if (!method.empty() && method != "sdf" && method != "paper" &&
      method != "shape_context") {
    return UsageError(absl::StrCat(
        "the method must be sdf, paper or shape_context, it is ", method));
  }
  MethodOptions result;
  result.describes_clouds = method == "shape_context";
  const bool is_default =
      gflags::GetCommandLineFlagInfoOrDie("configuration_basename").is_default;
  const std::string basename = is_default && !method.empty() && method != "sdf"
                                   ? absl::StrCat(method, ".lua")
                                   : FLAGS_configuration_basename;
  if (result.describes_clouds) {
    if (absl::Status status = CheckConfigurationDirectories(); !status.ok()) {
      return status;
    }
    absl::StatusOr<ComparisonOptions> options =
        LoadComparisonOptions(ConfigurationDirectories(), basename);
    if (!options.ok()) return options.status();
    result.options = std::move(options->options);
    result.shape_context = options->shape_context;
  } else {
    absl::StatusOr<Options> options = LoadOptionsOfFlags(basename);
    if (!options.ok()) return options.status();
    result.options = *std::move(options);
  }
  if (!method.empty()) {
    result.options.loop_closing.recognition.match.method =
        method == "sdf" ? Method::kSdf : Method::kPaper;
  }
  return result;
}

std::string FormatOptions(const MethodOptions& options) {
  return options.describes_clouds ? FormatOptions(ComparisonOptions{
                                        options.options, options.shape_context})
                                  : FormatOptions(options.options);
}

}  // namespace cartographer_sdf
