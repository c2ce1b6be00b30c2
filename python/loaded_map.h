// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef PYTHON_LOADED_MAP_H_
#define PYTHON_LOADED_MAP_H_

#include <map>
#include <string>

#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {

// cartographer_sdf.Map in Python: a map with all its grids.
struct LoadedMap {
  std::string path;
  MapState state;
  std::map<SubmapId, OccupancyGrid> grids;
};

}  // namespace cartographer_sdf

#endif  // PYTHON_LOADED_MAP_H_
