// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Recognises places of a map by matching submaps, as this project does, and by
// Cartographer's own search for a scan in a whole submap, without a prior
// (MatchFullSubmap): branch and bound with Cartographer's default options. The
// map must be one whose loops are closed: its poses are the truth.
//
// usage: measure_full_submap_search MAP.pbstream [MAX_NUM_PAIRS]
//
// For pairs of submaps that see the same place, and as many that do not: the
// median CPU time of one search, how many of the poses are accepted, and how
// many of these are within 1 m and 10 degrees. Cartographer searches for the
// scan in the middle of the second submap.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {
namespace {

namespace host = ::cartographer;
using host::mapping::scan_matching::FastCorrelativeScanMatcher2D;

// Of constraint_builder in Cartographer's configuration.
constexpr float kMinHostScore = 0.6f;
// Submaps nearer than this see the same place; those farther apart than the
// other do not [m].
constexpr double kNear = 3.;
constexpr double kFar = 20.;
constexpr int kMinIndexGap = 3;
constexpr PoseTolerance kRightPose{1., 0.175};

struct Map {
  DescribedMap described;
  std::map<SubmapId, OccupancyGrid> grids;
};

struct Pair {
  SubmapId reference;
  SubmapId query;
};

struct Tally {
  std::vector<double> milliseconds;
  int num_accepted = 0;
  int num_right = 0;

  void Add(const double time, const bool is_accepted, const bool is_right) {
    milliseconds.push_back(time);
    num_accepted += is_accepted;
    num_right += is_accepted && is_right;
  }
};

double Milliseconds(const std::clock_t begin) {
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double Median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// In the frame of our grid, so that no cell is resampled. Cartographer's first
// index runs along -y, its second along -x.
host::mapping::ProbabilityGrid HostGrid(
    const OccupancyGrid& grid,
    host::mapping::ValueConversionTables* const tables) {
  const CellGeometry& geometry = grid.geometry;
  const Eigen::Array2i size = geometry.size;
  host::mapping::ProbabilityGrid result(
      host::mapping::MapLimits(
          geometry.resolution,
          geometry.resolution * size.matrix().cast<double>(),
          host::mapping::CellLimits(size.y(), size.x())),
      tables);
  for (int j = 0; j < size.y(); ++j) {
    for (int i = 0; i < size.x(); ++i) {
      if (!grid.known(i, j)) continue;
      result.SetProbability({size.y() - 1 - j, size.x() - 1 - i},
                            grid.probability(i, j));
    }
  }
  return result;
}

host::sensor::PointCloud HostCloud(const PointCloud2& points) {
  host::sensor::PointCloud cloud;
  for (const Eigen::Vector2f& point : points) {
    cloud.push_back({Eigen::Vector3f(point.x(), point.y(), 0.f)});
  }
  return cloud;
}

absl::StatusOr<Map> Read(const std::string& path) {
  Map map;
  const auto add = [&map](const SubmapId& id, const SubmapSummary&,
                          OccupancyGrid grid) {
    map.grids.emplace(id, std::move(grid));
  };
  const absl::Status status = ReadMap(path, {add, {}}).status();
  if (!status.ok()) return status;
  absl::StatusOr<DescribedMap> described =
      DescribeMap(PlaceOptions(), MatchOptions(), path, MakeExecutor(1), {},
                  PointClouds::kKeep);
  if (!described.ok()) return described.status();
  map.described = *std::move(described);
  return map;
}

// The node in the middle of those that built a submap.
std::optional<NodeId> MiddleNode(const Map& map, const SubmapId& id) {
  std::vector<NodeId> nodes;
  for (const Constraint& constraint :
       map.described.state.pose_graph.constraints) {
    if (constraint.tag == Constraint::Tag::kIntraSubmap &&
        constraint.submap == id &&
        map.described.point_clouds.count(constraint.node) > 0) {
      nodes.push_back(constraint.node);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  if (nodes.empty()) return std::nullopt;
  return nodes[nodes.size() / 2];
}

// Pairs of submaps, the nearest that share no scans or one that is far away.
std::vector<Pair> ChoosePairs(const Map& map, const bool near,
                              const size_t count) {
  std::map<SubmapId, Eigen::Vector2d> centroids;
  for (const auto& [id, place] : map.described.places) {
    centroids[id] = map.described.state.pose_graph.submap_poses.at(id) *
                    ObservedCentroid(place.surface);
  }
  std::vector<Pair> pairs;
  for (const auto& [query, centroid] : centroids) {
    std::optional<std::pair<double, SubmapId>> best;
    for (const auto& [reference, other] : centroids) {
      if (ShareScans(reference, query, kMinIndexGap)) continue;
      const double distance = (other - centroid).norm();
      if (near ? distance > kNear : distance < kFar) continue;
      if (!best || distance < best->first) best = {distance, reference};
    }
    if (best) pairs.push_back({best->second, query});
  }
  std::vector<Pair> chosen;
  for (size_t k = 0; k < std::min(count, pairs.size()); ++k) {
    chosen.push_back(pairs[k * pairs.size() / std::min(count, pairs.size())]);
  }
  return chosen;
}

void MatchSubmaps(const Map& map, const Pair& pair, const Rigid2& truth,
                  Tally* const tally) {
  const Place& query = map.described.places.at(pair.query);
  const std::clock_t begin = std::clock();
  const std::optional<Match> match = MatchPlaces(
      MatchOptions(), map.described.places.at(pair.reference), query);
  const double time = Milliseconds(begin);
  tally->Add(time, match && match->verdict == Verdict::kAccepted,
             match && AreNear(match->pair.T_reference_query, truth,
                              ObservedCentroid(query.surface), kRightPose));
}

// Returns the time to prepare the submap for all searches in it.
double SearchScan(const Map& map, const Pair& pair, const NodeId& node,
                  const Rigid2& truth, Tally* const tally) {
  host::mapping::ValueConversionTables tables;
  const OccupancyGrid& submap = map.grids.at(pair.reference);
  const host::mapping::ProbabilityGrid grid = HostGrid(submap, &tables);
  host::mapping::scan_matching::proto::FastCorrelativeScanMatcherOptions2D
      options;
  options.set_linear_search_window(7.);
  options.set_angular_search_window(M_PI / 6.);
  options.set_branch_and_bound_depth(7);
  std::clock_t begin = std::clock();
  const FastCorrelativeScanMatcher2D matcher(grid, options);
  const double preparation = Milliseconds(begin);
  const host::sensor::PointCloud cloud =
      HostCloud(map.described.point_clouds.at(node));
  float score = 0.f;
  host::transform::Rigid2d pose;
  begin = std::clock();
  const bool is_found =
      matcher.MatchFullSubmap(cloud, kMinHostScore, &score, &pose);
  const double time = Milliseconds(begin);
  const Rigid2 T_submap_scan =
      submap.geometry.T_submap_grid *
      Rigid2(pose.translation(), pose.rotation().angle());
  tally->Add(time, is_found,
             is_found && AreNear(T_submap_scan, truth, {0., 0.}, kRightPose));
  return preparation;
}

void Print(const char* const what, const Tally& tally) {
  std::cout << "  " << what << ": " << Median(tally.milliseconds) << " ms, "
            << tally.num_accepted << " of " << tally.milliseconds.size()
            << " accepted, " << tally.num_right << " of these right\n";
}

void Measure(const Map& map, const char* const title,
             const std::vector<Pair>& pairs) {
  const PoseGraph& graph = map.described.state.pose_graph;
  Tally submaps, scans;
  std::vector<double> preparations;
  for (const Pair& pair : pairs) {
    const std::optional<NodeId> node = MiddleNode(map, pair.query);
    if (!node) continue;
    const Rigid2 T_reference_map =
        graph.submap_poses.at(pair.reference).Inverse();
    MatchSubmaps(map, pair, T_reference_map * graph.submap_poses.at(pair.query),
                 &submaps);
    preparations.push_back(
        SearchScan(map, pair, *node,
                   T_reference_map * graph.nodes.at(*node).T_map_node, &scans));
  }
  std::cout << title << "\n";
  Print("a submap in a submap", submaps);
  Print("Cartographer, a scan in a submap", scans);
  std::cout << "  Cartographer, once for each submap: " << Median(preparations)
            << " ms\n";
}

int Run(const std::string& path, const size_t max_num_pairs) {
  const absl::StatusOr<Map> map = Read(path);
  if (!map.ok()) {
    std::cerr << map.status().message() << "\n";
    return 1;
  }
  Measure(*map, "pairs of submaps that see the same place:",
          ChoosePairs(*map, true, max_num_pairs));
  Measure(*map, "pairs of submaps far apart:",
          ChoosePairs(*map, false, max_num_pairs));
  return 0;
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: measure_full_submap_search MAP.pbstream "
                 "[MAX_NUM_PAIRS]\n";
    return 2;
  }
  const int max_num_pairs = argc == 3 ? std::atoi(argv[2]) : 40;
  return cartographer_sdf::Run(argv[1],
                               static_cast<size_t>(std::max(1, max_num_pairs)));
}
