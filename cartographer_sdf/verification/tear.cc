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

// Screening draws parts in cells of twice the size from half of the points of
// half of the scans, a fifth of the work, where these leave enough.
constexpr double kMaxScreeningResolution = 0.2;  // [m]
constexpr size_t kMinNumScreeningScans = 8;
// How much better than the least contradiction of a tear the agreement of two
// parts must be on screening, to leave them out. The submaps of the test maps
// that are torn agree below that least value.
constexpr double kScreeningMargin = 0.2;
// Fewer points of two parts on screening than this fraction of the least number
// in the drawn parts are inconclusive there, too: it has a quarter of them.
constexpr double kMinFractionOnScreening = 0.1;

using Scans = std::vector<PlacedScan>;

// Returns the scans of one part, in order.
Scans ScansOfPart(const TearOptions& options, const Scans& scans,
                  const int part) {
  const auto size = static_cast<std::ptrdiff_t>(scans.size());
  return {scans.begin() + size * part / options.num_parts,
          scans.begin() + size * (part + 1) / options.num_parts};
}

std::optional<SurfaceModel> Draw(const TearOptions& options,
                                 const double resolution, const Scans& scans) {
  ScanGridOptions grid_options;
  grid_options.resolution = resolution;
  grid_options.hit_probability = kHitProbability;
  grid_options.miss_probability = kMissProbability;
  grid_options.max_range = options.max_range_meters;
  return MakeSurfaceModel(FieldOptions(), DrawScans(grid_options, scans));
}

// Every second return of every second scan.
Scans Thin(const Scans& scans) {
  Scans thinned;
  for (size_t k = 0; k < scans.size(); k += 2) {
    PlacedScan& scan = thinned.emplace_back();
    scan.T_submap_sensor = scans[k].T_submap_sensor;
    for (size_t point = 0; point < scans[k].scan.returns.size(); point += 2) {
      scan.scan.returns.push_back(scans[k].scan.returns[point]);
    }
  }
  return thinned;
}

// The parts of a submap, drawn when they are first needed.
class Parts {
 public:
  Parts(const TearOptions& options, const Scans& scans)
      : options_(options), scans_(scans), drawn_(options.num_parts) {}

  [[nodiscard]] std::optional<SurfaceModel> Screening(const int part) const {
    const Scans scans = ScansOfPart(options_, scans_, part);
    const double coarse = 2. * options_.resolution_meters;
    return Draw(
        options_,
        coarse <= kMaxScreeningResolution ? coarse : options_.resolution_meters,
        scans.size() < kMinNumScreeningScans ? scans : Thin(scans));
  }
  [[nodiscard]] const std::optional<SurfaceModel>& Get(const int part) {
    std::optional<std::optional<SurfaceModel>>& drawn = drawn_[part];
    if (!drawn) {
      drawn = Draw(options_, options_.resolution_meters,
                   ScansOfPart(options_, scans_, part));
    }
    return *drawn;
  }

 private:
  const TearOptions& options_;
  const Scans& scans_;
  std::vector<std::optional<std::optional<SurfaceModel>>> drawn_;
};

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

// Whether two parts may contradict each other, judged by their screening.
bool MayBeTorn(const TearOptions& options,
               const std::optional<SurfaceModel>& first,
               const std::optional<SurfaceModel>& second) {
  if (!first || !second) return true;
  const PartAgreement agreement = Compare(*first, *second, Rigid2());
  return agreement.num_points >=
             kMinFractionOnScreening * options.min_num_points &&
         agreement.value + options.min_gain <= 1. + kScreeningMargin;
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
  Parts parts(options, scans);
  std::vector<std::optional<SurfaceModel>> screening;
  for (int k = 0; k < options.num_parts; ++k) {
    screening.push_back(parts.Screening(k));
  }
  std::optional<Tear> clearest;
  for (int i = 0; i < options.num_parts; ++i) {
    for (int j = i + 1; j < options.num_parts; ++j) {
      if (!MayBeTorn(options, screening[i], screening[j])) continue;
      if (!parts.Get(i) || !parts.Get(j)) continue;
      std::optional<Tear> tear =
          CompareParts(options, *parts.Get(i), *parts.Get(j));
      if (!tear) continue;
      tear->first_part = i;
      tear->second_part = j;
      if (!clearest || Gain(*tear) > Gain(*clearest)) clearest = tear;
    }
  }
  return clearest;
}

}  // namespace cartographer_sdf
