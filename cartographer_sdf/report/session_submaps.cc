// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/session_submaps.h"

#include <map>

namespace cartographer_sdf {
namespace {

// The session of each trajectory in the picture.
std::map<int, size_t> SessionsOf(const std::vector<MapPart>& parts) {
  std::map<int, size_t> sessions;
  for (size_t k = 0; k < parts.size(); ++k) {
    for (const auto& [trajectory, number] : parts[k].trajectories) {
      sessions[number] = k;
    }
  }
  return sessions;
}

}  // namespace

void AddSubmapsOfParts(const MapState& state, const std::vector<MapPart>& parts,
                       const bool shows_new_ids, Inspection* const inspection) {
  std::map<int, int> numbers_in_file;
  for (const MapPart& part : parts) {
    for (const auto& [trajectory, number] : part.trajectories) {
      numbers_in_file[number] = trajectory;
    }
  }
  const std::map<int, size_t> sessions = SessionsOf(parts);
  for (const auto& [id, submap] : state.submaps) {
    const SubmapId shown =
        shows_new_ids ? id
                      : SubmapId{numbers_in_file.at(id.trajectory), id.index};
    inspection->submaps[id] = {submap.geometry, shown,
                               sessions.at(id.trajectory)};
  }
}

absl::Status ReadPart(const MapPart& part,
                      const std::map<SubmapId, OccupancyGrid>& but,
                      const ProgressCallback& on_progress,
                      const SubmapCallback& on_submap) {
  // What is missing was refused or dropped when the map was read for the work.
  return ReadMap({part.path, MissingRecords::kKeep},
                 {[&](const SubmapId& id, const SubmapSummary& summary,
                      const OccupancyGrid& grid) {
                   if (but.count(id) > 0) return;
                   on_submap(Renumbered(part, id), summary, grid);
                 }},
                 on_progress)
      .status();
}

}  // namespace cartographer_sdf
