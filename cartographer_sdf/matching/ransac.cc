// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/ransac.h"

#include <cmath>
#include <random>
#include <utility>

#include "cartographer_sdf/geometry/alignment.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// The points of the correspondences, side by side.
struct PointPairs {
  std::vector<Eigen::Vector2d> p_reference;
  std::vector<Eigen::Vector2d> p_query;
};

PointPairs CollectPoints(const FeatureSet& reference, const FeatureSet& query,
                         const std::vector<Correspondence>& correspondences) {
  PointPairs pairs;
  for (const Correspondence& c : correspondences) {
    pairs.p_reference.push_back(
        reference.features[c.reference].keypoint.position);
    pairs.p_query.push_back(query.features[c.query].keypoint.position);
  }
  return pairs;
}

int CountAgreeing(const PointPairs& pairs, const Rigid2& T_reference_query,
                  const double max_distance) {
  const Eigen::Matrix2d R = T_reference_query.RotationMatrix();
  int count = 0;
  for (size_t k = 0; k < pairs.p_query.size(); ++k) {
    count += (R * pairs.p_query[k] + T_reference_query.translation() -
              pairs.p_reference[k])
                 .squaredNorm() <= max_distance * max_distance;
  }
  return count;
}

// Selects the correspondences that agree, each keypoint used once: earlier
// correspondences first.
std::vector<Correspondence> SelectInliers(
    const RansacOptions& options, const FeatureSet& reference,
    const FeatureSet& query, const std::vector<Correspondence>& correspondences,
    const Rigid2& T_reference_query) {
  std::vector<Correspondence> inliers;
  const auto same = [](const Feature& a, const Feature& b) {
    return a.keypoint.position == b.keypoint.position;
  };
  for (const Correspondence& c : correspondences) {
    const Feature& r = reference.features[c.reference];
    const Feature& q = query.features[c.query];
    if ((T_reference_query * q.keypoint.position - r.keypoint.position).norm() >
        options.inlier_distance_meters) {
      continue;
    }
    bool used = false;
    for (const Correspondence& other : inliers) {
      used = used || same(reference.features[other.reference], r) ||
             same(query.features[other.query], q);
    }
    if (!used) inliers.push_back(c);
  }
  return inliers;
}

// All pairs (a, b) with a < b in order, or `max_num_pairs` random ones if there
// are more.
class PairSequence {
 public:
  PairSequence(const int num_items, const int max_num_pairs,
               const uint64_t seed)
      : num_items_(num_items),
        exhaustive_(static_cast<int64_t>(num_items) * (num_items - 1) / 2 <=
                    max_num_pairs),
        remaining_(max_num_pairs),
        generator_(seed) {}

  // Returns false when no pair is left.
  bool Next(std::pair<int, int>* const pair) {
    if (exhaustive_) {
      if (++pair_.second >= num_items_) {
        ++pair_.first;
        pair_.second = pair_.first + 1;
      }
      *pair = pair_;
      return pair_.second < num_items_;
    }
    pair->first = Draw(num_items_);
    pair->second = Draw(num_items_ - 1);
    pair->second += pair->second >= pair->first;
    return remaining_-- > 0;
  }

 private:
  // Uniform to within 2^-32; the standard's distributions differ between
  // libraries.
  int Draw(const int bound) {
    return static_cast<int>(((generator_() >> 32) * bound) >> 32);
  }

  const int num_items_;
  const bool exhaustive_;
  int remaining_;
  std::pair<int, int> pair_ = {0, 0};
  std::mt19937_64 generator_;
};

std::optional<Rigid2> AlignSegments(const RansacOptions& options,
                                    const PointPairs& pairs, const int a,
                                    const int b) {
  const Eigen::Vector2d query = pairs.p_query[b] - pairs.p_query[a];
  const Eigen::Vector2d reference = pairs.p_reference[b] - pairs.p_reference[a];
  const double length = query.norm();
  if (length < options.min_baseline_meters ||
      reference.norm() < options.min_baseline_meters ||
      std::abs(reference.norm() - length) >
          2. * options.inlier_distance_meters) {
    return std::nullopt;
  }
  const double rotation = std::atan2(reference.y(), reference.x()) -
                          std::atan2(query.y(), query.x());
  const Eigen::Vector2d middle = 0.5 * (pairs.p_query[a] + pairs.p_query[b]);
  return Rigid2(0.5 * (pairs.p_reference[a] + pairs.p_reference[b]) -
                    Eigen::Rotation2Dd(rotation) * middle,
                rotation);
}

Rigid2 LeastSquares(const FeatureSet& reference, const FeatureSet& query,
                    const std::vector<Correspondence>& inliers,
                    const Rigid2& otherwise) {
  const PointPairs pairs = CollectPoints(reference, query, inliers);
  return AlignPointPairs(pairs.p_reference, pairs.p_query).value_or(otherwise);
}

}  // namespace

std::string Validate(const RansacOptions& options) {
  if (options.max_num_iterations < 1 ||
      options.max_num_iterations > 100000000) {
    return "max_num_iterations must lie between 1 and 1e8";
  }
  if (!(options.inlier_distance_meters > 0.)) {
    return "inlier_distance_meters must be positive";
  }
  if (!(options.min_baseline_meters > 0.)) {
    return "min_baseline_meters must be positive";
  }
  return "";
}

std::optional<Alignment> AlignByRansac(
    const RansacOptions& options, const FeatureSet& reference,
    const FeatureSet& query, const std::vector<Correspondence>& correspondences,
    const uint64_t seed) {
  CHECK_EQ(Validate(options), "");
  if (correspondences.size() < 2) return std::nullopt;
  const PointPairs pairs = CollectPoints(reference, query, correspondences);
  PairSequence sequence(static_cast<int>(correspondences.size()),
                        options.max_num_iterations, seed);
  std::optional<Rigid2> best;
  int best_count = 1;
  for (std::pair<int, int> pair; sequence.Next(&pair);) {
    const std::optional<Rigid2> T_reference_query =
        AlignSegments(options, pairs, pair.first, pair.second);
    if (!T_reference_query) continue;
    const int count = CountAgreeing(pairs, *T_reference_query,
                                    options.inlier_distance_meters);
    if (count > best_count) {
      best_count = count;
      best = T_reference_query;
    }
  }
  if (!best) return std::nullopt;
  Alignment alignment;
  alignment.inliers =
      SelectInliers(options, reference, query, correspondences, *best);
  if (alignment.inliers.size() < 2) return std::nullopt;
  alignment.T_reference_query =
      LeastSquares(reference, query, alignment.inliers, *best);
  return alignment;
}

}  // namespace cartographer_sdf
