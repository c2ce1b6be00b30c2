// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/recording.h"

namespace cartographer_sdf {

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

}  // namespace cartographer_sdf
