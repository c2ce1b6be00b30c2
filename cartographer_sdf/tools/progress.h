// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_PROGRESS_H_
#define CARTOGRAPHER_SDF_TOOLS_PROGRESS_H_

#include <functional>
#include <memory>
#include <mutex>
#include <ostream>
#include <string>

#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/tools/run_record.h"

namespace cartographer_sdf {

// E.g. "match [=====>     ]  45 %, 12 s left", at most `width` characters.
// Includes the time left once it can be estimated.
[[nodiscard]] std::string FormatProgress(const std::string& stage,
                                         double fraction,
                                         double elapsed_seconds, int width);

// A line on the terminal that shows the progress of a stage once it takes
// longer than a second; the destructor removes it. Shows nothing if stderr is
// not a terminal. Thread-safe.
class Progress {
 public:
  explicit Progress(const std::string& stage);
  // `terminal` may be null; `seconds` is a monotonic clock.
  Progress(const std::string& stage, std::ostream* terminal, int width,
           std::function<double()> seconds);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  void Update(double fraction);
  // Update as a std::function; must not outlive this object.
  [[nodiscard]] ProgressCallback Callback() {
    return [this](const double fraction) { Update(fraction); };
  }
  // Time since construction.
  [[nodiscard]] double ElapsedSeconds() const;

 private:
  const std::string stage_;
  std::ostream* const terminal_;
  const int width_;
  const std::function<double()> seconds_;
  const double begin_;
  std::mutex mutex_;
  // When the line was last drawn, guarded by the mutex.
  double last_drawn_ = 0.;
  bool is_drawn_ = false;
};

// A progress line for one stage after the other, and their durations.
class StageProgress {
 public:
  // Nothing is recorded without a record, which must outlive this object.
  explicit StageProgress(RunRecord* const record = nullptr) : record_(record) {}
  StageProgress(const StageProgress&) = delete;
  StageProgress& operator=(const StageProgress&) = delete;
  ~StageProgress() { End(); }

  // Must not outlive this object.
  [[nodiscard]] StageCallback Callback() {
    return [this](const std::string& stage) { return Begin(stage); };
  }
  [[nodiscard]] ProgressCallback Begin(const std::string& stage) {
    // Removes the line of the previous stage first.
    End();
    stage_ = stage;
    progress_ = std::make_unique<Progress>(stage);
    return progress_->Callback();
  }
  // What follows belongs to no stage.
  void End() {
    if (progress_ == nullptr) return;
    if (record_ != nullptr) {
      record_->stage_seconds.emplace_back(stage_, progress_->ElapsedSeconds());
    }
    progress_.reset();
  }

 private:
  RunRecord* const record_;
  std::string stage_;
  std::unique_ptr<Progress> progress_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_PROGRESS_H_
