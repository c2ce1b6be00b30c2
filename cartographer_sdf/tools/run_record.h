// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a run of a subcommand says to other programs: its outcome, counts,
// warnings and durations, for the file of --result and the exit code.

#ifndef CARTOGRAPHER_SDF_TOOLS_RUN_RECORD_H_
#define CARTOGRAPHER_SDF_TOOLS_RUN_RECORD_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/run_description.h"

namespace cartographer_sdf {

// Of the program; docs/command_line.md.
enum class ExitCode {
  kDone = 0,
  kWorldAtFault = 1,
  kWrongUsage = 2,
  kAskedToFail = 3,
};

enum class Outcome {
  kDone,
  kNothing,  // there was nothing to find, or nothing was found
  kRefused,  // an answer would not have been certain
};

// "done", ...
[[nodiscard]] const char* OutcomeName(Outcome outcome);

// What deserves a look, although the run succeeded.
enum class RunWarning {
  kRepaired,             // records without data were left out
  kIncomplete,           // records without data are in the map
  kTornSubmaps,          // local SLAM slipped inside of submaps
  kSlips,                // odometry contradicts steps of local SLAM
  kNotConverged,         // the optimisation ran out of iterations
  kOdometryBends,        // Cartographer will bend the map, loaded unfrozen
  kDoubtful,             // audit found doubtful constraints
  kOdometryLeftOut,      // audit: odometry contradicts right constraints
  kContradictions,       // pairs of submaps of the merged map contradict
  kSessionsLeftOut,      // merge left some maps out
  kWindowsNotLocalized,  // of relocalize --num_starts, some of them
  kPlacesNotUsed,        // the file of --places did not fit
  kMapsFailed,           // batch: of the maps, some of them
};
// "torn_submaps", ...
[[nodiscard]] const char* RunWarningCode(RunWarning warning);

struct RunRecord {
  RunDescription run;  // set before the run
  Outcome outcome = Outcome::kDone;
  // One sentence, unless kDone.
  std::string reason;
  std::vector<std::pair<std::string, int64_t>> counts;
  // Each with a sentence.
  std::vector<std::pair<RunWarning, std::string>> warnings;
  // In the order in which they began.
  std::vector<std::pair<std::string, double>> stage_seconds;
  // Members that only this subcommand has.
  Json answer = Json::object();

  void Count(const std::string& name, size_t number) {
    counts.emplace_back(name, static_cast<int64_t>(number));
  }
  void Warn(const RunWarning warning, std::string sentence) {
    warnings.emplace_back(warning, std::move(sentence));
  }
  void End(const Outcome how, std::string why) {
    outcome = how;
    reason = std::move(why);
  }
};

// Adds what a map contains, and a warning where records were left out.
void RecordMap(const MapState& map, RunRecord* record);
// Adds a warning if the last optimisation did not converge.
void RecordConvergence(const std::vector<OptimizationSummary>& summaries,
                       RunRecord* record);

// An error if --fail_on names something that cannot happen.
[[nodiscard]] absl::Status CheckFailOn();
// Which of the conditions of --fail_on is met: its name; empty if none is.
[[nodiscard]] std::string ConditionToFailOn(const RunRecord& record);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_RUN_RECORD_H_
