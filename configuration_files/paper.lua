-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- The method as published (Millane et al. 2019): Table I, and our choices where
-- the paper gives no value (docs/design/). For comparison, with
-- `match --method paper`; close_loops refuses it, because counting inliers does
-- not verify a match.

include "sdf_global_constraints.lua"

local place = SDF_GLOBAL_CONSTRAINTS.loop_closing.place
place.keypoint.detection_threshold = 0.0025
place.descriptor.radius_meters = 0.8
place.descriptor.num_bins = 17
place.descriptor.distance_weight = 0.002
place.descriptor.secondary_orientation_ratio = 1.

local match = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.match
match.method = "paper"
match.correspondence.num_neighbours = 1
match.correspondence.use_ratio_test = true
match.correspondence.max_ratio = 0.75
-- The paper tells distances apart by the descriptor's last entry alone.
match.correspondence.max_clearance_difference_meters = 1e6
-- The paper compares every pair of submaps.
SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.use_retrieval = false

return SDF_GLOBAL_CONSTRAINTS
