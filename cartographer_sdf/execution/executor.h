// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EXECUTION_EXECUTOR_H_
#define CARTOGRAPHER_SDF_EXECUTION_EXECUTOR_H_

#include <cstddef>
#include <functional>

namespace cartographer_sdf {

// Runs task(0), ..., task(n - 1), once each, in any order, possibly
// concurrently, and returns when all are done.
using Executor =
    std::function<void(size_t n, const std::function<void(size_t)>& task)>;

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EXECUTION_EXECUTOR_H_
