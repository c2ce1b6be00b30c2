// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbour_walls.h"

#include <algorithm>
#include <cstddef>

#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/registration.h"

namespace cartographer_sdf {

NeighbourWalls::NeighbourWalls(const VerificationOptions& verification,
                               const int num_points,
                               const double min_overlap_area,
                               const TrajectoryPlaces& references,
                               const TrajectoryPlaces& queries)
    : verification_(verification),
      agreement_(verification.agreement),
      min_overlap_area_(min_overlap_area),
      references_(references),
      queries_(queries) {
  agreement_.max_num_points = num_points;
}

std::optional<ComparedWalls> NeighbourWalls::AtMatch(const PairPose& match) {
  const IdPair ids(match.reference, match.query);
  Shard& shard = shards_[(31 * static_cast<size_t>(match.reference.index) +
                          static_cast<size_t>(match.query.index)) %
                         shards_.size()];
  {
    const std::lock_guard<std::mutex> lock(shard.mutex);
    const auto found = shard.at_matches.find(ids);
    if (found != shard.at_matches.end()) return found->second;
  }
  // Two threads may compare the same at a time, with the same result.
  const std::optional<ComparedWalls> walls = CompareAt(match);
  const std::lock_guard<std::mutex> lock(shard.mutex);
  return shard.at_matches.emplace(ids, walls).first->second;
}

std::optional<ComparedWalls> NeighbourWalls::Registered(
    const PairPose& predicted) const {
  const std::optional<Rigid2> registered =
      RegisterSubmaps(verification_.registration, Reference(predicted),
                      Query(predicted), predicted.T_reference_query);
  if (!registered) return std::nullopt;
  return CompareAt({predicted.reference, predicted.query, *registered});
}

std::optional<ComparedWalls> NeighbourWalls::CompareAt(
    const PairPose& pair) const {
  const SurfaceModel& reference = Reference(pair);
  const SurfaceModel& query = Query(pair);
  const Rigid2& T_reference_query = pair.T_reference_query;
  if (!OverlapsBy(min_overlap_area_, reference, query, T_reference_query)) {
    return std::nullopt;
  }
  ComparedWalls walls{T_reference_query};
  AddWall(reference, query, T_reference_query, &walls);
  AddWall(query, reference, T_reference_query.Inverse(), &walls);
  return walls;
}

// Adds the wall of `points` in metres: each sampled point also stands for those
// not sampled.
void NeighbourWalls::AddWall(const SurfaceModel& model,
                             const SurfaceModel& points,
                             const Rigid2& T_model_points,
                             ComparedWalls* const walls) const {
  const DirectedAgreement agreement =
      MeasureAgreement(agreement_, model, points.walls, T_model_points);
  const double num_sampled = static_cast<double>(std::min(
      points.walls.size(), static_cast<size_t>(agreement_.max_num_points)));
  const double stands_for = static_cast<double>(points.walls.size()) /
                            num_sampled * points.geometry.resolution;
  walls->wall_length += stands_for * agreement.num_points;
  walls->contradicting_length += stands_for * agreement.contradictions;
}

}  // namespace cartographer_sdf
