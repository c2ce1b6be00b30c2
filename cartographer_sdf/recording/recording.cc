// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/recording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr double kMaxSecondsBetweenSamples = 0.05;
constexpr int kMinSamples = 4;
constexpr int kMaxSamples = 1200;
// Absorbs binary rounding, so that 0.2 s gives four samples and not five.
constexpr double kRounding = 1e-6;

// Ranges this near to the greatest are the same [m].
constexpr double kSameSilentRange = 0.01;
constexpr size_t kBeamsPerSilentBeam = 1000;

// From this range on, beams met nothing; infinite if no beam says so. And the
// greatest range below.
struct SilentRange {
  double least = std::numeric_limits<double>::infinity();
  double greatest_echo = 0.;
};

SilentRange FindSilentRange(const Recording& recording) {
  double greatest = 0.;
  for (const LaserScan& scan : recording.scans) {
    for (const double range : scan.ranges) greatest = std::max(greatest, range);
  }
  SilentRange silent;
  size_t num_beams = 0, num_greatest = 0;
  for (const LaserScan& scan : recording.scans) {
    num_beams += scan.ranges.size();
    for (const double range : scan.ranges) {
      if (range >= greatest - kSameSilentRange) {
        ++num_greatest;
      } else {
        silent.greatest_echo = std::max(silent.greatest_echo, range);
      }
    }
  }
  if (num_greatest > 1 && num_greatest * kBeamsPerSilentBeam >= num_beams) {
    silent.least = greatest - kSameSilentRange;
  }
  return silent;
}

}  // namespace

Recording Cut(const Recording& recording, const double start,
              const double duration) {
  Recording cut = recording;
  cut.scans.clear();
  if (recording.scans.empty()) return cut;
  const double begin = recording.scans.front().time + start;
  for (const LaserScan& scan : recording.scans) {
    if (scan.time >= begin && scan.time - begin <= duration) {
      cut.scans.push_back(scan);
    }
  }
  return cut;
}

std::vector<MotionSample> MotionBetween(const LaserScan& first,
                                        const LaserScan& second) {
  const double seconds = second.time - first.time;
  CHECK_GT(seconds, 0.);
  const int count = static_cast<int>(
      std::clamp(std::ceil(seconds / kMaxSecondsBetweenSamples - kRounding),
                 double{kMinSamples}, double{kMaxSamples}));
  const Eigen::Vector2d translation = second.T_odometry_robot.translation() -
                                      first.T_odometry_robot.translation();
  const double turn = NormalizeAngle(second.T_odometry_robot.rotation() -
                                     first.T_odometry_robot.rotation());
  std::vector<MotionSample> samples;
  for (int k = 1; k <= count; ++k) {
    const double fraction = static_cast<double>(k) / count;
    samples.push_back(MotionSample{
        first.time + fraction * seconds,
        Rigid2(first.T_odometry_robot.translation() + fraction * translation,
               first.T_odometry_robot.rotation() + fraction * turn),
        turn / seconds});
  }
  return samples;
}

std::vector<double> MetersDriven(const Recording& recording) {
  std::vector<double> distances;
  double sum = 0.;
  for (size_t i = 0; i < recording.scans.size(); ++i) {
    if (i > 0) {
      sum += (recording.scans[i].T_odometry_robot.translation() -
              recording.scans[i - 1].T_odometry_robot.translation())
                 .norm();
    }
    distances.push_back(sum);
  }
  return distances;
}

std::vector<OdometryScan> OdometryScansOf(const Recording& recording) {
  const SilentRange silent = FindSilentRange(recording);
  std::vector<OdometryScan> scans;
  for (const LaserScan& laser_scan : recording.scans) {
    RobotScan scan;
    for (size_t i = 0; i < laser_scan.ranges.size(); ++i) {
      const double range = laser_scan.ranges[i];
      const double angle = recording.first_angle +
                           static_cast<double>(i) * recording.angle_increment;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      if (range >= silent.least) {
        scan.scan.misses.push_back(
            (silent.greatest_echo * direction).cast<float>());
      } else {
        scan.scan.returns.push_back((range * direction).cast<float>());
      }
    }
    scans.push_back(
        {laser_scan.time, laser_scan.T_odometry_robot, {std::move(scan)}});
  }
  return scans;
}

}  // namespace cartographer_sdf
