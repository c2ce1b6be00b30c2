// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What is known of a query in a map: its pose, parts of their own, changes.

#include <optional>
#include <tuple>

#include "cartographer_sdf/localization/changes.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/probability.h"
#include "cartographer_sdf/localization/query_parts.h"
#include "pybind11/stl.h"
#include "python/bindings.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

std::optional<double> ProbabilityOfAnswer(const Localization& result) {
  if (!result.score) return std::nullopt;
  return ProbabilityOf(*result.score, result.runner_up_score);
}

std::optional<double> ProbabilityOfRunnerUp(const Localization& result) {
  if (!result.score || !result.runner_up_score) return std::nullopt;
  return ProbabilityOf(*result.runner_up_score, result.score);
}

std::tuple<double, double, double, double> BoxOf(const Change& change) {
  return {change.box.min().x(), change.box.min().y(), change.box.max().x(),
          change.box.max().y()};
}

void BindParts(py::module_* const module) {
  py::class_<Placement>(*module, "Placement")
      .def_readonly("T_map_query", &Placement::T_map_query)
      .def_readonly("score", &Placement::score)
      .def_readonly("is_rival", &Placement::is_rival)
      .def_readonly("votes", &Placement::votes);
  py::class_<QueryPart>(*module, "QueryPart")
      .def_readonly("placement", &QueryPart::placement)
      .def_readonly("first", &QueryPart::first)
      .def_readonly("last", &QueryPart::last);
  py::class_<Jump>(*module, "Jump")
      .def_readonly("before", &Jump::before)
      .def_readonly("after", &Jump::after)
      .def_readonly("distance", &Jump::distance);
  py::class_<Change>(*module, "Change")
      .def_property_readonly(
          "kind",
          [](const Change& change) { return ChangeKindName(change.kind); })
      .def_property_readonly("box", &BoxOf)
      .def_readonly("wall_area", &Change::wall_area);
}

// What supports the answer, and what speaks against it.
void BindEvidence(py::class_<Localization>* const localization) {
  localization->def_readonly("matches", &Localization::matches)
      .def_readonly("placements", &Localization::placements)
      .def_readonly("agreeing", &Localization::num_agreeing)
      .def_readonly("contradicting", &Localization::num_contradicting)
      .def_readonly("contradictions", &Localization::contradictions)
      .def_readonly("compared", &Localization::num_compared)
      .def_property_readonly("crossed",
                             [](const Localization& result) {
                               return result.crossing_walls.size();
                             })
      .def_property_readonly(
          "parts",
          [](const Localization& result) { return result.parts.parts; })
      .def_property_readonly(
          "jumps",
          [](const Localization& result) { return result.parts.jumps; })
      .def_readonly("changes", &Localization::changes)
      .def_property_readonly(
          "changed_area",
          [](const Localization& result) -> std::optional<double> {
            if (!result.T_map_query) return std::nullopt;
            return ChangedArea(result.changes);
          });
}

}  // namespace

void BindLocalization(py::module_* const module) {
  BindParts(module);
  py::class_<Localization> localization(*module, "Localization");
  localization
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
      .def_property_readonly("probability", &ProbabilityOfAnswer)
      .def_property_readonly("runner_up_probability", &ProbabilityOfRunnerUp)
      .def_readonly("score", &Localization::score)
      .def_readonly("runner_up_score", &Localization::runner_up_score)
      .def_readonly("stage_seconds", &Localization::stage_seconds);
  BindEvidence(&localization);
}

}  // namespace cartographer_sdf
