// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Whether keypoints of a submap are found again in another one that saw the
// same place: what matching can hope for at most.

#ifndef TEST_TESTING_KEYPOINT_REPEATABILITY_H_
#define TEST_TESTING_KEYPOINT_REPEATABILITY_H_

#include <array>
#include <cmath>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/place.h"

namespace cartographer_sdf::testing {

struct KeypointRepeatability {
  struct OfKind {
    // Features whose keypoint lies where the other submap has observed.
    int num_judged = 0;
    // Those with a feature of their kind within 0.2 m there; and, to tell skill
    // from density, within 0.2 m of a place 1 m away, if observed.
    int num_found = 0;
    int num_judged_by_chance = 0;
    int num_found_by_chance = 0;
    // Those of num_found whose orientation, too, is right within 20 degrees.
    int num_oriented = 0;
  };
  // By KeypointKind.
  std::array<OfKind, kNumKeypointKinds> kinds;

  [[nodiscard]] OfKind Total() const {
    OfKind total;
    for (const OfKind& kind : kinds) {
      total.num_judged += kind.num_judged;
      total.num_found += kind.num_found;
      total.num_judged_by_chance += kind.num_judged_by_chance;
      total.num_found_by_chance += kind.num_found_by_chance;
      total.num_oriented += kind.num_oriented;
    }
    return total;
  }
};

namespace internal {

constexpr double kKeypointRadius = 0.2;                             // [m]
constexpr double kMaxViewRotation = 20. * M_PI / 180.;              // [rad]
inline const Eigen::Vector2d kElsewhere = Eigen::Vector2d(1., 0.);  // [m]

inline bool IsObserved(const SurfaceModel& surface,
                       const Eigen::Vector2d& p_submap) {
  const Eigen::Array2i cell = surface.geometry.CellAt(p_submap);
  return surface.geometry.Contains(cell) &&
         (*surface.cells.Pin())(cell.x(), cell.y()).observed;
}

struct Found {
  bool near = false;
  bool oriented = false;
};

inline Found Find(const FeatureSet& features, const KeypointKind kind,
                  const Eigen::Vector2d& position, const double orientation) {
  Found found;
  for (const Feature& feature : features.features) {
    if (feature.keypoint.kind != kind) continue;
    if ((feature.keypoint.position - position).norm() > kKeypointRadius)
      continue;
    found.near = true;
    found.oriented |= std::abs(std::remainder(feature.orientation - orientation,
                                              2. * M_PI)) < kMaxViewRotation;
  }
  return found;
}

inline void AddOneWay(const Place& seen_in, const Place& looked_for,
                      const Rigid2& T_seen_in_looked_for,
                      KeypointRepeatability* const repeatability) {
  for (const Feature& feature : looked_for.features.features) {
    const KeypointKind kind = feature.keypoint.kind;
    KeypointRepeatability::OfKind& count =
        repeatability->kinds[static_cast<int>(kind)];
    const Eigen::Vector2d position =
        T_seen_in_looked_for * feature.keypoint.position;
    const double orientation =
        feature.orientation + T_seen_in_looked_for.rotation();
    if (IsObserved(seen_in.surface, position)) {
      const Found found = Find(seen_in.features, kind, position, orientation);
      ++count.num_judged;
      count.num_found += found.near;
      count.num_oriented += found.oriented;
    }
    if (IsObserved(seen_in.surface, position + kElsewhere)) {
      ++count.num_judged_by_chance;
      count.num_found_by_chance +=
          Find(seen_in.features, kind, position + kElsewhere, orientation).near;
    }
  }
}

}  // namespace internal

// Counts the features of both places, each looked for in the other.
inline void AddKeypointRepeatability(
    const Place& reference, const Place& query, const Rigid2& T_reference_query,
    KeypointRepeatability* const repeatability) {
  internal::AddOneWay(reference, query, T_reference_query, repeatability);
  internal::AddOneWay(query, reference, T_reference_query.Inverse(),
                      repeatability);
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_KEYPOINT_REPEATABILITY_H_
