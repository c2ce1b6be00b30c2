// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/background_search.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/localization/placement_covariance.h"
#include "cartographer_sdf/recognition/neighbourhood_verification.h"

namespace cartographer_sdf {
namespace {

// Maximum number of submaps of the map that are matched with the nodes of a
// localised trajectory.
constexpr size_t kMaxLocalizationClosures = 3;

// Submaps of the map that are compared with a pose that was found otherwise.
constexpr size_t kMaxNumNearSubmaps = 10;

// The host has cut beams without a return to its configured length.
ScanGridOptions GridOptions(const LiveLocalizationOptions& options) {
  ScanGridOptions grid;
  grid.resolution = options.resolution_meters;
  grid.empty_beam_length = grid.max_range;
  return grid;
}

void AddNodes(const SubmapId& submap, const std::vector<SubmapNode>& nodes,
              std::map<SubmapId, InsertedNodes>* const inserted,
              ScansByNode* const scans) {
  for (const SubmapNode& node : nodes) {
    (*inserted)[submap].emplace(node.id, node.T_submap_node);
    scans->emplace(node.id, NodeScan(*node.data));
  }
}

// Each place is at the origin of the map frame.
MapLayout LayoutOf(const std::map<SubmapId, Place>& places) {
  PoseGraph graph;
  for (const auto& [id, place] : places) graph.submap_poses[id] = Rigid2();
  return MakeMapLayout(graph, {}, places);
}

// The ids of the submaps whose middles are nearest to a point, nearest first.
std::vector<SubmapId> NearestSubmaps(const MapLayout& map,
                                     const Eigen::Vector2d& p_map) {
  std::vector<std::pair<double, SubmapId>> distances;
  for (const auto& [id, T_map_submap] : map.T_map_submap) {
    const auto centroid = map.centroids.find(id);
    if (centroid == map.centroids.end()) continue;
    distances.emplace_back((T_map_submap * centroid->second - p_map).norm(),
                           id);
  }
  std::sort(distances.begin(), distances.end());
  distances.resize(std::min(distances.size(), kMaxNumNearSubmaps));
  std::vector<SubmapId> ids;
  for (const auto& entry : distances) ids.push_back(entry.second);
  return ids;
}

// Of the best placement; zero if there is none.
Eigen::Matrix3d MeasureCovariance(const std::map<SubmapId, Place>& map_places,
                                  const std::map<SubmapId, Place>& query_places,
                                  const MapPair& maps,
                                  const Localization& localization,
                                  const Rigid2& T_query_tracking) {
  if (localization.placements.empty()) return Eigen::Matrix3d::Zero();
  const Placement& best = localization.placements.front();
  std::vector<PairPose> votes;
  for (const size_t vote : best.votes) {
    votes.push_back(localization.matches[vote].pair);
  }
  return PlacementCovariance(map_places, query_places, maps, votes,
                             best.T_map_query, T_query_tracking);
}

}  // namespace

std::vector<SubmapNode> ThinOut(const ConstraintOptions& options,
                                const std::vector<SubmapNode>& nodes) {
  std::vector<SubmapNode> kept;
  for (const size_t k : EvenlySpacedIndices(
           nodes.size(), static_cast<size_t>(options.num_nodes_per_submap))) {
    kept.push_back(nodes[k]);
  }
  return kept;
}

BackgroundSearch::BackgroundSearch(const LiveOptions& options)
    : options_(options), recognizer_(options.retrieval, options.match) {}

std::optional<Place> BackgroundSearch::Describe(
    const SubmapId& id, const OccupancyGrid& grid) const {
  std::optional<Place> place = DescribePlace(options_.place, id, grid);
  if (place) FindSelfSimilarities(options_.match, &*place);
  return place;
}

PlaceRecognizer::Recognition BackgroundSearch::Recognize(
    const SubmapId& query,
    const std::map<SubmapId, OdometryPose>& odometry) const {
  PlaceRecognizer::Recognition recognition = recognizer_.Recognize(
      places().at(query), [this, &query](const SubmapId& id) {
        return ShareScans(id, query, options_.min_index_gap);
      });
  if (options_.verify_neighbourhoods) {
    const TrajectoryPlaces map{&places(), &odometry};
    const NeighbourhoodMaps maps{map, map, options_.min_index_gap};
    for (Match& match : recognition.matches) {
      VerifyNeighbourhood(options_.neighbourhood, options_.match, maps, &match);
    }
  }
  return recognition;
}

void BackgroundSearch::Remember(Place place) {
  if (places().count(place.id) == 0) recognizer_.Remember(std::move(place));
}

void BackgroundSearch::GenerateConstraints(
    const std::map<SubmapId, std::vector<SubmapNode>>& nodes,
    std::vector<Closure>* const closures) const {
  std::map<SubmapId, InsertedNodes> inserted;
  ScansByNode scans;
  for (const Closure& closure : *closures) {
    if (closure.status != ClosureStatus::kSelected) continue;
    for (const SubmapId& submap :
         {closure.match.pair.reference, closure.match.pair.query}) {
      const auto found = nodes.find(submap);
      if (found == nodes.end() || inserted.count(submap) > 0) continue;
      AddNodes(submap, found->second, &inserted, &scans);
    }
  }
  cartographer_sdf::GenerateConstraints(options_.constraints, inserted,
                                        places(), scans, MakeExecutor(1),
                                        closures);
}

void BackgroundSearch::StartLocalizing(const int trajectory_id) {
  local_searches_.erase(trajectory_id);
  const LiveLocalizationOptions& options = options_.localization;
  local_searches_.emplace(
      trajectory_id,
      LocalSearch{{GridOptions(options), options.window_meters}, {}, {}, 0});
}

void BackgroundSearch::StopLocalizing(const int trajectory_id) {
  local_searches_.erase(trajectory_id);
}

void BackgroundSearch::AddScans(const int trajectory_id,
                                std::vector<NodeWithScan> nodes) {
  const auto found = local_searches_.find(trajectory_id);
  if (found == local_searches_.end()) return;
  LocalSearch& search = found->second;
  for (NodeWithScan& node : nodes) {
    search.nodes.push_back(std::move(node.data));
    search.grid.Insert(std::move(node.scan));
  }
  while (search.nodes.size() > search.grid.scans().size()) {
    search.nodes.pop_front();
  }
}

NodeData BackgroundSearch::NewestNode(const int trajectory_id) const {
  const auto found = local_searches_.find(trajectory_id);
  if (found == local_searches_.end() || found->second.nodes.empty()) {
    return nullptr;
  }
  return found->second.nodes.back();
}

std::optional<Place> BackgroundSearch::DescribeGrowing(
    const int trajectory_id, const LocalSearch& search) const {
  const std::optional<OccupancyGrid> grid = search.grid.Copy();
  if (!grid) return std::nullopt;
  return Describe({trajectory_id, kGrowingSubmapIndex}, *grid);
}

BackgroundSearch::Query BackgroundSearch::Localize(const int trajectory_id,
                                                   const MapLayout& map) {
  Query query;
  query.localization.verdict = LocalizationVerdict::kTooLittleSeen;
  const auto found = local_searches_.find(trajectory_id);
  if (found == local_searches_.end()) return query;
  LocalSearch& search = found->second;
  const std::optional<Place> place = DescribeGrowing(trajectory_id, search);
  if (!place) return query;
  query.T_local_query = search.grid.T_local_submap();
  const std::map<SubmapId, Place> query_places = {{place->id, *place}};
  const MapLayout query_layout = LayoutOf(query_places);
  const LiveLocalizationOptions& options = options_.localization;
  query.localization = cartographer_sdf::Localize(
      options.localizer, options_.consistency, options_.match,
      {&places(), &map}, {&query_places, &query_layout},
      [&](const std::map<SubmapId, Place>& queries, const ProgressCallback&) {
        PlaceRecognizer::Recognition recognition =
            recognizer_.RecognizeAmongBest(
                queries.begin()->second, options.max_num_candidates,
                [&map](const SubmapId& id) {
                  return map.T_map_submap.count(id) == 0;
                });
        query.num_candidates = recognition.num_candidates;
        return std::move(recognition.matches);
      },
      MakeExecutor(1));
  query.covariance = MeasureCovariance(
      places(), query_places, {&map, &query_layout}, query.localization,
      query.T_local_query.Inverse() *
          FromHost(search.nodes.back()->local_pose));
  CountCertain(query.T_local_query, &search, &query);
  if (query.num_certain >= options.min_num_queries) {
    CloseWithMap(search, *place, &query);
  }
  return query;
}

BackgroundSearch::Query BackgroundSearch::ConfirmPose(
    const int trajectory_id, const MapLayout& map,
    const Rigid2& T_map_local) const {
  Query query;
  query.localization.verdict = LocalizationVerdict::kUncertain;
  const auto found = local_searches_.find(trajectory_id);
  if (found == local_searches_.end()) return query;
  const LocalSearch& search = found->second;
  const std::optional<Place> place = DescribeGrowing(trajectory_id, search);
  if (!place) return query;
  query.T_local_query = search.grid.T_local_submap();
  Placement placement;
  placement.T_map_query = T_map_local * query.T_local_query;
  const Rigid2 T_query_tracking =
      query.T_local_query.Inverse() * FromHost(search.nodes.back()->local_pose);
  query.localization.matches =
      MatchAt(map, *place, placement.T_map_query, T_query_tracking);
  if (query.localization.matches.empty()) return query;
  placement.votes.resize(query.localization.matches.size());
  std::iota(placement.votes.begin(), placement.votes.end(), size_t{0});
  query.localization.placements.push_back(std::move(placement));
  CloseWithMap(search, *place, &query);
  return query;
}

std::vector<Match> BackgroundSearch::MatchAt(
    const MapLayout& map, const Place& query, const Rigid2& T_map_query,
    const Rigid2& T_query_tracking) const {
  std::vector<Match> matches;
  const Eigen::Vector2d& p_query = T_query_tracking.translation();
  for (const SubmapId& id : NearestSubmaps(map, T_map_query * p_query)) {
    const Place& reference = places().at(id);
    const Rigid2 T_reference_query =
        map.T_map_submap.at(id).Inverse() * T_map_query;
    std::optional<VerifiedPose> verified =
        VerifyClaim(options_.match.verification, reference.surface,
                    query.surface, T_reference_query, {});
    // A few scans show too little for a match to be accepted by itself.
    if (!verified || verified->verdict == Verdict::kContradicted ||
        verified->verdict == Verdict::kTooLittleOverlap ||
        !AreNear(verified->T_reference_query, T_reference_query, p_query,
                 {options_.localization.max_translation_difference_meters,
                  options_.localization.max_rotation_difference})) {
      continue;
    }
    matches.push_back(
        MakeMatch(options_.match, reference, query, *std::move(verified)));
  }
  return matches;
}

void BackgroundSearch::CountCertain(const Rigid2& T_local_query,
                                    LocalSearch* const search,
                                    Query* const query) const {
  if (!query->localization.T_map_query) {
    search->num_certain = 0;
    search->T_map_local.reset();
    return;
  }
  const Rigid2& T_map_query = *query->localization.T_map_query;
  const bool is_same =
      search->T_map_local &&
      AreNear(*search->T_map_local * T_local_query, T_map_query,
              Eigen::Vector2d::Zero(),
              {options_.localization.max_translation_difference_meters,
               options_.localization.max_rotation_difference});
  search->num_certain = is_same ? search->num_certain + 1 : 1;
  search->T_map_local = T_map_query * T_local_query.Inverse();
  query->num_certain = search->num_certain;
}

void BackgroundSearch::CloseWithMap(const LocalSearch& search,
                                    const Place& place,
                                    Query* const query) const {
  std::vector<SubmapNode> nodes;
  for (size_t k = 0; k < search.nodes.size(); ++k) {
    const DrivenScan& scan = search.grid.scans()[k];
    nodes.push_back({scan.node,
                     query->T_local_query.Inverse() * scan.T_local_node,
                     search.nodes[k]});
  }
  nodes = ThinOut(options_.constraints, nodes);
  std::map<SubmapId, InsertedNodes> inserted;
  ScansByNode scans;
  AddNodes(place.id, nodes, &inserted, &scans);
  const Localization& localization = query->localization;
  std::vector<const Match*> votes;
  for (const size_t vote : localization.placements.front().votes) {
    votes.push_back(&localization.matches[vote]);
  }
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Match* const a, const Match* const b) {
                     return a->pair.score > b->pair.score;
                   });
  for (const Match* const vote : votes) {
    if (query->closures.size() == kMaxLocalizationClosures) break;
    Closure closure;
    closure.match = *vote;
    closure.constraints = cartographer_sdf::GenerateConstraints(
        options_.constraints, vote->pair, inserted,
        places().at(vote->pair.reference).surface, place.surface, scans);
    if (closure.constraints.size() >=
        static_cast<size_t>(options_.constraints.min_num_constraints)) {
      query->closures.push_back(std::move(closure));
    }
  }
}

}  // namespace cartographer_sdf
