// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/pose_voter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr float kPi = static_cast<float>(M_PI);

float WrapAngle(float angle) {
  while (angle > kPi) angle -= 2.f * kPi;
  while (angle <= -kPi) angle += 2.f * kPi;
  return angle;
}

class PoseRaster {
 public:
  explicit PoseRaster(const PoseBinOptions& options)
      : pitch_(static_cast<float>(options.distance_meters)),
        num_rotations_(
            std::max(1, static_cast<int>(2. * M_PI / options.rotation))) {}

  // The rotation lies in [-pi, pi]. No bin spans the cut at pi, so that the
  // mean of a bin's rotations is their mean direction.
  [[nodiscard]] uint64_t BinAt(const float x, const float y,
                               const float rotation) const {
    const int bin = static_cast<int>((rotation + kPi) / (2.f * kPi) *
                                     static_cast<float>(num_rotations_));
    return (Along(x) << 42) | (Along(y) << 20) |
           static_cast<uint64_t>(std::min(bin, num_rotations_ - 1));
  }

 private:
  // 22 bits; all coordinates out of range share the outermost bins.
  [[nodiscard]] uint64_t Along(const float coordinate) const {
    constexpr float kOffset = 1 << 20;
    return static_cast<uint64_t>(std::clamp(
        std::floor(coordinate / pitch_) + kOffset, 0.f, 2.f * kOffset));
  }

  const float pitch_;
  const int num_rotations_;
};

// Computes the vote of a pair of correspondences; nullopt if they do not agree.
class PairVoter {
 public:
  explicit PairVoter(const PoseVotingOptions& options)
      : max_length_(static_cast<float>(options.max_length_difference_meters)),
        max_rotation_(static_cast<float>(options.max_orientation_difference)),
        min_squared_length_(static_cast<float>(options.min_baseline_meters *
                                               options.min_baseline_meters)) {}

  [[nodiscard]] float max_rotation() const { return max_rotation_; }

  [[nodiscard]] std::optional<PoseVote> operator()(
      const WeightedCorrespondence& first,
      const WeightedCorrespondence& second) const {
    const Eigen::Vector2f query = second.p_centroid - first.p_centroid;
    const Eigen::Vector2f reference = second.p_reference - first.p_reference;
    const float q2 = query.squaredNorm(), r2 = reference.squaredNorm();
    if (!(q2 >= min_squared_length_ && r2 >= min_squared_length_) ||
        std::abs(std::sqrt(q2) - std::sqrt(r2)) > max_length_) {
      return std::nullopt;
    }
    const float dot = query.dot(reference);
    const float cross = query.x() * reference.y() - query.y() * reference.x();
    const float rotation = std::atan2(cross, dot);
    if (std::abs(WrapAngle(rotation - first.rotation)) > max_rotation_ ||
        std::abs(WrapAngle(rotation - second.rotation)) > max_rotation_) {
      return std::nullopt;
    }
    const float norm = std::sqrt(dot * dot + cross * cross);
    const float c = dot / norm, s = cross / norm;
    const Eigen::Vector2f q = 0.5f * (first.p_centroid + second.p_centroid);
    const Eigen::Vector2f r = 0.5f * (first.p_reference + second.p_reference);
    const float x = r.x() - (c * q.x() - s * q.y());
    const float y = r.y() - (s * q.x() + c * q.y());
    return PoseVote{x, y, rotation, first.weight * second.weight};
  }

 private:
  const float max_length_;
  const float max_rotation_;
  const float min_squared_length_;
};

// `correspondences` are ordered by rotation.
std::vector<PoseVote> CollectVotes(
    const PoseVotingOptions& options,
    const std::vector<WeightedCorrespondence>& correspondences) {
  const PairVoter vote_of(options);
  std::vector<PoseVote> votes;
  const size_t n = correspondences.size();
  for (size_t a = 0; a < n; ++a) {
    // Correspondences that follow in rotation, around the circle.
    for (size_t step = 1; step < n; ++step) {
      const bool wraps = a + step >= n;
      const WeightedCorrespondence& second =
          correspondences[wraps ? a + step - n : a + step];
      if (second.rotation - correspondences[a].rotation +
              (wraps ? 2.f * kPi : 0.f) >
          vote_of.max_rotation()) {
        break;
      }
      const std::optional<PoseVote> vote = vote_of(correspondences[a], second);
      if (vote) votes.push_back(*vote);
    }
  }
  return votes;
}

// A bin with its total weight and the weighted mean of its votes.
struct Cluster {
  uint64_t bin;
  float weight;
  float x, y, rotation;
};

std::vector<Cluster> ClusterVotes(const PoseBinOptions& options,
                                  const std::vector<PoseVote>& votes) {
  const PoseRaster raster(options);
  std::vector<std::pair<uint64_t, PoseVote>> binned;
  binned.reserve(votes.size());
  for (const PoseVote& vote : votes) {
    binned.emplace_back(raster.BinAt(vote.x, vote.y, vote.rotation), vote);
  }
  // Sorted, so that sums round the same whatever the order of the votes.
  const auto key = [](const std::pair<uint64_t, PoseVote>& item) {
    const PoseVote& vote = item.second;
    return std::tie(item.first, vote.x, vote.y, vote.rotation, vote.weight);
  };
  std::sort(binned.begin(), binned.end(),
            [&key](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<Cluster> clusters;
  for (size_t begin = 0; begin < binned.size();) {
    Cluster sum{binned[begin].first, 0.f, 0.f, 0.f, 0.f};
    size_t end = begin;
    for (; end < binned.size() && binned[end].first == sum.bin; ++end) {
      const PoseVote& vote = binned[end].second;
      sum.weight += vote.weight;
      sum.x += vote.weight * vote.x;
      sum.y += vote.weight * vote.y;
      sum.rotation += vote.weight * vote.rotation;
    }
    clusters.push_back({sum.bin, sum.weight, sum.x / sum.weight,
                        sum.y / sum.weight, sum.rotation / sum.weight});
    begin = end;
  }
  return clusters;
}

}  // namespace

std::string Validate(const PoseBinOptions& options) {
  if (!(options.distance_meters >= 0.01 && options.rotation >= 1e-4)) {
    return "distance_meters must be at least 0.01 and rotation at least 0.0001";
  }
  return "";
}

std::string Validate(const PoseVotingOptions& options) {
  if (options.max_num_correspondences < 2 ||
      options.max_num_correspondences > 10000) {
    return "max_num_correspondences must lie between 2 and 10000";
  }
  if (!(options.max_length_difference_meters > 0. &&
        options.max_orientation_difference > 0. &&
        options.max_orientation_difference < M_PI)) {
    return "max_length_difference_meters must be positive and "
           "max_orientation_difference lie between 0 and pi";
  }
  if (!(options.min_baseline_meters > 0.)) {
    return "min_baseline_meters must be positive";
  }
  return Validate(options.bins);
}

std::string Validate(const HypothesisOptions& options) {
  if (options.max_num_hypotheses < 1) {
    return "max_num_hypotheses must be positive";
  }
  return Validate(options.votes);
}

Eigen::Vector2d KeypointCentroid(const FeatureSet& features) {
  CHECK(!features.features.empty());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Feature& feature : features.features) {
    sum += feature.keypoint.position;
  }
  return sum / static_cast<double>(features.features.size());
}

std::vector<VotedPose> HeaviestPoses(const PoseBinOptions& options,
                                     const int max_num_poses,
                                     const Eigen::Vector2d& centroid,
                                     const std::vector<PoseVote>& votes) {
  CHECK_EQ(Validate(options), "");
  std::vector<Cluster> clusters = ClusterVotes(options, votes);
  const size_t count =
      std::min(clusters.size(), static_cast<size_t>(max_num_poses));
  std::partial_sort(
      clusters.begin(), clusters.begin() + static_cast<std::ptrdiff_t>(count),
      clusters.end(), [](const Cluster& a, const Cluster& b) {
        return a.weight != b.weight ? a.weight > b.weight : a.bin < b.bin;
      });
  std::vector<VotedPose> poses;
  for (size_t k = 0; k < count; ++k) {
    const Cluster& cluster = clusters[k];
    const double rotation = cluster.rotation;
    poses.push_back({Rigid2(Eigen::Vector2d(cluster.x, cluster.y) -
                                Eigen::Rotation2Dd(rotation) * centroid,
                            rotation),
                     cluster.weight});
  }
  return poses;
}

std::vector<VotedPose> VotePoses(
    const PoseVotingOptions& options, const int max_num_poses,
    const Eigen::Vector2d& centroid,
    std::vector<WeightedCorrespondence> correspondences) {
  CHECK_EQ(Validate(options), "");
  correspondences.resize(
      std::min(correspondences.size(),
               static_cast<size_t>(options.max_num_correspondences)));
  std::stable_sort(
      correspondences.begin(), correspondences.end(),
      [](const WeightedCorrespondence& a, const WeightedCorrespondence& b) {
        return a.rotation < b.rotation;
      });
  return HeaviestPoses(options.bins, max_num_poses, centroid,
                       CollectVotes(options, correspondences));
}

std::vector<Rigid2> ProposePoses(const HypothesisOptions& options,
                                 const FeatureSet& reference,
                                 const FeatureSet& query,
                                 std::vector<Correspondence> correspondences) {
  CHECK_EQ(Validate(options), "");
  if (correspondences.size() < 2) return {};
  const Eigen::Vector2d centroid = KeypointCentroid(query);
  const auto middle =
      correspondences.begin() +
      static_cast<std::ptrdiff_t>(
          std::min(correspondences.size(),
                   static_cast<size_t>(options.votes.max_num_correspondences)));
  std::partial_sort(
      correspondences.begin(), middle, correspondences.end(),
      [](const Correspondence& a, const Correspondence& b) {
        return std::tie(a.descriptor_distance, a.query, a.reference) <
               std::tie(b.descriptor_distance, b.query, b.reference);
      });
  std::vector<WeightedCorrespondence> weighted;
  for (auto c = correspondences.begin(); c != middle; ++c) {
    const Feature& r = reference.features[c->reference];
    const Feature& q = query.features[c->query];
    weighted.push_back(
        {r.keypoint.position.cast<float>(),
         (q.keypoint.position - centroid).cast<float>(),
         static_cast<float>(NormalizeAngle(r.orientation - q.orientation)),
         1.f});
  }
  std::vector<Rigid2> poses;
  for (const VotedPose& pose :
       VotePoses(options.votes, options.max_num_hypotheses, centroid,
                 std::move(weighted))) {
    poses.push_back(pose.T_reference_query);
  }
  return poses;
}

}  // namespace cartographer_sdf
