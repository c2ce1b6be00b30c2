// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspector_page.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "cartographer_sdf/file/sha256.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/report/inspection_json.h"
#include "cartographer_sdf/report/inspector_template.h"
#include "cartographer_sdf/report/text.h"

namespace cartographer_sdf {
namespace {

using TextRow = std::pair<std::string, std::string>;

// What the page's policy allows to run: this very script, and no other.
std::string ScriptHash() {
  return absl::StrCat(
      "sha256-",
      absl::Base64Escape(absl::HexStringToBytes(Sha256(kInspectorScript))));
}

// JSON that no text in it can end early.
std::string EmbeddedJson(const Json& json) {
  return absl::StrReplaceAll(
      json.dump(-1, ' ', /*ensure_ascii=*/false,
                Json::error_handler_t::replace),
      {{"<", "\\u003c"}, {">", "\\u003e"}, {"&", "\\u0026"}});
}

std::string RenderRemarks(const std::vector<std::string>& remarks) {
  std::string html;
  for (const std::string& remark : remarks) {
    absl::StrAppend(&html, "<li>", EscapeMarkup(remark), "</li>\n");
  }
  return html.empty() ? ""
                      : absl::StrCat("<ul class=\"remarks\">\n", html, "</ul>");
}

std::string RenderRows(const std::vector<TextRow>& rows) {
  std::string html;
  for (const auto& [name, value] : rows) {
    absl::StrAppend(&html, "<tr><th scope=\"row\">", EscapeMarkup(name),
                    "</th><td>", EscapeMarkup(value), "</td></tr>\n");
  }
  return html;
}

// As a shell takes it.
std::string ShellQuoted(const std::string& argument) {
  const bool is_plain =
      !argument.empty() &&
      std::all_of(argument.begin(), argument.end(), [](const char c) {
        return absl::ascii_isalnum(static_cast<unsigned char>(c)) ||
               std::string("-_./=,:+@%").find(c) != std::string::npos;
      });
  return is_plain
             ? argument
             : absl::StrCat(
                   "'", absl::StrReplaceAll(argument, {{"'", "'\\''"}}), "'");
}

std::string CommandLine(const RunDescription& run) {
  std::vector<std::string> words = {run.program};
  if (!run.command.empty()) words.push_back(run.command);
  for (const std::string& argument : run.arguments) {
    words.push_back(ShellQuoted(argument));
  }
  return absl::StrJoin(words, " ");
}

std::vector<TextRow> ProvenanceRows(const RunDescription& run) {
  std::vector<TextRow> rows;
  if (run.program.empty()) return rows;
  rows.emplace_back("Command", CommandLine(run));
  rows.emplace_back("Program", absl::StrCat(run.program, " ", run.version,
                                            ", commit ", run.commit));
  rows.emplace_back("Started", run.started);
  for (const InputFile& file : run.inputs) {
    rows.emplace_back(
        absl::StrCat("--", file.flag),
        absl::StrCat(
            file.path, ", ",
            file.num_bytes ? absl::StrCat(*file.num_bytes, " bytes, ") : "",
            "SHA-256 ", file.sha256));
  }
  return rows;
}

std::string RenderChangedOptions(const std::vector<ChangedOption>& changed) {
  if (changed.empty()) {
    return "<p>All options have their default values.</p>\n";
  }
  std::string html =
      "<table class=\"facts\"><thead><tr><th>option</th><th>value</th>"
      "<th>default</th></tr></thead><tbody>\n";
  for (const ChangedOption& option : changed) {
    absl::StrAppend(&html, "<tr><th scope=\"row\">", EscapeMarkup(option.name),
                    "</th><td>", EscapeMarkup(option.value), "</td><td>",
                    EscapeMarkup(option.default_value), "</td></tr>\n");
  }
  return html + "</tbody></table>\n";
}

// The maps as the page shows them without JavaScript, which takes its pictures
// from here, too.
std::string RenderMaps(const Inspection& inspection) {
  std::string html;
  for (size_t k = 0; k < inspection.drawn.states.size(); ++k) {
    const InspectedState& state = inspection.states[k];
    const DrawnMaps& drawn = inspection.drawn;
    absl::StrAppendFormat(
        &html,
        "<figure><img id=\"map-%d\" alt=\"%s: floor plan of %.0f by %.0f m "
        "drawn from the submaps\" src=\"data:image/png;base64,%s\"/>"
        "<figcaption>%s</figcaption></figure>\n",
        k, EscapeMarkup(state.label),
        drawn.width / drawn.frame.pixels_per_meter,
        drawn.height / drawn.frame.pixels_per_meter,
        absl::Base64Escape(drawn.states[k].png), EscapeMarkup(state.caption));
  }
  return html;
}

std::string RenderHistograms(const std::vector<HistogramPlot>& histograms) {
  std::string html;
  for (const HistogramPlot& histogram : histograms) {
    absl::StrAppend(&html, "<div>", RenderHistogram(histogram), "</div>\n");
  }
  return html;
}

std::string RenderStages(
    const std::vector<std::pair<std::string, double>>& stages) {
  double longest = 0.;
  double sum = 0.;
  for (const auto& [name, seconds] : stages) {
    longest = std::max(longest, seconds);
    sum += seconds;
  }
  std::string html;
  for (const auto& [name, seconds] : stages) {
    const double percent =
        longest > 0. ? std::max(0., 100. * seconds / longest) : 0.;
    absl::StrAppendFormat(
        &html,
        "<tr><th scope=\"row\">%s</th><td>%.2f s</td>"
        "<td><div class=\"bar\" style=\"width:%.1f%%\"></div></td></tr>\n",
        EscapeMarkup(name), seconds, percent);
  }
  absl::StrAppendFormat(&html,
                        "<tr><th scope=\"row\">together</th>"
                        "<td>%.2f s</td><td></td></tr>\n",
                        sum);
  return html;
}

}  // namespace

std::string RenderInspector(const ReportRequest& request,
                            const Inspection& inspection) {
  // In one pass: no text is taken for a placeholder.
  return absl::StrReplaceAll(
      kInspectorPage,
      {{"{{title}}", EscapeMarkup(inspection.title)},
       {"{{script_hash}}", ScriptHash()},
       {"{{style}}", kInspectorStyle},
       {"{{tone}}", ToneName(inspection.tone)},
       {"{{verdict}}", EscapeMarkup(inspection.verdict)},
       {"{{remarks}}", RenderRemarks(inspection.remarks)},
       {"{{numbers}}", RenderRows(inspection.numbers)},
       {"{{maps}}", RenderMaps(inspection)},
       {"{{provenance}}", RenderRows(ProvenanceRows(request.run))},
       {"{{changed_options}}", RenderChangedOptions(request.changed_options)},
       {"{{options}}", EscapeMarkup(request.options_text)},
       {"{{histograms}}", RenderHistograms(inspection.histograms)},
       {"{{stages}}", RenderStages(inspection.stage_seconds)},
       {"{{document}}", EmbeddedJson(ToJson(request, inspection))},
       {"{{script}}", kInspectorScript}});
}

absl::Status WriteInspector(const ReportRequest& request,
                            const Inspection& inspection) {
  std::error_code error;
  std::filesystem::create_directories(request.directory, error);
  if (error) {
    return absl::UnavailableError(absl::StrCat("cannot make the directory ",
                                               request.directory, ": ",
                                               error.message()));
  }
  return WriteWholeFile(
      (std::filesystem::path(request.directory) / "index.html").string(),
      RenderInspector(request, inspection));
}

}  // namespace cartographer_sdf
