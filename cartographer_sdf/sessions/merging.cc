// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/sessions/merging.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>
#include <tuple>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/loop_closing/closure_stages.h"
#include "cartographer_sdf/pose_graph/odometry_weights.h"
#include "cartographer_sdf/sessions/pose_check.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Indices that are joined, each named by the lowest one it is joined with.
class Groups {
 public:
  explicit Groups(const size_t size) : parents_(size) {
    std::iota(parents_.begin(), parents_.end(), size_t{0});
  }
  [[nodiscard]] size_t Of(const size_t k) const {
    return parents_[k] == k ? k : Of(parents_[k]);
  }
  void Join(const size_t a, const size_t b) {
    const size_t group_a = Of(a), group_b = Of(b);
    parents_[std::max(group_a, group_b)] = std::min(group_a, group_b);
  }

 private:
  std::vector<size_t> parents_;
};

bool IsCertain(const SessionLink& link) {
  return link.relocalization.verdict == RelocalizationVerdict::kLocalized;
}

// (first of the group <- session) for the sessions of a group, along the most
// certain links; each session in the order in which it was reached.
std::map<size_t, Rigid2> PlaceSessions(const size_t first,
                                       const std::vector<SessionLink>& links) {
  std::map<size_t, Rigid2> placed = {{first, Rigid2()}};
  while (true) {
    const SessionLink* best = nullptr;
    for (const SessionLink& link : links) {
      if (!IsCertain(link) ||
          placed.count(link.first) == placed.count(link.second)) {
        continue;
      }
      if (best == nullptr ||
          *link.relocalization.score > *best->relocalization.score) {
        best = &link;
      }
    }
    if (best == nullptr) return placed;
    const Rigid2& T_first_second = *best->relocalization.T_map_query;
    if (placed.count(best->first) > 0) {
      placed[best->second] = placed.at(best->first) * T_first_second;
    } else {
      placed[best->first] = placed.at(best->second) * T_first_second.Inverse();
    }
  }
}

void Move(const Rigid2& T_moved_map, PoseGraph* const graph) {
  for (auto& [id, pose] : graph->submap_poses) pose = T_moved_map * pose;
  for (auto& [id, node] : graph->nodes) {
    node.T_map_node = T_moved_map * node.T_map_node;
  }
  for (auto& [id, pose] : graph->landmark_poses) {
    pose = Embed3D(T_moved_map) * pose;
  }
}

bool IsIdentity(const Rigid2& pose) {
  return pose.translation().isZero(0.) && pose.rotation() == 0.;
}

// The sessions that are merged, under their new numbers.
struct JoinedSessions {
  MapState placed;  // with the poses where the sessions were laid
  std::map<SubmapId, Place> places;
  std::map<int, size_t> session_of_trajectory;
};

class Merger {
 public:
  Merger(const MergingOptions& options, const LoopClosingOptions& stages,
         const std::vector<const Session*>& sessions, const Executor& executor,
         StageClock* const clock, MergingResult* const result)
      : options_(options),
        stages_(stages),
        sessions_(sessions),
        executor_(executor),
        clock_(*clock),
        result_(*result) {}

  // Joins the sessions that have a place in `placed`; `matches` are those
  // within them, by session.
  absl::Status Join(const std::map<size_t, Rigid2>& placed,
                    const std::map<size_t, std::vector<Match>>& matches,
                    const std::set<int>& frozen_trajectories) {
    Number(placed);
    CollectClosures(matches);
    if (stages_.silence_torn_submaps) {
      if (absl::Status status = FindTorn(); !status.ok()) return status;
    }
    clock_.Begin("select consistent");
    SelectClosures(stages_.consistency, result_.state, result_.torn_submaps,
                   &result_.closures);
    const ProgressCallback on_lift = clock_.Begin("lift to constraints");
    const absl::StatusOr<ScansByNode> scans = ReadScansToLift(
        stages_.lifting, result_.state.pose_graph, result_.closures,
        [&](const std::set<NodeId>& nodes) {
          return ReadJoinedPointClouds(result_.parts, nodes, on_lift);
        });
    if (!scans.ok()) return scans.status();
    LiftClosures(stages_.lifting, result_.state.pose_graph, joined_.places,
                 *scans, executor_, &result_.closures);
    OptimizedGraph optimized = OptimizeAndWithdraw(
        stages_.withdrawal, stages_.optimization, frozen_trajectories,
        joined_.placed.pose_graph, &result_.closures, clock_.Begin("optimise"));
    result_.pose_graph = std::move(optimized.pose_graph);
    result_.optimizations = std::move(optimized.optimizations);
    clock_.Begin("check");
    FindFolds();
    CheckResult();
    RemoveScanSubmaps();
    clock_.End();
    return absl::OkStatus();
  }

 private:
  void Number(const std::map<size_t, Rigid2>& placed) {
    std::vector<std::string> paths;
    std::vector<const MapState*> states;
    for (const auto& [session, pose] : placed) {
      part_sessions_.push_back(session);
      paths.push_back(sessions_[session]->path);
      states.push_back(&sessions_[session]->map.state);
    }
    result_.parts = NumberTrajectories(paths, states);
    for (size_t k = 0; k < part_sessions_.size(); ++k) {
      const size_t session = part_sessions_[k];
      const MapPart& part = result_.parts[k];
      const DescribedMap& map = sessions_[session]->map;
      AppendMap(part, map.state, &result_.state);
      MapState moved = map.state;
      const Rigid2& T_merged_session = placed.at(session);
      result_.sessions[session].T_merged_session = T_merged_session;
      // The first stays to the last bit.
      if (!IsIdentity(T_merged_session)) {
        Move(T_merged_session, &moved.pose_graph);
      }
      AppendMap(part, moved, &joined_.placed);
      for (const auto& [id, place] : map.places) {
        Place renamed = place;
        renamed.id = Renamed(k, id);
        joined_.places.emplace(renamed.id, std::move(renamed));
      }
      for (const auto& [trajectory, number] : part.trajectories) {
        joined_.session_of_trajectory[number] = session;
      }
      WeighOdometry(part, map.state);
    }
  }

  // Each map by the weights that it shows.
  void WeighOdometry(const MapPart& part, const MapState& map) {
    if (!stages_.infer_odometry_weights) return;
    const std::optional<OdometryWeights> weights =
        InferOdometryWeights(stages_.optimization, map.pose_graph);
    if (!weights) return;
    for (const auto& [trajectory, number] : part.trajectories) {
      joined_.placed.pose_graph.odometry_weights[number] = *weights;
    }
  }

  [[nodiscard]] SubmapId Renamed(const size_t part, const SubmapId& id) const {
    return {result_.parts[part].trajectories.at(id.trajectory), id.index};
  }
  [[nodiscard]] std::optional<size_t> PartOf(const size_t session) const {
    const auto it =
        std::find(part_sessions_.begin(), part_sessions_.end(), session);
    if (it == part_sessions_.end()) return std::nullopt;
    return static_cast<size_t>(it - part_sessions_.begin());
  }

  void AddClosure(const Match& match, const size_t reference_part,
                  const size_t query_part) {
    ClosureOutcome outcome{match, Fate::kInGraph, {}, {}};
    LoopClosure& closure = outcome.match.closure;
    closure.reference = Renamed(reference_part, closure.reference);
    closure.query = Renamed(query_part, closure.query);
    result_.closures.push_back(std::move(outcome));
  }

  void CollectClosures(const std::map<size_t, std::vector<Match>>& matches) {
    for (const auto& [session, within] : matches) {
      const std::optional<size_t> part = PartOf(session);
      if (!part) continue;
      for (const Match& match : within) {
        if (match.verdict == Verdict::kAccepted) {
          AddClosure(match, *part, *part);
        }
      }
    }
    for (const SessionLink& link : result_.links) {
      const std::optional<size_t> first = PartOf(link.first);
      const std::optional<size_t> second = PartOf(link.second);
      if (!first || !second || !IsCertain(link)) continue;
      const Relocalization& found = link.relocalization;
      for (const size_t vote : found.placements.front().votes) {
        AddClosure(found.matches[vote], *first, *second);
      }
    }
    std::stable_sort(result_.closures.begin(), result_.closures.end(),
                     [](const ClosureOutcome& a, const ClosureOutcome& b) {
                       const LoopClosure &x = a.match.closure,
                                         &y = b.match.closure;
                       return std::tie(x.reference, x.query) <
                              std::tie(y.reference, y.query);
                     });
  }

  absl::Status FindTorn() {
    const ProgressCallback on_progress = clock_.Begin("find torn submaps");
    for (size_t k = 0; k < part_sessions_.size(); ++k) {
      const Session& session = *sessions_[part_sessions_[k]];
      const absl::StatusOr<std::map<SubmapId, Tear>> torn =
          FindTornSubmaps(stages_.tear, session.path,
                          session.map.state.pose_graph, executor_, on_progress);
      if (!torn.ok()) return torn.status();
      for (const auto& [id, tear] : *torn) {
        result_.torn_submaps.emplace(Renamed(k, id), tear);
      }
    }
    return absl::OkStatus();
  }

  [[nodiscard]] size_t SessionOf(const SubmapId& id) const {
    return joined_.session_of_trajectory.at(id.trajectory);
  }

  struct Pair {
    const Place* reference;
    const Place* query;
    bool overlaps = false;
    std::optional<Match> contradiction;
  };

  static Rigid2 Between(const PoseGraph& graph, const Pair& pair) {
    return graph.submap_poses.at(pair.reference->id).Inverse() *
           graph.submap_poses.at(pair.query->id);
  }

  [[nodiscard]] std::optional<Match> Contradiction(
      const Pair& pair, const Rigid2& T_reference_query) const {
    return FindContradiction(stages_.match, options_.max_contradiction_ratio,
                             *pair.reference, *pair.query, T_reference_query);
  }

  // What contradicted itself before is not the merge's fault.
  void CheckPair(Pair* const pair) const {
    const Rigid2 after = Between(result_.pose_graph, *pair);
    if (!Overlap(*pair->reference, *pair->query, after)) return;
    pair->overlaps = true;
    std::optional<Match> contradiction = Contradiction(*pair, after);
    if (!contradiction) return;
    if (SessionOf(pair->reference->id) == SessionOf(pair->query->id)) {
      const Rigid2 before = Between(result_.state.pose_graph, *pair);
      if (Overlap(*pair->reference, *pair->query, before) &&
          Contradiction(*pair, before)) {
        return;
      }
    }
    pair->contradiction = std::move(contradiction);
  }

  void FindFolds() {
    std::vector<Pair> pairs;
    for (auto reference = joined_.places.begin();
         reference != joined_.places.end(); ++reference) {
      for (auto query = std::next(reference); query != joined_.places.end();
           ++query) {
        const SubmapId &a = reference->first, &b = query->first;
        if (a.trajectory == b.trajectory &&
            std::abs(a.index - b.index) < stages_.min_index_gap) {
          continue;
        }
        pairs.push_back({&reference->second, &query->second, false, {}});
      }
    }
    executor_(pairs.size(), [&](const size_t k) { CheckPair(&pairs[k]); });
    for (Pair& pair : pairs) {
      if (!pair.overlaps) continue;
      ++result_.num_overlapping;
      Overlaps& overlaps = overlaps_[std::minmax(
          {SessionOf(pair.reference->id), SessionOf(pair.query->id)})];
      ++overlaps.num_pairs;
      if (pair.contradiction) {
        overlaps.contradictions.push_back(pair.contradiction->closure);
        result_.contradictions.push_back(*std::move(pair.contradiction));
      }
    }
  }

  // Of two sessions, or within one, apart from all others: a long map that
  // agrees with itself must not outweigh what a short one contradicts.
  [[nodiscard]] std::string DescribeFold() const {
    for (const auto& [sessions, overlaps] : overlaps_) {
      const size_t num_folded = overlaps.contradictions.size();
      if (static_cast<double>(num_folded) <=
          options_.max_folded_fraction * overlaps.num_pairs) {
        continue;
      }
      const LoopClosure& example = overlaps.contradictions.front();
      return absl::StrFormat(
          "the merged map would be folded: of %d pairs of submaps of %s and %s "
          "that it lays over each other %d have walls in each other's free "
          "space, such as %d,%d and %d,%d",
          overlaps.num_pairs, sessions_[sessions.first]->path,
          sessions_[sessions.second]->path, num_folded,
          example.reference.trajectory, example.reference.index,
          example.query.trajectory, example.query.index);
    }
    return "";
  }

  // Submaps that are in no file can't be written.
  void RemoveScanSubmaps() {
    std::set<SubmapId> scan_submaps;
    for (size_t k = 0; k < part_sessions_.size(); ++k) {
      for (const auto& [id, grid] : sessions_[part_sessions_[k]]->scan_grids) {
        scan_submaps.insert(Renamed(k, id));
        result_.pose_graph.submap_poses.erase(Renamed(k, id));
      }
    }
    std::vector<Constraint>& constraints = result_.pose_graph.constraints;
    constraints.erase(
        std::remove_if(constraints.begin(), constraints.end(),
                       [&](const Constraint& constraint) {
                         return scan_submaps.count(constraint.submap) > 0;
                       }),
        constraints.end());
  }

  void CheckResult() {
    Groups groups(sessions_.size());
    for (const ClosureOutcome& outcome : result_.closures) {
      if (outcome.fate != Fate::kInGraph) continue;
      groups.Join(SessionOf(outcome.match.closure.reference),
                  SessionOf(outcome.match.closure.query));
    }
    for (const size_t session : part_sessions_) {
      if (groups.Of(session) != groups.Of(part_sessions_.front())) {
        result_.refusal =
            absl::StrCat("the optimised map contradicts all matches of ",
                         sessions_[session]->path, " with ",
                         sessions_[part_sessions_.front()]->path,
                         ": they show places that look alike");
        return;
      }
    }
    result_.refusal = DescribeFold();
  }

  const MergingOptions& options_;
  const LoopClosingOptions& stages_;
  const std::vector<const Session*>& sessions_;
  const Executor& executor_;
  StageClock& clock_;
  MergingResult& result_;
  std::vector<size_t> part_sessions_;  // of the parts, in order
  JoinedSessions joined_;
  // What the merged map lays over each other, by the sessions that it is of.
  struct Overlaps {
    int num_pairs = 0;
    std::vector<LoopClosure> contradictions;
  };
  std::map<std::pair<size_t, size_t>, Overlaps> overlaps_;
};

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

// Of the group that is merged: the largest, the first of the largest.
size_t LargestGroup(const Groups& groups, const size_t num_sessions) {
  std::map<size_t, int> sizes;
  for (size_t k = 0; k < num_sessions; ++k) ++sizes[groups.Of(k)];
  size_t largest = 0;
  for (const auto& [group, size] : sizes) {
    if (size > sizes.at(largest)) largest = group;
  }
  return largest;
}

// Of the pair that is most alike.
std::string DescribeStrangers(const MergingResult& result) {
  const SessionLink* most_alike = &result.links.front();
  for (const SessionLink& link : result.links) {
    if (link.relocalization.score.value_or(0.) >
        most_alike->relocalization.score.value_or(0.)) {
      most_alike = &link;
    }
  }
  return absl::StrCat("no two of the maps are connected; ",
                      result.sessions[most_alike->second].path, " in ",
                      result.sessions[most_alike->first].path, ": ",
                      most_alike->relocalization.reason);
}

}  // namespace

std::string Validate(const MergingOptions& options) {
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

absl::StatusOr<MergingResult> MergeSessions(
    const MergingOptions& options, const RelocalizationOptions& relocalization,
    const LoopClosingOptions& stages, const std::vector<std::string>& paths,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage) {
  CHECK_EQ(Validate(options), "");
  CHECK_GE(paths.size(), 2u);
  if (absl::Status status = CheckPaths(paths); !status.ok()) return status;
  MergingResult result;
  StageClock clock(on_stage, &result.stage_seconds);
  std::vector<Session> sessions;
  for (const std::string& path : paths) {
    absl::StatusOr<Session> session =
        DescribeSession(relocalization, stages, path, std::nullopt, executor,
                        clock.Begin(absl::StrCat("read and describe ", path)));
    if (!session.ok()) return session.status();
    sessions.push_back(*std::move(session));
    result.sessions.push_back({path, result.sessions.size(), {}});
    // As soon as it is known.
    if (sessions.size() > 1) continue;
    const int num_freezable =
        static_cast<int>(sessions.front().map.state.trajectories.size());
    for (const int trajectory : frozen_trajectories) {
      if (trajectory < num_freezable) continue;
      return absl::InvalidArgumentError(absl::StrCat(
          "trajectory ", trajectory, " is not of the first map, ",
          paths.front(), ", and cannot be frozen: only one map can stay"));
    }
  }

  // Every match is of use here.
  RelocalizationOptions thorough = relocalization;
  thorough.num_first_places = std::numeric_limits<int>::max();
  thorough.max_num_confirmed_pairs = std::numeric_limits<int>::max();
  Groups groups(sessions.size());
  for (size_t first = 0; first < sessions.size(); ++first) {
    for (size_t second = first + 1; second < sessions.size(); ++second) {
      SessionLink link{first, second, {}};
      link.relocalization = Relocalize(
          thorough, stages, sessions[first].map, sessions[second].map, executor,
          [&](const std::string& stage) {
            return clock.Begin(
                absl::StrFormat("%s, %d and %d", stage, first + 1, second + 1));
          });
      if (IsCertain(link)) groups.Join(first, second);
      result.links.push_back(std::move(link));
    }
  }
  for (size_t k = 0; k < sessions.size(); ++k) {
    result.sessions[k].group = groups.Of(k);
  }
  const std::map<size_t, Rigid2> placed =
      PlaceSessions(LargestGroup(groups, sessions.size()), result.links);
  if (placed.size() == 1) {
    clock.End();
    result.refusal = DescribeStrangers(result);
    return result;
  }
  if (!frozen_trajectories.empty() && placed.count(0) == 0) {
    clock.End();
    result.refusal =
        "the map with the frozen trajectories is not connected with others";
    return result;
  }
  std::map<size_t, std::vector<Match>> matches;
  for (const auto& [session, pose] : placed) {
    matches[session] = MatchWithin(
        stages.match,
        stages.use_retrieval ? std::make_optional(stages.retrieval)
                             : std::nullopt,
        sessions[session].map.places, stages.min_index_gap, executor,
        clock.Begin(absl::StrCat("match within ", paths[session])));
  }
  std::vector<const Session*> pointers;
  for (const Session& session : sessions) pointers.push_back(&session);
  const absl::Status status =
      Merger(options, stages, pointers, executor, &clock, &result)
          .Join(placed, matches, frozen_trajectories);
  if (!status.ok()) return status;
  return result;
}

absl::StatusOr<MergingResult> AttachQuery(const MergingOptions& options,
                                          const LoopClosingOptions& stages,
                                          const Session& map,
                                          const Session& query,
                                          const Relocalization& relocalization,
                                          const Executor& executor,
                                          const StageCallback& on_stage) {
  CHECK_EQ(Validate(options), "");
  CHECK(relocalization.T_map_query.has_value());
  if (absl::Status status = CheckPaths({map.path, query.path}); !status.ok()) {
    return status;
  }
  MergingResult result;
  result.sessions = {{map.path, 0, {}}, {query.path, 0, {}}};
  result.links = {{0, 1, relocalization}};
  std::set<int> frozen_trajectories;
  for (size_t k = 0; k < map.map.state.trajectories.size(); ++k) {
    frozen_trajectories.insert(static_cast<int>(k));
  }
  StageClock clock(on_stage, &result.stage_seconds);
  const absl::Status status =
      Merger(options, stages, {&map, &query}, executor, &clock, &result)
          .Join({{0, Rigid2()}, {1, *relocalization.T_map_query}}, {},
                frozen_trajectories);
  if (!status.ok()) return status;
  return result;
}

}  // namespace cartographer_sdf
