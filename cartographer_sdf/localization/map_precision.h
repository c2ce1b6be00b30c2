// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_MAP_PRECISION_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_MAP_PRECISION_H_

namespace cartographer_sdf {

// What a map is off by itself, from one place to the next: standard deviations,
// about half a cell [m], and what that turns a wall of 6 m [rad]. No pose in it
// is more certain.
constexpr double kMapTranslationSigma = 0.03;
constexpr double kMapRotationSigma = 0.005;

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_MAP_PRECISION_H_
