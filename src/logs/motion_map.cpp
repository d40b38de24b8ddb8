// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/motion_map.hpp"

#include "logs/signal_map.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

TimeMap time_map_of(const toml::table& node, const std::string& file, const char* where) {
  TomlFields table(node, file, where);
  TimeMap time;
  time.line = table.line();
  time.file = table.text("file");
  time.clock = table.clock();
  const std::string from = table.text("from", table.has("field") ? "field" : "stamp");
  if (from == "stamp") {
    time.from = TimeMap::From::stamp;
  } else if (from == "log") {
    time.from = TimeMap::From::log;
  } else if (from == "publish") {
    time.from = TimeMap::From::publish;
  } else if (from == "field") {
    time.from = TimeMap::From::field;
    time.field = table.needed_text("field");
    time.calendar = table.text("unit", "s") == "calendar";
    if (!time.calendar) time.unit = unit_of(table, "unit", "s", {Quantity::time}).si;
    time.fraction = table.text("fraction");
    time.fraction_unit = unit_of(table, "fraction_unit", "ns", {Quantity::time}).si;
    if (!time.fraction.empty() && time.calendar) {
      table.fail("has a date and time and a fraction, expected one of them");
    }
  } else {
    table.fail("from is \"" + from + "\", expected stamp, log, publish or field");
  }
  table.finish();
  return time;
}

PoseFields pose_fields_of(TomlFields& table) {
  PoseFields fields;
  fields.x = table.text("x");
  fields.y = table.text("y");
  fields.heading = table.text("heading");
  fields.quaternion = quaternion_of(table);
  fields.unit = unit_of(table, "unit", "m", {Quantity::length}).si;
  fields.heading_unit =
      unit_of(table, "heading_unit", "rad", {Quantity::angle}).si * table.sign("heading_sign");
  const bool both = !fields.x.empty() && !fields.y.empty();
  const bool turned = fields.heading.empty() != fields.quaternion.empty();
  const bool none =
      fields.x.empty() && fields.y.empty() && fields.heading.empty() && fields.quaternion.empty();
  if (!none && !(both && turned)) {
    table.fail("has a part of a pose, expected x, y and one of heading and quaternion");
  }
  return fields;
}

}  // namespace

std::vector<std::string> quaternion_of(TomlFields& table) {
  std::vector<std::string> paths = table.texts("quaternion");
  constexpr std::size_t kAll = 4;
  constexpr std::size_t kUpright = 2;
  if (!paths.empty() && paths.size() != kAll && paths.size() != kUpright) {
    table.fail(*table.find("quaternion"),
               "quaternion is no list of four or two fields, expected those of x, y, z and w, or "
               "of z and w");
  }
  return paths;
}

std::vector<TimeMap> times_of(const toml::node& node, const std::string& file) {
  if (node.is_table()) return {time_map_of(*node.as_table(), file, "[time]")};
  const toml::array* all = node.as_array();
  if (all == nullptr || !all->is_array_of_tables()) {
    throw InputError(file, node.source().begin.line,
                     "time is no table, expected [time], or [[time]] for each file");
  }
  std::vector<TimeMap> times;
  for (const toml::node& one : *all) {
    times.push_back(time_map_of(*one.as_table(), file, "[[time]]"));
    const TimeMap& last = times.back();
    const bool again = std::any_of(times.begin(), times.end() - 1,
                                   [&](const TimeMap& other) { return other.file == last.file; });
    if (!again) continue;
    throw InputError(file, last.line,
                     "a second [[time]] " +
                         (last.file.empty() ? "without a file" : "of " + last.file) +
                         ", expected one for each file");
  }
  return times;
}

OdometryMap odometry_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[odometry]");
  OdometryMap odometry;
  odometry.line = table.line();
  odometry.file = table.text("file");
  odometry.twist = table.text("twist");
  odometry.pose = table.text("pose");
  odometry.clock = table.clock();
  odometry.compare = table.flag("compare", false);
  odometry.modules = table.text("modules");
  odometry.places = table.points("places");
  constexpr std::size_t kFewestModules = 2;
  if (odometry.modules.empty() != odometry.places.empty() ||
      (!odometry.places.empty() && odometry.places.size() < kFewestModules)) {
    table.fail(
        "has modules without their places, or places without modules, expected both, of two "
        "or more: places = [[0.3, 0.3], [0.3, -0.3], ...]");
  }
  odometry.fields = pose_fields_of(table);
  odometry.speed = table.text("speed");
  odometry.turn_rate = table.text("turn_rate");
  odometry.sideways = table.text("sideways");
  odometry.speed_unit = unit_of(table, "speed_unit", "m/s", {Quantity::speed}).si;
  odometry.turn_rate_unit = unit_of(table, "turn_rate_unit", "rad/s", {Quantity::turn_rate}).si *
                            table.sign("turn_rate_sign");
  if (odometry.speed.empty() != odometry.turn_rate.empty() ||
      (odometry.speed.empty() && !odometry.sideways.empty())) {
    table.fail("has a part of the velocities, expected speed and turn_rate");
  }
  const int ways = (odometry.twist.empty() ? 0 : 1) + (odometry.pose.empty() ? 0 : 1) +
                   (odometry.fields.empty() ? 0 : 1) + (odometry.speed.empty() ? 0 : 1) +
                   (odometry.modules.empty() ? 0 : 1);
  if (ways != 1) {
    table.fail(
        "needs either a twist or a pose, expected the path of one, or the fields of one: speed and "
        "turn_rate, or x, y and heading (or modules)");
  }
  table.finish();
  return odometry;
}

TruthMap truth_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[truth]");
  TruthMap truth;
  truth.line = table.line();
  truth.file = table.text("file");
  truth.pose = table.text("pose");
  truth.fields = pose_fields_of(table);
  truth.clock = table.clock();
  if (truth.pose.empty() == truth.fields.empty()) {
    table.fail("needs either a pose, or x, y and heading, expected one of them");
  }
  table.finish();
  return truth;
}

}  // namespace trussmap::logs
