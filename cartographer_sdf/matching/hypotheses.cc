// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A correspondence made ready for pairing: the query point relative to the
// middle of the query's keypoints.
struct Candidate {
  Eigen::Vector2f p_reference;
  Eigen::Vector2f p_query;
  float rotation;  // that the orientations imply, (-pi, pi]
};

Eigen::Vector2d MiddleOfKeypoints(const FeatureSet& set) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Feature& feature : set.features) sum += feature.keypoint.position;
  return sum / static_cast<double>(set.features.size());
}

// The best correspondences, ordered by rotation.
std::vector<Candidate> SelectCandidates(
    const HypothesisOptions& options, const FeatureSet& reference,
    const FeatureSet& query, const Eigen::Vector2d& middle,
    std::vector<Correspondence> correspondences) {
  const auto nearer = [](const Correspondence& a, const Correspondence& b) {
    return std::tie(a.descriptor_distance, a.query, a.reference) <
           std::tie(b.descriptor_distance, b.query, b.reference);
  };
  const size_t count =
      std::min(correspondences.size(),
               static_cast<size_t>(options.max_num_correspondences));
  std::nth_element(correspondences.begin(), correspondences.begin() + count,
                   correspondences.end(), nearer);
  correspondences.resize(count);
  std::vector<std::pair<float, size_t>> order;
  std::vector<Candidate> unordered;
  std::sort(correspondences.begin(), correspondences.end(), nearer);
  for (const Correspondence& c : correspondences) {
    const Feature& r = reference.features[c.reference];
    const Feature& q = query.features[c.query];
    const float rotation =
        static_cast<float>(NormalizeAngle(r.orientation - q.orientation));
    order.emplace_back(rotation, unordered.size());
    unordered.push_back({r.keypoint.position.cast<float>(),
                         (q.keypoint.position - middle).cast<float>(),
                         rotation});
  }
  std::sort(order.begin(), order.end());
  std::vector<Candidate> candidates;
  for (const auto& entry : order) candidates.push_back(unordered[entry.second]);
  return candidates;
}

// A pose that takes the middle of the query's keypoints to `translation`.
struct Vote {
  uint64_t bin;
  float x, y, rotation;
};

constexpr float kPi = static_cast<float>(M_PI);

float WrapAngle(float angle) {
  while (angle > kPi) angle -= 2.f * kPi;
  while (angle <= -kPi) angle += 2.f * kPi;
  return angle;
}

class VoteSpace {
 public:
  explicit VoteSpace(const HypothesisOptions& options)
      : distance_(static_cast<float>(options.cluster_distance_meters)),
        num_rotations_(std::max(
            1, static_cast<int>(2. * M_PI / options.cluster_rotation))) {}

  // The rotation lies in [-pi, pi]. No bin spans the cut at pi, so that means
  // within a bin are means.
  Vote MakeVote(const float x, const float y, const float rotation) const {
    const int bin = static_cast<int>((rotation + kPi) / (2.f * kPi) *
                                     static_cast<float>(num_rotations_));
    return {(Along(x) << 42) | (Along(y) << 20) |
                static_cast<uint64_t>(std::min(bin, num_rotations_ - 1)),
            x, y, rotation};
  }

 private:
  // 22 bits; all that is absurdly far off is one.
  uint64_t Along(const float coordinate) const {
    constexpr float kOffset = 1 << 20;
    return static_cast<uint64_t>(std::clamp(
        std::floor(coordinate / distance_) + kOffset, 0.f, 2.f * kOffset));
  }

  const float distance_;
  const int num_rotations_;
};

std::vector<Vote> CollectVotes(const HypothesisOptions& options,
                               const std::vector<Candidate>& candidates,
                               const VoteSpace& space) {
  const float max_length =
      static_cast<float>(options.max_length_difference_meters);
  const float max_rotation =
      static_cast<float>(options.max_orientation_difference);
  const float min_squared = static_cast<float>(options.min_baseline_meters *
                                               options.min_baseline_meters);
  std::vector<Vote> votes;
  const size_t n = candidates.size();
  for (size_t a = 0; a < n; ++a) {
    const Candidate& first = candidates[a];
    // Those that follow in rotation, around the circle.
    for (size_t step = 1; step < n; ++step) {
      const size_t b = a + step < n ? a + step : a + step - n;
      const Candidate& second = candidates[b];
      const float apart =
          second.rotation - first.rotation + (a + step < n ? 0.f : 2.f * kPi);
      if (apart > max_rotation) break;
      const Eigen::Vector2f query = second.p_query - first.p_query;
      const Eigen::Vector2f reference = second.p_reference - first.p_reference;
      const float q2 = query.squaredNorm(), r2 = reference.squaredNorm();
      if (q2 < min_squared || r2 < min_squared) continue;
      if (std::abs(std::sqrt(q2) - std::sqrt(r2)) > max_length) continue;
      const float dot = query.dot(reference);
      const float cross = query.x() * reference.y() - query.y() * reference.x();
      const float rotation = std::atan2(cross, dot);
      if (std::abs(WrapAngle(rotation - first.rotation)) > max_rotation ||
          std::abs(WrapAngle(rotation - second.rotation)) > max_rotation) {
        continue;
      }
      const float norm = std::sqrt(dot * dot + cross * cross);
      const float c = dot / norm, s = cross / norm;
      const Eigen::Vector2f q = 0.5f * (first.p_query + second.p_query);
      const Eigen::Vector2f r = 0.5f * (first.p_reference + second.p_reference);
      const float x = r.x() - (c * q.x() - s * q.y());
      const float y = r.y() - (s * q.x() + c * q.y());
      votes.push_back(space.MakeVote(x, y, rotation));
    }
  }
  return votes;
}

struct Cluster {
  uint64_t bin;
  int count;
  float x, y, rotation;  // means
};

// One cluster a bin, in the order of the bins.
std::vector<Cluster> ClusterVotes(std::vector<Vote> votes) {
  std::sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) {
    return std::tie(a.bin, a.x, a.y, a.rotation) <
           std::tie(b.bin, b.x, b.y, b.rotation);
  });
  std::vector<Cluster> clusters;
  for (size_t begin = 0; begin < votes.size();) {
    size_t end = begin;
    float x = 0.f, y = 0.f, rotation = 0.f;
    for (; end < votes.size() && votes[end].bin == votes[begin].bin; ++end) {
      x += votes[end].x;
      y += votes[end].y;
      rotation += votes[end].rotation;
    }
    const float n = static_cast<float>(end - begin);
    clusters.push_back({votes[begin].bin, static_cast<int>(end - begin), x / n,
                        y / n, rotation / n});
    begin = end;
  }
  return clusters;
}

}  // namespace

std::string Validate(const HypothesisOptions& options) {
  if (options.max_num_hypotheses < 1 || options.max_num_correspondences < 2 ||
      options.max_num_correspondences > 10000) {
    return "hypotheses.max_num_hypotheses must be positive and "
           "hypotheses.max_num_correspondences lie between 2 and 10000";
  }
  if (!(options.max_length_difference_meters > 0. &&
        options.max_orientation_difference > 0. &&
        options.max_orientation_difference < M_PI)) {
    return "hypotheses.max_length_difference_meters must be positive and "
           "hypotheses.max_orientation_difference lie between 0 and pi";
  }
  if (!(options.min_baseline_meters > 0. &&
        options.cluster_distance_meters >= 0.01 &&
        options.cluster_rotation >= 1e-4)) {
    return "hypotheses.min_baseline_meters must be positive, "
           "hypotheses.cluster_distance_meters at least 0.01 and "
           "hypotheses.cluster_rotation at least 0.0001";
  }
  return "";
}

std::vector<Hypothesis> ProposeHypotheses(
    const HypothesisOptions& options, const FeatureSet& reference,
    const FeatureSet& query,
    const std::vector<Correspondence>& correspondences) {
  CHECK_EQ(Validate(options), "");
  if (correspondences.size() < 2) return {};
  const Eigen::Vector2d middle = MiddleOfKeypoints(query);
  const VoteSpace space(options);
  std::vector<Cluster> clusters = ClusterVotes(CollectVotes(
      options,
      SelectCandidates(options, reference, query, middle, correspondences),
      space));
  const size_t count = std::min(
      clusters.size(), static_cast<size_t>(options.max_num_hypotheses));
  std::partial_sort(clusters.begin(), clusters.begin() + count, clusters.end(),
                    [](const Cluster& a, const Cluster& b) {
                      return a.count != b.count ? a.count > b.count
                                                : a.bin < b.bin;
                    });
  std::vector<Hypothesis> hypotheses;
  for (size_t k = 0; k < count; ++k) {
    const Cluster& cluster = clusters[k];
    const double rotation = cluster.rotation;
    hypotheses.push_back({Rigid2(Eigen::Vector2d(cluster.x, cluster.y) -
                                     Eigen::Rotation2Dd(rotation) * middle,
                                 rotation),
                          static_cast<double>(cluster.count)});
  }
  return hypotheses;
}

}  // namespace cartographer_sdf
