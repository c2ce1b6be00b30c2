// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/reports.h"

#include <cmath>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/map_summary.h"

namespace cartographer_sdf {

std::string FileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string FormatPose(const Rigid2& pose) {
  return absl::StrFormat("x %.3f m, y %.3f m, yaw %.2f deg",
                         pose.translation().x(), pose.translation().y(),
                         pose.rotation() * 180. / M_PI);
}

std::string Counted(const size_t count, const std::string& noun) {
  return absl::StrCat(count, " ", noun, count == 1 ? "" : "s");
}

void AddSubmaps(const MapState& state, Inspection* const inspection) {
  for (const auto& [id, submap] : state.submaps) {
    inspection->submaps[id] = {submap.geometry, id};
  }
}

void AddDisplacement(Inspection* const inspection) {
  const std::optional<Displacement> moved = DisplacementOf(inspection->states);
  if (!moved) return;
  inspection->numbers.emplace_back(
      "Nodes moved by",
      absl::StrFormat("%.2f m on average, %.2f m at most, seen from the first "
                      "submap",
                      moved->mean, moved->largest));
}

void AddOptimization(const OptimizationOptions& options,
                     const std::vector<OptimizationSummary>& summaries,
                     Inspection* const inspection) {
  inspection->numbers.emplace_back(
      "Odometry weights", absl::StrFormat("%.3g (translation), %.3g (rotation)",
                                          options.odometry_translation_weight,
                                          options.odometry_rotation_weight));
  if (summaries.empty()) return;
  const OptimizationSummary& last = summaries.back();
  inspection->numbers.emplace_back(
      "Optimisation",
      absl::StrFormat("cost %.4g to %.4g in %d iterations, %d rounds",
                      last.initial_cost, last.final_cost, last.num_iterations,
                      summaries.size()));
  if (!last.converged) {
    inspection->remarks.push_back("The optimisation did not converge: " +
                                  last.message);
  }
}

void AddTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps,
                    Inspection* const inspection) {
  for (const auto& [id, tear] : torn_submaps) {
    const std::string description = DescribeTear(id, tear);
    inspection->remarks.push_back(
        "A submap is torn inside; its closures have zero weight. " +
        description);
    const auto submap = inspection->submaps.find(id);
    if (submap != inspection->submaps.end()) {
      submap->second.flaw = "torn inside: " + description;
    }
  }
}

void AddSlips(const Slips& slips, const PoseGraph& pose_graph,
              Inspection* const inspection) {
  if (slips.empty()) return;
  inspection->remarks.push_back(
      DescribeSlips(slips, pose_graph) +
      ". Where closures ask for it, the map gives way.");
  for (const SubmapId& id : SubmapsWithSlips(slips, pose_graph)) {
    const auto submap = inspection->submaps.find(id);
    if (submap == inspection->submaps.end() || !submap->second.flaw.empty()) {
      continue;
    }
    submap->second.flaw = "local SLAM slipped in it: odometry turned otherwise";
  }
}

}  // namespace cartographer_sdf
