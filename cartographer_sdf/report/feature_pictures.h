// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The pictures of [Millane2019] that show how features come about, with their
// longer side at about `max_pixels`. All in the grid frame, x to the right, y
// up, unless said otherwise.

#ifndef CARTOGRAPHER_SDF_REPORT_FEATURE_PICTURES_H_
#define CARTOGRAPHER_SDF_REPORT_FEATURE_PICTURES_H_

#include <string>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/submap_pictures.h"

namespace cartographer_sdf {

// As DrawDistanceField marks them.
[[nodiscard]] std::vector<MarkedKeypoint> MarkKeypoints(
    const FeatureSet& features);

// Where features may lie (Fig. 6): observed cells whose distance to a wall is
// at most that stay white, others are shaded; walls are black.
[[nodiscard]] Picture DrawClearanceMask(const DistanceField& field,
                                        double max_clearance, int max_pixels);

// The observed field as a surface over the plane (Fig. 3), seen obliquely from
// above, higher where walls are far; with keypoints in their places.
[[nodiscard]] Picture DrawFieldSurface(
    const DistanceField& field, const std::vector<MarkedKeypoint>& keypoints,
    int max_pixels);

// The window of a descriptor (Fig. 4b): the field around the keypoint, with an
// arrow for the gradient at each third cell as it is weighed, and a long one
// for the dominant direction. `smoothed` is SmoothField's result.
[[nodiscard]] Picture DrawFeatureWindow(const DescriptorOptions& options,
                                        const DistanceField& field,
                                        const Eigen::ArrayXXf& smoothed,
                                        const Feature& feature, int max_pixels);

// The descriptor (Fig. 4c): the histogram of orientations and, last, the mean
// distance. A plot as of svg_plot.h.
[[nodiscard]] std::string RenderDescriptor(const Eigen::VectorXf& descriptor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_FEATURE_PICTURES_H_
