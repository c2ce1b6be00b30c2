// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Stores what localising scans needs of a map in a file beside it, so that a
// robot has its answer some milliseconds after it was switched on. The
// container is that of place files (place_store/place_file.h), with the same
// checks: written to a temporary file that is renamed when complete, each
// record with a CRC-32, bound to the bytes of the map and to the options.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_PANORAMA_FILE_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_PANORAMA_FILE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/place_store/place_file.h"

namespace cartographer_sdf {

// A map as one grid, in the map frame, and what was made of it.
struct DrawnMap {
  OccupancyGrid grid;
  PanoramaMap panoramas;
};

// The key of a map that is no single file, by all cells of its grid.
[[nodiscard]] PlaceFileKey MakeGridKey(const OccupancyGrid& grid,
                                       const std::string& options);

// The options that panoramas depend on, as text.
[[nodiscard]] std::string FormatPanoramaOptions(
    const ViewpointOptions& options);

[[nodiscard]] absl::Status WritePanoramas(const std::string& path,
                                          const PlaceFileKey& key,
                                          const DrawnMap& map);

// Returns what was written, bit by bit. NotFound if there is no such file,
// FailedPrecondition if it belongs to another map, other options or another
// version, DataLoss for any other bytes.
[[nodiscard]] absl::StatusOr<DrawnMap> ReadPanoramas(const std::string& path,
                                                     const PlaceFileKey& key);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_PANORAMA_FILE_H_
