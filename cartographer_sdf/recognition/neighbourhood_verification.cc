// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood_verification.h"

#include <algorithm>
#include <map>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using IdPair = std::pair<SubmapId, SubmapId>;  // reference, query

// Proposals of one pair that are nearer than this count as one.
constexpr PoseTolerance kSameProposal{0.5, 0.15};
// At most this many proposals of a pair, the best, are verified.
constexpr size_t kMaxNumProposals = 4;

// One pose of a pair, verified with its neighbourhood.
struct Opinion {
  VerifiedPose verified;
  NeighbourhoodEvidence evidence;
  double score;
};

// A pair that the second pass decides.
struct Task {
  IdPair ids;
  const Match* match;  // null where the pair has none
  // Poses that neighbours propose, with the scores of the proposing matches.
  std::vector<PairPose> proposals;
};

IdPair IdsOf(const PairPose& pair) { return {pair.reference, pair.query}; }

class NeighbourhoodVerifier {
 public:
  NeighbourhoodVerifier(const NeighbourhoodOptions& options,
                        const MatchOptions& match_options,
                        const TrajectoryPlaces& references,
                        const TrajectoryPlaces& queries,
                        const std::optional<int> min_index_gap)
      : options_(options),
        match_options_(match_options),
        references_(references),
        queries_(queries),
        min_index_gap_(min_index_gap) {
    CHECK_EQ(Validate(options), "");
    CHECK(match_options.method == Method::kSdf);
  }

  // Sets score and verdict of a match at its given pose; returns the poses that
  // it proposes to other pairs, with its score.
  std::vector<PairPose> VerifyMatch(Match* const match) const {
    Neighbourhood neighbourhood;
    if (match->pair_score >= options_.min_pair_score) {
      neighbourhood = Measure(match->pair);
    }
    SetEvidence(neighbourhood.evidence, match);
    if (match->pair.score < options_.min_proposing_score) return {};
    for (PairPose& proposal : neighbourhood.proposals) {
      proposal.score = match->pair.score;
      // Within one map, the lower id is the reference.
      if (min_index_gap_ && proposal.query < proposal.reference) {
        std::swap(proposal.reference, proposal.query);
        proposal.T_reference_query = proposal.T_reference_query.Inverse();
      }
    }
    return std::move(neighbourhood.proposals);
  }

  // Returns the pairs that have proposals or rivals to choose from, by their
  // ids.
  [[nodiscard]] std::vector<Task> CollectTasks(
      const std::vector<Match>& matches,
      const std::vector<std::vector<PairPose>>& proposals) const {
    std::map<IdPair, Task> tasks;
    const auto task_of = [&tasks](const IdPair& ids) -> Task& {
      return tasks.emplace(ids, Task{ids, nullptr, {}}).first->second;
    };
    for (const Match& match : matches) {
      if (!match.rivals.empty() &&
          match.pair.score >= options_.min_proposing_score) {
        task_of(IdsOf(match.pair));
      }
    }
    for (const std::vector<PairPose>& of_match : proposals) {
      for (const PairPose& proposal : of_match) {
        task_of(IdsOf(proposal)).proposals.push_back(proposal);
      }
    }
    for (const Match& match : matches) {
      const auto task = tasks.find(IdsOf(match.pair));
      if (task != tasks.end()) task->second.match = &match;
    }
    std::vector<Task> result;
    for (auto& [ids, task] : tasks) {
      KeepBestProposals(&task);
      if (!task.proposals.empty() || !task.match->rivals.empty()) {
        result.push_back(std::move(task));
      }
    }
    return result;
  }

  // Returns the most likely of the match's own pose, its rivals and the
  // proposals; nullopt if none of them can be registered.
  [[nodiscard]] std::optional<Match> Decide(const Task& task) const {
    const Place& reference = references_.places->at(task.ids.first);
    const Place& query = queries_.places->at(task.ids.second);
    std::vector<Opinion> opinions;
    for (VerifiedPose& verified :
         VerifyPoses(match_options_.verification, reference.surface,
                     query.surface, PosesOf(task))) {
      Opinion opinion;
      if (verified.score >= options_.min_pair_score) {
        opinion.evidence = Measure({task.ids.first, task.ids.second,
                                    verified.T_reference_query})
                               .evidence;
      }
      opinion.score =
          NeighbourhoodScore(options_, verified.score, opinion.evidence);
      opinion.verified = std::move(verified);
      opinions.push_back(std::move(opinion));
    }
    if (opinions.empty()) return std::nullopt;
    std::stable_sort(
        opinions.begin(), opinions.end(),
        [](const Opinion& a, const Opinion& b) { return a.score > b.score; });
    const double lead = opinions.size() > 1
                            ? opinions[0].score - opinions[1].score
                            : opinions[0].verified.margin;
    Match match = MakeMatch(match_options_, reference, query,
                            std::move(opinions[0].verified));
    SetEvidence(opinions[0].evidence, &match);
    match.verdict = Judge(match_options_.verification.judgement, match.evidence,
                          match.pair.score, lead);
    return match;
  }

 private:
  [[nodiscard]] Neighbourhood Measure(const PairPose& pair) const {
    return MeasureNeighbourhood(options_, match_options_.verification,
                                references_, queries_, min_index_gap_, pair);
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
        ObservedCentroid(queries_.places->at(task->ids.second).surface);
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
  const TrajectoryPlaces& references_;
  const TrajectoryPlaces& queries_;
  const std::optional<int> min_index_gap_;
};

// Replaces matches by the decided ones of the same pairs.
std::vector<Match> Replace(std::vector<Match> matches,
                           std::vector<std::optional<Match>> decided) {
  std::map<IdPair, Match> all;
  for (std::optional<Match>& match : decided) {
    if (!match) continue;
    const IdPair ids = IdsOf(match->pair);
    all.emplace(ids, *std::move(match));
  }
  for (Match& match : matches) {
    const IdPair ids = IdsOf(match.pair);
    all.try_emplace(ids, std::move(match));
  }
  std::vector<Match> result;
  for (auto& [ids, match] : all) result.push_back(std::move(match));
  return result;
}

}  // namespace

std::vector<Match> VerifyNeighbourhoods(
    const NeighbourhoodOptions& options, const MatchOptions& match_options,
    const TrajectoryPlaces& references, const TrajectoryPlaces& queries,
    const std::optional<int> min_index_gap, std::vector<Match> matches,
    const Executor& executor, const ProgressCallback& on_progress) {
  const NeighbourhoodVerifier verifier(options, match_options, references,
                                       queries, min_index_gap);
  std::vector<std::vector<PairPose>> proposals(matches.size());
  TaskProgress first_half(on_progress, matches.size(), 0., 0.5);
  executor(matches.size(), [&](const size_t k) {
    proposals[k] = verifier.VerifyMatch(&matches[k]);
    first_half.TaskIsDone();
  });
  const std::vector<Task> tasks = verifier.CollectTasks(matches, proposals);
  std::vector<std::optional<Match>> decided(tasks.size());
  TaskProgress second_half(on_progress, tasks.size(), 0.5, 1.);
  executor(tasks.size(), [&](const size_t k) {
    decided[k] = verifier.Decide(tasks[k]);
    second_half.TaskIsDone();
  });
  return Replace(std::move(matches), std::move(decided));
}

void VerifyNeighbourhood(const NeighbourhoodOptions& options,
                         const MatchOptions& match_options,
                         const TrajectoryPlaces& references,
                         const TrajectoryPlaces& queries,
                         const std::optional<int> min_index_gap,
                         Match* const match) {
  NeighbourhoodVerifier(options, match_options, references, queries,
                        min_index_gap)
      .VerifyMatch(match);
}

}  // namespace cartographer_sdf
