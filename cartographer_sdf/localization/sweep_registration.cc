// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/sweep_registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/localization/map_precision.h"

namespace cartographer_sdf {
namespace {

constexpr int kNumIterations = 8;
constexpr double kLastKernelScale = 0.1;  // [m]
constexpr int kMinNumEchoes = 5;
// A weak hold of the guess, so that a pose along a bare wall stays: standard
// deviations [m], [rad] against residuals of kResidualSigma [m].
constexpr double kPriorTranslationSigma = 5.;
constexpr double kPriorRotationSigma = 0.5;
constexpr double kResidualSigma = 0.05;
// Neighbouring echoes err together, with the cells of the map: about one in so
// many is independent.
constexpr double kNumPerIndependentEcho = 10.;

std::vector<Eigen::Vector2d> SampleEchoes(const Sweep& sweep,
                                          const size_t count) {
  std::vector<Eigen::Vector2d> all, chosen;
  for (const RobotBeam& beam : sweep.beams) {
    if (beam.has_echo) all.push_back(beam.end - sweep.centre);
  }
  for (const size_t k : EvenlySpacedIndices(all.size(), count)) {
    chosen.push_back(all[k]);
  }
  return chosen;
}

// Of the squared distances, weighted by a Geman-McClure kernel, in x, y and the
// heading about the centre of the sensors.
struct NormalEquations {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  int num_echoes = 0;
};

NormalEquations Linearize(const DistanceField& field,
                          const std::vector<Eigen::Vector2d>& echoes,
                          const Rigid2& T_grid_centre, const double scale) {
  NormalEquations equations;
  const Eigen::Matrix2d rotation = T_grid_centre.RotationMatrix();
  for (const Eigen::Vector2d& echo : echoes) {
    const Eigen::Vector2d turned = rotation * echo;
    const std::optional<FieldSample> sample =
        SampleField(field, T_grid_centre.translation() + turned);
    if (!sample) continue;
    ++equations.num_echoes;
    // Within a wall of two cells or less, the middle is as good as the edge.
    const double distance = sample->distance;
    const double ratio = distance / scale;
    const double root_weight = 1. / (1. + ratio * ratio);
    const Eigen::Vector2d& gradient = sample->gradient;
    const Eigen::Vector3d jacobian(
        gradient.x(), gradient.y(),
        gradient.y() * turned.x() - gradient.x() * turned.y());
    const double weight = root_weight * root_weight;
    equations.hessian += weight * jacobian * jacobian.transpose();
    equations.gradient += weight * distance * jacobian;
  }
  return equations;
}

Eigen::Matrix3d PriorInformation() {
  const Eigen::Vector3d sigmas(kPriorTranslationSigma, kPriorTranslationSigma,
                               kPriorRotationSigma);
  return (kResidualSigma / sigmas.array()).square().matrix().asDiagonal();
}

Eigen::Matrix3d Covariance(const NormalEquations& equations) {
  const Eigen::Matrix3d information =
      (equations.hessian / kNumPerIndependentEcho + PriorInformation()) /
      (kResidualSigma * kResidualSigma);
  const Eigen::Vector3d map_sigmas(kMapTranslationSigma, kMapTranslationSigma,
                                   kMapRotationSigma);
  Eigen::Matrix3d covariance =
      information.llt().solve(Eigen::Matrix3d::Identity());
  covariance.diagonal() += map_sigmas.cwiseAbs2();
  return covariance;
}

}  // namespace

std::optional<RegisteredSweep> RegisterSweep(const DistanceField& field,
                                             const Sweep& sweep,
                                             const size_t num_beams,
                                             const double first_kernel_scale,
                                             const Rigid2& guess_T_grid_robot) {
  const std::vector<Eigen::Vector2d> echoes = SampleEchoes(sweep, num_beams);
  const Rigid2 T_robot_centre(sweep.centre, 0.);
  Rigid2 T_grid_centre = guess_T_grid_robot * T_robot_centre;
  const Eigen::Matrix3d prior = PriorInformation();
  for (int k = 0; k < kNumIterations; ++k) {
    const double scale =
        first_kernel_scale * std::pow(kLastKernelScale / first_kernel_scale,
                                      k / (kNumIterations - 1.));
    const NormalEquations equations =
        Linearize(field, echoes, T_grid_centre, scale);
    if (equations.num_echoes < kMinNumEchoes) return std::nullopt;
    const Eigen::Vector3d step =
        (equations.hessian + prior).llt().solve(-equations.gradient);
    T_grid_centre = Rigid2(T_grid_centre.translation() + step.head<2>(),
                           T_grid_centre.rotation() + step.z());
  }
  const NormalEquations last =
      Linearize(field, echoes, T_grid_centre, kLastKernelScale);
  return RegisteredSweep{T_grid_centre * T_robot_centre.Inverse(),
                         Covariance(last)};
}

}  // namespace cartographer_sdf
