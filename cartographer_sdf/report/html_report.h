// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One self-contained HTML page that shows what was done to a map: no scripts
// and nothing from the network, so that it can be mailed, archived and printed.
// All texts are escaped.

#ifndef CARTOGRAPHER_SDF_REPORT_HTML_REPORT_H_
#define CARTOGRAPHER_SDF_REPORT_HTML_REPORT_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/svg_plot.h"

namespace cartographer_sdf {

struct ReportedPicture {
  std::string caption;
  std::string png;
};

struct ReportedClosure {
  Match match;
  // Whether it entered the pose graph; if not, `reason` says why.
  bool accepted = false;
  // Replaces "accepted" or "refused", if not empty.
  std::string status;
  std::string reason;
  // Colour of its line in pictures of the map; none if it has no line.
  std::optional<Color> link;
  // Picture of the matched pair (DrawMatchedPair); empty if not drawn.
  std::string png;
};

// The page omits empty members.
struct ReportContent {
  std::string title;
  std::string subtitle;
  std::vector<std::pair<std::string, std::string>> summary;
  // Caveats that the reader should know before trusting the result.
  std::vector<std::string> warnings;
  // Pictures of the whole map, side by side: before and after.
  std::vector<ReportedPicture> maps;
  std::string closures_heading = "Closures";
  std::vector<ReportedClosure> closures;
  // Closures without a picture because of the limit; the page says so.
  int num_undrawn = 0;
  std::vector<HistogramPlot> histograms;
  // Stages and their durations [s].
  std::vector<std::pair<std::string, double>> stages;
  // The options in force, as Lua.
  std::string options;
};

// Leaves out pictures of closures, the last ones first, where the page would
// exceed some 30 MB.
[[nodiscard]] std::string RenderReport(const ReportContent& content);

// Writes `directory`/index.html; makes the directory if it is missing.
[[nodiscard]] absl::Status WriteReport(const std::string& directory,
                                       const ReportContent& content);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_HTML_REPORT_H_
