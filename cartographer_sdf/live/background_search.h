// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the worker does: it describes, remembers and recognises places, and
// locates trajectories in the places of a map. Knows neither locks nor the
// host's pose graph.

#ifndef CARTOGRAPHER_SDF_LIVE_BACKGROUND_SEARCH_H_
#define CARTOGRAPHER_SDF_LIVE_BACKGROUND_SEARCH_H_

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "cartographer_sdf/live/growing_grid.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/live/location.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/recognition/place_recognizer.h"

namespace cartographer_sdf {

// The index of a growing submap of ours, that the host does not know.
constexpr int kGrowingSubmapIndex = -1;

// A node of a submap whose scan will be held against other submaps.
struct SubmapNode {
  NodeId id;
  Rigid2 T_submap_node;
  std::shared_ptr<const cartographer::mapping::TrajectoryNode::Data> data;
};

// Evenly spaced ones, as many as are lifted.
[[nodiscard]] std::vector<SubmapNode> ThinOut(
    const LiftingOptions& options, const std::vector<SubmapNode>& nodes);

// Thread-compatible.
class BackgroundSearch {
 public:
  explicit BackgroundSearch(const LiveOptions& options);

  // None where the grid shows no walls.
  [[nodiscard]] std::optional<Place> Describe(const SubmapId& id,
                                              const OccupancyGrid& grid) const;
  struct Found {
    std::vector<Match> matches;  // whatever their verdict
    size_t num_candidates = 0;
  };
  // Among the places that are not nearly the same by their ids.
  [[nodiscard]] Found Recognize(const Place& query) const;
  void Remember(Place place);
  void Forget(const SubmapId& id) { recognizer_.Forget(id); }
  [[nodiscard]] const std::map<SubmapId, Place>& places() const {
    return recognizer_.places();
  }

  // Constraints of the closure; those of nodes of the reference are left out
  // where none are given. Both places are remembered.
  [[nodiscard]] std::vector<Constraint> Lift(
      const LoopClosure& closure,
      const std::vector<SubmapNode>& reference_nodes,
      const std::vector<SubmapNode>& query_nodes) const;

  // Locating a trajectory. Starts again from nothing:
  void StartLocalizing(int trajectory_id);
  void StopLocalizing(int trajectory_id);
  void AddScans(int trajectory_id, std::vector<PlacedScan> scans);
  struct Localization {
    std::optional<Location> location;
    // The submap that matches best there.
    std::optional<SubmapId> reference;
    // The frame of the query in the trajectory's local frame.
    Rigid2 T_local_query;
    // Queries in a row, this one included, that said the same and were certain.
    int num_certain = 0;
    bool has_seen_walls = false;
    size_t num_candidates = 0;
    // Matches that agree on the location, best first, and what they are as
    // constraints of the trajectory's nodes; as many as are needed.
    std::vector<LoopClosure> closures;
    std::vector<std::vector<Constraint>> constraints;
    std::map<NodeId, Eigen::Quaterniond> gravity_alignments;  // of their nodes
  };
  // Among the given submaps, whose poses in the map are T_map_submap. The
  // trajectory has scans.
  [[nodiscard]] Localization Localize(
      int trajectory_id, const std::map<SubmapId, Rigid2>& T_map_submap);

 private:
  struct LocalSearch {
    explicit LocalSearch(const LocalizationOptions& options)
        : grid(options.resolution_meters, options.window_meters) {}
    GrowingGrid grid;
    std::optional<Rigid2> T_map_local;  // by the latest certain query
    int num_certain = 0;
  };
  void LiftLocation(const GrowingGrid& grid, const std::vector<Match>& matches,
                    const Place& query, Localization* result) const;

  const LiveOptions options_;
  PlaceRecognizer recognizer_;
  std::map<int, LocalSearch> local_searches_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_BACKGROUND_SEARCH_H_
