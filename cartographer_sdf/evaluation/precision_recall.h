// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Precision and recall of answers over the threshold that their scores must
// reach ([Millane2019], Sec. V-A: over the number of inliers).

#ifndef CARTOGRAPHER_SDF_EVALUATION_PRECISION_RECALL_H_
#define CARTOGRAPHER_SDF_EVALUATION_PRECISION_RECALL_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace cartographer_sdf {

struct JudgedAnswer {
  double score = 0.;
  // Right, of what there was to find; else wrong.
  bool is_right = false;
};

struct PrecisionRecallPoint {
  double threshold = 0.;  // answers with this score or a higher one count
  int num_right = 0;
  int num_wrong = 0;
  double precision = 0.;  // of those that count
  double recall = 0.;     // num_right of all there was to find
};

struct PrecisionRecallCurve {
  // One for each distinct score, highest first: answers of one score come
  // together, so that their order cannot matter. Empty where there are none.
  std::vector<PrecisionRecallPoint> points;
  int num_positives = 0;

  // The largest recall without a wrong answer; 0 where the answers of the
  // highest score hold a wrong one, or there are none. None where there was
  // nothing to find.
  [[nodiscard]] std::optional<double> RecallAtPrecision1() const;
  // The least threshold with that recall; none where that is 0 or none.
  [[nodiscard]] std::optional<double> ThresholdAtPrecision1() const;
  // The area below the curve, as a sum of steps: each gain in recall at the
  // precision after it. None where there was nothing to find.
  [[nodiscard]] std::optional<double> AveragePrecision() const;
};

// `num_positives` is the number of what there was to find, answered or not; at
// least that of the right answers.
[[nodiscard]] PrecisionRecallCurve MakePrecisionRecallCurve(
    std::vector<JudgedAnswer> answers, int num_positives);

struct NamedCurve {
  std::string name;  // without commas
  PrecisionRecallCurve curve;
  // Of a method with a part taken away.
  bool is_variant = false;
};

// CSV with the columns series, threshold, right, wrong, precision, recall.
[[nodiscard]] absl::Status WriteCurves(const std::string& path,
                                       const std::vector<NamedCurve>& curves);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_PRECISION_RECALL_H_
