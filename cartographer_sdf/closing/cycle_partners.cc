// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/cycle_partners.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace cartographer_sdf {
namespace {

// Beyond this, odometry has no error worth the name [m].
constexpr double kEndlessDrive = 1e9;
// Covers the rounding of the cycle's sigma.
constexpr double kReachMargin = 1. + 1e-6;

// A stretch of a trajectory, counted in whole numbers; a double, as a hostile
// map may drive farther than an integer counts.
struct Stretch {
  int trajectory;
  double number;

  friend bool operator<(const Stretch& a, const Stretch& b) {
    return std::tie(a.trajectory, a.number) < std::tie(b.trajectory, b.number);
  }
};

// The stretches on which the lower and the higher end of a closure lie.
using Cell = std::pair<Stretch, Stretch>;

class Cells {
 public:
  Cells(const double reach, const std::map<SubmapId, OdometryPose>& odometry,
        const std::vector<PairPose>& closures) {
    cell_of_.reserve(closures.size());
    for (size_t k = 0; k < closures.size(); ++k) {
      const auto& [lower, higher] =
          std::minmax(closures[k].reference, closures[k].query);
      cell_of_.emplace_back(StretchOf(reach, lower, odometry.at(lower)),
                            StretchOf(reach, higher, odometry.at(higher)));
      members_[cell_of_.back()].push_back(k);
    }
    for (auto& [cell, members] : members_) KeepWeightiest(closures, &members);
  }

  // Appends the closures whose ends lie on the stretches of closure k or beside
  // them, in either direction.
  void AppendNear(const size_t k, std::vector<size_t>* const near) const {
    const auto& [lower, higher] = cell_of_[k];
    for (const double a : {-1., 0., 1.}) {
      for (const double b : {-1., 0., 1.}) {
        const Stretch near_lower{lower.trajectory, lower.number + a};
        const Stretch near_higher{higher.trajectory, higher.number + b};
        Append({near_lower, near_higher}, near);
        Append({near_higher, near_lower}, near);
      }
    }
  }

 private:
  static Stretch StretchOf(const double reach, const SubmapId& id,
                           const OdometryPose& pose) {
    return {id.trajectory, std::floor(pose.distance_driven / reach)};
  }

  static void KeepWeightiest(const std::vector<PairPose>& closures,
                             std::vector<size_t>* const members) {
    if (members->size() <= kMaxNumClosuresPerCell) return;
    std::sort(members->begin(), members->end(),
              [&closures](const size_t a, const size_t b) {
                return IsBeforeByScore(closures[a], closures[b]);
              });
    members->resize(kMaxNumClosuresPerCell);
  }

  void Append(const Cell& cell, std::vector<size_t>* const near) const {
    const auto members = members_.find(cell);
    if (members == members_.end()) return;
    near->insert(near->end(), members->second.begin(), members->second.end());
  }

  std::vector<Cell> cell_of_;
  std::map<Cell, std::vector<size_t>> members_;
};

void SortAndRemoveDuplicates(std::vector<size_t>* const indices) {
  std::sort(indices->begin(), indices->end());
  indices->erase(std::unique(indices->begin(), indices->end()), indices->end());
}

}  // namespace

double DrivenReach(const ConsistencyOptions& options) {
  // The cycle contains two closures, and odometry at both pairs of ends.
  const double squared =
      std::pow(options.max_cycle_sigma_meters, 2) -
      2. * std::pow(options.closure_translation_sigma_meters, 2);
  if (squared < 0.) return 0.;
  const double max_sigma = std::sqrt(squared);
  double within = 0., beyond = kEndlessDrive;
  if (DriftSigma(options, beyond) <= max_sigma) {
    return std::numeric_limits<double>::infinity();
  }
  // The sigma grows with the distance.
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (within + beyond);
    (DriftSigma(options, middle) <= max_sigma ? within : beyond) = middle;
  }
  return kReachMargin * beyond;
}

std::vector<std::vector<size_t>> FindCyclePartners(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<PairPose>& closures) {
  std::vector<std::vector<size_t>> partners(closures.size());
  const double reach = DrivenReach(options);
  if (!(reach > 0.)) return partners;
  const Cells cells(reach, odometry, closures);
  for (size_t k = 0; k < closures.size(); ++k) {
    std::vector<size_t> near;
    cells.AppendNear(k, &near);
    for (const size_t other : near) {
      if (other == k) continue;
      partners[k].push_back(other);
      partners[other].push_back(k);
    }
  }
  for (std::vector<size_t>& indices : partners) {
    SortAndRemoveDuplicates(&indices);
  }
  return partners;
}

}  // namespace cartographer_sdf
