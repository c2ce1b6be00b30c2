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

// The same for a pair whatever else is matched, and in which order.
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
  Match match;
  match.closure.reference = reference.id;
  match.closure.query = query.id;
  match.closure.T_reference_query = alignment->T_reference_query;
  match.closure.score = static_cast<double>(alignment->inliers.size());
  match.closure.evidence.inliers = static_cast<int>(alignment->inliers.size());
  match.verdict = match.closure.evidence.inliers >= options.min_num_inliers
                      ? Verdict::kAccepted
                      : Verdict::kUnlikely;
  for (const Correspondence& c : alignment->inliers) {
    match.inliers.emplace_back(
        reference.features.features[c.reference].keypoint.position,
        query.features.features[c.query].keypoint.position);
  }
  return match;
}

std::vector<Rigid2> ProposePoses(
    const HypothesisOptions& options, const Place& reference,
    const Place& query, const std::vector<Correspondence>& correspondences) {
  std::vector<Rigid2> poses;
  for (const Hypothesis& hypothesis : ProposeHypotheses(
           options, reference.features, query.features, correspondences)) {
    poses.push_back(hypothesis.T_reference_query);
  }
  return poses;
}

Match MakeMatch(const MatchOptions& options, const Place& reference,
                const Place& query,
                const std::vector<Correspondence>& correspondences,
                Verification verification) {
  Match match;
  match.verdict = verification.verdict;
  match.inliers =
      CollectInliers(options.inlier_distance_meters, reference, query,
                     correspondences, verification.T_reference_query);
  match.closure =
      LoopClosure{reference.id,
                  query.id,
                  verification.T_reference_query,
                  verification.information,
                  verification.score,
                  EvidenceOf(verification.agreement,
                             static_cast<int>(match.inliers.size()))};
  match.verification = std::move(verification);
  return match;
}

}  // namespace

ClosureEvidence EvidenceOf(const Agreement& agreement, const int num_inliers) {
  const DirectedAgreement& a = agreement.query_in_reference;
  const DirectedAgreement& b = agreement.reference_in_query;
  ClosureEvidence evidence;
  evidence.inliers = num_inliers;
  evidence.overlap_area = agreement.overlap_area;
  evidence.overlap = agreement.overlap;
  evidence.hit_ratio = std::min(a.HitRatio(), b.HitRatio());
  evidence.contradiction_ratio =
      std::max(a.ContradictionRatio(), b.ContradictionRatio());
  const double hits = a.hits + b.hits;
  evidence.residual =
      hits > 0. ? std::sqrt((a.squared_distance + b.squared_distance) / hits)
                : 0.;
  return evidence;
}

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
  // The paper tells distances apart by the descriptor's last entry alone.
  options.correspondence.max_clearance_difference_meters = 1e6;
  return options;
}

void FindSelfSimilarities(const MatchOptions& options, Place* const place) {
  CHECK_EQ(Validate(options), "");
  place->surface.self_similar_poses = FindSelfSimilarPoses(
      options.verification, place->surface,
      ProposePoses(options.hypotheses, *place, *place,
                   FindCorrespondences(options.correspondence, place->features,
                                       place->features)));
}

std::optional<Match> MatchPlaces(const MatchOptions& options,
                                 const Place& reference, const Place& query) {
  CHECK_EQ(Validate(options), "");
  const std::vector<Correspondence> correspondences = FindCorrespondences(
      options.correspondence, reference.features, query.features);
  if (options.method == Method::kPaper) {
    return MatchAsPaper(options, reference, query, correspondences);
  }
  std::optional<Verification> verification = VerifyHypotheses(
      options.verification, reference.surface, query.surface,
      ProposePoses(options.hypotheses, reference, query, correspondences));
  if (!verification) return std::nullopt;
  return MakeMatch(options, reference, query, correspondences,
                   *std::move(verification));
}

Match MakeMatch(const MatchOptions& options, const Place& reference,
                const Place& query, Verification verification) {
  return MakeMatch(options, reference, query,
                   FindCorrespondences(options.correspondence,
                                       reference.features, query.features),
                   std::move(verification));
}

}  // namespace cartographer_sdf
