// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The submaps of several sessions in one report, numbered as in the joined map.

#ifndef CARTOGRAPHER_SDF_REPORT_SESSION_SUBMAPS_H_
#define CARTOGRAPHER_SDF_REPORT_SESSION_SUBMAPS_H_

#include <map>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/inspection.h"

namespace cartographer_sdf {

// Adds the submaps under the numbers of the parts. `shows_new_ids`: as those of
// the files are, or as the parts have them.
void AddSubmapsOfParts(const MapState& state, const std::vector<MapPart>& parts,
                       bool shows_new_ids, Inspection* inspection);

// Calls back with the submaps of a file, except for some, under their new ids.
[[nodiscard]] absl::Status ReadPart(
    const MapPart& part, const std::map<SubmapId, OccupancyGrid>& but,
    const ProgressCallback& on_progress, const SubmapCallback& on_submap);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SESSION_SUBMAPS_H_
