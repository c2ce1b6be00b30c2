// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What walls and free space say of a pose of two submaps that comes from
// elsewhere: a placement, or an optimised map.

#ifndef CARTOGRAPHER_SDF_SESSIONS_POSE_CHECK_H_
#define CARTOGRAPHER_SDF_SESSIONS_POSE_CHECK_H_

#include <optional>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/place.h"

namespace cartographer_sdf {

// Observed [m^2].
[[nodiscard]] double ObservedArea(const Place& place);

// Whether the pose lays enough of the two over each other to tell: a fraction
// of the smaller observed area.
[[nodiscard]] bool Overlap(const Place& reference, const Place& query,
                           const Rigid2& T_reference_query);

// The match at the pose, moved by no more than these [m], [rad] (at the middle
// of the query), where verification accepts it. Other poses of the pair are not
// looked for.
[[nodiscard]] std::optional<Match> VerifyPose(
    const MatchOptions& options, const Place& reference, const Place& query,
    const Rigid2& T_reference_query, double max_distance, double max_rotation);

// The pose, as registration mends it, where walls of either stand in the free
// space of the other nonetheless: more than this fraction of them, in the mean
// of both directions. Its verdict is kContradicted. None where they do not.
[[nodiscard]] std::optional<Match> FindContradiction(
    const MatchOptions& options, double max_contradiction_ratio,
    const Place& reference, const Place& query,
    const Rigid2& T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SESSIONS_POSE_CHECK_H_
