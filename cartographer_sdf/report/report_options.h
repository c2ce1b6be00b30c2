// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_REPORT_OPTIONS_H_
#define CARTOGRAPHER_SDF_REPORT_REPORT_OPTIONS_H_

#include <string>
#include <vector>

#include "cartographer_sdf/report/run_description.h"

namespace cartographer_sdf {

struct ReportOptions {
  // Longer side of the pictures of the whole map [pixels].
  int map_picture_pixels = 2000;
  // Longer side of the picture of a submap [pixels].
  int submap_picture_pixels = 300;
  // Pairs of further submaps are listed without a picture.
  int max_submap_pictures = 300;
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
         : !is_size(options.submap_picture_pixels)
             ? "submap_picture_pixels must be from 16 to 8192"
         : options.max_submap_pictures < 0
             ? "max_submap_pictures must not be negative"
             : "";
}

// An option that differs from its default, by its path in the table of the
// configuration files.
struct ChangedOption {
  std::string name;
  std::string value;
  std::string default_value;
};

// What every report needs besides its content.
struct ReportRequest {
  std::string directory;  // index.html goes there
  ReportOptions options;
  std::string options_text;  // all options in force, as Lua
  std::vector<ChangedOption> changed_options = {};
  RunDescription run = {};
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_REPORT_OPTIONS_H_
