// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/stages.h"

#include <iostream>
#include <utility>

#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/parallel_for.h"

namespace cartographer_sdf {

Executor MakeExecutor(const int num_threads) {
  return
      [num_threads](const size_t n, const std::function<void(size_t)>& task) {
        ParallelFor(static_cast<int>(n), num_threads,
                    [&task](const int k) { task(static_cast<size_t>(k)); });
      };
}

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
    const Options& options, const std::string& path, const Executor& executor,
    const ProgressCallback& on_progress) {
  const LoopClosingOptions& stages = options.loop_closing;
  if (FLAGS_places.empty()) {
    return DescribeMap(stages.place, stages.match, path, executor, on_progress);
  }
  absl::StatusOr<RememberedMap> remembered =
      RememberMap(stages.place, stages.match, FormatOptions(options), path,
                  FLAGS_places, executor, on_progress);
  if (!remembered.ok()) return remembered.status();
  if (!remembered->complaint.empty()) {
    std::cerr << "--places: " << remembered->complaint << "\n";
  }
  return std::move(remembered->map);
}

MatchRow ToRow(const Match& match, const bool accepted,
               const std::string& verdict) {
  const LoopClosure& closure = match.closure;
  MatchRow row;
  row.reference = closure.reference;
  row.query = closure.query;
  row.accepted = accepted;
  row.score = closure.score;
  row.T_reference_query = closure.T_reference_query;
  row.verdict = verdict;
  row.inliers = closure.evidence.inliers;
  row.overlap = closure.evidence.overlap;
  row.hit_ratio = closure.evidence.hit_ratio;
  row.contradiction_ratio = closure.evidence.contradiction_ratio;
  return row;
}

}  // namespace cartographer_sdf
