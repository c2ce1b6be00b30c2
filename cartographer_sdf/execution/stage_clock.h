// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EXECUTION_STAGE_CLOCK_H_
#define CARTOGRAPHER_SDF_EXECUTION_STAGE_CLOCK_H_

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/progress.h"

namespace cartographer_sdf {

// Called at the beginning of each stage with its name; returns what is told of
// its progress. May be empty.
using StageCallback = std::function<ProgressCallback(const std::string& stage)>;

// Announces the stages of a job, one after the other, and takes their times.
class StageClock {
 public:
  // `seconds` outlives the clock.
  StageClock(StageCallback on_stage,
             std::vector<std::pair<std::string, double>>* const seconds)
      : on_stage_(std::move(on_stage)), seconds_(seconds) {}

  // Ends the stage before.
  ProgressCallback Begin(const std::string& stage) {
    End();
    seconds_->emplace_back(stage, 0.);
    begin_ = std::chrono::steady_clock::now();
    return on_stage_ ? on_stage_(stage) : ProgressCallback();
  }
  void End() {
    if (!begin_) return;
    seconds_->back().second = std::chrono::duration<double>(
                                  std::chrono::steady_clock::now() - *begin_)
                                  .count();
    begin_.reset();
  }

 private:
  const StageCallback on_stage_;
  std::vector<std::pair<std::string, double>>* const seconds_;
  std::optional<std::chrono::steady_clock::time_point> begin_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EXECUTION_STAGE_CLOCK_H_
