// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What works on whole maps, and what is compared with the truth.

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/recognition/recognize.h"
#include "cartographer_sdf/report/match_table.h"
#include "pybind11/stl.h"
#include "python/bindings.h"
#include "python/loaded_map.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

using ClosedMap = WithHostMotion<LoopClosingResult>;

std::shared_ptr<DescribedMap> Describe(const std::string& path,
                                       const Options& options,
                                       const int threads, const bool repair) {
  return std::make_shared<DescribedMap>(ValueOrThrow(DescribeMap(
      options.loop_closing.place, options.loop_closing.recognition.match,
      SourceOf(path, repair), ExecutorOf(threads))));
}

std::vector<Match> Recognize(const DescribedMap& map,
                             const DescribedMap* const query,
                             const Options& options, const int threads) {
  RecognitionOptions recognition = options.loop_closing.recognition;
  // As the subcommand match: all of them.
  recognition.neighbourhood.max_num_matches_per_submap = 0;
  std::vector<std::pair<std::string, double>> seconds;
  StageClock clock({}, &seconds);
  return query == nullptr
             ? RecognizeWithin(recognition, map.trajectory_places(),
                               ExecutorOf(threads), &clock)
             : RecognizeBetween(recognition, map.trajectory_places(),
                                query->trajectory_places(), ExecutorOf(threads),
                                &clock);
}

ClosedMap CloseLoopsOf(const std::string& path,
                       const std::optional<std::string>& output,
                       const Options& options,
                       const std::set<int>& frozen_trajectories,
                       const int threads, const bool repair,
                       const bool drop_odometry) {
  if (options.loop_closing.recognition.match.method != Method::kSdf) {
    throw py::value_error("close_loops needs match.method = \"sdf\"");
  }
  if (output) CheckOutput({path}, *output);
  const MapSource source = SourceOf(path, repair, drop_odometry);
  ClosedMap result{
      ValueOrThrow(CloseLoops(options.loop_closing, source, frozen_trajectories,
                              ExecutorOf(threads))),
      {}};
  if (output)
    ThrowUnlessOk(WriteMap(source, *output, result.closed.pose_graph));
  result.host_motion =
      PredictHostMotion(options.loop_closing.closing.optimization,
                        result.optimization, result.closed.pose_graph);
  return result;
}

std::map<SubmapId, ObservedPoints> ObservedOf(const LoadedMap& map) {
  std::map<SubmapId, ObservedPoints> observed;
  for (const auto& [id, grid] : map.grids) {
    observed[id] = ThinnedObservedPoints(grid);
  }
  return observed;
}

Truth TruthOf(const LoadedMap& map, const std::string& path) {
  Truth truth = ValueOrThrow(ReadTruth(path));
  ThrowUnlessOk(CheckIsTruthOf(map.path, map.state.pose_graph, path, truth));
  return truth;
}

py::dict ScoreDict(const MatchScore& score,
                   const PlaceRecognitionScore& accepted,
                   const double accepted_recall) {
  using namespace pybind11::literals;  // NOLINT: names of arguments
  return py::dict("pairs"_a = score.num_pairs,
                  "positives"_a = score.num_positives,
                  "answers"_a = score.num_answers, "wrong"_a = score.num_wrong,
                  "recall_at_precision_1"_a = score.recall_at_precision_1,
                  "recall_at_precision_99"_a = score.recall_at_precision_99,
                  "average_precision"_a = score.average_precision,
                  "threshold"_a = score.threshold,
                  "median_translation_error"_a = score.median_translation_error,
                  "median_rotation_error"_a = score.median_rotation_error,
                  "accepted_right"_a = accepted.num_right,
                  "accepted_near"_a = accepted.num_near,
                  "accepted_wrong"_a = accepted.num_wrong,
                  "accepted_recall"_a = accepted_recall);
}

struct Scores {
  MatchScore score;
  PlaceRecognitionScore accepted;
  double accepted_recall = 0.;
};

Scores ScoreMatches(const std::vector<Match>& matches, const LoadedMap& map,
                    const std::string& truth_path, const LoadedMap* const query,
                    const std::optional<std::string>& query_truth_path) {
  if ((query == nullptr) != !query_truth_path) {
    throw py::value_error("query and query_truth need each other");
  }
  const Truth truth = TruthOf(map, truth_path);
  const PairTruths pairs =
      query == nullptr
          ? ComputePairTruths(ObservedOf(map), truth)
          : ComputePairTruths(ObservedOf(map), truth, ObservedOf(*query),
                              TruthOf(*query, *query_truth_path));
  std::vector<MatchRow> rows;
  for (const Match& match : matches) {
    rows.push_back(ToRow(match, match.verdict == Verdict::kAccepted,
                         VerdictName(match.verdict)));
  }
  if (query == nullptr) OrderByIds(&rows);
  const std::vector<AnswerLabel> labels = LabelAnswers(pairs, rows);
  Scores scores{ScoreAnswers(pairs, labels),
                ScorePlaceRecognition(pairs, labels, rows), 0.};
  std::set<std::pair<SubmapId, SubmapId>> accepted;
  for (const MatchRow& row : rows) {
    if (row.accepted) accepted.emplace(row.reference, row.query);
  }
  const auto num_right = std::count_if(
      labels.begin(), labels.end(), [&accepted](const AnswerLabel& label) {
        return label.to_positive && label.verdict == AnswerVerdict::kRight &&
               accepted.count({label.reference, label.query}) > 0;
      });
  if (scores.score.num_positives > 0) {
    scores.accepted_recall =
        static_cast<double>(num_right) / scores.score.num_positives;
  }
  return scores;
}

py::dict StatisticsDict(const PoseErrorStatistics& errors) {
  using namespace pybind11::literals;  // NOLINT: names of arguments
  return py::dict("count"_a = errors.translation.count,
                  "mean"_a = errors.translation.mean,
                  "median"_a = errors.translation.median,
                  "percentile_90"_a = errors.translation.percentile_90,
                  "max"_a = errors.translation.max,
                  "mean_rotation"_a = errors.rotation.mean,
                  "median_rotation"_a = errors.rotation.median,
                  "percentile_90_rotation"_a = errors.rotation.percentile_90,
                  "max_rotation"_a = errors.rotation.max);
}

py::dict NodeErrors(const LoadedMap& map, const std::string& truth_path) {
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(map.state.pose_graph, TruthOf(map, truth_path));
  if (!error) throw StatusException("too few nodes in common to be aligned");
  return StatisticsDict(error->errors);
}

void BindClosedMap(py::module_* const module) {
  py::class_<Closure>(*module, "Closure")
      .def_readonly("match", &Closure::match)
      .def_property_readonly("status", [](const Closure& closure) {
        return ClosureStatusName(closure.status);
      });
  py::class_<ClosedMap>(*module, "ClosedMap")
      .def_property_readonly(
          "closures",
          [](const ClosedMap& result) { return result.closed.closures; })
      .def_property_readonly("submaps",
                             [](const ClosedMap& result) {
                               return result.closed.pose_graph.submap_poses;
                             })
      .def_readonly("refused", &ClosedMap::refused)
      .def_readonly("host_motion", &ClosedMap::host_motion)
      .def_property_readonly(
          "torn_submaps",
          [](const ClosedMap& result) {
            std::vector<SubmapId> ids;
            for (const auto& [id, tear] : result.closed.torn_submaps) {
              ids.push_back(id);
            }
            return ids;
          })
      .def_property_readonly("slips",
                             [](const ClosedMap& result) {
                               return SlipsByNode(result.closed.slips);
                             })
      .def_readonly("stage_seconds", &ClosedMap::stage_seconds);
  module->def("close_loops", &CloseLoopsOf, py::arg("path"),
              py::arg("output") = py::none(), py::arg("options") = Options(),
              py::arg("frozen_trajectories") = std::set<int>(),
              py::arg("threads") = 0, py::arg("repair") = false,
              py::arg("drop_odometry") = false,
              py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void BindTasks(py::module_* const module) {
  py::class_<DescribedMap, std::shared_ptr<DescribedMap>>(*module,
                                                          "DescribedMap")
      .def_property_readonly("ids",
                             [](const DescribedMap& map) {
                               std::vector<SubmapId> ids;
                               for (const auto& [id, place] : map.places) {
                                 ids.push_back(id);
                               }
                               return ids;
                             })
      .def(
          "place",
          [](const DescribedMap& map, const SubmapId& id) -> const Place& {
            const auto place = map.places.find(id);
            if (place == map.places.end()) {
              throw py::key_error("no place of this id");
            }
            return place->second;
          },
          py::arg("id"), py::return_value_policy::reference_internal)
      .def("__len__",
           [](const DescribedMap& map) { return map.places.size(); });
  module->def("describe_map", &Describe, py::arg("path"),
              py::arg("options") = Options(), py::arg("threads") = 0,
              py::arg("repair") = false,
              py::call_guard<py::gil_scoped_release>());
  module->def("recognize", &Recognize, py::arg("map"),
              py::arg("query") = py::none(), py::arg("options") = Options(),
              py::arg("threads") = 0, py::call_guard<py::gil_scoped_release>());
  BindClosedMap(module);
  module->def(
      "score_matches",
      [](const std::vector<Match>& matches, const LoadedMap& map,
         const std::string& truth, const LoadedMap* const query,
         const std::optional<std::string>& query_truth) {
        const Scores scores =
            ScoreMatches(matches, map, truth, query, query_truth);
        return ScoreDict(scores.score, scores.accepted, scores.accepted_recall);
      },
      py::arg("matches"), py::arg("map"), py::arg("truth"),
      py::arg("query") = py::none(), py::arg("query_truth") = py::none());
  module->def("node_errors", &NodeErrors, py::arg("map"), py::arg("truth"));
}

}  // namespace cartographer_sdf
