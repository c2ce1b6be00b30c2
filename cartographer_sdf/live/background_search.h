// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The work of the worker: describes, remembers and recognises places, generates
// the constraints of closures, and localises trajectories among the places of a
// map. Independent of locks and of the host's pose graph.

#ifndef CARTOGRAPHER_SDF_LIVE_BACKGROUND_SEARCH_H_
#define CARTOGRAPHER_SDF_LIVE_BACKGROUND_SEARCH_H_

#include <Eigen/Core>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer_sdf/closing/pipeline.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/localization/growing_grid.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/recognition/place_recognizer.h"

namespace cartographer_sdf {

// The index of our growing submap, which the host does not know.
constexpr int kGrowingSubmapIndex = -1;

using NodeData =
    std::shared_ptr<const cartographer::mapping::TrajectoryNode::Data>;

// A node of a submap whose scan will be matched with other submaps.
struct SubmapNode {
  NodeId id;
  Rigid2 T_submap_node;
  NodeData data;
};

// A scan for localising a trajectory, and the host's node it belongs to.
struct NodeWithScan {
  NodeData data;
  DrivenScan scan;
};

// Returns evenly spaced nodes, as many as get constraints.
[[nodiscard]] std::vector<SubmapNode> ThinOut(
    const ConstraintOptions& options, const std::vector<SubmapNode>& nodes);

// Thread-compatible.
class BackgroundSearch {
 public:
  explicit BackgroundSearch(const LiveOptions& options);

  // None where the grid shows no walls.
  [[nodiscard]] std::optional<Place> Describe(const SubmapId& id,
                                              const OccupancyGrid& grid) const;
  // Matches a remembered place, the query, with the others that share no scans
  // with it. `odometry` must contain all of them.
  [[nodiscard]] PlaceRecognizer::Recognition Recognize(
      const SubmapId& query,
      const std::map<SubmapId, OdometryPose>& odometry) const;
  void Remember(Place place);
  void Forget(const SubmapId& id) { recognizer_.Forget(id); }
  [[nodiscard]] const std::map<SubmapId, Place>& places() const {
    return recognizer_.places();
  }

  // Generates the constraints of the selected closures (closing/pipeline.h);
  // both places of each must be remembered. The nodes of submaps that are not
  // in `nodes` get none.
  void GenerateConstraints(
      const std::map<SubmapId, std::vector<SubmapNode>>& nodes,
      std::vector<Closure>* closures) const;

  // Starts localising a trajectory, or restarts from scratch.
  void StartLocalizing(int trajectory_id);
  void StopLocalizing(int trajectory_id);
  void AddScans(int trajectory_id, std::vector<NodeWithScan> nodes);
  struct Query {
    Localization localization;  // of `T_local_query` as the query's map frame
    // The query frame in the trajectory's local frame.
    Rigid2 T_local_query;
    // Number of consecutive queries, including this one, that were localised at
    // the same place.
    int num_certain = 0;
    // Of the tracking frame at the newest scan in the map, by the best
    // placement (LocalizationResult::covariance); zero if there is none.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    size_t num_candidates = 0;
    // Once enough queries agree: the best matches as closures, with constraints
    // of the trajectory's nodes.
    std::vector<Closure> closures;
  };
  // Of the newest scan; null if there is none.
  [[nodiscard]] NodeData NewestNode(int trajectory_id) const;
  // What Localize() says once enough queries agree, of a pose in the map that
  // was found otherwise: the submaps near it that do not contradict it and
  // whose walls, registered, leave it where it is. Without closures if the
  // scans of too few nodes fit there.
  [[nodiscard]] Query ConfirmPose(int trajectory_id, const MapLayout& map,
                                  const Rigid2& T_map_local) const;
  // Localises the trajectory among the remembered submaps of the layout. The
  // trajectory must have scans.
  [[nodiscard]] Query Localize(int trajectory_id, const MapLayout& map);

 private:
  struct LocalSearch {
    GrowingGrid grid;
    // One for each scan of the grid, in their order.
    std::deque<NodeData> nodes;
    std::optional<Rigid2> T_map_local;  // of the latest certain query
    int num_certain = 0;
  };
  // The growing submap; none if it shows no walls.
  [[nodiscard]] std::optional<Place> DescribeGrowing(
      int trajectory_id, const LocalSearch& search) const;
  // Of the growing submap with submaps of the map around its newest node.
  [[nodiscard]] std::vector<Match> MatchAt(
      const MapLayout& map, const Place& query, const Rigid2& T_map_query,
      const Rigid2& T_query_tracking) const;
  void CountCertain(const Rigid2& T_local_query, LocalSearch* search,
                    Query* query) const;
  void CloseWithMap(const LocalSearch& search, const Place& place,
                    Query* query) const;

  const LiveOptions options_;
  PlaceRecognizer recognizer_;
  std::map<int, LocalSearch> local_searches_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_BACKGROUND_SEARCH_H_
