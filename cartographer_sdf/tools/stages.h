// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the subcommands that work on maps share: threads, progress, tables.

#ifndef CARTOGRAPHER_SDF_TOOLS_STAGES_H_
#define CARTOGRAPHER_SDF_TOOLS_STAGES_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/match_table.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/tools/progress.h"

namespace cartographer_sdf {

[[nodiscard]] Executor MakeExecutor(int num_threads);

// A progress line for one stage after the other.
class StageProgress {
 public:
  // For LoopClosing's callbacks; not to be used after this object.
  [[nodiscard]] StageCallback Callback();
  [[nodiscard]] ProgressCallback Begin(const std::string& stage);

 private:
  std::unique_ptr<Progress> progress_;
};

// The places of a map: from the file of --places, if it is given, or described,
// and then left there. A file of places is bound to all options: more than they
// depend on, but never too few.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMapOfFlags(
    const Options& options, const std::string& path, const Executor& executor,
    const ProgressCallback& on_progress);

[[nodiscard]] MatchRow ToRow(const Match& match, bool accepted,
                             const std::string& verdict);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_STAGES_H_
