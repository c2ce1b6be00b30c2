// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The parts of the Python module. What they offer is described where users look
// for it, in cartographer_sdf/__init__.pyi.

#ifndef PYTHON_BINDINGS_H_
#define PYTHON_BINDINGS_H_

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/host_motion.h"
#include "cartographer_sdf/pose_graph/slips.h"
#include "pybind11/pybind11.h"

namespace cartographer_sdf {

// cartographer_sdf.Error in Python: the sentence of a status.
class StatusException : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void ThrowUnlessOk(const absl::Status& status) {
  if (!status.ok()) throw StatusException(std::string(status.message()));
}

template <typename T>
T ValueOrThrow(absl::StatusOr<T> value) {
  ThrowUnlessOk(value.status());
  return *std::move(value);
}

// What was computed, and what Cartographer would do to the map if it loaded it
// unfrozen; none where it would not move it, or where there is no map.
template <typename T>
struct WithHostMotion : T {
  std::optional<HostMotion> host_motion;
};

// (trajectory, node at the end of the step) to the angle of the slip.
std::map<std::pair<int, int>, double> SlipsByNode(const Slips& slips);

// 0: as many threads as the machine supports. ValueError for other nonsense.
Executor ExecutorOf(int threads);

MapSource SourceOf(const std::string& path, bool repair,
                   bool drop_odometry = false);

// Throws before any work if the output is an input or cannot be written.
void CheckOutput(const std::vector<std::string>& inputs,
                 const std::string& output);

void BindGeometry(pybind11::module_* module);
void BindOptions(pybind11::module_* module);
void BindMaps(pybind11::module_* module);
void BindPlaces(pybind11::module_* module);
void BindQuality(pybind11::module_* module);
void BindTasks(pybind11::module_* module);
void BindLocalization(pybind11::module_* module);
void BindSessions(pybind11::module_* module);
void BindScans(pybind11::module_* module);

}  // namespace cartographer_sdf

#endif  // PYTHON_BINDINGS_H_
