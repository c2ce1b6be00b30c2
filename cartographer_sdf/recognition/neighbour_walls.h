// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Compares the walls of neighbouring pairs of submaps. The matches around a
// place that was seen twice look at the same pairs over and over: at a pair's
// own match, its walls are compared once.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOUR_WALLS_H_
#define CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOUR_WALLS_H_

#include <array>
#include <map>
#include <mutex>
#include <optional>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/place/surface_model.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

// The walls of a pair at a pose.
struct ComparedWalls {
  Rigid2 T_reference_query;
  double wall_length = 0.;           // within the other's observed area [m]
  double contradicting_length = 0.;  // part in the other's free space [m]
};

// Thread-safe. No result depends on what was asked before.
class NeighbourWalls {
 public:
  // Compares up to `num_points` wall points of each submap, where the pair has
  // at least `min_overlap_area` [m^2] in common. The places must outlive it.
  NeighbourWalls(const VerificationOptions& verification, int num_points,
                 double min_overlap_area, const TrajectoryPlaces& references,
                 const TrajectoryPlaces& queries);

  // At the pose of a pair's match by itself, of which it has one at most.
  // Nullopt where the overlap is too small.
  [[nodiscard]] std::optional<ComparedWalls> AtMatch(const PairPose& match);

  // At the pose registered from a predicted one. Nullopt where the pair cannot
  // be registered or the overlap is too small then.
  [[nodiscard]] std::optional<ComparedWalls> Registered(
      const PairPose& predicted) const;

 private:
  struct Shard {
    std::mutex mutex;
    std::map<IdPair, std::optional<ComparedWalls>> at_matches;
  };

  [[nodiscard]] std::optional<ComparedWalls> CompareAt(
      const PairPose& pair) const;
  void AddWall(const SurfaceModel& model, const SurfaceModel& points,
               const Rigid2& T_model_points, ComparedWalls* walls) const;
  [[nodiscard]] const SurfaceModel& Reference(const PairPose& pair) const {
    return references_.places->at(pair.reference).surface;
  }
  [[nodiscard]] const SurfaceModel& Query(const PairPose& pair) const {
    return queries_.places->at(pair.query).surface;
  }

  const VerificationOptions verification_;
  AgreementOptions agreement_;
  const double min_overlap_area_;
  const TrajectoryPlaces references_;
  const TrajectoryPlaces queries_;
  // Several, so that threads seldom wait for each other.
  std::array<Shard, 64> shards_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOUR_WALLS_H_
