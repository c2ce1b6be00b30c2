// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/retrieval/pose_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <tuple>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr float kPi = static_cast<float>(M_PI);

struct Vote {
  float x, y;
  float rotation;  // [-pi, pi]
  float weight;
};

// A bin of the raster of poses and its share of the votes' weight.
struct Bin {
  int x, y, rotation;
  float weight;
};

// A sparse raster of poses: bin (i, j, k) has its centre at i and j times the
// pitch, and at k times the pitch of rotations from -pi on.
class Raster {
 public:
  Raster(const PoseVoteOptions& options, const size_t num_votes)
      : pitch_(static_cast<float>(options.bin_distance_meters)),
        num_rotations_(static_cast<int>(
            std::max(3., std::ceil(2. * M_PI / options.bin_rotation)))) {
    // A vote touches eight bins at most, and the table stays half empty.
    while (table_.size() < 16 * num_votes) table_.resize(2 * table_.size(), -1);
  }

  void Add(const Vote& vote) {
    for (const auto& [bin, share] : Shares(vote)) {
      Find(bin.x, bin.y, bin.rotation)->weight += share * vote.weight;
    }
  }

  // The bin's share of a vote, in [0, 1].
  [[nodiscard]] float ShareOf(const Bin& bin, const Vote& vote) const {
    for (const auto& [touched, share] : Shares(vote)) {
      if (IsSame(touched, bin)) return share;
    }
    return 0.f;
  }

  // In the order in which they were first voted for.
  [[nodiscard]] const std::vector<Bin>& bins() const { return bins_; }
  [[nodiscard]] float RotationOf(const Bin& bin) const {
    return static_cast<float>(bin.rotation) * RotationPitch() - kPi;
  }
  [[nodiscard]] bool AreAdjacent(const Bin& a, const Bin& b) const {
    const int turned = std::abs(a.rotation - b.rotation);
    return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 &&
           (turned <= 1 || turned == num_rotations_ - 1);
  }

 private:
  [[nodiscard]] float RotationPitch() const {
    return 2.f * kPi / static_cast<float>(num_rotations_);
  }

  [[nodiscard]] static bool IsSame(const Bin& a, const Bin& b) {
    return a.x == b.x && a.y == b.y && a.rotation == b.rotation;
  }

  // Floor and remainder; all that is absurdly far off is one.
  [[nodiscard]] static std::pair<int, float> Split(const float coordinate) {
    constexpr float kLimit = 1 << 20;
    const float clamped = std::clamp(coordinate, -kLimit, kLimit);
    const float floor = std::floor(clamped);
    return {static_cast<int>(floor), clamped - floor};
  }

  // The eight bins around, the nearer the larger their share; sum 1.
  [[nodiscard]] std::array<std::pair<Bin, float>, 8> Shares(
      const Vote& vote) const {
    const auto [i, u] = Split(vote.x / pitch_);
    const auto [j, v] = Split(vote.y / pitch_);
    const auto [k, w] = Split((vote.rotation + kPi) / RotationPitch());
    std::array<std::pair<Bin, float>, 8> shares;
    for (int corner = 0; corner < 8; ++corner) {
      const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
      shares[corner] = {
          Bin{i + di, j + dj, (k + dk) % num_rotations_, 0.f},
          (di ? u : 1.f - u) * (dj ? v : 1.f - v) * (dk ? w : 1.f - w)};
    }
    return shares;
  }

  [[nodiscard]] Bin* Find(const int x, const int y, const int rotation) {
    const uint64_t key = static_cast<uint64_t>(static_cast<uint32_t>(x)) << 40 ^
                         static_cast<uint64_t>(static_cast<uint32_t>(y)) << 16 ^
                         static_cast<uint64_t>(rotation);
    const Bin wanted{x, y, rotation, 0.f};
    size_t at = key * 0x9E3779B97F4A7C15u >> 20;  // Fibonacci hashing
    for (;; ++at) {
      int& index = table_[at & (table_.size() - 1)];
      if (index < 0) {
        index = static_cast<int>(bins_.size());
        bins_.push_back(wanted);
        return &bins_.back();
      }
      if (IsSame(bins_[index], wanted)) return &bins_[index];
    }
  }

  const float pitch_;
  const int num_rotations_;
  // Open addressing: indices of bins, or -1.
  std::vector<int> table_ = std::vector<int>(16, -1);
  std::vector<Bin> bins_;
};

// Those of the largest weight, ordered by rotation; ties by the order given.
void SelectCorrespondences(
    const PoseVoteOptions& options,
    std::vector<WeightedCorrespondence>* const correspondences) {
  std::stable_sort(
      correspondences->begin(), correspondences->end(),
      [](const WeightedCorrespondence& a, const WeightedCorrespondence& b) {
        return a.weight > b.weight;
      });
  if (correspondences->size() >
      static_cast<size_t>(options.max_num_correspondences)) {
    correspondences->resize(
        static_cast<size_t>(options.max_num_correspondences));
  }
  std::stable_sort(
      correspondences->begin(), correspondences->end(),
      [](const WeightedCorrespondence& a, const WeightedCorrespondence& b) {
        return a.rotation < b.rotation;
      });
}

// The pose that a pair fixes; none where the two do not agree.
std::optional<Vote> VoteOf(const PoseVoteOptions& options,
                           const WeightedCorrespondence& first,
                           const WeightedCorrespondence& second) {
  const Eigen::Vector2f query = second.p_middle - first.p_middle;
  const Eigen::Vector2f reference = second.p_reference - first.p_reference;
  const float query_length = query.norm();
  const float reference_length = reference.norm();
  const float min_length = static_cast<float>(options.min_baseline_meters);
  if (!(query_length >= min_length && reference_length >= min_length) ||
      std::abs(query_length - reference_length) >
          static_cast<float>(options.max_length_difference_meters)) {
    return std::nullopt;
  }
  const float rotation =
      std::atan2(query.x() * reference.y() - query.y() * reference.x(),
                 query.dot(reference));
  const auto is_near = [&](const float other) {
    const float turned = std::abs(rotation - other);
    return std::min(turned, 2.f * kPi - turned) <=
           static_cast<float>(options.max_orientation_difference);
  };
  if (!is_near(first.rotation) || !is_near(second.rotation)) {
    return std::nullopt;
  }
  const float c = std::cos(rotation), s = std::sin(rotation);
  const Eigen::Vector2f q = 0.5f * (first.p_middle + second.p_middle);
  const Eigen::Vector2f r = 0.5f * (first.p_reference + second.p_reference);
  return Vote{r.x() - (c * q.x() - s * q.y()), r.y() - (s * q.x() + c * q.y()),
              rotation, first.weight * second.weight};
}

std::vector<Vote> CollectVotes(
    const PoseVoteOptions& options,
    const std::vector<WeightedCorrespondence>& correspondences) {
  const float max_rotation =
      static_cast<float>(options.max_orientation_difference);
  std::vector<Vote> votes;
  const size_t n = correspondences.size();
  for (size_t a = 0; a < n; ++a) {
    // Those that follow in rotation, around the circle.
    for (size_t step = 1; step < n; ++step) {
      const bool wraps = a + step >= n;
      const WeightedCorrespondence& second =
          correspondences[wraps ? a + step - n : a + step];
      if (second.rotation - correspondences[a].rotation +
              (wraps ? 2.f * kPi : 0.f) >
          max_rotation) {
        break;
      }
      const std::optional<Vote> vote =
          VoteOf(options, correspondences[a], second);
      if (vote) votes.push_back(*vote);
    }
  }
  return votes;
}

// The mean of the votes that the bin has a share of, by their shares.
VotedPose MeanPose(const Raster& raster, const Bin& bin,
                   const std::vector<Vote>& votes) {
  const float centre = raster.RotationOf(bin);
  double sum = 0., sum_x = 0., sum_y = 0., sum_turned = 0.;
  for (const Vote& vote : votes) {
    const float share = raster.ShareOf(bin, vote);
    if (share == 0.f) continue;
    const double weight = share * vote.weight;
    sum += weight;
    sum_x += weight * vote.x;
    sum_y += weight * vote.y;
    sum_turned += weight * NormalizeAngle(vote.rotation - centre);
  }
  return {Rigid2(sum_x / sum, sum_y / sum, centre + sum_turned / sum),
          bin.weight};
}

}  // namespace

std::string Validate(const PoseVoteOptions& options) {
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
  if (!(options.min_baseline_meters > 0. &&
        options.bin_distance_meters >= 0.01 && options.bin_rotation >= 1e-3)) {
    return "min_baseline_meters must be positive, bin_distance_meters at least "
           "0.01 and bin_rotation at least 0.001";
  }
  return "";
}

std::vector<VotedPose> VotePoses(
    const PoseVoteOptions& options, const int max_num_poses,
    std::vector<WeightedCorrespondence> correspondences) {
  CHECK_EQ(Validate(options), "");
  SelectCorrespondences(options, &correspondences);
  const std::vector<Vote> votes = CollectVotes(options, correspondences);
  Raster raster(options, votes.size());
  for (const Vote& vote : votes) raster.Add(vote);
  std::vector<Bin> bins = raster.bins();
  const auto heavier = [](const Bin& a, const Bin& b) {
    return std::tie(b.weight, a.x, a.y, a.rotation) <
           std::tie(a.weight, b.x, b.y, b.rotation);
  };
  std::vector<VotedPose> poses;
  while (poses.size() < static_cast<size_t>(max_num_poses) && !bins.empty()) {
    const Bin peak = *std::min_element(bins.begin(), bins.end(), heavier);
    if (!(peak.weight > 0.f)) break;
    poses.push_back(MeanPose(raster, peak, votes));
    bins.erase(std::remove_if(bins.begin(), bins.end(),
                              [&](const Bin& bin) {
                                return raster.AreAdjacent(bin, peak);
                              }),
               bins.end());
  }
  return poses;
}

}  // namespace cartographer_sdf
