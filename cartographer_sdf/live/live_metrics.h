// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Metrics reported through the host, summed over all builders of the process.

#ifndef CARTOGRAPHER_SDF_LIVE_LIVE_METRICS_H_
#define CARTOGRAPHER_SDF_LIVE_LIVE_METRICS_H_

#include <map>

#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

// One counter for each outcome.
template <typename Outcome>
struct OutcomeCounters {
  std::map<Outcome, cartographer::metrics::Counter*> counters;

  void Increment(const Outcome outcome) const {
    const auto counter = counters.find(outcome);
    if (counter != counters.end()) counter->second->Increment();
  }
};

// Registered and described in live_metrics.cc.
struct LiveMetrics {
  using Counter = cartographer::metrics::Counter;
  using Histogram = cartographer::metrics::Histogram;

  cartographer::metrics::Gauge* places = cartographer::metrics::Gauge::Null();
  Counter* submaps = Counter::Null();
  Counter* queries = Counter::Null();
  Counter* candidates = Counter::Null();
  Counter* constraints = Counter::Null();
  Counter* looks = Counter::Null();
  Counter* dropped_scans = Counter::Null();
  Histogram* describe_seconds = Histogram::Null();
  Histogram* query_seconds = Histogram::Null();
  OutcomeCounters<Verdict> matches;
  OutcomeCounters<ClosureStatus> closures;
  OutcomeCounters<LocalizationVerdict> localizations;
};

// Returns the metrics of the process, which count nothing before
// RegisterMetrics().
[[nodiscard]] LiveMetrics& TheMetrics();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_LIVE_METRICS_H_
