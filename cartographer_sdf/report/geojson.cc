// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/geojson.h"

#include <cmath>
#include <map>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr double kDegree = M_PI / 180.;
// WGS 84: half the longer axis [m], and the first eccentricity squared.
constexpr double kSemiMajorAxis = 6378137.;
constexpr double kEccentricitySquared = 6.69437999014e-3;

class Projection {
 public:
  explicit Projection(const GeoOrigin& origin)
      : origin_(origin), T_earth_map_(0., 0., origin.bearing * kDegree) {
    const double sine = std::sin(origin.latitude * kDegree);
    const double w = 1. - kEccentricitySquared * sine * sine;
    // Radii of curvature, along the meridian and across it.
    meters_per_latitude_ = kDegree * kSemiMajorAxis *
                           (1. - kEccentricitySquared) / std::pow(w, 1.5);
    meters_per_longitude_ = kDegree * kSemiMajorAxis / std::sqrt(w) *
                            std::cos(origin.latitude * kDegree);
  }

  // "[longitude,latitude]", to a tenth of a millimetre.
  [[nodiscard]] std::string operator()(const Eigen::Vector2d& p_map) const {
    const Eigen::Vector2d east_north = T_earth_map_ * p_map;
    return absl::StrFormat(
        "[%.9f,%.9f]",
        origin_.longitude + east_north.x() / meters_per_longitude_,
        origin_.latitude + east_north.y() / meters_per_latitude_);
  }

 private:
  const GeoOrigin origin_;
  const Rigid2 T_earth_map_;
  double meters_per_latitude_ = 0.;
  double meters_per_longitude_ = 0.;
};

// One line of text.
std::string LineFeature(const Projection& project,
                        const std::vector<Eigen::Vector2d>& line,
                        Json properties) {
  std::vector<std::string> coordinates;
  double length = 0.;
  for (size_t k = 0; k < line.size(); ++k) {
    coordinates.push_back(project(line[k]));
    if (k > 0) length += (line[k] - line[k - 1]).norm();
  }
  properties["length_meters"] = length;
  return absl::StrCat(
      R"({"type":"Feature","geometry":{"type":"LineString","coordinates":[)",
      absl::StrJoin(coordinates, ","), R"(]},"properties":)", properties.dump(),
      "}");
}

// (submap <- node) as a line between them; empty if one of them has no pose.
std::vector<Eigen::Vector2d> LineOf(const PoseGraph& pose_graph,
                                    const Constraint& constraint) {
  const auto submap = pose_graph.submap_poses.find(constraint.submap);
  const auto node = pose_graph.nodes.find(constraint.node);
  if (submap == pose_graph.submap_poses.end() ||
      node == pose_graph.nodes.end()) {
    return {};
  }
  return {submap->second.translation(), node->second.T_map_node.translation()};
}

}  // namespace

std::string FormatGeoJson(const PoseGraph& pose_graph,
                          const GeoOrigin& origin) {
  const Projection project(origin);
  std::vector<std::string> features;
  for (const auto& [trajectory, path] : PathsOf(pose_graph)) {
    // A line has two ends.
    if (path.size() < 2) continue;
    features.push_back(LineFeature(project, path,
                                   {{"kind", "path"},
                                    {"trajectory", trajectory},
                                    {"nodes", path.size()}}));
  }
  for (const Constraint& constraint : pose_graph.constraints) {
    const std::vector<Eigen::Vector2d> line = LineOf(pose_graph, constraint);
    if (constraint.tag != Constraint::Tag::kInterSubmap || line.empty()) {
      continue;
    }
    features.push_back(
        LineFeature(project, line,
                    {{"kind", "closure"},
                     {"submap", ToJson(constraint.submap)},
                     {"node",
                      {{"trajectory", constraint.node.trajectory},
                       {"index", constraint.node.index}}}}));
  }
  return absl::StrCat(R"({"type":"FeatureCollection","features":[)", "\n",
                      absl::StrJoin(features, ",\n"), "\n]}\n");
}

}  // namespace cartographer_sdf
