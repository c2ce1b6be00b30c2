// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How good a map is, without a truth: whether places seen twice agree in it,
// whether local SLAM agrees with itself, and how much its places say. With
// advice in plain words.

#ifndef CARTOGRAPHER_SDF_APPS_MAP_EXAMINATION_H_
#define CARTOGRAPHER_SDF_APPS_MAP_EXAMINATION_H_

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/apps/map_quality.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/pose_graph/slips.h"
#include "cartographer_sdf/verification/tear.h"

namespace cartographer_sdf {

struct MapExamination {
  size_t num_submaps = 0;
  size_t num_places = 0;  // submaps that show walls
  // Whether the map has constraints that close loops.
  bool is_closed = false;
  // Where submaps lie over each other in the map.
  MapQuality whole;
  // Of submaps two indices apart, which share no scans, as local SLAM placed
  // them: the noise of the map itself.
  MapQuality along_trajectories;
  // The first submap of each link that walls contradict.
  std::set<SubmapId> broken_links;
  std::map<SubmapId, Tear> torn_submaps;
  // Steps of local SLAM that odometry contradicts.
  Slips slips;
  // Places that verification would take for themselves in another pose, turned
  // by half a turn or shifted.
  size_t num_self_similar = 0;
  // Mean area that a place shows [m^2].
  double mean_area = 0.;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// The map must have its point clouds.
[[nodiscard]] MapExamination ExamineMap(const LoopClosingOptions& options,
                                        const DescribedMap& map,
                                        const Executor& executor,
                                        const StageCallback& on_stage = {});

// Returns sentences for people, the gravest first: what is wrong with the map
// and what improves it. Empty if nothing is.
[[nodiscard]] std::vector<std::string> AdviseOnMap(
    const MapExamination& examination);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_MAP_EXAMINATION_H_
