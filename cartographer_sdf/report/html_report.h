// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One self-contained HTML page that shows what was done to a map: no scripts
// and nothing from the network, so that it can be mailed, archived and printed.
// All texts may hold anything; they are escaped.

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
  // Whether it went into the pose graph; if not, `reason` says why.
  bool accepted = false;
  // In place of "accepted" or "refused", where that is not the word.
  std::string status;
  std::string reason;
  // Of its line in pictures of the map; none where it has no line.
  std::optional<Color> link;
  // Of the matched pair (DrawMatchedPair); empty where it was not drawn.
  std::string png;
};

// What is empty is left out of the page.
struct ReportContent {
  std::string title;
  std::string subtitle;
  std::vector<std::pair<std::string, std::string>> summary;
  // What the reader should know before trusting the result.
  std::vector<std::string> warnings;
  // Of the whole map, shown side by side: before and after.
  std::vector<ReportedPicture> maps;
  std::string closures_heading = "Closures";
  std::vector<ReportedClosure> closures;
  // Closures beyond the number that was to be drawn; the page says so.
  int num_undrawn = 0;
  std::vector<HistogramPlot> histograms;
  // Stages and the seconds that they took.
  std::vector<std::pair<std::string, double>> stages;
  // The options in force, as Lua.
  std::string options;
};

// Pictures of closures beyond what makes a page of some 30 MB are left out, the
// last ones first.
[[nodiscard]] std::string RenderReport(const ReportContent& content);

// Writes `directory`/index.html; makes the directory where it is missing.
[[nodiscard]] absl::Status WriteReport(const std::string& directory,
                                       const ReportContent& content);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_HTML_REPORT_H_
