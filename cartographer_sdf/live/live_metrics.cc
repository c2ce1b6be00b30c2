// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/live_metrics.h"

#include <initializer_list>
#include <string>

namespace cartographer_sdf {
namespace {

namespace metrics = cartographer::metrics;

// [s]
constexpr double kMinSeconds = 0.001;
constexpr double kMaxSeconds = 10.;

// Adds a counter for each of `keys` to one family, distinguished by a label.
template <typename Key>
void AddCounters(metrics::Family<metrics::Counter>* const family,
                 const std::string& label, const char* (*const name_of)(Key),
                 const std::initializer_list<Key> keys,
                 OutcomeCounters<Key>* const all) {
  for (const Key key : keys) {
    all->counters[key] = family->Add({{label, name_of(key)}});
  }
}

void RegisterOutcomes(metrics::FamilyFactory* const family_factory) {
  AddCounters(family_factory->NewCounterFamily("cartographer_sdf_matches",
                                               "Verified poses, by verdict"),
              "verdict", &VerdictName,
              {Verdict::kAccepted, Verdict::kTooLittleOverlap,
               Verdict::kContradicted, Verdict::kUnlikely, Verdict::kUncertain,
               Verdict::kDegenerate, Verdict::kAmbiguous},
              &TheMetrics().matches);
  AddCounters(family_factory->NewCounterFamily("cartographer_sdf_closures",
                                               "Accepted closures, by status"),
              "status", &ClosureStatusName,
              {ClosureStatus::kUnsupported, ClosureStatus::kInconsistent,
               ClosureStatus::kScansDisagree, ClosureStatus::kReady,
               ClosureStatus::kInGraph, ClosureStatus::kDetectedOnly,
               ClosureStatus::kGone},
              &TheMetrics().closures);
  AddCounters(
      family_factory->NewCounterFamily("cartographer_sdf_localizations",
                                       "Localization queries, by verdict"),
      "verdict", &LocalizationVerdictName,
      {LocalizationVerdict::kLocalized, LocalizationVerdict::kTooLittleSeen,
       LocalizationVerdict::kNothingAlike, LocalizationVerdict::kUncertain,
       LocalizationVerdict::kAmbiguous, LocalizationVerdict::kContradicted,
       LocalizationVerdict::kNoMap, LocalizationVerdict::kFinished},
      &TheMetrics().localizations);
}

}  // namespace

LiveMetrics& TheMetrics() {
  static LiveMetrics* const kInstance = new LiveMetrics;
  return *kInstance;
}

void RegisterMetrics(metrics::FamilyFactory* const family_factory) {
  LiveMetrics& all = TheMetrics();
  all.places = family_factory
                   ->NewGaugeFamily("cartographer_sdf_places",
                                    "Submaps that can be recognised")
                   ->Add({});
  const auto counter = [&](const char* const name, const char* const what) {
    return family_factory->NewCounterFamily(name, what)->Add({});
  };
  all.submaps = counter("cartographer_sdf_submaps", "Described submaps");
  all.queries = counter("cartographer_sdf_queries",
                        "Submaps and growing submaps that were searched for "
                        "among the others");
  all.candidates =
      counter("cartographer_sdf_candidates", "Pairs proposed by queries");
  all.constraints =
      counter("cartographer_sdf_constraints", "Injected constraints");
  all.looks = counter("cartographer_sdf_looks",
                      "Scans that were compared with the whole loaded map");
  all.dropped_scans =
      counter("cartographer_sdf_dropped_scans",
              "Scans that were not, because too many waited for it");
  const auto histogram = [&](const char* const name, const char* const what) {
    return family_factory
        ->NewHistogramFamily(
            name, what,
            metrics::Histogram::ScaledPowersOf(2., kMinSeconds, kMaxSeconds))
        ->Add({});
  };
  all.describe_seconds = histogram("cartographer_sdf_describe_seconds",
                                   "Time to describe a submap");
  all.query_seconds = histogram("cartographer_sdf_query_seconds",
                                "Time of a query, including verification");
  RegisterOutcomes(family_factory);
}

}  // namespace cartographer_sdf
