// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/live_metrics.h"

#include <map>
#include <string>

#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"

namespace cartographer_sdf {
namespace {

namespace metrics = cartographer::metrics;

// [s]
constexpr double kMinSeconds = 0.001;
constexpr double kMaxSeconds = 10.;

// Set once, before there is any searcher.
struct Metrics {
  metrics::Gauge* places = metrics::Gauge::Null();
  metrics::Counter* submaps = metrics::Counter::Null();
  metrics::Counter* queries = metrics::Counter::Null();
  metrics::Counter* candidates = metrics::Counter::Null();
  metrics::Counter* constraints = metrics::Counter::Null();
  metrics::Histogram* describe_seconds = metrics::Histogram::Null();
  metrics::Histogram* query_seconds = metrics::Histogram::Null();
  std::map<Verdict, metrics::Counter*> matches;
  std::map<ClosureFate, metrics::Counter*> closures;
  std::map<LocalizationReason, metrics::Counter*> localizations;
};

Metrics& TheMetrics() {
  static Metrics* const instance = new Metrics;
  return *instance;
}

template <typename Key>
void Increment(const std::map<Key, metrics::Counter*>& counters,
               const Key key) {
  const auto counter = counters.find(key);
  if (counter != counters.end()) counter->second->Increment();
}

}  // namespace

void SetNumPlaces(const double num_places) {
  TheMetrics().places->Set(num_places);
}

void CountDescribedSubmap(const double seconds) {
  TheMetrics().submaps->Increment();
  TheMetrics().describe_seconds->Observe(seconds);
}

void CountQuery(const double seconds, const double num_candidates) {
  TheMetrics().queries->Increment();
  TheMetrics().candidates->Increment(num_candidates);
  TheMetrics().query_seconds->Observe(seconds);
}

void CountMatch(const Verdict verdict) {
  Increment(TheMetrics().matches, verdict);
}

void CountClosure(const ClosureFate fate) {
  Increment(TheMetrics().closures, fate);
}

void CountConstraints(const double num_constraints) {
  TheMetrics().constraints->Increment(num_constraints);
}

void CountLocalization(const LocalizationReason reason) {
  Increment(TheMetrics().localizations, reason);
}

void RegisterMetrics(metrics::FamilyFactory* const family_factory) {
  Metrics& all = TheMetrics();
  all.places = family_factory
                   ->NewGaugeFamily("cartographer_sdf_places",
                                    "Submaps that can be recognised")
                   ->Add({});
  all.submaps = family_factory
                    ->NewCounterFamily("cartographer_sdf_submaps",
                                       "Submaps that were described")
                    ->Add({});
  all.queries = family_factory
                    ->NewCounterFamily("cartographer_sdf_queries",
                                       "Submaps and growing submaps that were "
                                       "searched for among the others")
                    ->Add({});
  all.candidates = family_factory
                       ->NewCounterFamily("cartographer_sdf_candidates",
                                          "Pairs that queries proposed")
                       ->Add({});
  all.constraints = family_factory
                        ->NewCounterFamily("cartographer_sdf_constraints",
                                           "Constraints that were injected")
                        ->Add({});
  const auto boundaries =
      metrics::Histogram::ScaledPowersOf(2., kMinSeconds, kMaxSeconds);
  all.describe_seconds =
      family_factory
          ->NewHistogramFamily("cartographer_sdf_describe_seconds",
                               "Time to describe a submap", boundaries)
          ->Add({});
  all.query_seconds =
      family_factory
          ->NewHistogramFamily("cartographer_sdf_query_seconds",
                               "Time to search for one and to verify what is "
                               "found",
                               boundaries)
          ->Add({});
  auto* const matches = family_factory->NewCounterFamily(
      "cartographer_sdf_matches", "Poses that were verified, by verdict");
  for (const Verdict verdict :
       {Verdict::kAccepted, Verdict::kTooLittleOverlap, Verdict::kContradicted,
        Verdict::kUnlikely, Verdict::kDegenerate, Verdict::kAmbiguous}) {
    all.matches[verdict] = matches->Add({{"verdict", VerdictName(verdict)}});
  }
  auto* const closures = family_factory->NewCounterFamily(
      "cartographer_sdf_closures", "Accepted closures, by what became of them");
  for (const ClosureFate fate :
       {ClosureFate::kPending, ClosureFate::kContradicted,
        ClosureFate::kScansDisagree, ClosureFate::kReady,
        ClosureFate::kInjected, ClosureFate::kDetectedOnly,
        ClosureFate::kGone}) {
    all.closures[fate] = closures->Add({{"fate", ClosureFateName(fate)}});
  }
  auto* const localizations = family_factory->NewCounterFamily(
      "cartographer_sdf_localizations",
      "Queries for a trajectory in a map, by what they found");
  for (const LocalizationReason reason :
       {LocalizationReason::kLocated, LocalizationReason::kNoMap,
        LocalizationReason::kNotEnoughSeen, LocalizationReason::kNoMatch,
        LocalizationReason::kAmbiguous, LocalizationReason::kUncertain,
        LocalizationReason::kFinished}) {
    all.localizations[reason] =
        localizations->Add({{"reason", LocalizationReasonName(reason)}});
  }
}

}  // namespace cartographer_sdf
