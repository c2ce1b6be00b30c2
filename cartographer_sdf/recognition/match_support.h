// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Matches that support or oppose each other. A match that is certain by itself
// tells, by local SLAM on either side, where the submaps around its own lie in
// each other. A match of two of them that lies there and is only likely is
// right as well, and supports others in its turn; one without support has to be
// certain itself. One that lies farther off than local SLAM drifts is opposed,
// and refused if far more matches oppose than support it, however certain it
// is: shifts by one rack or one door agree with the walls and disagree with
// what lies around.
//
// Matches that are only likely are certain together where they support each
// other, one of them is accepted, none of them has any rival, and those of them
// that share no scans add up to more than the evidence of a certain one:
// outdoors and in long halls no submap alone shows that much. Where rooms are
// equal every match has rivals, at which its walls do nearly as well, and many
// of them say no more than one.
//
// One threshold for all could not do both. In noisy maps and outdoors, most
// right matches are only likely, but near some that are certain. Between
// different buildings, two bare corners or corridors may be likely, and nothing
// around them is certain.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_MATCH_SUPPORT_H_
#define CARTOGRAPHER_SDF_RECOGNITION_MATCH_SUPPORT_H_

#include <functional>
#include <string>
#include <vector>

#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

struct MatchSupportOptions {
  // Least score of a match that stands alone; log-odds. Such a match is
  // certain. Those of a group must add up to two more.
  double min_unsupported_score = 7.;
  // Least score of a match that others support; log-odds. Above
  // JudgementOptions::min_score it supports in its turn.
  double min_supported_score = 1.;
  // The submaps of a match and of one that supports it are at most so many
  // indices apart, on either side.
  int max_index_distance = 4;
  // A match supports another if the pose that it predicts for the query of the
  // other is this near [m], [rad]. Local SLAM drifts less on so short a way.
  // Beyond one and a half times that, and a hundredth of the way between them,
  // it opposes it.
  double max_distance_meters = 0.5;
  double max_rotation = 0.1;
};
[[nodiscard]] std::string Validate(const MatchSupportOptions& options);

// Sets Match::num_supporting and num_opposing, by the votes of those that are
// certain and what they support. Matches that were accepted and
// are opposed by more than twice as many as support them, or have no support
// and are not certain, become kUncertain; those that were kUnlikely, have
// support, are not opposed by so many, and have no rival become kAccepted.
// Nothing supports or opposes across a broken link (trajectory_links.h).
// `maps.own_matches` is not used. Independent of the order of the matches.
// Linear in their number.
void JudgeBySupport(const MatchSupportOptions& options,
                    const NeighbourhoodMaps& maps, std::vector<Match>* matches);

// Returns the matches, by their indices, of which `may_join` is true, in groups
// that support each other: of two groups none supports one of the other.
[[nodiscard]] std::vector<std::vector<size_t>> FindSupportingGroups(
    const MatchSupportOptions& options, const NeighbourhoodMaps& maps,
    const std::vector<Match>& matches,
    const std::function<bool(const Match&)>& may_join);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_MATCH_SUPPORT_H_
