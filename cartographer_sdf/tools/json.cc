// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/json.h"

#include <cmath>
#include <string_view>

#include "absl/strings/str_format.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kLineLength = 100;
constexpr size_t kIndent = 2;

// Bytes that are not ASCII become question marks: paths need not be UTF-8.
std::string Quoted(const std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20) {
      quoted += absl::StrFormat("\\u%04x", byte);
    } else {
      quoted += byte < 0x7f ? c : '?';
    }
  }
  return quoted + "\"";
}

}  // namespace

Json::Json(const char* const text) : scalar_(Quoted(text)) {}
Json::Json(const std::string& text) : scalar_(Quoted(text)) {}
Json::Json(const int number) : scalar_(std::to_string(number)) {}
Json::Json(const double number) {
  if (std::isfinite(number)) scalar_ = absl::StrFormat("%.12g", number);
}
Json::Json(const bool value) : scalar_(value ? "true" : "false") {}

Json Json::Null() { return Json(); }

Json Json::Object(Members members) {
  Json json;
  json.kind_ = Kind::kObject;
  json.members_ = std::move(members);
  return json;
}

Json Json::Array(std::vector<Json> elements) {
  Json json;
  json.kind_ = Kind::kArray;
  for (Json& element : elements) {
    json.members_.emplace_back("", std::move(element));
  }
  return json;
}

std::string Json::FormatOnOneLine() const {
  if (kind_ == Kind::kScalar) return scalar_;
  std::string text = kind_ == Kind::kObject ? "{" : "[";
  for (size_t i = 0; i < members_.size(); ++i) {
    if (i > 0) text += ", ";
    if (kind_ == Kind::kObject) text += Quoted(members_[i].first) + ": ";
    text += members_[i].second.FormatOnOneLine();
  }
  return text + (kind_ == Kind::kObject ? "}" : "]");
}

void Json::Append(const size_t indent, const size_t column,
                  std::string* const text) const {
  const std::string line = FormatOnOneLine();
  if (kind_ == Kind::kScalar || column + line.size() <= kLineLength) {
    *text += line;
    return;
  }
  *text += kind_ == Kind::kObject ? "{" : "[";
  for (size_t i = 0; i < members_.size(); ++i) {
    *text += (i > 0 ? ",\n" : "\n") + std::string(indent + kIndent, ' ');
    const std::string name =
        kind_ == Kind::kObject ? Quoted(members_[i].first) + ": " : "";
    *text += name;
    members_[i].second.Append(indent + kIndent, indent + kIndent + name.size(),
                              text);
  }
  *text +=
      "\n" + std::string(indent, ' ') + (kind_ == Kind::kObject ? "}" : "]");
}

std::string Json::Format() const {
  std::string text;
  Append(0, 0, &text);
  return text + "\n";
}

}  // namespace cartographer_sdf
