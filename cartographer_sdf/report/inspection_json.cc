// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspection_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace cartographer_sdf {
namespace {

// Of all paths together; more show nothing that a screen can.
constexpr size_t kMaxPathPoints = 6000;

// Digits that nobody sees would double the size of the page.
Json Rounded(const double value, const int num_decimals) {
  const double factor = std::pow(10., num_decimals);
  const double rounded = std::round(value * factor) / factor;
  return std::isfinite(rounded) ? Json(rounded) : Json(nullptr);
}

Json RoundedPose(const Rigid2& pose) {
  return {{"x", Rounded(pose.translation().x(), 4)},
          {"y", Rounded(pose.translation().y(), 4)},
          {"yaw", Rounded(pose.rotation(), 5)}};
}

Json RoundedPoint(const Eigen::Vector2d& point) {
  return {Rounded(point.x(), 2), Rounded(point.y(), 2)};
}

std::string PngUri(const std::string& png) {
  return absl::StrCat("data:image/png;base64,", absl::Base64Escape(png));
}

Json OptionsJson(const std::vector<ChangedOption>& changed) {
  Json json = Json::array();
  for (const ChangedOption& option : changed) {
    json.push_back({{"name", option.name},
                    {"value", option.value},
                    {"default", option.default_value}});
  }
  return json;
}

Json NumbersJson(const Inspection& inspection) {
  Json json = Json::array();
  for (const auto& [name, value] : inspection.numbers) {
    json.push_back({{"name", name}, {"value", value}});
  }
  return json;
}

Json StageSecondsJson(const Inspection& inspection) {
  Json stages = Json::object();
  double total = 0.;
  for (const auto& [stage, seconds] : inspection.stage_seconds) {
    stages[stage] = stages.value(stage, 0.) + seconds;
    total += seconds;
  }
  return {{"total", total}, {"stages", stages}};
}

std::string ColorText(const Color& color) {
  std::string text = "#";
  for (const double part : {color.red, color.green, color.blue}) {
    absl::StrAppend(&text,
                    absl::Hex(std::lround(255. * part), absl::kZeroPad2));
  }
  return text;
}

Json InspectedSessionsJson(const Inspection& inspection) {
  Json json = Json::array();
  for (size_t k = 0; k < inspection.sessions.size(); ++k) {
    const InspectedSession& session = inspection.sessions[k];
    json.push_back({{"name", session.name},
                    {"outcome", session.outcome},
                    {"tone", ToneName(session.tone)},
                    {"color", ColorText(CategoryColor(static_cast<int>(k)))}});
  }
  return json;
}

// The pictures of all sessions together are in the page, for readers without
// JavaScript.
Json StatesJson(const Inspection& inspection) {
  Json json = Json::array();
  for (size_t k = 0; k < inspection.states.size(); ++k) {
    const InspectedState& state = inspection.states[k];
    json.push_back({{"name", state.name},
                    {"label", state.label},
                    {"caption", state.caption},
                    {"pictures", Json::array()}});
    if (k >= inspection.drawn.states.size()) continue;
    json.back()["conflict_share"] =
        ToJson(inspection.drawn.states[k].conflict_share);
    for (const std::string& png : inspection.drawn.states[k].session_pngs) {
      json.back()["pictures"].push_back(PngUri(png));
    }
  }
  return json;
}

Json FrameJson(const DrawnMaps& drawn) {
  if (drawn.states.empty()) return nullptr;
  return {{"width", drawn.width},
          {"height", drawn.height},
          {"pixels_per_meter", drawn.frame.pixels_per_meter},
          {"left", drawn.frame.top_left.x()},
          {"top", drawn.frame.top_left.y()}};
}

Json RasterJson(const SubmapRaster& raster) {
  return {{"width", raster.width},
          {"height", raster.height},
          {"resolution", raster.resolution},
          {"T_submap_picture", RoundedPose(raster.T_submap_raster)},
          {"data", PngUri(EncodePng(raster))}};
}

// By state: null where it has no pose.
Json PosesJson(const Inspection& inspection,
               const std::vector<Rigid2>& T_map_states, const SubmapId& id) {
  Json poses = Json::array();
  for (size_t k = 0; k < inspection.states.size(); ++k) {
    const auto& submap_poses = inspection.states[k].pose_graph->submap_poses;
    const auto pose = submap_poses.find(id);
    poses.push_back(pose == submap_poses.end()
                        ? Json()
                        : RoundedPose(T_map_states[k] * pose->second));
  }
  return poses;
}

using ErrorsByState = std::vector<std::map<SubmapId, double>>;

ErrorsByState ErrorsOf(const Inspection& inspection) {
  ErrorsByState errors;
  for (const InspectedState& state : inspection.states) {
    errors.push_back(
        SubmapErrors(*inspection.states.back().pose_graph, *state.pose_graph));
  }
  return errors;
}

Json ErrorsJson(const ErrorsByState& errors, const SubmapId& id) {
  Json json = Json::array();
  for (const std::map<SubmapId, double>& state : errors) {
    const auto error = state.find(id);
    json.push_back(error == state.end() ? Json() : Rounded(error->second, 3));
  }
  return json;
}

Json SubmapsJson(const Inspection& inspection,
                 const std::vector<Rigid2>& T_map_states) {
  const ErrorsByState errors = ErrorsOf(inspection);
  Json json = Json::array();
  for (const auto& [id, submap] : inspection.submaps) {
    json.push_back(ToJson(submap.id_in_file));
    json.back().update(
        {{"session", submap.session},
         {"T_map_submap", PosesJson(inspection, T_map_states, id)},
         {"mean_errors", ErrorsJson(errors, id)},
         {"flaw", submap.flaw}});
    const auto raster = inspection.drawn.submaps.find(id);
    if (raster != inspection.drawn.submaps.end()) {
      json.back()["picture"] = RasterJson(raster->second);
    }
  }
  return json;
}

// One path for each trajectory that the last state has.
class PathWriter {
 public:
  PathWriter(const Inspection& inspection,
             const std::vector<Rigid2>& T_map_states)
      : inspection_(inspection), T_map_states_(T_map_states) {
    if (inspection.states.empty()) return;
    nodes_ = &inspection.states.back().pose_graph->nodes;
    stride_ = 1 + nodes_->size() / kMaxPathPoints;
  }

  [[nodiscard]] Json Write() const {
    if (nodes_ == nullptr) return Json::array();
    std::map<int, std::vector<NodeId>> ids;
    for (const auto& [id, node] : *nodes_) ids[id.trajectory].push_back(id);
    Json json = Json::array();
    for (const auto& [trajectory, path] : ids) {
      json.push_back(WritePath(trajectory, path));
      json.back()["color"] =
          ColorText(CategoryColor(static_cast<int>(json.size()) - 1));
    }
    return json;
  }

 private:
  Json WritePath(const int trajectory, const std::vector<NodeId>& ids) const {
    Json times = Json::array(), phases = Json::array(), points = Json::array();
    for (size_t k = 0; k < inspection_.states.size(); ++k) {
      points.push_back(Json::array());
    }
    const int64_t begin = nodes_->at(ids.front()).time;
    for (size_t n = 0; n < ids.size(); ++n) {
      if (n % stride_ != 0 && n + 1 < ids.size()) continue;
      times.push_back(
          Rounded(static_cast<double>(nodes_->at(ids[n]).time - begin) /
                      kTicksPerSecond,
                  1));
      const auto phase = inspection_.phases.phase_of_node.find(ids[n]);
      if (phase != inspection_.phases.phase_of_node.end()) {
        phases.push_back(phase->second);
      }
      for (size_t k = 0; k < points.size(); ++k) {
        points[k].push_back(PointAt(k, ids[n]));
      }
    }
    return {{"trajectory", trajectory},
            {"session", SessionOf(trajectory)},
            {"seconds", std::move(times)},
            {"phases", std::move(phases)},
            {"positions", std::move(points)}};
  }

  [[nodiscard]] Json PointAt(const size_t state, const NodeId& id) const {
    const auto& nodes = inspection_.states[state].pose_graph->nodes;
    const auto node = nodes.find(id);
    return node == nodes.end()
               ? Json()
               : RoundedPoint(T_map_states_[state] *
                              node->second.T_map_node.translation());
  }

  [[nodiscard]] size_t SessionOf(const int trajectory) const {
    const auto submap = inspection_.submaps.lower_bound({trajectory, 0});
    return submap != inspection_.submaps.end() &&
                   submap->first.trajectory == trajectory
               ? submap->second.session
               : 0;
  }

  const Inspection& inspection_;
  const std::vector<Rigid2>& T_map_states_;
  const std::map<NodeId, Node>* nodes_ = nullptr;
  size_t stride_ = 1;
};

Json MeasuresJson(const std::vector<Measure>& measures) {
  constexpr const char* kBounds[] = {"none", "at_least", "at_most"};
  Json json = Json::array();
  for (const Measure& measure : measures) {
    json.push_back({{"name", measure.name},
                    {"label", measure.label},
                    {"unit", measure.unit},
                    {"decimals", measure.num_decimals},
                    {"meaning", measure.meaning},
                    {"column", measure.is_column},
                    {"bound", kBounds[static_cast<size_t>(measure.bound)]},
                    {"threshold", measure.bound == Measure::Bound::kNone
                                      ? Json()
                                      : Json(measure.threshold)},
                    {"option", measure.option}});
  }
  return json;
}

Json RowStatusesJson(const std::vector<RowStatus>& statuses) {
  Json json = Json::array();
  for (const RowStatus& status : statuses) {
    json.push_back({{"name", status.name},
                    {"label", status.label},
                    {"tone", ToneName(status.tone)},
                    {"meaning", status.meaning},
                    {"option", status.option}});
  }
  return json;
}

Json ConstraintsJson(const Inspection& inspection, const InspectedRow& row) {
  Json json = Json::array();
  for (const size_t k : row.constraints) {
    const auto found = inspection.constraints.find(k);
    if (found == inspection.constraints.end()) continue;
    json.push_back({{"constraint", k},
                    {"submap_trajectory", found->second.submap.trajectory},
                    {"submap_index", found->second.submap.index},
                    {"node_trajectory", found->second.node.trajectory},
                    {"node_index", found->second.node.index},
                    {"dropped", found->second.is_dropped}});
  }
  return json;
}

// In the list of submaps; null where it is not listed.
using Positions = std::map<SubmapId, size_t>;

Json PositionJson(const Positions& positions, const SubmapId& id) {
  const auto position = positions.find(id);
  return position == positions.end() ? Json() : Json(position->second);
}

Json RowJson(const Inspection& inspection, const InspectedTable& table,
             const Positions& positions, const InspectedRow& row) {
  Json values = Json::array();
  for (size_t k = 0; k < row.values.size(); ++k) {
    values.push_back(row.values[k] ? Rounded(*row.values[k],
                                             table.measures[k].num_decimals + 1)
                                   : Json());
  }
  Json json = {{"status", row.status}, {"values", std::move(values)}};
  if (!row.remark.empty()) json["remark"] = row.remark;
  if (row.pair) {
    json["reference"] = PositionJson(positions, row.pair->reference);
    json["query"] = PositionJson(positions, row.pair->query);
    json["T_reference_query"] = RoundedPose(row.pair->T_reference_query);
    json["p_reference_overlap"] = row.p_reference_overlap
                                      ? RoundedPoint(*row.p_reference_overlap)
                                      : Json();
  }
  if (row.T_map_robot) json["T_map_robot"] = RoundedPose(*row.T_map_robot);
  if (!row.constraints.empty()) {
    json["constraints"] = ConstraintsJson(inspection, row);
  }
  return json;
}

Json TablesJson(const Inspection& inspection) {
  Positions positions;
  for (const auto& [id, submap] : inspection.submaps) {
    positions.emplace(id, positions.size());
  }
  Json json = Json::array();
  for (const InspectedTable& table : inspection.tables) {
    Json rows = Json::array();
    for (const InspectedRow& row : table.rows) {
      rows.push_back(RowJson(inspection, table, positions, row));
    }
    json.push_back({{"name", table.name},
                    {"heading", table.heading},
                    {"note", table.note},
                    {"measures", MeasuresJson(table.measures)},
                    {"statuses", RowStatusesJson(table.statuses)},
                    {"rows", std::move(rows)},
                    {"unlisted", table.num_unlisted}});
  }
  return json;
}

// As in the file of --result.
Json InspectedChangesJson(const Inspection& inspection) {
  Json json = Json::array();
  for (const InspectedChange& change : inspection.changes) {
    json.push_back({{"kind", change.kind},
                    {"x_min", Rounded(change.box.min().x(), 2)},
                    {"y_min", Rounded(change.box.min().y(), 2)},
                    {"x_max", Rounded(change.box.max().x(), 2)},
                    {"y_max", Rounded(change.box.max().y(), 2)},
                    {"wall_area", Rounded(change.wall_area, 3)}});
  }
  return json;
}

Json EchoesJson(const Inspection& inspection) {
  Json json = Json::array();
  for (const Eigen::Vector2d& echo : inspection.echoes) {
    json.push_back(RoundedPoint(echo));
  }
  return json;
}

}  // namespace

Json ToJson(const ReportRequest& request, const Inspection& inspection) {
  const std::vector<Rigid2> T_map_states = AlignStates(inspection.states);
  Json json = {{"schema", kInspectionSchema},
               {"schema_version", kInspectionSchemaVersion}};
  json.update(ToJson(request.run));
  json.update({{"title", inspection.title},
               {"verdict",
                {{"tone", ToneName(inspection.tone)},
                 {"sentence", inspection.verdict},
                 {"remarks", inspection.remarks}}},
               {"numbers", NumbersJson(inspection)},
               {"seconds", StageSecondsJson(inspection)},
               {"changed_options", OptionsJson(request.changed_options)},
               {"frame", FrameJson(inspection.drawn)},
               {"sessions", InspectedSessionsJson(inspection)},
               {"states", StatesJson(inspection)},
               {"submaps", SubmapsJson(inspection, T_map_states)},
               {"phases", inspection.phases.names},
               {"paths", PathWriter(inspection, T_map_states).Write()},
               {"tables", TablesJson(inspection)},
               {"changes", InspectedChangesJson(inspection)},
               {"echoes", EchoesJson(inspection)}});
  return json;
}

}  // namespace cartographer_sdf
