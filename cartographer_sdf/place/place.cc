// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place/place.h"

#include <algorithm>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {

std::string Validate(const PlaceOptions& options) {
  for (const std::string& error :
       {Validate(options.field), Validate(options.keypoint),
        Validate(options.descriptor)}) {
    if (!error.empty()) return error;
  }
  if (!(options.max_field_megabytes >= 0. &&
        options.max_field_megabytes <= 1e6)) {
    return "max_field_megabytes must lie between 0 and 1000000";
  }
  return "";
}

Eigen::ArrayXXf SmoothFieldForPlace(const PlaceOptions& options,
                                    const DistanceField& field) {
  return SmoothFieldNearObserved(
      field, options.keypoint.smoothing_sigma_cells,
      std::max(options.keypoint.non_maximum_suppression_cells + 1,
               SmoothedReach(options.descriptor, field.geometry.resolution)));
}

std::optional<Place> DescribePlace(const PlaceOptions& options,
                                   const SubmapId& id,
                                   const OccupancyGrid& grid) {
  CHECK_EQ(Validate(options), "");
  const std::optional<DistanceField> field =
      MakeDistanceField(options.field, grid);
  if (!field) return std::nullopt;
  std::optional<SurfaceModel> surface =
      MakeSurfaceModel(options.field, grid, *field);
  if (!surface) return std::nullopt;
  const Eigen::ArrayXXf smoothed = SmoothFieldForPlace(options, *field);
  FeatureSet features =
      DescribeKeypoints(options.descriptor, *field, smoothed,
                        DetectKeypoints(options.keypoint, *field, smoothed));
  return Place{id, *std::move(surface), std::move(features)};
}

}  // namespace cartographer_sdf
