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

// Total weight and weighted means of the pairs.
struct PairMeans {
  double total_weight = 0.;
  Eigen::Vector2d reference = Eigen::Vector2d::Zero();
  Eigen::Vector2d query = Eigen::Vector2d::Zero();
};

struct PairMoments {
  // Weighted sums of the products of the centred query and reference.
  double dot = 0.;
  double cross = 0.;
  // Weighted sums of squares of the centred points.
  double spread_reference = 0.;
  double spread_query = 0.;
  // Largest norm of a point; rounding errors scale with it.
  double size = 0.;
};

double WeightOf(const std::vector<double>& weights, const size_t k) {
  return weights.empty() ? 1. : weights[k];
}

std::optional<PairMeans> FindMeans(
    const std::vector<Eigen::Vector2d>& p_reference,
    const std::vector<Eigen::Vector2d>& p_query,
    const std::vector<double>& weights) {
  PairMeans means;
  for (size_t k = 0; k < p_query.size(); ++k) {
    const double weight = WeightOf(weights, k);
    CHECK_GE(weight, 0.);
    means.total_weight += weight;
    means.reference += weight * p_reference[k];
    means.query += weight * p_query[k];
  }
  if (!(means.total_weight > 0.)) return std::nullopt;
  means.reference /= means.total_weight;
  means.query /= means.total_weight;
  return means;
}

PairMoments FindMoments(const std::vector<Eigen::Vector2d>& p_reference,
                        const std::vector<Eigen::Vector2d>& p_query,
                        const std::vector<double>& weights,
                        const PairMeans& means) {
  PairMoments moments;
  for (size_t k = 0; k < p_query.size(); ++k) {
    const double weight = WeightOf(weights, k);
    const Eigen::Vector2d r = p_reference[k] - means.reference;
    const Eigen::Vector2d q = p_query[k] - means.query;
    moments.dot += weight * q.dot(r);
    moments.cross += weight * (q.x() * r.y() - q.y() * r.x());
    moments.spread_reference += weight * r.squaredNorm();
    moments.spread_query += weight * q.squaredNorm();
    moments.size =
        std::max({moments.size, p_reference[k].norm(), p_query[k].norm()});
  }
  return moments;
}

// Whether the rotation stands out from rounding errors.
bool HasRotation(const PairMoments& moments, const double total_weight) {
  // A centred coordinate is off by up to `size` times the rounding.
  const double noise = kRounding * moments.size;
  const double spread =
      std::sqrt(moments.spread_reference * moments.spread_query);
  return moments.spread_reference > total_weight * noise * noise &&
         moments.spread_query > total_weight * noise * noise &&
         std::hypot(moments.dot, moments.cross) >
             kRounding * spread + noise * std::sqrt(total_weight * spread);
}

}  // namespace

std::optional<Rigid2> AlignPointPairs(
    const std::vector<Eigen::Vector2d>& p_reference,
    const std::vector<Eigen::Vector2d>& p_query,
    const std::vector<double>& weights) {
  CHECK_EQ(p_reference.size(), p_query.size());
  CHECK(weights.empty() || weights.size() == p_query.size());
  const std::optional<PairMeans> means =
      FindMeans(p_reference, p_query, weights);
  if (!means) return std::nullopt;
  const PairMoments moments =
      FindMoments(p_reference, p_query, weights, *means);
  if (!HasRotation(moments, means->total_weight)) return std::nullopt;
  // The optimal rotation is the direction of (dot, cross).
  const Rigid2 R_reference_query(Eigen::Vector2d::Zero(),
                                 std::atan2(moments.cross, moments.dot));
  return Rigid2(means->reference - R_reference_query * means->query,
                R_reference_query.rotation());
}

}  // namespace cartographer_sdf
