// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/json.h"

namespace cartographer_sdf {

std::string FormatJson(const Json& json) {
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', /*ensure_ascii=*/false,
                   Json::error_handler_t::replace) +
         "\n";
}

Json ToJson(const Rigid2& pose) {
  return {{"x", pose.translation().x()},
          {"y", pose.translation().y()},
          {"yaw", pose.rotation()}};
}

Json ToJson(const SubmapId& id) {
  return {{"trajectory", id.trajectory}, {"index", id.index}};
}

}  // namespace cartographer_sdf
