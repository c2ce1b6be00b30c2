// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/stages.h"

#include <iostream>
#include <utility>

#include "cartographer_sdf/tools/flags.h"

namespace cartographer_sdf {

StageCallback StageProgress::Callback() {
  return [this](const std::string& stage) { return Begin(stage); };
}

ProgressCallback StageProgress::Begin(const std::string& stage) {
  // The line of the stage before goes first.
  progress_.reset();
  progress_ = std::make_unique<Progress>(stage);
  return progress_->Callback();
}

absl::StatusOr<DescribedMap> DescribeMapOfFlags(
    const LoopClosingOptions& options, const std::string& path,
    const Executor& executor, const PointClouds point_clouds,
    const ProgressCallback& on_progress) {
  const MatchOptions& match = options.recognition.match;
  if (FLAGS_places.empty()) {
    return DescribeMap(options.place, match, path, executor, on_progress,
                       point_clouds);
  }
  absl::StatusOr<RememberedMap> remembered = RememberMap(
      options.place, match, FormatPlaceOptions(options.place, match), path,
      FLAGS_places, executor, on_progress, point_clouds);
  if (!remembered.ok()) return remembered.status();
  if (!remembered->complaint.empty()) {
    std::cerr << "--places: " << remembered->complaint << "\n";
  }
  return std::move(remembered->map);
}

absl::Status RequireVerification(const LoopClosingOptions& options,
                                 const std::string& subcommand) {
  if (options.recognition.match.method == Method::kSdf) return absl::OkStatus();
  return absl::InvalidArgumentError(
      subcommand +
      " needs match.method = \"sdf\": the number of inliers is no "
      "verification");
}

}  // namespace cartographer_sdf
