// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/map_image/ros_map.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/map_image/grey_image.h"

namespace cartographer_sdf {
namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kMaxYamlSize = 65536;
constexpr double kMaxOrigin = 1e6;  // [m]

std::string ExtensionOf(const std::string& path) {
  return absl::AsciiStrToLower(fs::path(path).extension().string());
}

bool IsYamlName(const std::string& path) {
  const std::string extension = ExtensionOf(path);
  return extension == ".yaml" || extension == ".yml";
}

enum class RosMapMode { kTrinary, kScale, kRaw };

struct MapDescription {
  std::string image;
  double resolution = 0.;
  double origin[3] = {0., 0., 0.};
  bool negate = false;
  double occupied_threshold = 0.65;
  double free_threshold = 0.196;
  RosMapMode mode = RosMapMode::kTrinary;
};

absl::StatusOr<RosMapMode> ModeOf(const std::string& name) {
  if (name == "trinary") return RosMapMode::kTrinary;
  if (name == "scale") return RosMapMode::kScale;
  if (name == "raw") return RosMapMode::kRaw;
  return absl::InvalidArgumentError("mode must be trinary, scale or raw");
}

// "0", "1", "false" or "true".
bool ReadNegate(const YAML::Node& node) {
  const std::string text = absl::AsciiStrToLower(node.as<std::string>());
  return text != "0" && text != "false";
}

// Throws what yaml-cpp throws.
absl::StatusOr<MapDescription> ReadMembers(const std::string& text) {
  const YAML::Node yaml = YAML::Load(text);
  if (!yaml.IsMap()) return absl::InvalidArgumentError("it has no members");
  for (const char* const name : {"image", "resolution", "origin"}) {
    if (!yaml[name]) {
      return absl::InvalidArgumentError(absl::StrCat("it has no ", name));
    }
  }
  MapDescription description;
  description.image = yaml["image"].as<std::string>();
  description.resolution = yaml["resolution"].as<double>();
  if (!yaml["origin"].IsSequence() || yaml["origin"].size() < 2) {
    return absl::InvalidArgumentError("origin is not a list of three numbers");
  }
  for (size_t k = 0; k < std::min<size_t>(3, yaml["origin"].size()); ++k) {
    description.origin[k] = yaml["origin"][k].as<double>();
  }
  if (yaml["negate"]) description.negate = ReadNegate(yaml["negate"]);
  if (yaml["occupied_thresh"]) {
    description.occupied_threshold = yaml["occupied_thresh"].as<double>();
  }
  if (yaml["free_thresh"]) {
    description.free_threshold = yaml["free_thresh"].as<double>();
  }
  if (yaml["mode"]) {
    const absl::StatusOr<RosMapMode> mode =
        ModeOf(yaml["mode"].as<std::string>());
    if (!mode.ok()) return mode.status();
    description.mode = *mode;
  }
  return description;
}

absl::Status CheckDescription(const MapDescription& description) {
  if (!(description.resolution >= 0.01 && description.resolution <= 1.)) {
    return absl::InvalidArgumentError(
        "resolution must lie between 0.01 m and 1 m");
  }
  for (const double value : description.origin) {
    if (!(std::abs(value) <= kMaxOrigin)) {
      return absl::InvalidArgumentError("origin is absurdly far away");
    }
  }
  if (!(description.free_threshold >= 0. &&
        description.free_threshold <= description.occupied_threshold &&
        description.occupied_threshold <= 1.)) {
    return absl::InvalidArgumentError(
        "free_thresh and occupied_thresh must lie between 0 and 1, in this "
        "order");
  }
  return absl::OkStatus();
}

absl::StatusOr<MapDescription> ReadDescription(const std::string& path) {
  std::error_code error;
  const uintmax_t size = fs::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (error || !in) return absl::NotFoundError("it cannot be read");
  if (size > kMaxYamlSize) {
    return absl::InvalidArgumentError("it is too large to describe a map");
  }
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  absl::StatusOr<MapDescription> description;
  try {
    description = ReadMembers(text);
  } catch (const YAML::Exception& exception) {
    return absl::InvalidArgumentError(exception.what());
  }
  if (!description.ok()) return description;
  const absl::Status status = CheckDescription(*description);
  if (!status.ok()) return status;
  return description;
}

// The probability that a pixel is occupied; nullopt where unknown.
std::optional<float> Interpret(const MapDescription& description,
                               const float brightness,
                               const bool is_transparent) {
  constexpr float kFree = 0.1f, kOccupied = 0.9f;
  if (description.mode == RosMapMode::kRaw) {
    const float value = std::round(255.f * brightness);
    if (value > 100.f) return std::nullopt;
    return std::clamp(value / 100.f, kFree, kOccupied);
  }
  if (is_transparent) return std::nullopt;
  const float probability = description.negate ? brightness : 1.f - brightness;
  if (probability > static_cast<float>(description.occupied_threshold)) {
    return kOccupied;
  }
  if (probability < static_cast<float>(description.free_threshold)) {
    return kFree;
  }
  if (description.mode == RosMapMode::kTrinary) return std::nullopt;
  return std::clamp(probability, kFree, kOccupied);
}

OccupancyGrid GridOf(const MapDescription& description,
                     const GreyImage& image) {
  CellGeometry geometry;
  geometry.size = Eigen::Array2i(static_cast<int>(image.brightness.rows()),
                                 static_cast<int>(image.brightness.cols()));
  geometry.resolution = description.resolution;
  geometry.T_submap_grid = Rigid2(description.origin[0], description.origin[1],
                                  description.origin[2]);
  OccupancyGrid grid = UnknownGrid(geometry);
  for (Eigen::Index k = 0; k < image.brightness.size(); ++k) {
    const bool is_transparent =
        image.transparent.size() > 0 && image.transparent.data()[k];
    const std::optional<float> probability =
        Interpret(description, image.brightness.data()[k], is_transparent);
    if (!probability) continue;
    grid.known.data()[k] = true;
    grid.probability.data()[k] = *probability;
  }
  return grid;
}

absl::StatusOr<std::string> YamlPathOf(const std::string& path) {
  if (IsYamlName(path)) return path;
  for (const char* const extension : {".yaml", ".yml"}) {
    const std::string yaml = fs::path(path).replace_extension(extension);
    std::error_code ignored;
    if (fs::exists(yaml, ignored)) return yaml;
  }
  return absl::NotFoundError(absl::StrCat(
      path, " is an image without a file that says what it means: ",
      fs::path(path).replace_extension(".yaml").string(), " is missing"));
}

}  // namespace

bool IsRosMapName(const std::string& path) {
  const std::string extension = ExtensionOf(path);
  return IsYamlName(path) || extension == ".pgm" || extension == ".png";
}

absl::StatusOr<OccupancyGrid> ReadRosMap(const std::string& path) {
  const absl::StatusOr<std::string> yaml_path = YamlPathOf(path);
  if (!yaml_path.ok()) return yaml_path.status();
  const absl::StatusOr<MapDescription> description =
      ReadDescription(*yaml_path);
  if (!description.ok()) {
    return absl::Status(
        description.status().code(),
        absl::StrCat(*yaml_path, " is no description of a map: ",
                     description.status().message()));
  }
  const std::string image_path =
      fs::path(*yaml_path).parent_path() / description->image;
  const absl::StatusOr<GreyImage> image = ExtensionOf(image_path) == ".png"
                                              ? ReadPngImage(image_path)
                                              : ReadPgmImage(image_path);
  if (!image.ok()) return image.status();
  return GridOf(*description, *image);
}

}  // namespace cartographer_sdf
