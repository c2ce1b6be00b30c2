// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_JSON_H_
#define CARTOGRAPHER_SDF_TOOLS_JSON_H_

#include <string>
#include <utility>
#include <vector>

namespace cartographer_sdf {

// A value to be written as JSON [RFC 8259].
class Json {
 public:
  using Members = std::vector<std::pair<std::string, Json>>;

  // Implicit, so that objects read like what they become.
  Json(const char* text);         // NOLINT(google-explicit-constructor)
  Json(const std::string& text);  // NOLINT(google-explicit-constructor)
  Json(int number);               // NOLINT(google-explicit-constructor)
  // To twelve digits. Null where it is not finite, which JSON cannot say.
  Json(double number);  // NOLINT(google-explicit-constructor)
  Json(bool value);     // NOLINT(google-explicit-constructor)
  [[nodiscard]] static Json Null();
  // Members keep their order.
  [[nodiscard]] static Json Object(Members members);
  [[nodiscard]] static Json Array(std::vector<Json> elements);

  // Indented; an object or array that fits stays on one line. Ends with a line
  // feed.
  [[nodiscard]] std::string Format() const;

 private:
  enum class Kind { kScalar, kObject, kArray };
  Json() = default;

  [[nodiscard]] std::string FormatOnOneLine() const;
  void Append(size_t indent, size_t column, std::string* text) const;

  Kind kind_ = Kind::kScalar;
  std::string scalar_ = "null";
  // Names are empty in arrays.
  Members members_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_JSON_H_
