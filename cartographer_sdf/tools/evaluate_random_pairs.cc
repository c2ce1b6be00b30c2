// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/evaluate_random_pairs.h"

#include <map>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/evaluation/random_pairs.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/method_options.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_int32(random_pairs, 0,
             "Number of random pairs of submaps to match, each query rotated "
             "by a random angle; fewer if the map has fewer. 0: none.");
DEFINE_string(methods, "paper,shape_context,sdf",
              "Methods for --random_pairs, separated by commas.");
DEFINE_int32(pair_seed, 42,
             "Random seed for the choice of pairs and their rotation.");
DEFINE_string(min_overlaps, "0.5,0.1,0.2,0.3,0.4,0.6,0.7",
              "Fractions, separated by commas: a random pair is a match if the "
              "common area is at least this fraction of the smaller submap's "
              "area. The curves use the first; numbers are given for all, as "
              "the paper does not specify it.");
DEFINE_int32(min_index_gap, 3,
             "Least difference of the indices of a random pair within one "
             "trajectory; below 3, submaps share scans.");
DEFINE_string(max_clearances, "",
              "Distances, separated by commas [m]: method paper is also tested "
              "with only the keypoints within each distance of a wall; in the "
              "paper, 2.0,1.5,1.0,0.5.");

namespace cartographer_sdf {
namespace {

// Parses the numbers of a flag, each in [least, most].
absl::StatusOr<std::vector<double>> ParseNumbers(const std::string& flag,
                                                 const std::string& text,
                                                 const double least,
                                                 const double most) {
  std::vector<double> numbers;
  for (const absl::string_view part :
       absl::StrSplit(text, ',', absl::SkipEmpty())) {
    double number = 0.;
    if (!absl::SimpleAtod(part, &number) ||
        !(number >= least && number <= most)) {
      return UsageError(absl::StrCat("--", flag, " must be numbers from ",
                                     least, " to ", most, ", one is '", part,
                                     "'"));
    }
    numbers.push_back(number);
  }
  return numbers;
}

struct RandomPairFlags {
  std::vector<std::string> methods;
  std::vector<double> min_overlaps;
  std::vector<double> max_clearances;
};

absl::StatusOr<RandomPairFlags> ParseFlags() {
  if (FLAGS_random_pairs < 0 || FLAGS_random_pairs > 10000000) {
    return UsageError("--random_pairs must be from 0 to 10000000");
  }
  if (FLAGS_min_index_gap < 1) {
    return UsageError("--min_index_gap must be positive");
  }
  const absl::StatusOr<std::vector<double>> min_overlaps =
      ParseNumbers("min_overlaps", FLAGS_min_overlaps, 1e-6, 1.);
  if (!min_overlaps.ok()) return min_overlaps.status();
  if (min_overlaps->empty()) {
    return UsageError("--min_overlaps needs a number");
  }
  const std::vector<std::string> methods =
      absl::StrSplit(FLAGS_methods, ',', absl::SkipEmpty());
  if (methods.empty()) return UsageError("--methods needs a method");
  const absl::StatusOr<std::vector<double>> max_clearances =
      ParseNumbers("max_clearances", FLAGS_max_clearances, 0., 1000.);
  if (!max_clearances.ok()) return max_clearances.status();
  return RandomPairFlags{methods, *min_overlaps, *max_clearances};
}

struct RandomPairData {
  MapState state;
  std::map<SubmapId, OccupancyGrid> grids;
  PairTruths truths;
  std::vector<TurnedPair> pairs;
};

absl::StatusOr<RandomPairData> ReadData(const Truth& truth,
                                        const ProgressCallback& on_progress) {
  RandomPairData data;
  std::map<SubmapId, ObservedPoints> observed;
  absl::StatusOr<MapState> state =
      ReadMap(FLAGS_input,
              {[&](const SubmapId& id, const SubmapSummary&,
                   const OccupancyGrid& grid) {
                if (truth.T_world_submap.count(id) == 0) return;
                observed[id] = ThinnedObservedPoints(grid);
                data.grids.emplace(id, grid);
              }},
              on_progress);
  if (!state.ok()) return state.status();
  data.state = *std::move(state);
  data.truths = ComputePairTruths(observed, truth, FLAGS_min_index_gap);
  data.pairs =
      DrawRandomPairs(data.truths, FLAGS_random_pairs, FLAGS_pair_seed);
  if (data.pairs.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(FLAGS_input, " and ", FLAGS_truth,
                     " have no pair of submaps in common"));
  }
  return data;
}

// The answers of one method: with all features, and for each clearance.
absl::StatusOr<std::vector<std::vector<MatchRow>>> Answer(
    const std::string& method, const RandomPairData& data,
    const std::vector<double>& max_clearances, const Executor& executor,
    StageProgress* const progress) {
  const absl::StatusOr<MethodOptions> options = LoadOptionsOfMethod(method);
  if (!options.ok()) return options.status();
  const LoopClosingOptions& stages = options->options.loop_closing;
  std::map<SubmapId, SubmapCloud> clouds;
  if (options->describes_clouds) {
    absl::StatusOr<std::map<SubmapId, SubmapCloud>> read = ReadSubmapClouds(
        options->shape_context.cloud, FLAGS_input, data.state.pose_graph,
        progress->Begin("read point clouds"));
    if (!read.ok()) return read.status();
    clouds = *std::move(read);
  }
  const PlaceMaker make_place =
      options->describes_clouds
          ? MakeCloudPlaces(options->shape_context, clouds)
          : MakeGridPlaces(stages.place, stages.recognition.match, data.grids);
  return MatchTurnedPairs(
      stages.recognition.match, make_place, data.pairs,
      method == "paper" ? max_clearances : std::vector<double>(), executor,
      progress->Begin(absl::StrCat("match by ", method)));
}

// Labelled answers of a method, or of a variant of it with fewer features.
struct Series {
  std::string name;
  bool is_variant;
  std::vector<AnswerLabel> labels;
};

absl::StatusOr<std::vector<Series>> AnswerByMethods(
    const RandomPairFlags& flags, const RandomPairData& data,
    const Executor& executor, StageProgress* const progress) {
  std::vector<Series> series;
  for (const std::string& method : flags.methods) {
    const absl::StatusOr<std::vector<std::vector<MatchRow>>> answers =
        Answer(method, data, flags.max_clearances, executor, progress);
    if (!answers.ok()) return answers.status();
    for (size_t v = 0; v < answers->size(); ++v) {
      series.push_back({v == 0 ? method
                               : absl::StrFormat("%s %g m", method,
                                                 flags.max_clearances[v - 1]),
                        v > 0, LabelAnswers(data.truths, (*answers)[v])});
    }
  }
  return series;
}

Measurement MeasureAnswers(const std::string& series, const double min_overlap,
                           const RandomPairData& data,
                           const std::vector<AnswerLabel>& labels) {
  const PrecisionRecallCurve by_pair = JudgePairs(
      data.truths, data.pairs, labels, min_overlap, AnswerJudgement::kByPair);
  const PrecisionRecallCurve by_pose = JudgePairs(
      data.truths, data.pairs, labels, min_overlap, AnswerJudgement::kByPose);
  return {absl::StrFormat("%s overlap>=%g", series, min_overlap),
          {{"pairs", data.pairs.size()},
           {"positives", by_pair.num_positives},
           {"answers", labels.size()},
           {"recall_p1", by_pair.RecallAtPrecision1()},
           {"threshold", by_pair.ThresholdAtPrecision1()},
           {"ap", by_pair.AveragePrecision()},
           {"recall_p1_pose", by_pose.RecallAtPrecision1()},
           {"threshold_pose", by_pose.ThresholdAtPrecision1()},
           {"ap_pose", by_pose.AveragePrecision()}}};
}

}  // namespace

bool WantsRandomPairs() { return FLAGS_random_pairs != 0; }

absl::Status CheckRandomPairFlags() { return ParseFlags().status(); }

absl::Status MeasureRandomPairs(const Truth& truth,
                                StageProgress* const progress,
                                std::vector<Measurement>* const measurements,
                                std::vector<NamedCurve>* const curves) {
  const absl::StatusOr<RandomPairFlags> flags = ParseFlags();
  if (!flags.ok()) return flags.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const Executor executor = MakeExecutor(*num_threads);
  const absl::StatusOr<RandomPairData> data =
      ReadData(truth, progress->Begin("read"));
  if (!data.ok()) return data.status();
  const absl::StatusOr<std::vector<Series>> series =
      AnswerByMethods(*flags, *data, executor, progress);
  if (!series.ok()) return series.status();
  for (const double min_overlap : flags->min_overlaps) {
    for (const auto& [name, is_variant, labels] : *series) {
      measurements->push_back(MeasureAnswers(name, min_overlap, *data, labels));
    }
  }
  for (const auto& [name, is_variant, labels] : *series) {
    curves->push_back(
        {name,
         JudgePairs(data->truths, data->pairs, labels,
                    flags->min_overlaps.front(), AnswerJudgement::kByPair),
         is_variant});
  }
  return absl::OkStatus();
}

}  // namespace cartographer_sdf
