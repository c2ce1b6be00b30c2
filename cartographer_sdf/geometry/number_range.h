// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Range checks for the Validate functions of options.

#ifndef CARTOGRAPHER_SDF_GEOMETRY_NUMBER_RANGE_H_
#define CARTOGRAPHER_SDF_GEOMETRY_NUMBER_RANGE_H_

#include <initializer_list>
#include <sstream>
#include <string>

namespace cartographer_sdf {

// A number with the least and the largest value allowed.
struct NumberRange {
  template <typename T>
  NumberRange(const char* const name, const T value, const double least,
              const double most)
      : name(name),
        value(static_cast<double>(value)),
        least(least),
        most(most) {}

  const char* name;
  double value;
  double least;
  double most;
};

// Returns "NAME must lie between LEAST and MOST" for the first number out of
// range, or an empty string.
[[nodiscard]] inline std::string FirstOutside(
    const std::initializer_list<NumberRange> ranges) {
  for (const NumberRange& range : ranges) {
    if (range.value >= range.least && range.value <= range.most) continue;
    std::ostringstream sentence;
    sentence << range.name << " must lie between " << range.least << " and "
             << range.most;
    return sentence.str();
  }
  return "";
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GEOMETRY_NUMBER_RANGE_H_
