// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {
namespace {

// Above it, pictures of 32 bit per pixel exceed what browsers show well.
constexpr int kMaxPixels = 8192;

bool IsPictureSize(const int pixels) {
  return pixels >= 16 && pixels <= kMaxPixels;
}

}  // namespace

std::string Validate(const ReportOptions& options) {
  if (!IsPictureSize(options.map_picture_pixels)) {
    return "map_picture_pixels must be from 16 to 8192";
  }
  if (!IsPictureSize(options.closure_picture_pixels)) {
    return "closure_picture_pixels must be from 16 to 8192";
  }
  if (options.max_closure_pictures < 0) {
    return "max_closure_pictures must not be negative";
  }
  return "";
}

}  // namespace cartographer_sdf
