// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/place_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kMinNumBuckets = 256;
// Entries per bucket, at most on average.
constexpr size_t kMaxLoad = 8;
constexpr int kNumDirections = 256;
constexpr float kMetersPerUnit = 0.01f;
constexpr uint32_t kMaxNumSlots = 1u << 24;

// Memory is on its way for so many lookups before the first is looked at.
constexpr size_t kNumFetchedAhead = 16;

// Submaps whose votes are sorted into poses: of thousands, the others have too
// few votes to be among the best.
constexpr size_t kMaxNumVotedSubmaps = 200;

// Directions in 1 / 256 of a turn.
uint32_t QuantizeDirection(const double direction) {
  return static_cast<uint32_t>(
             std::lround(direction / (2. * M_PI) * kNumDirections) +
             kNumDirections) %
         kNumDirections;
}

struct UnitVector {
  float x, y;
};
std::array<UnitVector, kNumDirections> MakeUnitVectors() {
  std::array<UnitVector, kNumDirections> vectors;
  for (int k = 0; k < kNumDirections; ++k) {
    const double angle = 2. * M_PI * k / kNumDirections;
    vectors[k] = {static_cast<float>(std::cos(angle)),
                  static_cast<float>(std::sin(angle))};
  }
  return vectors;
}

// Turns the pairs of a query onto stored ones.
class PoseOfPair {
 public:
  PoseOfPair(const KeypointPair& pair, const Eigen::Vector2d& centroid)
      : arm_(centroid.cast<float>() - pair.middle),
        direction_(pair.direction),
        cos_(std::cos(pair.direction)),
        sin_(std::sin(pair.direction)) {}

  // `middle` and `direction` of the stored pair.
  [[nodiscard]] PoseVote operator()(const Eigen::Vector2f& middle,
                                    const uint32_t direction,
                                    const float weight) const {
    static const std::array<UnitVector, kNumDirections> kUnit =
        MakeUnitVectors();
    const UnitVector& unit = kUnit[direction];
    const float c = unit.x * cos_ + unit.y * sin_;
    const float s = unit.y * cos_ - unit.x * sin_;
    constexpr float kTurn = static_cast<float>(2. * M_PI);
    float rotation =
        static_cast<float>(direction) * (kTurn / kNumDirections) - direction_;
    if (rotation > 0.5f * kTurn) rotation -= kTurn;
    if (rotation > 0.5f * kTurn) rotation -= kTurn;
    rotation = std::clamp(rotation, -0.5f * kTurn, 0.5f * kTurn);
    return {middle.x() + c * arm_.x() - s * arm_.y(),
            middle.y() + s * arm_.x() + c * arm_.y(), rotation, weight};
  }

 private:
  const Eigen::Vector2f arm_;  // from the middle of the pair to the centroid
  const float direction_;
  const float cos_, sin_;
};

}  // namespace

// Which slots a query skips. The predicate is asked once about each that the
// query meets.
class PlaceIndex::SlotFilter {
 public:
  SlotFilter(const std::vector<Slot>& slots, const Predicate& is_excluded)
      : slots_(slots),
        is_excluded_(is_excluded),
        answers_(slots.size(), Answer::kUnknown) {}

  [[nodiscard]] bool Skips(const uint32_t slot) {
    Answer& answer = answers_[slot];
    if (answer == Answer::kUnknown) {
      const bool skips = slots_[slot].is_removed ||
                         (is_excluded_ && is_excluded_(slots_[slot].id));
      answer = skips ? Answer::kSkip : Answer::kKeep;
    }
    return answer == Answer::kSkip;
  }

 private:
  enum class Answer : char { kUnknown, kKeep, kSkip };

  const std::vector<Slot>& slots_;
  const Predicate& is_excluded_;
  std::vector<Answer> answers_;
};

std::string Validate(const RetrievalOptions& options) {
  for (const std::string& error :
       {Validate(options.pairs), Validate(options.pose_bins)}) {
    if (!error.empty()) return error;
  }
  for (const int count :
       {options.num_stored_partners, options.num_sought_partners,
        options.max_num_stored_pairs, options.max_num_sought_pairs,
        options.max_num_visited_pairs, options.max_num_poses}) {
    if (count < 1 || count > 100000000) {
      return "num_stored_partners, num_sought_partners, max_num_stored_pairs, "
             "max_num_sought_pairs, max_num_visited_pairs and max_num_poses "
             "must lie between 1 and 100000000";
    }
  }
  if (!(options.min_score >= 0.)) return "min_score must not be negative";
  if (options.min_num_candidates < 1 ||
      options.max_num_candidates < options.min_num_candidates) {
    return "min_num_candidates must be positive and at most max_num_candidates";
  }
  return "";
}

PlaceIndex::PlaceIndex(const RetrievalOptions& options)
    : options_(options), buckets_(kMinNumBuckets) {
  CHECK_EQ(Validate(options), "");
}

std::vector<PlaceIndex::Entry>& PlaceIndex::BucketOf(const uint32_t key) {
  return buckets_[key & (buckets_.size() - 1)];
}

const std::vector<PlaceIndex::Entry>& PlaceIndex::BucketOf(
    const uint32_t key) const {
  return buckets_[key & (buckets_.size() - 1)];
}

void PlaceIndex::Grow() {
  std::vector<std::vector<Entry>> old(2 * buckets_.size());
  old.swap(buckets_);
  for (std::vector<Entry>& bucket : old) {
    for (const Entry& entry : bucket) BucketOf(entry.key).push_back(entry);
    std::vector<Entry>().swap(bucket);
  }
}

void PlaceIndex::Add(const SubmapId& id, const FeatureSet& features) {
  CHECK(!Contains(id)) << id << " is in the index already";
  if (free_slots_.empty()) {
    CHECK_LT(slots_.size(), kMaxNumSlots);
    free_slots_.push_back(static_cast<uint32_t>(slots_.size()));
    slots_.emplace_back();
  }
  const uint32_t slot_index = free_slots_.back();
  free_slots_.pop_back();
  slots_by_id_[id] = slot_index;
  Slot& slot = slots_[slot_index];
  slot = Slot();
  slot.id = id;
  if (features.features.empty()) return;
  slot.origin = KeypointCentroid(features).cast<float>();
  for (const KeypointPair& pair : PairsToStore(
           options_.pairs, options_.num_stored_partners,
           static_cast<size_t>(options_.max_num_stored_pairs), features)) {
    const Eigen::Vector2f middle = (pair.middle - slot.origin) / kMetersPerUnit;
    if (!(middle.cwiseAbs().maxCoeff() <
          static_cast<float>(std::numeric_limits<int16_t>::max()))) {
      continue;
    }
    Entry entry;
    entry.slot = slot_index & (kMaxNumSlots - 1);
    entry.direction = QuantizeDirection(pair.direction) & 255u;
    entry.x = static_cast<int16_t>(std::lround(middle.x()));
    entry.y = static_cast<int16_t>(std::lround(middle.y()));
    for (const uint32_t key : pair.keys) {
      entry.key = key;
      BucketOf(key).push_back(entry);
      ++num_entries_;
    }
    ++slot.num_pairs;
  }
  while (num_entries_ > kMaxLoad * buckets_.size()) Grow();
}

bool PlaceIndex::Remove(const SubmapId& id) {
  const auto found = slots_by_id_.find(id);
  if (found == slots_by_id_.end()) return false;
  Slot& slot = slots_[found->second];
  slot.is_removed = true;
  num_removed_entries_ += static_cast<size_t>(slot.num_pairs);
  slots_by_id_.erase(found);
  // Rarely, so that a removal costs as much as it takes to add a submap.
  if (2 * num_removed_entries_ > num_entries_) Sweep();
  return true;
}

void PlaceIndex::Sweep() {
  for (std::vector<Entry>& bucket : buckets_) {
    bucket.erase(std::remove_if(bucket.begin(), bucket.end(),
                                [this](const Entry& entry) {
                                  return slots_[entry.slot].is_removed;
                                }),
                 bucket.end());
  }
  num_entries_ -= num_removed_entries_;
  num_removed_entries_ = 0;
  for (uint32_t k = 0; k < slots_.size(); ++k) {
    if (!slots_[k].is_removed) continue;
    slots_[k] = Slot();
    free_slots_.push_back(k);
  }
}

bool PlaceIndex::Contains(const SubmapId& id) const {
  return slots_by_id_.count(id) > 0;
}

size_t PlaceIndex::MemoryUse() const {
  size_t bytes =
      buckets_.capacity() * sizeof(std::vector<Entry>) +
      slots_.capacity() * sizeof(Slot) +
      // A node of a map has three pointers and a colour beside.
      slots_by_id_.size() * (sizeof(std::pair<SubmapId, uint32_t>) + 32);
  for (const std::vector<Entry>& bucket : buckets_) {
    bytes += bucket.capacity() * sizeof(Entry);
  }
  return bytes;
}

std::vector<PlaceIndex::Lookup> PlaceIndex::FindBuckets(
    const std::vector<KeypointPair>& pairs) const {
  std::vector<Lookup> lookups;
  for (uint32_t k = 0; k < pairs.size(); ++k) {
    for (const uint32_t key : pairs[k].keys) {
      lookups.push_back({nullptr, 0, k, key, 0.f});
    }
  }
  size_t count = 0;
  for (size_t k = 0; k < lookups.size(); ++k) {
    if (k + kNumFetchedAhead < lookups.size()) {
      __builtin_prefetch(&BucketOf(lookups[k + kNumFetchedAhead].key));
    }
    const std::vector<Entry>& bucket = BucketOf(lookups[k].key);
    if (bucket.empty()) continue;
    lookups[count] = lookups[k];
    lookups[count].entries = bucket.data();
    lookups[count].num_entries = static_cast<uint32_t>(bucket.size());
    ++count;
  }
  lookups.resize(count);
  return lookups;
}

std::vector<PlaceIndex::Lookup> PlaceIndex::PlanLookups(
    const std::vector<KeypointPair>& pairs) const {
  const std::vector<Lookup> lookups = FindBuckets(pairs);
  // By counting, since most buckets are small: the lookups of each size lie
  // where those of smaller ones end.
  std::vector<uint32_t> ends(1, 0);
  for (const Lookup& lookup : lookups) {
    if (lookup.num_entries >= ends.size()) {
      ends.resize(lookup.num_entries + 1, 0);
    }
    ++ends[lookup.num_entries];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<Lookup> planned(lookups.size());
  for (size_t k = lookups.size(); k > 0; --k) {
    planned[--ends[lookups[k - 1].num_entries]] = lookups[k - 1];
  }
  size_t num_visited = 0;
  size_t count = 0;
  while (count < planned.size()) {
    num_visited += planned[count].num_entries;
    if (num_visited > static_cast<size_t>(options_.max_num_visited_pairs)) {
      break;
    }
    ++count;
  }
  planned.resize(count);
  return planned;
}

std::vector<float> PlaceIndex::WeighSlots(
    const Predicate& is_excluded, std::vector<Lookup>* const lookups) const {
  SlotFilter filter(slots_, is_excluded);
  const float num_submaps = static_cast<float>(slots_by_id_.size());
  std::vector<float> weights(slots_.size(), 0.f);
  std::vector<uint32_t> found;
  for (size_t k = 0; k < lookups->size(); ++k) {
    const Lookup& ahead =
        (*lookups)[std::min(k + kNumFetchedAhead, lookups->size() - 1)];
    __builtin_prefetch(ahead.entries);
    __builtin_prefetch(ahead.entries + ahead.num_entries - 1);
    Lookup& lookup = (*lookups)[k];
    found.clear();
    for (uint32_t e = 0; e < lookup.num_entries; ++e) {
      const Entry& entry = lookup.entries[e];
      if (entry.key == lookup.key && !filter.Skips(entry.slot)) {
        found.push_back(entry.slot);
      }
    }
    if (found.empty()) continue;
    // Inverse document frequency of the key.
    lookup.weight =
        std::log1p(num_submaps / static_cast<float>(found.size() + 1));
    for (const uint32_t slot : found) weights[slot] += lookup.weight;
  }
  return weights;
}

std::vector<uint32_t> PlaceIndex::Heaviest(std::vector<float> weights) const {
  std::vector<uint32_t> voted;
  for (uint32_t slot = 0; slot < weights.size(); ++slot) {
    if (weights[slot] > 0.f) voted.push_back(slot);
  }
  if (voted.size() <= kMaxNumVotedSubmaps) return voted;
  for (const uint32_t slot : voted) {
    weights[slot] /= std::sqrt(static_cast<float>(slots_[slot].num_pairs));
  }
  std::nth_element(voted.begin(), voted.begin() + kMaxNumVotedSubmaps,
                   voted.end(),
                   [this, &weights](const uint32_t a, const uint32_t b) {
                     return std::make_tuple(-weights[a], slots_[a].id) <
                            std::make_tuple(-weights[b], slots_[b].id);
                   });
  voted.resize(kMaxNumVotedSubmaps);
  return voted;
}

std::vector<std::vector<PoseVote>> PlaceIndex::VotesBySlot(
    const std::vector<KeypointPair>& pairs, const Eigen::Vector2d& centroid,
    const std::vector<Lookup>& lookups,
    const std::vector<uint32_t>& slots) const {
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> ranks(slots_.size(), kNone);
  for (uint32_t k = 0; k < slots.size(); ++k) ranks[slots[k]] = k;
  std::vector<PoseOfPair> poses;
  poses.reserve(pairs.size());
  for (const KeypointPair& pair : pairs) poses.emplace_back(pair, centroid);
  std::vector<std::vector<PoseVote>> votes_by_slot(slots.size());
  for (const Lookup& lookup : lookups) {
    for (uint32_t e = 0; e < lookup.num_entries; ++e) {
      const Entry& entry = lookup.entries[e];
      if (entry.key != lookup.key || ranks[entry.slot] == kNone) continue;
      const Eigen::Vector2f middle =
          slots_[entry.slot].origin +
          kMetersPerUnit * Eigen::Vector2f(entry.x, entry.y);
      votes_by_slot[ranks[entry.slot]].push_back(
          poses[lookup.pair](middle, entry.direction, lookup.weight));
    }
  }
  return votes_by_slot;
}

std::vector<RetrievalCandidate> PlaceIndex::Rank(
    const FeatureSet& features, const Predicate& is_excluded) const {
  if (features.features.empty()) return {};
  const Eigen::Vector2d centroid = KeypointCentroid(features);
  const std::vector<KeypointPair> pairs =
      PairsToSeek(options_.pairs, options_.num_sought_partners,
                  static_cast<size_t>(options_.max_num_sought_pairs), features);
  std::vector<Lookup> lookups = PlanLookups(pairs);
  const std::vector<uint32_t> slots =
      Heaviest(WeighSlots(is_excluded, &lookups));
  const std::vector<std::vector<PoseVote>> votes_by_slot =
      VotesBySlot(pairs, centroid, lookups, slots);
  std::vector<RetrievalCandidate> candidates;
  for (size_t k = 0; k < slots.size(); ++k) {
    const std::vector<VotedPose> poses = HeaviestPoses(
        options_.pose_bins, options_.max_num_poses, centroid, votes_by_slot[k]);
    const Slot& slot = slots_[slots[k]];
    // The more pairs both have, the more agree by chance.
    const double num_pairs = std::sqrt(static_cast<double>(slot.num_pairs) *
                                       static_cast<double>(pairs.size()));
    candidates.push_back({slot.id, poses.front().weight / num_pairs, {}});
    for (const VotedPose& pose : poses) {
      candidates.back().T_reference_query.push_back(pose.T_reference_query);
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const RetrievalCandidate& a, const RetrievalCandidate& b) {
              return std::make_tuple(-a.score, a.id) <
                     std::make_tuple(-b.score, b.id);
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
