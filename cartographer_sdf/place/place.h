// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PLACE_PLACE_H_
#define CARTOGRAPHER_SDF_PLACE_PLACE_H_

#include <optional>
#include <string>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/feature/keypoint.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/place/surface_model.h"

namespace cartographer_sdf {

struct PlaceOptions {
  FieldOptions field;
  KeypointOptions keypoint;
  DescriptorOptions descriptor;
  // Distance fields of one map that stay in memory [MB]; others are made again
  // when they are needed (field_memory.h). No result depends on it.
  double max_field_megabytes = 512.;
};
[[nodiscard]] std::string Validate(const PlaceOptions& options);

// The description by which a submap is remembered, in the submap frame.
struct Place {
  SubmapId id;
  SurfaceModel surface;
  FeatureSet features;
};

// Returns the smoothed field as far as detecting and describing keypoints reads
// it.
[[nodiscard]] Eigen::ArrayXXf SmoothFieldForPlace(const PlaceOptions& options,
                                                  const DistanceField& field);

// Returns nullopt if the grid has no wall or no observed cell.
[[nodiscard]] std::optional<Place> DescribePlace(const PlaceOptions& options,
                                                 const SubmapId& id,
                                                 const OccupancyGrid& grid);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_PLACE_H_
