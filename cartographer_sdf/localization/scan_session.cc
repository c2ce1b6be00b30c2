// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/scan_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/localization/sweep_registration.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Of the sweep of a look: a beam every two degrees.
constexpr int kNumLookDirections = 180;
constexpr int kNumBeamsPerDirection = 2;  // of one a degree
constexpr double kLookKernelScale = 0.3;  // [m]
// Searches become rarer by this factor, up to the other: what fits was found.
constexpr int kSearchBackoff = 2, kMaxSearchBackoff = 4;
constexpr PoseTolerance kSamePath{0.5, 0.175};
constexpr size_t kMaxNumHypotheses = 40;
// So many are kept, however improbable: the sixth says what fits by chance.
constexpr size_t kMinNumHypotheses = 8;
// Once the robot is located: the answer and rivals.
constexpr size_t kMaxNumIfLocated = 4;
// Less probable ones, by this log-odds, are dropped.
constexpr double kMaxUtilityGap = 9.;
// What odometry may be off between two looks [m], [rad], and per metre and
// radian of motion; a fit that needs more is by chance.
constexpr double kOdometryError = 0.25, kRotationError = 0.15;
constexpr double kRelativeOdometryError = 0.3;
// A rival of the answer that is as probable shows that the answer was wrong.
constexpr double kRivalProbability = 0.9;
// A robot does not move farther from one scan to the next [m].
constexpr double kMaxOdometryStep = 20.;
constexpr double kMaxOdometryCoordinate = 1e7;
// Scans of looks this near to each other are searched for together [m].
constexpr double kSamePlace = 0.3;
// Without odometry, a scan from the same place shows the same in this many of
// the beams, up to this difference [m].
constexpr double kMinSameFraction = 0.4;
constexpr double kSameRange = 0.5;
// So near, two scans are from the same place [m], [rad].
constexpr PoseTolerance kStanding{0.1, 0.1};

bool IsFinitePose(const Rigid2& pose) {
  return pose.translation().allFinite() && std::isfinite(pose.rotation()) &&
         pose.translation().cwiseAbs().maxCoeff() <= kMaxOdometryCoordinate;
}

double ContradictingFraction(const BeamEvidence& evidence) {
  return evidence.through_wall + evidence.in_free_space;
}

// Ranges of a sweep's echoes by direction; negative where there is none.
std::vector<double> EchoRanges(const Sweep& sweep, const double rotation) {
  std::vector<double> ranges(kNumLookDirections, -1.);
  for (const RobotBeam& beam : sweep.beams) {
    if (!beam.has_echo) continue;
    const Eigen::Vector2d offset = beam.end - sweep.centre;
    const double turns =
        (std::atan2(offset.y(), offset.x()) + rotation) / (2. * M_PI);
    const int direction =
        static_cast<int>((turns - std::floor(turns)) * kNumLookDirections);
    ranges[direction % kNumLookDirections] = offset.norm();
  }
  return ranges;
}

// Of the directions in which both sweeps have an echo, the fraction with the
// same range, neighbouring directions counting as well. `rotation`: of the
// second robot's heading against the first.
double SameFraction(const Sweep& first, const Sweep& second,
                    const double rotation) {
  const std::vector<double> a = EchoRanges(first, 0.);
  const std::vector<double> b = EchoRanges(second, rotation);
  int num_both = 0, num_same = 0;
  for (int k = 0; k < kNumLookDirections; ++k) {
    if (a[k] < 0. || b[k] < 0.) continue;
    ++num_both;
    for (const int step : {0, 1, kNumLookDirections - 1}) {
      const double other = a[(k + step) % kNumLookDirections];
      if (other < 0. || std::abs(other - b[k]) > kSameRange) continue;
      ++num_same;
      break;
    }
  }
  return num_both == 0 ? 1. : static_cast<double>(num_same) / num_both;
}

}  // namespace

std::string Validate(const ScanSessionOptions& options) {
  if (!(options.look_distance_meters >= 0.05 &&
        options.look_distance_meters <= 10.)) {
    return "look_distance_meters must lie between 0.05 and 10";
  }
  if (!(options.look_rotation >= 0.05 && options.look_rotation <= M_PI)) {
    return "look_rotation must lie between 0.05 and pi";
  }
  if (options.max_num_looks < 2 || options.max_num_looks > 1000) {
    return "max_num_looks must lie between 2 and 1000";
  }
  if (options.num_looks_per_search < 1 ||
      options.num_looks_per_search > 100000) {
    return "num_looks_per_search must lie between 1 and 100000";
  }
  if (!(options.independent_distance_meters >= 0.05 &&
        options.independent_distance_meters <= 1000.) ||
      !(options.independent_rotation >= 0.05 &&
        options.independent_rotation <= 1000.)) {
    return "independent_distance_meters and independent_rotation must lie "
           "between 0.05 and 1000";
  }
  if (!std::isfinite(options.presence_bias_per_log +
                     options.presence_lead_per_log)) {
    return "presence_bias_per_log and presence_lead_per_log must be finite";
  }
  if (!(options.max_contradicting_fraction > 0. &&
        options.max_contradicting_fraction <= 1.)) {
    return "max_contradicting_fraction must lie between 0 and 1";
  }
  if (!(options.lost_after_seconds >= 0. &&
        std::isfinite(options.lost_after_seconds))) {
    return "lost_after_seconds must not be negative";
  }
  return options.lost_after_scans >= 1 ? ""
                                       : "lost_after_scans must be positive";
}

const char* ScanSearchStateName(const ScanSearchState state) {
  switch (state) {
    case ScanSearchState::kSearching:
      return "searching";
    case ScanSearchState::kLocated:
      return "located";
    case ScanSearchState::kLost:
      return "lost";
  }
  LOG(FATAL) << "no such state";
}

const char* ScanUseName(const ScanUse use) {
  switch (use) {
    case ScanUse::kCompared:
      return "compared";
    case ScanUse::kNotMoved:
      return "not_moved";
    case ScanUse::kTooFewEchoes:
      return "too_few_echoes";
    case ScanUse::kTimeNotLater:
      return "time_not_later";
    case ScanUse::kBrokenOdometry:
      return "broken_odometry";
    case ScanUse::kOdometryJumped:
      return "odometry_jumped";
    case ScanUse::kCarriedAway:
      return "carried_away";
  }
  LOG(FATAL) << "no such use";
}

ScanSession::ScanSession(const ScanLocalizationOptions& options,
                         const ScanSessionOptions& session_options,
                         const PanoramaMap& map)
    : options_(options), session_options_(session_options), map_(map) {
  CHECK_EQ(Validate(options), "");
  CHECK_EQ(Validate(session_options), "");
  DescribeNothing();
}

const SessionAnswer& ScanSession::Add(const OdometryScan& scan) {
  if (const std::optional<ScanUse> refusal = Refuse(scan)) {
    answer_.use = *refusal;
    return answer_;
  }
  answer_.use = ScanUse::kCompared;
  FollowOdometry(scan);
  const Sweep sweep =
      MakeSweep(scan.scans, kNumLookDirections, options_.max_range_meters);
  if (kNumBeamsPerDirection * NumEchoes(sweep) < options_.min_num_beams) {
    answer_.use = ScanUse::kTooFewEchoes;
  } else {
    if (answer_.state == ScanSearchState::kLocated
            ? Contradicts(scan, sweep)
            : IsCarriedAway(scan, sweep)) {
      BeginSearch(scan);
      answer_.use = ScanUse::kCarriedAway;
    }
    if (looks_.empty() || HasMoved(scan.T_odometry_robot)) {
      AddLook(scan, sweep);
    } else {
      answer_.use = ScanUse::kNotMoved;
    }
  }
  CarryPoses();
  return answer_;
}

void ScanSession::FollowOdometry(const OdometryScan& scan) {
  if (!latest_) {
    search_begin_ = scan.time;
  } else {
    const double step =
        (latest_->T_odometry_robot.Inverse() * scan.T_odometry_robot)
            .translation()
            .norm();
    answer_.distance_driven += step;
    if (step > kMaxOdometryStep) {
      BeginSearch(scan);
      answer_.use = ScanUse::kOdometryJumped;
    }
  }
  latest_ = OdometryScan{scan.time, scan.T_odometry_robot, {}};
  answer_.seconds = scan.time - search_begin_;
}

std::optional<ScanUse> ScanSession::Refuse(const OdometryScan& scan) const {
  if (!IsFinitePose(scan.T_odometry_robot)) return ScanUse::kBrokenOdometry;
  if (!std::isfinite(scan.time) || (latest_ && scan.time <= latest_->time)) {
    return ScanUse::kTimeNotLater;
  }
  return std::nullopt;
}

void ScanSession::BeginSearch(const OdometryScan& scan) {
  looks_.clear();
  hypotheses_.clear();
  contradicted_since_.reset();
  num_contradicting_ = 0;
  num_looks_until_search_ = 0;
  search_backoff_ = 1;
  search_begin_ = scan.time;
  const ScanSearchState state = answer_.state == ScanSearchState::kSearching
                                    ? ScanSearchState::kSearching
                                    : ScanSearchState::kLost;
  answer_ = SessionAnswer();
  answer_.state = state;
  DescribeNothing();
}

void ScanSession::DescribeNothing() {
  answer_.localization.verdict = LocalizationVerdict::kTooLittleSeen;
  answer_.localization.reason = "no scan was compared with the map";
}

bool ScanSession::IsCarriedAway(const OdometryScan& scan,
                                const Sweep& sweep) const {
  if (looks_.empty()) return false;
  const Look& look = looks_.back();
  if (!AreNear(look.T_odometry_robot, scan.T_odometry_robot,
               Eigen::Vector2d::Zero(), kStanding)) {
    return false;
  }
  const double rotation = NormalizeAngle(scan.T_odometry_robot.rotation() -
                                         look.T_odometry_robot.rotation());
  return SameFraction(look.sweep, sweep, rotation) < kMinSameFraction;
}

bool ScanSession::Contradicts(const OdometryScan& scan, const Sweep& sweep) {
  const auto answer =
      std::find_if(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& one) { return one.is_answer; });
  CHECK(answer != hypotheses_.end());
  const LookFit fit = FitLook(
      sweep, looks_.back().T_odometry_robot.Inverse() * scan.T_odometry_robot,
      answer->fits.back().T_grid_robot);
  if (ContradictingFraction(fit.evidence) <=
      session_options_.max_contradicting_fraction) {
    contradicted_since_.reset();
    num_contradicting_ = 0;
    return false;
  }
  if (!contradicted_since_) contradicted_since_ = scan.time;
  ++num_contradicting_;
  return num_contradicting_ >= session_options_.lost_after_scans &&
         scan.time - *contradicted_since_ >=
             session_options_.lost_after_seconds;
}

bool ScanSession::HasMoved(const Rigid2& T_odometry_robot) const {
  return !AreNear(
      looks_.back().T_odometry_robot, T_odometry_robot, Eigen::Vector2d::Zero(),
      {session_options_.look_distance_meters, session_options_.look_rotation});
}

ScanSession::LookFit ScanSession::FitLook(const Sweep& sweep,
                                          const Rigid2& T_last_robot,
                                          const Rigid2& T_grid_last) const {
  const Rigid2 predicted_T_grid_robot = T_grid_last * T_last_robot;
  const PoseTolerance tolerance{
      kOdometryError +
          kRelativeOdometryError * T_last_robot.translation().norm(),
      kRotationError +
          kRelativeOdometryError * std::abs(T_last_robot.rotation())};
  const std::optional<RegisteredSweep> registered =
      RegisterSweep(map_.rays.field, sweep, kNoLimit, kLookKernelScale,
                    predicted_T_grid_robot);
  const bool is_near =
      registered && AreNear(registered->T_grid_robot, predicted_T_grid_robot,
                            sweep.centre, tolerance);
  LookFit fit{is_near ? registered->T_grid_robot : predicted_T_grid_robot,
              registered ? registered->covariance
                         : Eigen::Matrix3d(Eigen::Matrix3d::Identity()),
              {}};
  fit.evidence = MeasureBeams(map_.rays, sweep, fit.T_grid_robot);
  return fit;
}

void ScanSession::AddLook(const OdometryScan& scan, Sweep sweep) {
  if (looks_.size() >= static_cast<size_t>(session_options_.max_num_looks)) {
    looks_.pop_front();
    for (Hypothesis& hypothesis : hypotheses_) hypothesis.fits.pop_front();
  }
  if (!looks_.empty()) {
    const Rigid2 T_last_robot =
        looks_.back().T_odometry_robot.Inverse() * scan.T_odometry_robot;
    for (Hypothesis& hypothesis : hypotheses_) {
      hypothesis.fits.push_back(
          FitLook(sweep, T_last_robot, hypothesis.fits.back().T_grid_robot));
    }
  }
  looks_.push_back({scan.T_odometry_robot, scan.scans, std::move(sweep)});
  ++answer_.num_looks;
  bool may_search = answer_.state != ScanSearchState::kLocated;
  if (may_search && --num_looks_until_search_ <= 0) {
    SearchMap();
    may_search = false;
  }
  RankHypotheses();
  Judge();
  if (may_search &&
      answer_.localization.verdict == LocalizationVerdict::kLocalized) {
    // Nothing is certain before what fits the latest look is known, too.
    SearchMap();
    RankHypotheses();
    Judge();
  }
  Decide();
}

void ScanSession::SearchMap() {
  // What is seen from here: a robot that turns sees all round.
  const Look& newest = looks_.back();
  std::vector<RobotScan> scans = newest.scans;
  for (size_t k = looks_.size() - 1; k-- > 0;) {
    const Rigid2 T_newest_look =
        newest.T_odometry_robot.Inverse() * looks_[k].T_odometry_robot;
    if (T_newest_look.translation().norm() > kSamePlace) break;
    for (const RobotScan& scan : looks_[k].scans) {
      scans.push_back({T_newest_look * scan.T_robot_sensor, scan.scan});
    }
  }
  num_looks_until_search_ =
      session_options_.num_looks_per_search * search_backoff_;
  search_backoff_ =
      std::min(kSearchBackoff * search_backoff_, kMaxSearchBackoff);
  answer_.localization.stage_seconds.clear();
  const std::vector<Rigid2> poses = FindLikelyPoses(
      options_, map_, scans, &answer_.localization.stage_seconds);
  for (const Rigid2& T_grid_robot : poses) {
    const bool is_known = std::any_of(
        hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& one) {
          return AreNear(one.fits.back().T_grid_robot, T_grid_robot,
                         newest.sweep.centre, kSamePath);
        });
    if (is_known) continue;
    Hypothesis hypothesis;
    hypothesis.fits.push_front(FitLook(newest.sweep, Rigid2(), T_grid_robot));
    for (size_t k = looks_.size() - 1; k-- > 0;) {
      hypothesis.fits.push_front(FitLook(
          looks_[k].sweep,
          looks_[k + 1].T_odometry_robot.Inverse() * looks_[k].T_odometry_robot,
          hypothesis.fits.front().T_grid_robot));
    }
    hypotheses_.push_back(std::move(hypothesis));
  }
}

void ScanSession::RankHypotheses() {
  const double factor = std::sqrt(NumIndependentScans());
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.mean = MeanEvidence(hypothesis);
    hypothesis.utility =
        factor * CandidateUtility(options_.candidate_weights, hypothesis.mean);
  }
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& a, const Hypothesis& b) {
                     return a.utility > b.utility;
                   });
  const bool is_located = answer_.state == ScanSearchState::kLocated;
  std::vector<Hypothesis> kept;
  for (Hypothesis& one : hypotheses_) {
    const auto same =
        std::find_if(kept.begin(), kept.end(), [&](const Hypothesis& better) {
          return AreNear(one.fits.back().T_grid_robot,
                         better.fits.back().T_grid_robot,
                         looks_.back().sweep.centre, kSamePath);
        });
    if (same != kept.end()) {
      same->is_answer = same->is_answer || one.is_answer;
      continue;
    }
    const bool is_likely =
        kept.empty() || one.utility >= kept.front().utility - kMaxUtilityGap;
    const size_t limit = is_located  ? kMaxNumIfLocated
                         : is_likely ? kMaxNumHypotheses
                                     : kMinNumHypotheses;
    if (kept.size() < limit || one.is_answer) kept.push_back(std::move(one));
  }
  hypotheses_ = std::move(kept);
}

double ScanSession::NumIndependentScans() const {
  double count = 1.;
  for (size_t k = 1; k < looks_.size(); ++k) {
    const Rigid2 motion =
        looks_[k - 1].T_odometry_robot.Inverse() * looks_[k].T_odometry_robot;
    count += std::min(1., motion.translation().norm() /
                                  session_options_.independent_distance_meters +
                              std::abs(NormalizeAngle(motion.rotation())) /
                                  session_options_.independent_rotation);
  }
  return count;
}

BeamEvidence ScanSession::MeanEvidence(const Hypothesis& hypothesis) {
  BeamEvidence mean;
  double num_beams = 0.;
  for (const LookFit& fit : hypothesis.fits) {
    const BeamEvidence& evidence = fit.evidence;
    num_beams += kNumBeamsPerDirection * evidence.num_beams;
    mean.at_wall += evidence.at_wall;
    mean.through_wall += evidence.through_wall;
    mean.in_free_space += evidence.in_free_space;
    mean.in_unknown += evidence.in_unknown;
    mean.fit += evidence.fit;
    mean.wall_distance += evidence.wall_distance;
  }
  const double count = static_cast<double>(hypothesis.fits.size());
  mean.num_beams = static_cast<int>(std::lround(num_beams / count));
  for (double* const value :
       {&mean.at_wall, &mean.through_wall, &mean.in_free_space,
        &mean.in_unknown, &mean.fit, &mean.wall_distance}) {
    *value /= count;
  }
  return mean;
}

void ScanSession::Judge() {
  ScanLocalization& result = answer_.localization;
  result.candidates.clear();
  if (hypotheses_.empty()) {
    result.verdict = LocalizationVerdict::kNothingAlike;
    result.elsewhere_probability = 1.;
    result.reason = "no pose of the map has its echoes near walls";
    return;
  }
  const Eigen::Matrix3d R_map_grid = [this] {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    rotation.topLeftCorner<2, 2>() =
        map_.rays.geometry().T_submap_grid.RotationMatrix();
    return rotation;
  }();
  for (const Hypothesis& one : hypotheses_) {
    ScanCandidate candidate;
    candidate.covariance =
        R_map_grid * one.fits.back().covariance * R_map_grid.transpose();
    candidate.evidence = one.mean;
    result.candidates.push_back(candidate);
  }
  CarryPoses();
  const double count = NumIndependentScans();
  PresenceWeights presence = options_.presence_weights;
  presence.bias += session_options_.presence_bias_per_log * std::log(count);
  presence.lead += session_options_.presence_lead_per_log * std::log(count);
  AssignProbabilities(options_.candidate_weights, std::sqrt(count), presence,
                      &result);
  JudgeCandidates(options_.min_probability, looks_.back().sweep.widest_gap,
                  &result);
}

void ScanSession::Decide() {
  if (hypotheses_.empty()) return;
  ScanLocalization& result = answer_.localization;
  Hypothesis& best = hypotheses_.front();
  if (answer_.state == ScanSearchState::kLocated) {
    if (best.is_answer ||
        result.candidates.front().probability < kRivalProbability) {
      if (result.verdict != LocalizationVerdict::kLocalized) {
        result.reason = absl::StrCat(
            "located before, and not contradicted since; by the latest scans "
            "alone: ",
            result.reason);
      }
      return;
    }
    answer_.state = ScanSearchState::kLost;
    for (Hypothesis& one : hypotheses_) one.is_answer = false;
  }
  if (result.verdict == LocalizationVerdict::kLocalized) {
    answer_.state = ScanSearchState::kLocated;
    best.is_answer = true;
  }
}

void ScanSession::CarryPoses() {
  answer_.T_map_robot.reset();
  if (looks_.empty()) return;
  const Rigid2 T_look_robot =
      looks_.back().T_odometry_robot.Inverse() * latest_->T_odometry_robot;
  const Rigid2& T_map_grid = map_.rays.geometry().T_submap_grid;
  for (size_t k = 0; k < answer_.localization.candidates.size(); ++k) {
    const Rigid2 T_map_robot =
        T_map_grid * hypotheses_[k].fits.back().T_grid_robot * T_look_robot;
    answer_.localization.candidates[k].T_map_robot = T_map_robot;
    if (hypotheses_[k].is_answer) answer_.T_map_robot = T_map_robot;
  }
}

}  // namespace cartographer_sdf
