-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- The method that the paper compares itself with (Millane et al. 2019, Sec.
-- V-A): curvature clusters and shape contexts, Table I, matched as the paper's
-- own features are. For comparison, by `match --method shape_context`:
-- close_loops refuses it.

include "paper.lua"

-- Curvature clusters of point clouds (Bosse and Zlot 2009), described by shape
-- contexts (Belongie et al. 2002).
SDF_GLOBAL_CONSTRAINTS.shape_context = {
  cloud = {
    -- Scans taken of each submap. Larger: denser clouds, more time.
    max_num_scans = 30,
    -- [m] Points in one square of this side become one.
    voxel_size_meters = 0.05,
  },
  keypoint = {
    -- [m] Points within it say how a surface bends. Larger: small corners
    -- blur.
    scatter_radius_meters = 0.4,
    -- Points with fewer neighbours are no part of a surface.
    min_num_neighbours = 5,
    -- Least curvature, 0 to 0.5. Larger: fewer, sharper keypoints.
    detection_threshold = 0.05,
    -- [m] Points of high curvature this near to each other are one keypoint.
    cluster_radius_meters = 0.4,
    -- Clusters of fewer points are noise.
    min_num_points = 3,
  },
  descriptor = {
    -- [m] How much of the surroundings is described.
    radius_meters = 2.,
    -- Each reaches twice as far as the one inside it.
    num_radial_bins = 3,
    num_angular_bins = 6,
    -- [m] Points within it fix the direction that the others are seen from.
    orientation_radius_meters = 1.,
  },
}

local match = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.match
match.correspondence.max_ratio = 0.75
-- Corners make fewer features than free space does; on the maps that the
-- project develops with, no wrong answer to a pair had as many inliers but on
-- the corridors of MIT Killian Court.
match.min_num_inliers = 6

return SDF_GLOBAL_CONSTRAINTS
