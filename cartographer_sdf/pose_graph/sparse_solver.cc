// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/sparse_solver.h"

#include "ceres/ceres.h"

namespace cartographer_sdf {
namespace {

// A chain of 1e4 stiff links bends 1e10 times as easily as one link. Damping
// must lie below that, or each step moves a far end only a little.
constexpr double kInitialTrustRegionRadius = 1e12;
// Only the function tolerance is to end it: poses of a large graph differ in
// size from their changes by more than the solver's default for either.
constexpr double kNegligibleTolerance = 1e-15;

}  // namespace

SparseSolution SolveSparse(const int max_num_iterations,
                           const double function_tolerance,
                           ceres::Problem* const problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // As fast as SuiteSparse on these graphs, and free of BLAS, whose rounding
  // depends on its number of threads.
  if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE)) {
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  }
  options.num_threads = 1;
  options.max_num_iterations = max_num_iterations;
  options.initial_trust_region_radius = kInitialTrustRegionRadius;
  options.function_tolerance = function_tolerance;
  options.parameter_tolerance = kNegligibleTolerance;
  options.gradient_tolerance = kNegligibleTolerance;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
  return SparseSolution{
      summary.IsSolutionUsable(),
      summary.termination_type == ceres::CONVERGENCE,
      summary.num_successful_steps + summary.num_unsuccessful_steps,
      summary.message};
}

}  // namespace cartographer_sdf
