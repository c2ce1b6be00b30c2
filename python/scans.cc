// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where a robot stands or drives, by its scans.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cartographer_sdf/apps/map_grid.h"
#include "cartographer_sdf/apps/robot_scans.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/scan_session.h"
#include "cartographer_sdf/map_image/ros_map.h"
#include "cartographer_sdf/recording/scan_file.h"
#include "pybind11/eigen.h"
#include "pybind11/stl.h"
#include "python/bindings.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

using PointRows = Eigen::Matrix<float, Eigen::Dynamic, 2>;

std::vector<Eigen::Vector2f> PointsOf(const PointRows& rows) {
  if (!rows.allFinite()) throw py::value_error("points must be finite");
  std::vector<Eigen::Vector2f> points;
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    points.emplace_back(rows(k, 0), rows(k, 1));
  }
  return points;
}

PointRows RowsOf(const std::vector<Eigen::Vector2f>& points) {
  PointRows rows(static_cast<Eigen::Index>(points.size()), 2);
  for (size_t k = 0; k < points.size(); ++k) {
    rows.row(static_cast<Eigen::Index>(k)) = points[k].transpose();
  }
  return rows;
}

RobotScan MakeScan(const PointRows& returns, const PointRows& misses,
                   const Rigid2& T_robot_sensor) {
  return {T_robot_sensor, {PointsOf(returns), PointsOf(misses)}};
}

MapGrid GridOfPath(const std::string& path, const bool repair) {
  if (IsRosMapName(path)) return {ValueOrThrow(ReadRosMap(path)), {}};
  return ValueOrThrow(ReadMapGrid(SourceOf(path, repair)));
}

std::shared_ptr<PanoramaMap> MakePanoramas(
    const std::variant<std::string, OccupancyGrid>& map, const Options& options,
    const bool repair) {
  // Here, as pybind11 registers the object itself with the lock held.
  const py::gil_scoped_release release;
  const auto* const path = std::get_if<std::string>(&map);
  const MapGrid grid = path != nullptr
                           ? GridOfPath(*path, repair)
                           : MapGrid{std::get<OccupancyGrid>(map), {}};
  std::optional<PanoramaMap> panoramas = MakePanoramaMap(
      options.scan_localization.viewpoints, grid.grid, grid.driven_positions);
  if (!panoramas) {
    throw StatusException(
        "the map has no wall, or no free space for a robot to stand in");
  }
  return std::make_shared<PanoramaMap>(*std::move(panoramas));
}

ScanLocalization LocalizeScansIn(const PanoramaMap& map,
                                 const std::vector<RobotScan>& scans,
                                 const Options& options) {
  if (scans.empty()) throw py::value_error("there is no scan");
  return LocalizeScans(options.scan_localization, map, scans);
}

std::vector<OdometryScan> ReadDrive(const std::string& path,
                                    const bool repair) {
  ScanRecording recording =
      ValueOrThrow(ReadRobotScans(SourceOf(path, repair)));
  if (!recording.is_drive) {
    throw StatusException("the scans of " + path + " have no odometry");
  }
  return std::move(recording.scans);
}

OdometryScan MakeOdometryScan(const double time, const Rigid2& T_odometry_robot,
                              std::vector<RobotScan> scans) {
  return {time, T_odometry_robot, std::move(scans)};
}

void BindDrives(py::module_* const module) {
  py::class_<OdometryScan>(*module, "OdometryScan")
      .def(py::init(&MakeOdometryScan), py::arg("time"),
           py::arg("T_odometry_robot"), py::arg("scans"))
      .def_readonly("time", &OdometryScan::time)
      .def_readonly("T_odometry_robot", &OdometryScan::T_odometry_robot)
      .def_readonly("scans", &OdometryScan::scans);
  module->def("read_drive", &ReadDrive, py::arg("path"),
              py::arg("repair") = false,
              py::call_guard<py::gil_scoped_release>());
  py::class_<SessionAnswer>(*module, "SessionAnswer")
      .def_property_readonly("state",
                             [](const SessionAnswer& answer) {
                               return ScanSearchStateName(answer.state);
                             })
      .def_readonly("T_map_robot", &SessionAnswer::T_map_robot)
      .def_readonly("localization", &SessionAnswer::localization)
      .def_readonly("looks", &SessionAnswer::num_looks)
      .def_readonly("distance_driven", &SessionAnswer::distance_driven)
      .def_readonly("seconds", &SessionAnswer::seconds)
      .def_property_readonly("use", [](const SessionAnswer& answer) {
        return ScanUseName(answer.use);
      });
  py::class_<ScanSession>(*module, "ScanSession")
      .def(py::init([](const PanoramaMap& map, const Options& options) {
             return std::make_unique<ScanSession>(options.scan_localization,
                                                  options.scan_session, map);
           }),
           py::arg("map"), py::arg("options") = Options(),
           py::keep_alive<1, 2>())
      // With the interpreter's lock, as a session is not for several threads.
      .def(
          "add",
          [](ScanSession& session, const OdometryScan& scan) {
            return session.Add(scan);
          },
          py::arg("scan"))
      .def_property_readonly("answer", [](const ScanSession& session) {
        return session.answer();
      });
}

void BindCandidates(py::module_* const module) {
  py::class_<ScanCandidate>(*module, "ScanCandidate")
      .def_readonly("T_map_robot", &ScanCandidate::T_map_robot)
      .def_readonly("probability", &ScanCandidate::probability)
      .def_property_readonly(
          "covariance",
          [](const ScanCandidate& candidate) { return candidate.covariance; })
      .def_property_readonly(
          "beams", [](const ScanCandidate& c) { return c.evidence.num_beams; })
      .def_property_readonly(
          "fit", [](const ScanCandidate& c) { return c.evidence.fit; })
      .def_property_readonly(
          "at_wall", [](const ScanCandidate& c) { return c.evidence.at_wall; })
      .def_property_readonly(
          "through_wall",
          [](const ScanCandidate& c) { return c.evidence.through_wall; })
      .def_property_readonly(
          "in_free_space",
          [](const ScanCandidate& c) { return c.evidence.in_free_space; })
      .def_property_readonly("in_unknown", [](const ScanCandidate& c) {
        return c.evidence.in_unknown;
      });
}

void BindScanLocalization(py::module_* const module) {
  py::class_<ScanLocalization>(*module, "ScanLocalization")
      .def_property_readonly("localized",
                             [](const ScanLocalization& result) {
                               return result.verdict ==
                                      LocalizationVerdict::kLocalized;
                             })
      .def_property_readonly("verdict",
                             [](const ScanLocalization& result) {
                               return LocalizationVerdictName(result.verdict);
                             })
      .def_readonly("reason", &ScanLocalization::reason)
      .def_property_readonly(
          "T_map_robot",
          [](const ScanLocalization& result) -> std::optional<Rigid2> {
            if (result.verdict != LocalizationVerdict::kLocalized) return {};
            return result.candidates.front().T_map_robot;
          })
      .def_readonly("candidates", &ScanLocalization::candidates)
      .def_readonly("elsewhere_probability",
                    &ScanLocalization::elsewhere_probability)
      .def_readonly("stage_seconds", &ScanLocalization::stage_seconds);
  module->def("localize_scans", &LocalizeScansIn, py::arg("map"),
              py::arg("scans"), py::arg("options") = Options(),
              py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void BindScans(py::module_* const module) {
  py::class_<RobotScan>(*module, "Scan")
      .def(py::init(&MakeScan), py::arg("returns"),
           py::arg("misses") = PointRows(0, 2),
           py::arg("T_robot_sensor") = Rigid2())
      .def_property_readonly(
          "returns",
          [](const RobotScan& scan) { return RowsOf(scan.scan.returns); })
      .def_property_readonly(
          "misses",
          [](const RobotScan& scan) { return RowsOf(scan.scan.misses); })
      .def_readonly("T_robot_sensor", &RobotScan::T_robot_sensor);
  module->def(
      "read_scans",
      [](const std::string& path) { return ValueOrThrow(ReadScanFile(path)); },
      py::arg("path"), py::call_guard<py::gil_scoped_release>());
  py::class_<PanoramaMap, std::shared_ptr<PanoramaMap>>(*module, "PanoramaMap")
      .def(py::init(&MakePanoramas), py::arg("map"),
           py::arg("options") = Options(), py::arg("repair") = false);
  BindCandidates(module);
  BindScanLocalization(module);
  BindDrives(module);
}

}  // namespace cartographer_sdf
