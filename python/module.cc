// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/file/pending_file.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "pybind11/eigen.h"
#include "pybind11/operators.h"
#include "pybind11/stl.h"
#include "python/bindings.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

constexpr int kMaxThreads = 1024;

using PointRows = Eigen::Matrix<double, Eigen::Dynamic, 2>;

PointRows Apply(const Rigid2& T_a_b, const PointRows& p_b) {
  PointRows p_a(p_b.rows(), 2);
  for (Eigen::Index k = 0; k < p_b.rows(); ++k) {
    p_a.row(k) = (T_a_b * Eigen::Vector2d(p_b.row(k))).transpose();
  }
  return p_a;
}

Eigen::Matrix3d MatrixOf(const Rigid2& pose) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix.topLeftCorner<2, 2>() = pose.RotationMatrix();
  matrix.topRightCorner<2, 1>() = pose.translation();
  return matrix;
}

py::str Format(const char* const format, const py::tuple& values) {
  return py::str(format).attr("format")(*values);
}

}  // namespace

std::map<std::pair<int, int>, double> SlipsByNode(const Slips& slips) {
  std::map<std::pair<int, int>, double> by_node;
  for (const auto& [node, angle] : slips) {
    by_node[{node.trajectory, node.index}] = angle;
  }
  return by_node;
}

Executor ExecutorOf(const int threads) {
  if (threads < 0 || threads > kMaxThreads) {
    throw py::value_error("threads must be from 0 to 1024");
  }
  if (threads > 0) return MakeExecutor(threads);
  return MakeExecutor(std::clamp(
      static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxThreads));
}

MapSource SourceOf(const std::string& path, const bool repair,
                   const bool drop_odometry) {
  return {path, repair ? MissingRecords::kDrop : MissingRecords::kRefuse,
          drop_odometry ? OdometryRecords::kDrop : OdometryRecords::kKeep};
}

void CheckOutput(const std::vector<std::string>& inputs,
                 const std::string& output) {
  for (const std::string& input : inputs) {
    ThrowUnlessOk(CheckIsNoInput(input, output));
  }
  ThrowUnlessOk(PendingFile::Create(output).status());
}

void BindGeometry(py::module_* const module) {
  py::class_<Rigid2>(*module, "Pose")
      .def(py::init<double, double, double>(), py::arg("x") = 0.,
           py::arg("y") = 0., py::arg("yaw") = 0.)
      .def_property_readonly(
          "x", [](const Rigid2& pose) { return pose.translation().x(); })
      .def_property_readonly(
          "y", [](const Rigid2& pose) { return pose.translation().y(); })
      .def_property_readonly("yaw", &Rigid2::rotation)
      .def("inverse", &Rigid2::Inverse)
      .def("matrix", &MatrixOf)
      .def("apply", &Apply, py::arg("points"))
      .def("__matmul__", [](const Rigid2& a, const Rigid2& b) { return a * b; })
      .def("__iter__",
           [](const Rigid2& pose) {
             return py::iter(py::make_tuple(pose.translation().x(),
                                            pose.translation().y(),
                                            pose.rotation()));
           })
      .def("__repr__", [](const Rigid2& pose) {
        return Format("Pose(x={:.6g}, y={:.6g}, yaw={:.6g})",
                      py::make_tuple(pose.translation().x(),
                                     pose.translation().y(), pose.rotation()));
      });
  py::class_<SubmapId>(*module, "SubmapId")
      .def(py::init([](const int trajectory, const int index) {
             return SubmapId{trajectory, index};
           }),
           py::arg("trajectory"), py::arg("index"))
      .def(py::init([](const std::pair<int, int>& id) {
        return SubmapId{id.first, id.second};
      }))
      .def_readonly("trajectory", &SubmapId::trajectory)
      .def_readonly("index", &SubmapId::index)
      .def(
          "__eq__", [](const SubmapId& a, const SubmapId& b) { return a == b; },
          py::is_operator())
      .def(
          "__lt__", [](const SubmapId& a, const SubmapId& b) { return a < b; },
          py::is_operator())
      .def("__hash__",
           [](const SubmapId& id) {
             return py::hash(py::make_tuple(id.trajectory, id.index));
           })
      .def("__iter__",
           [](const SubmapId& id) {
             return py::iter(py::make_tuple(id.trajectory, id.index));
           })
      .def("__repr__", [](const SubmapId& id) {
        return Format("SubmapId({}, {})",
                      py::make_tuple(id.trajectory, id.index));
      });
  py::implicitly_convertible<py::tuple, SubmapId>();
}

void BindOptions(py::module_* const module) {
  py::class_<Options>(*module, "Options")
      .def(py::init<>())
      .def("__str__",
           [](const Options& options) { return FormatOptions(options); });
  module->def("_load_options", [](std::vector<std::string> directories,
                                  const std::string& basename) {
    directories.push_back(CARTOGRAPHER_SDF_INSTALLED_CONFIGURATION_DIRECTORY);
    const std::string source = CARTOGRAPHER_SDF_SOURCE_CONFIGURATION_DIRECTORY;
    if (!source.empty()) directories.push_back(source);
    return ValueOrThrow(LoadOptions(directories, basename));
  });
}

}  // namespace cartographer_sdf

PYBIND11_MODULE(_core, module) {
  namespace sdf = cartographer_sdf;
  module.attr("__version__") = CARTOGRAPHER_SDF_VERSION;
  module.attr("__commit__") = CARTOGRAPHER_SDF_COMMIT;
  pybind11::register_exception<sdf::StatusException>(module, "Error",
                                                     PyExc_RuntimeError);
  sdf::BindGeometry(&module);
  sdf::BindOptions(&module);
  sdf::BindMaps(&module);
  sdf::BindPlaces(&module);
  sdf::BindQuality(&module);
  sdf::BindTasks(&module);
  sdf::BindLocalization(&module);
  sdf::BindSessions(&module);
  sdf::BindScans(&module);
}
