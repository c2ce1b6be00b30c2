-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Options of the searcher beside a live Cartographer, with their defaults: good
-- for a lidar of 20 to 40 m and submaps of 5 cm. The file stands beside
-- Cartographer's own, which must not have these keys. To change some, write a
-- file that includes this one, as described in sdf_global_constraints.lua.

include "sdf_global_constraints.lua"

SDF_LIVE = {
  -- false: Cartographer runs as if we were not there.
  enabled = true,
  -- Whether closures become constraints. false: they are logged and counted.
  inject_constraints = true,
  -- Whether each closure makes a line in the log.
  log_closures = true,
  -- Whether the places of a loaded MAP.pbstream are taken from
  -- MAP.pbstream.places where that fits, and else left there for the next time.
  use_place_files = true,
  -- Submaps of one trajectory are matched from this difference of their indices
  -- on; nearer ones share scans.
  min_index_gap = 3,
  -- As for saved maps, from the description of a submap to its constraints.
  place = SDF_GLOBAL_CONSTRAINTS.loop_closing.place,
  match = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.match,
  retrieval = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.retrieval,
  neighbourhood = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.neighbourhood,
  consistency = SDF_GLOBAL_CONSTRAINTS.loop_closing.closing.consistency,
  constraints = SDF_GLOBAL_CONSTRAINTS.loop_closing.closing.constraints,
  -- Whether matches are verified together with the neighbours of both submaps.
  -- The newest submap has neighbours on one side only.
  verify_neighbourhoods = false,
  -- Where a new trajectory is in a loaded map.
  localization = {
    -- Whether it is asked for every trajectory that starts without a pose.
    enabled = true,
    -- [m] Driving between queries. Smaller: sooner, more CPU time.
    query_interval_meters = 0.5,
    -- [m] Scans of so much driving make the query. Larger: more is seen, and
    -- local SLAM bends more.
    window_meters = 15.,
    -- [m] Cells of the query's grid; best that of the map's submaps.
    resolution_meters = 0.05,
    -- The best so many submaps of the map are matched with the query. Larger:
    -- found sooner, more CPU time.
    max_num_candidates = 50,
    -- As for saved maps, but for what is below.
    localizer = SDF_GLOBAL_CONSTRAINTS.localization,
    -- Queries in a row that must say the same.
    min_num_queries = 2,
    -- [m], [rad] Poses nearer than this count as the same.
    max_translation_difference_meters = 0.5,
    max_rotation_difference = 0.1,
  },
}

-- The best so many places are matched with a new one. Larger: more is found,
-- more CPU time.
SDF_LIVE.retrieval.max_num_candidates = 15

-- A young query is one place, which sees too little for most of its matches to
-- be certain: all matches that may be right add up, and must be more in return.
SDF_LIVE.localization.localizer.count_likely_matches = true
SDF_LIVE.localization.localizer.placement.further_match_weight = 1.
SDF_LIVE.localization.localizer.placement.min_score = 7.

return SDF_LIVE
