// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the inspector shows of a run: one page for every subcommand that makes a
// report. Metres, radians and seconds, unless a measure names its unit.

#ifndef CARTOGRAPHER_SDF_REPORT_INSPECTION_H_
#define CARTOGRAPHER_SDF_REPORT_INSPECTION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/submap_raster.h"
#include "cartographer_sdf/report/svg_plot.h"

namespace cartographer_sdf {

// How good the news is.
enum class Tone { kGood, kNeutral, kCaution, kBad };
[[nodiscard]] const char* ToneName(Tone tone);

// A number of each row of a table, and the bound by which it is judged.
struct Measure {
  enum class Bound { kNone, kAtLeast, kAtMost };

  std::string name;  // as in tables and JSON
  std::string label;
  std::string unit;  // "%", "m"; empty if it has none
  int num_decimals = 0;
  std::string meaning;  // a sentence
  // Whether it is a column of the table; otherwise only the evidence of a row
  // shows it.
  bool is_column = false;
  Bound bound = Bound::kNone;
  double threshold = 0.;
  std::string option = {};  // that holds the threshold
};

// What became of a row.
struct RowStatus {
  std::string name;   // as in tables and JSON
  std::string label;  // in words
  Tone tone = Tone::kNeutral;
  std::string meaning;      // why, in a sentence
  std::string option = {};  // that decides; empty if none does
};

struct InspectedRow {
  std::string status;  // the name of one of the table's
  // What the status does not say of this row.
  std::string remark = {};
  // A pair of submaps, or ...
  std::optional<PairPose> pair = {};
  // ... where the robot may be, in the map frame.
  std::optional<Rigid2> T_map_robot = {};
  // Of the table's measures, in their order; none where it has no value.
  std::vector<std::optional<double>> values = {};
  // Indices in PoseGraph::constraints of what was judged together.
  std::vector<size_t> constraints = {};
  // Where the walls of the pair overlap, in the reference frame; set by
  // DrawInspection().
  std::optional<Eigen::Vector2d> p_reference_overlap = {};
};

// Of its pair; zero if it has none.
[[nodiscard]] inline double ScoreOf(const InspectedRow& row) {
  return row.pair ? row.pair->score : 0.;
}

struct InspectedTable {
  std::string name;
  std::string heading;
  std::string note = {};
  std::vector<Measure> measures;
  std::vector<RowStatus> statuses;
  std::vector<InspectedRow> rows = {};
  // Rows that are left out to keep the page small.
  size_t num_unlisted = 0;
};

// One of the maps that are shown together.
struct InspectedSession {
  std::string name;
  std::string outcome = {};
  Tone tone = Tone::kNeutral;
};

// The map at one time, "before" or "after". The pose graph must outlive it.
struct InspectedState {
  std::string name;
  std::string label;
  std::string caption;
  const PoseGraph* pose_graph = nullptr;
};

struct InspectedSubmap {
  CellGeometry geometry;
  SubmapId id_in_file;
  size_t session = 0;
  std::string flaw = {};  // what is wrong with it, in a sentence
};

// The state of the robot along its path, e.g. "located".
struct PathPhases {
  std::vector<std::string> names;
  std::map<NodeId, size_t> phase_of_node;  // indices of names
};

// A picture of the whole map, made by DrawInspection().
struct StatePicture {
  std::string png;                        // all sessions in one
  std::vector<std::string> session_pngs;  // empty if there is only one
  // Of the pixels with a wall of any session, the share that is free in
  // another; none if there is only one.
  std::optional<double> conflict_share;
};

struct DrawnMaps {
  PixelFrame frame;
  int width = 0;
  int height = 0;
  std::vector<StatePicture> states;
  std::map<SubmapId, SubmapRaster> submaps;
};

struct InspectedConstraint {
  SubmapId submap;
  NodeId node;
  bool is_dropped = false;  // from the last state
};

// Where a query differs from the map.
struct InspectedChange {
  std::string kind;         // "appeared", "vanished"
  Eigen::AlignedBox2d box;  // map frame
  double wall_area = 0.;    // [m^2]
};

struct Inspection {
  std::string title;
  Tone tone = Tone::kNeutral;
  std::string verdict;  // a sentence or two
  // What the reader should know before trusting the result.
  std::vector<std::string> remarks;
  std::vector<std::pair<std::string, std::string>> numbers;
  std::vector<InspectedSession> sessions;  // at least one
  // The last one gives the map frame; the others are moved so that the first
  // submap, by id, lies where it lies there.
  std::vector<InspectedState> states;
  std::map<SubmapId, InspectedSubmap> submaps;
  PathPhases phases;
  std::vector<InspectedTable> tables;
  // By the indices that rows name, where constraints can be dropped.
  std::map<size_t, InspectedConstraint> constraints;
  std::vector<InspectedChange> changes;
  // What a robot saw from where it stands, in its frame.
  std::vector<Eigen::Vector2d> echoes;
  std::vector<HistogramPlot> histograms;
  std::vector<std::pair<std::string, double>> stage_seconds;
  DrawnMaps drawn;
};

// (map <- map frame of the state) for each state.
[[nodiscard]] std::vector<Rigid2> AlignStates(
    const std::vector<InspectedState>& states);

// How far the nodes that the first and the last state share lie apart, mean and
// largest [m]; none without two states.
struct Displacement {
  double mean = 0.;
  double largest = 0.;
};
[[nodiscard]] std::optional<Displacement> DisplacementOf(
    const std::vector<InspectedState>& states);

// Mean error of the last state's constraints between submaps, of each submap,
// by the poses of `poses` [m].
[[nodiscard]] std::map<SubmapId, double> SubmapErrors(
    const PoseGraph& constraints_of, const PoseGraph& poses);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_INSPECTION_H_
