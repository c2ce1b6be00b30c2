// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/injection_gate.h"

#include <algorithm>

#include "glog/logging.h"

namespace cartographer_sdf {

void InjectionGate::Announce() {
  ++num_announced_;
  ++num_unsettled_;
}

int InjectionGate::Settle() {
  CHECK_GT(num_unsettled_, 0);
  --num_unsettled_;
  return ++newest_generation_;
}

bool InjectionGate::EnterRound(const int generation,
                               const int64_t num_nodes_done,
                               const int64_t num_nodes_waiting) {
  newest_entered_ = std::max(newest_entered_, generation);
  const int64_t num_since_last_round = num_nodes_done - num_nodes_done_;
  num_nodes_done_ = std::max(num_nodes_done_, num_nodes_done);
  // The last of these nodes may have started this round; those before it did
  // not. Nothing is known about the time before the first observed round.
  if (has_entered_) {
    num_harmless_nodes_ =
        std::max(num_harmless_nodes_, num_since_last_round - 1);
  }
  has_entered_ = true;
  return generation == newest_generation_ && num_unsettled_ == 0 &&
         num_nodes_waiting <= num_harmless_nodes_;
}

}  // namespace cartographer_sdf
