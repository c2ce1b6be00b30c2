// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/fold_check.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/localization/confirmation.h"

namespace cartographer_sdf {
namespace {

// Two submaps that overlap in the graph.
struct Overlap {
  std::optional<Match> contradiction;
};

struct OverlappingPair {
  const Place* reference;
  const Place* query;
  std::optional<Overlap> overlap;
};

std::vector<OverlappingPair> ListPairs(
    const int min_index_gap, const std::map<SubmapId, Place>& places) {
  std::vector<OverlappingPair> pairs;
  for (auto reference = places.begin(); reference != places.end();
       ++reference) {
    for (auto query = std::next(reference); query != places.end(); ++query) {
      if (ShareScans(reference->first, query->first, min_index_gap)) {
        continue;
      }
      pairs.push_back({&reference->second, &query->second, {}});
    }
  }
  return pairs;
}

// Returns none if the two do not overlap in the graph.
std::optional<Overlap> FindOverlap(const FoldCheckOptions& options,
                                   const VerificationOptions& verification,
                                   const OverlappingPair& pair,
                                   const PoseGraph& graph) {
  const Rigid2 T_reference_query =
      graph.submap_poses.at(pair.reference->id).Inverse() *
      graph.submap_poses.at(pair.query->id);
  if (!OverlapsEnough(pair.reference->surface, pair.query->surface,
                      T_reference_query)) {
    return std::nullopt;
  }
  return Overlap{
      FindContradiction(verification, options.max_contradiction_ratio,
                        *pair.reference, *pair.query, T_reference_query)};
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
  std::vector<OverlappingPair> pairs =
      ListPairs(recognition.min_index_gap, joined.places);
  const auto check = [&](const OverlappingPair& pair, const PoseGraph& graph) {
    return FindOverlap(options, recognition.match.verification, pair, graph);
  };
  executor(pairs.size(), [&](const size_t k) {
    OverlappingPair& pair = pairs[k];
    pair.overlap = check(pair, merged);
    if (!pair.overlap || !pair.overlap->contradiction ||
        joined.SessionOf(pair.reference->id) !=
            joined.SessionOf(pair.query->id)) {
      return;
    }
    // The merge did not cause contradictions that existed before it.
    const std::optional<Overlap> before = check(pair, joined.state.pose_graph);
    if (before && before->contradiction) pair.overlap->contradiction.reset();
  });
  std::map<std::pair<size_t, size_t>, SessionOverlap> overlaps;
  for (OverlappingPair& pair : pairs) {
    if (!pair.overlap) continue;
    SessionOverlap& overlap =
        overlaps[std::minmax({joined.SessionOf(pair.reference->id),
                              joined.SessionOf(pair.query->id)})];
    ++overlap.num_overlapping;
    if (pair.overlap->contradiction) {
      overlap.contradictions.push_back(*std::move(pair.overlap->contradiction));
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
