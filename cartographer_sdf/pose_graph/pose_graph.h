// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer's 2D pose graph as plain data. As in the host's optimisation
// problem, the node frame is the *gravity-aligned* tracking frame: the file's
// 3D pose times the inverse of the node's gravity alignment, projected onto the
// plane. pbstream/ converts in both directions.

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_POSE_GRAPH_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_POSE_GRAPH_H_

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/grid/submap_id.h"

namespace cartographer_sdf {

// Identifies a node: a scan that passed the motion filter.
struct NodeId {
  int trajectory = 0;
  int index = 0;

  friend bool operator==(const NodeId& a, const NodeId& b) {
    return a.trajectory == b.trajectory && a.index == b.index;
  }
  friend bool operator!=(const NodeId& a, const NodeId& b) { return !(a == b); }
  friend bool operator<(const NodeId& a, const NodeId& b) {
    return std::tie(a.trajectory, a.index) < std::tie(b.trajectory, b.index);
  }
  friend std::ostream& operator<<(std::ostream& out, const NodeId& id) {
    return out << id.trajectory << "," << id.index;
  }
};

// Points of a node's range data in the node frame [m].
using PointCloud2 = std::vector<Eigen::Vector2f>;

struct Node {
  int64_t time = 0;
  Rigid2 T_map_node;
  // Pose by local SLAM in the trajectory's local frame; absent where the file
  // has a pose but no data for the node.
  std::optional<Rigid2> T_local_node;
  // Takes the tracking frame to the gravity-aligned frame. With IMU or
  // odometry it holds the yaw too.
  Eigen::Quaterniond gravity_alignment = Eigen::Quaterniond::Identity();
  // (previous node of the trajectory <- node) by odometry, if odometry covers
  // both times.
  std::optional<Rigid2> T_previous_node_by_odometry;
};

// Universal time, as in the file: 100 ns ticks since 0001-01-01.
constexpr int64_t kTicksPerSecond = 10'000'000;
constexpr int64_t kUnixEpochTicks =
    int64_t{719'162} * 24 * 3600 * kTicksPerSecond;

// Cartographer's default weights of constraints between a submap and the nodes
// that were inserted into it.
constexpr double kIntraTranslationWeight = 5e2;
constexpr double kIntraRotationWeight = 1.6e3;

struct Constraint {
  enum class Tag { kIntraSubmap, kInterSubmap };

  SubmapId submap;
  NodeId node;
  Rigid2 T_submap_node;
  double translation_weight = 0.;
  double rotation_weight = 0.;
  Tag tag = Tag::kIntraSubmap;
};

// Weights of the odometry between consecutive nodes.
struct OdometryWeights {
  double translation = 0.;
  double rotation = 0.;
};

struct PoseGraph {
  std::map<SubmapId, Rigid2> submap_poses;  // T_map_submap
  std::map<NodeId, Node> nodes;
  std::vector<Constraint> constraints;
  std::map<std::string, Rigid3> landmark_poses;  // (map <- landmark)
  // Trajectories whose weights differ from those of the optimisation options,
  // as where maps of different origin were joined. Not stored in the file.
  std::map<int, OdometryWeights> odometry_weights;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_POSE_GRAPH_H_
