// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EXECUTION_PROGRESS_H_
#define CARTOGRAPHER_SDF_EXECUTION_PROGRESS_H_

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace cartographer_sdf {

// Takes the fraction of a job that is done, in [0, 1]. May be empty.
using ProgressCallback = std::function<void(double)>;

// Counts the tasks of a stage that are done, on whatever threads they run, and
// tells the callback: increasing fractions, one call at a time.
class TaskProgress {
 public:
  // The stage takes the job from the fraction `begin` to `end`.
  TaskProgress(ProgressCallback on_progress, const size_t num_tasks,
               const double begin = 0., const double end = 1.)
      : on_progress_(std::move(on_progress)),
        num_tasks_(num_tasks),
        begin_(begin),
        end_(end) {}

  // To be called once by each task. Thread-safe.
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
  size_t num_done_ = 0;  // guarded by the mutex, as are calls of the callback
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EXECUTION_PROGRESS_H_
