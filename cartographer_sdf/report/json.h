// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Results as JSON [RFC 8259], for other programs. Metres and radians; null
// where there is no value. Not installed: programs that link the library use
// the result structs directly.

#ifndef CARTOGRAPHER_SDF_REPORT_JSON_H_
#define CARTOGRAPHER_SDF_REPORT_JSON_H_

#include <optional>
#include <string>
#include <type_traits>

#include "cartographer_sdf/apps/map_quality.h"
#include "cartographer_sdf/apps/merge.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/scan_session.h"
#include "cartographer_sdf/report/run_description.h"
#include "nlohmann/json.hpp"

namespace cartographer_sdf {

// Members keep the order in which they are added.
using Json = nlohmann::ordered_json;

// Indented by two, with a line feed at the end. Takes any value: bytes that are
// not UTF-8 become U+FFFD, numbers that are not finite become null; all others
// read back as the same number.
[[nodiscard]] std::string FormatJson(const Json& json);

// {x, y, yaw}
[[nodiscard]] Json ToJson(const Rigid2& pose);
// Its rows.
[[nodiscard]] Json ToJson(const Eigen::Matrix3d& matrix);
// {trajectory, index}
[[nodiscard]] Json ToJson(const SubmapId& id);

template <typename T>
[[nodiscard]] Json ToJson(const std::optional<T>& value) {
  if (!value.has_value()) return nullptr;
  if constexpr (std::is_constructible_v<Json, const T&>) {
    return *value;
  } else {
    return ToJson(*value);
  }
}

// {program, command, started, inputs}, as in the file of --result.
[[nodiscard]] Json ToJson(const RunDescription& run);

// The file R.json of relocalize.
[[nodiscard]] Json ToJson(const MapQuality& quality);

[[nodiscard]] Json ToJson(const Localization& result);

// The file R.json of relocalize --scan.
[[nodiscard]] Json ToJson(const ScanLocalization& result);

// As of a scan; "localized" where the robot is located.
[[nodiscard]] Json ToJson(const SessionAnswer& answer);

// The outcome of each session, and of each two that were compared.
[[nodiscard]] Json ToJson(const MergingResult& result);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_JSON_H_
