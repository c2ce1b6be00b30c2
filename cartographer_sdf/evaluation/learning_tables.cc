// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/learning_tables.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"

namespace cartographer_sdf {
namespace {

constexpr char kIdColumns[] =
    "reference_trajectory,reference_index,query_trajectory,query_index";

std::string Ids(const SubmapId& reference, const SubmapId& query) {
  return absl::StrCat(reference.trajectory, ",", reference.index, ",",
                      query.trajectory, ",", query.index);
}

}  // namespace

absl::Status WriteScoreTerms(const std::string& path,
                             const std::vector<Match>& matches) {
  std::string content = absl::StrCat(kIdColumns, ",score");
  for (const char* const name : ScoreTermNames()) {
    absl::StrAppend(&content, ",", name);
  }
  content += "\n";
  for (const Match& match : matches) {
    if (!match.verification) continue;
    const Verification& verification = *match.verification;
    absl::StrAppendFormat(&content, "%s,%.9g",
                          Ids(match.closure.reference, match.closure.query),
                          verification.score);
    for (const double term :
         ScoreTerms(verification.agreement, verification.margin)) {
      absl::StrAppendFormat(&content, ",%.9g", term);
    }
    content += "\n";
  }
  return WriteWholeFile(path, content);
}

absl::Status WriteAnswerLabels(const std::string& path,
                               const std::vector<AnswerLabel>& labels) {
  std::string content =
      absl::StrCat(kIdColumns,
                   ",overlap,positive,verdict,translation_error,"
                   "rotation_error\n");
  for (const AnswerLabel& label : labels) {
    absl::StrAppendFormat(&content, "%s,%.6f,%d,%s,%.6f,%.6f\n",
                          Ids(label.reference, label.query), label.overlap,
                          label.to_positive ? 1 : 0,
                          AnswerVerdictName(label.verdict),
                          label.translation_error, label.rotation_error);
  }
  return WriteWholeFile(path, content);
}

}  // namespace cartographer_sdf
