// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_MATCHING_CORRESPONDENCE_H_
#define CARTOGRAPHER_SDF_MATCHING_CORRESPONDENCE_H_

#include <string>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"

namespace cartographer_sdf {

struct CorrespondenceOptions {
  // Nearest neighbours in descriptor space that each query feature proposes.
  // Larger: more true correspondences among more false ones.
  int num_neighbours = 5;
  // Whether to drop query features whose nearest neighbour is not clearly
  // nearer than the next ([Lowe2004], Sec. 7.1).
  bool use_ratio_test = false;
  // Largest ratio of the two distances; Table I.
  double max_ratio = 0.75;
  // Whether features correspond only to features of the same kind
  // ([Millane2019], Sec. IV-C).
  bool same_kind_only = true;
  // Features whose clearance differs by more than this do not correspond [m].
  double max_clearance_difference_meters = 0.2;
  // Features of other kinds do not correspond.
  KeypointKinds kinds;
};
[[nodiscard]] std::string Validate(const CorrespondenceOptions& options);

// Indices into the two feature sets.
struct Correspondence {
  int reference;
  int query;
  float descriptor_distance;
};

// Finds putative correspondences between features by exhaustive search: kind by
// kind (all together where kinds may mix), in the order of the query features,
// nearest first.
[[nodiscard]] std::vector<Correspondence> FindCorrespondences(
    const CorrespondenceOptions& options, const FeatureSet& reference,
    const FeatureSet& query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MATCHING_CORRESPONDENCE_H_
