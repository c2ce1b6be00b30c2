// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How good a map is, without a truth, and what Cartographer would do to it.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/map_examination.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/pose_graph/host_motion.h"
#include "pybind11/stl.h"
#include "python/bindings.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

// Where nothing was compared, nothing is known.
std::optional<double> IfCompared(const MapQuality& walls, const double value) {
  if (walls.num_pairs == 0) return std::nullopt;
  return value;
}

MapExamination Examine(const std::string& path, const Options& options,
                       const int threads, const bool repair) {
  const LoopClosingOptions& closing = options.loop_closing;
  const Executor executor = ExecutorOf(threads);
  const DescribedMap map = ValueOrThrow(
      DescribeMap(closing.place, closing.recognition.match,
                  SourceOf(path, repair), executor, {}, PointClouds::kKeep));
  return ExamineMap(closing, map, executor);
}

std::vector<SubmapId> TornSubmapsOf(const MapExamination& examination) {
  std::vector<SubmapId> ids;
  for (const auto& [id, tear] : examination.torn_submaps) ids.push_back(id);
  return ids;
}

std::pair<double, double> PairOf(const OdometryWeights& weights) {
  return {weights.translation, weights.rotation};
}

void BindWalls(py::module_* const module) {
  py::class_<MapQuality>(*module, "Walls")
      .def_readonly("pairs", &MapQuality::num_pairs)
      .def_property_readonly("hit_ratio",
                             [](const MapQuality& walls) {
                               return IfCompared(walls, walls.hit_ratio);
                             })
      .def_property_readonly("contradiction_ratio",
                             [](const MapQuality& walls) {
                               return IfCompared(walls,
                                                 walls.contradiction_ratio);
                             })
      .def_property_readonly("wall_distance", [](const MapQuality& walls) {
        return IfCompared(walls, walls.wall_distance);
      });
}

void BindHostMotion(py::module_* const module) {
  py::class_<HostMotion>(*module, "HostMotion")
      .def_readonly("max_translation", &HostMotion::max_translation)
      .def_property_readonly(
          "host_weights",
          [](const HostMotion& motion) { return PairOf(motion.host_weights); })
      .def_property_readonly("map_weights", [](const HostMotion& motion) {
        return PairOf(motion.map_weights);
      });
}

}  // namespace

void BindQuality(py::module_* const module) {
  BindWalls(module);
  BindHostMotion(module);
  py::class_<MapExamination>(*module, "MapExamination")
      .def_readonly("submaps", &MapExamination::num_submaps)
      .def_readonly("places", &MapExamination::num_places)
      .def_readonly("is_closed", &MapExamination::is_closed)
      .def_readonly("walls", &MapExamination::whole)
      .def_readonly("walls_along_trajectories",
                    &MapExamination::along_trajectories)
      .def_property_readonly("broken_links",
                             [](const MapExamination& map) {
                               return std::vector<SubmapId>(
                                   map.broken_links.begin(),
                                   map.broken_links.end());
                             })
      .def_property_readonly("torn_submaps", &TornSubmapsOf)
      .def_property_readonly(
          "slips",
          [](const MapExamination& map) { return SlipsByNode(map.slips); })
      .def_readonly("self_similar", &MapExamination::num_self_similar)
      .def_readonly("mean_area", &MapExamination::mean_area)
      .def_property_readonly("advice", &AdviseOnMap)
      .def_readonly("stage_seconds", &MapExamination::stage_seconds);
  module->def("examine_map", &Examine, py::arg("path"),
              py::arg("options") = Options(), py::arg("threads") = 0,
              py::arg("repair") = false,
              py::call_guard<py::gil_scoped_release>());
}

}  // namespace cartographer_sdf
