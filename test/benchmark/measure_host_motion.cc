// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a stock Cartographer does to a map that it loads unfrozen: runs its
// final optimisation with its defaults, prints how far nodes move [m], and
// saves the result.
//
// usage: measure_host_motion MAP.pbstream OUTPUT.pbstream [LUA]
//   LUA  lines that change the defaults, for example
//        POSE_GRAPH.optimization_problem.odometry_translation_weight = 1e3

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "glog/logging.h"
#include "test/live/host.h"

namespace cartographer_sdf {
namespace {

namespace mapping = ::cartographer::mapping;

// How far each node moves [m], sorted.
std::vector<double> Motions(const PoseGraph& before,
                            mapping::PoseGraphInterface* const host) {
  std::vector<double> motions;
  for (const auto& node : host->GetTrajectoryNodes()) {
    const NodeId id{node.id.trajectory_id, node.id.node_index};
    const Eigen::Vector2d after = node.data.global_pose.translation().head<2>();
    motions.push_back(
        (after - before.nodes.at(id).T_map_node.translation()).norm());
  }
  std::sort(motions.begin(), motions.end());
  return motions;
}

int Main(const std::string& map_path, const std::string& output,
         const std::string& lua) {
  const absl::StatusOr<MapState> map = ReadMap(map_path);
  CHECK(map.ok()) << map.status();
  const testing::StockOptions stock = testing::MakeStockOptions(lua);
  const auto host = mapping::CreateMapBuilder(stock.map_builder);
  host->LoadStateFromFile(map_path, /*load_frozen_state=*/false);
  host->pose_graph()->RunFinalOptimization();
  const std::vector<double> motions =
      Motions(map->pose_graph, host->pose_graph());
  CHECK(!motions.empty());
  std::cout << "nodes,median_m,max_m\n"
            << motions.size() << "," << motions[motions.size() / 2] << ","
            << motions.back() << "\n";
  return host->SerializeStateToFile(/*include_unfinished_submaps=*/true, output)
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: measure_host_motion MAP.pbstream OUTPUT.pbstream "
                 "[LUA]\n";
    return 2;
  }
  return cartographer_sdf::Main(argv[1], argv[2], argc == 4 ? argv[3] : "");
}
