// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/evaluation/false_constraints.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DECLARE_uint32(seed);
DEFINE_string(wrong_constraints, "",
              "CSV file to write a list of the added constraints to.");
DEFINE_string(
    kinds, "corridor,door,half_turn,twin,row,random",
    "Kinds of wrong constraints, separated by commas: overlapping submaps, "
    "slid along the walls at random (corridor) or to where they look most "
    "alike (door), or rotated (half_turn); different places that look alike, "
    "alone (twin) or with their neighbours (row); random poses (random).");
DEFINE_int32(pairs, 3, "Number of pairs of submaps (or rows) of each kind.");

namespace cartographer_sdf {
namespace {

absl::StatusOr<std::vector<FalseKind>> KindsOfFlags() {
  std::vector<FalseKind> kinds;
  for (const absl::string_view name :
       absl::StrSplit(FLAGS_kinds, ',', absl::SkipEmpty())) {
    const std::vector<FalseKind> all = AllFalseKinds();
    const auto kind =
        std::find_if(all.begin(), all.end(), [name](const FalseKind candidate) {
          return name == FalseKindName(candidate);
        });
    if (kind == all.end()) {
      return UsageError(absl::StrCat("--kinds: there is no kind ", name));
    }
    kinds.push_back(*kind);
  }
  return kinds;
}

absl::Status WriteLabels(const std::string& path, const FalsifiedMap& map) {
  std::string content = "constraint,kind,pair\n";
  for (const FalseConstraint& label : map.false_constraints) {
    absl::StrAppendFormat(&content, "%d,%s,%d\n", label.constraint,
                          FalseKindName(label.kind), label.pair);
  }
  return WriteWholeFile(path, content);
}

void PrintCounts(const FalsifiedMap& map) {
  std::map<FalseKind, std::pair<std::set<size_t>, int>> counts;
  for (const FalseConstraint& label : map.false_constraints) {
    auto& [pairs, count] = counts[label.kind];
    pairs.insert(label.pair);
    ++count;
  }
  for (const auto& [kind, count] : counts) {
    std::cout << absl::StrFormat("%5d constraints of %d pairs: %s\n",
                                 count.second, count.first.size(),
                                 FalseKindName(kind));
  }
}

absl::Status RunFalsify(RunRecord* const record) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  if (options->loop_closing.recognition.match.method != Method::kSdf) {
    return absl::InvalidArgumentError(
        "falsify needs loop_closing.recognition.match.method = \"sdf\"");
  }
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const absl::StatusOr<std::set<int>> frozen = FrozenTrajectoriesOfFlags();
  if (!frozen.ok()) return frozen.status();
  const absl::StatusOr<std::vector<FalseKind>> kinds = KindsOfFlags();
  if (!kinds.ok()) return kinds.status();
  FalsificationOptions falsification;
  falsification.kinds = *kinds;
  falsification.num_pairs = FLAGS_pairs;
  falsification.seed = FLAGS_seed;
  if (const std::string error = Validate(falsification); !error.empty()) {
    return UsageError(error);
  }
  const absl::StatusOr<FalsifiedMap> map =
      FalsifyMap(options->loop_closing, falsification, FLAGS_input, *frozen,
                 MakeExecutor(*num_threads));
  if (!map.ok()) return map.status();
  absl::Status status = WriteLabels(FLAGS_wrong_constraints, *map);
  if (status.ok()) {
    status = WriteMap(FLAGS_input, FLAGS_output, map->pose_graph);
  }
  if (!status.ok()) return status;
  record->Count("false_constraints", map->false_constraints.size());
  PrintCounts(*map);
  std::cout << FLAGS_output << "\n";
  return absl::OkStatus();
}

}  // namespace

Subcommand FalsifySubcommand() {
  Subcommand subcommand{
      "falsify",
      "add wrong constraints to a map, to test audit",
      "A.pbstream --output B.pbstream --wrong_constraints W.csv "
      "[--kinds K,...] [--pairs N] [--seed N]",
      "Assumes that the map is right, adds wrong inter-submap constraints, and "
      "optimises, so that the map is distorted as Cartographer's would be. "
      "--wrong_constraints lists them: the constraint's index in the file, its "
      "kind, and the number of its pair.",
      {{"input", FileUse::kRead},
       {"output", FileUse::kCopyMap, {}, "Map to write, a .pbstream."},
       {"wrong_constraints", FileUse::kWriteText}},
      {"kinds", "pairs", "seed", "frozen_trajectories",
       "configuration_directory", "configuration_basename", "threads"},
      &RunFalsify};
  subcommand.is_for_developers = true;
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
