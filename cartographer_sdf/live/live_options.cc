// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/live_options.h"

#include "cartographer_sdf/config/option_keys.h"

namespace cartographer_sdf {

inline void VisitOptions(OptionVisitor& visit,
                         LiveLocalizationOptions& options) {
  visit("enabled", options.enabled);
  visit("query_interval_meters", options.query_interval_meters);
  visit("window_meters", options.window_meters);
  visit("resolution_meters", options.resolution_meters);
  visit("max_num_candidates", options.max_num_candidates);
  visit("localizer", options.localizer);
  visit("min_num_queries", options.min_num_queries);
  visit("max_translation_difference_meters",
        options.max_translation_difference_meters);
  visit("max_rotation_difference", options.max_rotation_difference);
  visit("compare_scans", options.compare_scans);
  visit("scan_localization", options.scan_localization);
  visit("scan_session", options.scan_session);
}

inline void VisitOptions(OptionVisitor& visit, LiveOptions& options) {
  visit("enabled", options.enabled);
  visit("inject_constraints", options.inject_constraints);
  visit("log_closures", options.log_closures);
  visit("use_place_files", options.use_place_files);
  visit("min_index_gap", options.min_index_gap);
  visit("place", options.place);
  visit("match", options.match);
  visit("retrieval", options.retrieval);
  visit("verify_neighbourhoods", options.verify_neighbourhoods);
  visit("neighbourhood", options.neighbourhood);
  visit("consistency", options.consistency);
  visit("constraints", options.constraints);
  visit("localization", options.localization);
}

namespace {

constexpr char kTableName[] = "SDF_LIVE";

}  // namespace

LocalizationOptions SinglePlaceLocalizationOptions() {
  LocalizationOptions options;
  options.count_likely_matches = true;
  options.placement.further_match_weight = 0.3;
  options.placement.min_score = 7.;
  return options;
}

std::string Validate(const LiveLocalizationOptions& options) {
  if (!(options.query_interval_meters > 0.)) {
    return "query_interval_meters must be positive";
  }
  if (!(options.window_meters > 0.)) return "window_meters must be positive";
  if (!(options.resolution_meters >= 0.01 && options.resolution_meters <= 1.)) {
    return "resolution_meters must lie between 0.01 and 1";
  }
  if (options.max_num_candidates < 1) {
    return "max_num_candidates must be positive";
  }
  if (options.min_num_queries < 1) return "min_num_queries must be positive";
  if (!(options.max_translation_difference_meters > 0. &&
        options.max_rotation_difference > 0.)) {
    return "max_translation_difference_meters and max_rotation_difference must "
           "be positive";
  }
  for (const std::string& error :
       {Validate(options.localizer), Validate(options.scan_localization),
        Validate(options.scan_session)}) {
    if (!error.empty()) return error;
  }
  return "";
}

std::string Validate(const LiveOptions& options) {
  if (options.min_index_gap < 1) return "min_index_gap must be positive";
  if (options.match.method != Method::kSdf) {
    return "match.method must be \"sdf\": the paper's method verifies nothing";
  }
  for (const std::string& error :
       {Validate(options.place), Validate(options.match),
        Validate(options.retrieval), Validate(options.neighbourhood),
        Validate(options.consistency), Validate(options.constraints),
        Validate(options.localization)}) {
    if (!error.empty()) return error;
  }
  return "";
}

absl::StatusOr<LiveOptions> LoadLiveOptions(
    const std::vector<std::string>& directories, const std::string& basename) {
  return LoadTable<LiveOptions>(directories, basename, kTableName);
}

std::string FormatLiveOptions(const LiveOptions& options) {
  return FormatFile(kTableName, options);
}

std::vector<ChangedOption> ChangedLiveOptions(const LiveOptions& options) {
  return ListChangedOptions(options);
}

}  // namespace cartographer_sdf
