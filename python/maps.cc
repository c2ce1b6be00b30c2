// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Maps, grids and fields.

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/field/distance_field.h"
#include "pybind11/eigen.h"
#include "pybind11/stl.h"
#include "python/bindings.h"
#include "python/loaded_map.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

// As of the host; memory for the field is some times that of the grid.
constexpr Eigen::Index kMaxNumCells = Eigen::Index{1} << 26;

OccupancyGrid MakeGrid(const Eigen::ArrayXXf& probability,
                       const BoolArray& known, const double resolution,
                       const Rigid2& T_submap_grid) {
  if (probability.rows() != known.rows() ||
      probability.cols() != known.cols()) {
    throw py::value_error("probability and known differ in shape");
  }
  if (probability.size() == 0 || probability.size() > kMaxNumCells) {
    throw py::value_error("a grid has from 1 to 2^26 cells");
  }
  if (!(resolution >= 1e-4 && resolution <= 1e3)) {
    throw py::value_error("resolution must be from 1e-4 to 1e3 m");
  }
  if (!(known.select(probability, 0.5f) > 0.f).all() ||
      !(known.select(probability, 0.5f) < 1.f).all()) {
    throw py::value_error("probabilities of known cells must lie in (0, 1)");
  }
  OccupancyGrid grid;
  grid.geometry.size = {static_cast<int>(probability.rows()),
                        static_cast<int>(probability.cols())};
  grid.geometry.resolution = resolution;
  grid.geometry.T_submap_grid = T_submap_grid;
  grid.probability = probability;
  grid.known = known;
  return grid;
}

LoadedMap ReadLoadedMap(const std::string& path, const bool repair) {
  LoadedMap map;
  map.path = path;
  map.state = ValueOrThrow(ReadMap(
      SourceOf(path, repair),
      {[&map](const SubmapId& id, const SubmapSummary&, OccupancyGrid grid) {
         map.grids.emplace(id, std::move(grid));
       },
       {}}));
  return map;
}

const OccupancyGrid& GridOf(const LoadedMap& map, const SubmapId& id) {
  const auto grid = map.grids.find(id);
  if (grid == map.grids.end()) throw py::key_error("no grid of this submap");
  return grid->second;
}

// Rows of trajectory, index; x, y, yaw; and Unix time [s].
using IdRows = Eigen::Matrix<int, Eigen::Dynamic, 2>;
using PoseRows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

IdRows NodeIds(const LoadedMap& map) {
  const auto& nodes = map.state.pose_graph.nodes;
  IdRows rows(static_cast<Eigen::Index>(nodes.size()), 2);
  Eigen::Index row = 0;
  for (const auto& [id, node] : nodes) {
    rows.row(row++) << id.trajectory, id.index;
  }
  return rows;
}

PoseRows NodePoses(const LoadedMap& map) {
  const auto& nodes = map.state.pose_graph.nodes;
  PoseRows rows(static_cast<Eigen::Index>(nodes.size()), 3);
  Eigen::Index row = 0;
  for (const auto& [id, node] : nodes) {
    const Rigid2 pose = TrackingPose(node);
    rows.row(row++) << pose.translation().x(), pose.translation().y(),
        pose.rotation();
  }
  return rows;
}

Eigen::VectorXd NodeTimes(const LoadedMap& map) {
  const auto& nodes = map.state.pose_graph.nodes;
  Eigen::VectorXd times(static_cast<Eigen::Index>(nodes.size()));
  Eigen::Index row = 0;
  for (const auto& [id, node] : nodes) {
    times[row++] = static_cast<double>(node.time - kUnixEpochTicks) /
                   static_cast<double>(kTicksPerSecond);
  }
  return times;
}

void BindFields(py::module_* const module) {
  py::class_<DistanceField>(*module, "Field")
      .def_property_readonly(
          "distance", [](const DistanceField& field) { return field.distance; })
      .def_property_readonly(
          "observed", [](const DistanceField& field) { return field.observed; })
      .def_property_readonly(
          "resolution",
          [](const DistanceField& field) { return field.geometry.resolution; })
      .def_property_readonly("T_submap_grid", [](const DistanceField& field) {
        return field.geometry.T_submap_grid;
      });
  module->def(
      "distance_field",
      [](const OccupancyGrid& grid, const Options& options) {
        return MakeDistanceField(options.loop_closing.place.field, grid);
      },
      py::arg("grid"), py::arg("options") = Options(),
      py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void BindMaps(py::module_* const module) {
  py::class_<OccupancyGrid>(*module, "Grid")
      .def(py::init(&MakeGrid), py::arg("probability"), py::arg("known"),
           py::arg("resolution"), py::arg("T_submap_grid") = Rigid2())
      .def_readonly("probability", &OccupancyGrid::probability)
      .def_readonly("known", &OccupancyGrid::known)
      .def_property_readonly(
          "resolution",
          [](const OccupancyGrid& grid) { return grid.geometry.resolution; })
      .def_property_readonly("T_submap_grid", [](const OccupancyGrid& grid) {
        return grid.geometry.T_submap_grid;
      });
  py::class_<Constraint>(*module, "Constraint")
      .def_readonly("submap", &Constraint::submap)
      .def_property_readonly("node",
                             [](const Constraint& constraint) {
                               return py::make_tuple(constraint.node.trajectory,
                                                     constraint.node.index);
                             })
      .def_readonly("T_submap_node", &Constraint::T_submap_node)
      .def_readonly("translation_weight", &Constraint::translation_weight)
      .def_readonly("rotation_weight", &Constraint::rotation_weight)
      .def_property_readonly(
          "is_inter_submap", [](const Constraint& constraint) {
            return constraint.tag == Constraint::Tag::kInterSubmap;
          });
  py::class_<LoadedMap>(*module, "Map")
      .def_readonly("path", &LoadedMap::path)
      .def_property_readonly(
          "trajectories",
          [](const LoadedMap& map) { return map.state.trajectories; })
      .def_property_readonly("submaps",
                             [](const LoadedMap& map) {
                               return map.state.pose_graph.submap_poses;
                             })
      .def_property_readonly(
          "constraints",
          [](const LoadedMap& map) { return map.state.pose_graph.constraints; })
      .def_property_readonly("node_ids", &NodeIds)
      .def_property_readonly("node_poses", &NodePoses)
      .def_property_readonly("node_times", &NodeTimes)
      .def("grid", &GridOf, py::arg("id"),
           py::return_value_policy::reference_internal)
      .def_property_readonly("grid_ids", [](const LoadedMap& map) {
        std::vector<SubmapId> ids;
        for (const auto& [id, grid] : map.grids) ids.push_back(id);
        return ids;
      });
  module->def("read_map", &ReadLoadedMap, py::arg("path"),
              py::arg("repair") = false,
              py::call_guard<py::gil_scoped_release>());
  BindFields(module);
}

}  // namespace cartographer_sdf
