// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/neighbours.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using IdPair = std::pair<SubmapId, SubmapId>;

// Proposals of one pair that are nearer than this are one [m], [rad].
constexpr double kSameDistance = 0.5;
constexpr double kSameRotation = 0.15;
// The best ones that are looked at.
constexpr size_t kMaxNumProposals = 4;

// A pose of a pair and who says so.
struct Proposal {
  Rigid2 T_reference_query;
  double score;  // of the match that proposes it
};

// One pose of a pair, judged.
struct Opinion {
  Verification verification;
  NeighbourhoodEvidence evidence;
  double score;
};

class PairJudge {
 public:
  PairJudge(const NeighbourhoodOptions& options,
            const MatchOptions& match_options,
            const PlacesAlongTrajectories& references,
            const PlacesAlongTrajectories& queries,
            const std::optional<int> min_index_gap)
      : options_(options),
        match_options_(match_options),
        references_(references),
        queries_(queries),
        min_index_gap_(min_index_gap) {}

  // Fills in the neighbourhood's score; returns what follows for other pairs.
  std::vector<PoseProposal> AskAlone(Match* const match) const {
    Neighbourhood neighbourhood;
    if (match->verification->score >= options_.min_pair_score) {
      neighbourhood = Ask(match->closure.reference, match->closure.query,
                          match->closure.T_reference_query);
    }
    SetEvidence(neighbourhood.evidence, match);
    if (match->closure.score < options_.min_proposing_score) return {};
    return std::move(neighbourhood.proposals);
  }

  // The most likely of the match's own pose, its rivals and the proposals.
  std::optional<Match> AskAll(const IdPair& ids, const Match* const match,
                              const std::vector<Proposal>& proposals) const {
    const Place& reference = references_.places->at(ids.first);
    const Place& query = queries_.places->at(ids.second);
    std::vector<Rigid2> poses;
    if (match != nullptr) {
      poses.push_back(match->closure.T_reference_query);
      const std::vector<Rigid2>& rivals = match->verification->rivals;
      poses.insert(poses.end(), rivals.begin(), rivals.end());
    }
    for (const Proposal& proposal : proposals) {
      poses.push_back(proposal.T_reference_query);
    }
    std::vector<Opinion> opinions;
    for (Verification& verification :
         VerifyPoses(match_options_.verification, reference.surface,
                     query.surface, poses)) {
      Opinion opinion;
      if (verification.score >= options_.min_pair_score) {
        opinion.evidence =
            Ask(ids.first, ids.second, verification.T_reference_query).evidence;
      }
      opinion.score =
          NeighbourhoodScore(options_, verification.score, opinion.evidence);
      opinion.verification = std::move(verification);
      opinions.push_back(std::move(opinion));
    }
    if (opinions.empty()) return std::nullopt;
    std::stable_sort(
        opinions.begin(), opinions.end(),
        [](const Opinion& a, const Opinion& b) { return a.score > b.score; });
    Opinion& best = opinions.front();
    Match judged = MakeMatch(match_options_, reference, query,
                             std::move(best.verification));
    SetEvidence(best.evidence, &judged);
    const double lead = opinions.size() > 1 ? best.score - opinions[1].score
                                            : judged.verification->margin;
    judged.verdict =
        Judge(match_options_.verification, judged.verification->agreement,
              judged.closure.score, lead);
    return judged;
  }

 private:
  Neighbourhood Ask(const SubmapId& reference, const SubmapId& query,
                    const Rigid2& T_reference_query) const {
    return AskNeighbours(options_, match_options_.verification, references_,
                         queries_, min_index_gap_, reference, query,
                         T_reference_query);
  }

  void SetEvidence(const NeighbourhoodEvidence& evidence,
                   Match* const match) const {
    match->neighbourhood = evidence;
    match->closure.score =
        NeighbourhoodScore(options_, match->verification->score, evidence);
    match->verdict =
        Judge(match_options_.verification, match->verification->agreement,
              match->closure.score, match->verification->margin);
  }

  const NeighbourhoodOptions& options_;
  const MatchOptions& match_options_;
  const PlacesAlongTrajectories& references_;
  const PlacesAlongTrajectories& queries_;
  const std::optional<int> min_index_gap_;
};

// Best first; of nearly equal ones the best.
std::vector<Proposal> KeepBest(std::vector<Proposal> proposals,
                               const Place& query) {
  std::stable_sort(
      proposals.begin(), proposals.end(),
      [](const Proposal& a, const Proposal& b) { return a.score > b.score; });
  // Any point that the query has seen.
  const Eigen::Vector2d& point = query.surface.observed_points.front();
  std::vector<Proposal> kept;
  for (const Proposal& proposal : proposals) {
    if (kept.size() >= kMaxNumProposals) break;
    const bool is_new =
        std::none_of(kept.begin(), kept.end(), [&](const Proposal& better) {
          return AreNear(proposal.T_reference_query, better.T_reference_query,
                         point, kSameDistance, kSameRotation);
        });
    if (is_new) kept.push_back(proposal);
  }
  return kept;
}

}  // namespace

void JudgeByNeighbours(const NeighbourhoodOptions& options,
                       const MatchOptions& match_options,
                       const PlacesAlongTrajectories& references,
                       const PlacesAlongTrajectories& queries,
                       const std::optional<int> min_index_gap,
                       const Executor& executor,
                       const ProgressCallback& on_progress,
                       std::vector<Match>* const matches) {
  CHECK_EQ(Validate(options), "");
  CHECK(match_options.method == Method::kSdf);
  const PairJudge judge(options, match_options, references, queries,
                        min_index_gap);
  std::mutex progress_mutex;
  size_t num_done = 0;
  const auto tell = [&](const double begin, const size_t count) {
    if (!on_progress) return;
    const std::lock_guard<std::mutex> lock(progress_mutex);
    on_progress(begin + 0.5 * static_cast<double>(++num_done) /
                            static_cast<double>(count));
  };

  std::vector<std::vector<PoseProposal>> proposed(matches->size());
  executor(matches->size(), [&](const size_t k) {
    proposed[k] = judge.AskAlone(&(*matches)[k]);
    tell(0., matches->size());
  });

  // Pairs that have something to decide, in the order of their ids.
  std::map<IdPair, std::vector<Proposal>> by_pair;
  std::map<IdPair, const Match*> match_of;
  for (size_t k = 0; k < matches->size(); ++k) {
    const Match& match = (*matches)[k];
    const IdPair ids(match.closure.reference, match.closure.query);
    match_of[ids] = &match;
    if (!match.verification->rivals.empty() &&
        match.closure.score >= options.min_proposing_score) {
      by_pair[ids];
    }
    for (const PoseProposal& proposal : proposed[k]) {
      const bool is_reversed =
          min_index_gap.has_value() && proposal.query < proposal.reference;
      by_pair[is_reversed ? IdPair(proposal.query, proposal.reference)
                          : IdPair(proposal.reference, proposal.query)]
          .push_back({is_reversed ? proposal.T_reference_query.Inverse()
                                  : proposal.T_reference_query,
                      match.closure.score});
    }
  }
  struct Task {
    IdPair ids;
    const Match* match;  // null where the pair has none
    std::vector<Proposal> proposals;
  };
  std::vector<Task> tasks;
  for (auto& [ids, proposals] : by_pair) {
    const auto found = match_of.find(ids);
    const Match* const match =
        found == match_of.end() ? nullptr : found->second;
    const Place& query = queries.places->at(ids.second);
    std::vector<Proposal> kept = KeepBest(std::move(proposals), query);
    if (match != nullptr) {
      const Eigen::Vector2d& point = query.surface.observed_points.front();
      kept.erase(std::remove_if(kept.begin(), kept.end(),
                                [&](const Proposal& proposal) {
                                  return AreNear(
                                      proposal.T_reference_query,
                                      match->closure.T_reference_query, point,
                                      kSameDistance, kSameRotation);
                                }),
                 kept.end());
      if (kept.empty() && match->verification->rivals.empty()) continue;
    }
    tasks.push_back({ids, match, std::move(kept)});
  }
  std::vector<std::optional<Match>> judged(tasks.size());
  num_done = 0;
  executor(tasks.size(), [&](const size_t k) {
    judged[k] = judge.AskAll(tasks[k].ids, tasks[k].match, tasks[k].proposals);
    tell(0.5, tasks.size());
  });
  std::map<IdPair, Match> all;
  for (std::optional<Match>& match : judged) {
    if (!match) continue;
    const IdPair ids(match->closure.reference, match->closure.query);
    all.emplace(ids, *std::move(match));
  }
  for (Match& match : *matches) {
    // Does nothing where the pair was judged anew.
    const IdPair ids(match.closure.reference, match.closure.query);
    all.try_emplace(ids, std::move(match));
  }
  matches->clear();
  for (auto& [ids, match] : all) matches->push_back(std::move(match));
}

}  // namespace cartographer_sdf
