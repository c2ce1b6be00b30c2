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

MergingResult Merge(const std::vector<std::string>& paths,
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
  MergingResult result = ValueOrThrow(MergeSessions(
      options.fold_check, options.localization, options.scan_places,
      options.loop_closing, sources, frozen_trajectories, ExecutorOf(threads)));
  if (output && result.refusal.empty()) {
    ThrowUnlessOk(
        WriteJoinedMap(result.parts, result.closed.pose_graph, *output));
  }
  return result;
}

Audit AuditOf(const std::string& path, const std::optional<std::string>& output,
              const Options& options, const std::set<int>& frozen_trajectories,
              const int threads, const bool repair, const bool drop_odometry) {
  CheckMethod(options, "audit");
  if (output) CheckOutput({path}, *output);
  const MapSource source = SourceOf(path, repair, drop_odometry);
  Audit audit =
      ValueOrThrow(AuditMap(options.loop_closing, options.audit, source,
                            frozen_trajectories, ExecutorOf(threads)));
  if (output && audit.refusal.empty()) {
    ThrowUnlessOk(WriteMap(source, *output, audit.pose_graph));
  }
  return audit;
}

void BindLocalization(py::module_* const module) {
  py::class_<Placement>(*module, "Placement")
      .def_readonly("T_map_query", &Placement::T_map_query)
      .def_readonly("score", &Placement::score)
      .def_readonly("is_rival", &Placement::is_rival)
      .def_readonly("votes", &Placement::votes);
  py::class_<Localization>(*module, "Localization")
      .def_property_readonly("localized",
                             [](const Localization& result) {
                               return result.T_map_query.has_value();
                             })
      .def_property_readonly("verdict",
                             [](const Localization& result) {
                               return LocalizationVerdictName(result.verdict);
                             })
      .def_readonly("reason", &Localization::reason)
      .def_readonly("T_map_query", &Localization::T_map_query)
      .def_readonly("score", &Localization::score)
      .def_readonly("runner_up_score", &Localization::runner_up_score)
      .def_readonly("matches", &Localization::matches)
      .def_readonly("placements", &Localization::placements)
      .def_readonly("agreeing", &Localization::num_agreeing)
      .def_readonly("contradicting", &Localization::num_contradicting)
      .def_readonly("stage_seconds", &Localization::stage_seconds);
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
  py::class_<MergingResult>(*module, "MergedMap")
      .def_property_readonly(
          "merged",
          [](const MergingResult& result) { return result.refusal.empty(); })
      .def_readonly("reason", &MergingResult::refusal)
      .def_readonly("sessions", &MergingResult::sessions)
      .def_readonly("links", &MergingResult::links)
      .def_property_readonly(
          "closures",
          [](const MergingResult& result) { return result.closed.closures; })
      .def_property_readonly("submaps",
                             [](const MergingResult& result) {
                               return result.closed.pose_graph.submap_poses;
                             })
      .def_readonly("overlapping_pairs", &MergingResult::num_overlapping)
      .def_readonly("contradictions", &MergingResult::contradictions)
      .def_readonly("stage_seconds", &MergingResult::stage_seconds);
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

void BindAudit(py::module_* const module) {
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
  py::class_<Audit>(*module, "Audit")
      .def_readonly("constraints", &Audit::constraints)
      .def_readonly("doubtful", &Audit::num_doubtful)
      .def_readonly("refusal", &Audit::refusal)
      .def_readonly("leaves_out_odometry", &Audit::leaves_out_odometry)
      .def_property_readonly(
          "submaps",
          [](const Audit& audit) { return audit.pose_graph.submap_poses; })
      .def_readonly("stage_seconds", &Audit::stage_seconds);
  module->def("audit", &AuditOf, py::arg("path"),
              py::arg("output") = py::none(), py::arg("options") = Options(),
              py::arg("frozen_trajectories") = std::set<int>(),
              py::arg("threads") = 0, py::arg("repair") = false,
              py::arg("drop_odometry") = false,
              py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void BindSessions(py::module_* const module) {
  BindLocalization(module);
  BindMerge(module);
  BindAudit(module);
}

}  // namespace cartographer_sdf
