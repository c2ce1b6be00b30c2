// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A low-priority thread that runs tasks in order.

#ifndef CARTOGRAPHER_SDF_LIVE_WORKER_H_
#define CARTOGRAPHER_SDF_LIVE_WORKER_H_

#include <chrono>
#include <deque>
#include <functional>
#include <thread>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace cartographer_sdf {

// CPU time of the calling thread [s].
[[nodiscard]] double ThreadCpuSeconds();

[[nodiscard]] inline double SecondsSince(
    const std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
      .count();
}

class Worker {
 public:
  Worker() : thread_([this] { Run(); }) {}
  ~Worker() { Stop(); }

  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Drops the task after Stop.
  void Schedule(std::function<void()> task) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns at once when called by a task, which would otherwise wait for
  // itself.
  void WaitUntilIdle() ABSL_LOCKS_EXCLUDED(mutex_);
  // Finishes the running task, drops the others.
  void Stop() ABSL_LOCKS_EXCLUDED(mutex_);
  // Number of tasks that wait for the running one.
  [[nodiscard]] size_t NumWaiting() const ABSL_LOCKS_EXCLUDED(mutex_);
  // CPU time of completed tasks [s].
  [[nodiscard]] double CpuSeconds() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  void Run() ABSL_LOCKS_EXCLUDED(mutex_);

  mutable absl::Mutex mutex_;
  std::deque<std::function<void()>> tasks_ ABSL_GUARDED_BY(mutex_);
  bool is_busy_ ABSL_GUARDED_BY(mutex_) = false;
  bool is_stopping_ ABSL_GUARDED_BY(mutex_) = false;
  double cpu_seconds_ ABSL_GUARDED_BY(mutex_) = 0.;
  std::thread thread_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_WORKER_H_
