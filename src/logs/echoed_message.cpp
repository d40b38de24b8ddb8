// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/echoed_message.hpp"

#include "logs/ros2_definition.hpp"
#include "logs/table_layout.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace trussmap::logs {
namespace {

using Rows = std::vector<std::vector<std::string>>;

struct EchoedField {
  std::string name;
  bool text = false;
  bool whole = false;
};

/// With a stamp, and of always the same length. Types of the same fields in the same order but for
/// their names cannot be told apart: the commonest is here.
constexpr const char* kTypes[] = {"nav_msgs/Odometry",
                                  "sensor_msgs/Imu",
                                  "geometry_msgs/PoseWithCovarianceStamped",
                                  "geometry_msgs/PoseStamped",
                                  "geometry_msgs/TransformStamped",
                                  "geometry_msgs/TwistWithCovarianceStamped",
                                  "geometry_msgs/TwistStamped",
                                  "geometry_msgs/QuaternionStamped",
                                  "geometry_msgs/PointStamped",
                                  "sensor_msgs/NavSatFix",
                                  "sensor_msgs/MagneticField",
                                  "sensor_msgs/Temperature",
                                  "sensor_msgs/Range"};

void flatten(const Ros2Layout& layout, std::size_t group, const std::string& before,
             std::vector<EchoedField>& found) {
  for (const Ros2Field& field : layout.groups[group].fields) {
    const bool list = field.list == Ros2List::fixed;
    for (std::uint64_t k = 0; k < (list ? field.count : 1); ++k) {
      const std::string name =
          before + field.name + (list ? '[' + std::to_string(k) + ']' : std::string());
      if (field.type == Ros2Type::group) {
        flatten(layout, field.group, name + '.', found);
      } else {
        const bool number = field.type == Ros2Type::float32 || field.type == Ros2Type::float64;
        const bool text = field.type == Ros2Type::text || field.type == Ros2Type::wide_text;
        found.push_back({name, text, !number && !text});
      }
    }
  }
}

std::optional<double> number_in(const std::string& cell) {
  CellReader reader('.');
  if (reader.read(cell) != CellKind::number) return std::nullopt;
  return reader.number();
}

bool is_cell_of(const EchoedField& field, const std::string& cell) {
  CellReader reader('.');
  const CellKind kind = reader.read(cell);
  if (field.text) return kind != CellKind::number;
  if (kind == CellKind::text || cell.empty()) return false;
  if (field.whole && !(kind == CellKind::number && reader.whole())) return false;
  constexpr std::int64_t kSecond = 1000000000;
  const bool nanoseconds = field.name.ends_with("nanosec");
  return !nanoseconds || (reader.integer() >= 0 && reader.integer() < kSecond);
}

/// Whether each quaternion in the row has a length of 1, or 0 where none was read.
bool has_rotations(const std::vector<EchoedField>& fields, const std::vector<std::string>& row) {
  constexpr std::size_t kParts = 4;
  for (std::size_t k = 0; k + kParts <= fields.size(); ++k) {
    const std::string& name = fields[k].name;
    const bool turned = name.ends_with("orientation.x") || name.ends_with("rotation.x") ||
                        name.ends_with("quaternion.x");
    if (!turned) continue;
    double sum = 0.0;
    for (std::size_t j = 0; j < kParts; ++j) {
      const double part = number_in(row[k + j]).value_or(0.0);
      sum += part * part;
    }
    constexpr double kOff = 0.1;
    if (sum != 0.0 && std::abs(std::sqrt(sum) - 1.0) > kOff) return false;
  }
  return true;
}

bool are_like(const std::vector<EchoedField>& fields, const Rows& rows) {
  return std::all_of(rows.begin(), rows.end(), [&](const std::vector<std::string>& row) {
    for (std::size_t k = 0; k < fields.size(); ++k) {
      if (!is_cell_of(fields[k], row[k])) return false;
    }
    return has_rotations(fields, row);
  });
}

/// JointState: header, names of the joints, their positions, velocities and efforts, of which lists
/// at the end may be missing.
std::vector<EchoedField> joint_fields(const std::vector<std::string>& row) {
  std::vector<EchoedField> fields{{"header.stamp.sec", false, true},
                                  {"header.stamp.nanosec", false, true},
                                  {"header.frame_id", true, false}};
  const std::size_t first = fields.size();
  std::size_t joints = 0;
  while (first + joints < row.size() && !row[first + joints].empty() &&
         !number_in(row[first + joints])) {
    fields.push_back({"name[" + std::to_string(joints++) + "]", true, false});
  }
  const std::size_t rest = row.size() - std::min(row.size(), first + joints);
  constexpr const char* kLists[] = {"position", "velocity", "effort"};
  if (joints == 0 || rest == 0 || rest % joints != 0 || rest / joints > std::size(kLists)) {
    return {};
  }
  for (std::size_t k = 0; k < rest; ++k) {
    const std::string& joint = row[first + k % joints];
    fields.push_back({std::string(kLists[k / joints]) + '[' + joint + ']', false, false});
  }
  return fields;
}

std::vector<std::string> names_of(const std::vector<EchoedField>& fields) {
  std::vector<std::string> names;
  for (const EchoedField& one : fields) names.push_back(one.name);
  return names;
}

}  // namespace

std::vector<std::string> echoed_columns(const Rows& rows) {
  constexpr std::size_t kLeast = 4;     // a stamp, a frame, a value
  constexpr std::size_t kTelling = 10;  // fields: of fewer the seconds must be those of a calendar
  constexpr double kCalendar = 1e8;     // s
  const std::vector<std::string>& row = rows.front();
  if (row.size() < kLeast) return {};
  if (row.size() < kTelling && !(number_in(row.front()).value_or(0.0) > kCalendar)) return {};
  for (const char* const type : kTypes) {
    std::vector<EchoedField> fields;
    flatten(parse_ros2_definition(type, ""), 0, "", fields);
    if (fields.size() == row.size() && are_like(fields, rows)) return names_of(fields);
  }
  const std::vector<EchoedField> joints = joint_fields(row);
  if (joints.empty() || !are_like(joints, rows)) return {};
  const bool same = std::all_of(rows.begin(), rows.end(), [&](const auto& other) {
    return names_of(joint_fields(other)) == names_of(joints);
  });
  return same ? names_of(joints) : std::vector<std::string>();
}

}  // namespace trussmap::logs
