// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/worker.h"

#include <unistd.h>

#include <ctime>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Same as the host's background threads.
constexpr int kNiceness = 10;

}  // namespace

double ThreadCpuSeconds() {
  timespec time;
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) != 0) return 0.;
  return static_cast<double>(time.tv_sec) +
         1e-9 * static_cast<double>(time.tv_nsec);
}

void Worker::Schedule(std::function<void()> task) {
  const absl::MutexLock lock(&mutex_);
  if (!is_stopping_) tasks_.push_back(std::move(task));
}

void Worker::WaitUntilIdle() {
  if (std::this_thread::get_id() == thread_.get_id()) return;
  const auto is_idle = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return tasks_.empty() && !is_busy_;
  };
  const absl::MutexLock lock(&mutex_);
  mutex_.Await(absl::Condition(&is_idle));
}

void Worker::Stop() {
  CHECK(std::this_thread::get_id() != thread_.get_id())
      << "stopped by one of its tasks";
  {
    const absl::MutexLock lock(&mutex_);
    is_stopping_ = true;
    tasks_.clear();
  }
  if (thread_.joinable()) thread_.join();
}

size_t Worker::NumWaiting() const {
  const absl::MutexLock lock(&mutex_);
  return tasks_.size();
}

double Worker::CpuSeconds() const {
  const absl::MutexLock lock(&mutex_);
  return cpu_seconds_;
}

void Worker::Run() {
#ifdef __linux__
  // On Linux, affects only this thread. Failure is harmless.
  if (nice(kNiceness) == -1) VLOG(1) << "no lower priority";
#endif
  const auto has_work = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return !tasks_.empty() || is_stopping_;
  };
  while (true) {
    std::function<void()> task;
    {
      const absl::MutexLock lock(&mutex_);
      is_busy_ = false;
      cpu_seconds_ = ThreadCpuSeconds();
      mutex_.Await(absl::Condition(&has_work));
      if (is_stopping_) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
      is_busy_ = true;
    }
    task();
  }
}

}  // namespace cartographer_sdf
