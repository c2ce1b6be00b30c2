// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// `export`: a map in the formats of other programs, without ROS.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/geojson.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/report/ros_map.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/map_picture.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DECLARE_int32(picture_pixels);

DEFINE_string(pgm, "",
              "PGM file to write the map to, as ROS's map_server loads it.");
DEFINE_string(yaml, "",
              "YAML file that describes the PGM file. If empty, the name of "
              "the PGM file with .yaml.");
DEFINE_string(map_filestem, "",
              "As in cartographer_ros: STEM.pgm and STEM.yaml are written. "
              "Instead of --pgm.");
DEFINE_double(
    resolution, 0.,
    "Size of a pixel of the PGM file [m]; 0: that of the map's finest "
    "cell, below which it must not be.");
DEFINE_string(png, "", "PNG file to draw the map with the driven paths to.");
DEFINE_string(geojson, "",
              "GeoJSON file to write the paths of the trajectories and the "
              "inter-submap constraints to, as lines.");
DEFINE_string(geojson_origin, "0,0",
              "Where on earth the origin of the map lies, for --geojson: "
              "latitude,longitude or latitude,longitude,bearing [degrees]; the "
              "bearing is that of the map's x axis, counterclockwise from "
              "east.");

namespace cartographer_sdf {
namespace {

absl::StatusOr<GeoOrigin> GeoOriginOfFlags() {
  std::vector<double> numbers;
  for (const absl::string_view text :
       absl::StrSplit(FLAGS_geojson_origin, ',')) {
    double number = 0.;
    if (!absl::SimpleAtod(text, &number) || !std::isfinite(number)) {
      numbers.clear();
      break;
    }
    numbers.push_back(number);
  }
  if (numbers.size() < 2 || numbers.size() > 3 || std::abs(numbers[0]) > 89. ||
      std::abs(numbers[1]) > 180.) {
    return UsageError(
        absl::StrCat("--geojson_origin must be latitude,longitude[,bearing] in "
                     "degrees, it is ",
                     FLAGS_geojson_origin));
  }
  return GeoOrigin{numbers[0], numbers[1],
                   numbers.size() > 2 ? numbers[2] : 0.};
}

absl::Status CheckFlagsOfExport() {
  if (!FLAGS_map_filestem.empty()) {
    if (!FLAGS_pgm.empty()) {
      return UsageError("--pgm and --map_filestem exclude each other");
    }
    FLAGS_pgm = absl::StrCat(FLAGS_map_filestem, ".pgm");
  }
  if (FLAGS_pgm.empty() && FLAGS_png.empty() && FLAGS_geojson.empty()) {
    return UsageError("export needs --pgm, --png or --geojson");
  }
  if (FLAGS_pgm == kStandardOutput || FLAGS_png == kStandardOutput) {
    return UsageError("only --geojson can be written to the standard output");
  }
  if (FLAGS_pgm.empty() && !FLAGS_yaml.empty()) {
    return UsageError("--yaml needs --pgm");
  }
  if (!FLAGS_pgm.empty() && FLAGS_yaml.empty()) {
    FLAGS_yaml =
        std::filesystem::path(FLAGS_pgm).replace_extension(".yaml").string();
  }
  if (!(FLAGS_resolution >= 0. && std::isfinite(FLAGS_resolution))) {
    return UsageError("--resolution must not be negative");
  }
  const absl::Status status = GeoOriginOfFlags().status();
  return status.ok() ? CheckPictureFlags() : status;
}

// An error names the map.
absl::StatusOr<MapPainter> PainterOfRosMap(
    const std::vector<PlacedGrid>& grids) {
  absl::StatusOr<MapPainter> painter =
      MapPainter::WithPixelSize(grids, FLAGS_resolution);
  if (painter.ok()) return painter;
  return absl::Status(painter.status().code(),
                      absl::StrCat(FLAGS_input, " cannot become a PGM file: ",
                                   painter.status().message()));
}

struct Painters {
  std::optional<MapPainter> ros_map;
  std::optional<MapPainter> picture;
};

absl::StatusOr<Painters> PaintersOfFlags(const MapState& state) {
  Painters painters;
  if (!FLAGS_pgm.empty()) {
    absl::StatusOr<MapPainter> painter =
        PainterOfRosMap(PlaceGrids(state, state.pose_graph));
    if (!painter.ok()) return painter.status();
    painters.ros_map = *std::move(painter);
  }
  if (!FLAGS_png.empty()) {
    painters.picture.emplace(PlaceGrids(state, state.pose_graph),
                             FLAGS_picture_pixels);
  }
  return painters;
}

// Reads the grids into the painters.
absl::Status Paint(const MapState& state, const ProgressCallback& on_progress,
                   Painters* const painters) {
  if (!painters->ros_map && !painters->picture) return absl::OkStatus();
  const auto add = [&](const SubmapId& id, const SubmapSummary&,
                       const OccupancyGrid& grid) {
    const auto pose = state.pose_graph.submap_poses.find(id);
    if (pose == state.pose_graph.submap_poses.end()) return;
    if (painters->ros_map) painters->ros_map->AddSubmap(grid, pose->second);
    if (painters->picture) painters->picture->AddSubmap(grid, pose->second);
  };
  return ReadMap(SourceOfFlags(FLAGS_input), {add, {}}, on_progress).status();
}

absl::Status WriteRosMap(const MapPainter& painter, RunRecord* const record) {
  const RosMap map =
      MakeRosMap(painter, std::filesystem::path(FLAGS_pgm).filename().string());
  record->Count("occupied_pixels", static_cast<size_t>(map.num_occupied));
  record->Count("free_pixels", static_cast<size_t>(map.num_free));
  record->Count("unknown_pixels", static_cast<size_t>(map.num_unknown));
  const absl::Status status = WriteWholeFile(FLAGS_pgm, map.pgm);
  return status.ok() ? WriteWholeFile(FLAGS_yaml, map.yaml) : status;
}

absl::Status WriteExports(const MapState& state, const Painters& painters,
                          RunRecord* const record) {
  absl::Status status;
  if (painters.ros_map) status = WriteRosMap(*painters.ros_map, record);
  if (status.ok() && painters.picture) {
    status = WriteWholeFile(
        FLAGS_png,
        PaintWithPaths(*painters.picture, state.pose_graph).EncodePng());
  }
  if (status.ok() && !FLAGS_geojson.empty()) {
    const absl::StatusOr<GeoOrigin> origin = GeoOriginOfFlags();
    if (!origin.ok()) return origin.status();
    status =
        WriteWholeFile(FLAGS_geojson, FormatGeoJson(state.pose_graph, *origin));
  }
  return status;
}

absl::Status RunExport(RunRecord* const record) {
  StageProgress progress(record);
  const absl::StatusOr<MapState> state =
      ReadMap(SourceOfFlags(FLAGS_input), {}, progress.Begin("read"));
  if (!state.ok()) return state.status();
  RecordMap(*state, record);
  absl::StatusOr<Painters> painters = PaintersOfFlags(*state);
  if (!painters.ok()) return painters.status();
  absl::Status status = Paint(*state, progress.Begin("paint"), &*painters);
  if (status.ok()) status = WriteExports(*state, *painters, record);
  if (!status.ok()) return status;
  PrintRepair(*state);
  for (const std::string& path :
       {FLAGS_pgm, FLAGS_yaml, FLAGS_png, FLAGS_geojson}) {
    if (!path.empty()) std::cout << path << "\n";
  }
  return absl::OkStatus();
}

}  // namespace

Subcommand ExportSubcommand() {
  Subcommand subcommand{
      "export",
      "write a map in the formats of other programs",
      "A.pbstream [--pgm M.pgm | --map_filestem M] [--png M.png] "
      "[--geojson M.geojson]",
      "Draws all submaps at their poses into one grid, as "
      "cartographer_pbstream_to_ros_map does, without ROS: a PGM file with "
      "walls 0, free space 254 and unknown 205, and the YAML file that "
      "map_server and Nav2 load it by. Also a PNG for people, and GeoJSON for "
      "viewers of maps.\n\n"
      "Frames: the map frame of the file, x to the right and y up [m].",
      {{"input", FileUse::kRead}},
      {{"pgm", FileUse::kWriteText},
       {"yaml", FileUse::kWriteText},
       "map_filestem",
       "resolution",
       {"png", FileUse::kWriteText},
       {"picture_pixels",
        FileUse::kNone,
        {},
        "Longer side of --png at most [pixels]; no pixel is smaller than a "
        "cell."},
       {"geojson", FileUse::kWriteText},
       "geojson_origin",
       "repair"},
      &RunExport};
  subcommand.check_flags = &CheckFlagsOfExport;
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
