// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Writing a map while it is read. Its pose graph comes first in the file, but
// to change it takes the nodes' gravity alignments, which come later, in the
// nodes' own records. A pose graph that ReadMap() returned has them too; they
// are assumed to be those of the file, and compared with them at its end.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_ASSUMED_ATTITUDES_H_
#define CARTOGRAPHER_SDF_PBSTREAM_ASSUMED_ATTITUDES_H_

#include <functional>

#include "absl/status/statusor.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct WrittenMap {
  RecordWriter file;  // whole, to be committed
  // What the nodes' records turned out to have.
  Attitudes attitudes;
};
using AssumingWriter =
    std::function<absl::StatusOr<WrittenMap>(const Attitudes& assumed)>;

// Calls `write` with the gravity alignments of `pose_graph`, and once more with
// the right ones where those were wrong: where `pose_graph` lacks nodes, or its
// gravity alignments were changed. Fails as `write` does.
[[nodiscard]] absl::StatusOr<RecordWriter> WriteWithAssumedAttitudes(
    const PoseGraph& pose_graph, const AssumingWriter& write);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_ASSUMED_ATTITUDES_H_
