-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- The options that rarely need a change, with their defaults. Those that users
-- do change are in sdf_global_constraints.lua, which includes this file; change
-- these in the same way.

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
    -- Which submaps see the same place.
    recognition = {
      -- How a pair of submaps is matched.
      match = {
        -- "sdf", or "paper": ratio test, RANSAC and the number of inliers, as
        -- published (see paper.lua).
        method = "sdf",
        correspondence = {
          -- Per feature, nearest in descriptor space. Larger: more recall,
          -- slower.
          num_neighbours = 5,
          -- Whether features without a clearly nearest neighbour are dropped.
          use_ratio_test = false,
          max_ratio = 0.75,
          -- Whether maxima match maxima only, saddles saddles, and minima
          -- minima.
          same_kind_only = true,
          -- [m] Features whose distance to walls differs by more do not match.
          max_clearance_difference_meters = 0.2,
        },
        -- Poses that pairs of correspondences vote for.
        hypotheses = {
          -- Larger: more recall, slower.
          max_num_hypotheses = 80,
          votes = {
            -- The best correspondences, which are paired. Time grows with the
            -- square.
            max_num_correspondences = 400,
            -- [m] Tolerance of the distance between two keypoints.
            max_length_difference_meters = 0.2,
            -- [rad] Tolerance of the keypoints' orientations.
            max_orientation_difference = 0.44,
            -- [m] Keypoints closer together than this fix no rotation.
            min_baseline_meters = 1.5,
            -- [m], [rad] Bins of the accumulator of poses.
            bin_distance_meters = 0.5,
            bin_rotation = 0.1,
          },
        },
        verification = {
          -- Which hypotheses are worth refining: a coarse test on few wall
          -- points, then a finer one on more.
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
            -- [m] Scale of the robust kernel in the first and the last
            -- iteration. Larger residuals hardly count.
            initial_kernel_scale_meters = 0.4,
            final_kernel_scale_meters = 0.15,
            -- Wall points of each submap. Larger: more precise, slower.
            max_num_points = 300,
          },
          -- How walls and free space are compared at a refined pose.
          agreement = {
            -- [m] Walls this near to each other agree.
            hit_distance_meters = 0.15,
            -- [m] Walls this deep in the other's free space contradict.
            contradiction_distance_meters = 0.25,
            -- Whether walls and free space count by how certain they are.
            weigh_by_certainty = true,
            -- Wall points of each submap. Larger: more precise, slower.
            max_num_points = 2000,
          },
          -- From the evidence to a verdict.
          judgement = {
            -- Score = log-odds of being right. Learned by
            -- scripts/learn_score.py on Intel, ACES, Killian Court, Willow
            -- Garage and two simulated offices.
            score_weights = {
              -- Of the fraction of wall points in the other's free space.
              contradiction_ratio = -99.5,
              -- Of ln(0.05 + fraction of the smaller observed area that both
              -- observed).
              log_overlap = 2.32,
              -- Of the number of tiles of 2 m whose walls agree.
              wall_evidence = 0.8,
              -- Of how evenly the walls face all directions.
              sqrt_scatter_eigenvalue = 10.,
              -- Of the lead over the best distinct pose.
              margin = 1.04,
              bias = -4.67,
            },
            -- [m^2] Least area observed by both.
            min_overlap_area = 10.,
            -- Smaller eigenvalue of the scatter of wall normals: 0 where walls
            -- face one way only (a corridor), 0.5 where they face all ways.
            min_scatter_eigenvalue = 0.03,
          },
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
        -- Fewer make no match by method "paper".
        min_num_inliers = 12,
        -- Of RANSAC.
        seed = 42,
      },
      retrieval = {
        -- Per feature, nearest of the whole map. Larger: more recall, slower.
        num_neighbours = 100,
        -- [m] Features whose distance to walls differs by more do not match.
        max_clearance_difference_meters = 0.2,
        -- As match.hypotheses.votes.
        votes = {
          max_num_correspondences = 250,
          max_length_difference_meters = 0.25,
          max_orientation_difference = 0.35,
          min_baseline_meters = 1.,
          bin_distance_meters = 0.75,
          bin_rotation = 0.2,
        },
        -- Submaps with a lower score are not matched. Larger: faster, less
        -- recall.
        min_score = 0.06,
        -- The best so many are matched whatever their score, and never more
        -- than max_num_candidates.
        min_num_candidates = 10,
        max_num_candidates = 200,
      },
      -- How the neighbours of both submaps, where local SLAM places them,
      -- verify a match.
      neighbourhood = {
        -- Neighbours on each side, and how far apart their indices are. Every
        -- other submap shares no scans. Larger: more evidence, slower.
        num_steps = 2,
        index_step = 2,
        -- [m^2] Neighbouring pairs that have observed less in common are
        -- skipped.
        min_overlap_area = 15.,
        -- Wall points of each neighbour. Larger: more precise, slower.
        num_points = 600,
        -- [m] Prior: a match is scored as if its neighbourhood had shown this
        -- much more wall ...
        prior_wall_length_meters = 50.,
        -- ... of which this fraction contradicts. Larger: agreement counts for
        -- more.
        prior_contradiction_ratio = 0.05,
        -- The neighbourhood of matches with a lower score of their own is
        -- skipped.
        min_pair_score = -5.,
        -- From this score on a match proposes poses to neighbouring pairs.
        -- Larger: faster, less recall.
        min_proposing_score = 0.,
        -- Score = log-odds of being right. Learned by scripts/learn_score.py
        -- --neighbours on the same maps as score_weights.
        weights = {
          -- Of the pair's own score.
          pair_score = 0.515,
          -- Of the logarithm of the fraction of the neighbours' wall that
          -- contradicts.
          log_contradiction = -5.57,
          bias = -0.633,
        },
        -- The neighbourhood raises a pair's own score by no more than this.
        -- Larger: accepts more matches whose own walls hardly agree.
        max_gain = 3.,
      },
    },
    -- From matches to an optimised pose graph.
    closing = {
      -- What counts as a torn submap. Agreement is the ratio of hits less twice
      -- that of contradictions.
      tear = {
        -- Parts of equally many scans that are compared with each other.
        -- Larger: finds slips near a submap's ends, but fewer walls are seen
        -- twice.
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
        -- How well they must agree at the moved pose.
        min_agreement = 0.7,
        -- [m], [rad] The move must reach one of these.
        min_translation_meters = 0.2,
        min_rotation = 0.035,
      },
      -- Which closures are consistent, by cycles with the odometry between.
      consistency = {
        -- [m], [rad] Of a closure.
        closure_translation_sigma_meters = 0.15,
        closure_rotation_sigma = 0.02,
        -- Cycles that fail to close by more standard deviations are
        -- inconsistent.
        max_mahalanobis_distance = 4.03,
        -- [m] Cycles whose end is less certain than this are not tested.
        max_cycle_sigma_meters = 1.,
        -- Sum of the scores of consistent closures that counts as support.
        min_support = 8.,
      },
      -- How a closure becomes constraints between submaps and nodes.
      constraints = {
        -- Nodes of each of the two submaps. Larger: a stronger, smoother pull.
        num_nodes_per_submap = 5,
        -- [m], [rad] Standard deviations of a node's pose within its submap.
        translation_sigma_meters = 0.1,
        rotation_sigma = 0.02,
        -- A node yields no constraint where registration moves it by more than
        -- so many standard deviations, ...
        max_num_sigmas = 3.,
        -- ... or leaves a smaller fraction of its scan on walls.
        min_hit_ratio = 0.6,
      },
      -- As Cartographer's POSE_GRAPH.optimization_problem, with its defaults.
      -- Use the weights that the map was made with: others bend it.
      optimization = {
        huber_scale = 1e1,
        local_slam_pose_translation_weight = 1e5,
        local_slam_pose_rotation_weight = 1e5,
        odometry_translation_weight = 1e5,
        odometry_rotation_weight = 1e5,
        max_num_iterations = 200,
      },
      -- Closures that the optimised map contradicts are taken out, and the rest
      -- optimised again.
      outlier_rejection = {
        -- [rad]
        max_rotation_error = 0.052,
        max_num_rounds = 10,
      },
    },
  },
  -- Where a map, or the beginning of a drive, lies in another map (relocalize,
  -- merge, live). All else is as in loop_closing.
  localization = {
    -- When a pose in the map is certain.
    placement = {
      -- [m] Submaps closer together than this are partly the same evidence.
      -- Larger: more must be seen.
      independent_distance_meters = 10.,
      -- One match counts at most so much (log-odds).
      max_place_score = 10.,
      -- A submap counts by its best match, and with this fraction of its other
      -- matches. Larger: less must be seen, more look-alikes are believed.
      further_match_weight = 0.,
      -- Largest fraction of the submaps that may contradict the answer. Larger:
      -- tolerates more change since the map was made.
      max_contradicting_fraction = 0.3,
      -- [m], [rad] Answers that differ by less are the same. Larger: tolerates
      -- more drift within the map, overlooks look-alikes close by.
      same_distance_meters = 1.,
      same_rotation = 0.2,
      -- [m^2] Least area seen, summed over the submaps.
      min_observed_area = 20.,
    },
    -- Whether matches count, too, that show too little to be accepted, but are
    -- more likely right than wrong. One must be accepted in any case.
    count_likely_matches = false,
    -- Submaps of the query, evenly spaced, that are searched in the map first;
    -- twice as many each time that leaves the answer uncertain. Larger: slower
    -- where few are enough.
    num_first_places = 2,
    -- Pairs of submaps that are verified where the answer lays them over each
    -- other. Larger: more evidence for and against it, slower.
    max_num_confirmed_pairs = 50,
  },
  -- Grids drawn from scans: of the first seconds of a drive, and of maps
  -- without submaps.
  scan_places = {
    -- Scans of each; as Cartographer's 2 * num_range_data.
    num_scans = 120,
    -- As Cartographer's probability_grid_range_data_inserter.
    hit_probability = 0.55,
    miss_probability = 0.49,
  },
  -- Whether merged maps fold over each other (merge).
  fold_check = {
    -- Submaps whose walls stand in each other's free space by more than this
    -- fraction contradict each other. Larger: tolerates more change between the
    -- maps.
    max_contradiction_ratio = 0.05,
  },
  -- Which constraints of a map are doubtful (audit). All else is as in
  -- loop_closing.
  audit = {
    -- [m], [rad] Constraints of a pair of submaps whose poses differ by less
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
    -- [m], [rad] A doubtful constraint stays where the map that is made without
    -- it agrees to this. Larger: fewer right constraints are dropped.
    max_agreeing_translation_meters = 0.3,
    max_agreeing_rotation = 0.1,
    -- What that map contradicts by more is doubtful too. Smaller: finds smaller
    -- errors, drops more right ones.
    outlier_rejection = {
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
  },
}
