// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_physics.hpp"
#include "io/csv.hpp"
#include "io/model_sections.hpp"
#include "io/toml_text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace trussmap::io {
namespace {

/// What [robot] holds of a drive besides its name.
struct DriveKeys {
  std::set<std::string_view> names;
  std::vector<std::string_view> needed;
  std::size_t columns_wanted;
  std::vector<std::string> columns;  ///< where nothing is said
};

const DriveKeys& keys_of(DriveKind drive) {
  static const std::map<DriveKind, DriveKeys> all{
      {DriveKind::differential, {{"wheelbase", "columns"}, {}, 2, {}}},
      {DriveKind::unicycle, {{"wheelbase", "columns"}, {}, 2, {"travel", "turn"}}},
      {DriveKind::skid_steer, {{"wheelbase", "columns"}, {"wheelbase"}, 2, {"left", "right"}}},
      {DriveKind::tricycle,
       {{"length", "steer_left", "columns"}, {"length"}, 2, {"wheel", "steer"}}},
      {DriveKind::ackermann,
       {{"length", "wheel_left", "steer_left", "columns"}, {"length"}, 2, {"wheel", "steer"}}},
      {DriveKind::omni3, {{"radius", "columns"}, {"radius"}, 3, {"wheel1", "wheel2", "wheel3"}}},
      {DriveKind::mecanum,
       {{"wheelbase", "length", "columns"},
        {"wheelbase", "length"},
        4,
        {"front_left", "front_right", "rear_left", "rear_right"}}},
      {DriveKind::wheels, {{"columns", "matrix", "wheel"}, {}, 0, {}}}};
  return all.at(drive);
}

void read_columns(const toml::node& node, Robot& result) {
  const toml::array* columns = node.as_array();
  if (columns == nullptr) refuse(node.source(), "columns is no list, expected [\"...\", ...]");
  for (const toml::node& one : *columns) {
    result.columns.push_back(toml_words(one, "a column"));
    const auto twin =
        std::find(result.columns.begin(), result.columns.end() - 1, result.columns.back());
    if (twin != result.columns.end() - 1) {
      refuse(one.source(), "column \"" + *twin + "\" is named twice, expected each wheel once");
    }
  }
}

/// A table of [robot] that says where a sensor sits.
struct MountingKey {
  std::string_view name;
  std::optional<Mounting> Mountings::*place;
  bool turns = true;  ///< has a yaw
};

constexpr MountingKey kMountings[] = {{"sensor", &Mountings::sensor},
                                      {"antenna", &Mountings::antenna, false},
                                      {"tracked", &Mountings::tracked},
                                      {"scanner", &Mountings::scanner}};

const MountingKey* mounting_named(std::string_view name) {
  const auto* found = std::find_if(std::begin(kMountings), std::end(kMountings),
                                   [name](const MountingKey& one) { return one.name == name; });
  return found == std::end(kMountings) ? nullptr : found;
}

Mounting read_mounting(const toml::table& table, const MountingKey& kind) {
  Mounting result;
  for (const auto& [key, value] : table) {
    if (key == "x") {
      result.x = toml_figure(value, "x");
    } else if (key == "y") {
      result.y = toml_figure(value, "y");
    } else if (key == "yaw" && kind.turns) {
      result.yaw = toml_figure(value, "yaw");
    } else {
      refuse(key.source(),
             fmt::format("key \"{}\" in [robot.{}] is unknown, expected x, y{}",
                         std::string(key.str()), kind.name, kind.turns ? ", yaw" : ""));
    }
  }
  return result;
}

std::string mountings_text(const Mountings& mounted) {
  std::string text;
  for (const MountingKey& one : kMountings) {
    const std::optional<Mounting>& at = mounted.*one.place;
    if (!at) continue;
    text += fmt::format("[robot.{}]\nx = {}  # m ahead\ny = {}  # m to the left\n", one.name,
                        toml_number(at->x), toml_number(at->y));
    if (one.turns && at->yaw != 0.0) text += "yaw = " + toml_number(at->yaw) + "  # rad\n";
  }
  return text;
}

/// Its column is added to `columns`.
WheelPlace read_place(const toml::node& wheel, std::vector<std::string>& columns) {
  WheelPlace place;
  for (const auto& [key, value] : *wheel.as_table()) {
    if (key == "column") {
      columns.push_back(toml_words(value, "column"));
    } else if (key == "x") {
      place.x = toml_figure(value, "x");
    } else if (key == "y") {
      place.y = toml_figure(value, "y");
    } else if (key == "direction") {
      place.direction = toml_figure(value, "direction");
    } else if (key == "roller") {
      place.roller = toml_figure(value, "roller");
      if (!(std::abs(std::cos(place.roller)) > 1e-3)) {
        refuse(value.source(), "roller is " + csv_number(place.roller) +
                                   ", expected the angle from the wheel's direction to its "
                                   "rollers' axes, less than a quarter turn (rad)");
      }
    } else {
      refuse(key.source(), "key \"" + std::string(key.str()) +
                               "\" in [[robot.wheel]] is unknown, expected column, x, y, "
                               "direction, roller");
    }
  }
  return place;
}

void read_places(const toml::node& node, Robot& result) {
  for (const toml::node& one : toml_tables(node, "wheel", "[[robot.wheel]]")) {
    result.places.push_back(read_place(one, result.columns));
    if (result.columns.size() != result.places.size()) {
      refuse(one.source(), "a wheel has no column, expected the name of its column of drive.csv");
    }
  }
}

void read_matrix(const toml::node& node, Robot& result) {
  const toml::array* rows = node.as_array();
  const auto count = result.columns.size();
  if (rows == nullptr || rows->size() != 3) {
    refuse(node.source(), "matrix is no list of three rows, expected forward, sideways and turn");
  }
  result.matrix.resize(3, static_cast<Eigen::Index>(count));
  for (std::size_t row = 0; row < 3; ++row) {
    const toml::array* numbers = (*rows)[row].as_array();
    if (numbers == nullptr || numbers->size() != count) {
      refuse(
          (*rows)[row].source(),
          fmt::format("a row of matrix is no list of {} numbers, expected one per column", count));
    }
    for (std::size_t k = 0; k < count; ++k) {
      result.matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k)) =
          toml_figure((*numbers)[k], "an entry of matrix");
    }
  }
}

/// How many columns, what they are called if nothing is said, and what else is asked.
void finish_robot(const toml::table& robot, const DriveKeys& keys, Robot& result) {
  constexpr std::size_t kMostWheels = 6;  // wheel1 ... wheel6
  if (result.columns.empty()) result.columns = keys.columns;
  const std::size_t count = result.columns.size();
  if (result.drive == DriveKind::wheels) {
    const toml::node* matrix = robot.get("matrix");
    if ((matrix == nullptr) == result.places.empty()) {
      refuse(robot.source(),
             "drive wheels needs either [[robot.wheel]] or columns and a matrix, expected one");
    }
    if (count < 2 || count > kMostWheels) {
      refuse(robot.source(),
             fmt::format("drive wheels has {} columns, expected 2 to {}", count, kMostWheels));
    }
    if (matrix != nullptr) {
      read_matrix(*matrix, result);
    } else {
      result.matrix = told(robot, "", [&] { return wheel_matrix(result.places); });
    }
  } else if (result.drive == DriveKind::skid_steer ? count != 2 && count != 4 && count != 6
             : result.drive == DriveKind::unicycle
                 ? count != 1 && count != 2
                 : !result.columns.empty() && count != keys.columns_wanted) {
    refuse(robot.source(),
           fmt::format(
               "drive {} has {} columns, expected {}", name_of(result.drive), count,
               result.drive == DriveKind::skid_steer ? "2, 4 or 6, those of the left side first"
               : result.drive == DriveKind::unicycle ? "travel and turn, or travel beside a gyro"
                                                     : std::to_string(keys.columns_wanted)));
  }
  if (keys.names.find("wheelbase") != keys.names.end()) return;
  // Of no meaning then but for how turns are written as travels of two wheels.
  if (result.length > 0.0) result.wheelbase = result.length;
  result.wheelbase_stated = true;
}

std::string list_text(const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& one : values) text += (text.empty() ? "" : ", ") + one;
  return "[" + text + "]";
}

}  // namespace

Robot read_robot(const toml::table& robot) {
  Robot result;
  result.wheelbase_stated = false;
  if (const toml::node* drive = robot.get("drive")) {
    result.drive = told(*drive, "", [&] { return drive_named(toml_words(*drive, "drive")); });
  }
  const DriveKeys& keys = keys_of(result.drive);
  for (const auto& [key, node] : robot) {
    const std::string_view name = key.str();
    if (const MountingKey* mounting = mounting_named(name)) {
      result.mounted.*mounting->place =
          read_mounting(toml_table(node, "[robot." + std::string(name) + "]"), *mounting);
      continue;
    }
    if (name != "drive" && keys.names.find(name) == keys.names.end()) {
      std::string expected;
      for (const std::string_view one : keys.names) expected += ", " + std::string(one);
      refuse(key.source(), fmt::format("key \"{}\" in [robot] is unknown for drive {}, expected "
                                       "drive{}, sensor, antenna, tracked, scanner",
                                       name, name_of(result.drive), expected));
    }
    if (name == "wheelbase") {
      result.wheelbase = toml_length(node, "wheelbase");
      result.wheelbase_stated = true;
    } else if (name == "length" || name == "radius") {
      result.length = toml_length(node, std::string(name));
    } else if (name == "wheel_left") {
      result.wheel_left = toml_figure(node, "wheel_left");
    } else if (name == "steer_left") {
      result.steer_left = toml_figure(node, "steer_left");
    } else if (name == "columns") {
      read_columns(node, result);
    } else if (name == "wheel") {
      read_places(node, result);
    }
  }
  for (const std::string_view needed : keys.needed) {
    if (!robot.contains(needed)) {
      refuse(robot.source(), fmt::format("[robot] has no {}, expected one of drive {}", needed,
                                         name_of(result.drive)));
    }
  }
  finish_robot(robot, keys, result);
  return result;
}

std::string robot_text(const Robot& robot) {
  std::string text = "[robot]\n";
  const DriveKeys& keys = keys_of(robot.drive);
  const auto has = [&keys](const char* name) { return keys.names.find(name) != keys.names.end(); };
  if (robot.drive != DriveKind::differential) {
    text += "drive = " + toml_string(std::string(name_of(robot.drive))) + "\n";
  }
  if (has("wheelbase")) text += "wheelbase = " + toml_number(robot.wheelbase) + "  # m\n";
  if (has("length")) text += "length = " + toml_number(robot.length) + "  # m\n";
  if (has("radius")) text += "radius = " + toml_number(robot.length) + "  # m\n";
  if (has("wheel_left") && robot.wheel_left != 0.0) {
    text += "wheel_left = " + toml_number(robot.wheel_left) + "  # m\n";
  }
  if (has("steer_left") && robot.steer_left != 0.0) {
    text += "steer_left = " + toml_number(robot.steer_left) + "  # m\n";
  }
  if (!robot.columns.empty() && robot.places.empty()) {
    std::vector<std::string> names;
    for (const std::string& one : robot.columns) names.push_back(toml_string(one));
    text += "columns = " + list_text(names) + "\n";
  }
  if (robot.drive == DriveKind::wheels && robot.places.empty()) {
    std::vector<std::string> rows;
    for (Eigen::Index row = 0; row < 3; ++row) {
      std::vector<std::string> numbers;
      for (const double one : robot.matrix.row(row)) numbers.push_back(toml_number(one));
      rows.push_back(list_text(numbers));
    }
    text += "matrix = " + list_text(rows) + "  # to forward, sideways, turn\n";
  }
  for (std::size_t k = 0; k < robot.places.size(); ++k) {
    const WheelPlace& one = robot.places[k];
    text += "[[robot.wheel]]\ncolumn = " + toml_string(robot.columns[k]) +
            "\nx = " + toml_number(one.x) + "\ny = " + toml_number(one.y) +
            "\ndirection = " + toml_number(one.direction) + "\n";
    if (one.roller != 0.0) text += "roller = " + toml_number(one.roller) + "\n";
  }
  return text + mountings_text(robot.mounted);
}

}  // namespace trussmap::io
