// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Retrieval: which submaps may show the same place as a query, without a look
// at each of them. The index is an inverted file: pairs of keypoints
// (keypoint_pairs.h) are stored under what does not depend on the pose, and a
// pair of the query that finds one of a submap votes for the pose that takes it
// there. Pairs found in few submaps weigh more. Heuristic; verification
// decides.

#ifndef CARTOGRAPHER_SDF_MATCHING_PLACE_INDEX_H_
#define CARTOGRAPHER_SDF_MATCHING_PLACE_INDEX_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/matching/keypoint_pairs.h"
#include "cartographer_sdf/matching/pose_voter.h"

namespace cartographer_sdf {

struct RetrievalOptions {
  KeypointPairOptions pairs;
  // Each keypoint of a submap is stored with so many partners, and each of a
  // query is sought with so many. Larger: more recall, more memory, slower.
  int num_stored_partners = 3;
  int num_sought_partners = 6;
  // Pairs of one submap, those of the strongest keypoints. A stored pair takes
  // some 20 bytes.
  int max_num_stored_pairs = 360;
  int max_num_sought_pairs = 1000;
  // A query looks at so many stored pairs, those under the rarest keys: this
  // bounds its time, however large the index.
  int max_num_visited_pairs = 100000;
  // Pairs that vote for poses in one bin agree.
  PoseBinOptions pose_bins = {0.75, 0.2};
  // Poses returned of each candidate.
  int max_num_poses = 4;
  // Candidates with a lower score are dropped, ...
  double min_score = 0.004;
  // ... except the best `min_num_candidates`. Never more than
  // `max_num_candidates` are returned.
  int min_num_candidates = 10;
  int max_num_candidates = 20;
};
[[nodiscard]] std::string Validate(const RetrievalOptions& options);

struct RetrievalCandidate {
  SubmapId id;
  // Weight of the best pose over the geometric mean of both numbers of pairs:
  // comparable between queries; grows with the logarithm of the number of
  // submaps in the index.
  double score;
  // Poses of the query in the candidate, best first.
  std::vector<Rigid2> T_reference_query;
};

// Thread-compatible: queries may run concurrently, Add and Remove need
// exclusive access. Results do not depend on the order in which submaps were
// added, or on removed submaps, unless max_num_visited_pairs cuts them short.
class PlaceIndex {
 public:
  // Returns whether a submap is excluded: its pairs are not even looked at.
  using Predicate = std::function<bool(const SubmapId&)>;

  explicit PlaceIndex(const RetrievalOptions& options);

  // The id must be new. Amortised time: linear in the number of features.
  void Add(const SubmapId& id, const FeatureSet& features);
  // Returns whether the submap was present. Amortised constant time.
  bool Remove(const SubmapId& id);
  [[nodiscard]] bool Contains(const SubmapId& id) const;
  [[nodiscard]] size_t size() const { return slots_by_id_.size(); }
  // Memory held [bytes].
  [[nodiscard]] size_t MemoryUse() const;

  // Returns candidates, best first. Time is bounded by
  // RetrievalOptions::max_num_visited_pairs, but for some nanoseconds for each
  // submap (times: retrieval_benchmark).
  [[nodiscard]] std::vector<RetrievalCandidate> Query(
      const FeatureSet& features, const Predicate& is_excluded = {}) const;
  // Returns the best `num_candidates`, whatever their scores.
  [[nodiscard]] std::vector<RetrievalCandidate> QueryBest(
      const FeatureSet& features, int num_candidates,
      const Predicate& is_excluded = {}) const;

 private:
  // A stored pair, in the frame of its submap's slot.
  struct Entry {
    uint32_t key;
    uint32_t slot : 24;
    uint32_t direction : 8;  // in 1 / 256 of a turn
    int16_t x, y;            // middle, from the slot's origin [cm]
  };
  struct Slot {
    SubmapId id;
    Eigen::Vector2f origin = Eigen::Vector2f::Zero();  // submap frame [m]
    int num_pairs = 0;
    bool is_removed = false;
  };
  // A key of one of a query's pairs, and its bucket.
  struct Lookup {
    const Entry* entries;
    uint32_t num_entries;
    uint32_t pair;
    uint32_t key;
    float weight;  // of each entry with the key
  };
  class SlotFilter;
  [[nodiscard]] std::vector<Entry>& BucketOf(uint32_t key);
  [[nodiscard]] const std::vector<Entry>& BucketOf(uint32_t key) const;
  // Doubles the number of buckets.
  void Grow();
  // Forgets the pairs of removed submaps.
  void Sweep();
  // Returns the lookups of all keys whose buckets hold anything, in the order
  // of the pairs.
  [[nodiscard]] std::vector<Lookup> FindBuckets(
      const std::vector<KeypointPair>& pairs) const;
  // Returns where to look for the pairs, rarest keys first, as far as
  // RetrievalOptions::max_num_visited_pairs allows.
  [[nodiscard]] std::vector<Lookup> PlanLookups(
      const std::vector<KeypointPair>& pairs) const;
  // Sets the weights of the lookups and returns their sums for each slot.
  [[nodiscard]] std::vector<float> WeighSlots(
      const Predicate& is_excluded, std::vector<Lookup>* lookups) const;
  // Returns the slots with the most weight for their numbers of pairs.
  [[nodiscard]] std::vector<uint32_t> Heaviest(
      std::vector<float> weights) const;
  // Returns the votes for each of the slots.
  [[nodiscard]] std::vector<std::vector<PoseVote>> VotesBySlot(
      const std::vector<KeypointPair>& pairs, const Eigen::Vector2d& centroid,
      const std::vector<Lookup>& lookups,
      const std::vector<uint32_t>& slots) const;
  // Returns all submaps with a vote, best first.
  [[nodiscard]] std::vector<RetrievalCandidate> Rank(
      const FeatureSet& features, const Predicate& is_excluded) const;

  const RetrievalOptions options_;
  std::map<SubmapId, uint32_t> slots_by_id_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_slots_;
  std::vector<std::vector<Entry>> buckets_;  // their number is a power of two
  size_t num_entries_ = 0;
  size_t num_removed_entries_ = 0;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MATCHING_PLACE_INDEX_H_
