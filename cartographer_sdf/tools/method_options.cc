// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/method_options.h"

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
  const bool has_file =
      !method.empty() && method != "sdf" &&
      gflags::GetCommandLineFlagInfoOrDie("configuration_basename").is_default;
  absl::StatusOr<Options> options =
      has_file ? LoadOptionsOfFlags(absl::StrCat(method, ".lua"))
               : LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  if (!method.empty()) {
    options->loop_closing.match.method =
        method == "sdf" ? Method::kSdf : Method::kPaper;
  }
  return MethodOptions{*std::move(options), method == "shape_context"};
}

}  // namespace cartographer_sdf
