// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/keypoint_repeatability.h"

#include <cmath>

#include "cartographer_sdf/feature/descriptor.h"

namespace cartographer_sdf {
namespace {

constexpr double kRadius = 0.2;                              // [m]
constexpr double kMaxViewRotation = 20. * M_PI / 180.;       // [rad]
const Eigen::Vector2d kElsewhere = Eigen::Vector2d(1., 0.);  // [m]

bool IsObserved(const SurfaceModel& surface, const Eigen::Vector2d& p_submap) {
  const Eigen::Array2i cell = surface.geometry.CellAt(p_submap);
  return surface.geometry.Contains(cell) &&
         surface.cells(cell.x(), cell.y()).observed;
}

struct Found {
  bool near = false;
  bool oriented = false;
};

Found Find(const FeatureSet& features, const KeypointKind kind,
           const Eigen::Vector2d& position, const double orientation) {
  Found found;
  for (const Feature& feature : features.features) {
    if (feature.keypoint.kind != kind) continue;
    if ((feature.keypoint.position - position).norm() > kRadius) continue;
    found.near = true;
    found.oriented |= std::abs(std::remainder(feature.orientation - orientation,
                                              2. * M_PI)) < kMaxViewRotation;
  }
  return found;
}

void AddOneWay(const Place& seen_in, const Place& looked_for,
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

}  // namespace

KeypointRepeatability::OfKind KeypointRepeatability::Total() const {
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

void AddKeypointRepeatability(const Place& reference, const Place& query,
                              const Rigid2& T_reference_query,
                              KeypointRepeatability* const repeatability) {
  AddOneWay(reference, query, T_reference_query, repeatability);
  AddOneWay(query, reference, T_reference_query.Inverse(), repeatability);
}

}  // namespace cartographer_sdf
