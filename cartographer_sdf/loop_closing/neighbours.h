// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// All matches of a map judged again by what the neighbours of both submaps say
// (recognition/neighbourhood.h), and found where only neighbours propose them.

#ifndef CARTOGRAPHER_SDF_LOOP_CLOSING_NEIGHBOURS_H_
#define CARTOGRAPHER_SDF_LOOP_CLOSING_NEIGHBOURS_H_

#include <optional>
#include <vector>

#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

// `matches` are those of MatchWithin (with the same `min_index_gap`) or
// MatchBetween (without), method kSdf, in the order of their ids. Afterwards
// each is the pose of its pair that its neighbourhood makes most likely, its
// score and verdict are those in the neighbourhood, and pairs that had no pose
// may have one. The order is that of the ids.
void JudgeByNeighbours(const NeighbourhoodOptions& options,
                       const MatchOptions& match_options,
                       const PlacesAlongTrajectories& references,
                       const PlacesAlongTrajectories& queries,
                       std::optional<int> min_index_gap,
                       const Executor& executor,
                       const ProgressCallback& on_progress,
                       std::vector<Match>* matches);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOOP_CLOSING_NEIGHBOURS_H_
