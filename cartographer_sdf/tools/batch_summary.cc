// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/batch_summary.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "cartographer_sdf/report/text.h"
#include "cartographer_sdf/tools/json_members.h"
#include "cartographer_sdf/tools/version.h"

namespace cartographer_sdf {
namespace {

constexpr double kMegabyte = 1e6;

constexpr char kSummaryStyle[] = R"css(
:root { color-scheme: light dark; }
body { margin: 1.5rem auto; max-width: 90rem; padding: 0 1rem;
  font: 15px/1.45 system-ui, sans-serif; }
.failed { border-left: 4px solid #b34700; padding: .2rem .8rem; margin: .6rem 0;
  overflow-wrap: anywhere; }
.maps { display: grid; gap: 1rem;
  grid-template-columns: repeat(auto-fill, minmax(16rem, 1fr)); }
figure { margin: 0; border: 1px solid #8888; padding: .6rem; }
figure img { width: 100%; height: 14rem; object-fit: contain; background: #808080; }
figcaption { overflow-wrap: anywhere; font-variant-numeric: tabular-nums; }
.warning { color: #b34700; }
.small { opacity: .75; font-size: .9em; }
)css";

// A field of CSV [RFC4180], in one line.
std::string CsvField(const std::string& text) {
  std::string field = text;
  for (char& c : field) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  if (field.find_first_of(",\"") == std::string::npos) return field;
  return absl::StrCat("\"", absl::StrReplaceAll(field, {{"\"", "\"\""}}), "\"");
}

// All counts, in the order in which rows have them first.
std::vector<std::string> CountNames(const std::vector<BatchRow>& rows) {
  std::vector<std::string> names;
  for (const BatchRow& row : rows) {
    for (const auto& [name, number] : row.counts) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
  }
  return names;
}

std::string CountOf(const BatchRow& row, const std::string& name) {
  for (const auto& [other, number] : row.counts) {
    if (other == name) return absl::StrCat(number);
  }
  return "";
}

std::string PictureMarkup(const BatchRow& row) {
  std::ifstream file(row.job.picture, std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(file),
                        std::istreambuf_iterator<char>()};
  if (png.empty() || row.has_failed()) return "";
  return absl::StrCat("<img alt=\"the map\" src=\"data:image/png;base64,",
                      absl::Base64Escape(png), "\"/>");
}

std::string FigureMarkup(const BatchRow& row) {
  std::string text = absl::StrCat("<figure>", PictureMarkup(row),
                                  "<figcaption><b>", EscapeMarkup(row.job.name),
                                  "</b> ", EscapeMarkup(row.status));
  if (!row.warnings.empty()) {
    absl::StrAppend(&text, " <span class=\"warning\">",
                    EscapeMarkup(absl::StrJoin(row.warnings, ", ")), "</span>");
  }
  text += "<br/>";
  for (const auto& [name, number] : row.counts) {
    absl::StrAppend(&text, EscapeMarkup(name), " ", number, ", ");
  }
  absl::StrAppendFormat(&text, "%.1f s, %.0f MB<br/>", row.seconds,
                        static_cast<double>(row.peak_memory_bytes) / kMegabyte);
  return absl::StrCat(text, "<span class=\"small\">",
                      EscapeMarkup(row.job.input),
                      "</span></figcaption></figure>\n");
}

}  // namespace

BatchRow MakeRow(const BatchJob& job) {
  BatchRow row;
  row.job = job;
  const std::optional<Json> result = ReadResult(job);
  if (!result) {
    row.status = "lost";
    row.message = "no result: it was killed, or has not run";
    return row;
  }
  row.status = TextOf(*result, "status");
  row.exit_code = static_cast<int>(NumberOf(*result, "exit_code"));
  row.message = TextOf(*result, "message");
  const Json counts = MemberOf(*result, "counts");
  for (const auto& [name, number] : counts.items()) {
    if (number.is_number()) row.counts.emplace_back(name, number);
  }
  const Json warnings = MemberOf(*result, "warnings");
  for (const Json& warning : warnings) {
    row.warnings.push_back(TextOf(warning, "code"));
  }
  const Json inputs = MemberOf(*result, "inputs");
  if (inputs.is_array() && !inputs.empty()) {
    row.sha256 = TextOf(inputs[0], "sha256");
  }
  row.seconds = NumberOf(MemberOf(*result, "seconds"), "total");
  row.peak_memory_bytes =
      static_cast<int64_t>(NumberOf(*result, "peak_memory_bytes"));
  return row;
}

std::string FormatSummaryCsv(const std::vector<BatchRow>& rows) {
  const std::vector<std::string> names = CountNames(rows);
  std::string csv = "name,input,status,exit_code,message";
  for (const std::string& name : names) absl::StrAppend(&csv, ",", name);
  csv += ",warnings,seconds,peak_memory_bytes,output,sha256\n";
  for (const BatchRow& row : rows) {
    absl::StrAppend(&csv, CsvField(row.job.name), ",", CsvField(row.job.input),
                    ",", row.status, ",", row.exit_code, ",",
                    CsvField(row.message));
    for (const std::string& name : names) {
      absl::StrAppend(&csv, ",", CountOf(row, name));
    }
    absl::StrAppendFormat(
        &csv, ",%s,%.3f,%d,%s,%s\n", absl::StrJoin(row.warnings, " "),
        row.seconds, row.peak_memory_bytes,
        row.has_failed() ? "" : CsvField(row.job.output), row.sha256);
  }
  return csv;
}

Json SummaryJson(const std::vector<BatchRow>& rows) {
  Json maps = Json::array();
  for (const BatchRow& row : rows) {
    Json counts = Json::object();
    for (const auto& [name, number] : row.counts) counts[name] = number;
    maps.push_back({{"name", row.job.name},
                    {"input", row.job.input},
                    {"sha256", row.sha256},
                    {"status", row.status},
                    {"exit_code", row.exit_code},
                    {"message", row.message},
                    {"counts", std::move(counts)},
                    {"warnings", row.warnings},
                    {"seconds", row.seconds},
                    {"peak_memory_bytes", row.peak_memory_bytes},
                    {"output", row.has_failed() ? "" : row.job.output},
                    {"result", row.job.result},
                    {"log", row.job.log}});
  }
  return maps;
}

std::string FormatSummaryPage(const std::vector<BatchRow>& rows) {
  std::string failures, maps;
  size_t num_failed = 0;
  for (const BatchRow& row : rows) {
    if (!row.has_failed()) {
      maps += FigureMarkup(row);
      continue;
    }
    ++num_failed;
    absl::StrAppend(&failures, "<p class=\"failed\"><b>",
                    EscapeMarkup(row.job.name), "</b> ",
                    EscapeMarkup(row.status), ": ", EscapeMarkup(row.message),
                    "<br/><span class=\"small\">", EscapeMarkup(row.job.input),
                    "; log: ", EscapeMarkup(row.job.log), "</span></p>\n");
  }
  std::string page = absl::StrCat(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
      "<meta name=\"viewport\" content=\"width=device-width\"/>"
      "<title>Batch of ",
      rows.size(), " maps</title><style>", kSummaryStyle,
      "</style></head><body>\n<h1>", rows.size(), " maps, ", num_failed,
      " failed</h1>\n<p class=\"small\">",
      EscapeMarkup(VersionLine("cartographer_sdf")), "</p>\n");
  if (num_failed > 0) {
    absl::StrAppend(&page, "<h2>Failures</h2>\n", failures);
  }
  return absl::StrCat(page, "<h2>Maps</h2>\n<div class=\"maps\">\n", maps,
                      "</div>\n</body></html>\n");
}

std::string FormatFailures(const std::vector<BatchRow>& rows) {
  std::string text;
  for (const BatchRow& row : rows) {
    if (row.has_failed()) absl::StrAppend(&text, row.job.input, "\n");
  }
  return text;
}

}  // namespace cartographer_sdf
