// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// On ties, returns the first.
size_t LargestGroup(const std::vector<size_t>& groups) {
  std::map<size_t, int> sizes;
  for (const size_t group : groups) ++sizes[group];
  return std::max_element(
             sizes.begin(), sizes.end(),
             [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

// Returns (first of the group <- session) for the sessions of a group, along
// the most certain links, without those in `left_out`.
std::map<size_t, Rigid2> PlaceSessions(
    const size_t first, const std::vector<SessionLink>& links,
    const std::map<size_t, std::string>& left_out) {
  std::map<size_t, Rigid2> placed = {{first, Rigid2()}};
  while (true) {
    const SessionLink* best = nullptr;
    for (const SessionLink& link : links) {
      if (!IsCertain(link) || left_out.count(link.first) > 0 ||
          left_out.count(link.second) > 0 ||
          placed.count(link.first) == placed.count(link.second)) {
        continue;
      }
      if (best == nullptr ||
          *link.localization.score > *best->localization.score) {
        best = &link;
      }
    }
    if (best == nullptr) return placed;
    const Rigid2& T_first_second = *best->localization.T_map_query;
    if (placed.count(best->first) > 0) {
      placed[best->second] = placed.at(best->first) * T_first_second;
    } else {
      placed[best->first] = placed.at(best->second) * T_first_second.Inverse();
    }
  }
}

absl::Status CheckPaths(const std::vector<std::string>& paths) {
  for (size_t a = 0; a < paths.size(); ++a) {
    for (size_t b = a + 1; b < paths.size(); ++b) {
      std::error_code error;
      if (std::filesystem::equivalent(paths[a], paths[b], error)) {
        return absl::InvalidArgumentError(
            absl::StrCat(paths[b], " is given twice"));
      }
    }
  }
  return absl::OkStatus();
}

// Describes the most similar pair.
std::string DescribeStrangers(const MergingResult& result) {
  const SessionLink& most_alike =
      *std::max_element(result.links.begin(), result.links.end(),
                        [](const SessionLink& a, const SessionLink& b) {
                          return a.localization.score.value_or(0.) <
                                 b.localization.score.value_or(0.);
                        });
  return absl::StrCat("no two of the maps are connected; ",
                      result.sessions[most_alike.second].path, " in ",
                      result.sessions[most_alike.first].path, ": ",
                      most_alike.localization.reason);
}

// Returns a session that the closures in the graph do not connect with the
// first, and why; none if they connect all.
std::optional<MergingFault> FindSplit(
    const JoinedSessions& joined, const std::vector<Closure>& closures,
    const std::vector<const Session*>& sessions) {
  std::vector<size_t> groups = SingleGroups(sessions.size());
  for (const Closure& closure : closures) {
    if (closure.status != ClosureStatus::kInGraph &&
        closure.status != ClosureStatus::kAlreadyInGraph) {
      continue;
    }
    JoinGroups(joined.SessionOf(closure.match.pair.reference),
               joined.SessionOf(closure.match.pair.query), &groups);
  }
  const size_t first = joined.parts.begin()->first;
  for (const auto& [session, part] : joined.parts) {
    if (groups[session] == groups[first]) continue;
    return MergingFault{
        absl::StrCat("the optimised map contradicts all matches of ",
                     sessions[session]->path, " with ", sessions[first]->path,
                     ": they show places that look alike"),
        session};
  }
  return std::nullopt;
}

// Joins sessions and closes loops in the joined graph. Finds the matches within
// each session only once.
class SessionJoiner {
 public:
  // Nothing is owned.
  SessionJoiner(const FoldCheckOptions& options,
                const LoopClosingOptions& stages,
                std::vector<const Session*> sessions,
                const std::set<int>& frozen_trajectories,
                const Executor& executor, StageClock* const clock)
      : options_(options),
        stages_(stages),
        sessions_(std::move(sessions)),
        frozen_trajectories_(frozen_trajectories),
        executor_(executor),
        clock_(clock) {}

  // Joins the sessions in `placed` and fills in the result, which has the
  // links. Returns why the map cannot be right, if so.
  std::optional<MergingFault> JoinAndClose(
      const std::map<size_t, Rigid2>& placed, const bool closes_within,
      MergingResult* const result) {
    JoinedSessions joined = JoinSessions(stages_.closing, sessions_, placed);
    for (const auto& [session, pose] : placed) {
      result->sessions[session].T_merged_session = pose;
    }
    result->closed =
        CloseGraph(stages_.closing,
                   {&joined.placed, &joined.odometry, &joined.places,
                    &joined.point_clouds},
                   CollectMatches(joined, result->links, closes_within),
                   frozen_trajectories_, executor_, clock_);
    clock_->Begin("check for folds");
    const auto overlaps = CheckOverlaps(options_, stages_.recognition, joined,
                                        result->closed.pose_graph, executor_);
    for (const auto& [ids, overlap] : overlaps) {
      result->num_overlapping += overlap.num_overlapping;
      result->contradictions.insert(result->contradictions.end(),
                                    overlap.contradictions.begin(),
                                    overlap.contradictions.end());
    }
    std::optional<MergingFault> fault =
        FindSplit(joined, result->closed.closures, sessions_);
    if (!fault) fault = FindFold(options_, overlaps, sessions_);
    RemoveScanSubmaps(joined, &result->closed.pose_graph);
    for (auto& [session, part] : joined.parts) {
      result->parts.push_back(std::move(part));
    }
    result->state = std::move(joined.state);
    return fault;
  }

 private:
  const std::vector<Match>& MatchesWithin(const size_t session) {
    const auto [found, is_new] = within_.try_emplace(session);
    if (is_new) {
      found->second = RecognizeWithin(
          stages_.recognition, sessions_[session]->map.trajectory_places(),
          executor_, clock_);
    }
    return found->second;
  }

  // Returns the accepted matches of the joined map: between sessions those that
  // vote for the placement, and with `also_within` also those within each
  // session.
  std::vector<Match> CollectMatches(const JoinedSessions& joined,
                                    const std::vector<SessionLink>& links,
                                    const bool also_within) {
    std::vector<Match> matches;
    const auto add = [&](Match match, const size_t first, const size_t second) {
      const auto reference_part = joined.parts.find(first);
      const auto query_part = joined.parts.find(second);
      if (reference_part == joined.parts.end() ||
          query_part == joined.parts.end()) {
        return;
      }
      PairPose& pair = match.pair;
      pair.reference = Renumbered(reference_part->second, pair.reference);
      pair.query = Renumbered(query_part->second, pair.query);
      matches.push_back(std::move(match));
    };
    if (also_within) {
      for (const auto& [k, part] : joined.parts) {
        for (const Match& match : MatchesWithin(k)) add(match, k, k);
      }
    }
    for (const SessionLink& link : links) {
      if (!IsCertain(link)) continue;
      for (const size_t vote : link.localization.placements.front().votes) {
        add(link.localization.matches[vote], link.first, link.second);
      }
    }
    std::stable_sort(matches.begin(), matches.end(),
                     [](const Match& a, const Match& b) {
                       return IsBeforeByIds(a.pair, b.pair);
                     });
    return matches;
  }

  const FoldCheckOptions& options_;
  const LoopClosingOptions& stages_;
  const std::vector<const Session*> sessions_;
  const std::set<int>& frozen_trajectories_;
  const Executor& executor_;
  StageClock* const clock_;
  std::map<size_t, std::vector<Match>> within_;
};

std::vector<std::string> PathsOf(const std::vector<MapSource>& sources) {
  std::vector<std::string> paths;
  for (const MapSource& source : sources) paths.push_back(source.path);
  return paths;
}

// Only the first map can be frozen.
absl::Status CheckFrozen(const std::string& first_path,
                         const std::set<int>& frozen_trajectories) {
  if (frozen_trajectories.empty()) return absl::OkStatus();
  const absl::StatusOr<std::vector<int>> freezable =
      ReadTrajectories(first_path);
  if (!freezable.ok()) return freezable.status();
  const int last = *frozen_trajectories.rbegin();
  if (last < static_cast<int>(freezable->size())) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      "trajectory ", last, " is not of the first map, ", first_path,
      ", and cannot be frozen: only one map can stay"));
}

absl::StatusOr<std::vector<Session>> ReadSessions(
    const ScanPlaceOptions& scan_places, const LoopClosingOptions& stages,
    const std::vector<MapSource>& sources, const MapDescriber& describe,
    const Executor& executor, StageClock* const clock) {
  std::vector<Session> sessions;
  for (const MapSource& source : sources) {
    absl::StatusOr<Session> session = DescribeSession(
        stages, scan_places, source, std::nullopt, executor,
        clock->Begin(absl::StrCat("read and describe ", source.path)),
        describe);
    if (!session.ok()) return session.status();
    sessions.push_back(*std::move(session));
  }
  return sessions;
}

// Links sessions until all are connected, if they can be.
std::vector<SessionLink> LinkSessions(const size_t num_sessions,
                                      SessionLinker* const linker) {
  linker->LinkMostAlike();
  std::set<size_t> all;
  for (size_t k = 0; k < num_sessions; ++k) all.insert(k);
  linker->Connect(all);
  return linker->links();
}

// Returns why the connected sessions cannot be merged, or an empty string.
std::string FindRefusal(const MergingResult& result,
                        const std::map<size_t, Rigid2>& placed,
                        const bool has_frozen_trajectories) {
  if (placed.size() == 1) return DescribeStrangers(result);
  if (has_frozen_trajectories && placed.count(0) == 0) {
    return "the map with the frozen trajectories is not connected with others";
  }
  return "";
}

// Names the jump if one is the reason.
std::string DescribeDisconnected(const MergingResult& result, const size_t k) {
  for (const SessionLink& link : result.links) {
    if ((link.first != k && link.second != k) ||
        link.localization.parts.jumps.empty()) {
      continue;
    }
    const size_t other = link.first == k ? link.second : link.first;
    return absl::StrCat("not at one pose in ", result.sessions[other].path,
                        ": ", link.localization.reason);
  }
  return "not connected with the other maps";
}

// Says of each session that is not in the map why.
void ExplainLeftOut(const std::map<size_t, std::string>& faults,
                    MergingResult* const result) {
  for (size_t k = 0; k < result->sessions.size(); ++k) {
    MergedSession& session = result->sessions[k];
    if (session.T_merged_session) continue;
    const auto fault = faults.find(k);
    session.left_out = fault != faults.end() ? fault->second
                                             : DescribeDisconnected(*result, k);
  }
}

// Takes over an attempt, but for the stages that the clock writes to.
void Conclude(MergingResult attempt,
              const std::map<size_t, std::string>& faults,
              MergingResult* const result) {
  attempt.stage_seconds = std::move(result->stage_seconds);
  *result = std::move(attempt);
  ExplainLeftOut(faults, result);
}

// The sessions of a group that are not left out.
std::set<size_t> MembersLeft(const MergingResult& result, const size_t group,
                             const std::map<size_t, std::string>& left_out) {
  std::set<size_t> members;
  for (size_t k = 0; k < result.sessions.size(); ++k) {
    if (result.sessions[k].group == group && left_out.count(k) == 0) {
      members.insert(k);
    }
  }
  return members;
}

// Joins a group of connected sessions. While the map cannot be right, leaves
// out the session at fault; if that does not help, the result is the first map
// and its fault. The first of all sessions stays if trajectories are frozen.
void JoinGroup(const size_t group, const bool has_frozen_trajectories,
               SessionLinker* const linker, SessionJoiner* const joiner,
               MergingResult* const result) {
  std::map<size_t, std::string> left_out;
  std::optional<MergingResult> first_attempt;
  while (true) {
    linker->Connect(MembersLeft(*result, group, left_out));
    result->links = linker->links();
    size_t first = group;
    while (left_out.count(first) > 0 ||
           result->sessions[first].group != group) {
      ++first;
    }
    const std::map<size_t, Rigid2> placed =
        PlaceSessions(first, result->links, left_out);
    MergingResult attempt = *result;
    std::optional<MergingFault> fault;
    if (placed.size() > 1) {
      fault = joiner->JoinAndClose(placed, /*closes_within=*/true, &attempt);
      if (!fault) return Conclude(std::move(attempt), left_out, result);
      attempt.refusal = fault->reason;
      if (!first_attempt) first_attempt = std::move(attempt);
    }
    if (placed.size() <= 2 ||
        (has_frozen_trajectories && fault->session == 0)) {
      return Conclude(*std::move(first_attempt), {}, result);
    }
    left_out.emplace(fault->session, fault->reason);
  }
}

}  // namespace

absl::StatusOr<MergingResult> MergeSessions(
    const FoldCheckOptions& options, const SessionLinkOptions& session_links,
    const LocalizationOptions& localization,
    const ScanPlaceOptions& scan_places, const LoopClosingOptions& stages,
    const std::vector<MapSource>& sources,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage, const MapDescriber& describe) {
  CHECK_EQ(Validate(options), "");
  CHECK_GE(sources.size(), 2u);
  const std::vector<std::string> paths = PathsOf(sources);
  absl::Status status = CheckPaths(paths);
  if (status.ok()) status = CheckFrozen(paths.front(), frozen_trajectories);
  if (!status.ok()) return status;
  MergingResult result;
  StageClock clock(on_stage, &result.stage_seconds);
  const absl::StatusOr<std::vector<Session>> sessions =
      ReadSessions(scan_places, stages, sources, describe, executor, &clock);
  if (!sessions.ok()) return sessions.status();
  SessionLinker linker(session_links, localization, stages, *sessions, executor,
                       &clock);
  result.links = LinkSessions(paths.size(), &linker);
  const std::vector<size_t> groups = GroupSessions(paths.size(), result.links);
  for (size_t k = 0; k < paths.size(); ++k) {
    result.sessions.push_back({paths[k], groups[k], {}, ""});
  }
  const size_t group = LargestGroup(groups);
  result.refusal = FindRefusal(result, PlaceSessions(group, result.links, {}),
                               !frozen_trajectories.empty());
  if (result.refusal.empty()) {
    std::vector<const Session*> pointers;
    for (const Session& session : *sessions) pointers.push_back(&session);
    SessionJoiner joiner(options, stages, std::move(pointers),
                         frozen_trajectories, executor, &clock);
    JoinGroup(group, !frozen_trajectories.empty(), &linker, &joiner, &result);
  } else {
    ExplainLeftOut({}, &result);
  }
  clock.End();
  return result;
}

absl::StatusOr<MergingResult> AttachQuery(
    const FoldCheckOptions& options, const LoopClosingOptions& stages,
    const Session& map, const Session& query, const Localization& localization,
    const Executor& executor, const StageCallback& on_stage) {
  CHECK_EQ(Validate(options), "");
  CHECK(localization.T_map_query.has_value());
  const absl::Status status = CheckPaths({map.path, query.path});
  if (!status.ok()) return status;
  MergingResult result;
  result.sessions = {{map.path, 0, {}, ""}, {query.path, 0, {}, ""}};
  result.links = {{0, 1, localization}};
  std::set<int> frozen_trajectories;
  for (size_t k = 0; k < map.map.state.trajectories.size(); ++k) {
    frozen_trajectories.insert(static_cast<int>(k));
  }
  StageClock clock(on_stage, &result.stage_seconds);
  const std::optional<MergingFault> fault =
      SessionJoiner(options, stages, {&map, &query}, frozen_trajectories,
                    executor, &clock)
          .JoinAndClose({{0, Rigid2()}, {1, *localization.T_map_query}},
                        /*closes_within=*/false, &result);
  if (fault) result.refusal = fault->reason;
  clock.End();
  return result;
}

}  // namespace cartographer_sdf
