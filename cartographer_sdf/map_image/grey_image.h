// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Images of maps: PGM and PNG.

#ifndef CARTOGRAPHER_SDF_MAP_IMAGE_GREY_IMAGE_H_
#define CARTOGRAPHER_SDF_MAP_IMAGE_GREY_IMAGE_H_

#include <Eigen/Core>
#include <string>

#include "absl/status/statusor.h"

namespace cartographer_sdf {

// Pixel (x, y) is at row x and column y of the arrays; y grows upwards, from
// the lowest line of the image.
struct GreyImage {
  // From 0, black, to 1, white.
  Eigen::ArrayXXf brightness;
  // Where a pixel is not opaque; empty if all are.
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> transparent;
};

// Any bytes yield an image or an error of one sentence. Images of more than 25
// million pixels, or more than 30 000 a side, are refused before memory is
// taken for them.
//
// P2 or P5.
[[nodiscard]] absl::StatusOr<GreyImage> ReadPgmImage(const std::string& path);
// Colours count as the mean of their channels.
[[nodiscard]] absl::StatusOr<GreyImage> ReadPngImage(const std::string& path);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MAP_IMAGE_GREY_IMAGE_H_
