-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- The options of cartographer_sdf that users change, with their defaults, which
-- suit a lidar with a range of 20 to 40 m and submaps with cells of 5 cm.
-- sdf_advanced_options.lua has the others. To change options, write a file
-- beside this one:
--
--   include "sdf_global_constraints.lua"
--   local recognition = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition
--   recognition.support.min_unsupported_score = 8.
--   return SDF_GLOBAL_CONSTRAINTS
--
-- and pass it with --configuration_directory and --configuration_basename.

include "sdf_advanced_options.lua"

local loop_closing = SDF_GLOBAL_CONSTRAINTS.loop_closing

-- When the relative pose of two submaps is accepted. Scores are log-odds of
-- being right.
local judgement = loop_closing.recognition.match.verification.judgement
-- Least lead over the best other pose of the pair; below it the pair is
-- ambiguous. Larger: more pairs are refused where rooms look alike.
judgement.min_margin = 0.7
-- Largest fraction of wall points in the other submap's free space. Larger:
-- tolerates more moved furniture, and more wrong matches.
judgement.max_contradiction_ratio = 0.25

-- Which pairs of submaps are compared.
local recognition = loop_closing.recognition
-- Least difference of the indices of two submaps of one trajectory; closer ones
-- share scans and are not matched.
recognition.min_index_gap = 3
-- Whether an index of all submaps proposes the pairs to match. false: every pair
-- is matched, which takes time quadratic in the number of submaps; for studies.
recognition.use_retrieval = true
-- Whether matches are verified together with the neighbours of both submaps,
-- which resolves perceptual aliasing and finds matches that a pair's own
-- features miss. false: each pair is verified alone; faster.
recognition.verify_neighbourhoods = true
-- Least score of a match that stands alone; log-odds. From it on, a match
-- supports likely ones around it, which need not reach it. Likely ones that suit
-- no other place and support each other may reach it together. Larger: fewer
-- wrong matches, fewer matches.
recognition.support.min_unsupported_score = 7.

-- Which closures enter the pose graph.
local closing = loop_closing.closing
-- Whether to detect submaps that local SLAM tore, so that walls appear in them
-- twice. Their closures have zero weight and need the support of others.
closing.detect_torn_submaps = true
-- Drift of local SLAM in rotation [rad / sqrt(m)] and in translation [m / m].
-- Larger: fewer closures are found inconsistent with each other.
closing.consistency.rotation_sigma_per_sqrt_meter = 0.01
closing.consistency.translation_sigma_per_meter = 0.01
-- Least score of a closure that no other closure supports.
closing.consistency.min_unsupported_score = 5.
-- Closures whose scans yield fewer constraints are refused.
closing.constraints.min_num_constraints = 3
-- As Cartographer's POSE_GRAPH.constraint_builder.loop_closure_*_weight.
-- Larger: closures pull more strongly.
closing.constraints.translation_weight = 1.1e4
closing.constraints.rotation_weight = 1e5
-- Whether to infer the odometry weights from the map's poses, which show the
-- weights it was optimised with. false: those of closing.optimization.
closing.infer_odometry_weights = true
-- [m] Closures that the optimised map contradicts by more are removed.
closing.outlier_rejection.max_translation_error_meters = 0.3

-- When a map, or the beginning of a drive, counts as localised in another map
-- (relocalize, merge, live); log-odds.
local placement = SDF_GLOBAL_CONSTRAINTS.localization.placement
-- Least total evidence of all submaps. Larger: fewer answers, fewer wrong ones.
placement.min_score = 7.5
-- Least lead over the best other answer. Larger: more refusals where places
-- look alike.
placement.min_lead = 4.

-- [m] Cell size of grids drawn from scans; use that of the map.
SDF_GLOBAL_CONSTRAINTS.scan_places.resolution_meters = 0.05

-- Largest fraction of the overlapping pairs of submaps that may contradict each
-- other in a merged map; with more, the map is considered folded and is
-- refused. Larger: tolerates more change between the maps.
SDF_GLOBAL_CONSTRAINTS.fold_check.max_folded_fraction = 0.2

-- Number of submaps with a picture in a report; pairs of others are only listed.
-- Larger: larger pages.
SDF_GLOBAL_CONSTRAINTS.report.max_submap_pictures = 300

return SDF_GLOBAL_CONSTRAINTS
