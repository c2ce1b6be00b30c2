// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Text that comes from outside: configurations in Lua, logs, tables, scans,
// floor plans, and images of maps. Each input is read as all of them; the seeds
// are of each kind.

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/localization/scan_session.h"
#include "cartographer_sdf/map_image/grey_image.h"
#include "cartographer_sdf/map_image/ros_map.h"
#include "cartographer_sdf/recording/carmen_log.h"
#include "cartographer_sdf/recording/scan_file.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/simulation/floor_plan.h"
#include "cartographer_sdf/simulation/truth.h"
#include "glog/logging.h"
#include "test/fuzz/drawn_room.h"
#include "test/fuzz/fuzz_target.h"

namespace cartographer_sdf::fuzz {
namespace {

// Two scans of a robot that drives through the room.
std::string DriveText() {
  std::string text = "[";
  for (int scan = 0; scan < 2; ++scan) {
    absl::StrAppend(&text, scan > 0 ? "," : "", "{\"time\": ", scan,
                    ", \"odometry\": {\"x\": ", scan,
                    ", \"y\": 0, \"yaw\": 0}, \"angle_min\": 0, "
                    "\"angle_increment\": 0.1, \"range_max\": 9, "
                    "\"ranges\": [1.5");
    for (int k = 1; k < 60; ++k) absl::StrAppend(&text, ",1.", k);
    text += "]}";
  }
  return text + "]";
}

}  // namespace

std::vector<std::string> Seeds() {
  return {
      "local t = {a = {1, 2.5, \"x\"}, b = not true}\n"
      "for k, v in pairs(t) do t[k] = v end\n"
      "SDF_GLOBAL_CONSTRAINTS = t\nreturn SDF_GLOBAL_CONSTRAINTS\n",
      "# comment\nFLASER 3 1.0 2.0 81.9 0 0 0 1.5 -2 0.25 12.5 host 12.5\n"
      "FLASER 3 1.0 2.0 81.9 0 0 0 1.6 -2 0.25 12.7 host 12.7\n",
      "kind,trajectory,index,x,y,yaw\nsubmap,0,1,2.5,-1e3,0.5\n"
      "node,0,2,1,2,3\n",
      "1 2 0.5 0.25 1.5 100.0 200.0\n",
      "P2\n# plan\n3 2\n255\n0 255 0\n255 255 255\n",
      std::string("P5 2 2 255\n\x00\xff\xff\x00", 15),
      "image: input\nresolution: 0.1\norigin: [0, -1, 0.5]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: scale\n",
      "{\"angle_min\": -1, \"angle_increment\": 0.5, \"range_max\": 9,\n"
      "\"ranges\": [1, 2.5, null, NaN, Infinity], \"sensor\": {\"x\": 0.1}}\n",
      "[{\"points\": [[1, 2], [3, -4e-1]]}]\n",
      "angle,range\n0.5,3\n",
      DriveText(),
      "reference_trajectory,reference_index,query_trajectory,query_index,"
      "accepted,score,x,y,yaw,verdict,inliers,overlap,hit_ratio,"
      "contradiction_ratio\n0,1,0,5,1,2.5,1,2,3,accepted,4,0.5,0.5,0.1\n"};
}

// Follows a robot by its scans, whatever they are.
void FollowDrive(const ScanRecording& recording) {
  constexpr size_t kMaxNumScans = 8;
  static const auto* const room = new DrawnMap(DrawRoom());
  ScanSession session(ScanLocalizationOptions(), ScanSessionOptions(),
                      room->panoramas);
  for (size_t k = 0; k < std::min(kMaxNumScans, recording.scans.size()); ++k) {
    const SessionAnswer& answer = session.Add(recording.scans[k]);
    CheckCandidates(answer.localization);
    if (answer.T_map_robot)
      CHECK(answer.T_map_robot->translation().allFinite());
  }
}

}  // namespace cartographer_sdf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* const data,
                                      const size_t size) {
  using namespace cartographer_sdf;  // NOLINT
  const std::string path = fuzz::WriteInput(
      "input", std::string(reinterpret_cast<const char*>(data), size));
  (void)LoadOptions({fuzz::Directory().path()}, "input");
  (void)ReadCarmenLog(path, CarmenLogOptions());
  (void)ReadTruth(path);
  (void)ReadRelations(path);
  (void)ReadMatches(path);
  (void)ReadPgm(path, 0.05);
  (void)ReadPngImage(path);
  (void)ReadScanFile(path);
  const absl::StatusOr<ScanRecording> recording = ReadScanRecording(path);
  if (recording.ok()) fuzz::FollowDrive(*recording);
  (void)ReadRosMap(fuzz::WriteInput(
      "input.yaml", std::string(reinterpret_cast<const char*>(data), size)));
  return 0;
}
