// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Converts Cartographer's grids to ours and back. Only this code knows how the
// host orders cells and encodes values.
//
// The host's cells lie in the trajectory's local frame. Its fast index runs
// along -y and its slow index along -x, starting at the corner `max`; ours run
// along +x and +y from the opposite corner. No cell is dropped or resampled.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_GRID_CONVERSION_H_
#define CARTOGRAPHER_SDF_PBSTREAM_GRID_CONVERSION_H_

#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Returns the occupancy of a probability grid, or the occupancy that the signed
// distance of a TSDF implies (exact at cell centres, heuristic in its values):
//
// - The surface is where the distance changes sign. In every column that a
//   surface crosses, or else in every row, it passes within half a cell of a
//   centre, so the cells within half a cell form its gap-free image.
//   Probability falls linearly from 0.9 on the surface to 0.5 at 3/4 of a cell,
//   a margin for noise and for thresholds above 0.5, and to 0.1 at 3/2 of a
//   cell or at the truncation distance.
// - Cells farther behind the surface were not observed but extrapolated along
//   the ray; like cells without weight they are unknown.
//
// The message of an error is a predicate, as in pose_codec.h.
[[nodiscard]] absl::StatusOr<OccupancyGrid> MakeOccupancyGrid(
    const proto::Grid2D& grid, const Rigid2& T_local_submap);

// Returns a probability grid with the host's bounds, to which probabilities are
// clamped: [0.1, 0.9] in steps of 0.8 / 32766. The grid's axes must be aligned
// with those of the local frame.
[[nodiscard]] proto::Grid2D MakeGrid2D(const OccupancyGrid& grid,
                                       const Rigid2& T_local_submap);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_GRID_CONVERSION_H_
