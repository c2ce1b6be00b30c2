// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/recording.h"

#include <algorithm>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr double kMaxSecondsBetweenSamples = 0.05;
constexpr int kMinSamples = 4;
constexpr int kMaxSamples = 1200;
// Absorbs binary rounding, so that 0.2 s gives four samples and not five.
constexpr double kRounding = 1e-6;

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

}  // namespace cartographer_sdf
