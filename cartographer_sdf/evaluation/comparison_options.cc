// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/comparison_options.h"

#include "cartographer_sdf/config/option_binding.h"
#include "cartographer_sdf/config/option_keys.h"

namespace cartographer_sdf {

template <typename Visitor>
void VisitOptions(Visitor& visit, SubmapCloudOptions& options) {
  visit("max_num_scans", options.max_num_scans);
  visit("voxel_size_meters", options.voxel_size_meters);
}

template <typename Visitor>
void VisitOptions(Visitor& visit, CurvatureClusterOptions& options) {
  visit("scatter_radius_meters", options.scatter_radius_meters);
  visit("min_num_neighbours", options.min_num_neighbours);
  visit("detection_threshold", options.detection_threshold);
  visit("cluster_radius_meters", options.cluster_radius_meters);
  visit("min_num_points", options.min_num_points);
}

template <typename Visitor>
void VisitOptions(Visitor& visit, ShapeContextOptions& options) {
  visit("radius_meters", options.radius_meters);
  visit("num_radial_bins", options.num_radial_bins);
  visit("num_angular_bins", options.num_angular_bins);
  visit("orientation_radius_meters", options.orientation_radius_meters);
}

template <typename Visitor>
void VisitOptions(Visitor& visit, CloudPlaceOptions& options) {
  visit("cloud", options.cloud);
  visit("keypoint", options.keypoint);
  visit("descriptor", options.descriptor);
}

template <typename Visitor>
void VisitOptions(Visitor& visit, ComparisonOptions& options) {
  VisitOptions(visit, options.options);
  visit("shape_context", options.shape_context);
}

std::string Validate(const ComparisonOptions& options) {
  return Validate(options.options);
}

absl::StatusOr<ComparisonOptions> LoadComparisonOptions(
    const std::vector<std::string>& directories, const std::string& basename) {
  const absl::StatusOr<LuaDictionary> dictionary =
      LoadLuaDictionary(directories, basename, kOptionsTable);
  if (!dictionary.ok()) return dictionary.status();
  return ReadOptions<ComparisonOptions>(*dictionary);
}

std::string FormatOptions(const ComparisonOptions& options) {
  return FormatOptions(kOptionsTable, options) + "\nreturn " + kOptionsTable +
         "\n";
}

}  // namespace cartographer_sdf
