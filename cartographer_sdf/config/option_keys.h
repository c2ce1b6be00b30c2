// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The Lua keys of every option struct; see option_binding.h. The Lua files
// describe each option.

#ifndef CARTOGRAPHER_SDF_CONFIG_OPTION_KEYS_H_
#define CARTOGRAPHER_SDF_CONFIG_OPTION_KEYS_H_

#include <string>
#include <vector>

#include "cartographer_sdf/config/option_binding.h"
#include "cartographer_sdf/config/options.h"

namespace cartographer_sdf {

inline void VisitOptions(OptionVisitor& visit, FieldOptions& options) {
  visit("occupied_probability", options.occupied_probability);
  visit("padding_meters", options.padding_meters);
}

inline void VisitOptions(OptionVisitor& visit, KeypointOptions& options) {
  visit("smoothing_sigma_cells", options.smoothing_sigma_cells);
  visit("detection_threshold", options.detection_threshold);
  visit("non_maximum_suppression_cells", options.non_maximum_suppression_cells);
  visit("unobserved_border_cells", options.unobserved_border_cells);
  visit("max_clearance_meters", options.max_clearance_meters);
}

inline void VisitOptions(OptionVisitor& visit, DescriptorOptions& options) {
  visit("radius_meters", options.radius_meters);
  visit("num_bins", options.num_bins);
  visit("num_orientation_bins", options.num_orientation_bins);
  visit("distance_weight", options.distance_weight);
  visit("gaussian_sigma_ratio", options.gaussian_sigma_ratio);
  visit("secondary_orientation_ratio", options.secondary_orientation_ratio);
}

inline void VisitOptions(OptionVisitor& visit, PlaceOptions& options) {
  visit("field", options.field);
  visit("keypoint", options.keypoint);
  visit("descriptor", options.descriptor);
  visit("max_field_megabytes", options.max_field_megabytes);
}

inline void VisitOptions(OptionVisitor& visit, KeypointKinds& kinds) {
  visit("maxima", kinds.maxima);
  visit("minima", kinds.minima);
  visit("saddles", kinds.saddles);
}

inline void VisitOptions(OptionVisitor& visit, CorrespondenceOptions& options) {
  visit("num_neighbours", options.num_neighbours);
  visit("use_ratio_test", options.use_ratio_test);
  visit("max_ratio", options.max_ratio);
  visit("same_kind_only", options.same_kind_only);
  visit("max_clearance_difference_meters",
        options.max_clearance_difference_meters);
  visit("kinds", options.kinds);
}

inline void VisitOptions(OptionVisitor& visit, PoseBinOptions& options) {
  visit("distance_meters", options.distance_meters);
  visit("rotation", options.rotation);
}

inline void VisitOptions(OptionVisitor& visit, PoseVotingOptions& options) {
  visit("max_num_correspondences", options.max_num_correspondences);
  visit("max_length_difference_meters", options.max_length_difference_meters);
  visit("max_orientation_difference", options.max_orientation_difference);
  visit("min_baseline_meters", options.min_baseline_meters);
  visit("bins", options.bins);
}

inline void VisitOptions(OptionVisitor& visit, HypothesisOptions& options) {
  visit("max_num_hypotheses", options.max_num_hypotheses);
  visit("votes", options.votes);
}

inline void VisitOptions(OptionVisitor& visit, RansacOptions& options) {
  visit("max_num_iterations", options.max_num_iterations);
  visit("inlier_distance_meters", options.inlier_distance_meters);
  visit("min_baseline_meters", options.min_baseline_meters);
}

inline void VisitOptions(OptionVisitor& visit, RankingOptions& options) {
  visit("num_coarse_points", options.num_coarse_points);
  visit("num_fine_points", options.num_fine_points);
  visit("num_coarse_survivors", options.num_coarse_survivors);
  visit("num_refined", options.num_refined);
  visit("hit_distance_meters", options.hit_distance_meters);
  visit("contradiction_distance_meters", options.contradiction_distance_meters);
  visit("contradiction_weight", options.contradiction_weight);
  visit("min_coarse_score", options.min_coarse_score);
  visit("min_fine_score", options.min_fine_score);
  visit("max_fine_score_gap", options.max_fine_score_gap);
}

inline void VisitOptions(OptionVisitor& visit, ScreeningOptions& options) {
  visit("num_points", options.num_points);
  visit("min_score", options.min_score);
  visit("max_score_gap", options.max_score_gap);
}

inline void VisitOptions(OptionVisitor& visit, RegistrationOptions& options) {
  visit("num_iterations", options.num_iterations);
  visit("initial_kernel_scale_meters", options.initial_kernel_scale_meters);
  visit("final_kernel_scale_meters", options.final_kernel_scale_meters);
  visit("max_num_points", options.max_num_points);
}

inline void VisitOptions(OptionVisitor& visit, AgreementOptions& options) {
  visit("hit_distance_meters", options.hit_distance_meters);
  visit("contradiction_distance_meters", options.contradiction_distance_meters);
  visit("weigh_by_certainty", options.weigh_by_certainty);
  visit("max_num_points", options.max_num_points);
}

inline void VisitOptions(OptionVisitor& visit, ScoreWeights& options) {
  visit("log_contradiction_ratio", options.log_contradiction_ratio);
  visit("log_overlap", options.log_overlap);
  visit("wall_evidence", options.wall_evidence);
  visit("sqrt_scatter_eigenvalue", options.sqrt_scatter_eigenvalue);
  visit("margin", options.margin);
  visit("bias", options.bias);
}

inline void VisitOptions(OptionVisitor& visit, JudgementOptions& options) {
  visit("score_weights", options.score_weights);
  visit("min_overlap_area", options.min_overlap_area);
  visit("max_contradiction_ratio", options.max_contradiction_ratio);
  visit("min_scatter_eigenvalue", options.min_scatter_eigenvalue);
  visit("min_score", options.min_score);
  visit("min_margin", options.min_margin);
}

inline void VisitOptions(OptionVisitor& visit, CrossingOptions& options) {
  visit("max_wall_meters", options.max_wall_meters);
  visit("max_crossed_fraction", options.max_crossed_fraction);
}

inline void VisitOptions(OptionVisitor& visit, VerificationOptions& options) {
  visit("ranking", options.ranking);
  visit("screening", options.screening);
  visit("registration", options.registration);
  visit("agreement", options.agreement);
  visit("judgement", options.judgement);
  visit("crossing", options.crossing);
}

[[nodiscard]] inline std::vector<std::string> OptionNames(Method) {
  return {"sdf", "paper"};
}

inline void VisitOptions(OptionVisitor& visit, MatchOptions& options) {
  visit("method", options.method);
  visit("correspondence", options.correspondence);
  visit("hypotheses", options.hypotheses);
  visit("verification", options.verification);
  visit("inlier_distance_meters", options.inlier_distance_meters);
  visit("ransac", options.ransac);
  visit("min_num_inliers", options.min_num_inliers);
  visit("seed", options.seed);
}

inline void VisitOptions(OptionVisitor& visit, TearOptions& options) {
  visit("num_parts", options.num_parts);
  visit("resolution_meters", options.resolution_meters);
  visit("max_range_meters", options.max_range_meters);
  visit("min_num_points", options.min_num_points);
  visit("min_gain", options.min_gain);
  visit("min_agreement", options.min_agreement);
  visit("min_translation_meters", options.min_translation_meters);
  visit("min_rotation", options.min_rotation);
}

inline void VisitOptions(OptionVisitor& visit, KeypointPairOptions& options) {
  visit("min_length_meters", options.min_length_meters);
  visit("max_length_meters", options.max_length_meters);
  visit("clearance_bin_meters", options.clearance_bin_meters);
  visit("length_bin_meters", options.length_bin_meters);
  visit("orientation_bin", options.orientation_bin);
  visit("border_fraction", options.border_fraction);
  visit("kinds", options.kinds);
}

inline void VisitOptions(OptionVisitor& visit, RetrievalOptions& options) {
  visit("pairs", options.pairs);
  visit("num_stored_partners", options.num_stored_partners);
  visit("num_sought_partners", options.num_sought_partners);
  visit("max_num_stored_pairs", options.max_num_stored_pairs);
  visit("max_num_sought_pairs", options.max_num_sought_pairs);
  visit("max_num_visited_pairs", options.max_num_visited_pairs);
  visit("pose_bins", options.pose_bins);
  visit("max_num_poses", options.max_num_poses);
  visit("min_score", options.min_score);
  visit("min_num_candidates", options.min_num_candidates);
  visit("max_num_candidates", options.max_num_candidates);
}

inline void VisitOptions(OptionVisitor& visit, ConsistencyOptions& options) {
  visit("rotation_sigma_per_sqrt_meter", options.rotation_sigma_per_sqrt_meter);
  visit("translation_sigma_per_meter", options.translation_sigma_per_meter);
  visit("closure_translation_sigma_meters",
        options.closure_translation_sigma_meters);
  visit("closure_rotation_sigma", options.closure_rotation_sigma);
  visit("max_mahalanobis_distance", options.max_mahalanobis_distance);
  visit("max_cycle_sigma_meters", options.max_cycle_sigma_meters);
  visit("min_unsupported_score", options.min_unsupported_score);
  visit("min_support", options.min_support);
}

inline void VisitOptions(OptionVisitor& visit, RedundancyOptions& options) {
  visit("min_num_ties", options.min_num_ties);
}

inline void VisitOptions(OptionVisitor& visit, ConstraintOptions& options) {
  visit("num_nodes_per_submap", options.num_nodes_per_submap);
  visit("min_num_constraints", options.min_num_constraints);
  visit("translation_weight", options.translation_weight);
  visit("rotation_weight", options.rotation_weight);
  visit("translation_sigma_meters", options.translation_sigma_meters);
  visit("rotation_sigma", options.rotation_sigma);
  visit("max_num_sigmas", options.max_num_sigmas);
  visit("min_hit_ratio", options.min_hit_ratio);
}

inline void VisitOptions(OptionVisitor& visit, OptimizationOptions& options) {
  visit("huber_scale", options.huber_scale);
  visit("local_slam_pose_translation_weight",
        options.local_slam_pose_translation_weight);
  visit("local_slam_pose_rotation_weight",
        options.local_slam_pose_rotation_weight);
  visit("odometry_translation_weight", options.odometry_translation_weight);
  visit("odometry_rotation_weight", options.odometry_rotation_weight);
  visit("min_slip_angle", options.min_slip_angle);
  visit("max_num_iterations", options.max_num_iterations);
}

inline void VisitOptions(OptionVisitor& visit,
                         OutlierRejectionOptions& options) {
  visit("max_translation_error_meters", options.max_translation_error_meters);
  visit("max_rotation_error", options.max_rotation_error);
  visit("max_num_rounds", options.max_num_rounds);
}

inline void VisitOptions(OptionVisitor& visit, TrajectoryLinkOptions& options) {
  visit("index_step", options.index_step);
  visit("max_contradiction_ratio", options.max_contradiction_ratio);
  visit("min_overlap_area", options.min_overlap_area);
}

inline void VisitOptions(OptionVisitor& visit, NeighbourhoodWeights& weights) {
  visit("pair_score", weights.pair_score);
  visit("log_contradiction", weights.log_contradiction);
  visit("log_confirmation", weights.log_confirmation);
  visit("bias", weights.bias);
}

inline void VisitOptions(OptionVisitor& visit, NeighbourhoodOptions& options) {
  visit("num_steps", options.num_steps);
  visit("index_step", options.index_step);
  visit("min_overlap_area", options.min_overlap_area);
  visit("num_points", options.num_points);
  visit("max_prediction_error_meters", options.max_prediction_error_meters);
  visit("max_prediction_rotation_error", options.max_prediction_rotation_error);
  visit("prior_wall_length_meters", options.prior_wall_length_meters);
  visit("prior_contradiction_ratio", options.prior_contradiction_ratio);
  visit("min_pair_score", options.min_pair_score);
  visit("min_promising_score", options.min_promising_score);
  visit("min_proposing_score", options.min_proposing_score);
  visit("max_num_rounds", options.max_num_rounds);
  visit("max_proposal_index_distance", options.max_proposal_index_distance);
  visit("max_num_matches_per_submap", options.max_num_matches_per_submap);
  visit("weights", options.weights);
  visit("max_gain", options.max_gain);
}

inline void VisitOptions(OptionVisitor& visit, RivalMatchOptions& options) {
  visit("min_lead", options.min_lead);
  visit("rival_weight", options.rival_weight);
  visit("min_distance_meters", options.min_distance_meters);
  visit("min_rotation", options.min_rotation);
  visit("max_drift_per_meter", options.max_drift_per_meter);
  visit("max_rotation_drift_per_sqrt_meter",
        options.max_rotation_drift_per_sqrt_meter);
}

inline void VisitOptions(OptionVisitor& visit, MatchSupportOptions& options) {
  visit("min_unsupported_score", options.min_unsupported_score);
  visit("min_supported_score", options.min_supported_score);
  visit("max_index_distance", options.max_index_distance);
  visit("max_distance_meters", options.max_distance_meters);
  visit("max_rotation", options.max_rotation);
}

inline void VisitOptions(OptionVisitor& visit, RecognitionOptions& options) {
  visit("match", options.match);
  visit("min_index_gap", options.min_index_gap);
  visit("use_retrieval", options.use_retrieval);
  visit("retrieval", options.retrieval);
  visit("verify_neighbourhoods", options.verify_neighbourhoods);
  visit("links", options.links);
  visit("neighbourhood", options.neighbourhood);
  visit("rivals", options.rivals);
  visit("support", options.support);
}

inline void VisitOptions(OptionVisitor& visit, ClosingOptions& options) {
  visit("detect_torn_submaps", options.detect_torn_submaps);
  visit("tear", options.tear);
  visit("consistency", options.consistency);
  visit("redundancy", options.redundancy);
  visit("constraints", options.constraints);
  visit("optimization", options.optimization);
  visit("infer_odometry_weights", options.infer_odometry_weights);
  visit("outlier_rejection", options.outlier_rejection);
}

inline void VisitOptions(OptionVisitor& visit, LoopClosingOptions& options) {
  visit("place", options.place);
  visit("recognition", options.recognition);
  visit("closing", options.closing);
}

inline void VisitOptions(OptionVisitor& visit, GroupingOptions& options) {
  visit("max_distance_meters", options.max_distance_meters);
  visit("max_rotation", options.max_rotation);
}

inline void VisitOptions(OptionVisitor& visit, AuditOptions& options) {
  visit("grouping", options.grouping);
  visit("max_contradiction_ratio", options.max_contradiction_ratio);
  visit("min_margin", options.min_margin);
  visit("min_score", options.min_score);
  visit("max_agreeing_translation_meters",
        options.max_agreeing_translation_meters);
  visit("max_agreeing_rotation", options.max_agreeing_rotation);
  visit("outlier_rejection", options.outlier_rejection);
}

inline void VisitOptions(OptionVisitor& visit, PlacementOptions& options) {
  visit("independent_distance_meters", options.independent_distance_meters);
  visit("max_place_score", options.max_place_score);
  visit("further_match_weight", options.further_match_weight);
  visit("min_score", options.min_score);
  visit("min_lead", options.min_lead);
  visit("max_contradiction_ratio", options.max_contradiction_ratio);
  visit("max_contradicting_fraction", options.max_contradicting_fraction);
  visit("same_distance_meters", options.same_distance_meters);
  visit("same_rotation", options.same_rotation);
  visit("min_observed_area", options.min_observed_area);
}

inline void VisitOptions(OptionVisitor& visit, ScanPlaceOptions& options) {
  visit("num_scans", options.num_scans);
  visit("resolution_meters", options.resolution_meters);
  visit("hit_probability", options.hit_probability);
  visit("miss_probability", options.miss_probability);
}

inline void VisitOptions(OptionVisitor& visit, LocalizationOptions& options) {
  visit("placement", options.placement);
  visit("count_likely_matches", options.count_likely_matches);
  visit("num_first_places", options.num_first_places);
  visit("max_num_confirmed_pairs", options.max_num_confirmed_pairs);
}

inline void VisitOptions(OptionVisitor& visit, ViewpointOptions& options) {
  visit("step_meters", options.step_meters);
  visit("max_num_viewpoints", options.max_num_viewpoints);
  visit("min_clearance_meters", options.min_clearance_meters);
}

inline void VisitOptions(OptionVisitor& visit, CandidateWeights& weights) {
  visit("fit", weights.fit);
  visit("loose_fit", weights.loose_fit);
  visit("log_through", weights.log_through);
  visit("log_free", weights.log_free);
  visit("in_unknown", weights.in_unknown);
}

inline void VisitOptions(OptionVisitor& visit, PresenceWeights& weights) {
  visit("loose_fit", weights.loose_fit);
  visit("log_through", weights.log_through);
  visit("log_free", weights.log_free);
  visit("in_unknown", weights.in_unknown);
  visit("num_beams", weights.num_beams);
  visit("lead", weights.lead);
  visit("bias", weights.bias);
}

inline void VisitOptions(OptionVisitor& visit,
                         ScanLocalizationOptions& options) {
  visit("viewpoints", options.viewpoints);
  visit("num_registered_poses", options.num_registered_poses);
  visit("num_echo_poses", options.num_echo_poses);
  visit("min_num_beams", options.min_num_beams);
  visit("max_range_meters", options.max_range_meters);
  visit("candidate_weights", options.candidate_weights);
  visit("presence_weights", options.presence_weights);
  visit("min_probability", options.min_probability);
}

inline void VisitOptions(OptionVisitor& visit, ScanSessionOptions& options) {
  visit("look_distance_meters", options.look_distance_meters);
  visit("look_rotation", options.look_rotation);
  visit("max_num_looks", options.max_num_looks);
  visit("num_looks_per_search", options.num_looks_per_search);
  visit("independent_distance_meters", options.independent_distance_meters);
  visit("independent_rotation", options.independent_rotation);
  visit("presence_bias_per_log", options.presence_bias_per_log);
  visit("presence_lead_per_log", options.presence_lead_per_log);
  visit("max_contradicting_fraction", options.max_contradicting_fraction);
  visit("lost_after_seconds", options.lost_after_seconds);
  visit("lost_after_scans", options.lost_after_scans);
}

inline void VisitOptions(OptionVisitor& visit, SessionLinkOptions& options) {
  visit("min_num_links_per_session", options.min_num_links_per_session);
}

inline void VisitOptions(OptionVisitor& visit, FoldCheckOptions& options) {
  visit("max_contradiction_ratio", options.max_contradiction_ratio);
  visit("max_folded_fraction", options.max_folded_fraction);
}

inline void VisitOptions(OptionVisitor& visit, ReportOptions& options) {
  visit("map_picture_pixels", options.map_picture_pixels);
  visit("submap_picture_pixels", options.submap_picture_pixels);
  visit("max_submap_pictures", options.max_submap_pictures);
}

inline void VisitOptions(OptionVisitor& visit, Options& options) {
  visit("loop_closing", options.loop_closing);
  visit("localization", options.localization);
  visit("scan_places", options.scan_places);
  visit("scan_localization", options.scan_localization);
  visit("scan_session", options.scan_session);
  visit("session_links", options.session_links);
  visit("fold_check", options.fold_check);
  visit("audit", options.audit);
  visit("report", options.report);
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_OPTION_KEYS_H_
