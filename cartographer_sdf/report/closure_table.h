// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The numbers of a match beside their bounds, and what became of it in words:
// what tables of the inspector show of matches and closures.

#ifndef CARTOGRAPHER_SDF_REPORT_CLOSURE_TABLE_H_
#define CARTOGRAPHER_SDF_REPORT_CLOSURE_TABLE_H_

#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/closing/closure.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/recognize.h"
#include "cartographer_sdf/report/inspection.h"
#include "cartographer_sdf/verification/judgement.h"

namespace cartographer_sdf {

// More rows make a page slow, and nobody reads them.
constexpr size_t kMaxTableRows = 2000;

// Where the options are in the table of the configuration files.
constexpr char kRecognitionPath[] = "loop_closing.recognition";
constexpr char kJudgementPath[] =
    "loop_closing.recognition.match.verification.judgement";
constexpr char kCrossingPath[] =
    "loop_closing.recognition.match.verification.crossing";
constexpr char kClosingPath[] = "loop_closing.closing";

// The least score of a match, and the option that holds it.
struct LeastScore {
  double score;
  std::string option;
};
// Of a match that others support, if support counts.
[[nodiscard]] LeastScore LeastScoreOf(const RecognitionOptions& options);

// `path` is that of the options of judgement.
[[nodiscard]] std::vector<Measure> MatchMeasures(
    const JudgementOptions& judgement, const std::string& path,
    const LeastScore& least_score);
[[nodiscard]] std::vector<std::optional<double>> MatchValues(
    const Match& match);

// The statuses of matches that verification refused, by the names of their
// verdicts, and of closures, by theirs. `path` is that of the options of
// recognition, or of closing.
[[nodiscard]] std::vector<RowStatus> RefusalStatuses(const std::string& path);
[[nodiscard]] std::vector<RowStatus> ClosureStatuses(const std::string& path);

// Closures first that deserve a look, then the matches that verification
// refused, the most likely first.
[[nodiscard]] InspectedTable MakeClosureTable(
    const LoopClosingOptions& options, const std::vector<Closure>& closures,
    const std::vector<Match>& refused);

// Sorts rows by the tone of their status, the bad ones first, then caution,
// good and neutral ones, and leaves out those beyond kMaxTableRows.
void FinishTable(InspectedTable* table);

[[nodiscard]] int NumWithStatus(const std::vector<Closure>& closures,
                                ClosureStatus status);

// Root mean square distance of the walls of the closures in the graph [m]; none
// without any.
[[nodiscard]] std::optional<double> WallDistanceInGraph(
    const std::vector<Closure>& closures);

// The row of a match, with the values of MatchMeasures.
[[nodiscard]] InspectedRow MatchRowOf(const Match& match,
                                      const std::string& status,
                                      const std::string& remark);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_CLOSURE_TABLE_H_
