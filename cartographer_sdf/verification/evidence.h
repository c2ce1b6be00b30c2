// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What two submaps show at one pose: how their walls and free space agree, how
// much both have observed, and how well the walls hold the pose. Measured here
// and nowhere else; judgement.h turns it into a score and a verdict.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_EVIDENCE_H_
#define CARTOGRAPHER_SDF_VERIFICATION_EVIDENCE_H_

#include <Eigen/Core>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"
#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/registration.h"

namespace cartographer_sdf {

struct PairEvidence : PairAgreement {
  double overlap_area = 0.;  // observed by both [m^2]
  double overlap = 0.;       // as a fraction of the smaller observed area
  // Scatter of the normals of the matching walls; see NormalScatter.
  Eigen::Matrix2d normal_scatter = Eigen::Matrix2d::Zero();

  // Of the wall points of either submap within what the other has observed, the
  // fraction on a wall of the other; the worse of both directions.
  [[nodiscard]] double HitRatio() const;
  // ... and the fraction deep in its free space: the worse, and the mean.
  [[nodiscard]] double ContradictionRatio() const;
  [[nodiscard]] double MeanContradictionRatio() const;
  // Root mean square distance of the hits to the other's walls [m]; 0 without
  // hits.
  [[nodiscard]] double WallDistance() const;
  // How much the walls speak for the pose: grows with the number of tiles that
  // agree, and is negative where fewer agree than at the best of wrong poses.
  // Tiles near each other are not independent, so their number counts by its
  // square root.
  [[nodiscard]] double WallEvidence() const;
  // Smaller eigenvalue of the scatter, in [0, 0.5]: 0 in a bare corridor.
  [[nodiscard]] double MinScatterEigenvalue() const;
  // Unit vector in the reference frame along which the pose is held least.
  [[nodiscard]] Eigen::Vector2d LeastConstrainedDirection() const;
};

// Any pose can be measured, however wrong. Some 0.1 ms; less with fewer points
// (AgreementOptions::max_num_points), by which the sample of the overlap
// shrinks too.
[[nodiscard]] PairEvidence MeasurePair(const AgreementOptions& agreement,
                                       const RegistrationOptions& registration,
                                       const SurfaceModel& reference,
                                       const SurfaceModel& query,
                                       const Rigid2& T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_EVIDENCE_H_
