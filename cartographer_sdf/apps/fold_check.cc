// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/fold_check.h"

#include <algorithm>
#include <optional>
#include <set>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/apps/map_quality.h"
#include "cartographer_sdf/localization/confirmation.h"
#include "cartographer_sdf/verification/agreement.h"

namespace cartographer_sdf {
namespace {

// Returns the pair at its pose in the graph if it contradicts itself there.
std::optional<Match> FindContradictionIn(
    const FoldCheckOptions& options, const VerificationOptions& verification,
    const PlacePair& pair) {
  return FindContradiction(verification, options.max_contradiction_ratio,
                           *pair.reference, *pair.query,
                           pair.T_reference_query);
}

// Whether the two overlapped and contradicted each other in this graph, too.
bool ContradictedIn(const FoldCheckOptions& options,
                    const VerificationOptions& verification,
                    const PoseGraph& graph, const PlacePair& pair) {
  const PlacePair there = {pair.reference, pair.query,
                           graph.submap_poses.at(pair.reference->id).Inverse() *
                               graph.submap_poses.at(pair.query->id)};
  return OverlapsEnough(there.reference->surface, there.query->surface,
                        there.T_reference_query) &&
         FindContradictionIn(options, verification, there).has_value();
}

using Overlaps = std::map<std::pair<size_t, size_t>, SessionOverlap>;

bool IsFolded(const FoldCheckOptions& options, const SessionOverlap& overlap) {
  return static_cast<double>(overlap.contradictions.size()) >
         options.max_folded_fraction * overlap.num_overlapping;
}

// Returns the one of the two sessions that has more folded pairs of sessions,
// on ties the later: the first is what the others are added to.
size_t SessionAtFault(const FoldCheckOptions& options, const Overlaps& overlaps,
                      const std::pair<size_t, size_t>& ids) {
  std::map<size_t, int> num_folded;
  for (const auto& [pair, overlap] : overlaps) {
    if (!IsFolded(options, overlap)) continue;
    for (const size_t session : std::set<size_t>{pair.first, pair.second}) {
      ++num_folded[session];
    }
  }
  return num_folded[ids.first] > num_folded[ids.second] ? ids.first
                                                        : ids.second;
}

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
  const VerificationOptions& verification = recognition.match.verification;
  const std::vector<PlacePair> pairs = FindOverlappingPairs(
      recognition.min_index_gap, joined.places, merged, executor);
  std::vector<std::optional<Match>> contradictions(pairs.size());
  executor(pairs.size(), [&](const size_t k) {
    const PlacePair& pair = pairs[k];
    contradictions[k] = FindContradictionIn(options, verification, pair);
    // The merge did not cause contradictions that existed before it.
    if (contradictions[k] &&
        joined.SessionOf(pair.reference->id) ==
            joined.SessionOf(pair.query->id) &&
        ContradictedIn(options, verification, joined.state.pose_graph, pair)) {
      contradictions[k].reset();
    }
  });
  std::map<std::pair<size_t, size_t>, SessionOverlap> overlaps;
  for (size_t k = 0; k < pairs.size(); ++k) {
    SessionOverlap& overlap =
        overlaps[std::minmax({joined.SessionOf(pairs[k].reference->id),
                              joined.SessionOf(pairs[k].query->id)})];
    ++overlap.num_overlapping;
    if (contradictions[k]) {
      overlap.contradictions.push_back(*std::move(contradictions[k]));
    }
  }
  return overlaps;
}

std::optional<MergingFault> FindFold(
    const FoldCheckOptions& options,
    const std::map<std::pair<size_t, size_t>, SessionOverlap>& overlaps,
    const std::vector<const Session*>& sessions) {
  for (const auto& [ids, overlap] : overlaps) {
    if (!IsFolded(options, overlap)) continue;
    const PairPose& example = overlap.contradictions.front().pair;
    return MergingFault{
        absl::StrFormat(
            "the merged map would be folded: of %d pairs of submaps of %s and "
            "%s that it lays over each other %d have walls in each other's "
            "free space, such as %d,%d and %d,%d",
            overlap.num_overlapping, sessions[ids.first]->path,
            sessions[ids.second]->path, overlap.contradictions.size(),
            example.reference.trajectory, example.reference.index,
            example.query.trajectory, example.query.index),
        SessionAtFault(options, overlaps, ids)};
  }
  return std::nullopt;
}

}  // namespace cartographer_sdf
