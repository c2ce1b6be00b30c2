// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kNumPictures = 4;
// Less probable candidates are not drawn in the picture of the map, but for the
// best one.
constexpr double kMinDrawnProbability = 0.01;
constexpr double kArrowLength = 2.;  // [m]
constexpr double kScanMarginMeters = 1.;

// Of a whole map, or of what a scan sees at a pose.
MapPainter PaintMap(const OccupancyGrid& grid, const int max_pixels) {
  MapPainter painter({{grid.geometry, Rigid2()}}, max_pixels);
  painter.AddSubmap(grid, Rigid2());
  return painter;
}

std::vector<Eigen::Vector2d> EchoesIn(const std::vector<RobotScan>& scans,
                                      const Rigid2& T_map_robot) {
  std::vector<Eigen::Vector2d> echoes;
  for (const RobotScan& scan : scans) {
    const Rigid2 T_map_sensor = T_map_robot * scan.T_robot_sensor;
    for (const Eigen::Vector2f& point : scan.scan.returns) {
      const Eigen::Vector2d p_sensor = point.cast<double>();
      if (p_sensor.allFinite()) echoes.push_back(T_map_sensor * p_sensor);
    }
  }
  return echoes;
}

void DrawArrow(const Rigid2& T_map_robot, const double length,
               const PixelFrame& frame, const Color& color,
               Picture* const picture) {
  const auto at = [&](const double x, const double y) {
    return frame.ToPixels(T_map_robot * Eigen::Vector2d(x, y));
  };
  const double width =
      std::max(1.5, 0.003 * std::max(picture->width(), picture->height()));
  picture->DrawPolyline({at(0., 0.), at(length, 0.)}, width, color);
  picture->DrawPolyline({at(0.7 * length, 0.2 * length), at(length, 0.),
                         at(0.7 * length, -0.2 * length)},
                        width, color);
  picture->DrawCircle(at(0., 0.), 1.5 * width, color, kWhite);
}

std::string Percent(const double probability) {
  return probability < 0.1 ? absl::StrFormat("%.1f %%", 100. * probability)
                           : absl::StrFormat("%.0f %%", 100. * probability);
}

void DrawEchoes(const std::vector<Eigen::Vector2d>& echoes,
                const PixelFrame& frame, const Color& color,
                Picture* const picture) {
  for (const Eigen::Vector2d& echo : echoes) {
    const Eigen::Vector2d pixel = frame.ToPixels(echo);
    if (!(pixel.array().abs() < 1e5).all()) continue;
    picture->DrawCircle(pixel, 1.2, color, color);
  }
}

// All candidates as arrows with their probability, and the scan at the best.
Picture DrawCandidates(const MapPainter& painter,
                       const std::vector<RobotScan>& scans,
                       const ScanLocalization& result) {
  Picture picture = painter.Paint();
  const PixelFrame& frame = painter.frame();
  DrawMetricGrid(frame, &picture);
  const double text_size =
      std::max(10., 0.014 * std::max(picture.width(), picture.height()));
  for (size_t k = result.candidates.size(); k-- > 0;) {
    const ScanCandidate& candidate = result.candidates[k];
    if (k > 0 && candidate.probability < kMinDrawnProbability) continue;
    const Color color = CategoryColor(static_cast<int>(k));
    if (k == 0) {
      DrawEchoes(EchoesIn(scans, candidate.T_map_robot), frame, color,
                 &picture);
    }
    DrawArrow(candidate.T_map_robot, kArrowLength, frame, color, &picture);
    picture.DrawText(frame.ToPixels(candidate.T_map_robot.translation()) +
                         Eigen::Vector2d(0.6, -0.6) * text_size,
                     Percent(candidate.probability), text_size, color,
                     Picture::Anchor::kLeft);
  }
  DrawScaleBar(frame, &picture);
  return picture;
}

// What surrounds a candidate, with the scan at its pose.
Picture DrawScanAt(const OccupancyGrid& grid,
                   const std::vector<RobotScan>& scans,
                   const ScanCandidate& candidate, const Color& color,
                   const int max_pixels) {
  const std::vector<Eigen::Vector2d> echoes =
      EchoesIn(scans, candidate.T_map_robot);
  Eigen::AlignedBox2d bounds(candidate.T_map_robot.translation());
  for (const Eigen::Vector2d& echo : echoes) bounds.extend(echo);
  // A stray echo does not make the rest tiny.
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(30.);
  bounds = bounds.intersection(Eigen::AlignedBox2d(
      Eigen::Vector2d(candidate.T_map_robot.translation() - reach),
      Eigen::Vector2d(candidate.T_map_robot.translation() + reach)));
  CellGeometry shown;
  shown.resolution = grid.geometry.resolution;
  shown.size =
      ((bounds.sizes().array() + 2. * kScanMarginMeters) / shown.resolution)
          .ceil()
          .cast<int>();
  shown.T_submap_grid =
      Rigid2(Eigen::Vector2d(bounds.min().array() - kScanMarginMeters), 0.);
  MapPainter painter({{shown, Rigid2()}}, max_pixels);
  painter.AddSubmap(grid, Rigid2());
  Picture picture = painter.Paint();
  DrawEchoes(echoes, painter.frame(), color, &picture);
  DrawArrow(candidate.T_map_robot, 0.5 * kArrowLength, painter.frame(), color,
            &picture);
  DrawScaleBar(painter.frame(), &picture);
  return picture;
}

std::vector<std::pair<std::string, std::string>> ScanSummary(
    const ScanLocalization& result) {
  std::vector<std::pair<std::string, std::string>> summary = {
      {"Answer", LocalizationVerdictName(result.verdict)},
      {"Reason", result.reason}};
  if (result.elsewhere_probability) {
    summary.emplace_back(
        "Probability of being elsewhere",
        absl::StrFormat("%.4f", *result.elsewhere_probability));
  }
  for (size_t k = 0; k < result.candidates.size(); ++k) {
    const ScanCandidate& candidate = result.candidates[k];
    if (k > 0 && candidate.probability < kMinDrawnProbability) break;
    summary.emplace_back(
        absl::StrCat("Candidate ", k + 1),
        absl::StrFormat(
            "probability %.4f at %s; standard deviation %.2f m in x, %.2f m "
            "in y, %.1f degrees; beams: %.0f %% at walls, %.0f %% through "
            "walls, %.0f %% in free space, %.0f %% in unknown space",
            candidate.probability, FormatPose(candidate.T_map_robot),
            std::sqrt(candidate.covariance(0, 0)),
            std::sqrt(candidate.covariance(1, 1)),
            std::sqrt(candidate.covariance(2, 2)) * 180. / M_PI,
            100. * candidate.evidence.at_wall,
            100. * candidate.evidence.through_wall,
            100. * candidate.evidence.in_free_space,
            100. * candidate.evidence.in_unknown));
  }
  return summary;
}

}  // namespace

absl::Status WriteScanReport(const ReportRequest& request,
                             const std::string& map_name,
                             const std::string& scan_name,
                             const OccupancyGrid& grid,
                             const std::vector<RobotScan>& scans,
                             const ScanLocalization& result) {
  ReportContent content;
  content.title =
      absl::StrCat("Where in ", map_name, " was ", scan_name, " taken?");
  content.subtitle =
      "Found by comparing the scan with the whole map, without "
      "a pose prior.";
  content.summary = ScanSummary(result);
  if (result.verdict != LocalizationVerdict::kLocalized) {
    content.warnings.push_back("Not localized: " + result.reason);
  }
  content.stages = result.stage_seconds;
  content.options = request.options_text;
  const MapPainter painter = PaintMap(grid, request.options.map_picture_pixels);
  content.maps.push_back(
      {"The map with all candidates of 1 % and more, and the scan at the best",
       DrawCandidates(painter, scans, result).EncodePng()});
  for (size_t k = 0; k < std::min(kNumPictures, result.candidates.size());
       ++k) {
    const ScanCandidate& candidate = result.candidates[k];
    if (k > 0 && candidate.probability < kMinDrawnProbability) break;
    content.maps.push_back(
        {absl::StrCat("The scan at candidate ", k + 1, ", ",
                      Percent(candidate.probability)),
         DrawScanAt(grid, scans, candidate, CategoryColor(static_cast<int>(k)),
                    request.options.closure_picture_pixels)
             .EncodePng()});
  }
  return WriteReport(request.directory, content);
}

}  // namespace cartographer_sdf
