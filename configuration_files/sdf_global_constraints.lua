-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- All options of cartographer_sdf with their defaults, good for a lidar of 20
-- to 40 m and submaps of 5 cm. To change some, write a file beside it:
--
--   include "sdf_global_constraints.lua"
--   SDF_GLOBAL_CONSTRAINTS.loop_closing.match.verification.min_score = 5.
--   return SDF_GLOBAL_CONSTRAINTS
--
-- and name it by --configuration_directory and --configuration_basename.

SDF_GLOBAL_CONSTRAINTS = {
  loop_closing = {
    -- How a submap is described.
    place = {
      field = {
        -- Cells above are walls. Cartographer's hits start at 0.55.
        occupied_probability = 0.5,
        -- [m] How far the distance field reaches beyond the submap.
        padding_meters = 0.6,
      },
      keypoint = {
        -- [cells] Gaussian before differentiation. Larger: fewer, smoother
        -- keypoints.
        smoothing_sigma_cells = 3.,
        -- [1 / cells^2] Least |determinant of the Hessian|. Larger: fewer, more
        -- distinctive keypoints.
        detection_threshold = 0.0025,
        -- [cells] Least distance between keypoints, along either axis.
        non_maximum_suppression_cells = 4,
        -- [cells] No keypoints this near to where free space meets the unknown.
        unobserved_border_cells = 1.5,
        -- [m] No keypoints farther from walls. Smaller: free space counts for
        -- less.
        max_clearance_meters = 1000.,
      },
      descriptor = {
        -- [m] Window around a keypoint. Larger: more distinctive, less often
        -- the same from another side.
        radius_meters = 0.8,
        -- Bins of the histogram of relative gradient orientations.
        num_bins = 17,
        -- Bins of the histogram that finds the dominant orientation.
        num_orientation_bins = 36,
        -- [1 / mm] Of the mean distance beside a histogram of length 1. Larger:
        -- places of other width are told apart more sharply.
        distance_weight = 0.002,
        -- Standard deviation of the window's Gaussian, of the radius.
        gaussian_sigma_ratio = 0.5,
        -- Peaks of the orientation histogram above this fraction of the highest
        -- are features of their own. 1: the highest alone.
        secondary_orientation_ratio = 1.,
      },
    },
    -- How a pair of submaps is matched.
    match = {
      -- "sdf", or "paper": ratio test, RANSAC and the number of inliers, as
      -- published (see paper.lua).
      method = "sdf",
      correspondence = {
        -- Per feature, nearest in descriptor space. Larger: more recall, slower.
        num_neighbours = 5,
        -- Whether features without a clearly nearest neighbour are dropped.
        use_ratio_test = false,
        max_ratio = 0.75,
        -- Whether a maximum matches maxima only, and so on.
        same_kind_only = true,
        -- [m] Features whose distance to walls differs by more do not match.
        max_clearance_difference_meters = 0.2,
      },
      -- Poses that many pairs of correspondences vote for.
      hypotheses = {
        -- Larger: more recall, slower.
        max_num_hypotheses = 80,
        -- The best ones that are paired. Time grows with the square.
        max_num_correspondences = 400,
        -- [m] Tolerance of the distance between two keypoints.
        max_length_difference_meters = 0.2,
        -- [rad] Tolerance of the keypoints' orientations.
        max_orientation_difference = 0.44,
        -- [m] Nearer keypoints fix no rotation.
        min_baseline_meters = 1.5,
        -- [m], [rad] Poses this near count as one.
        cluster_distance_meters = 0.5,
        cluster_rotation = 0.1,
      },
      verification = {
        -- Which hypotheses are worth refining: first on few wall points, then
        -- on more.
        ranking = {
          num_coarse_points = 40,
          num_fine_points = 200,
          num_coarse_survivors = 25,
          num_refined = 8,
          -- [m] Walls this near to each other agree.
          hit_distance_meters = 0.3,
          -- [m] Walls this deep in the other's free space contradict.
          contradiction_distance_meters = 0.5,
          -- A contradiction counts so many times as much as a hit.
          contradiction_weight = 2.,
          -- (hits - weight * contradictions) / points. Larger: faster, less
          -- recall.
          min_coarse_score = 0.2,
          min_fine_score = 0.45,
          -- Hypotheses worse than the best by more are not refined. Larger:
          -- slower, more rivals are noticed.
          max_fine_score_gap = 0.25,
        },
        -- Refinement of a pose on the distance fields.
        registration = {
          num_iterations = 12,
          -- [m] Residuals beyond it hardly count, in the first and in the last
          -- iteration.
          initial_kernel_scale_meters = 0.4,
          final_kernel_scale_meters = 0.15,
          -- Wall points of each submap. Larger: more precise, slower.
          max_num_points = 300,
        },
        -- The final judgement, as in ranking.
        agreement = {
          hit_distance_meters = 0.15,
          contradiction_distance_meters = 0.25,
          -- Whether walls and free space count by how certain they are.
          weigh_by_certainty = true,
        },
        -- Wall points of each submap for it.
        num_agreement_points = 2000,
        -- Score = log-odds of being right. Learned by scripts/learn_score.py on
        -- Intel, ACES, Killian Court, Willow Garage and two simulated offices.
        score_weights = {
          -- Of the fraction of wall points in the other's free space.
          contradiction_ratio = -99.5,
          -- Of ln(0.05 + fraction of the smaller area that both saw).
          log_overlap = 2.32,
          -- Of the number of places, squares of 2 m, whose walls agree.
          wall_evidence = 0.8,
          -- Of how evenly the walls face all ways.
          sqrt_scatter_eigenvalue = 10.,
          -- Of the lead over the best distinct pose.
          margin = 1.04,
          bias = -4.67,
        },
        -- [m^2] Least area seen by both.
        min_overlap_area = 10.,
        -- Largest fraction of wall points in the other's free space.
        max_contradiction_ratio = 0.1,
        -- 0: walls face one way only (a corridor); 0.5: all ways.
        min_scatter_eigenvalue = 0.03,
        -- Least score. Larger: fewer wrong matches, fewer matches.
        min_score = 3.,
        -- A pair with a second pose that is nearly as good is ambiguous. Larger:
        -- more pairs are.
        min_margin = 0.7,
      },
      -- [m] Keypoints this near under the final pose are reported as inliers.
      inlier_distance_meters = 0.3,
      -- These only for method "paper".
      ransac = {
        max_num_iterations = 2000,
        -- [m]
        inlier_distance_meters = 0.3,
        min_baseline_meters = 1.,
      },
      min_num_inliers = 12,
      -- Of everything random, which is RANSAC alone.
      seed = 42,
    },
    -- Submaps of one trajectory are matched from this difference of their
    -- indices on; nearer ones share scans.
    min_index_gap = 3,
    -- Whether only those pairs are matched that an index of all features
    -- proposes. false: every pair, the time of which grows with the square of
    -- the number of submaps. `match` has the flag --retrieval instead.
    use_retrieval = false,
    retrieval = {
      -- Per feature, nearest of the whole map. Larger: more recall, slower.
      num_neighbours = 100,
      -- [m] Features whose distance to walls differs by more are none.
      max_clearance_difference_meters = 0.2,
      -- Poses that pairs of neighbours in one submap vote for; as in
      -- match.hypotheses.
      votes = {
        max_num_correspondences = 250,
        -- [m], [rad]
        max_length_difference_meters = 0.25,
        max_orientation_difference = 0.35,
        min_baseline_meters = 1.,
        -- [m], [rad] Pitch of the raster that gathers the votes.
        bin_distance_meters = 0.75,
        bin_rotation = 0.2,
      },
      -- Submaps with a lower score are not matched. Larger: faster, less recall.
      min_score = 0.04,
      -- But so many always are, and never more.
      min_num_candidates = 10,
      max_num_candidates = 200,
      -- Poses that come with each.
      max_num_hypotheses = 3,
    },
    -- Whether matches are judged again by the neighbours of both submaps, where
    -- local SLAM places them: tells twins apart, and finds what a pair's own
    -- features do not. false: each pair alone, faster. `match` has the flag
    -- --alone.
    ask_neighbours = true,
    neighbourhood = {
      -- Neighbours on each side, and how far apart their indices are. Every
      -- other submap shares no scans. Larger: more evidence, slower.
      num_steps = 2,
      index_step = 2,
      -- [m^2] Two neighbours that see less in common are not asked.
      min_overlap_area = 15.,
      -- Wall points of each neighbour. Larger: more precise, slower.
      num_points = 600,
      -- [m] A match is judged as if its neighbours had seen this much wall more
      -- in common ...
      prior_wall_length_meters = 50.,
      -- ... of which this part contradicts. Larger: agreement counts for more.
      prior_contradiction_ratio = 0.05,
      -- Matches of a lower score of their own are not looked at.
      min_pair_score = -5.,
      -- From this score on a match proposes poses to neighbouring pairs. Larger:
      -- faster, less recall.
      min_proposing_score = 0.,
      -- Score = log-odds of being right. Learned by scripts/learn_score.py
      -- --neighbours on the same maps as score_weights.
      weights = {
        -- Of the pair's own score.
        pair_score = 0.515,
        -- Of the logarithm of the neighbours' contradicting part of wall.
        log_contradiction = -5.57,
        bias = -0.633,
      },
      -- Neighbours raise a pair's own score by no more than this. Larger: more
      -- matches whose own walls hardly agree.
      max_gain = 3.,
    },
    -- Whether closures of submaps that local SLAM tore, so that walls stand in
    -- them twice, say nothing of others and need the support of others. Reads
    -- all scans of the map.
    silence_torn_submaps = true,
    -- What counts as torn. Agreement is the ratio of hits less twice that of
    -- contradictions.
    tear = {
      -- Parts of equally many scans that are compared with each other. Larger:
      -- finds slips near a submap's ends, but fewer walls are seen twice.
      num_parts = 6,
      -- [m] Cells of the grids that the parts are drawn into.
      resolution_meters = 0.1,
      -- [m] Points farther from the robot are left out.
      max_range_meters = 30.,
      -- Wall cells that two parts must have in common.
      min_num_points = 50,
      -- How much better two parts must agree once one is moved. Lower: finds
      -- smaller tears, and takes moved doors and people for some.
      min_gain = 0.6,
      -- How well they must agree then.
      min_agreement = 0.7,
      -- [m], [rad] The move must be one of these at least.
      min_translation_meters = 0.2,
      min_rotation = 0.035,
    },
    -- Which closures believe each other, by cycles with the odometry between.
    consistency = {
      -- [rad / sqrt(m)] Drift of local SLAM. Larger: fewer contradictions.
      rotation_sigma_per_sqrt_meter = 0.01,
      -- [m / m]
      translation_sigma_per_meter = 0.01,
      -- [m], [rad] Of a closure.
      closure_translation_sigma_meters = 0.15,
      closure_rotation_sigma = 0.02,
      -- Cycles that fail to close by more standard deviations contradict.
      max_mahalanobis_distance = 4.03,
      -- [m] Cycles less certain than this are not asked.
      max_cycle_sigma_meters = 1.,
      -- A closure that no other supports needs this score.
      min_unsupported_score = 5.,
      -- Sum of the scores that counts as support.
      min_support = 8.,
    },
    -- How a closure becomes constraints between submaps and nodes.
    lifting = {
      -- Nodes of each of the two submaps. Larger: a stronger, smoother pull.
      num_nodes_per_submap = 5,
      -- As Cartographer's POSE_GRAPH.constraint_builder.loop_closure_*.
      translation_weight = 1.1e4,
      rotation_weight = 1e5,
      -- [m], [rad] How far a node may be off within its submap.
      translation_sigma_meters = 0.1,
      rotation_sigma = 0.02,
      -- A scan that would move its node farther, ...
      max_num_sigmas = 3.,
      -- ... or that has fewer points on walls, gives no constraint.
      min_hit_ratio = 0.6,
    },
    -- As Cartographer's POSE_GRAPH.optimization_problem, with its defaults. Use
    -- the weights that the map was made with: others bend it.
    optimization = {
      huber_scale = 1e1,
      local_slam_pose_translation_weight = 1e5,
      local_slam_pose_rotation_weight = 1e5,
      odometry_translation_weight = 1e5,
      odometry_rotation_weight = 1e5,
      max_num_iterations = 200,
    },
    -- Whether the odometry weights are taken from the map instead, whose poses
    -- show with which ones it was optimised.
    infer_odometry_weights = true,
    -- A closure that the optimised map contradicts by more is taken out, and
    -- the rest optimised again.
    withdrawal = {
      -- [m], [rad]
      max_translation_error_meters = 0.3,
      max_rotation_error = 0.052,
      max_num_rounds = 10,
    },
  },
  -- The comparison method: curvature clusters of point clouds (Bosse and Zlot
  -- 2009), described by shape contexts (Belongie et al. 2002). Only for
  -- `--method shape_context`, whose matching shape_context.lua sets.
  shape_context = {
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
  },
  -- Where a map, or the beginning of a drive, lies in another map (relocalize,
  -- merge). What is not here is as in loop_closing.
  relocalization = {
    -- When agreeing matches of submaps are believed.
    placement = {
      -- [m] Places nearer together tell partly the same. Larger: more must be
      -- seen.
      independent_distance_meters = 10.,
      -- One place counts at most so much (log-odds).
      max_place_score = 10.,
      -- Least evidence of all places (log-odds). Larger: fewer answers, fewer
      -- wrong ones.
      min_score = 6.5,
      -- Least lead over the best other answer (log-odds). Larger: more refusals
      -- where places look alike.
      min_lead = 4.,
      -- Largest fraction of the places that may contradict the answer. Larger:
      -- tolerates more change since the map was made.
      max_contradicting_fraction = 0.3,
      -- [m], [rad] Answers that differ by less are one. Larger: tolerates more
      -- drift within the map, overlooks nearer look-alikes.
      same_distance_meters = 1.,
      same_rotation = 0.2,
      -- [m^2] Area that must have been seen at least, submap by submap.
      min_observed_area = 20.,
    },
    -- Places that are made of scans: of the first seconds of a drive, and of
    -- maps without submaps.
    scan_places = {
      -- Scans of each; as Cartographer's 2 * num_range_data.
      num_scans = 120,
      -- [m] Side of a cell; as that of the map.
      resolution_meters = 0.05,
      -- As Cartographer's probability_grid_range_data_inserter.
      hit_probability = 0.55,
      miss_probability = 0.49,
    },
    -- Places, evenly spaced, that are searched in the map at first; twice as
    -- many in all each time that leaves the answer uncertain. Larger: slower
    -- where few are enough.
    num_first_places = 2,
    -- Pairs of submaps that are verified where the answer lays them over each
    -- other. Larger: more is known for and against it, slower.
    max_num_confirmed_pairs = 50,
  },
  -- Several maps as one (merge). What is not here is as above.
  merging = {
    -- Submaps whose walls stand in each other's free space by more than this
    -- fraction contradict each other. Larger: tolerates more change between the
    -- maps.
    max_contradiction_ratio = 0.05,
    -- Largest fraction of the overlapping pairs of submaps of two maps that may
    -- contradict each other in the merged map; more is a fold, and refused.
    -- Larger: tolerates more change between the maps.
    max_folded_fraction = 0.2,
  },
  -- Which constraints of a map are doubtful (audit). What is not here is as in
  -- loop_closing.
  audit = {
    -- [m], [rad] Constraints of a pair of submaps that put it no farther apart
    -- are judged together.
    grouping = {
      max_distance_meters = 0.5,
      max_rotation = 0.15,
    },
    -- Larger ratio of wall points in the other's free space: contradicted.
    -- Smaller: finds more wrong constraints, drops more right ones.
    max_contradiction_ratio = 0.1,
    -- A pose that is better than any other of its pair by less is ambiguous
    -- (log-odds; negative: another one is better).
    min_margin = 0.,
    -- Least score; log-odds. Larger: more constraints need support by others.
    min_score = 0.,
    -- [m], [rad] What is doubtful stays where the map that is made without it
    -- agrees to this. Larger: fewer right constraints are dropped.
    max_agreeing_translation_meters = 0.3,
    max_agreeing_rotation = 0.1,
    -- What that map contradicts by more is doubtful, too. Smaller: finds
    -- smaller errors, drops more right ones.
    withdrawal = {
      -- [m], [rad]
      max_translation_error_meters = 0.5,
      max_rotation_error = 0.1,
      max_num_rounds = 10,
    },
  },
  -- The HTML page that shows what was done.
  report = {
    -- [pixels] Longer side of the pictures of the whole map.
    map_picture_pixels = 1600,
    -- [pixels] Longer side of the picture of a matched pair.
    closure_picture_pixels = 360,
    -- Closures beyond it are listed without a picture. More: a larger page.
    max_closure_pictures = 60,
  },
}

return SDF_GLOBAL_CONSTRAINTS
