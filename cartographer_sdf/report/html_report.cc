// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/html_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/report/text.h"

namespace cartographer_sdf {
namespace {

// Total size of the PNGs of closures; base64 adds a third.
constexpr size_t kMaxClosurePictureBytes = size_t{20} << 20;

// A hidden checkbox before each picture enlarges it, without a script.
constexpr char kStyle[] = R"css(
:root { color-scheme: light dark; --ink: #1b1f24; --paper: #ffffff;
  --soft: #f3f5f8; --line: #d4d9e0; --faint: #5d6673; --accent: #0072b2;
  --good: #00794f; --bad: #b34700; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e8ed; --paper: #14171b; --soft: #1e2329; --line: #39414b;
    --faint: #9aa4b1; --accent: #5ab4e8; --good: #3fbf8f; --bad: #f0883e; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem; max-width: 84rem; color: var(--ink);
  background: var(--paper); font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .7rem; padding-bottom: .2rem;
  border-bottom: 2px solid var(--accent); }
.subtitle { color: var(--faint); margin: .3rem 0 0; overflow-wrap: anywhere; }
.warning { border-left: 4px solid var(--bad); background: var(--soft);
  padding: .5rem .8rem; margin: .6rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .7rem; text-align: right; vertical-align: middle;
  border-bottom: 1px solid var(--line); }
th { color: var(--faint); font-weight: 600; }
td { white-space: nowrap; }
td.text, th.text { text-align: left; white-space: normal; }
.summary th { text-align: left; }
.summary td { text-align: left; white-space: normal; overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
.wide table { width: 100%; }
.accepted { color: var(--good); font-weight: 600; }
.refused { color: var(--bad); font-weight: 600; }
.columns { display: grid; gap: 1.2rem;
  grid-template-columns: repeat(auto-fit, minmax(22rem, 1fr)); }
figure { margin: 0; }
figcaption { color: var(--faint); margin-bottom: .3rem; }
.zoom { cursor: zoom-in; display: block; position: relative; }
.zoom input { position: absolute; opacity: 0; width: 1px; height: 1px; }
.zoom img { display: block; width: 100%; border: 1px solid var(--line); }
.zoom input:focus-visible + img { outline: 3px solid var(--accent); }
.zoom input:checked + img { position: fixed; inset: 0; z-index: 1;
  width: 100vw; height: 100vh; object-fit: contain; padding: 1rem;
  background: var(--paper); cursor: zoom-out; }
td .zoom { width: 8.5rem; margin: 0 auto; }
.plot { width: 100%; max-width: 34rem; height: auto; }
.bar { background: var(--accent); height: .8rem; min-width: 1px; }
.stages td:last-child { width: 60%; }
.stages table { width: 100%; }
.legend { color: var(--faint); }
.key { display: inline-block; width: .8rem; height: .8rem; margin: 0 .3rem 0 .9rem;
  vertical-align: -.05rem; border: 1px solid var(--line); }
pre { background: var(--soft); padding: 1rem; overflow-x: auto; }
summary { cursor: pointer; color: var(--accent); }
@media print {
  body { max-width: none; padding: 0; font-size: 10px; }
  tr, figure, .plot { break-inside: avoid; }
  .columns { grid-template-columns: 1fr 1fr; }
  td .zoom { width: 6rem; }
  .wide { overflow: visible; } }
)css";

std::string Zoomable(const std::string& png, const std::string& description) {
  return absl::StrCat(
      "<label class=\"zoom\"><input type=\"checkbox\" "
      "aria-label=\"enlarge\"/><img alt=\"",
      EscapeMarkup(description), "\" src=\"data:image/png;base64,",
      absl::Base64Escape(png), "\"/></label>");
}

std::string Section(const std::string& heading, const std::string& body) {
  return absl::StrCat("<section>\n<h2>", EscapeMarkup(heading), "</h2>\n", body,
                      "</section>\n");
}

std::string RenderSummary(const ReportContent& content) {
  std::string html;
  for (const std::string& warning : content.warnings) {
    absl::StrAppend(&html, "<p class=\"warning\">", EscapeMarkup(warning),
                    "</p>\n");
  }
  if (!content.summary.empty()) {
    html += "<table class=\"summary\">\n";
    for (const auto& [name, value] : content.summary) {
      absl::StrAppend(&html, "<tr><th scope=\"row\">", EscapeMarkup(name),
                      "</th><td>", EscapeMarkup(value), "</td></tr>\n");
    }
    html += "</table>\n";
  }
  return html.empty() ? html : Section("Summary", html);
}

// Side by side; empty if there are none.
std::string Columns(const std::string& heading,
                    const std::vector<std::string>& columns) {
  if (columns.empty()) return "";
  return Section(heading, absl::StrCat("<div class=\"columns\">\n",
                                       absl::StrJoin(columns, ""), "</div>\n"));
}

std::string RenderMap(const ReportedPicture& map) {
  return absl::StrCat("<figure><figcaption>", EscapeMarkup(map.caption),
                      " (click to enlarge)</figcaption>",
                      Zoomable(map.png, map.caption), "</figure>\n");
}

std::string IdText(const SubmapId& id) {
  return absl::StrCat(id.trajectory, ",", id.index);
}

std::string RenderClosure(const ReportedClosure& reported,
                          const bool with_picture) {
  const PairPose& pair = reported.match.pair;
  const PairEvidence& evidence = reported.match.evidence;
  const Eigen::Vector2d& translation = pair.T_reference_query.translation();
  std::string html = absl::StrFormat(
      "<tr><td>%s</td><td>%s</td><td class=\"text\"><span class=\"%s\">%s"
      "</span>",
      IdText(pair.reference), IdText(pair.query),
      reported.accepted ? "accepted" : "refused",
      !reported.status.empty() ? EscapeMarkup(reported.status)
      : reported.accepted      ? "accepted"
                               : "refused");
  if (!reported.reason.empty()) {
    absl::StrAppend(&html, "<br/>", EscapeMarkup(reported.reason));
  }
  absl::StrAppendFormat(
      &html,
      "</td><td>%.2f</td><td>%d</td><td>%.1f</td><td>%.0f %%</td>"
      "<td>%.1f %%</td><td>%.1f %%</td><td>%.3f</td><td>%.2f</td><td>%.2f</td>"
      "<td>%.1f</td><td>",
      pair.score, reported.match.inliers.size(), evidence.overlap_area,
      100. * evidence.overlap, 100. * evidence.HitRatio(),
      100. * evidence.ContradictionRatio(), evidence.WallDistance(),
      translation.x(), translation.y(),
      pair.T_reference_query.rotation() * 180. / M_PI);
  if (with_picture) {
    html +=
        Zoomable(reported.png, absl::StrCat("submap ", IdText(pair.query),
                                            " on ", IdText(pair.reference)));
  }
  return html + "</td></tr>\n";
}

constexpr char kClosureTableHead[] =
    "<div class=\"wide\"><table>\n<thead><tr><th>reference</th>"
    "<th>query</th><th class=\"text\">status</th><th>score</th>"
    "<th>inliers</th><th>overlap [m&#178;]</th><th>overlap</th><th>hits</th>"
    "<th>contradictions</th><th>wall distance [m]</th><th>x [m]</th>"
    "<th>y [m]</th><th>yaw [&#176;]</th><th>matched pair</th></tr></thead>\n"
    "<tbody>\n";

constexpr char kPictureLegend[] =
    "<p class=\"legend\">Pictures: walls of the reference "
    "<span class=\"key\" style=\"background:#0d2673\"></span>blue, of the "
    "query <span class=\"key\" style=\"background:#d91a1a\"></span>red, of "
    "either in the free space of the other "
    "<span class=\"key\" style=\"background:#ff9900\"></span>orange.</p>\n";

std::string RenderClosures(const ReportContent& content) {
  if (content.closures.empty()) return "";
  std::string rows;
  int num_left_out = content.num_undrawn;
  size_t num_bytes = 0;
  for (const ReportedClosure& closure : content.closures) {
    const bool fits = num_bytes + closure.png.size() <= kMaxClosurePictureBytes;
    if (fits) num_bytes += closure.png.size();
    num_left_out += !fits;
    rows += RenderClosure(closure, fits && !closure.png.empty());
  }
  return Section(
      content.closures_heading,
      absl::StrCat(
          num_bytes > 0 ? kPictureLegend : "",
          num_left_out > 0
              ? absl::StrCat(
                    "<p class=\"legend\">", num_left_out,
                    " pictures are left out to keep this page small.</p>\n")
              : "",
          kClosureTableHead, rows, "</tbody></table></div>\n"));
}

std::string RenderStages(
    const std::vector<std::pair<std::string, double>>& stages) {
  if (stages.empty()) return "";
  double longest = 0.;
  double sum = 0.;
  for (const auto& [name, seconds] : stages) {
    longest = std::max(longest, seconds);
    sum += seconds;
  }
  std::string html = "<div class=\"stages\"><table>\n";
  for (const auto& [name, seconds] : stages) {
    const double percent =
        longest > 0. ? std::max(0., 100. * seconds / longest) : 0.;
    absl::StrAppendFormat(
        &html,
        "<tr><th scope=\"row\" class=\"text\">%s</th><td>%.2f s</td>"
        "<td><div class=\"bar\" style=\"width:%.1f%%\"></div></td></tr>\n",
        EscapeMarkup(name), seconds, percent);
  }
  absl::StrAppendFormat(&html,
                        "<tr><th scope=\"row\" class=\"text\">together</th>"
                        "<td>%.2f s</td><td></td></tr>\n",
                        sum);
  return Section("Time", html + "</table></div>\n");
}

std::string RenderOptions(const std::string& options) {
  if (options.empty()) return "";
  return Section("Options",
                 absl::StrCat("<details><summary>The options in "
                              "force, as Lua</summary>\n<pre>",
                              EscapeMarkup(options), "</pre></details>\n"));
}

}  // namespace

std::string RenderReport(const ReportContent& content) {
  const std::string title = EscapeMarkup(content.title);
  std::vector<std::string> maps, histograms;
  for (const ReportedPicture& map : content.maps) {
    maps.push_back(RenderMap(map));
  }
  for (const HistogramPlot& histogram : content.histograms) {
    histograms.push_back(
        absl::StrCat("<div>", RenderHistogram(histogram), "</div>\n"));
  }
  return absl::StrCat(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\"/>\n<title>",
      title, "</title>\n<style>", kStyle, "</style>\n</head>\n<body>\n<header>",
      "<h1>", title, "</h1>\n<p class=\"subtitle\">",
      EscapeMarkup(content.subtitle), "</p>\n</header>\n<main>\n",
      RenderSummary(content), Columns("Map", maps), RenderClosures(content),
      Columns("Residuals", histograms), RenderStages(content.stages),
      RenderOptions(content.options), "</main>\n</body>\n</html>\n");
}

absl::Status WriteReport(const std::string& directory,
                         const ReportContent& content) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) {
    return absl::UnavailableError(absl::StrCat(
        "cannot make the directory ", directory, ": ", error.message()));
  }
  return WriteWholeFile(
      (std::filesystem::path(directory) / "index.html").string(),
      RenderReport(content));
}

}  // namespace cartographer_sdf
