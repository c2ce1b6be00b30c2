// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_SPARSE_SOLVER_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_SPARSE_SOLVER_H_

#include <string>

namespace ceres {
class Problem;
}  // namespace ceres

namespace cartographer_sdf {

struct SparseSolution {
  // Whether the parameters hold a result; they are as given otherwise.
  bool usable = false;
  bool converged = false;
  int num_iterations = 0;
  std::string message;
};

// Levenberg-Marquardt until the cost changes by less than the given fraction of
// itself. Deterministic.
[[nodiscard]] SparseSolution SolveSparse(int max_num_iterations,
                                         double function_tolerance,
                                         ceres::Problem* problem);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_SPARSE_SOLVER_H_
