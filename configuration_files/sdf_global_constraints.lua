-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- The options of cartographer_sdf that users change, with their defaults: good
-- for a lidar of 20 to 40 m and submaps of 5 cm. sdf_advanced_options.lua has
-- the others. To change some, write a file beside this one:
--
--   include "sdf_global_constraints.lua"
--   local recognition = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition
--   recognition.match.verification.judgement.min_score = 5.
--   return SDF_GLOBAL_CONSTRAINTS
--
-- and name it by --configuration_directory and --configuration_basename.

include "sdf_advanced_options.lua"

local loop_closing = SDF_GLOBAL_CONSTRAINTS.loop_closing

-- When a pose of two submaps is accepted. Scores are log-odds of being right.
local judgement = loop_closing.recognition.match.verification.judgement
-- Least score. Larger: fewer wrong matches, fewer matches.
judgement.min_score = 3.
-- A pair with another pose whose score comes nearer than this is ambiguous.
-- Larger: more pairs are refused where rooms look alike.
judgement.min_margin = 0.7
-- Largest fraction of wall points in the other submap's free space. Larger:
-- tolerates more moved furniture, and more wrong matches.
judgement.max_contradiction_ratio = 0.1

-- Which pairs of submaps are compared.
local recognition = loop_closing.recognition
-- Submaps of one trajectory are matched from this difference of their indices
-- on; nearer ones share scans.
recognition.min_index_gap = 3
-- Whether an index of all features proposes the pairs to match. false: every
-- pair is matched; finds a little more, and time grows with the square of the
-- number of submaps.
recognition.use_retrieval = false
-- Whether matches are verified together with the neighbours of both submaps,
-- which resolves perceptual aliasing and finds what a pair's own features do
-- not. false: each pair alone; faster.
recognition.verify_neighbourhoods = true

-- Which closures enter the pose graph.
local closing = loop_closing.closing
-- Whether submaps are looked for that local SLAM tore, so that walls stand in
-- them twice: their closures have zero weight and need the support of others.
closing.detect_torn_submaps = true
-- Drift of local SLAM: of its rotation [rad / sqrt(m)] and of its translation
-- [m / m]. Larger: fewer closures are found inconsistent with each other.
closing.consistency.rotation_sigma_per_sqrt_meter = 0.01
closing.consistency.translation_sigma_per_meter = 0.01
-- Least score of a closure that no other supports.
closing.consistency.min_unsupported_score = 5.
-- A closure whose scans yield fewer constraints is refused.
closing.constraints.min_num_constraints = 3
-- As Cartographer's POSE_GRAPH.constraint_builder.loop_closure_*_weight.
-- Larger: closures pull harder.
closing.constraints.translation_weight = 1.1e4
closing.constraints.rotation_weight = 1e5
-- Whether the odometry weights are taken from the map, whose poses show with
-- which ones it was optimised, and not from closing.optimization.
closing.infer_odometry_weights = true
-- [m] Closures that the optimised map contradicts by more are taken out.
closing.outlier_rejection.max_translation_error_meters = 0.3

-- When a map, or the beginning of a drive, counts as localised in another map
-- (relocalize, merge, live); log-odds.
local placement = SDF_GLOBAL_CONSTRAINTS.localization.placement
-- Least evidence of all submaps. Larger: fewer answers, fewer wrong ones.
placement.min_score = 6.5
-- Least lead over the best other answer. Larger: more refusals where places
-- look alike.
placement.min_lead = 4.

-- [m] Cells of grids drawn from scans; as those of the map.
SDF_GLOBAL_CONSTRAINTS.scan_places.resolution_meters = 0.05

-- Largest fraction of the overlapping pairs of submaps that may contradict each
-- other in a merged map; more is a fold, and refused. Larger: tolerates more
-- change between the maps.
SDF_GLOBAL_CONSTRAINTS.fold_check.max_folded_fraction = 0.2

-- Closures beyond it are listed in reports without a picture. More: larger
-- pages.
SDF_GLOBAL_CONSTRAINTS.report.max_closure_pictures = 60

return SDF_GLOBAL_CONSTRAINTS
