// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/closure.h"

#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {

const char* ClosureStatusName(const ClosureStatus status) {
  switch (status) {
    case ClosureStatus::kSelected:
      return "selected";
    case ClosureStatus::kInGraph:
      return "in_graph";
    case ClosureStatus::kInconsistent:
      return "inconsistent";
    case ClosureStatus::kUnsupported:
      return "unsupported";
    case ClosureStatus::kScansDisagree:
      return "scans_disagree";
    case ClosureStatus::kOutlier:
      return "outlier";
    case ClosureStatus::kReady:
      return "ready";
    case ClosureStatus::kDetectedOnly:
      return "detected_only";
    case ClosureStatus::kGone:
      return "gone";
  }
  LOG(FATAL) << "not a status: " << static_cast<int>(status);
}

std::vector<Closure> MakeClosures(std::vector<Match> matches) {
  std::vector<Closure> closures;
  for (Match& match : matches) {
    if (match.verdict != Verdict::kAccepted) continue;
    closures.emplace_back().match = std::move(match);
  }
  return closures;
}

}  // namespace cartographer_sdf
