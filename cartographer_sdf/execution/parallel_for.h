// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EXECUTION_PARALLEL_FOR_H_
#define CARTOGRAPHER_SDF_EXECUTION_PARALLEL_FOR_H_

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/progress.h"
#include "glog/logging.h"

namespace cartographer_sdf {

// Calls `function(i)` once for each i in [0, n), on `num_threads` >= 1 threads
// including the caller's; returns when all calls have returned. The order of
// the calls is unspecified: for results that do not depend on the number of
// threads, let each call write only the output of its own i, and combine
// outputs by index afterwards. `function` must not throw. `on_progress`
// receives the completed fraction, increasing, in one call at a time from any
// of the threads.
template <typename Function>
void ParallelFor(const int n, const int num_threads, const Function& function,
                 const ProgressCallback& on_progress = {}) {
  CHECK_GE(num_threads, 1);
  std::atomic<int> next{0};
  TaskProgress progress(on_progress, static_cast<size_t>(n));
  const auto work = [&] {
    for (int i = next.fetch_add(1); i < n; i = next.fetch_add(1)) {
      function(i);
      progress.TaskIsDone();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < std::min(num_threads, n); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

// Returns an executor that runs tasks as ParallelFor does.
[[nodiscard]] inline Executor MakeExecutor(const int num_threads) {
  return
      [num_threads](const size_t n, const std::function<void(size_t)>& task) {
        ParallelFor(static_cast<int>(n), num_threads,
                    [&task](const int k) { task(static_cast<size_t>(k)); });
      };
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EXECUTION_PARALLEL_FOR_H_
