// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the subcommands that work on maps share: progress lines, places.

#ifndef CARTOGRAPHER_SDF_TOOLS_STAGES_H_
#define CARTOGRAPHER_SDF_TOOLS_STAGES_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/tools/progress.h"

namespace cartographer_sdf {

// A progress line for one stage after the other.
class StageProgress {
 public:
  // For LoopClosing's callbacks; not to be used after this object.
  [[nodiscard]] StageCallback Callback();
  [[nodiscard]] ProgressCallback Begin(const std::string& stage);

 private:
  std::unique_ptr<Progress> progress_;
};

// The map with its places: from the file of --places, if it is given, or
// described, and then left there.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMapOfFlags(
    const LoopClosingOptions& options, const std::string& path,
    const Executor& executor, PointClouds point_clouds,
    const ProgressCallback& on_progress);

// An error where the configured method verifies nothing.
[[nodiscard]] absl::Status RequireVerification(
    const LoopClosingOptions& options, const std::string& subcommand);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_STAGES_H_
