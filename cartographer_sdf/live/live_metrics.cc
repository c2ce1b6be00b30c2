// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/live_metrics.h"

#include <initializer_list>
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
  std::map<ClosureStatus, metrics::Counter*> closures;
  std::map<LocalizationVerdict, metrics::Counter*> localizations;
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

metrics::Counter* NewCounter(metrics::FamilyFactory* const family_factory,
                             const std::string& name,
                             const std::string& description) {
  return family_factory->NewCounterFamily(name, description)->Add({});
}

// A counter for each of `keys`, in one family, told apart by a label.
template <typename Key>
std::map<Key, metrics::Counter*> AddCounters(
    metrics::Family<metrics::Counter>* const family, const std::string& label,
    const char* (*const name_of)(Key), const std::initializer_list<Key> keys) {
  std::map<Key, metrics::Counter*> counters;
  for (const Key key : keys) {
    counters[key] = family->Add({{label, name_of(key)}});
  }
  return counters;
}

void RegisterTotals(metrics::FamilyFactory* const family_factory,
                    Metrics* const all) {
  all->places = family_factory
                    ->NewGaugeFamily("cartographer_sdf_places",
                                     "Submaps that can be recognised")
                    ->Add({});
  all->submaps = NewCounter(family_factory, "cartographer_sdf_submaps",
                            "Submaps that were described");
  all->queries = NewCounter(family_factory, "cartographer_sdf_queries",
                            "Submaps and growing submaps that were searched "
                            "for among the others");
  all->candidates = NewCounter(family_factory, "cartographer_sdf_candidates",
                               "Pairs that queries proposed");
  all->constraints = NewCounter(family_factory, "cartographer_sdf_constraints",
                                "Constraints that were injected");
}

void RegisterTimes(metrics::FamilyFactory* const family_factory,
                   Metrics* const all) {
  const auto boundaries =
      metrics::Histogram::ScaledPowersOf(2., kMinSeconds, kMaxSeconds);
  all->describe_seconds =
      family_factory
          ->NewHistogramFamily("cartographer_sdf_describe_seconds",
                               "Time to describe a submap", boundaries)
          ->Add({});
  all->query_seconds =
      family_factory
          ->NewHistogramFamily("cartographer_sdf_query_seconds",
                               "Time to search for one and to verify what is "
                               "found",
                               boundaries)
          ->Add({});
}

void RegisterOutcomes(metrics::FamilyFactory* const family_factory,
                      Metrics* const all) {
  all->matches = AddCounters(
      family_factory->NewCounterFamily("cartographer_sdf_matches",
                                       "Poses that were verified, by verdict"),
      "verdict", &VerdictName,
      {Verdict::kAccepted, Verdict::kTooLittleOverlap, Verdict::kContradicted,
       Verdict::kUnlikely, Verdict::kDegenerate, Verdict::kAmbiguous});
  all->closures =
      AddCounters(family_factory->NewCounterFamily(
                      "cartographer_sdf_closures",
                      "Accepted closures, by what became of them"),
                  "status", &ClosureStatusName,
                  {ClosureStatus::kUnsupported, ClosureStatus::kInconsistent,
                   ClosureStatus::kScansDisagree, ClosureStatus::kReady,
                   ClosureStatus::kInGraph, ClosureStatus::kDetectedOnly,
                   ClosureStatus::kGone});
  all->localizations = AddCounters(
      family_factory->NewCounterFamily(
          "cartographer_sdf_localizations",
          "Queries for a trajectory in a map, by what they found"),
      "verdict", &LocalizationVerdictName,
      {LocalizationVerdict::kLocalized, LocalizationVerdict::kTooLittleSeen,
       LocalizationVerdict::kNothingAlike, LocalizationVerdict::kUncertain,
       LocalizationVerdict::kAmbiguous, LocalizationVerdict::kContradicted,
       LocalizationVerdict::kNoMap, LocalizationVerdict::kFinished});
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

void CountClosure(const ClosureStatus status) {
  Increment(TheMetrics().closures, status);
}

void CountConstraints(const double num_constraints) {
  TheMetrics().constraints->Increment(num_constraints);
}

void CountLocalization(const LocalizationVerdict verdict) {
  Increment(TheMetrics().localizations, verdict);
}

void RegisterMetrics(metrics::FamilyFactory* const family_factory) {
  RegisterTotals(family_factory, &TheMetrics());
  RegisterTimes(family_factory, &TheMetrics());
  RegisterOutcomes(family_factory, &TheMetrics());
}

}  // namespace cartographer_sdf
