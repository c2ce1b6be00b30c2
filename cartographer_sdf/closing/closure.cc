// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/closure.h"

#include <cstddef>
#include <iterator>
#include <utility>

namespace cartographer_sdf {

const char* ClosureStatusName(const ClosureStatus status) {
  // In the order of the enumerators.
  constexpr const char* kNames[] = {"selected",
                                    "in_graph",
                                    "inconsistent",
                                    "unsupported",
                                    "scans_disagree",
                                    "outlier",
                                    "already_in_graph",
                                    "redundant",
                                    "ready",
                                    "detected_only",
                                    "gone"};
  static_assert(std::size(kNames) ==
                static_cast<size_t>(ClosureStatus::kGone) + 1);
  return kNames[static_cast<size_t>(status)];
}

std::vector<Closure> MakeClosures(std::vector<Match> matches) {
  std::vector<Closure> closures;
  for (Match& match : matches) {
    if (!IsLikely(match.verdict)) continue;
    closures.emplace_back().match = std::move(match);
  }
  return closures;
}

}  // namespace cartographer_sdf
