// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/evidence.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cartographer_sdf {

double PairEvidence::HitRatio() const {
  return std::min(query_in_reference.HitRatio(), reference_in_query.HitRatio());
}

double PairEvidence::ContradictionRatio() const {
  return std::max(query_in_reference.ContradictionRatio(),
                  reference_in_query.ContradictionRatio());
}

double PairEvidence::MeanContradictionRatio() const {
  return 0.5 * (query_in_reference.ContradictionRatio() +
                reference_in_query.ContradictionRatio());
}

double PairEvidence::WallDistance() const {
  const double hits = query_in_reference.hits + reference_in_query.hits;
  if (!(hits > 0.)) return 0.;
  return std::sqrt((query_in_reference.squared_distance +
                    reference_in_query.squared_distance) /
                   hits);
}

double PairEvidence::WallEvidence() const {
  // The best of wrong poses, where rooms are cluttered, agree in some six of
  // ten walls; in bare ones in more, which the other terms have to tell.
  constexpr double kHitRatioByChance = 0.6;
  return std::sqrt(tiles.num_tiles) *
         (tiles.mean_hit_ratio - kHitRatioByChance);
}

double PairEvidence::MinScatterEigenvalue() const {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(normal_scatter,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

Eigen::Vector2d PairEvidence::LeastConstrainedDirection() const {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(normal_scatter)
      .eigenvectors()
      .col(0);
}

PairEvidence MeasurePair(const AgreementOptions& agreement,
                         const RegistrationOptions& registration,
                         const SurfaceModel& reference,
                         const SurfaceModel& query,
                         const Rigid2& T_reference_query) {
  PairEvidence evidence;
  static_cast<PairAgreement&>(evidence) =
      MeasurePairAgreement(agreement, reference, query, T_reference_query);
  evidence.overlap_area =
      OverlapArea(reference, query, T_reference_query,
                  std::min(kMaxNumOverlapPoints, agreement.max_num_points));
  evidence.overlap =
      std::min(1., evidence.overlap_area /
                       std::min(ObservedArea(reference), ObservedArea(query)));
  evidence.normal_scatter =
      NormalScatter(registration, reference, query, T_reference_query);
  return evidence;
}

}  // namespace cartographer_sdf
