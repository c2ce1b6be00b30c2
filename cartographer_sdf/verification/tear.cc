// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/tear.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "cartographer_sdf/grid/scan_grid.h"
#include "cartographer_sdf/place/surface_model.h"
#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/registration.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Log-odds of 0.4 and -0.08: those of the host's hits (0.55) and misses (0.49),
// doubled. A part holds a fraction of the scans that make a wall of a submap
// certain.
constexpr double kHitProbability = 0.598688;
constexpr double kMissProbability = 0.480011;

// Registration converges from about half a metre and 6 degrees; guesses lie
// around the given pose, this far off.
constexpr double kGuessTranslation = 0.4;  // [m]
constexpr double kGuessRotation = 0.06;    // [rad]
// A pose farther away than a guess and its convergence reach is chance.
constexpr double kMaxTranslation = 1.5;  // [m]
constexpr double kMaxRotation = 0.2;     // [rad]
// A pose at which the parts hardly overlap cannot contradict.
constexpr double kMinFractionOfPoints = 0.7;

// Wall cells used of each part: nearly all.
constexpr int kMaxRegisteredPoints = 1000;

std::vector<std::optional<SurfaceModel>> DrawParts(
    const TearOptions& options, const std::vector<PlacedScan>& scans) {
  ScanGridOptions grid_options;
  grid_options.resolution = options.resolution_meters;
  grid_options.hit_probability = kHitProbability;
  grid_options.miss_probability = kMissProbability;
  grid_options.max_range = options.max_range_meters;
  std::vector<std::optional<SurfaceModel>> parts;
  const auto size = static_cast<std::ptrdiff_t>(scans.size());
  for (int k = 0; k < options.num_parts; ++k) {
    parts.push_back(MakeSurfaceModel(
        FieldOptions(),
        DrawScans(grid_options,
                  {scans.begin() + size * k / options.num_parts,
                   scans.begin() + size * (k + 1) / options.num_parts})));
  }
  return parts;
}

struct PartAgreement {
  double num_points;
  double value;
};

PartAgreement Compare(const SurfaceModel& first, const SurfaceModel& second,
                      const Rigid2& T_first_second) {
  AgreementOptions options;
  options.max_num_points = std::numeric_limits<int>::max();
  const DirectedAgreement forward =
      MeasureAgreement(options, first, second.walls, T_first_second);
  const DirectedAgreement backward =
      MeasureAgreement(options, second, first.walls, T_first_second.Inverse());
  const double num_points = forward.num_points + backward.num_points;
  const double sum = forward.hits + backward.hits -
                     2. * (forward.contradictions + backward.contradictions);
  return {num_points, num_points > 0. ? sum / num_points : 0.};
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

// Returns whether a registered pose moves a part far enough to be a tear, and
// not so far that it is chance.
bool IsPlausibleMove(const TearOptions& options, const double translation,
                     const double rotation) {
  return translation <= kMaxTranslation && rotation <= kMaxRotation &&
         (translation >= options.min_translation_meters ||
          rotation >= options.min_rotation);
}

bool IsClearlyBetter(const TearOptions& options, const PartAgreement& placed,
                     const PartAgreement& registered) {
  return registered.num_points >= kMinFractionOfPoints * placed.num_points &&
         registered.value >= options.min_agreement &&
         registered.value - placed.value >= options.min_gain;
}

// Returns the clearest tear between two parts, without their numbers.
std::optional<Tear> CompareParts(const TearOptions& options,
                                 const SurfaceModel& first,
                                 const SurfaceModel& second) {
  const PartAgreement placed = Compare(first, second, Rigid2());
  // Agreement is at most 1.
  if (placed.num_points < options.min_num_points ||
      placed.value + options.min_gain > 1.) {
    return std::nullopt;
  }
  const std::optional<Eigen::Vector2d> middle =
      OverlapCentroid(first, second, Rigid2());
  if (!middle) return std::nullopt;
  RegistrationOptions registration_options;
  registration_options.max_num_points = kMaxRegisteredPoints;
  std::optional<Tear> best;
  for (const Rigid2& guess : Guesses(*middle)) {
    const std::optional<Rigid2> T =
        RegisterSubmaps(registration_options, first, second, guess);
    if (!T) continue;
    const double translation = (*T * *middle - *middle).norm();
    if (!IsPlausibleMove(options, translation, std::abs(T->rotation()))) {
      continue;
    }
    const PartAgreement registered = Compare(first, second, *T);
    if (!IsClearlyBetter(options, placed, registered)) continue;
    if (!best || registered.value > best->agreement_as_registered) {
      best = Tear{0,
                  0,
                  *T,
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
                             const std::vector<PlacedScan>& scans) {
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
