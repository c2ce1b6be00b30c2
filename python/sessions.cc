// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What relates several maps, and what checks the constraints of one.

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cartographer_sdf/apps/audit.h"
#include "cartographer_sdf/apps/merge.h"
#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/config/options.h"
#include "pybind11/stl.h"
#include "python/bindings.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

using MergedMap = WithHostMotion<MergingResult>;
using AuditedMap = WithHostMotion<Audit>;

// A map by its path, or what was made of it.
using MapArgument = std::variant<std::string, std::shared_ptr<DescribedMap>>;

std::optional<TimeWindow> WindowOf(const std::optional<double>& first_seconds,
                                   const double start_seconds) {
  if (!first_seconds && start_seconds == 0.) return std::nullopt;
  if (!(start_seconds >= 0.) || (first_seconds && !(*first_seconds > 0.))) {
    throw py::value_error(
        "first_seconds must be positive, start_seconds not negative");
  }
  return TimeWindow{start_seconds, first_seconds};
}

void CheckMethod(const Options& options, const std::string& task) {
  if (options.loop_closing.recognition.match.method == Method::kSdf) return;
  throw py::value_error(task + " needs match.method = \"sdf\"");
}

void Attach(const Session& map, const Session& query, const Localization& found,
            const Options& options, const Executor& executor,
            const std::string& output) {
  if (!found.T_map_query) {
    throw StatusException("nothing is written to " + output + ": " +
                          found.reason);
  }
  const MergingResult merged = ValueOrThrow(AttachQuery(
      options.fold_check, options.loop_closing, map, query, found, executor));
  if (!merged.refusal.empty()) {
    throw StatusException("nothing is written to " + output + ": " +
                          merged.refusal);
  }
  ThrowUnlessOk(WriteJoinedMap(merged.parts, merged.closed.pose_graph, output));
}

// Writes the query, attached to the map.
Localization RelocalizeAndWrite(const std::string& map_path,
                                const std::string& query_path,
                                const std::string& output,
                                const Options& options, const bool repair,
                                const bool drop_odometry,
                                const Executor& executor) {
  CheckOutput({map_path, query_path}, output);
  const LoopClosingOptions& closing = options.loop_closing;
  Session map{
      map_path,
      ValueOrThrow(DescribeMap(closing.place, closing.recognition.match,
                               SourceOf(map_path, repair, drop_odometry),
                               executor, {}, PointClouds::kKeep)),
      {}};
  const Session query = ValueOrThrow(DescribeSession(
      closing, options.scan_places, SourceOf(query_path, repair, drop_odometry),
      std::nullopt, executor));
  LocalizationOptions localization = options.localization;
  localization.num_first_places = std::numeric_limits<int>::max();
  localization.max_num_confirmed_pairs = std::numeric_limits<int>::max();
  Localization found =
      LocalizeIn(localization, closing, map.map, query.map, executor);
  Attach(map, query, found, options, executor, output);
  return found;
}

Localization Relocalize(const MapArgument& map_argument,
                        const std::string& query_path,
                        const std::optional<std::string>& output,
                        const std::optional<double>& first_seconds,
                        const double start_seconds, const Options& options,
                        const int threads, const bool repair,
                        const bool drop_odometry) {
  CheckMethod(options, "relocalize");
  const Executor executor = ExecutorOf(threads);
  const std::optional<TimeWindow> window =
      WindowOf(first_seconds, start_seconds);
  const auto* const path = std::get_if<std::string>(&map_argument);
  if (output) {
    if (path == nullptr || window) {
      throw py::value_error("output takes two whole maps, by their paths");
    }
    return RelocalizeAndWrite(*path, query_path, *output, options, repair,
                              drop_odometry, executor);
  }
  if (drop_odometry) throw py::value_error("drop_odometry needs an output");
  const LoopClosingOptions& closing = options.loop_closing;
  std::shared_ptr<DescribedMap> map;
  if (path == nullptr) {
    map = std::get<std::shared_ptr<DescribedMap>>(map_argument);
  } else {
    map = std::make_shared<DescribedMap>(
        ValueOrThrow(DescribeMap(closing.place, closing.recognition.match,
                                 SourceOf(*path, repair), executor)));
  }
  const Session query = ValueOrThrow(
      DescribeSession(closing, options.scan_places,
                      SourceOf(query_path, repair), window, executor));
  return LocalizeIn(options.localization, closing, *map, query.map, executor);
}

MergedMap Merge(const std::vector<std::string>& paths,
                const std::optional<std::string>& output,
                const Options& options,
                const std::set<int>& frozen_trajectories, const int threads,
                const bool repair, const bool drop_odometry) {
  CheckMethod(options, "merge");
  if (paths.size() < 2) throw py::value_error("merge needs two maps at least");
  if (output) CheckOutput(paths, *output);
  std::vector<MapSource> sources;
  for (const std::string& path : paths) {
    sources.push_back(SourceOf(path, repair, drop_odometry));
  }
  MergedMap result{
      ValueOrThrow(MergeSessions(options.fold_check, options.session_links,
                                 options.localization, options.scan_places,
                                 options.loop_closing, sources,
                                 frozen_trajectories, ExecutorOf(threads))),
      {}};
  if (!result.refusal.empty()) return result;
  if (output) {
    ThrowUnlessOk(
        WriteJoinedMap(result.parts, result.closed.pose_graph, *output));
  }
  const OptimizationOptions& weights =
      options.loop_closing.closing.optimization;
  result.host_motion =
      PredictHostMotion(weights, weights, result.closed.pose_graph);
  return result;
}

// The constraints of those numbers; ids are not checked here.
std::vector<ListedConstraint> ListOf(const std::vector<size_t>& numbers,
                                     const std::string& path,
                                     const MapSource& source) {
  const MapState state = ValueOrThrow(ReadMap(source, {}));
  std::vector<ListedConstraint> listed;
  for (const size_t number : numbers) {
    if (number >= state.pose_graph.constraints.size()) {
      throw py::value_error(path + " has no constraint " +
                            std::to_string(number));
    }
    const Constraint& constraint = state.pose_graph.constraints[number];
    listed.push_back({number, constraint.submap, constraint.node});
  }
  return listed;
}

AuditedMap AuditOf(const std::string& path,
                   const std::optional<std::string>& output,
                   const Options& options,
                   const std::set<int>& frozen_trajectories, const int threads,
                   const bool repair, const bool drop_odometry,
                   const std::optional<std::vector<size_t>>& drop) {
  CheckMethod(options, "audit");
  if (output) CheckOutput({path}, *output);
  const MapSource source = SourceOf(path, repair, drop_odometry);
  std::optional<std::vector<ListedConstraint>> listed;
  if (drop) listed = ListOf(*drop, path, source);
  AuditedMap audit{ValueOrThrow(AuditMap(options.loop_closing, options.audit,
                                         source, frozen_trajectories,
                                         ExecutorOf(threads), {}, listed)),
                   {}};
  if (!audit.refusal.empty()) return audit;
  if (output) ThrowUnlessOk(WriteMap(source, *output, audit.pose_graph));
  audit.host_motion =
      PredictHostMotion(options.loop_closing.closing.optimization,
                        audit.optimization, audit.pose_graph);
  return audit;
}

void BindRelocalization(py::module_* const module) {
  module->def("relocalize", &Relocalize, py::arg("map"), py::arg("query"),
              py::arg("output") = py::none(),
              py::arg("first_seconds") = py::none(),
              py::arg("start_seconds") = 0., py::arg("options") = Options(),
              py::arg("threads") = 0, py::arg("repair") = false,
              py::arg("drop_odometry") = false,
              py::call_guard<py::gil_scoped_release>());
}

void BindMerge(py::module_* const module) {
  py::class_<MergedSession>(*module, "MergedSession")
      .def_readonly("path", &MergedSession::path)
      .def_readonly("group", &MergedSession::group)
      .def_readonly("T_merged_session", &MergedSession::T_merged_session)
      .def_readonly("left_out", &MergedSession::left_out);
  py::class_<SessionLink>(*module, "SessionLink")
      .def_readonly("first", &SessionLink::first)
      .def_readonly("second", &SessionLink::second)
      .def_readonly("localization", &SessionLink::localization);
  py::class_<MergedMap>(*module, "MergedMap")
      .def_property_readonly(
          "merged",
          [](const MergedMap& result) { return result.refusal.empty(); })
      .def_readonly("reason", &MergedMap::refusal)
      .def_readonly("sessions", &MergedMap::sessions)
      .def_readonly("links", &MergedMap::links)
      .def_property_readonly(
          "closures",
          [](const MergedMap& result) { return result.closed.closures; })
      .def_property_readonly("submaps",
                             [](const MergedMap& result) {
                               return result.closed.pose_graph.submap_poses;
                             })
      .def_readonly("overlapping_pairs", &MergedMap::num_overlapping)
      .def_readonly("contradictions", &MergedMap::contradictions)
      .def_readonly("host_motion", &MergedMap::host_motion)
      .def_readonly("stage_seconds", &MergedMap::stage_seconds);
  module->def("merge", &Merge, py::arg("paths"), py::arg("output") = py::none(),
              py::arg("options") = Options(),
              py::arg("frozen_trajectories") = std::set<int>(),
              py::arg("threads") = 0, py::arg("repair") = false,
              py::arg("drop_odometry") = false,
              py::call_guard<py::gil_scoped_release>());
}

std::pair<double, double> PairOf(const ConstraintError& error) {
  return {error.translation, error.rotation};
}

void BindAuditedConstraint(py::module_* const module) {
  py::class_<AuditedConstraint>(*module, "AuditedConstraint")
      .def_readonly("index", &AuditedConstraint::constraint)
      .def_property_readonly("verdict",
                             [](const AuditedConstraint& constraint) {
                               return AuditVerdictName(constraint.verdict);
                             })
      .def_property_readonly("is_doubtful",
                             [](const AuditedConstraint& constraint) {
                               return IsDoubtful(constraint.verdict);
                             })
      .def_property_readonly("error_before",
                             [](const AuditedConstraint& constraint) {
                               return PairOf(constraint.error_before);
                             })
      .def_property_readonly("error_after",
                             [](const AuditedConstraint& constraint) {
                               return PairOf(constraint.error_after);
                             });
}

void BindAudit(py::module_* const module) {
  py::class_<AuditedMap>(*module, "Audit")
      .def_readonly("constraints", &AuditedMap::constraints)
      .def_readonly("doubtful", &AuditedMap::num_doubtful)
      .def_property_readonly("dropped",
                             [](const AuditedMap& audit) {
                               return std::vector<size_t>(audit.dropped.begin(),
                                                          audit.dropped.end());
                             })
      .def_readonly("walls_before", &AuditedMap::quality_before)
      .def_readonly("walls_after", &AuditedMap::quality_after)
      .def_readonly("host_motion", &AuditedMap::host_motion)
      .def_readonly("refusal", &AuditedMap::refusal)
      .def_readonly("leaves_out_odometry", &AuditedMap::leaves_out_odometry)
      .def_property_readonly(
          "submaps",
          [](const AuditedMap& audit) { return audit.pose_graph.submap_poses; })
      .def_readonly("stage_seconds", &AuditedMap::stage_seconds);
  module->def("audit", &AuditOf, py::arg("path"),
              py::arg("output") = py::none(), py::arg("options") = Options(),
              py::arg("frozen_trajectories") = std::set<int>(),
              py::arg("threads") = 0, py::arg("repair") = false,
              py::arg("drop_odometry") = false, py::arg("drop") = py::none(),
              py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void BindSessions(py::module_* const module) {
  BindRelocalization(module);
  BindMerge(module);
  BindAuditedConstraint(module);
  BindAudit(module);
}

}  // namespace cartographer_sdf
