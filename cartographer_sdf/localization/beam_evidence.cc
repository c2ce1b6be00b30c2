// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/beam_evidence.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cartographer_sdf {
namespace {

// An echo this near to a wall is at it [m].
constexpr double kWallTolerance = 0.25;
// A beam that goes on this far behind a wall crosses it [m].
constexpr double kCrossingTolerance = 0.3;

// Standard deviation of the distance of an echo from its wall [m]: noise of the
// lidar, and cells of the map.
constexpr double kEchoSigma = 0.07;

enum class BeamFate { kAtWall, kThroughWall, kInFreeSpace, kInUnknown };

struct JudgedBeam {
  BeamFate fate;
  double wall_distance = 0.;  // [m]
};

// Whether the map knows the cell of a point.
bool IsObserved(const RayMap& map, const Eigen::Vector2d& p_grid) {
  const Eigen::Array2i cell =
      (p_grid.array() / map.geometry().resolution).floor().cast<int>();
  return map.geometry().Contains(cell) &&
         map.field.observed(cell.x(), cell.y());
}

JudgedBeam JudgeBeam(const RayMap& map, const Eigen::Vector2d& origin_grid,
                     const Eigen::Vector2d& end_grid) {
  const double resolution = map.geometry().resolution;
  const Eigen::Vector2d offset = end_grid - origin_grid;
  const double range = offset.norm();
  const Ray ray = CastRay(map, origin_grid / resolution, offset / range,
                          std::max(0., range - kCrossingTolerance) / resolution,
                          /*stops_at_grazed=*/false);
  if (ray.end == RayEnd::kWall) return {BeamFate::kThroughWall};
  const std::optional<FieldSample> sample = SampleField(map.field, end_grid);
  const double distance = sample ? std::abs(sample->distance) : 1e3;
  if (distance < kWallTolerance) return {BeamFate::kAtWall, distance};
  if (ray.end == RayEnd::kUnknown || !IsObserved(map, end_grid)) {
    return {BeamFate::kInUnknown};
  }
  return {BeamFate::kInFreeSpace};
}

}  // namespace

BeamEvidence MeasureBeams(const RayMap& map, const Sweep& sweep,
                          const Rigid2& T_grid_robot) {
  BeamEvidence evidence;
  double sum_of_squares = 0.;
  for (const RobotBeam& beam : sweep.beams) {
    // It may have met glass or a dark wall.
    if (!beam.has_echo) continue;
    const JudgedBeam judged =
        JudgeBeam(map, T_grid_robot * beam.origin, T_grid_robot * beam.end);
    ++evidence.num_beams;
    evidence.at_wall += judged.fate == BeamFate::kAtWall;
    evidence.through_wall += judged.fate == BeamFate::kThroughWall;
    evidence.in_free_space += judged.fate == BeamFate::kInFreeSpace;
    evidence.in_unknown += judged.fate == BeamFate::kInUnknown;
    if (judged.fate == BeamFate::kAtWall) {
      const double ratio = judged.wall_distance / kEchoSigma;
      evidence.fit += std::exp(-0.5 * ratio * ratio);
    }
    sum_of_squares += judged.wall_distance * judged.wall_distance;
  }
  if (evidence.num_beams == 0) return evidence;
  evidence.wall_distance =
      std::sqrt(sum_of_squares / std::max(1., evidence.at_wall));
  const double count = evidence.num_beams;
  evidence.fit /= count;
  evidence.at_wall /= count;
  evidence.through_wall /= count;
  evidence.in_free_space /= count;
  evidence.in_unknown /= count;
  return evidence;
}

}  // namespace cartographer_sdf
