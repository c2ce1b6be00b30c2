// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/self_contradiction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/registration.h"
#include "cartographer_sdf/verification/surface_model.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Log-odds of the host's hits (0.55) and misses (0.49), doubled: a part holds a
// fraction of the scans that make a wall of a submap certain.
constexpr float kHitLogOdds = 0.4f;
constexpr float kMissLogOdds = -0.08f;
// Probabilities of 0.12 and 0.88, about the host's limits.
constexpr float kMaxLogOdds = 2.f;

// A part that is larger than this many cells along a side is no part of a
// submap that anyone drove; it is left out.
constexpr double kMaxCellsPerSide = 4096.;

// Registration converges from about half a metre and 6 degrees; it is started
// from guesses around the given pose, this far off.
constexpr double kGuessTranslation = 0.4;  // [m]
constexpr double kGuessRotation = 0.06;    // [rad]
// Farther than a guess and its convergence reach, a pose is chance.
constexpr double kMaxTranslation = 1.5;  // [m]
constexpr double kMaxRotation = 0.2;     // [rad]
// A pose under which the parts hardly meet can't contradict.
constexpr double kMinFractionOfPoints = 0.7;

// Wall cells used of each part: nearly all that a part has.
constexpr int kMaxRegisteredPoints = 1000;

using Scans = std::vector<InsertedScan>::const_iterator;

// What is within range of where it was seen, in the submap frame.
std::vector<Eigen::Vector2d> PointsInRange(const TearOptions& options,
                                           const InsertedScan& scan) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(scan.points.size());
  const Eigen::Matrix2d R_submap_node = scan.T_submap_node.RotationMatrix();
  for (const Eigen::Vector2f& point : scan.points) {
    const Eigen::Vector2d p_node = point.cast<double>();
    if (!(p_node.norm() <= options.max_range_meters)) continue;
    points.emplace_back(R_submap_node * p_node +
                        scan.T_submap_node.translation());
  }
  return points;
}

// One cell more than needed on each side, for rounding; none where it would
// not be a submap's size.
std::optional<CellGeometry> BoundingGeometry(const TearOptions& options,
                                             const Scans begin,
                                             const Scans end) {
  Eigen::AlignedBox2d box;
  for (Scans scan = begin; scan != end; ++scan) {
    box.extend(scan->T_submap_node.translation());
    for (const Eigen::Vector2d& p : PointsInRange(options, *scan)) {
      box.extend(p);
    }
  }
  const double resolution = options.resolution_meters;
  if (box.isEmpty() ||
      !(box.sizes().maxCoeff() < resolution * kMaxCellsPerSide)) {
    return std::nullopt;
  }
  CellGeometry geometry;
  geometry.resolution = resolution;
  geometry.T_submap_grid =
      Rigid2(box.min() - Eigen::Vector2d::Constant(resolution), 0.);
  geometry.size = (box.sizes().array() / resolution).floor().cast<int>() + 3;
  return geometry;
}

// Hits and misses of the scans' points. Rays are walked in steps of a cell, so
// that they may miss a cell that they cut at a corner.
std::optional<OccupancyGrid> DrawPart(const TearOptions& options,
                                      const Scans begin, const Scans end) {
  const std::optional<CellGeometry> geometry =
      BoundingGeometry(options, begin, end);
  if (!geometry) return std::nullopt;
  OccupancyGrid grid = UnknownGrid(*geometry);
  Eigen::ArrayXXf log_odds =
      Eigen::ArrayXXf::Zero(geometry->size.x(), geometry->size.y());
  const auto update = [&](const Eigen::Array2i& cell, const float change) {
    log_odds(cell.x(), cell.y()) += change;
    grid.known(cell.x(), cell.y()) = true;
  };
  // Continuous cell coordinates in which cell (i, j) is [i, i + 1) x [j, j +
  // 1).
  const Rigid2 T_grid_submap = geometry->T_submap_grid.Inverse();
  const auto to_cells = [&](const Eigen::Vector2d& p_submap) {
    return Eigen::Array2d(
        geometry->GridToCells(T_grid_submap * p_submap).array() + 0.5);
  };
  for (Scans scan = begin; scan != end; ++scan) {
    const Eigen::Array2d from = to_cells(scan->T_submap_node.translation());
    for (const Eigen::Vector2d& p : PointsInRange(options, *scan)) {
      const Eigen::Array2d to = to_cells(p);
      const Eigen::Array2i hit = to.cast<int>();
      const int num_steps =
          static_cast<int>(std::ceil((to - from).matrix().norm()));
      const Eigen::Array2d step = (to - from) / std::max(num_steps, 1);
      for (int k = 0; k < num_steps; ++k) {
        const Eigen::Array2i cell = (from + k * step).cast<int>();
        if ((cell == hit).all()) break;
        update(cell, kMissLogOdds);
      }
      update(hit, kHitLogOdds);
    }
  }
  grid.probability =
      1.f / (1.f + (-log_odds.max(-kMaxLogOdds).min(kMaxLogOdds)).exp());
  return grid;
}

std::vector<std::optional<SurfaceModel>> DrawParts(
    const TearOptions& options, const std::vector<InsertedScan>& scans) {
  std::vector<std::optional<SurfaceModel>> parts;
  const auto size = static_cast<std::ptrdiff_t>(scans.size());
  for (int k = 0; k < options.num_parts; ++k) {
    const std::optional<OccupancyGrid> grid =
        DrawPart(options, scans.begin() + size * k / options.num_parts,
                 scans.begin() + size * (k + 1) / options.num_parts);
    parts.push_back(grid ? MakeSurfaceModel(FieldOptions(), *grid)
                         : std::nullopt);
  }
  return parts;
}

struct PartAgreement {
  double num_points;
  double value;
};

PartAgreement Compare(const SurfaceModel& first, const SurfaceModel& second,
                      const Rigid2& T_first_second) {
  constexpr size_t kAll = std::numeric_limits<size_t>::max();
  const DirectedAgreement forward =
      MeasureAgreement(AgreementOptions(), first, second, T_first_second, kAll);
  const DirectedAgreement backward = MeasureAgreement(
      AgreementOptions(), second, first, T_first_second.Inverse(), kAll);
  const double num_points = forward.num_points + backward.num_points;
  const double sum = forward.hits + backward.hits -
                     2. * (forward.contradictions + backward.contradictions);
  return {num_points, num_points > 0. ? sum / num_points : 0.};
}

// The middle of what both have observed, as placed.
std::optional<Eigen::Vector2d> MiddleOfOverlap(const SurfaceModel& first,
                                               const SurfaceModel& second) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const Eigen::Vector2d& p : second.observed_points) {
    const Eigen::Array2i cell = first.geometry.CellAt(p);
    if (!first.geometry.Contains(cell) ||
        !first.cells(cell.x(), cell.y()).observed) {
      continue;
    }
    sum += p;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::vector<Rigid2> Guesses(const Eigen::Vector2d& middle) {
  constexpr double kStep = kGuessTranslation;
  std::vector<Rigid2> guesses;
  for (const double rotation : {0., -kGuessRotation, kGuessRotation}) {
    for (const Eigen::Vector2d& translation :
         {Eigen::Vector2d(0., 0.), Eigen::Vector2d(kStep, 0.),
          Eigen::Vector2d(-kStep, 0.), Eigen::Vector2d(0., kStep),
          Eigen::Vector2d(0., -kStep)}) {
      guesses.push_back(Rigid2(middle + translation, rotation) *
                        Rigid2(-middle, 0.));
    }
  }
  return guesses;
}

// The clearest tear between two parts, without their numbers.
std::optional<Tear> CompareParts(const TearOptions& options,
                                 const SurfaceModel& first,
                                 const SurfaceModel& second) {
  const PartAgreement placed = Compare(first, second, Rigid2());
  // Agreement is at most 1.
  if (placed.num_points < options.min_num_points ||
      placed.value + options.min_gain > 1.) {
    return std::nullopt;
  }
  const std::optional<Eigen::Vector2d> middle = MiddleOfOverlap(first, second);
  if (!middle) return std::nullopt;
  RegistrationOptions registration_options;
  registration_options.max_num_points = kMaxRegisteredPoints;
  std::optional<Tear> best;
  for (const Rigid2& guess : Guesses(*middle)) {
    const std::optional<Registration> registration =
        RegisterSubmaps(registration_options, first, second, guess);
    if (!registration) continue;
    const Rigid2& T = registration->T_reference_query;
    const double translation = (T * *middle - *middle).norm();
    const double rotation = std::abs(T.rotation());
    if (translation > kMaxTranslation || rotation > kMaxRotation ||
        (translation < options.min_translation_meters &&
         rotation < options.min_rotation)) {
      continue;
    }
    const PartAgreement registered = Compare(first, second, T);
    if (registered.num_points < kMinFractionOfPoints * placed.num_points ||
        registered.value < options.min_agreement ||
        registered.value - placed.value < options.min_gain) {
      continue;
    }
    if (!best || registered.value > best->agreement_as_registered) {
      best = Tear{0,
                  0,
                  T,
                  translation,
                  placed.value,
                  registered.value,
                  placed.num_points};
    }
  }
  return best;
}

double Gain(const Tear& tear) {
  return tear.agreement_as_registered - tear.agreement_as_placed;
}

}  // namespace

std::string Validate(const TearOptions& options) {
  if (options.num_parts < 2 || options.num_parts > 100) {
    return "num_parts must lie between 2 and 100";
  }
  if (!(options.resolution_meters >= 0.01 && options.resolution_meters <= 1.)) {
    return "resolution_meters must lie between 0.01 and 1";
  }
  if (!(options.max_range_meters >= 1. && options.max_range_meters <= 1000.)) {
    return "max_range_meters must lie between 1 and 1000";
  }
  if (options.min_num_points < 1) return "min_num_points must be positive";
  if (!(options.min_gain > 0. && options.min_gain <= 3.)) {
    return "min_gain must be positive and at most 3";
  }
  if (!(options.min_agreement >= -2. && options.min_agreement <= 1.)) {
    return "min_agreement must lie between -2 and 1";
  }
  if (!(options.min_translation_meters > 0. && options.min_rotation > 0.)) {
    return "min_translation_meters and min_rotation must be positive";
  }
  return "";
}

std::optional<Tear> FindTear(const TearOptions& options,
                             const std::vector<InsertedScan>& scans) {
  CHECK_EQ(Validate(options), "");
  const std::vector<std::optional<SurfaceModel>> parts =
      DrawParts(options, scans);
  std::optional<Tear> clearest;
  for (int i = 0; i < options.num_parts; ++i) {
    for (int j = i + 1; j < options.num_parts; ++j) {
      if (!parts[i] || !parts[j]) continue;
      std::optional<Tear> tear = CompareParts(options, *parts[i], *parts[j]);
      if (!tear) continue;
      tear->first_part = i;
      tear->second_part = j;
      if (!clearest || Gain(*tear) > Gain(*clearest)) clearest = tear;
    }
  }
  return clearest;
}

}  // namespace cartographer_sdf
