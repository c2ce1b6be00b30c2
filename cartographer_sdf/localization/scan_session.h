// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where in a map is a robot that turns or drives: scans are added with
// odometry, candidates live on, are pruned or confirmed, and the answer comes
// as soon as it is certain. Where scans contradict the answer for long enough,
// the robot is lost, and the search begins anew.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SCAN_SESSION_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SCAN_SESSION_H_

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/sweep.h"

namespace cartographer_sdf {

struct ScanSessionOptions {
  // [m], [rad] How far the robot moves or turns from one scan that is compared
  // with the map, a look, to the next. Smaller: slower; the looks say less new.
  double look_distance_meters = 0.5;
  double look_rotation = 0.5;
  // Latest looks that count. Larger: slower.
  int max_num_looks = 20;
  // While the robot is searched for, the whole map is searched at the first
  // look and after so many, then after twice and four times as many. Smaller:
  // slower, found sooner.
  int num_looks_per_search = 4;
  // [m], [rad] Driving or turning so far shows as much new as another scan:
  // neighbouring looks see for the most part the same. With the mean look, the
  // utility of candidates grows with the square root of the number of such
  // scans.
  double independent_distance_meters = 3.;
  double independent_rotation = 6.;
  // Added to PresenceWeights::bias and ::lead, times the logarithm of that
  // number. Chosen on drives through several buildings, each judged by what
  // suits the others; more makes wrong answers certain.
  double presence_bias_per_log = 0.5;
  double presence_lead_per_log = 5.;
  // A scan contradicts the answer if more of its beams cross walls, or end in
  // free space, there.
  double max_contradicting_fraction = 0.5;
  // The robot is lost if all scans of this duration, and so many, contradict.
  double lost_after_seconds = 2.;
  int lost_after_scans = 5;
};
[[nodiscard]] std::string Validate(const ScanSessionOptions& options);

enum class ScanSearchState {
  kSearching,
  kLocated,
  kLost  // located before, and searched for again
};
// "searching", ...
[[nodiscard]] const char* ScanSearchStateName(ScanSearchState state);

// What became of a scan.
enum class ScanUse {
  kCompared,
  kNotMoved,        // too little since the last that was compared
  kTooFewEchoes,    // the pose follows the odometry
  kTimeNotLater,    // left out
  kBrokenOdometry,  // not finite or absurd; left out
  kOdometryJumped,  // farther than a robot drives; the search begins anew
  kCarriedAway,     // the robot was, without odometry; the search begins anew
};
// "compared", ...
[[nodiscard]] const char* ScanUseName(ScanUse use);

struct SessionAnswer {
  ScanSearchState state = ScanSearchState::kSearching;
  // Of the robot at the latest scan; only while it is located.
  std::optional<Rigid2> T_map_robot;
  // What the latest looks say: all candidates at the latest scan, each with the
  // mean evidence of its looks, and the covariance of the last.
  ScanLocalization localization;
  // Since the search began.
  int num_looks = 0;
  double distance_driven = 0.;  // [m]
  double seconds = 0.;
  // Of the scan that was added last.
  ScanUse use = ScanUse::kNotMoved;
};

// Thread-compatible. Memory and time of a scan are bounded: at most one search
// of the map, and the registration of some dozens of candidates.
class ScanSession {
 public:
  // `map` must outlive the session. Options must be valid.
  ScanSession(const ScanLocalizationOptions& options,
              const ScanSessionOptions& session_options,
              const PanoramaMap& map);

  // Deterministic. Any scan is taken; SessionAnswer::use says what became of
  // it.
  const SessionAnswer& Add(const OdometryScan& scan);
  [[nodiscard]] const SessionAnswer& answer() const { return answer_; }

 private:
  // A scan that is compared with the map.
  struct Look {
    Rigid2 T_odometry_robot;
    std::vector<RobotScan> scans;
    Sweep sweep;
  };
  struct LookFit {
    Rigid2 T_grid_robot;
    Eigen::Matrix3d covariance;
    BeamEvidence evidence;
  };
  // A path of the robot through the map, with a fit for each look.
  struct Hypothesis {
    std::deque<LookFit> fits;
    BeamEvidence mean;
    double utility = 0.;
    bool is_answer = false;
  };

  [[nodiscard]] std::optional<ScanUse> Refuse(const OdometryScan& scan) const;
  // Begins anew where the odometry jumps.
  void FollowOdometry(const OdometryScan& scan);
  void BeginSearch(const OdometryScan& scan);
  void DescribeNothing();
  [[nodiscard]] bool IsCarriedAway(const OdometryScan& scan,
                                   const Sweep& sweep) const;
  // Whether scans have contradicted the answer for long enough.
  bool Contradicts(const OdometryScan& scan, const Sweep& sweep);
  [[nodiscard]] bool HasMoved(const Rigid2& T_odometry_robot) const;
  void AddLook(const OdometryScan& scan, Sweep sweep);
  [[nodiscard]] LookFit FitLook(const Sweep& sweep, const Rigid2& T_last_robot,
                                const Rigid2& T_grid_last) const;
  void SearchMap();
  [[nodiscard]] static BeamEvidence MeanEvidence(const Hypothesis& hypothesis);
  // How many independent scans would say as much as the looks.
  [[nodiscard]] double NumIndependentScans() const;
  void RankHypotheses();
  // Fills in all candidates.
  void Judge();
  // Whether the robot is located, or lost.
  void Decide();
  // Fills in the poses at the latest scan.
  void CarryPoses();

  const ScanLocalizationOptions options_;
  const ScanSessionOptions session_options_;
  const PanoramaMap& map_;
  std::deque<Look> looks_;
  std::vector<Hypothesis> hypotheses_;
  std::optional<OdometryScan> latest_;  // without its scans
  double search_begin_ = 0.;            // time
  int num_looks_until_search_ = 0;
  int search_backoff_ = 1;
  // Since scans contradict the answer.
  std::optional<double> contradicted_since_;
  int num_contradicting_ = 0;
  SessionAnswer answer_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SCAN_SESSION_H_
