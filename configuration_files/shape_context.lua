-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- The paper's baseline (Millane et al. 2019, Sec. V-A): curvature clusters and
-- shape contexts, Table I, matched in the same way as the paper's own features.
-- For comparison, with `match --method shape_context`; close_loops refuses it.

include "paper.lua"

-- Curvature clusters of point clouds (Bosse and Zlot 2009), described by shape
-- contexts (Belongie et al. 2002).
SDF_GLOBAL_CONSTRAINTS.shape_context = {
  cloud = {
    -- Scans used per submap. Larger: denser clouds, slower.
    max_num_scans = 30,
    -- [m] Points in one square of this side are merged into one.
    voxel_size_meters = 0.05,
  },
  keypoint = {
    -- [m] Radius of the neighbourhood that curvature is measured in. Larger:
    -- small corners blur.
    scatter_radius_meters = 0.4,
    -- Points with fewer neighbours do not belong to a surface.
    min_num_neighbours = 5,
    -- Least curvature, 0 to 0.5. Larger: fewer, sharper keypoints.
    detection_threshold = 0.05,
    -- [m] Points of high curvature this close together form one keypoint.
    cluster_radius_meters = 0.4,
    -- Clusters of fewer points are noise.
    min_num_points = 3,
  },
  descriptor = {
    -- [m] Radius of the surroundings that are described.
    radius_meters = 2.,
    -- Each bin reaches twice as far as the one inside it.
    num_radial_bins = 3,
    num_angular_bins = 6,
    -- [m] Points within it determine the keypoint's orientation.
    orientation_radius_meters = 1.,
  },
}

local match = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.match
match.correspondence.max_ratio = 0.75
-- Corners yield fewer features than free space. On the project's development
-- maps, no wrong answer to a pair had this many inliers, except in the
-- corridors of MIT Killian Court.
match.min_num_inliers = 6

return SDF_GLOBAL_CONSTRAINTS
