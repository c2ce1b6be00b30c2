// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/fold_check.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/localization/confirmation.h"

namespace cartographer_sdf {
namespace {

struct PairToCheck {
  const Place* reference;
  const Place* query;
  bool overlaps = false;
  std::optional<Match> contradiction;
};

Rigid2 Between(const PoseGraph& graph, const PairToCheck& pair) {
  return graph.submap_poses.at(pair.reference->id).Inverse() *
         graph.submap_poses.at(pair.query->id);
}

class OverlapChecker {
 public:
  OverlapChecker(const FoldCheckOptions& options,
                 const VerificationOptions& verification,
                 const JoinedSessions& joined, const PoseGraph& merged)
      : options_(options),
        verification_(verification),
        joined_(joined),
        merged_(merged) {}

  void Check(PairToCheck* const pair) const {
    const Rigid2 after = Between(merged_, *pair);
    pair->overlaps = Overlap(*pair, after);
    if (!pair->overlaps) return;
    pair->contradiction = Contradiction(*pair, after);
    if (!pair->contradiction || joined_.SessionOf(pair->reference->id) !=
                                    joined_.SessionOf(pair->query->id)) {
      return;
    }
    // What contradicted itself before is not the merge's fault.
    const Rigid2 before = Between(joined_.state.pose_graph, *pair);
    if (Overlap(*pair, before) && Contradiction(*pair, before)) {
      pair->contradiction.reset();
    }
  }

 private:
  [[nodiscard]] static bool Overlap(const PairToCheck& pair,
                                    const Rigid2& T_reference_query) {
    return OverlapsEnough(pair.reference->surface, pair.query->surface,
                          T_reference_query);
  }
  [[nodiscard]] std::optional<Match> Contradiction(
      const PairToCheck& pair, const Rigid2& T_reference_query) const {
    return FindContradiction(verification_, options_.max_contradiction_ratio,
                             *pair.reference, *pair.query, T_reference_query);
  }

  const FoldCheckOptions& options_;
  const VerificationOptions& verification_;
  const JoinedSessions& joined_;
  const PoseGraph& merged_;
};

}  // namespace

std::string Validate(const FoldCheckOptions& options) {
  if (!(options.max_contradiction_ratio > 0. &&
        options.max_contradiction_ratio <= 1.)) {
    return "max_contradiction_ratio must be above 0 and not above 1";
  }
  if (!(options.max_folded_fraction >= 0. &&
        options.max_folded_fraction <= 1.)) {
    return "max_folded_fraction must lie between 0 and 1";
  }
  return "";
}

std::map<std::pair<size_t, size_t>, SessionOverlap> CheckOverlaps(
    const FoldCheckOptions& options, const RecognitionOptions& recognition,
    const JoinedSessions& joined, const PoseGraph& merged,
    const Executor& executor) {
  std::vector<PairToCheck> pairs;
  for (auto reference = joined.places.begin(); reference != joined.places.end();
       ++reference) {
    for (auto query = std::next(reference); query != joined.places.end();
         ++query) {
      if (ShareScans(reference->first, query->first,
                     recognition.min_index_gap)) {
        continue;
      }
      pairs.push_back({&reference->second, &query->second, false, {}});
    }
  }
  const OverlapChecker checker(options, recognition.match.verification, joined,
                               merged);
  executor(pairs.size(), [&](const size_t k) { checker.Check(&pairs[k]); });
  std::map<std::pair<size_t, size_t>, SessionOverlap> overlaps;
  for (PairToCheck& pair : pairs) {
    if (!pair.overlaps) continue;
    SessionOverlap& overlap =
        overlaps[std::minmax({joined.SessionOf(pair.reference->id),
                              joined.SessionOf(pair.query->id)})];
    ++overlap.num_overlapping;
    if (pair.contradiction) {
      overlap.contradictions.push_back(*std::move(pair.contradiction));
    }
  }
  return overlaps;
}

std::string DescribeFold(
    const FoldCheckOptions& options,
    const std::map<std::pair<size_t, size_t>, SessionOverlap>& overlaps,
    const std::vector<const Session*>& sessions) {
  for (const auto& [ids, overlap] : overlaps) {
    const size_t num_folded = overlap.contradictions.size();
    if (static_cast<double>(num_folded) <=
        options.max_folded_fraction * overlap.num_overlapping) {
      continue;
    }
    const PairPose& example = overlap.contradictions.front().pair;
    return absl::StrFormat(
        "the merged map would be folded: of %d pairs of submaps of %s and %s "
        "that it lays over each other %d have walls in each other's free "
        "space, such as %d,%d and %d,%d",
        overlap.num_overlapping, sessions[ids.first]->path,
        sessions[ids.second]->path, num_folded, example.reference.trajectory,
        example.reference.index, example.query.trajectory, example.query.index);
  }
  return "";
}

}  // namespace cartographer_sdf
