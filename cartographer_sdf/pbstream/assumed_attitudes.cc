// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/assumed_attitudes.h"

#include <utility>

#include "absl/status/status.h"

namespace cartographer_sdf {
namespace {

// Whether nodes have the same gravity alignment in both; one that is absent has
// none.
bool AreSame(const Attitudes& a, const Attitudes& b) {
  const auto are_in = [](const Attitudes& some, const Attitudes& others) {
    for (const auto& [id, attitude] : some) {
      const auto other = others.find(id);
      const NodeAttitude& expected =
          other == others.end() ? NodeAttitude() : other->second;
      if (attitude.gravity_alignment.coeffs() !=
          expected.gravity_alignment.coeffs()) {
        return false;
      }
    }
    return true;
  };
  return are_in(a, b) && are_in(b, a);
}

}  // namespace

absl::StatusOr<RecordWriter> WriteWithAssumedAttitudes(
    const PoseGraph& pose_graph, const AssumingWriter& write) {
  Attitudes assumed;
  for (const auto& [id, node] : pose_graph.nodes) {
    assumed[id].gravity_alignment = node.gravity_alignment;
  }
  constexpr int kMaxAttempts = 2;
  for (int i = 0; i < kMaxAttempts; ++i) {
    absl::StatusOr<WrittenMap> map = write(assumed);
    if (!map.ok()) return map.status();
    if (AreSame(assumed, map->attitudes)) return std::move(map->file);
    assumed = std::move(map->attitudes);
  }
  return absl::AbortedError("the map changes while it is read");
}

}  // namespace cartographer_sdf
