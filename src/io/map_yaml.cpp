// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

namespace trussmap {
namespace {

// Of what the map does not know, and a reader must not count on.
constexpr double kUnknownVariance = 1e6;

/// The number that the name ends in: 5 of tag36h11:5, tag_5 and 5.
std::optional<int> number_in(const std::string& name) {
  const std::size_t last = name.find_last_not_of("0123456789");
  const std::size_t begin = last == std::string::npos ? 0 : last + 1;
  int number = 0;
  const auto read = std::from_chars(name.data() + begin, name.data() + name.size(), number);
  if (read.ec != std::errc()) return std::nullopt;
  return number;
}

/// Per landmark; none where the name has no number, or another landmark's has the same.
std::vector<std::optional<int>> yaml_ids_of(const LandmarkGraph& map) {
  std::vector<std::optional<int>> ids;
  std::map<int, int> bearers;
  for (int k = 0; k < map.landmarks(); ++k) {
    ids.push_back(number_in(map.landmark(k).name));
    if (ids.back()) ++bearers[*ids.back()];
  }
  for (std::optional<int>& one : ids) {
    if (one && bearers[*one] > 1) one.reset();
  }
  return ids;
}

/// Shortest text that reads back to the same number, in YAML 1.1 and 1.2: always with a point.
std::string yaml_number(double value) {
  std::string text = io::csv_number(value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

std::string yaml_text(const std::string& text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20U || code == 0x7fU) {
      quoted += "\\x";
      quoted += kDigits[code >> 4U];
      quoted += kDigits[code & 0xfU];
      continue;
    }
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string yaml_comment(const std::string& comment) {
  if (comment.empty()) return "";
  std::string text = "# ";
  for (const char c : comment) {
    text += c;
    if (c == '\n') text += "# ";
  }
  return text + '\n';
}

double half_turn(const Landmark& landmark) {
  return 0.5 * wrap_angle(landmark.heading.value_or(0.0));
}

/// Rows of geometry_msgs/PoseWithCovariance: x, y, z, roll, pitch, yaw.
std::string covariance_text(const Landmark& landmark) {
  constexpr int kSize = 6;
  constexpr int kYaw = 5;
  Eigen::Matrix<double, kSize, kSize> C =
      kUnknownVariance * Eigen::Matrix<double, kSize, kSize>::Identity();
  C.topLeftCorner<2, 2>() = *landmark.covariance;
  if (landmark.heading && landmark.sd_heading) C(kYaw, kYaw) = std::pow(*landmark.sd_heading, 2);
  std::string text = "[";
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) {
      if (i + j > 0) text += ", ";
      text += yaml_number(C(i, j));
    }
  }
  return text + ']';
}

std::string markers_text(const LandmarkGraph& map, const std::vector<std::optional<int>>& ids,
                         const YamlMapOptions& options) {
  std::string text = "frame_id: " + yaml_text(options.frame) + "\nmarkers:";
  if (map.landmarks() == 0) return text + " []\n";
  text += '\n';
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& one = map.landmark(k);
    text += "  - name: " + yaml_text(one.name) + '\n';
    const std::optional<int> id = ids[static_cast<std::size_t>(k)];
    if (id) text += "    id: " + std::to_string(*id) + '\n';
    if (options.tag_size) text += "    size: " + yaml_number(*options.tag_size) + '\n';
    text += "    pose:\n      position: {x: " + yaml_number(one.position.x()) +
            ", y: " + yaml_number(one.position.y()) + ", z: 0.0}\n";
    text += "      orientation: {x: 0.0, y: 0.0, z: " + yaml_number(std::sin(half_turn(one))) +
            ", w: " + yaml_number(std::cos(half_turn(one))) + "}\n";
    if (one.covariance) text += "    covariance: " + covariance_text(one) + '\n';
  }
  return text;
}

std::string bundle_text(const LandmarkGraph& map, const std::vector<std::optional<int>>& ids,
                        const YamlMapOptions& options) {
  std::string text = "standalone_tags:\n  []\ntag_bundles:\n  - name: " + yaml_text(options.frame) +
                     "\n    layout:\n";
  for (int k = 0; k < map.landmarks(); ++k) {
    const std::optional<int> id = ids[static_cast<std::size_t>(k)];
    if (!id) continue;
    const Landmark& one = map.landmark(k);
    text += "      - {id: " + std::to_string(*id) + ", size: " + yaml_number(*options.tag_size) +
            ", x: " + yaml_number(one.position.x()) + ", y: " + yaml_number(one.position.y()) +
            ", z: 0.0, qw: " + yaml_number(std::cos(half_turn(one))) +
            ", qx: 0.0, qy: 0.0, qz: " + yaml_number(std::sin(half_turn(one))) + "}\n";
  }
  return text;
}

}  // namespace

YamlMap format_map_yaml(const LandmarkGraph& map, const YamlMapOptions& options) {
  if (options.tag_size && !(*options.tag_size > 0.0 && std::isfinite(*options.tag_size))) {
    throw std::invalid_argument("the tag size must be above 0");
  }
  const std::vector<std::optional<int>> ids = yaml_ids_of(map);
  YamlMap result;
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& one = map.landmark(k);
    if (!ids[static_cast<std::size_t>(k)]) result.without_id.push_back(one.name);
    if (!one.heading) result.without_heading.push_back(one.name);
  }
  result.text = yaml_comment(options.comment);
  if (options.layout == YamlLayout::markers) {
    result.text += markers_text(map, ids, options);
    return result;
  }
  if (!options.tag_size) throw std::invalid_argument("a bundle of tags needs the tags' size");
  if (static_cast<int>(result.without_id.size()) == map.landmarks()) {
    throw InputError("the map", 0,
                     "has no landmark whose name ends in a number of its own, expected tags such "
                     "as tag36h11:5, tag_5 or 5");
  }
  result.text += bundle_text(map, ids, options);
  return result;
}

}  // namespace trussmap
