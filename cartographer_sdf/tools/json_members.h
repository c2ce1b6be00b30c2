// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Members of JSON that another process wrote, and that may lack any of them.

#ifndef CARTOGRAPHER_SDF_TOOLS_JSON_MEMBERS_H_
#define CARTOGRAPHER_SDF_TOOLS_JSON_MEMBERS_H_

#include <string>

#include "cartographer_sdf/report/json.h"

namespace cartographer_sdf {

// Null where there is none.
[[nodiscard]] inline Json MemberOf(const Json& json, const char* const name) {
  if (!json.is_object()) return nullptr;
  const auto member = json.find(name);
  return member == json.end() ? Json() : *member;
}

// Empty where there is no text of this name.
[[nodiscard]] inline std::string TextOf(const Json& json,
                                        const char* const name) {
  const Json member = MemberOf(json, name);
  return member.is_string() ? member.get<std::string>() : "";
}

// Zero where there is no number of this name.
[[nodiscard]] inline double NumberOf(const Json& json, const char* const name) {
  const Json member = MemberOf(json, name);
  return member.is_number() ? member.get<double>() : 0.;
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_JSON_MEMBERS_H_
