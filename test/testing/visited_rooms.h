// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The map, as in a file, of one drive that sees two rooms, and later both
// again: as small as a map with loops can be.

#ifndef TEST_TESTING_VISITED_ROOMS_H_
#define TEST_TESTING_VISITED_ROOMS_H_

#include <cmath>
#include <string>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "glog/logging.h"
#include "test/testing/building.h"
#include "test/testing/slipped_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::testing {

class VisitedRooms {
 public:
  static constexpr SubmapId kWestFirst{0, 0}, kEastFirst{0, 1};
  static constexpr SubmapId kWestAgain{0, 2}, kEastAgain{0, 3};
  static constexpr int kNodesPerSubmap = 12;

  // Local SLAM is off by some centimetres since the first visit and, if told
  // so, slips in the middle of the last submap.
  explicit VisitedRooms(const Rigid2& slip = Rigid2()) {
    const Rigid2 drifted(0.08, -0.05, 0.004);
    AddSubmap({{1., 2.2}, {3., 2.}, {5.6, 1.2}, {5.5, 4.2}}, {}, {});
    AddSubmap({{10.6, 2.7}, {11., -0.8}, {13.6, 0.8}, {13.5, 3.4}}, {}, {});
    AddSubmap({{2., 1.}, {2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}}, drifted, {});
    AddSubmap({{10.8, 2.4}, {11.2, -0.6}, {13.8, 1.}, {13.3, 3.2}}, drifted,
              slip);
    DrawGrids(&simulated_);
    AddOdometry();
    const absl::Status status =
        WriteSimulatedMap(simulated_, Path(), Path() + ".truth.csv");
    CHECK(status.ok()) << status;
    absl::StatusOr<DescribedMap> map =
        DescribeMap(PlaceOptions(), MatchOptions(), Path(), MakeExecutor(2), {},
                    PointClouds::kKeep);
    CHECK(map.ok()) << map.status();
    map_ = *std::move(map);
  }

  [[nodiscard]] std::string Path() const {
    return directory_.File("rooms.pbstream");
  }
  [[nodiscard]] const TemporaryDirectory& directory() const {
    return directory_;
  }
  [[nodiscard]] const DescribedMap& map() const { return map_; }
  [[nodiscard]] const Rigid2& T_world_node(const NodeId& id) const {
    return simulated_.nodes.at(static_cast<size_t>(id.index)).T_world_node;
  }
  [[nodiscard]] const Rigid2& T_world_submap(const SubmapId& id) const {
    return simulated_.submaps.at(static_cast<size_t>(id.index)).T_world_submap;
  }
  [[nodiscard]] Rigid2 TruePose(const SubmapId& reference,
                                const SubmapId& query) const {
    return T_world_submap(reference).Inverse() * T_world_submap(query);
  }
  // Accepted at the true pose, or off by `error` as the query sees it.
  [[nodiscard]] Match MakeMatch(const SubmapId& reference,
                                const SubmapId& query, const double score,
                                const Rigid2& error = Rigid2()) const {
    Match match;
    match.pair = {reference, query, TruePose(reference, query) * error, score};
    match.pair_score = score;
    match.verdict = Verdict::kAccepted;
    return match;
  }

 private:
  void AddSubmap(const Viewpoints& way, const Rigid2& T_local_world,
                 const Rigid2& slip) {
    SimulatedSubmap submap;
    submap.first_node = static_cast<int>(simulated_.nodes.size());
    for (int k = 0; k < kNodesPerSubmap; ++k) {
      const double along = static_cast<double>(k) *
                           static_cast<double>(way.size() - 1) /
                           (kNodesPerSubmap - 0.5);
      const auto corner = static_cast<size_t>(along);
      const double part = along - static_cast<double>(corner);
      SimulatedNode node;
      node.time = 5'000'000 * static_cast<int64_t>(simulated_.nodes.size() + 1);
      node.T_world_node =
          Rigid2((1. - part) * way[corner] + part * way[corner + 1], 0.3 * k);
      node.T_local_node = T_local_world * node.T_world_node;
      if (k >= kNodesPerSubmap / 2) {
        node.T_local_node = T_local_world * slip * node.T_world_node;
      }
      for (const SurfacePoint& point :
           TakeScan(TwoRooms(), node.T_world_node)) {
        node.points.push_back(point.position.cast<float>());
      }
      simulated_.nodes.push_back(std::move(node));
    }
    submap.end_node = static_cast<int>(simulated_.nodes.size());
    simulated_.submaps.push_back(std::move(submap));
  }

  // As local SLAM but for some millimetres a step.
  void AddOdometry() {
    Rigid2 T_odometry_node;
    const SimulatedNode* previous = nullptr;
    for (const SimulatedNode& node : simulated_.nodes) {
      if (previous != nullptr) {
        const double k = static_cast<double>(simulated_.odometry.size());
        T_odometry_node =
            T_odometry_node * previous->T_local_node.Inverse() *
            node.T_local_node *
            Rigid2(0.004 * std::sin(k), 0.003 * std::cos(k), 0.002);
      }
      simulated_.odometry.push_back({node.time, T_odometry_node});
      previous = &node;
    }
  }

  TemporaryDirectory directory_;
  SimulatedMap simulated_;
  DescribedMap map_;
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_VISITED_ROOMS_H_
