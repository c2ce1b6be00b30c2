// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/match.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using InlierPairs = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

// Correspondences that agree with the pose, each keypoint once.
InlierPairs CollectInliers(const double max_distance, const Place& reference,
                           const Place& query,
                           const std::vector<Correspondence>& correspondences,
                           const Rigid2& T_reference_query) {
  InlierPairs inliers;
  for (const Correspondence& c : correspondences) {
    const Eigen::Vector2d& r =
        reference.features.features[c.reference].keypoint.position;
    const Eigen::Vector2d& q =
        query.features.features[c.query].keypoint.position;
    if ((T_reference_query * q - r).norm() > max_distance) continue;
    const bool used = std::any_of(
        inliers.begin(), inliers.end(), [&r, &q](const auto& other) {
          return other.first == r || other.second == q;
        });
    if (!used) inliers.emplace_back(r, q);
  }
  return inliers;
}

// Depends on the pair alone, not on other matches or their order.
uint64_t PairSeed(const int seed, const SubmapId& reference,
                  const SubmapId& query) {
  uint64_t hash = static_cast<uint64_t>(seed);
  for (const int value :
       {reference.trajectory, reference.index, query.trajectory, query.index}) {
    // The finalising steps of SplitMix64 ([Steele2014]).
    hash += static_cast<uint64_t>(value) + 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
    hash ^= hash >> 31;
  }
  return hash;
}

std::optional<Match> MatchAsPaper(
    const MatchOptions& options, const Place& reference, const Place& query,
    const std::vector<Correspondence>& correspondences) {
  const std::optional<Alignment> alignment = AlignByRansac(
      options.ransac, reference.features, query.features, correspondences,
      PairSeed(options.seed, reference.id, query.id));
  if (!alignment) return std::nullopt;
  const int num_inliers = static_cast<int>(alignment->inliers.size());
  Match match;
  match.pair = {reference.id, query.id, alignment->T_reference_query,
                static_cast<double>(num_inliers)};
  match.pair_score = match.pair.score;
  match.verdict = num_inliers >= options.min_num_inliers ? Verdict::kAccepted
                                                         : Verdict::kUnlikely;
  for (const Correspondence& c : alignment->inliers) {
    match.inliers.emplace_back(
        reference.features.features[c.reference].keypoint.position,
        query.features.features[c.query].keypoint.position);
  }
  return match;
}

Match MakeMatch(const MatchOptions& options, const Place& reference,
                const Place& query,
                const std::vector<Correspondence>& correspondences,
                VerifiedPose verified) {
  Match match;
  match.pair = {reference.id, query.id, verified.T_reference_query,
                verified.score};
  match.verdict = verified.verdict;
  match.evidence = verified.evidence;
  match.pair_score = verified.score;
  match.margin = verified.margin;
  match.rivals = std::move(verified.rivals);
  match.inliers =
      CollectInliers(options.inlier_distance_meters, reference, query,
                     correspondences, match.pair.T_reference_query);
  return match;
}

}  // namespace

std::string Validate(const MatchOptions& options) {
  for (const std::string& error :
       {Validate(options.correspondence), Validate(options.hypotheses),
        Validate(options.verification), Validate(options.ransac)}) {
    if (!error.empty()) return error;
  }
  if (!(options.inlier_distance_meters > 0.)) {
    return "inlier_distance_meters must be positive";
  }
  if (options.min_num_inliers < 2) {
    return "min_num_inliers must be at least 2";
  }
  return "";
}

PlaceOptions PaperPlaceOptions() { return PlaceOptions(); }

MatchOptions PaperMatchOptions() {
  MatchOptions options;
  options.method = Method::kPaper;
  options.correspondence.num_neighbours = 1;
  options.correspondence.use_ratio_test = true;
  // The paper compares distances only by the descriptor's last entry.
  options.correspondence.max_clearance_difference_meters = 1e6;
  return options;
}

void FindSelfSimilarities(const MatchOptions& options, Place* const place) {
  CHECK_EQ(Validate(options), "");
  place->surface.self_similar_poses =
      FindSelfSimilarPoses(options.verification, place->surface,
                           ProposePoses(options, *place, *place));
}

std::vector<Rigid2> ProposePoses(const MatchOptions& options,
                                 const Place& reference, const Place& query) {
  return ProposePoses(options.hypotheses, reference.features, query.features,
                      FindCorrespondences(options.correspondence,
                                          reference.features, query.features));
}

std::optional<Match> MatchPlaces(
    const MatchOptions& options, const Place& reference, const Place& query,
    const std::vector<Rigid2>& proposed_T_reference_query) {
  CHECK_EQ(Validate(options), "");
  const std::vector<Correspondence> correspondences = FindCorrespondences(
      options.correspondence, reference.features, query.features);
  if (options.method == Method::kPaper) {
    return MatchAsPaper(options, reference, query, correspondences);
  }
  std::vector<Rigid2> hypotheses = ProposePoses(
      options.hypotheses, reference.features, query.features, correspondences);
  hypotheses.insert(hypotheses.end(), proposed_T_reference_query.begin(),
                    proposed_T_reference_query.end());
  std::optional<VerifiedPose> verified = VerifyHypotheses(
      options.verification, reference.surface, query.surface, hypotheses);
  if (!verified) return std::nullopt;
  return MakeMatch(options, reference, query, correspondences,
                   *std::move(verified));
}

Match MakeMatch(const MatchOptions& options, const Place& reference,
                const Place& query, VerifiedPose verified) {
  return MakeMatch(options, reference, query,
                   FindCorrespondences(options.correspondence,
                                       reference.features, query.features),
                   std::move(verified));
}

}  // namespace cartographer_sdf
