-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Options that rarely need a change, with their defaults. The options that
-- users do change are in sdf_global_constraints.lua, which includes this file;
-- change these in the same way.

SDF_GLOBAL_CONSTRAINTS = {
  loop_closing = {
    -- How a submap is described.
    place = {
      field = {
        -- Cells above this probability are walls. Cartographer's hits start at
        -- 0.55.
        occupied_probability = 0.5,
        -- [m] How far the distance field extends beyond the submap.
        padding_meters = 0.6,
      },
      keypoint = {
        -- [cells] Standard deviation of the Gaussian applied before
        -- differentiation. Larger: fewer, smoother keypoints.
        smoothing_sigma_cells = 3.,
        -- [1 / cells^2] Least |determinant of the Hessian|. Larger: fewer, more
        -- distinctive keypoints.
        detection_threshold = 0.0025,
        -- [cells] Least distance between keypoints, along either axis.
        non_maximum_suppression_cells = 4,
        -- [cells] No keypoints closer than this to the border between free and
        -- unobserved cells.
        unobserved_border_cells = 1.5,
        -- [m] Largest distance of a keypoint from walls. Smaller: free space
        -- counts for less.
        max_clearance_meters = 1000.,
      },
      descriptor = {
        -- [m] Radius of the window around a keypoint. Larger: more distinctive,
        -- less repeatable from other viewpoints.
        radius_meters = 0.8,
        -- Bins of the histogram of relative gradient orientations.
        num_bins = 17,
        -- Bins of the histogram that determines the dominant orientation.
        num_orientation_bins = 36,
        -- [1 / mm] Weight of the mean distance relative to a histogram of
        -- length 1. Larger: separates places of different width more sharply.
        distance_weight = 0.002,
        -- Standard deviation of the window's Gaussian, as a fraction of the
        -- radius.
        gaussian_sigma_ratio = 0.5,
        -- Peaks of the orientation histogram above this fraction of the highest
        -- yield additional features. 1: only the highest peak.
        secondary_orientation_ratio = 1.,
      },
      -- [MB] Distance fields of one map that stay in memory; others are made
      -- again when they are needed, with the same results. Smaller: less
      -- memory, slower on large maps.
      max_field_megabytes = 512.,
    },
    -- Recognition of submaps that see the same place.
    recognition = {
      -- How a pair of submaps is matched.
      match = {
        -- "sdf", or "paper": ratio test, RANSAC and the number of inliers, as
        -- published (see paper.lua).
        method = "sdf",
        correspondence = {
          -- Nearest neighbours per feature in descriptor space. Larger: more
          -- recall, slower.
          num_neighbours = 5,
          -- Whether to drop features without a clearly nearest neighbour.
          use_ratio_test = false,
          max_ratio = 0.75,
          -- Whether features match only features of the same kind (maximum,
          -- saddle, minimum).
          same_kind_only = true,
          -- [m] Features whose distance to walls differs by more do not match.
          max_clearance_difference_meters = 0.2,
          -- Kinds of keypoints that match: maxima and saddles in free space,
          -- minima on walls.
          kinds = {
            maxima = true,
            minima = true,
            saddles = true,
          },
        },
        -- Candidate poses from the votes of pairs of correspondences.
        hypotheses = {
          -- Larger: more recall, slower.
          max_num_hypotheses = 80,
          votes = {
            -- Number of best correspondences to pair. Time grows with its
            -- square.
            max_num_correspondences = 400,
            -- [m] Tolerance for the distance between two keypoints.
            max_length_difference_meters = 0.2,
            -- [rad] Tolerance for the keypoints' orientations.
            max_orientation_difference = 0.44,
            -- [m] Keypoints closer together than this do not determine a
            -- rotation.
            min_baseline_meters = 1.5,
            -- [m], [rad] Bins of the accumulator of poses.
            bins = {
              distance_meters = 0.5,
              rotation = 0.1,
            },
          },
        },
        verification = {
          -- Selection of hypotheses to refine: a coarse test on few wall
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
            -- Weight of a contradiction relative to a hit.
            contradiction_weight = 2.,
            -- (hits - weight * contradictions) / points. Larger: faster, less
            -- recall.
            min_coarse_score = 0.2,
            min_fine_score = 0.45,
            -- Hypotheses that score lower than the best by more are not
            -- refined. Larger: slower, detects more rivals.
            max_fine_score_gap = 0.25,
          },
          -- A look at coarsely registered poses, before those that may be the
          -- best or its rivals are registered and measured fully.
          screening = {
            -- Wall points of each submap. Larger: slower, drops fewer poses.
            num_points = 300,
            -- If all poses of a pair score lower, only the best is completed;
            -- log-odds. Smaller: slower.
            min_score = -12.,
            -- Poses that score lower than the best by more are dropped.
            -- Larger: slower, detects more rivals.
            max_score_gap = 8.,
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
          -- Comparison of walls and free space at a refined pose.
          agreement = {
            -- [m] Walls this near to each other agree.
            hit_distance_meters = 0.15,
            -- [m] Walls this deep in the other's free space contradict.
            contradiction_distance_meters = 0.25,
            -- Whether to weight walls and free space by their certainty.
            weigh_by_certainty = true,
            -- Wall points of each submap. Larger: more precise, slower.
            max_num_points = 2000,
          },
          -- Verdict from the evidence.
          judgement = {
            -- Score = log-odds of being right. Learned by
            -- scripts/learn_score.py on Intel, ACES, Killian Court, Willow
            -- Garage and two simulated offices.
            score_weights = {
              -- Of ln(0.02 + fraction of wall points in the other's free space).
              log_contradiction_ratio = -2.1,
              -- Of ln(0.05 + fraction of the smaller observed area that both
              -- observed).
              log_overlap = 1.69,
              -- Of the number of tiles of 2 m whose walls agree.
              wall_evidence = 1.43,
              -- Of how evenly the walls face all directions.
              sqrt_scatter_eigenvalue = 14.7,
              -- Of the lead over the best distinct pose.
              margin = 0.69,
              bias = -15.,
            },
            -- Least score of a match by itself; with its neighbourhood, see
            -- support. Larger: fewer wrong matches, fewer matches.
            min_score = 4.,
            -- [m^2] Least area observed by both.
            min_overlap_area = 10.,
            -- Smaller eigenvalue of the scatter of wall normals: 0 where walls
            -- face one way only (a corridor), 0.5 where they face all ways.
            min_scatter_eigenvalue = 0.03,
          },
          -- What refuses matches between two trajectories, and the answers of
          -- relocalize and merge, where they agree with each other and not with
          -- the walls.
          crossing = {
            -- [m] Two submaps cannot show the same place if a longer straight
            -- wall of one stands across the free space of the other. Larger:
            -- tolerates partitions that were moved.
            max_wall_meters = 3.,
            -- Largest fraction of the pairs of submaps that overlap that such
            -- a wall may cross. Larger: tolerates torn submaps.
            max_crossed_fraction = 0.05,
          },
        },
        -- [m] Keypoints this close under the final pose are reported as
        -- inliers.
        inlier_distance_meters = 0.3,
        -- Only for method "paper".
        ransac = {
          max_num_iterations = 2000,
          -- [m]
          inlier_distance_meters = 0.3,
          min_baseline_meters = 1.,
        },
        -- Least number of inliers of a match by method "paper".
        min_num_inliers = 12,
        -- Random seed of RANSAC.
        seed = 42,
      },
      -- The index that proposes which submaps to match: pairs of keypoints,
      -- stored under their kinds, clearances, distance and relative
      -- orientations.
      retrieval = {
        pairs = {
          -- [m] Keypoints are paired at these distances.
          min_length_meters = 1.5,
          max_length_meters = 8.,
          -- [m], [m], [rad] Bins. Larger: more recall, slower.
          clearance_bin_meters = 0.2,
          length_bin_meters = 0.3,
          orientation_bin = 0.45,
          -- A query also looks into the next bin where it lies within this
          -- fraction of a bin from it. Larger: more recall, slower.
          border_fraction = 0.3,
          -- Kinds of keypoints that are paired, as in correspondence.kinds.
          kinds = {
            maxima = true,
            minima = true,
            saddles = true,
          },
        },
        -- Partners with which each keypoint is stored, and sought. Larger: more
        -- recall, more memory, slower.
        num_stored_partners = 3,
        num_sought_partners = 6,
        -- Pairs stored of a submap (20 bytes each), and sought of a query.
        max_num_stored_pairs = 360,
        max_num_sought_pairs = 1000,
        -- Stored pairs that a query looks at, the rarest first: bounds its time
        -- in large maps.
        max_num_visited_pairs = 100000,
        -- [m], [rad] Bins of the accumulator of poses.
        pose_bins = {
          distance_meters = 0.75,
          rotation = 0.2,
        },
        -- Poses that are tried of each candidate, beside those of the match's
        -- own correspondences.
        max_num_poses = 4,
        -- Submaps with a lower score are not matched. Larger: faster, less
        -- recall.
        min_score = 0.004,
        -- The best min_num_candidates are matched whatever their score, and
        -- never more than max_num_candidates.
        min_num_candidates = 10,
        max_num_candidates = 20,
      },
      -- Where walls show that local SLAM slipped, what it says of submaps on
      -- either side of the slip is not used.
      links = {
        -- Indices between the submaps of a link; those two apart share no
        -- scans.
        index_step = 2,
        -- A link is broken where more of its walls stand in free space.
        -- Smaller: trusts local SLAM less, and so has fewer neighbours.
        max_contradiction_ratio = 0.05,
        -- [m^2] Links with a smaller commonly observed area say nothing.
        min_overlap_area = 10.,
      },
      -- Neighbourhood verification: the neighbours of both submaps, where local
      -- SLAM places them, support or contradict a match.
      neighbourhood = {
        -- Number of neighbours on each side, and the step between their
        -- indices; submaps two indices apart share no scans. Larger: more
        -- evidence, slower.
        num_steps = 2,
        index_step = 2,
        -- [m^2] Neighbouring pairs with a smaller commonly observed area are
        -- skipped.
        min_overlap_area = 15.,
        -- Wall points of each neighbour. Larger: more precise, slower.
        num_points = 600,
        -- [m], [rad] A neighbouring pair's own match confirms the prediction if
        -- it lies this near to it. Larger: bears more drift, and lets matches
        -- that are a little off pass for right.
        max_prediction_error_meters = 1.,
        max_prediction_rotation_error = 0.15,
        -- [m] Prior: a match is scored as if its neighbourhood had shown this
        -- much additional wall ...
        prior_wall_length_meters = 50.,
        -- ... of which this fraction contradicts. Larger: agreement counts for
        -- more.
        prior_contradiction_ratio = 0.05,
        -- Matches whose own score is lower skip neighbourhood verification.
        min_pair_score = -5.,
        -- The neighbours of a match are compared one by one, as long as its
        -- score with what they have shown is at least this. Smaller: more is
        -- known of matches that are refused all the same, slower.
        min_promising_score = -2.,
        -- Least score at which a match proposes poses to neighbouring pairs.
        -- Larger: faster, less recall.
        min_proposing_score = 0.,
        -- A pair that was proposed and found likely proposes poses in its turn;
        -- this many times over. Larger: more recall where a place was seen
        -- often, slower.
        max_num_rounds = 4,
        -- An accepted match also proposes poses to the unmatched pairs of all
        -- submaps up to so many indices from its own. 0: to none.
        max_proposal_index_distance = 4,
        -- close_loops and merge try a pair within a map that was not matched by
        -- itself only while one of its submaps has fewer likely matches than
        -- this. Larger: more closures of a place that was seen often, most of
        -- them redundant, for time that grows with the square of the visits.
        -- 0: no limit, as in match.
        max_num_matches_per_submap = 20,
        -- Score = log-odds of being right. Learned by scripts/learn_score.py
        -- --neighbours on the same maps as score_weights.
        weights = {
          -- Of the pair's own score.
          pair_score = 0.91,
          -- Of the logarithm of the fraction of the neighbours' wall that
          -- contradicts.
          log_contradiction = -1.46,
          -- Of the logarithm of the odds at which neighbouring pairs, matched by
          -- themselves, lie where the match predicts them.
          log_confirmation = 3.52,
          bias = 0.,
        },
        -- Most that the neighbourhood may raise a pair's own score. Larger:
        -- accepts more matches whose own walls hardly agree.
        max_gain = 6.,
      },
      -- A submap that matches two others, which local SLAM puts far apart, is in
      -- one place at most: where both are about as likely, both are ambiguous.
      -- Applied where neighbourhoods are verified.
      rivals = {
        -- Least lead over each match that excludes it; log-odds. Larger: more is
        -- refused in buildings of equal rooms.
        min_lead = 1.5,
        -- A match loses this fraction of ln(1 + odds) of its best rival.
        rival_weight = 0.5,
        -- [m], [rad] Matches exclude each other if the poses that they give to
        -- the submap differ by more than this ...
        min_distance_meters = 1.5,
        min_rotation = 0.3,
        -- ... and by more than local SLAM may have drifted on the way between
        -- the other two: as a fraction of the way, and [rad / sqrt(m)]. Larger:
        -- tolerates worse odometry, and more equal rooms.
        max_drift_per_meter = 0.04,
        max_rotation_drift_per_sqrt_meter = 0.04,
      },
      -- A match that is certain by itself supports likely ones nearby, and those
      -- without support must be certain themselves: see
      -- support.min_unsupported_score. Applied where neighbourhoods are verified.
      support = {
        -- Least score of a match that others support; log-odds. From
        -- judgement.min_score on, it supports in its turn. Larger: fewer matches
        -- in noisy maps and outdoors.
        min_supported_score = 1.,
        -- A match and one that supports it are at most so many submaps apart, on
        -- either side. Larger: supports more, and relies on more odometry.
        max_index_distance = 4,
        -- [m], [rad] How near a match must be to where the other puts it. Beyond
        -- half as much again, and drift, the other opposes it.
        max_distance_meters = 0.5,
        max_rotation = 0.1,
      },
    },
    -- From matches to an optimised pose graph.
    closing = {
      -- Detection of torn submaps. Agreement is the ratio of hits minus twice
      -- the ratio of contradictions.
      tear = {
        -- Number of parts, with equally many scans, that are compared with each
        -- other. Larger: finds slips near a submap's ends, but fewer walls are
        -- seen twice.
        num_parts = 6,
        -- [m] Cell size of the grids that the parts are drawn into.
        resolution_meters = 0.1,
        -- [m] Points farther from the robot are left out.
        max_range_meters = 30.,
        -- Wall cells that two parts must have in common.
        min_num_points = 50,
        -- Least gain in agreement when one of two parts is moved. Smaller:
        -- finds smaller tears, but mistakes moved doors and people for tears.
        min_gain = 0.6,
        -- Least agreement at the moved pose.
        min_agreement = 0.7,
        -- [m], [rad] The move must reach one of these.
        min_translation_meters = 0.2,
        min_rotation = 0.035,
      },
      -- Consistency of closures, tested on cycles through the odometry between
      -- them.
      consistency = {
        -- [m], [rad] Standard deviations of a closure.
        closure_translation_sigma_meters = 0.15,
        closure_rotation_sigma = 0.02,
        -- Cycles that fail to close by more standard deviations are
        -- inconsistent.
        max_mahalanobis_distance = 4.03,
        -- [m] Cycles whose end has a larger standard deviation are not tested.
        max_cycle_sigma_meters = 1.,
        -- Sum of the scores of consistent closures that counts as support.
        min_support = 8.,
      },
      -- Closures between submaps that better ones tie together are left out.
      redundancy = {
        -- However the submaps are divided in two, so many closures between the
        -- two parts stay. Larger: a stiffer graph, a slower optimisation.
        min_num_ties = 10,
      },
      -- Conversion of a closure into constraints between submaps and nodes.
      constraints = {
        -- Number of nodes of each of the two submaps. Larger: a stronger,
        -- smoother pull.
        num_nodes_per_submap = 5,
        -- [m], [rad] Standard deviations of a node's pose within its submap.
        translation_sigma_meters = 0.1,
        rotation_sigma = 0.02,
        -- A node yields no constraint if registration moves it by more than
        -- this number of standard deviations, ...
        max_num_sigmas = 3.,
        -- ... or leaves a smaller fraction of its scan on walls.
        min_hit_ratio = 0.6,
      },
      -- As Cartographer's POSE_GRAPH.optimization_problem, with its defaults.
      -- Use the weights that the map was made with; other weights distort it.
      optimization = {
        huber_scale = 1e1,
        local_slam_pose_translation_weight = 1e5,
        local_slam_pose_rotation_weight = 1e5,
        odometry_translation_weight = 1e5,
        odometry_rotation_weight = 1e5,
        -- [rad] Not an option of Cartographer: where local SLAM and odometry
        -- turn by angles that differ by more between two scans, local SLAM has
        -- slipped, and the map may give way. Smaller: more places give way; pi:
        -- none.
        min_slip_angle = 0.15,
        max_num_iterations = 200,
      },
      -- Closures that the optimised map contradicts are removed, and the map is
      -- optimised again.
      outlier_rejection = {
        -- [rad]
        max_rotation_error = 0.052,
        max_num_rounds = 10,
      },
    },
  },
  -- Localisation of a map, or of the beginning of a drive, in another map
  -- (relocalize, merge, live). The other options are those of loop_closing.
  localization = {
    -- When a pose in the map is certain.
    placement = {
      -- [m] Submaps count as evidence as far as they show ground that others do
      -- not: a disc of what they show, at least of this diameter. Larger: more
      -- must be seen.
      independent_distance_meters = 10.,
      -- Largest contribution of one match (log-odds).
      max_place_score = 10.,
      -- A submap contributes its best match, and this fraction of its other
      -- matches. Larger: less must be seen, more look-alikes are accepted.
      further_match_weight = 0.,
      -- Two submaps that the answer makes overlap contradict it if more of their
      -- walls stand in the other's free space. Larger: tolerates more moved
      -- furniture.
      max_contradiction_ratio = 0.2,
      -- Largest fraction of the submaps that may contradict the answer. Larger:
      -- tolerates more change since the map was made.
      max_contradicting_fraction = 0.3,
      -- [m], [rad] Answers that differ by less count as the same. Larger:
      -- tolerates more drift within the map, but overlooks look-alikes close
      -- by.
      same_distance_meters = 1.,
      same_rotation = 0.2,
      -- [m^2] Least observed area, summed over the submaps.
      min_observed_area = 20.,
    },
    -- Whether to count matches that show too little to be accepted but are more
    -- likely right than wrong. At least one must be accepted in any case.
    count_likely_matches = false,
    -- Number of submaps of the query, evenly spaced, to search for in the map
    -- first; doubled while the answer is uncertain. Smaller: faster, but
    -- look-alikes elsewhere may go unnoticed.
    num_first_places = 64,
    -- Number of pairs of submaps that overlap under the answer and are verified
    -- there. Larger: more evidence for and against it, slower.
    max_num_confirmed_pairs = 50,
  },
  -- Grids drawn from scans: of the first seconds of a drive, and of maps
  -- without submaps.
  scan_places = {
    -- Scans per grid; corresponds to Cartographer's 2 * num_range_data.
    num_scans = 120,
    -- As Cartographer's probability_grid_range_data_inserter.
    hit_probability = 0.55,
    miss_probability = 0.49,
  },
  -- Where a robot stands, by one scan (relocalize --scan).
  scan_localization = {
    -- Where in the map a robot can stand.
    viewpoints = {
      -- [m] Distance between neighbouring places that the scan is compared with.
      -- Smaller: slower, quadratically; larger: the right one may be missed.
      step_meters = 0.3,
      -- In a map with room for more, they are farther apart. Larger: slower in
      -- large maps.
      max_num_viewpoints = 60000,
      -- [m] Least distance from the lidar to a wall.
      min_clearance_meters = 0.15,
    },
    -- Poses that are registered, of those at which the ranges fit best, and of
    -- those at which the most echoes are near walls, whatever stands between.
    -- Larger: slower, and less likely that the right one is missed.
    num_registered_poses = 200,
    num_echo_poses = 100,
    -- Least number of echoes, of which each degree counts once.
    min_num_beams = 30,
    -- [m] Farther echoes are left out.
    max_range_meters = 60.,
    -- Least probability of a pose that is certain. Larger: fewer answers, fewer
    -- wrong ones.
    min_probability = 0.99,
    -- Which of the candidates is the right one. Learned by
    -- scripts/measure_scan_localization.py, as those below.
    candidate_weights = {
      fit = 27.8,
      loose_fit = -23.1,
      log_through = -1.85,
      log_free = -0.9,
      in_unknown = -8.3,
    },
    -- Whether the right pose is among the candidates at all.
    presence_weights = {
      loose_fit = -22.4,
      log_through = -1.27,
      log_free = -0.08,
      in_unknown = -4.1,
      num_beams = 1.25,
      lead = 24.9,
      bias = -5.5,
    },
  },
  -- Localisation of a robot that drives, by scans with odometry (relocalize
  -- --scan of a drive).
  scan_session = {
    -- [m], [rad] How far the robot drives or turns from one scan that is
    -- compared with the map, a look, to the next. Smaller: slower.
    look_distance_meters = 0.5,
    look_rotation = 0.5,
    -- Latest looks that count. Larger: slower.
    max_num_looks = 20,
    -- While the robot is searched for, the whole map is searched at the first
    -- look and after so many, then after twice and four times as many. Smaller:
    -- slower, found sooner.
    num_looks_per_search = 4,
    -- [m], [rad] Driving or turning so far shows as much new as another scan.
    -- Larger: fewer answers, fewer wrong ones.
    independent_distance_meters = 3.,
    independent_rotation = 6.,
    -- Added to presence_weights.bias and .lead above, times the logarithm of
    -- the number of such scans. Learned, as those.
    presence_bias_per_log = 0.5,
    presence_lead_per_log = 5.,
    -- Once the robot is located: a scan contradicts the pose if a larger
    -- fraction of its beams crosses walls or ends in free space.
    max_contradicting_fraction = 0.5,
    -- [s] The robot is lost if all scans of this time, and so many, contradict.
    -- Larger: a robot that was carried away is noticed later.
    lost_after_seconds = 2.,
    lost_after_scans = 5,
  },
  -- Which sessions are compared (merge).
  session_links = {
    -- Each is compared with so many of those that it resembles most, and with
    -- others where that does not connect them. Larger: more constraints between
    -- sessions, for time that grows with the square of their number.
    min_num_links_per_session = 4,
  },
  -- Detection of merged maps that fold over each other (merge).
  fold_check = {
    -- Submaps contradict each other if a larger fraction of their walls lies in
    -- each other's free space. Larger: tolerates more change between the maps.
    max_contradiction_ratio = 0.15,
  },
  -- Detection of doubtful constraints of a map (audit). The other options are
  -- those of loop_closing.
  audit = {
    -- [m], [rad] Constraints of one pair of submaps are judged together if
    -- their poses differ by less.
    grouping = {
      max_distance_meters = 0.5,
      max_rotation = 0.15,
    },
    -- Constraints with a larger fraction of wall points in the other's free
    -- space are contradicted. Smaller: finds more wrong constraints, drops more
    -- right ones.
    max_contradiction_ratio = 0.1,
    -- Least lead over the best other pose of the pair; below it the pose is
    -- ambiguous (log-odds; negative: another pose is better).
    min_margin = 0.,
    -- Least score (log-odds). Larger: more constraints need the support of
    -- others.
    min_score = 0.,
    -- [m], [rad] A doubtful constraint is kept if the map made without it
    -- agrees with it to this tolerance. Larger: fewer right constraints are
    -- dropped.
    max_agreeing_translation_meters = 0.3,
    max_agreeing_rotation = 0.1,
    -- Constraints that this map contradicts by more are doubtful too. Smaller:
    -- finds smaller errors, drops more right ones.
    outlier_rejection = {
      -- [m], [rad]
      max_translation_error_meters = 0.5,
      max_rotation_error = 0.1,
      max_num_rounds = 10,
    },
  },
  -- The HTML report.
  report = {
    -- [pixels] Longer side of the pictures of the whole map.
    map_picture_pixels = 2000,
    -- [pixels] Longer side of the picture of a submap.
    submap_picture_pixels = 300,
  },
}
