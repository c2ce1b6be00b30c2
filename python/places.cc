// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Places with their features, matches of pairs, and the index.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/recognition/match.h"
#include "pybind11/eigen.h"
#include "pybind11/stl.h"
#include "python/bindings.h"

namespace cartographer_sdf {

namespace py = pybind11;

namespace {

using PositionRows = Eigen::Matrix<double, Eigen::Dynamic, 2>;

const char* KindName(const KeypointKind kind) {
  switch (kind) {
    case KeypointKind::kMaximum:
      return "maximum";
    case KeypointKind::kMinimum:
      return "minimum";
    case KeypointKind::kSaddle:
      return "saddle";
  }
  return "";
}

// A number of each feature.
template <typename Number>
Eigen::VectorXd NumbersOf(const Place& place, const Number& number) {
  const std::vector<Feature>& features = place.features.features;
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(features.size()));
  for (size_t k = 0; k < features.size(); ++k) {
    numbers[static_cast<Eigen::Index>(k)] = number(features[k]);
  }
  return numbers;
}

PositionRows PositionsOf(const Place& place) {
  const std::vector<Feature>& features = place.features.features;
  PositionRows positions(static_cast<Eigen::Index>(features.size()), 2);
  for (size_t k = 0; k < features.size(); ++k) {
    positions.row(static_cast<Eigen::Index>(k)) =
        features[k].keypoint.position.transpose();
  }
  return positions;
}

std::vector<std::string> KindsOf(const Place& place) {
  std::vector<std::string> kinds;
  for (const Feature& feature : place.features.features) {
    kinds.emplace_back(KindName(feature.keypoint.kind));
  }
  return kinds;
}

// Of the keypoints that agree: x, y in the reference, x, y in the query.
Eigen::Matrix<double, Eigen::Dynamic, 4> InliersOf(const Match& match) {
  Eigen::Matrix<double, Eigen::Dynamic, 4> rows(
      static_cast<Eigen::Index>(match.inliers.size()), 4);
  for (size_t k = 0; k < match.inliers.size(); ++k) {
    const auto& [p_reference, p_query] = match.inliers[k];
    rows.row(static_cast<Eigen::Index>(k)) << p_reference.x(), p_reference.y(),
        p_query.x(), p_query.y();
  }
  return rows;
}

std::optional<Place> DescribeGrid(const OccupancyGrid& grid, const SubmapId& id,
                                  const Options& options) {
  std::optional<Place> place =
      DescribePlace(options.loop_closing.place, id, grid);
  const MatchOptions& match = options.loop_closing.recognition.match;
  if (place && match.method == Method::kSdf) {
    FindSelfSimilarities(match, &*place);
  }
  return place;
}

void BindPlace(py::module_* const module) {
  py::class_<Place>(*module, "Place")
      .def_readonly("id", &Place::id)
      .def_property_readonly("positions", &PositionsOf)
      .def_property_readonly("kinds", &KindsOf)
      .def_property_readonly("clearances",
                             [](const Place& place) {
                               return NumbersOf(place, [](const Feature& f) {
                                 return f.keypoint.clearance;
                               });
                             })
      .def_property_readonly("strengths",
                             [](const Place& place) {
                               return NumbersOf(place, [](const Feature& f) {
                                 return f.keypoint.strength;
                               });
                             })
      .def_property_readonly("orientations",
                             [](const Place& place) {
                               return NumbersOf(place, [](const Feature& f) {
                                 return f.orientation;
                               });
                             })
      .def_property_readonly("descriptors",
                             [](const Place& place) -> Eigen::MatrixXf {
                               return place.features.descriptors.transpose();
                             })
      .def_property_readonly(
          "observed_area",
          [](const Place& place) { return ObservedArea(place.surface); })
      .def("__len__",
           [](const Place& place) { return place.features.features.size(); });
  module->def("describe", &DescribeGrid, py::arg("grid"),
              py::arg("id") = SubmapId{0, 0}, py::arg("options") = Options(),
              py::call_guard<py::gil_scoped_release>());
}

void BindMatch(py::module_* const module) {
  py::class_<Match>(*module, "Match")
      .def_property_readonly(
          "reference", [](const Match& match) { return match.pair.reference; })
      .def_property_readonly(
          "query", [](const Match& match) { return match.pair.query; })
      .def_property_readonly(
          "T_reference_query",
          [](const Match& match) { return match.pair.T_reference_query; })
      .def_property_readonly(
          "score", [](const Match& match) { return match.pair.score; })
      .def_property_readonly(
          "verdict",
          [](const Match& match) { return VerdictName(match.verdict); })
      .def_property_readonly("accepted",
                             [](const Match& match) {
                               return match.verdict == Verdict::kAccepted;
                             })
      .def_property_readonly(
          "overlap", [](const Match& match) { return match.evidence.overlap; })
      .def_property_readonly(
          "hit_ratio",
          [](const Match& match) { return match.evidence.HitRatio(); })
      .def_property_readonly("contradiction_ratio",
                             [](const Match& match) {
                               return match.evidence.ContradictionRatio();
                             })
      .def_readonly("margin", &Match::margin)
      .def_readonly("rivals", &Match::rivals)
      .def_property_readonly("inliers", &InliersOf)
      .def("__repr__", [](const Match& match) {
        return py::str("Match({!r}, {!r}, {}, score={:.2f})")
            .attr("format")(match.pair.reference, match.pair.query,
                            VerdictName(match.verdict), match.pair.score);
      });
  module->def(
      "match",
      [](const Place& reference, const Place& query, const Options& options) {
        return MatchPlaces(options.loop_closing.recognition.match, reference,
                           query);
      },
      py::arg("reference"), py::arg("query"), py::arg("options") = Options(),
      py::call_guard<py::gil_scoped_release>());
}

void BindIndex(py::module_* const module) {
  py::class_<RetrievalCandidate>(*module, "Candidate")
      .def_readonly("id", &RetrievalCandidate::id)
      .def_readonly("score", &RetrievalCandidate::score)
      .def_readonly("T_reference_query",
                    &RetrievalCandidate::T_reference_query);
  py::class_<PlaceIndex>(*module, "Index")
      .def(py::init([](const Options& options) {
             return std::make_unique<PlaceIndex>(
                 options.loop_closing.recognition.retrieval);
           }),
           py::arg("options") = Options())
      .def(
          "add",
          [](PlaceIndex& index, const Place& place) {
            if (index.Contains(place.id)) {
              throw py::value_error("the index has a place of this id");
            }
            index.Add(place.id, place.features);
          },
          py::arg("place"))
      .def("remove", &PlaceIndex::Remove, py::arg("id"))
      .def(
          "query",
          [](const PlaceIndex& index, const Place& place) {
            return index.Query(place.features, [&place](const SubmapId& id) {
              return id == place.id;
            });
          },
          py::arg("place"))
      .def_property_readonly("memory_bytes", &PlaceIndex::MemoryUse)
      .def("__contains__", &PlaceIndex::Contains)
      .def("__len__", &PlaceIndex::size);
}

}  // namespace

void BindPlaces(py::module_* const module) {
  BindPlace(module);
  BindMatch(module);
  BindIndex(module);
}

}  // namespace cartographer_sdf
