// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_CONFIG_NEAREST_NAME_H_
#define CARTOGRAPHER_SDF_CONFIG_NEAREST_NAME_H_

#include <optional>
#include <string>
#include <vector>

namespace cartographer_sdf {

// Returns the candidate that `name` most likely misspells: that with the least
// Levenshtein distance, at most a third of the length of `name` (rounded up);
// the first one on ties. None if no candidate is that near.
[[nodiscard]] std::optional<std::string> NearestName(
    const std::string& name, const std::vector<std::string>& candidates);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_NEAREST_NAME_H_
