// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/consistency.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A pose and the covariance of (x, y, yaw): translation in the target frame,
// rotation about the origin of the source frame.
struct UncertainPose {
  Rigid2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

UncertainPose Compose(const UncertainPose& T_a_b, const UncertainPose& T_b_c) {
  // A small rotation of b moves c by the lever from b to c.
  const Eigen::Vector2d lever =
      T_a_b.pose.RotationMatrix() * T_b_c.pose.translation();
  Eigen::Matrix3d J_ab = Eigen::Matrix3d::Identity();
  J_ab(0, 2) = -lever.y();
  J_ab(1, 2) = lever.x();
  Eigen::Matrix3d J_bc = Eigen::Matrix3d::Identity();
  J_bc.topLeftCorner<2, 2>() = T_a_b.pose.RotationMatrix();
  return {T_a_b.pose * T_b_c.pose,
          J_ab * T_a_b.covariance * J_ab.transpose() +
              J_bc * T_b_c.covariance * J_bc.transpose()};
}

Eigen::Matrix3d DiagonalCovariance(const double translation_sigma,
                                   const double rotation_sigma) {
  return Eigen::Vector3d(translation_sigma * translation_sigma,
                         translation_sigma * translation_sigma,
                         rotation_sigma * rotation_sigma)
      .asDiagonal();
}

// (a <- b) by odometry; none between trajectories.
std::optional<UncertainPose> Odometry(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry, const SubmapId& a,
    const SubmapId& b) {
  if (a.trajectory != b.trajectory) return std::nullopt;
  const OdometryPose& from = odometry.at(a);
  const OdometryPose& to = odometry.at(b);
  const double driven = std::abs(to.distance_driven - from.distance_driven);
  const double rotation_sigma =
      options.rotation_sigma_per_sqrt_meter * std::sqrt(driven);
  const Rigid2 T_a_b = from.T_local_submap.Inverse() * to.T_local_submap;
  return UncertainPose{
      T_a_b, DiagonalCovariance(DriftSigma(options, driven), rotation_sigma)};
}

PairPose Inverse(const PairPose& closure) {
  PairPose inverse = closure;
  inverse.reference = closure.query;
  inverse.query = closure.reference;
  inverse.T_reference_query = closure.T_reference_query.Inverse();
  return inverse;
}

PairPose FromLowerToHigherId(const PairPose& closure) {
  return closure.query < closure.reference ? Inverse(closure) : closure;
}

// a.reference -> a.query -> b.query -> b.reference -> a.reference.
std::optional<UncertainPose> Cycle(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry, const PairPose& a,
    const PairPose& b) {
  const std::optional<UncertainPose> queries =
      Odometry(options, odometry, a.query, b.query);
  const std::optional<UncertainPose> references =
      Odometry(options, odometry, b.reference, a.reference);
  if (!queries || !references) return std::nullopt;
  const Eigen::Matrix3d covariance = DiagonalCovariance(
      options.closure_translation_sigma_meters, options.closure_rotation_sigma);
  return Compose(
      Compose({a.T_reference_query, covariance}, *queries),
      Compose({b.T_reference_query.Inverse(), covariance}, *references));
}

double TranslationSigma(const UncertainPose& pose) {
  return std::sqrt(0.5 * pose.covariance.topLeftCorner<2, 2>().trace());
}

// Returns an id unlike that of any submap in a file, whose ids are not
// negative.
SubmapId Apart(const SubmapId& id) {
  return {std::numeric_limits<int>::min() + id.trajectory, id.index};
}

}  // namespace

std::string Validate(const ConsistencyOptions& options) {
  if (!(options.rotation_sigma_per_sqrt_meter >= 0. &&
        options.translation_sigma_per_meter >= 0. &&
        options.closure_translation_sigma_meters > 0. &&
        options.closure_rotation_sigma > 0.)) {
    return "consistency: sigmas of odometry must not be negative, those of "
           "closures must be positive";
  }
  if (!(options.max_mahalanobis_distance > 0. &&
        options.max_cycle_sigma_meters > 0.)) {
    return "max_mahalanobis_distance and max_cycle_sigma_meters "
           "must be positive";
  }
  return "";
}

double DriftSigma(const ConsistencyOptions& options, const double driven) {
  // The heading error is a random walk; integrated along the way, it displaces
  // the end with variance sigma^2 * driven^3 / 3.
  const double swing = options.rotation_sigma_per_sqrt_meter *
                       std::sqrt(driven) * driven / std::sqrt(3.);
  return std::hypot(swing, options.translation_sigma_per_meter * driven);
}

CycleVerdict CheckCycle(const ConsistencyOptions& options,
                        const std::map<SubmapId, OdometryPose>& odometry,
                        const PairPose& one, const PairPose& other) {
  // Fixes where the cycle begins and in which direction it runs, on which its
  // covariance depends.
  PairPose a = FromLowerToHigherId(one);
  PairPose b = FromLowerToHigherId(other);
  if (std::tie(b.reference, b.query) < std::tie(a.reference, a.query)) {
    std::swap(a, b);
  }
  std::optional<UncertainPose> cycle = Cycle(options, odometry, a, b);
  const std::optional<UncertainPose> crosswise =
      Cycle(options, odometry, a, Inverse(b));
  if (!cycle ||
      (crosswise && TranslationSigma(*crosswise) < TranslationSigma(*cycle))) {
    cycle = crosswise;
  }
  if (!cycle || TranslationSigma(*cycle) > options.max_cycle_sigma_meters) {
    return CycleVerdict::kUninformative;
  }
  const Eigen::Vector3d error(cycle->pose.translation().x(),
                              cycle->pose.translation().y(),
                              cycle->pose.rotation());
  const double squared = error.dot(cycle->covariance.ldlt().solve(error));
  return squared <= options.max_mahalanobis_distance *
                        options.max_mahalanobis_distance
             ? CycleVerdict::kConsistent
             : CycleVerdict::kInconsistent;
}

VerdictTable::VerdictTable(
    const std::vector<PairPose>& closures,
    const std::function<CycleVerdict(const PairPose&, const PairPose&)>& check)
    : closures_(closures), verdicts_(closures.size() * closures.size()) {
  for (size_t a = 0; a < closures.size(); ++a) {
    for (size_t b = a + 1; b < closures.size(); ++b) {
      verdicts_[a * closures.size() + b] = verdicts_[b * closures.size() + a] =
          check(closures[a], closures[b]);
    }
  }
}

SelectionResult VerdictTable::Weigh(const size_t k,
                                    const std::vector<size_t>& others) const {
  SelectionResult result{Selection::kSelected};
  for (const size_t other : others) {
    if (other == k) continue;
    const double score = std::max(closures_[other].score, 0.);
    const CycleVerdict verdict = verdicts_[k * closures_.size() + other];
    if (verdict == CycleVerdict::kConsistent) result.support += score;
    if (verdict == CycleVerdict::kInconsistent) result.contradiction += score;
  }
  return result;
}

double VerdictTable::Support(const size_t k,
                             const std::vector<size_t>& others) const {
  const SelectionResult weighed = Weigh(k, others);
  return weighed.support - weighed.contradiction;
}

std::vector<size_t> VerdictTable::InOrderOfWeight() const {
  std::vector<size_t> order(closures_.size());
  std::iota(order.begin(), order.end(), size_t{0});
  // By ids first, so that sums round the same.
  std::sort(order.begin(), order.end(), [&](const size_t a, const size_t b) {
    return IsBeforeByIds(closures_[a], closures_[b]);
  });
  std::vector<double> weight;
  for (size_t k = 0; k < closures_.size(); ++k) {
    const SelectionResult weighed = Weigh(k, order);
    weight.push_back(closures_[k].score + weighed.support -
                     weighed.contradiction);
  }
  std::stable_sort(
      order.begin(), order.end(),
      [&](const size_t a, const size_t b) { return weight[a] > weight[b]; });
  return order;
}

std::vector<SelectionResult> SelectConsistent(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<PairPose>& closures) {
  CHECK_EQ(Validate(options), "");
  const VerdictTable table(closures, [&](const PairPose& a, const PairPose& b) {
    return CheckCycle(options, odometry, a, b);
  });
  std::vector<size_t> chosen;
  std::vector<SelectionResult> results(closures.size());
  for (const size_t k : table.InOrderOfWeight()) {
    results[k] = table.Weigh(k, chosen);
    if (results[k].contradiction > results[k].support) {
      results[k].selection = Selection::kInconsistent;
    } else {
      chosen.push_back(k);
    }
  }
  for (const size_t k : chosen) {
    results[k] = table.Weigh(k, chosen);
    if (results[k].support < options.min_support &&
        closures[k].score < options.min_unsupported_score) {
      results[k].selection = Selection::kUnsupported;
    }
  }
  return results;
}

std::vector<SelectionResult> SelectConsistentBetween(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& reference_odometry,
    const std::map<SubmapId, OdometryPose>& query_odometry,
    const std::vector<PairPose>& pairs) {
  std::map<SubmapId, OdometryPose> odometry = query_odometry;
  for (const auto& [id, pose] : reference_odometry) odometry[Apart(id)] = pose;
  std::vector<PairPose> renamed = pairs;
  for (PairPose& pair : renamed) pair.reference = Apart(pair.reference);
  return SelectConsistent(options, odometry, renamed);
}

}  // namespace cartographer_sdf
