// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/keypoint_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "cartographer_sdf/geometry/rigid2.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Bins of one quantity: the one it lies in, and perhaps the one beside.
struct Bins {
  std::array<int, 2> index;
  int count;
};

class PairQuantizer {
 public:
  PairQuantizer(const KeypointPairOptions& options, const bool with_neighbours)
      : options_(options),
        border_(with_neighbours ? options.border_fraction : 0.),
        num_orientations_(std::max(
            1, static_cast<int>(
                   std::lround(2. * M_PI / options.orientation_bin)))) {}

  // The keys of first and second in this order.
  void AddKeys(const Feature& first, const Feature& second, const double length,
               const double direction,
               std::vector<uint32_t>* const keys) const {
    const Bins c1 =
        Along(first.keypoint.clearance, options_.clearance_bin_meters);
    const Bins c2 =
        Along(second.keypoint.clearance, options_.clearance_bin_meters);
    const Bins l = Along(length, options_.length_bin_meters);
    const Bins o1 = Around(first.orientation - direction);
    const Bins o2 = Around(second.orientation - direction);
    const uint64_t kinds =
        static_cast<uint64_t>(first.keypoint.kind) * kNumKeypointKinds +
        static_cast<uint64_t>(second.keypoint.kind);
    keys->reserve(keys->size() +
                  static_cast<size_t>(c1.count * c2.count * l.count * o1.count *
                                      o2.count));
    for (int a = 0; a < c1.count; ++a) {
      for (int b = 0; b < c2.count; ++b) {
        for (int c = 0; c < l.count; ++c) {
          for (int d = 0; d < o1.count; ++d) {
            for (int e = 0; e < o2.count; ++e) {
              keys->push_back(
                  Mixed(Packed(kinds, c1.index[a], c2.index[b], l.index[c],
                               o1.index[d], o2.index[e])));
            }
          }
        }
      }
    }
  }

  // Whether the order of two keypoints is the same however they are seen.
  [[nodiscard]] bool IsOrdered(const Keypoint& a, const Keypoint& b) const {
    return a.kind != b.kind ||
           std::abs(a.clearance - b.clearance) > options_.clearance_bin_meters;
  }

 private:
  [[nodiscard]] Bins Along(const double value, const double size) const {
    const double position = value / size;
    const int bin = static_cast<int>(std::floor(position));
    const double fraction = position - bin;
    if (fraction < border_) return {{bin, bin - 1}, 2};
    if (fraction > 1. - border_) return {{bin, bin + 1}, 2};
    return {{bin, bin}, 1};
  }
  [[nodiscard]] Bins Around(const double angle) const {
    Bins bins = Along(
        (NormalizeAngle(angle) + M_PI) / (2. * M_PI) * num_orientations_, 1.);
    for (int& bin : bins.index) {
      bin = (bin + num_orientations_) % num_orientations_;
    }
    return bins;
  }
  // Ten bits each; coordinates out of range share bins.
  template <typename... Index>
  [[nodiscard]] static uint64_t Packed(const uint64_t kinds,
                                       const Index... index) {
    uint64_t packed = kinds;
    ((packed = (packed << 10) | (static_cast<uint64_t>(index + 512) & 1023u)),
     ...);
    return packed;
  }
  // The finalising steps of SplitMix64 ([Steele2014]).
  [[nodiscard]] static uint32_t Mixed(uint64_t key) {
    key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
    key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
    return static_cast<uint32_t>(key ^ (key >> 31));
  }

  const KeypointPairOptions& options_;
  const double border_;
  const int num_orientations_;
};

std::vector<int> IndicesOf(const KeypointKinds& kinds,
                           const std::vector<Feature>& features) {
  std::vector<int> indices;
  for (size_t k = 0; k < features.size(); ++k) {
    if (Contains(kinds, features[k].keypoint.kind)) {
      indices.push_back(static_cast<int>(k));
    }
  }
  return indices;
}

using IndexPair = std::pair<int, int>;

// The nearest partners of each keypoint within reach; each pair once, the lower
// index first, in order.
std::vector<IndexPair> NearestPartners(const KeypointPairOptions& options,
                                       const int num_partners,
                                       const std::vector<Feature>& features) {
  const double min_squared = std::pow(options.min_length_meters, 2);
  const double max_squared = std::pow(options.max_length_meters, 2);
  std::vector<IndexPair> pairs;
  std::vector<std::pair<double, int>> partners;
  const std::vector<int> indices = IndicesOf(options.kinds, features);
  for (const int k : indices) {
    partners.clear();
    for (const int other : indices) {
      const double squared =
          (features[other].keypoint.position - features[k].keypoint.position)
              .squaredNorm();
      if (squared >= min_squared && squared <= max_squared) {
        partners.emplace_back(squared, other);
      }
    }
    const size_t kept =
        std::min(partners.size(), static_cast<size_t>(num_partners));
    std::partial_sort(partners.begin(),
                      partners.begin() + static_cast<std::ptrdiff_t>(kept),
                      partners.end());
    for (size_t n = 0; n < kept; ++n) {
      pairs.push_back(std::minmax(k, partners[n].second));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

// Keeps the pairs whose weaker keypoint is strongest.
void KeepStrongest(const std::vector<Feature>& features, const size_t count,
                   std::vector<IndexPair>* const pairs) {
  if (pairs->size() <= count) return;
  const auto strength = [&features](const IndexPair& pair) {
    return std::min(features[pair.first].keypoint.strength,
                    features[pair.second].keypoint.strength);
  };
  std::nth_element(
      pairs->begin(), pairs->begin() + static_cast<std::ptrdiff_t>(count),
      pairs->end(), [&strength](const IndexPair& a, const IndexPair& b) {
        return std::make_tuple(-strength(a), a.first, a.second) <
               std::make_tuple(-strength(b), b.first, b.second);
      });
  pairs->resize(count);
  std::sort(pairs->begin(), pairs->end());
}

// The first keypoint of a pair is the one of the lower kind or clearance.
bool IsFirst(const Keypoint& a, const Keypoint& b) {
  return std::tie(a.kind, a.clearance, a.position.x(), a.position.y()) <
         std::tie(b.kind, b.clearance, b.position.x(), b.position.y());
}

KeypointPair MakePair(const PairQuantizer& quantizer, const Feature& first,
                      const Feature& second) {
  const Eigen::Vector2d line =
      second.keypoint.position - first.keypoint.position;
  KeypointPair pair;
  const double direction = std::atan2(line.y(), line.x());
  pair.middle = (0.5 * (first.keypoint.position + second.keypoint.position))
                    .cast<float>();
  pair.direction = static_cast<float>(direction);
  quantizer.AddKeys(first, second, line.norm(), direction, &pair.keys);
  return pair;
}

std::vector<KeypointPair> MakePairs(const KeypointPairOptions& options,
                                    const int num_partners,
                                    const size_t max_num_pairs,
                                    const FeatureSet& set, const bool to_seek) {
  CHECK_EQ(Validate(options), "");
  const std::vector<Feature>& features = set.features;
  std::vector<IndexPair> indices =
      NearestPartners(options, num_partners, features);
  KeepStrongest(features, max_num_pairs, &indices);
  const PairQuantizer quantizer(options, to_seek);
  std::vector<KeypointPair> pairs;
  for (const auto& [a, b] : indices) {
    const bool in_order = IsFirst(features[a].keypoint, features[b].keypoint);
    const Feature& first = features[in_order ? a : b];
    const Feature& second = features[in_order ? b : a];
    pairs.push_back(MakePair(quantizer, first, second));
    if (to_seek && !quantizer.IsOrdered(first.keypoint, second.keypoint)) {
      pairs.push_back(MakePair(quantizer, second, first));
    }
  }
  return pairs;
}

}  // namespace

std::string Validate(const KeypointPairOptions& options) {
  if (!(options.min_length_meters > 0. &&
        options.max_length_meters > options.min_length_meters)) {
    return "min_length_meters must be positive and below max_length_meters";
  }
  if (!(options.clearance_bin_meters >= 0.01 &&
        options.length_bin_meters >= 0.01 && options.orientation_bin >= 0.01)) {
    return "clearance_bin_meters, length_bin_meters and orientation_bin must "
           "be at least 0.01";
  }
  if (!(options.border_fraction >= 0. && options.border_fraction <= 0.5)) {
    return "border_fraction must lie between 0 and 0.5";
  }
  return Validate(options.kinds);
}

std::vector<KeypointPair> PairsToStore(const KeypointPairOptions& options,
                                       const int num_partners,
                                       const size_t max_num_pairs,
                                       const FeatureSet& features) {
  return MakePairs(options, num_partners, max_num_pairs, features, false);
}

std::vector<KeypointPair> PairsToSeek(const KeypointPairOptions& options,
                                      const int num_partners,
                                      const size_t max_num_pairs,
                                      const FeatureSet& features) {
  return MakePairs(options, num_partners, max_num_pairs, features, true);
}

}  // namespace cartographer_sdf
