// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds the remembered submaps that look like a new one without comparing it
// with each: every feature of the query finds its nearest neighbours among the
// features of all submaps at once, and pairs of neighbours in the same submap
// vote for poses. A neighbour's weight is how much nearer it is than the last
// one found ([McCann2012]); features found in many submaps are less distinctive
// and weigh less. Heuristic; verification decides.

#ifndef CARTOGRAPHER_SDF_MATCHING_PLACE_INDEX_H_
#define CARTOGRAPHER_SDF_MATCHING_PLACE_INDEX_H_

#include <Eigen/Core>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/matching/pose_voter.h"

namespace cartographer_sdf {

struct RetrievalOptions {
  // Nearest neighbours of each query feature among all features of the index.
  // Larger: more recall, more time.
  int num_neighbours = 100;
  // Features whose clearance differs by more than this are not neighbours [m].
  double max_clearance_difference_meters = 0.2;
  PoseVotingOptions votes = {250, 0.25, 0.35, 1., 0.75, 0.2};
  // Candidates with a lower score are dropped, ...
  double min_score = 0.06;
  // ... except the best `min_num_candidates`. Never more than
  // `max_num_candidates` are returned.
  int min_num_candidates = 10;
  int max_num_candidates = 200;
};
[[nodiscard]] std::string Validate(const RetrievalOptions& options);

struct RetrievalCandidate {
  SubmapId id;
  // Square root of the weight of the best pose over the geometric mean of both
  // numbers of features: comparable between queries, and nearly so between
  // maps.
  double score;
};

// Thread-compatible: queries may run concurrently, Add and Remove need
// exclusive access. Results do not depend on the order in which submaps were
// added, or on removed submaps.
class PlaceIndex {
 public:
  // Returns whether a submap is excluded: its features are not even neighbours.
  using Predicate = std::function<bool(const SubmapId&)>;

  explicit PlaceIndex(const RetrievalOptions& options);

  // The id must be new, and descriptors must have the same length as before.
  // Amortised cost: n log n for n features in total.
  void Add(const SubmapId& id, const FeatureSet& features);
  // Returns whether the submap was present. Linear in the total number of
  // features.
  bool Remove(const SubmapId& id);
  [[nodiscard]] bool Contains(const SubmapId& id) const;
  [[nodiscard]] size_t size() const { return slots_by_id_.size(); }

  // Returns candidates, best first. Time grows with the total number of
  // features times those of the query, with a small constant (times:
  // retrieval_benchmark).
  [[nodiscard]] std::vector<RetrievalCandidate> Query(
      const FeatureSet& features, const Predicate& is_excluded = {}) const;
  // Returns the best `num_candidates`, whatever their scores.
  [[nodiscard]] std::vector<RetrievalCandidate> QueryBest(
      const FeatureSet& features, int num_candidates,
      const Predicate& is_excluded = {}) const;

 private:
  struct StoredFeature {
    Eigen::Vector2f position;  // submap frame [m]
    float orientation;         // [rad]
  };
  struct Slot {
    SubmapId id;
    std::vector<StoredFeature> features;
  };
  // Features of one kind from a few submaps, ordered by clearance.
  struct Segment {
    std::vector<float> clearances;
    Eigen::ArrayXXf descriptors;  // one row per feature
    std::vector<int> slots;
    std::vector<int> features;  // indices in the slot
  };
  struct Neighbour {
    float squared_distance;
    int slot;
    int feature;
  };

  [[nodiscard]] static Segment MakeSegment(const FeatureSet& features,
                                           std::vector<int> columns, int slot);
  [[nodiscard]] static Segment SelectRows(const Segment& segment,
                                          const std::vector<int>& rows);
  [[nodiscard]] static Segment Merge(const Segment& a, const Segment& b);
  [[nodiscard]] std::vector<Neighbour> FindNeighbours(
      const Feature& feature, const Eigen::Ref<const Eigen::VectorXf>& query,
      const std::vector<char>& is_excluded) const;
  // Calls visit(squared distance, row) for the rows of similar clearance.
  template <typename Visitor>
  void VisitDistances(const Segment& segment, double clearance,
                      const Eigen::Ref<const Eigen::VectorXf>& query,
                      const Visitor& visit) const;
  // Returns all submaps with a vote, best first.
  [[nodiscard]] std::vector<RetrievalCandidate> Rank(
      const FeatureSet& features, const Predicate& is_excluded) const;
  // Returns the correspondences of the query's features with those of the
  // submap in each slot.
  [[nodiscard]] std::vector<std::vector<WeightedCorrespondence>> Correspond(
      const FeatureSet& query, const Eigen::Vector2d& centroid,
      const std::vector<char>& is_excluded) const;

  const RetrievalOptions options_;
  Eigen::Index descriptor_length_ = 0;  // 0: not known yet
  std::map<SubmapId, int> slots_by_id_;
  std::vector<Slot> slots_;
  std::vector<int> free_slots_;
  // Each segment has less than half the features of the one before.
  std::array<std::vector<Segment>, kNumKeypointKinds> segments_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MATCHING_PLACE_INDEX_H_
