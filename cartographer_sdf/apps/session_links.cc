// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/session_links.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/matching/place_index.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Pair = std::pair<size_t, size_t>;

// The places of all sessions, each under its own number.
struct NumberedPlaces {
  std::vector<const Place*> places;
  std::vector<size_t> sessions;
};

NumberedPlaces Number(const std::vector<Session>& sessions) {
  NumberedPlaces numbered;
  for (size_t k = 0; k < sessions.size(); ++k) {
    for (const auto& [id, place] : sessions[k].map.places) {
      numbered.places.push_back(&place);
      numbered.sessions.push_back(k);
    }
  }
  return numbered;
}

SubmapId IdOf(const size_t number) { return {0, static_cast<int>(number)}; }

// For each two sessions, how much the places of each resemble those of the
// other: the sum of the scores of the candidates that an index of all proposes.
std::map<Pair, double> Resemblances(const RetrievalOptions& retrieval,
                                    const std::vector<Session>& sessions,
                                    const Executor& executor) {
  const NumberedPlaces numbered = Number(sessions);
  PlaceIndex index(retrieval);
  for (size_t k = 0; k < numbered.places.size(); ++k) {
    index.Add(IdOf(k), numbered.places[k]->features);
  }
  const auto session_of = [&numbered](const SubmapId& id) {
    return numbered.sessions[static_cast<size_t>(id.index)];
  };
  std::vector<std::vector<RetrievalCandidate>> candidates(
      numbered.places.size());
  executor(candidates.size(), [&](const size_t k) {
    candidates[k] =
        index.Query(numbered.places[k]->features, [&, k](const SubmapId& id) {
          return session_of(id) == numbered.sessions[k];
        });
  });
  std::map<Pair, double> resemblances;
  for (size_t k = 0; k < candidates.size(); ++k) {
    for (const RetrievalCandidate& candidate : candidates[k]) {
      resemblances[std::minmax(numbered.sessions[k],
                               session_of(candidate.id))] += candidate.score;
    }
  }
  return resemblances;
}

// All pairs, the most alike first; on ties, in the order of the sessions.
std::vector<Pair> PairsByResemblance(const RetrievalOptions& retrieval,
                                     const std::vector<Session>& sessions,
                                     const Executor& executor) {
  std::map<Pair, double> resemblances =
      Resemblances(retrieval, sessions, executor);
  std::vector<Pair> pairs;
  for (size_t first = 0; first < sessions.size(); ++first) {
    for (size_t second = first + 1; second < sessions.size(); ++second) {
      pairs.emplace_back(first, second);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&resemblances](const Pair& a, const Pair& b) {
                     return resemblances[a] > resemblances[b];
                   });
  return pairs;
}

}  // namespace

std::string Validate(const SessionLinkOptions& options) {
  if (options.min_num_links_per_session < 1) {
    return "min_num_links_per_session must be positive";
  }
  return "";
}

bool IsCertain(const SessionLink& link) {
  return link.localization.verdict == LocalizationVerdict::kLocalized &&
         link.localization.parts.jumps.empty();
}

std::vector<size_t> SingleGroups(const size_t num_sessions) {
  std::vector<size_t> groups(num_sessions);
  std::iota(groups.begin(), groups.end(), size_t{0});
  return groups;
}

void JoinGroups(const size_t a, const size_t b,
                std::vector<size_t>* const groups) {
  const size_t group_a = (*groups)[a], group_b = (*groups)[b];
  std::replace(groups->begin(), groups->end(), std::max(group_a, group_b),
               std::min(group_a, group_b));
}

std::vector<size_t> GroupSessions(const size_t num_sessions,
                                  const std::vector<SessionLink>& links) {
  std::vector<size_t> groups = SingleGroups(num_sessions);
  for (const SessionLink& link : links) {
    if (IsCertain(link)) JoinGroups(link.first, link.second, &groups);
  }
  return groups;
}

SessionLinker::SessionLinker(const SessionLinkOptions& options,
                             const LocalizationOptions& localization,
                             const LoopClosingOptions& stages,
                             const std::vector<Session>& sessions,
                             const Executor& executor, StageClock* const clock)
    : options_(options),
      localization_(localization),
      stages_(stages),
      sessions_(sessions),
      executor_(executor),
      clock_(clock) {
  CHECK_EQ(Validate(options), "");
  // Every match of linked sessions is used.
  localization_.num_first_places = std::numeric_limits<int>::max();
  localization_.max_num_confirmed_pairs = std::numeric_limits<int>::max();
  clock_->Begin("find sessions that are alike");
  pairs_ = PairsByResemblance(stages.recognition.retrieval, sessions, executor);
}

void SessionLinker::LinkMostAlike() {
  std::vector<int> num_links(sessions_.size(), 0);
  for (const Pair& pair : pairs_) {
    if (std::min(num_links[pair.first], num_links[pair.second]) >=
        options_.min_num_links_per_session) {
      continue;
    }
    ++num_links[pair.first];
    ++num_links[pair.second];
    Link(pair);
  }
}

void SessionLinker::Connect(const std::set<size_t>& sessions) {
  std::vector<size_t> groups = SingleGroups(sessions_.size());
  const auto are_among = [&sessions](const size_t first, const size_t second) {
    return sessions.count(first) > 0 && sessions.count(second) > 0;
  };
  for (const SessionLink& link : links_) {
    if (are_among(link.first, link.second) && IsCertain(link)) {
      JoinGroups(link.first, link.second, &groups);
    }
  }
  for (const auto& [first, second] : pairs_) {
    if (!are_among(first, second) || groups[first] == groups[second] ||
        IsLinked({first, second})) {
      continue;
    }
    if (IsCertain(Link({first, second}))) JoinGroups(first, second, &groups);
  }
}

const SessionLink& SessionLinker::Link(const Pair& pair) {
  SessionLink link{
      pair.first, pair.second,
      LocalizeIn(
          localization_, stages_, sessions_[pair.first].map,
          sessions_[pair.second].map, executor_, [&](const std::string& stage) {
            return clock_->Begin(absl::StrFormat(
                "%s, %d and %d", stage, pair.first + 1, pair.second + 1));
          })};
  const auto place = std::upper_bound(links_.begin(), links_.end(), pair,
                                      [](const Pair& a, const SessionLink& b) {
                                        return a < Pair(b.first, b.second);
                                      });
  return *links_.insert(place, std::move(link));
}

bool SessionLinker::IsLinked(const Pair& pair) const {
  return std::any_of(links_.begin(), links_.end(),
                     [&pair](const SessionLink& link) {
                       return Pair(link.first, link.second) == pair;
                     });
}

}  // namespace cartographer_sdf
