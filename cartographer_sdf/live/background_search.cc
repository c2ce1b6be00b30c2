// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/background_search.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "cartographer_sdf/live/host_conversion.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// So many submaps of the map at most are held against the nodes of a trajectory
// that was located.
constexpr size_t kMaxLocationClosures = 3;

RetrievalOptions RecognizerOptions(const LiveOptions& options) {
  RetrievalOptions retrieval = options.retrieval;
  retrieval.max_num_candidates = std::max(
      retrieval.max_num_candidates, options.localization.max_num_candidates);
  retrieval.min_num_candidates =
      std::min(retrieval.max_num_candidates,
               std::max(retrieval.min_num_candidates,
                        options.localization.max_num_candidates));
  return retrieval;
}

void AddNodes(const SubmapId& submap, const std::vector<SubmapNode>& nodes,
              PoseGraph* const pose_graph, ScansByNode* const scans) {
  for (const SubmapNode& node : nodes) {
    pose_graph->constraints.push_back({submap, node.id, node.T_submap_node, 0.,
                                       0., Constraint::Tag::kIntraSubmap});
    std::vector<SurfacePoint> scan = NodeScan(*node.data);
    if (!scan.empty()) scans->emplace(node.id, std::move(scan));
  }
}

}  // namespace

std::vector<SubmapNode> ThinOut(const LiftingOptions& options,
                                const std::vector<SubmapNode>& nodes) {
  const size_t count =
      std::min(nodes.size(), static_cast<size_t>(options.num_nodes_per_submap));
  std::vector<SubmapNode> kept;
  for (size_t k = 0; k < count; ++k) {
    kept.push_back(nodes[(2 * k + 1) * nodes.size() / (2 * count)]);
  }
  return kept;
}

BackgroundSearch::BackgroundSearch(const LiveOptions& options)
    : options_(options),
      recognizer_(RecognizerOptions(options), options.match) {}

std::optional<Place> BackgroundSearch::Describe(
    const SubmapId& id, const OccupancyGrid& grid) const {
  std::optional<Place> place = DescribePlace(options_.place, id, grid);
  if (place) FindSelfSimilarities(options_.match, &*place);
  return place;
}

BackgroundSearch::Found BackgroundSearch::Recognize(const Place& query) const {
  std::vector<RetrievalCandidate> candidates =
      recognizer_.Retrieve(query, [this, &query](const SubmapId& id) {
        return id.trajectory == query.id.trajectory &&
               std::abs(id.index - query.id.index) < options_.min_index_gap;
      });
  const size_t max_num_candidates =
      static_cast<size_t>(options_.retrieval.max_num_candidates);
  const size_t min_num_candidates =
      static_cast<size_t>(options_.retrieval.min_num_candidates);
  // The recognizer retrieves more, for localization.
  while (candidates.size() > max_num_candidates ||
         (candidates.size() > min_num_candidates &&
          candidates.back().score < options_.retrieval.min_score)) {
    candidates.pop_back();
  }
  Found found;
  found.num_candidates = candidates.size();
  for (const RetrievalCandidate& candidate : candidates) {
    std::optional<Match> match =
        MatchPlaces(options_.match, places().at(candidate.id), query);
    if (match) found.matches.push_back(*std::move(match));
  }
  return found;
}

void BackgroundSearch::Remember(Place place) {
  if (places().count(place.id) == 0) recognizer_.Remember(std::move(place));
}

std::vector<Constraint> BackgroundSearch::Lift(
    const LoopClosure& closure, const std::vector<SubmapNode>& reference_nodes,
    const std::vector<SubmapNode>& query_nodes) const {
  PoseGraph pose_graph;
  ScansByNode scans;
  AddNodes(closure.reference, reference_nodes, &pose_graph, &scans);
  AddNodes(closure.query, query_nodes, &pose_graph, &scans);
  return LiftClosure(options_.lifting, pose_graph, closure,
                     places().at(closure.reference).surface,
                     places().at(closure.query).surface, scans);
}

void BackgroundSearch::StartLocalizing(const int trajectory_id) {
  local_searches_.erase(trajectory_id);
  local_searches_.emplace(trajectory_id, options_.localization);
}

void BackgroundSearch::StopLocalizing(const int trajectory_id) {
  local_searches_.erase(trajectory_id);
}

void BackgroundSearch::AddScans(const int trajectory_id,
                                std::vector<PlacedScan> scans) {
  const auto search = local_searches_.find(trajectory_id);
  if (search == local_searches_.end()) return;
  for (PlacedScan& scan : scans) search->second.grid.Insert(std::move(scan));
}

BackgroundSearch::Localization BackgroundSearch::Localize(
    const int trajectory_id, const std::map<SubmapId, Rigid2>& T_map_submap) {
  Localization result;
  const auto found = local_searches_.find(trajectory_id);
  if (found == local_searches_.end()) return result;
  LocalSearch& search = found->second;
  const std::optional<OccupancyGrid> grid = search.grid.Copy();
  if (!grid) return result;
  result.T_local_query = search.grid.T_local_grid();
  const std::optional<Place> query =
      Describe({trajectory_id, kGrowingSubmapIndex}, *grid);
  if (!query) return result;
  result.has_seen_walls = true;

  std::vector<Match> matches;
  std::vector<PoseVote> votes;
  for (const RetrievalCandidate& candidate :
       recognizer_.Retrieve(*query, [&T_map_submap](const SubmapId& id) {
         return T_map_submap.count(id) == 0;
       })) {
    ++result.num_candidates;
    std::optional<Match> match =
        MatchPlaces(options_.match, places().at(candidate.id), *query);
    if (!match) continue;
    votes.push_back(
        {T_map_submap.at(candidate.id) * match->closure.T_reference_query,
         match->closure.score, match->verdict == Verdict::kAccepted,
         match->verdict == Verdict::kUnlikely && match->closure.score > 0.});
    matches.push_back(*std::move(match));
  }
  const LocalizationOptions& options = options_.localization;
  result.location = FindLocation(options, votes);
  if (result.location) {
    result.reference =
        matches[result.location->supporters.front()].closure.reference;
  }
  if (!result.location || result.location->score < options.min_score ||
      result.location->score - result.location->runner_up_score <
          options.min_lead) {
    search.num_certain = 0;
    search.T_map_local.reset();
    return result;
  }
  const Rigid2 T_map_local =
      result.location->T_map_query * result.T_local_query.Inverse();
  const bool is_same =
      search.T_map_local &&
      IsSamePose(options, *search.T_map_local * result.T_local_query,
                 result.location->T_map_query);
  search.num_certain = is_same ? search.num_certain + 1 : 1;
  search.T_map_local = T_map_local;
  result.num_certain = search.num_certain;
  if (result.num_certain >= options.min_num_queries) {
    LiftLocation(search.grid, matches, *query, &result);
  }
  return result;
}

void BackgroundSearch::LiftLocation(const GrowingGrid& grid,
                                    const std::vector<Match>& matches,
                                    const Place& query,
                                    Localization* const result) const {
  std::vector<SubmapNode> nodes;
  for (const PlacedScan& scan : grid.scans()) {
    nodes.push_back(
        {FromHost(scan.node),
         result->T_local_query.Inverse() * LocalNodePose(*scan.data),
         scan.data});
  }
  nodes = ThinOut(options_.lifting, nodes);
  for (const SubmapNode& node : nodes) {
    result->gravity_alignments[node.id] = node.data->gravity_alignment;
  }
  PoseGraph pose_graph;
  ScansByNode scans;
  AddNodes(query.id, nodes, &pose_graph, &scans);
  for (const size_t k : result->location->supporters) {
    if (result->closures.size() == kMaxLocationClosures) break;
    const LoopClosure& closure = matches[k].closure;
    std::vector<Constraint> constraints = LiftClosure(
        options_.lifting, pose_graph, closure,
        places().at(closure.reference).surface, query.surface, scans);
    if (constraints.empty()) continue;
    result->closures.push_back(closure);
    result->constraints.push_back(std::move(constraints));
  }
}

}  // namespace cartographer_sdf
