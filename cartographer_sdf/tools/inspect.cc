// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// `inspect`: the numbers of one submap, or of a pair: what `figures` draws.

#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "cartographer_sdf/tools/submap_flag.h"
#include "gflags/gflags.h"

DEFINE_string(partner, "",
              "Submap to match --submap with, as trajectory,index; of --query, "
              "if that is given.");
DEFINE_string(features, "",
              "CSV file to write the features of --submap to, with their "
              "descriptors.");

namespace cartographer_sdf {
namespace {

struct InspectedSubmap {
  OccupancyGrid grid;
  Rigid2 T_map_submap;
  // None where the grid shows no wall.
  std::optional<Place> place;
};

absl::Status CheckFlagsOfInspect() {
  if (FLAGS_submap.empty()) {
    return UsageError("--submap is missing: trajectory,index");
  }
  const absl::Status status = ParseSubmap("submap", FLAGS_submap).status();
  if (!status.ok()) return status;
  if (FLAGS_partner.empty()) {
    return FLAGS_query.empty() ? absl::OkStatus()
                               : UsageError("--query needs --partner");
  }
  return ParseSubmap("partner", FLAGS_partner).status();
}

// Reads the whole map, and keeps one submap.
absl::StatusOr<InspectedSubmap> Inspect(const LoopClosingOptions& stages,
                                        const std::string& path,
                                        const SubmapId& wanted,
                                        const ProgressCallback& on_progress) {
  std::optional<OccupancyGrid> grid;
  const absl::StatusOr<MapState> state = ReadMap(
      SourceOfFlags(path),
      {[&](const SubmapId& id, const SubmapSummary&, OccupancyGrid found) {
         if (id == wanted) grid = std::move(found);
       },
       {}},
      on_progress);
  if (!state.ok()) return state.status();
  const auto pose = state->pose_graph.submap_poses.find(wanted);
  if (!grid || pose == state->pose_graph.submap_poses.end()) {
    return absl::NotFoundError(absl::StrCat(
        path, " has no submap ", wanted.trajectory, ",", wanted.index));
  }
  InspectedSubmap submap{*std::move(grid), pose->second, std::nullopt};
  submap.place = DescribePlace(stages.place, wanted, submap.grid);
  const MatchOptions& match = stages.recognition.match;
  if (submap.place && match.method == Method::kSdf) {
    FindSelfSimilarities(match, &*submap.place);
  }
  return submap;
}

const char* KindName(const KeypointKind kind) {
  return kind == KeypointKind::kMaximum   ? "maximum"
         : kind == KeypointKind::kMinimum ? "minimum"
                                          : "saddle";
}

Json InspectedJson(const SubmapId& id, const InspectedSubmap& submap) {
  const OccupancyGrid& grid = submap.grid;
  Json json = {
      {"id", ToJson(id)},
      {"T_map_submap", ToJson(submap.T_map_submap)},
      {"T_submap_grid", ToJson(grid.geometry.T_submap_grid)},
      {"cells", {grid.geometry.size.x(), grid.geometry.size.y()}},
      {"resolution", grid.geometry.resolution},
      {"known_cells", grid.known.count()},
      {"occupied_cells", (grid.known && grid.probability > 0.5f).count()}};
  if (!submap.place) {
    json["features"] = nullptr;
    return json;
  }
  std::map<std::string, int> kinds;
  for (const Feature& feature : submap.place->features.features) {
    ++kinds[KindName(feature.keypoint.kind)];
  }
  json["observed_area"] = ObservedArea(submap.place->surface);
  json["features"] = kinds;
  json["self_similar_poses"] = Json::array();
  for (const Rigid2& pose : submap.place->surface.self_similar_poses) {
    json["self_similar_poses"].push_back(ToJson(pose));
  }
  return json;
}

Json PairJson(const Match& match) {
  Json json = {{"T_reference_query", ToJson(match.pair.T_reference_query)},
               {"verdict", VerdictName(match.verdict)},
               {"score", match.pair.score},
               {"margin", match.margin},
               {"overlap_area", match.evidence.overlap_area},
               {"overlap", match.evidence.overlap},
               {"hit_ratio", match.evidence.HitRatio()},
               {"contradiction_ratio", match.evidence.ContradictionRatio()},
               {"wall_distance", match.evidence.WallDistance()},
               {"inliers", match.inliers.size()},
               {"rivals", Json::array()}};
  for (const Rigid2& pose : match.rivals)
    json["rivals"].push_back(ToJson(pose));
  return json;
}

std::string FormatFeatures(const FeatureSet& features) {
  std::string csv = "feature,x,y,clearance,kind,strength,orientation";
  for (Eigen::Index k = 0; k < features.descriptors.rows(); ++k) {
    absl::StrAppend(&csv, ",d", k);
  }
  csv += "\n";
  for (size_t n = 0; n < features.features.size(); ++n) {
    const Feature& feature = features.features[n];
    const Keypoint& keypoint = feature.keypoint;
    absl::StrAppendFormat(&csv, "%d,%.6f,%.6f,%.6f,%s,%.6g,%.6f", n,
                          keypoint.position.x(), keypoint.position.y(),
                          keypoint.clearance, KindName(keypoint.kind),
                          keypoint.strength, feature.orientation);
    for (Eigen::Index k = 0; k < features.descriptors.rows(); ++k) {
      absl::StrAppendFormat(
          &csv, ",%.6g", features.descriptors(k, static_cast<Eigen::Index>(n)));
    }
    csv += "\n";
  }
  return csv;
}

// Adds the partner and the match, if flags ask for them.
absl::Status InspectPair(const LoopClosingOptions& stages,
                         const InspectedSubmap& submap,
                         StageProgress* const progress,
                         RunRecord* const record) {
  if (FLAGS_partner.empty()) return absl::OkStatus();
  const absl::StatusOr<SubmapId> id = ParseSubmap("partner", FLAGS_partner);
  if (!id.ok()) return id.status();
  const absl::StatusOr<InspectedSubmap> partner =
      Inspect(stages, FLAGS_query.empty() ? FLAGS_input : FLAGS_query, *id,
              progress->Begin("read and describe the partner"));
  if (!partner.ok()) return partner.status();
  record->answer["partner"] = InspectedJson(*id, *partner);
  progress->Begin("match")(1.);
  std::optional<Match> match;
  if (submap.place && partner->place) {
    match =
        MatchPlaces(stages.recognition.match, *submap.place, *partner->place);
  }
  record->answer["match"] = match ? PairJson(*match) : Json();
  if (!match) record->End(Outcome::kNothing, "nothing proposes a pose");
  return absl::OkStatus();
}

absl::Status RunInspect(RunRecord* const record) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  const absl::StatusOr<SubmapId> id = ParseSubmap("submap", FLAGS_submap);
  if (!id.ok()) return id.status();
  StageProgress progress(record);
  const absl::StatusOr<InspectedSubmap> submap =
      Inspect(options->loop_closing, FLAGS_input, *id,
              progress.Begin("read and describe"));
  if (!submap.ok()) return submap.status();
  record->answer["submap"] = InspectedJson(*id, *submap);
  absl::Status status =
      InspectPair(options->loop_closing, *submap, &progress, record);
  if (status.ok() && !FLAGS_features.empty()) {
    status = WriteWholeFile(
        FLAGS_features,
        FormatFeatures(submap->place ? submap->place->features : FeatureSet{}));
  }
  if (!status.ok()) return status;
  record->Count("features",
                submap->place ? submap->place->features.features.size() : 0);
  std::cout << FormatJson(record->answer);
  return absl::OkStatus();
}

}  // namespace

Subcommand InspectSubcommand() {
  Subcommand subcommand{
      "inspect",
      "show the numbers of a submap, or of a pair",
      "A.pbstream [B.pbstream] --submap 0,12 [--partner 0,40] "
      "[--features F.csv]",
      "Prints, as JSON, the grid of a submap, its features by kind, and the "
      "poses in which it resembles itself; with --partner, the same of another "
      "submap, and the best pose of the pair by itself, accepted or not, with "
      "its evidence. `figures` draws what this counts.\n\n"
      "--features has the columns feature, x, y (submap frame), clearance [m], "
      "kind, strength, orientation [rad], and d0, d1, ... of the descriptor.",
      {{"input", FileUse::kRead}},
      {{"submap",
        FileUse::kNone,
        {},
        "Submap to inspect, as trajectory,index: the reference of a pair. "
        "Required."},
       "partner",
       {"query", FileUse::kRead, {}, "Map of --partner. If empty, --input."},
       {"features", FileUse::kWriteText},
       "repair",
       "configuration_directory",
       "configuration_basename"},
      &RunInspect};
  subcommand.check_flags = &CheckFlagsOfInspect;
  subcommand.positional_flags = {"input", "query"};
  return subcommand;
}

}  // namespace cartographer_sdf
