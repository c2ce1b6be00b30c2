// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/geometry/alignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Correlations below this fraction of what the coordinates' size allows are
// rounding errors of the centred coordinates.
constexpr double kRounding = 64. * std::numeric_limits<double>::epsilon();

}  // namespace

std::optional<Rigid2> AlignPointPairs(
    const std::vector<Eigen::Vector2d>& p_reference,
    const std::vector<Eigen::Vector2d>& p_query,
    const std::vector<double>& weights) {
  CHECK_EQ(p_reference.size(), p_query.size());
  CHECK(weights.empty() || weights.size() == p_query.size());
  const auto weight = [&weights](const size_t k) {
    return weights.empty() ? 1. : weights[k];
  };

  double total = 0.;
  Eigen::Vector2d mean_reference = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_query = Eigen::Vector2d::Zero();
  for (size_t k = 0; k < p_query.size(); ++k) {
    CHECK_GE(weight(k), 0.);
    total += weight(k);
    mean_reference += weight(k) * p_reference[k];
    mean_query += weight(k) * p_query[k];
  }
  if (!(total > 0.)) {
    return std::nullopt;
  }
  mean_reference /= total;
  mean_query /= total;

  // The optimal rotation is the direction of (dot, cross).
  double dot = 0.;
  double cross = 0.;
  double size = 0.;
  double spread_reference = 0.;
  double spread_query = 0.;
  for (size_t k = 0; k < p_query.size(); ++k) {
    const Eigen::Vector2d r = p_reference[k] - mean_reference;
    const Eigen::Vector2d q = p_query[k] - mean_query;
    dot += weight(k) * q.dot(r);
    cross += weight(k) * (q.x() * r.y() - q.y() * r.x());
    spread_reference += weight(k) * r.squaredNorm();
    spread_query += weight(k) * q.squaredNorm();
    size = std::max({size, p_reference[k].norm(), p_query[k].norm()});
  }
  // A centred coordinate is off by up to `size` times the rounding.
  const double noise = kRounding * size;
  const double spread = std::sqrt(spread_reference * spread_query);
  if (!(spread_reference > total * noise * noise) ||
      !(spread_query > total * noise * noise) ||
      !(std::hypot(dot, cross) >
        kRounding * spread + noise * std::sqrt(total * spread))) {
    return std::nullopt;
  }
  const Rigid2 R_reference_query(Eigen::Vector2d::Zero(),
                                 std::atan2(cross, dot));
  return Rigid2(mean_reference - R_reference_query * mean_query,
                R_reference_query.rotation());
}

}  // namespace cartographer_sdf
