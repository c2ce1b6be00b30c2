// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Joins maps into one as they are, each with trajectories of its own, without
// looking for loop closures: maps of any size for measurements.
//
// usage: join_maps OUTPUT.pbstream MAP.pbstream [MAP.pbstream ...]

#include <iostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {
namespace {

absl::Status Join(const std::string& output,
                  const std::vector<std::string>& paths) {
  std::vector<MapState> maps;
  std::vector<const MapState*> pointers;
  for (const std::string& path : paths) {
    absl::StatusOr<MapState> map = ReadMap(path, {});
    if (!map.ok()) return map.status();
    maps.push_back(*std::move(map));
  }
  for (const MapState& map : maps) pointers.push_back(&map);
  const std::vector<MapPart> parts = NumberTrajectories(paths, pointers);
  MapState joined;
  for (size_t k = 0; k < maps.size(); ++k) {
    AppendMap(parts[k], maps[k], &joined);
  }
  std::cout << joined.submaps.size() << " submaps, "
            << joined.pose_graph.nodes.size() << " nodes\n";
  return WriteJoinedMap(parts, joined.pose_graph, output);
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: join_maps OUTPUT.pbstream MAP.pbstream ...\n";
    return 1;
  }
  const absl::Status status = cartographer_sdf::Join(
      argv[1], std::vector<std::string>(argv + 2, argv + argc));
  if (status.ok()) return 0;
  std::cerr << status.message() << "\n";
  return 1;
}
