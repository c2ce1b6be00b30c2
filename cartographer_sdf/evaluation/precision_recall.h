// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Precision and recall of answers over the threshold on their scores
// ([Millane2019], Sec. V-A: over the number of inliers).

#ifndef CARTOGRAPHER_SDF_EVALUATION_PRECISION_RECALL_H_
#define CARTOGRAPHER_SDF_EVALUATION_PRECISION_RECALL_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace cartographer_sdf {

struct JudgedAnswer {
  double score = 0.;
  // A right answer to a positive; otherwise wrong.
  bool is_right = false;
};

struct PrecisionRecallPoint {
  double threshold = 0.;  // answers with at least this score count
  int num_right = 0;
  int num_wrong = 0;
  double precision = 0.;  // of the answers that count
  double recall = 0.;     // num_right over num_positives
};

struct PrecisionRecallCurve {
  // One point for each distinct score, highest first; answers with equal scores
  // count together, so that their order does not matter. Empty if there are no
  // answers.
  std::vector<PrecisionRecallPoint> points;
  int num_positives = 0;

  // The largest recall without a wrong answer; 0 if an answer with the highest
  // score is wrong, or there are no answers. None if there are no positives.
  [[nodiscard]] std::optional<double> RecallAtPrecision1() const;
  // The least threshold with that recall; none if the recall is 0 or none.
  [[nodiscard]] std::optional<double> ThresholdAtPrecision1() const;
  // The area under the curve, as a sum of steps: each gain in recall times the
  // precision after it. None if there are no positives.
  [[nodiscard]] std::optional<double> AveragePrecision() const;
};

// `num_positives` counts all positives, answered or not; it is at least the
// number of right answers.
[[nodiscard]] PrecisionRecallCurve MakePrecisionRecallCurve(
    std::vector<JudgedAnswer> answers, int num_positives);

struct NamedCurve {
  std::string name;  // without commas
  PrecisionRecallCurve curve;
  // Whether it belongs to a reduced variant of a method.
  bool is_variant = false;
};

// CSV with the columns series, threshold, right, wrong, precision, recall.
[[nodiscard]] absl::Status WriteCurves(const std::string& path,
                                       const std::vector<NamedCurve>& curves);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_PRECISION_RECALL_H_
