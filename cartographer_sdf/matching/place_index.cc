// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/place_index.h"

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

// Estimates the inverse document frequency of a query feature from the slots of
// the nearer half of its neighbours, of `num_slots` in total.
float Distinctiveness(std::vector<int> slots, const size_t num_slots) {
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return std::log1p(static_cast<float>(num_slots) /
                    static_cast<float>(slots.size()));
}

// Returns the weight of the pose for which the correspondences with one submap
// vote most; nullopt if no two agree.
std::optional<double> HeaviestVote(
    const PoseVotingOptions& options, const Eigen::Vector2d& centroid,
    std::vector<WeightedCorrespondence> correspondences) {
  std::stable_sort(
      correspondences.begin(), correspondences.end(),
      [](const WeightedCorrespondence& a, const WeightedCorrespondence& b) {
        return a.weight > b.weight;
      });
  const std::vector<VotedPose> poses =
      VotePoses(options, 1, centroid, std::move(correspondences));
  if (poses.empty()) return std::nullopt;
  return poses.front().weight;
}

}  // namespace

std::string Validate(const RetrievalOptions& options) {
  if (options.num_neighbours < 2 || options.num_neighbours > 100000) {
    return "num_neighbours must lie between 2 and 100000";
  }
  if (!(options.max_clearance_difference_meters > 0.)) {
    return "max_clearance_difference_meters must be positive";
  }
  if (const std::string error = Validate(options.votes); !error.empty()) {
    return error;
  }
  if (!(options.min_score >= 0.)) return "min_score must not be negative";
  if (options.min_num_candidates < 1 ||
      options.max_num_candidates < options.min_num_candidates) {
    return "min_num_candidates must be positive and at most max_num_candidates";
  }
  return "";
}

PlaceIndex::PlaceIndex(const RetrievalOptions& options) : options_(options) {
  CHECK_EQ(Validate(options), "");
}

PlaceIndex::Segment PlaceIndex::SelectRows(const Segment& segment,
                                           const std::vector<int>& rows) {
  Segment selected;
  selected.descriptors.resize(static_cast<Eigen::Index>(rows.size()),
                              segment.descriptors.cols());
  for (const int row : rows) {
    selected.descriptors.row(static_cast<Eigen::Index>(selected.slots.size())) =
        segment.descriptors.row(row);
    selected.clearances.push_back(segment.clearances[row]);
    selected.slots.push_back(segment.slots[row]);
    selected.features.push_back(segment.features[row]);
  }
  return selected;
}

PlaceIndex::Segment PlaceIndex::Merge(const Segment& a, const Segment& b) {
  Segment both = a;
  both.clearances.insert(both.clearances.end(), b.clearances.begin(),
                         b.clearances.end());
  both.slots.insert(both.slots.end(), b.slots.begin(), b.slots.end());
  both.features.insert(both.features.end(), b.features.begin(),
                       b.features.end());
  both.descriptors.resize(a.descriptors.rows() + b.descriptors.rows(),
                          a.descriptors.cols());
  both.descriptors << a.descriptors, b.descriptors;
  std::vector<int> order(both.slots.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&both](int i, int j) {
    return both.clearances[i] < both.clearances[j];
  });
  return SelectRows(both, order);
}

PlaceIndex::Segment PlaceIndex::MakeSegment(const FeatureSet& features,
                                            std::vector<int> columns,
                                            const int slot) {
  const auto clearance = [&features](const int column) {
    return static_cast<float>(features.features[column].keypoint.clearance);
  };
  std::stable_sort(columns.begin(), columns.end(),
                   [&](int a, int b) { return clearance(a) < clearance(b); });
  Segment segment;
  segment.descriptors.resize(static_cast<Eigen::Index>(columns.size()),
                             features.descriptors.rows());
  for (const int column : columns) {
    segment.descriptors.row(static_cast<Eigen::Index>(segment.slots.size())) =
        features.descriptors.col(column).transpose();
    segment.clearances.push_back(clearance(column));
    segment.slots.push_back(slot);
    segment.features.push_back(column);
  }
  return segment;
}

void PlaceIndex::Add(const SubmapId& id, const FeatureSet& features) {
  CHECK(!Contains(id)) << id << " is in the index already";
  if (!features.features.empty()) {
    if (descriptor_length_ == 0) {
      descriptor_length_ = features.descriptors.rows();
    }
    CHECK_EQ(features.descriptors.rows(), descriptor_length_);
    CHECK_EQ(features.descriptors.cols(), features.features.size());
  }
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<int>(slots_.size()));
    slots_.emplace_back();
  }
  const int slot = free_slots_.back();
  free_slots_.pop_back();
  slots_by_id_[id] = slot;
  slots_[slot].id = id;
  std::array<std::vector<int>, kNumKeypointKinds> columns;
  for (const Feature& feature : features.features) {
    columns[static_cast<int>(feature.keypoint.kind)].push_back(
        static_cast<int>(slots_[slot].features.size()));
    slots_[slot].features.push_back({feature.keypoint.position.cast<float>(),
                                     static_cast<float>(feature.orientation)});
  }
  for (int kind = 0; kind < kNumKeypointKinds; ++kind) {
    if (columns[kind].empty()) continue;
    Segment added = MakeSegment(features, columns[kind], slot);
    std::vector<Segment>& segments = segments_[kind];
    segments.push_back(std::move(added));
    while (segments.size() > 1 && 2 * segments.back().slots.size() >=
                                      segments.end()[-2].slots.size()) {
      const Segment merged = Merge(segments.end()[-2], segments.back());
      segments.pop_back();
      segments.back() = merged;
    }
  }
}

bool PlaceIndex::Remove(const SubmapId& id) {
  const auto found = slots_by_id_.find(id);
  if (found == slots_by_id_.end()) return false;
  const int slot = found->second;
  slots_by_id_.erase(found);
  slots_[slot].features.clear();
  free_slots_.push_back(slot);
  for (std::vector<Segment>& segments : segments_) {
    for (Segment& segment : segments) {
      std::vector<int> rows;
      for (size_t row = 0; row < segment.slots.size(); ++row) {
        if (segment.slots[row] != slot) rows.push_back(static_cast<int>(row));
      }
      if (rows.size() < segment.slots.size()) {
        segment = SelectRows(segment, rows);
      }
    }
    segments.erase(std::remove_if(segments.begin(), segments.end(),
                                  [](const Segment& segment) {
                                    return segment.slots.empty();
                                  }),
                   segments.end());
  }
  return true;
}

bool PlaceIndex::Contains(const SubmapId& id) const {
  return slots_by_id_.count(id) > 0;
}

template <typename Visitor>
void PlaceIndex::VisitDistances(const Segment& segment, const double clearance,
                                const Eigen::Ref<const Eigen::VectorXf>& query,
                                const Visitor& visit) const {
  const std::vector<float>& clearances = segment.clearances;
  const auto row_at = [&clearances](const auto& iterator) {
    return static_cast<Eigen::Index>(iterator - clearances.begin());
  };
  const double difference = options_.max_clearance_difference_meters;
  const Eigen::Index first = row_at(std::lower_bound(
      clearances.begin(), clearances.end(),
      static_cast<float>(clearance) - static_cast<float>(difference)));
  const Eigen::Index end = row_at(std::upper_bound(
      clearances.begin(), clearances.end(),
      static_cast<float>(clearance) + static_cast<float>(difference)));
  // Elementwise, so that a distance does not depend on its neighbours in
  // memory.
  constexpr Eigen::Index kBlock = 512;
  Eigen::Array<float, kBlock, 1> distances;
  for (Eigen::Index begin = first; begin < end; begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, end - begin);
    auto block = distances.head(size);
    block.setZero();
    for (Eigen::Index d = 0; d < descriptor_length_; ++d) {
      block +=
          (segment.descriptors.col(d).segment(begin, size) - query[d]).square();
    }
    for (Eigen::Index k = 0; k < size; ++k) visit(distances[k], begin + k);
  }
}

std::vector<PlaceIndex::Neighbour> PlaceIndex::FindNeighbours(
    const Feature& feature, const Eigen::Ref<const Eigen::VectorXf>& query,
    const std::vector<char>& is_excluded) const {
  // One more than vote: the others are compared with the last.
  const size_t count = static_cast<size_t>(options_.num_neighbours) + 1;
  const auto nearer = [this](const Neighbour& a, const Neighbour& b) {
    return std::tie(a.squared_distance, slots_[a.slot].id, a.feature) <
           std::tie(b.squared_distance, slots_[b.slot].id, b.feature);
  };
  std::vector<Neighbour> neighbours;
  float limit = std::numeric_limits<float>::infinity();
  const auto keep_nearest = [&] {
    if (neighbours.size() <= count) return;
    std::nth_element(neighbours.begin(), neighbours.begin() + count - 1,
                     neighbours.end(), nearer);
    neighbours.resize(count);
    limit = neighbours.back().squared_distance;
  };
  for (const Segment& segment :
       segments_[static_cast<int>(feature.keypoint.kind)]) {
    VisitDistances(
        segment, feature.keypoint.clearance, query,
        [&](const float squared_distance, const Eigen::Index row) {
          const int slot = segment.slots[row];
          if (!(squared_distance <= limit) || is_excluded[slot]) {
            return;
          }
          neighbours.push_back({squared_distance, slot, segment.features[row]});
          if (neighbours.size() > 2 * count) keep_nearest();
        });
  }
  keep_nearest();
  std::sort(neighbours.begin(), neighbours.end(), nearer);
  return neighbours;
}

std::vector<std::vector<WeightedCorrespondence>> PlaceIndex::Correspond(
    const FeatureSet& query, const Eigen::Vector2d& centroid,
    const std::vector<char>& is_excluded) const {
  std::vector<std::vector<WeightedCorrespondence>> correspondences(
      slots_.size());
  for (size_t k = 0; k < query.features.size(); ++k) {
    const Feature& feature = query.features[k];
    const std::vector<Neighbour> neighbours = FindNeighbours(
        feature, query.descriptors.col(static_cast<Eigen::Index>(k)),
        is_excluded);
    if (neighbours.size() < 2) continue;
    const float background = neighbours.back().squared_distance;
    if (!(background > 0.f)) continue;
    std::vector<int> near_slots;
    for (size_t n = 0; 2 * n < neighbours.size(); ++n) {
      near_slots.push_back(neighbours[n].slot);
    }
    const float distinctiveness =
        Distinctiveness(std::move(near_slots), size());
    const Eigen::Vector2f p_centroid =
        (feature.keypoint.position - centroid).cast<float>();
    for (const Neighbour& neighbour : neighbours) {
      const float weight =
          distinctiveness * (1.f - neighbour.squared_distance / background);
      if (!(weight > 0.f)) break;
      const StoredFeature& other =
          slots_[neighbour.slot].features[neighbour.feature];
      correspondences[neighbour.slot].push_back(
          {other.position, p_centroid,
           static_cast<float>(
               NormalizeAngle(other.orientation - feature.orientation)),
           weight});
    }
  }
  return correspondences;
}

std::vector<RetrievalCandidate> PlaceIndex::Rank(
    const FeatureSet& features, const Predicate& is_excluded) const {
  if (features.features.empty() || descriptor_length_ == 0) return {};
  CHECK_EQ(features.descriptors.rows(), descriptor_length_);
  CHECK_EQ(features.descriptors.cols(), features.features.size());
  std::vector<char> excluded(slots_.size(), 0);
  if (is_excluded) {
    for (const auto& [id, slot] : slots_by_id_)
      excluded[slot] = is_excluded(id);
  }
  const Eigen::Vector2d centroid = KeypointCentroid(features);
  std::vector<std::vector<WeightedCorrespondence>> correspondences =
      Correspond(features, centroid, excluded);
  std::vector<RetrievalCandidate> candidates;
  for (const auto& [id, slot] : slots_by_id_) {
    const std::optional<double> weight = HeaviestVote(
        options_.votes, centroid, std::move(correspondences[slot]));
    if (!weight) continue;
    // The more features both have, the more agree by chance.
    const double num_features =
        std::sqrt(static_cast<double>(slots_[slot].features.size()) *
                  static_cast<double>(features.features.size()));
    candidates.push_back({id, std::sqrt(*weight / num_features)});
  }
  // Ties stay in the order of ids.
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const RetrievalCandidate& a, const RetrievalCandidate& b) {
        return a.score > b.score;
      });
  return candidates;
}

std::vector<RetrievalCandidate> PlaceIndex::Query(
    const FeatureSet& features, const Predicate& is_excluded) const {
  std::vector<RetrievalCandidate> candidates = Rank(features, is_excluded);
  size_t count = 0;
  while (count < candidates.size() &&
         count < static_cast<size_t>(options_.max_num_candidates) &&
         (count < static_cast<size_t>(options_.min_num_candidates) ||
          candidates[count].score >= options_.min_score)) {
    ++count;
  }
  candidates.resize(count);
  return candidates;
}

std::vector<RetrievalCandidate> PlaceIndex::QueryBest(
    const FeatureSet& features, const int num_candidates,
    const Predicate& is_excluded) const {
  std::vector<RetrievalCandidate> candidates = Rank(features, is_excluded);
  candidates.resize(
      std::min(candidates.size(), static_cast<size_t>(num_candidates)));
  return candidates;
}

}  // namespace cartographer_sdf
