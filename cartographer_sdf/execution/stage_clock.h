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

// Called with the name of each stage as it begins; returns the callback for its
// progress. May be empty.
using StageCallback = std::function<ProgressCallback(const std::string& stage)>;

// Announces the stages of a job, one after another, and measures their
// durations.
class StageClock {
 public:
  // `seconds` must outlive the clock.
  StageClock(StageCallback on_stage,
             std::vector<std::pair<std::string, double>>* const seconds)
      : on_stage_(std::move(on_stage)), seconds_(seconds) {}

  // Ends the previous stage, if any.
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
