// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/precision_recall.h"

#include <algorithm>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"
#include "glog/logging.h"

namespace cartographer_sdf {

std::optional<double> PrecisionRecallCurve::RecallAtPrecision1() const {
  if (num_positives == 0) return std::nullopt;
  double recall = 0.;
  for (const PrecisionRecallPoint& point : points) {
    if (point.num_wrong == 0) recall = point.recall;
  }
  return recall;
}

std::optional<double> PrecisionRecallCurve::ThresholdAtPrecision1() const {
  const std::optional<double> recall = RecallAtPrecision1();
  std::optional<double> threshold;
  if (!recall || *recall == 0.) return threshold;
  for (const PrecisionRecallPoint& point : points) {
    if (point.num_wrong == 0) threshold = point.threshold;
  }
  return threshold;
}

std::optional<double> PrecisionRecallCurve::AveragePrecision() const {
  if (num_positives == 0) return std::nullopt;
  double sum = 0.;
  int num_right = 0;
  for (const PrecisionRecallPoint& point : points) {
    sum += (point.num_right - num_right) * point.precision;
    num_right = point.num_right;
  }
  return sum / num_positives;
}

PrecisionRecallCurve MakePrecisionRecallCurve(std::vector<JudgedAnswer> answers,
                                              const int num_positives) {
  CHECK_GE(num_positives, std::count_if(answers.begin(), answers.end(),
                                        [](const JudgedAnswer& answer) {
                                          return answer.is_right;
                                        }));
  std::stable_sort(answers.begin(), answers.end(),
                   [](const JudgedAnswer& a, const JudgedAnswer& b) {
                     return a.score > b.score;
                   });
  PrecisionRecallCurve curve;
  curve.num_positives = num_positives;
  PrecisionRecallPoint point;
  for (size_t k = 0; k < answers.size(); ++k) {
    ++(answers[k].is_right ? point.num_right : point.num_wrong);
    if (k + 1 < answers.size() && answers[k + 1].score == answers[k].score) {
      continue;
    }
    point.threshold = answers[k].score;
    point.precision =
        static_cast<double>(point.num_right) / static_cast<double>(k + 1);
    point.recall = num_positives == 0
                       ? 0.
                       : static_cast<double>(point.num_right) / num_positives;
    curve.points.push_back(point);
  }
  return curve;
}

absl::Status WriteCurves(const std::string& path,
                         const std::vector<NamedCurve>& curves) {
  std::string content = "series,threshold,right,wrong,precision,recall\n";
  for (const NamedCurve& curve : curves) {
    for (const PrecisionRecallPoint& point : curve.curve.points) {
      absl::StrAppendFormat(&content, "%s,%.9g,%d,%d,%.6f,%.6f\n", curve.name,
                            point.threshold, point.num_right, point.num_wrong,
                            point.precision, point.recall);
    }
  }
  return WriteWholeFile(path, content);
}

}  // namespace cartographer_sdf
