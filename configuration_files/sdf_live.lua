-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Options of the searcher beside a live Cartographer, with their defaults,
-- which suit a lidar with a range of 20 to 40 m and submaps with cells of 5 cm.
-- This file is separate from Cartographer's own, which must not have these
-- keys. To change options, write a file that includes this one, as described in
-- sdf_global_constraints.lua.

include "sdf_global_constraints.lua"

SDF_LIVE = {
  -- false: Cartographer runs as it does without the searcher.
  enabled = true,
  -- Whether closures become constraints. false: they are only logged and
  -- counted.
  inject_constraints = true,
  -- Whether to log a line for each closure.
  log_closures = true,
  -- Whether to read the places of a loaded MAP.pbstream from
  -- MAP.pbstream.places if that file fits the map and options, and to write it
  -- otherwise.
  use_place_files = true,
  -- Least difference of the indices of two submaps of one trajectory; closer
  -- ones share scans and are not matched.
  min_index_gap = 3,
  -- As for saved maps, from the description of a submap to its constraints.
  place = SDF_GLOBAL_CONSTRAINTS.loop_closing.place,
  match = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.match,
  retrieval = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.retrieval,
  neighbourhood = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.neighbourhood,
  consistency = SDF_GLOBAL_CONSTRAINTS.loop_closing.closing.consistency,
  constraints = SDF_GLOBAL_CONSTRAINTS.loop_closing.closing.constraints,
  -- Whether matches are verified together with the neighbours of both submaps,
  -- by their walls alone. The newest submap has neighbours on one side only.
  verify_neighbourhoods = false,
  -- Localisation of a new trajectory in a loaded map.
  localization = {
    -- Whether to localise every trajectory that starts without a pose.
    enabled = true,
    -- [m] Distance driven between queries. Smaller: localised sooner, more CPU
    -- time.
    query_interval_meters = 0.5,
    -- [m] Length of the driven path whose scans form the query. Larger: more is
    -- seen, but local SLAM drifts more.
    window_meters = 15.,
    -- [m] Cell size of the query's grid; use that of the map's submaps.
    resolution_meters = 0.05,
    -- Number of best submaps of the map to match with the query. Larger:
    -- localised sooner, more CPU time.
    max_num_candidates = 50,
    -- As for saved maps, except for the changes below.
    localizer = SDF_GLOBAL_CONSTRAINTS.localization,
    -- Consecutive queries that must agree.
    min_num_queries = 2,
    -- [m], [rad] Poses that differ by less agree.
    max_translation_difference_meters = 0.5,
    max_rotation_difference = 0.1,
    -- Whether each scan by itself is compared with the whole map, too. true:
    -- robots are found sooner, and noticed to be lost; more CPU time and up to
    -- 30 MB.
    compare_scans = false,
    scan_localization = SDF_GLOBAL_CONSTRAINTS.scan_localization,
    scan_session = SDF_GLOBAL_CONSTRAINTS.scan_session,
  },
}

-- Number of best places to match with a new one. Larger: finds more, more CPU
-- time.
SDF_LIVE.retrieval.max_num_candidates = 15

-- An early query is a single place and sees too little for most of its matches
-- to be certain. So its likely matches count, too, further ones in part, as
-- overlapping submaps of the map share scans; the required total is higher.
SDF_LIVE.localization.localizer.count_likely_matches = true
SDF_LIVE.localization.localizer.placement.further_match_weight = 0.3
SDF_LIVE.localization.localizer.placement.min_score = 7.

return SDF_LIVE
