// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood_verification.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Proposals of one pair that are nearer than this count as one.
constexpr PoseTolerance kSameProposal{0.5, 0.15};
// At most this many proposals of a pair, the best, are verified.
constexpr size_t kMaxNumProposals = 4;

// One pose of a pair, verified with its neighbourhood.
struct Opinion {
  VerifiedPose verified;
  Neighbourhood neighbourhood;
  double score;
};

// A pair that the second pass decides.
struct Task {
  IdPair ids;
  const Match* match;  // null where the pair has none
  // Poses that neighbours propose, with the scores of the proposing matches.
  std::vector<PairPose> proposals;
};

struct Decision {
  Match match;
  std::vector<PairPose> proposals;  // to other pairs
};

IdPair IdsOf(const PairPose& pair) { return {pair.reference, pair.query}; }

// Bounds the matches of each submap that only neighbours propose: a place that
// was seen n times has some n^2 / 2 pairs, and most say what others have said.
class MatchBudget {
 public:
  explicit MatchBudget(const int max_num_matches_per_submap)
      : max_num_matches_(max_num_matches_per_submap) {}

  // Whether one of the two submaps has matches to come.
  [[nodiscard]] bool Affords(const IdPair& ids) const {
    return max_num_matches_ == 0 || NumSpent(ids.first) < max_num_matches_ ||
           NumSpent(ids.second) < max_num_matches_;
  }
  void Spend(const IdPair& ids) {
    ++num_spent_[ids.first];
    ++num_spent_[ids.second];
  }

 private:
  [[nodiscard]] int NumSpent(const SubmapId& id) const {
    const auto found = num_spent_.find(id);
    return found == num_spent_.end() ? 0 : found->second;
  }

  const int max_num_matches_;
  std::map<SubmapId, int> num_spent_;
};

// Leaves out tasks without a match that the budget does not afford once the
// likelier ones are done. `tasks` stay in their order.
void KeepAffordable(MatchBudget budget, std::vector<Task>* const tasks) {
  std::vector<Task*> unmatched;
  for (Task& task : *tasks) {
    if (task.match == nullptr) unmatched.push_back(&task);
  }
  std::stable_sort(unmatched.begin(), unmatched.end(),
                   [](const Task* const a, const Task* const b) {
                     return a->proposals[0].score > b->proposals[0].score;
                   });
  std::set<IdPair> left_out;
  for (const Task* const task : unmatched) {
    if (budget.Affords(task->ids)) {
      budget.Spend(task->ids);
    } else {
      left_out.insert(task->ids);
    }
  }
  tasks->erase(std::remove_if(tasks->begin(), tasks->end(),
                              [&left_out](const Task& task) {
                                return left_out.count(task.ids) > 0;
                              }),
               tasks->end());
}

class NeighbourhoodVerifier {
 public:
  NeighbourhoodVerifier(const NeighbourhoodOptions& options,
                        const MatchOptions& match_options,
                        const NeighbourhoodMaps& maps)
      : options_(options),
        match_options_(match_options),
        maps_(maps),
        meter_(options, match_options.verification, maps) {
    CHECK_EQ(Validate(options), "");
    CHECK(match_options.method == Method::kSdf);
  }

  // Sets score and verdict of a match at its given pose; returns the poses that
  // it proposes to other pairs, with its score.
  std::vector<PairPose> VerifyMatch(Match* const match) const {
    Neighbourhood neighbourhood;
    if (match->pair_score >= options_.min_pair_score) {
      neighbourhood =
          Measure({match->pair.reference, match->pair.query,
                   match->pair.T_reference_query, match->pair_score});
    }
    SetEvidence(neighbourhood.evidence, match);
    return ProposalsOf(*match, std::move(neighbourhood.proposals));
  }

  // Returns the pairs that have proposals or rivals to choose from, by their
  // ids; those without a match as far as the budget allows.
  [[nodiscard]] std::vector<Task> CollectTasks(
      const std::map<IdPair, Match>& matches,
      const std::vector<PairPose>& proposals) const {
    std::map<IdPair, Task> tasks;
    for (const auto& [ids, match] : matches) {
      if (!match.rivals.empty() &&
          match.pair.score >= options_.min_proposing_score) {
        tasks.emplace(ids, Task{ids, &match, {}});
      }
    }
    for (const PairPose& proposal : proposals) {
      const IdPair ids = IdsOf(proposal);
      const auto [task, is_new] =
          tasks.try_emplace(ids, Task{ids, nullptr, {}});
      if (is_new) {
        const auto match = matches.find(ids);
        if (match != matches.end()) task->second.match = &match->second;
      }
      task->second.proposals.push_back(proposal);
    }
    return Affordable(std::move(tasks), matches);
  }

  // Where an accepted match puts the unmatched pairs of submaps around its own
  // that the budget affords; nothing if it is too unlikely.
  void ProposeAround(const Match& match, const std::map<IdPair, Match>& matches,
                     const MatchBudget& budget,
                     std::vector<PairPose>* const proposals) const {
    const PairPose& pair = match.pair;
    if (match.verdict != Verdict::kAccepted ||
        pair.score < options_.min_proposing_score) {
      return;
    }
    const int distance = options_.max_proposal_index_distance;
    for (const SubmapId& i :
         SubmapsAround(maps_.references, maps_.reference_links, pair.reference,
                       distance, 1)) {
      const Rigid2 T_i_query =
          RelativePose(maps_.references, i, pair.reference) *
          pair.T_reference_query;
      for (const SubmapId& j : SubmapsAround(maps_.queries, maps_.query_links,
                                             pair.query, distance, 1)) {
        if (maps_.min_index_gap && ShareScans(i, j, *maps_.min_index_gap)) {
          continue;
        }
        const PairPose proposal = InOrder(
            {i, j, T_i_query * RelativePose(maps_.queries, pair.query, j),
             pair.score});
        const IdPair ids = IdsOf(proposal);
        if (matches.count(ids) == 0 && budget.Affords(ids) &&
            Overlap(proposal)) {
          proposals->push_back(proposal);
        }
      }
    }
  }

  // Returns the pairs without a match that have proposals, by their ids, as far
  // as the budget allows.
  [[nodiscard]] std::vector<Task> CollectUnmatched(
      const std::map<IdPair, Match>& matches,
      const std::vector<PairPose>& proposals) const {
    std::map<IdPair, Task> tasks;
    for (const PairPose& proposal : proposals) {
      const IdPair ids = IdsOf(proposal);
      if (matches.count(ids) > 0) continue;
      tasks.try_emplace(ids, Task{ids, nullptr, {}})
          .first->second.proposals.push_back(proposal);
    }
    return Affordable(std::move(tasks), matches);
  }

  // What the matches so far leave. Between two maps there is no bound: all
  // matches vote for a placement.
  [[nodiscard]] MatchBudget Budget(
      const std::map<IdPair, Match>& matches) const {
    MatchBudget budget(maps_.min_index_gap ? options_.max_num_matches_per_submap
                                           : 0);
    for (const auto& [ids, match] : matches) {
      if (match.verdict == Verdict::kAccepted) budget.Spend(ids);
    }
    return budget;
  }

  // Returns the most likely of the match's own pose, its rivals and the
  // proposals; nullopt if none of them can be registered.
  [[nodiscard]] std::optional<Decision> Decide(const Task& task) const {
    const Place& reference = maps_.references.places->at(task.ids.first);
    const Place& query = maps_.queries.places->at(task.ids.second);
    std::vector<Opinion> opinions = OpinionsOn(task, reference, query);
    if (opinions.empty()) return std::nullopt;
    std::stable_sort(
        opinions.begin(), opinions.end(),
        [](const Opinion& a, const Opinion& b) { return a.score > b.score; });
    const double lead = opinions.size() > 1
                            ? opinions[0].score - opinions[1].score
                            : opinions[0].verified.margin;
    Decision decision{MakeMatch(match_options_, reference, query,
                                std::move(opinions[0].verified)),
                      {}};
    Match& match = decision.match;
    SetEvidence(opinions[0].neighbourhood.evidence, &match);
    match.verdict = Judge(match_options_.verification.judgement, match.evidence,
                          match.pair.score, lead);
    decision.proposals =
        ProposalsOf(match, std::move(opinions[0].neighbourhood.proposals));
    return decision;
  }

 private:
  // Verifies the poses of a task, each with its neighbourhood.
  [[nodiscard]] std::vector<Opinion> OpinionsOn(const Task& task,
                                                const Place& reference,
                                                const Place& query) const {
    // A pair that was never matched needs rivals of its own.
    std::vector<Rigid2> hypotheses;
    if (task.match == nullptr) {
      hypotheses = ProposePoses(match_options_, reference, query);
    }
    std::vector<Opinion> opinions;
    for (VerifiedPose& verified :
         VerifyPoses(match_options_.verification, reference.surface,
                     query.surface, PosesOf(task), hypotheses)) {
      Opinion opinion;
      if (verified.score >= options_.min_pair_score) {
        opinion.neighbourhood =
            Measure({task.ids.first, task.ids.second,
                     verified.T_reference_query, verified.score});
      }
      opinion.score = NeighbourhoodScore(options_, verified.score,
                                         opinion.neighbourhood.evidence);
      opinion.verified = std::move(verified);
      opinions.push_back(std::move(opinion));
    }
    return opinions;
  }

  // Those of the tasks that leave a choice and that the budget affords.
  [[nodiscard]] std::vector<Task> Affordable(
      std::map<IdPair, Task>&& tasks,
      const std::map<IdPair, Match>& matches) const {
    std::vector<Task> result;
    for (auto& [ids, task] : tasks) {
      KeepBestProposals(&task);
      if (!task.proposals.empty() || !task.match->rivals.empty()) {
        result.push_back(std::move(task));
      }
    }
    KeepAffordable(Budget(matches), &result);
    return result;
  }

  // The registered neighbours of a match as proposals, with its score; none if
  // it is too unlikely.
  [[nodiscard]] std::vector<PairPose> ProposalsOf(
      const Match& match, std::vector<PairPose> neighbours) const {
    if (match.pair.score < options_.min_proposing_score) return {};
    for (PairPose& proposal : neighbours) {
      proposal.score = match.pair.score;
      proposal = InOrder(proposal);
    }
    return neighbours;
  }

  // Within one map, the lower id is the reference.
  [[nodiscard]] PairPose InOrder(PairPose pair) const {
    if (maps_.min_index_gap && pair.query < pair.reference) {
      std::swap(pair.reference, pair.query);
      pair.T_reference_query = pair.T_reference_query.Inverse();
    }
    return pair;
  }

  [[nodiscard]] bool Overlap(const PairPose& pair) const {
    return OverlapsBy(options_.min_overlap_area,
                      maps_.references.places->at(pair.reference).surface,
                      maps_.queries.places->at(pair.query).surface,
                      pair.T_reference_query);
  }

  [[nodiscard]] Neighbourhood Measure(const PairPose& pair) const {
    return meter_.Measure(pair);
  }

  void SetEvidence(const NeighbourhoodEvidence& evidence,
                   Match* const match) const {
    match->neighbourhood = evidence;
    match->pair.score =
        NeighbourhoodScore(options_, match->pair_score, evidence);
    match->verdict = Judge(match_options_.verification.judgement,
                           match->evidence, match->pair.score, match->margin);
  }

  // Keeps the best proposals that are distinct from each other and from the
  // match's own pose.
  void KeepBestProposals(Task* const task) const {
    std::stable_sort(
        task->proposals.begin(), task->proposals.end(),
        [](const PairPose& a, const PairPose& b) { return a.score > b.score; });
    const Eigen::Vector2d centroid =
        ObservedCentroid(maps_.queries.places->at(task->ids.second).surface);
    std::vector<PairPose> kept = KeepDistinct(
        task->proposals,
        [](const PairPose& proposal) { return proposal.T_reference_query; },
        centroid, kSameProposal, kMaxNumProposals);
    if (task->match != nullptr) {
      kept.erase(std::remove_if(kept.begin(), kept.end(),
                                [&](const PairPose& proposal) {
                                  return AreNear(
                                      proposal.T_reference_query,
                                      task->match->pair.T_reference_query,
                                      centroid, kSameProposal);
                                }),
                 kept.end());
    }
    task->proposals = std::move(kept);
  }

  [[nodiscard]] static std::vector<Rigid2> PosesOf(const Task& task) {
    std::vector<Rigid2> poses;
    if (task.match != nullptr) {
      poses.push_back(task.match->pair.T_reference_query);
      poses.insert(poses.end(), task.match->rivals.begin(),
                   task.match->rivals.end());
    }
    for (const PairPose& proposal : task.proposals) {
      poses.push_back(proposal.T_reference_query);
    }
    return poses;
  }

  const NeighbourhoodOptions& options_;
  const MatchOptions& match_options_;
  const NeighbourhoodMaps& maps_;
  mutable NeighbourhoodMeter meter_;  // remembers
};

// Only what pairs found by themselves: poses that neighbours propose are no
// independent evidence.
OwnMatches OwnMatchesOf(const std::vector<Match>& matches) {
  OwnMatches own_matches;
  for (const Match& match : matches) {
    PairPose pair = match.pair;
    pair.score = match.pair_score;
    own_matches.emplace(IdsOf(pair), pair);
  }
  return own_matches;
}

using Proposals = std::vector<std::vector<PairPose>>;

std::vector<PairPose> Concatenated(const Proposals& proposals) {
  std::vector<PairPose> all;
  for (const std::vector<PairPose>& some : proposals) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

// Runs the tasks and enters their decisions; returns what these propose.
std::vector<PairPose> DecideAll(const NeighbourhoodVerifier& verifier,
                                const std::vector<Task>& tasks,
                                const Executor& executor,
                                TaskProgress* const progress,
                                std::map<IdPair, Match>* const matches) {
  std::vector<std::optional<Decision>> decisions(tasks.size());
  executor(tasks.size(), [&](const size_t k) {
    decisions[k] = verifier.Decide(tasks[k]);
    progress->TaskIsDone();
  });
  std::vector<PairPose> proposals;
  for (std::optional<Decision>& decision : decisions) {
    if (!decision) continue;
    proposals.insert(proposals.end(), decision->proposals.begin(),
                     decision->proposals.end());
    const IdPair ids = IdsOf(decision->match.pair);
    matches->insert_or_assign(ids, std::move(decision->match));
  }
  return proposals;
}

// Accepted matches propose poses to the unmatched pairs around them, until they
// find no more.
void SpreadAccepted(const NeighbourhoodVerifier& verifier,
                    const Executor& executor,
                    std::map<IdPair, Match>* const matches) {
  std::set<IdPair> have_proposed;
  for (;;) {
    const MatchBudget budget = verifier.Budget(*matches);
    std::vector<PairPose> proposals;
    for (const auto& [ids, match] : *matches) {
      if (have_proposed.insert(ids).second) {
        verifier.ProposeAround(match, *matches, budget, &proposals);
      }
    }
    const std::vector<Task> tasks =
        verifier.CollectUnmatched(*matches, proposals);
    if (tasks.empty()) return;
    TaskProgress no_progress({}, tasks.size());
    DecideAll(verifier, tasks, executor, &no_progress, matches);
  }
}

}  // namespace

std::vector<Match> VerifyNeighbourhoods(const NeighbourhoodOptions& options,
                                        const MatchOptions& match_options,
                                        NeighbourhoodMaps maps,
                                        std::vector<Match> matches,
                                        const Executor& executor,
                                        const ProgressCallback& on_progress) {
  const OwnMatches own_matches = OwnMatchesOf(matches);
  maps.own_matches = &own_matches;
  const NeighbourhoodVerifier verifier(options, match_options, maps);
  Proposals first_proposals(matches.size());
  TaskProgress first_half(on_progress, matches.size(), 0., 0.5);
  executor(matches.size(), [&](const size_t k) {
    first_proposals[k] = verifier.VerifyMatch(&matches[k]);
    first_half.TaskIsDone();
  });
  std::map<IdPair, Match> by_ids;
  for (Match& match : matches) {
    const IdPair ids = IdsOf(match.pair);
    by_ids.emplace(ids, std::move(match));
  }
  std::vector<PairPose> proposals = Concatenated(first_proposals);
  double done = 0.5;
  for (int round = 0; round < options.max_num_rounds; ++round) {
    const std::vector<Task> tasks =
        round == 0 ? verifier.CollectTasks(by_ids, proposals)
                   : verifier.CollectUnmatched(by_ids, proposals);
    if (tasks.empty()) break;
    // Each round has fewer tasks than the one before.
    TaskProgress progress(on_progress, tasks.size(), done, 0.5 * (1. + done));
    done = 0.5 * (1. + done);
    proposals = DecideAll(verifier, tasks, executor, &progress, &by_ids);
  }
  SpreadAccepted(verifier, executor, &by_ids);
  std::vector<Match> result;
  for (auto& [ids, match] : by_ids) result.push_back(std::move(match));
  return result;
}

void VerifyNeighbourhood(const NeighbourhoodOptions& options,
                         const MatchOptions& match_options,
                         const NeighbourhoodMaps& maps, Match* const match) {
  NeighbourhoodVerifier(options, match_options, maps).VerifyMatch(match);
}

}  // namespace cartographer_sdf
