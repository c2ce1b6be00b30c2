// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The pictures of [Millane2019], with their longer side at about `max_pixels`.
// All in the grid frame, x to the right, y up, unless said otherwise. Maxima
// are red, saddles green, minima yellow.

#ifndef CARTOGRAPHER_SDF_REPORT_FEATURE_PICTURES_H_
#define CARTOGRAPHER_SDF_REPORT_FEATURE_PICTURES_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/submap_pictures.h"

namespace cartographer_sdf {

// Free space white, walls black, unknown grey.
[[nodiscard]] Picture DrawOccupancyGrid(const OccupancyGrid& grid,
                                        int max_pixels);

// The signed distance at cell centres, with keypoints: white at walls, blue in
// free space, brown inside obstacles, hatched where unobserved, and a contour
// line every half metre.
[[nodiscard]] Picture DrawDistanceField(const DistanceField& field,
                                        const std::vector<Feature>& features,
                                        int max_pixels);

// Where features may lie (Fig. 6): observed cells within `max_clearance` of a
// wall are white, other cells are shaded, walls are black.
[[nodiscard]] Picture DrawClearanceMask(const DistanceField& field,
                                        double max_clearance, int max_pixels);

// The observed field as a surface over the plane (Fig. 3), with keypoints, seen
// obliquely from above; the height is the distance to walls.
[[nodiscard]] Picture DrawFieldSurface(const DistanceField& field,
                                       const std::vector<Feature>& features,
                                       int max_pixels);

// The window of a descriptor (Fig. 4b): the field around the keypoint, with an
// arrow for the weighted gradient at every third cell and a long arrow for the
// dominant direction. `smoothed` is the result of SmoothField.
[[nodiscard]] Picture DrawFeatureWindow(const DescriptorOptions& options,
                                        const DistanceField& field,
                                        const Eigen::ArrayXXf& smoothed,
                                        const Feature& feature, int max_pixels);

// The descriptor (Fig. 4c): the histogram of orientations and, last, the mean
// distance. A plot as in svg_plot.h.
[[nodiscard]] std::string RenderDescriptor(const Eigen::VectorXf& descriptor);

// One of two matched submaps, and the paths of its robot, in the map frame.
struct ShownSubmap {
  DistanceField field;
  Rigid2 T_map_submap;
  std::map<int, std::vector<Eigen::Vector2d>> paths;  // by trajectory
};

// A match on the map that it was found in (Fig. 1 and 8). The map is pale. The
// two submaps are drawn as distance fields, darker far from walls: the
// reference and its paths blue, the query and its paths red. Black lines join
// the features that agree.
[[nodiscard]] Picture DrawMatchOnMap(const MapPainter& map,
                                     const ShownSubmap& reference,
                                     const ShownSubmap& query,
                                     const std::vector<PointPair>& inliers);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_FEATURE_PICTURES_H_
