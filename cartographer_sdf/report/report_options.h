// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_REPORT_OPTIONS_H_
#define CARTOGRAPHER_SDF_REPORT_REPORT_OPTIONS_H_

#include <string>

namespace cartographer_sdf {

struct ReportOptions {
  // Longer side of the pictures of the whole map [pixels].
  int map_picture_pixels = 1600;
  // Longer side of the picture of a matched pair [pixels].
  int closure_picture_pixels = 360;
  // Further closures are listed without a picture.
  int max_closure_pictures = 60;
};

// Returns a sentence that begins with the offending option, or nothing.
[[nodiscard]] inline std::string Validate(const ReportOptions& options) {
  // Browsers do not show larger pictures of 32 bit per pixel well.
  constexpr int kMaxPixels = 8192;
  const auto is_size = [](const int pixels) {
    return pixels >= 16 && pixels <= kMaxPixels;
  };
  return !is_size(options.map_picture_pixels)
             ? "map_picture_pixels must be from 16 to 8192"
         : !is_size(options.closure_picture_pixels)
             ? "closure_picture_pixels must be from 16 to 8192"
         : options.max_closure_pictures < 0
             ? "max_closure_pictures must not be negative"
             : "";
}

// What every report needs besides its content.
struct ReportRequest {
  std::string directory;  // index.html goes there
  ReportOptions options;
  std::string options_text;  // all options in force, as Lua
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_REPORT_OPTIONS_H_
