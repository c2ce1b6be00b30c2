// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/learning_tables.h"

#include <array>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/file/whole_file.h"

namespace cartographer_sdf {
namespace {

constexpr char kIdColumns[] =
    "reference_trajectory,reference_index,query_trajectory,query_index";

std::string Ids(const SubmapId& reference, const SubmapId& query) {
  return absl::StrCat(reference.trajectory, ",", reference.index, ",",
                      query.trajectory, ",", query.index);
}

template <size_t kSize>
std::string Header(const std::array<const char*, kSize>& term_names) {
  return absl::StrCat(kIdColumns, ",score,", absl::StrJoin(term_names, ","),
                      "\n");
}

template <size_t kSize>
void AppendRow(const PairPose& pair, const double score,
               const std::array<double, kSize>& terms,
               std::string* const content) {
  absl::StrAppendFormat(content, "%s,%.9g", Ids(pair.reference, pair.query),
                        score);
  for (const double term : terms) absl::StrAppendFormat(content, ",%.9g", term);
  *content += "\n";
}

}  // namespace

absl::Status WriteScoreTerms(const std::string& path,
                             const std::vector<Match>& matches) {
  std::string content = Header(ScoreTermNames());
  for (const Match& match : matches) {
    AppendRow(match.pair, match.pair_score,
              ScoreTerms(match.evidence, match.margin), &content);
  }
  return WriteWholeFile(path, content);
}

absl::Status WriteNeighbourhoodTerms(const std::string& path,
                                     const NeighbourhoodOptions& options,
                                     const std::vector<Match>& matches) {
  std::string content = Header(NeighbourhoodTermNames());
  for (const Match& match : matches) {
    if (!match.neighbourhood || match.pair_score < options.min_pair_score) {
      continue;
    }
    AppendRow(
        match.pair, match.pair.score,
        NeighbourhoodTerms(options, match.pair_score, *match.neighbourhood),
        &content);
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
