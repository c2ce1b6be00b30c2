// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EXECUTION_PROGRESS_H_
#define CARTOGRAPHER_SDF_EXECUTION_PROGRESS_H_

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace cartographer_sdf {

// Receives the completed fraction of a job, in [0, 1]. May be empty.
using ProgressCallback = std::function<void(double)>;

// Counts the completed tasks of a stage, from any thread, and reports
// increasing fractions to the callback, one call at a time.
class TaskProgress {
 public:
  // The stage advances the job from fraction `begin` to `end`.
  TaskProgress(ProgressCallback on_progress, const size_t num_tasks,
               const double begin = 0., const double end = 1.)
      : on_progress_(std::move(on_progress)),
        num_tasks_(num_tasks),
        begin_(begin),
        end_(end) {}

  // Each task calls this once, when done. Thread-safe.
  void TaskIsDone() {
    if (!on_progress_) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    ++num_done_;
    on_progress_(begin_ + (end_ - begin_) * static_cast<double>(num_done_) /
                              static_cast<double>(num_tasks_));
  }

 private:
  const ProgressCallback on_progress_;
  const size_t num_tasks_;
  const double begin_;
  const double end_;
  std::mutex mutex_;
  size_t num_done_ = 0;  // guarded by mutex_, as are calls to the callback
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EXECUTION_PROGRESS_H_
