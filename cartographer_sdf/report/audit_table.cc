// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/audit_table.h"

#include <algorithm>
#include <map>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"

namespace cartographer_sdf {
namespace {

constexpr char kHeader[] =
    "constraint,submap_trajectory,submap_index,node_trajectory,node_index,x,y,"
    "yaw,doubtful,verdict,error_before,rotation_error_before,error_after,"
    "rotation_error_after,group,reference_trajectory,reference_index,"
    "query_trajectory,query_index,group_x,group_y,group_yaw,score,margin,"
    "overlap_area,overlap,hit_ratio,"
    "contradiction_ratio,shift,support,contradiction\n";

std::string GroupFields(const AuditedGroup& audited, const size_t number) {
  const ConstraintGroup& group = audited.group;
  const ClaimEvidence& claim = audited.claim;
  return absl::StrFormat(
      "%d,%d,%d,%d,%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%s,%.6f,%."
      "6f",
      number, group.reference.trajectory, group.reference.index,
      group.query.trajectory, group.query.index,
      group.T_reference_query.translation().x(),
      group.T_reference_query.translation().y(),
      group.T_reference_query.rotation(), claim.score, claim.margin,
      claim.evidence.overlap_area, claim.evidence.overlap,
      claim.evidence.HitRatio(), claim.evidence.ContradictionRatio(),
      claim.shift ? absl::StrFormat("%.6f", *claim.shift) : "",
      audited.cycles.support, audited.cycles.contradiction);
}

}  // namespace

absl::Status WriteAuditTable(const std::string& path, const Audit& audit) {
  std::map<size_t, size_t> group_of;
  for (size_t g = 0; g < audit.groups.size(); ++g) {
    for (const size_t k : audit.groups[g].group.constraints) group_of[k] = g;
  }
  std::string content = kHeader;
  for (const AuditedConstraint& audited : audit.constraints) {
    const Constraint& constraint =
        audit.state.pose_graph.constraints[audited.constraint];
    const Rigid2& T_submap_node = constraint.T_submap_node;
    const auto group = group_of.find(audited.constraint);
    absl::StrAppendFormat(
        &content,
        "%d,%d,%d,%d,%d,%.6f,%.6f,%.6f,%d,%s,%.6f,%.6f,%.6f,%.6f,%s\n",
        audited.constraint, constraint.submap.trajectory,
        constraint.submap.index, constraint.node.trajectory,
        constraint.node.index, T_submap_node.translation().x(),
        T_submap_node.translation().y(), T_submap_node.rotation(),
        IsDoubtful(audited.verdict) ? 1 : 0, AuditVerdictName(audited.verdict),
        audited.error_before.translation, audited.error_before.rotation,
        audited.error_after.translation, audited.error_after.rotation,
        group == group_of.end()
            ? std::string(16, ',')
            : GroupFields(audit.groups[group->second], group->second));
  }
  return WriteWholeFile(path, content);
}

}  // namespace cartographer_sdf
