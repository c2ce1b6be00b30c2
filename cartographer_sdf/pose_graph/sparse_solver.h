// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_SPARSE_SOLVER_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_SPARSE_SOLVER_H_

#include <cstddef>
#include <vector>

#include "cartographer_sdf/pose_graph/spa_graph.h"
#include "ceres/ceres.h"

namespace cartographer_sdf {

// A chain of 1e4 stiff links bends 1e10 times as easily as one link. Damping
// must lie below that, or each step moves a far end only a little.
constexpr double kInitialTrustRegionRadius = 1e12;
// Only the function tolerance should end the iteration: in a large graph, poses
// and their changes differ in size by more than the solver's defaults for the
// other two allow.
constexpr double kNegligibleTolerance = 1e-15;

// Single-threaded Levenberg-Marquardt until the cost changes by less than the
// given fraction of itself. Deterministic.
[[nodiscard]] inline ceres::Solver::Options SparseSolverOptions(
    const int max_num_iterations, const double function_tolerance) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // As fast as SuiteSparse on these graphs, and without BLAS, whose rounding
  // depends on its thread count.
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
  return options;
}

// Minimises the residuals of the graph's edges, robust ones under the Huber
// loss, over one vector per pose; vectors of constant poses stay fixed.
// `make_cost` returns a new ceres::CostFunction for an edge, of the vectors of
// its start and end. Without a usable solution the vectors stay unchanged.
template <typename Vector, typename MakeCost>
[[nodiscard]] ceres::Solver::Summary SolveSparse(
    const ceres::Solver::Options& options, const SpaGraph& graph,
    const double huber_scale, const MakeCost& make_cost,
    std::vector<Vector>* const vectors) {
  ceres::HuberLoss huber_loss(huber_scale);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  for (size_t i = 0; i != vectors->size(); ++i) {
    double* const vector = (*vectors)[i].data();
    problem.AddParameterBlock(vector, Vector::RowsAtCompileTime);
    if (graph.constant[i]) problem.SetParameterBlockConstant(vector);
  }
  for (const SpaEdge& edge : graph.edges) {
    problem.AddResidualBlock(
        make_cost(edge), edge.robust ? &huber_loss : nullptr,
        (*vectors)[edge.start].data(), (*vectors)[edge.end].data());
  }
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_SPARSE_SOLVER_H_
