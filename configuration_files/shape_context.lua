-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- The method that the paper compares itself with (Millane et al. 2019, Sec.
-- V-A): curvature clusters and shape contexts, Table I, matched as the paper's
-- own features are. For comparison, by `match --method shape_context`:
-- close_loops refuses it.

include "paper.lua"

local place = SDF_GLOBAL_CONSTRAINTS.shape_context
place.cloud.max_num_scans = 30
place.keypoint.detection_threshold = 0.05
place.descriptor.radius_meters = 2.
place.descriptor.num_radial_bins = 3
place.descriptor.num_angular_bins = 6

local match = SDF_GLOBAL_CONSTRAINTS.loop_closing.match
match.correspondence.max_ratio = 0.75
-- Corners make fewer features than free space does; on the maps that the
-- project develops with, no wrong answer to a pair had as many inliers but on
-- the corridors of MIT Killian Court.
match.min_num_inliers = 6

return SDF_GLOBAL_CONSTRAINTS
