// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/consistency.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "cartographer_sdf/closing/cycle_partners.h"
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

// An end of a closure: a submap and where odometry puts it.
struct End {
  int trajectory;
  OdometryPose pose;
};

// A closure from its lower to its higher id.
struct PlacedClosure {
  End reference;
  End query;
  Rigid2 T_reference_query;
};

PlacedClosure Inverse(const PlacedClosure& closure) {
  return {closure.query, closure.reference,
          closure.T_reference_query.Inverse()};
}

PlacedClosure PlaceByOdometry(const std::map<SubmapId, OdometryPose>& odometry,
                              const PairPose& closure) {
  const PlacedClosure placed{
      {closure.reference.trajectory, odometry.at(closure.reference)},
      {closure.query.trajectory, odometry.at(closure.query)},
      closure.T_reference_query};
  return closure.query < closure.reference ? Inverse(placed) : placed;
}

// Whether a cycle begins with `a`, for two closures from lower to higher id.
bool BeginsCycle(const PairPose& a, const PairPose& b) {
  return !(std::minmax(b.reference, b.query) <
           std::minmax(a.reference, a.query));
}

double Driven(const End& a, const End& b) {
  return std::abs(b.pose.distance_driven - a.pose.distance_driven);
}

// (a <- b) by odometry, of one trajectory.
UncertainPose Odometry(const ConsistencyOptions& options, const End& a,
                       const End& b) {
  const double driven = Driven(a, b);
  const double rotation_sigma =
      options.rotation_sigma_per_sqrt_meter * std::sqrt(driven);
  return {a.pose.T_local_submap.Inverse() * b.pose.T_local_submap,
          DiagonalCovariance(DriftSigma(options, driven), rotation_sigma)};
}

// a.reference -> a.query -> b.query -> b.reference -> a.reference. None if
// trajectories differ or the drives alone make it uninformative.
std::optional<UncertainPose> Cycle(const ConsistencyOptions& options,
                                   const double reach, const PlacedClosure& a,
                                   const PlacedClosure& b) {
  if (a.query.trajectory != b.query.trajectory ||
      a.reference.trajectory != b.reference.trajectory ||
      Driven(a.query, b.query) > reach ||
      Driven(a.reference, b.reference) > reach) {
    return std::nullopt;
  }
  const Eigen::Matrix3d covariance = DiagonalCovariance(
      options.closure_translation_sigma_meters, options.closure_rotation_sigma);
  return Compose(Compose({a.T_reference_query, covariance},
                         Odometry(options, a.query, b.query)),
                 Compose({b.T_reference_query.Inverse(), covariance},
                         Odometry(options, b.reference, a.reference)));
}

double TranslationSigma(const UncertainPose& pose) {
  return std::sqrt(0.5 * pose.covariance.topLeftCorner<2, 2>().trace());
}

// The cycle begins with `a`.
CycleVerdict CheckPlaced(const ConsistencyOptions& options, const double reach,
                         const PlacedClosure& a, const PlacedClosure& b) {
  std::optional<UncertainPose> cycle = Cycle(options, reach, a, b);
  const std::optional<UncertainPose> crosswise =
      Cycle(options, reach, a, Inverse(b));
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

// What a closure and each of its partners say about each other.
class SparseVerdicts {
 public:
  SparseVerdicts(const ConsistencyOptions& options,
                 const std::map<SubmapId, OdometryPose>& odometry,
                 const std::vector<PairPose>& closures)
      : closures_(closures), informative_(closures.size()) {
    const double reach = DrivenReach(options);
    const std::vector<std::vector<size_t>> partners =
        FindCyclePartners(options, odometry, closures);
    std::vector<PlacedClosure> placed;
    placed.reserve(closures.size());
    for (const PairPose& closure : closures) {
      placed.push_back(PlaceByOdometry(odometry, closure));
    }
    for (size_t a = 0; a < closures.size(); ++a) {
      for (const size_t b : partners[a]) {
        if (b < a) continue;
        const CycleVerdict verdict =
            BeginsCycle(closures[a], closures[b])
                ? CheckPlaced(options, reach, placed[a], placed[b])
                : CheckPlaced(options, reach, placed[b], placed[a]);
        if (verdict == CycleVerdict::kUninformative) continue;
        informative_[a].push_back({b, verdict});
        informative_[b].push_back({a, verdict});
      }
    }
  }

  // Adds the vote of closure k to what counts for and against its partners.
  void Vote(const size_t k, std::vector<SelectionResult>* const results) const {
    const double score = std::max(closures_[k].score, 0.);
    for (const auto& [partner, verdict] : informative_[k]) {
      SelectionResult& result = (*results)[partner];
      (verdict == CycleVerdict::kConsistent ? result.support
                                            : result.contradiction) += score;
    }
  }

 private:
  const std::vector<PairPose>& closures_;
  std::vector<std::vector<std::pair<size_t, CycleVerdict>>> informative_;
};

// By ids, so that sums round the same whatever the input order.
std::vector<size_t> OrderByIds(const std::vector<PairPose>& closures) {
  std::vector<size_t> order(closures.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](const size_t a, const size_t b) {
    return IsBeforeByIds(closures[a], closures[b]);
  });
  return order;
}

// Returns the closures by decreasing weight, score plus support. `order` is
// that by ids, `results` has the votes of all.
std::vector<size_t> OrderByWeight(const std::vector<PairPose>& closures,
                                  const std::vector<SelectionResult>& results,
                                  std::vector<size_t> order) {
  const auto weight = [&](const size_t k) {
    return closures[k].score + results[k].support - results[k].contradiction;
  };
  std::stable_sort(
      order.begin(), order.end(),
      [&](const size_t a, const size_t b) { return weight(a) > weight(b); });
  return order;
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
  // Where the cycle begins and in which direction it runs is fixed, as its
  // covariance depends on it.
  const PlacedClosure a = PlaceByOdometry(odometry, one);
  const PlacedClosure b = PlaceByOdometry(odometry, other);
  const double reach = std::numeric_limits<double>::infinity();
  return BeginsCycle(one, other) ? CheckPlaced(options, reach, a, b)
                                 : CheckPlaced(options, reach, b, a);
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
  std::vector<size_t> by_ids = OrderByIds(closures_);
  std::vector<SelectionResult> results;
  for (size_t k = 0; k < closures_.size(); ++k) {
    results.push_back(Weigh(k, by_ids));
  }
  return OrderByWeight(closures_, results, std::move(by_ids));
}

std::vector<SelectionResult> SelectConsistent(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<PairPose>& closures) {
  CHECK_EQ(Validate(options), "");
  const SparseVerdicts verdicts(options, odometry, closures);
  const std::vector<SelectionResult> no_votes(
      closures.size(), SelectionResult{Selection::kSelected});
  std::vector<size_t> by_ids = OrderByIds(closures);
  std::vector<SelectionResult> of_all = no_votes;
  for (const size_t k : by_ids) verdicts.Vote(k, &of_all);
  std::vector<size_t> chosen;
  std::vector<SelectionResult> results(closures.size());
  std::vector<SelectionResult> of_chosen = no_votes;
  for (const size_t k : OrderByWeight(closures, of_all, std::move(by_ids))) {
    results[k] = of_chosen[k];
    if (results[k].contradiction > results[k].support) {
      results[k].selection = Selection::kInconsistent;
    } else {
      chosen.push_back(k);
      verdicts.Vote(k, &of_chosen);
    }
  }
  for (const size_t k : chosen) {
    results[k] = of_chosen[k];
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
