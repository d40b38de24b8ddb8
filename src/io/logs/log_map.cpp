// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/log_map.hpp"

#include "io/logs/toml_fields.hpp"
#include "io/logs/units.hpp"
#include "io/model_tables.hpp"
#include "io/survey_csv.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// The unit under `key`, of one of these quantities.
Unit unit_of(TomlFields& table, const char* key, const char* otherwise,
             const std::vector<Quantity>& allowed) {
  const std::string name = table.text(key, otherwise);
  const std::optional<Unit> unit = unit_named(name);
  if (unit && std::find(allowed.begin(), allowed.end(), unit->quantity) != allowed.end()) {
    return *unit;
  }
  std::string expected;
  for (const Quantity one : allowed) {
    const std::string names = unit_names(one);
    if (!names.empty()) expected += (expected.empty() ? "" : ", ") + names;
  }
  const std::string what =
      fmt::format("{} \"{}\" is no unit for it, expected one of {}", key, name, expected);
  if (const toml::node* node = table.find(key)) table.fail(*node, what);
  table.fail("has no " + std::string(key) + ", expected one of " + expected);
}

SignalMap::Kind kind_of(TomlFields& table, SignalMap::Kind otherwise) {
  if (!table.has("kind")) return otherwise;
  const std::string name = table.text("kind");
  if (name == "level") return SignalMap::Kind::level;
  if (name == "cumulative") return SignalMap::Kind::cumulative;
  if (name == "per row") return SignalMap::Kind::per_row;
  if (name == "rate") return SignalMap::Kind::rate;
  table.fail(*table.find("kind"),
             "kind is \"" + name + "\", expected level, cumulative, per row or rate");
}

SignalMap signal_of(TomlFields& table) {
  SignalMap signal;
  signal.line = table.line();
  signal.field = table.needed_text("field");
  signal.clock = table.number("clock", 0.0);
  signal.on_change = table.positive("on_change", 0.0);
  return signal;
}

/// m per radian that the wheel turns; 0 where neither radius nor diameter is stated.
double radius_of(TomlFields& table) {
  const double radius = table.positive("radius", 0.0);
  const double diameter = table.positive("diameter", 0.0);
  if (radius > 0.0 && diameter > 0.0) {
    table.fail("has a radius and a diameter, expected one of them");
  }
  return radius > 0.0 ? radius : 0.5 * diameter;
}

/// m per unit of a wheel's field.
double metres_per_unit(TomlFields& table, const Unit& unit) {
  const double radius = radius_of(table);
  const double per_tick = table.positive("metres_per_tick", 0.0);
  const double per_turn = table.positive("ticks_per_turn", 0.0);
  if (unit.quantity == Quantity::length || unit.quantity == Quantity::speed) return unit.si;
  if (unit.quantity != Quantity::ticks) {
    if (radius > 0.0) return unit.si * radius;
    table.fail(
        fmt::format("turns of the wheel (unit {}) need its radius or diameter, expected one "
                    "(m)",
                    unit.name));
  }
  if (per_tick > 0.0) return per_tick;
  if (per_turn > 0.0 && radius > 0.0) return kTurn * radius / per_turn;
  table.fail("ticks need metres_per_tick, or ticks_per_turn and radius, expected them");
}

SignalMap wheel_of(const toml::table& node, const std::string& file, const std::string& name,
                   bool steers) {
  TomlFields table(node, file, "[wheels." + name + "]");
  SignalMap signal = signal_of(table);
  const std::string& unit_text = table.text("unit", steers ? "rad" : "m");
  if (steers) {
    const Unit unit = unit_of(table, "unit", "rad", {Quantity::angle});
    signal.scale = unit.si * table.sign("sign");
    signal.offset = unit.si * table.number("offset", 0.0);
    signal.kind = SignalMap::Kind::rate;  // held since the message before
    table.finish();
    return signal;
  }
  const Unit unit = unit_of(
      table, "unit", "m",
      {Quantity::length, Quantity::angle, Quantity::ticks, Quantity::speed, Quantity::turn_rate});
  const bool rate = unit.quantity == Quantity::speed || unit.quantity == Quantity::turn_rate ||
                    unit_text.ends_with("/s");
  signal.kind = kind_of(table, rate ? SignalMap::Kind::rate : SignalMap::Kind::cumulative);
  if (rate && signal.kind != SignalMap::Kind::rate) {
    table.fail(fmt::format("unit {} is one of a rate, expected kind = \"rate\"", unit.name));
  }
  if (signal.kind == SignalMap::Kind::level) {
    table.fail("kind level is none of a wheel, expected cumulative, per row or rate");
  }
  signal.scale = metres_per_unit(table, unit) * table.sign("sign");
  signal.wraps = table.positive("wraps", 0.0);
  table.finish();
  return signal;
}

SignalMap heading_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[heading]");
  SignalMap signal = signal_of(table);
  signal.quaternion = table.text("unit", "rad") == "quaternion";
  const double si = signal.quaternion ? 1.0 : unit_of(table, "unit", "rad", {Quantity::angle}).si;
  signal.scale = si * table.sign("sign");
  signal.offset = si * table.number("offset", 0.0);
  // Readings next to each other are less than half a turn apart: interpolated the short way.
  signal.kind = SignalMap::Kind::cumulative;
  signal.wraps = kTurn / si;
  table.finish();
  return signal;
}

SignalMap yaw_rate_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[yaw_rate]");
  SignalMap signal = signal_of(table);
  signal.quaternion = table.text("unit", "rad/s") == "quaternion";
  if (signal.quaternion) {
    signal.kind = SignalMap::Kind::cumulative;
    signal.scale = table.sign("sign");
    signal.wraps = kTurn;
  } else {
    const Unit unit = unit_of(table, "unit", "rad/s", {Quantity::turn_rate, Quantity::angle});
    const bool rate = unit.quantity == Quantity::turn_rate;
    signal.kind = kind_of(table, rate ? SignalMap::Kind::rate : SignalMap::Kind::cumulative);
    if (rate != (signal.kind == SignalMap::Kind::rate) || signal.kind == SignalMap::Kind::level) {
      table.fail(
          fmt::format("kind does not go with unit {}, expected a rate in rad/s, deg/s or "
                      "turn/s, or a sum in rad, deg or turn",
                      unit.name));
    }
    signal.scale = unit.si * table.sign("sign");
    signal.wraps = kTurn / unit.si;
  }
  table.finish();
  return signal;
}

/// A field's name alone, or a table.
SignalMap covariate_of(const toml::node& node, const std::string& file, const std::string& name) {
  SignalMap signal;
  if (node.is_string()) {
    signal.field = *node.value<std::string>();
    signal.line = node.source().begin.line;
    return signal;
  }
  if (!node.is_table()) {
    throw InputError(file, node.source().begin.line,
                     "covariate " + name +
                         " is neither a text nor a table, expected the path of "
                         "its field");
  }
  TomlFields table(*node.as_table(), file, "[covariates." + name + "]");
  signal = signal_of(table);
  signal.scale = table.number("scale", 1.0);
  signal.offset = table.number("offset", 0.0);
  table.finish();
  return signal;
}

TimeMap time_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[time]");
  TimeMap time;
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
  } else {
    table.fail("from is \"" + from + "\", expected stamp, log, publish or field");
  }
  table.finish();
  return time;
}

SightingMap sighting_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[[sightings]]");
  SightingMap one;
  one.line = table.line();
  one.frames = table.text("frames");
  one.base = table.text("base", "base_link");
  one.prefix = table.text("prefix");
  one.none = table.texts("none");
  one.clock = table.number("clock", 0.0);
  one.with_yaw = table.flag("use_yaw", true);
  const std::string axis = table.text("axis", "x");
  if (axis != "x" && axis != "y" && axis != "z") {
    table.fail("axis is \"" + axis + "\", expected x, y or z");
  }
  one.axis = axis.front();
  if (one.frames.empty()) {
    one.topic = table.text("topic");
    one.each = table.text("each");
    one.landmark = table.text("landmark");
    one.name = table.text("name");
    one.range = table.text("range");
    one.bearing = table.text("bearing");
    one.yaw = table.text("yaw");
    one.position = table.text("position");
    one.sensor = table.text("sensor");
    one.changes = table.flag("changes", false);
    one.range_unit = unit_of(table, "range_unit", "m", {Quantity::length}).si;
    one.bearing_unit =
        unit_of(table, "bearing_unit", "rad", {Quantity::angle}).si * table.sign("bearing_sign");
    one.yaw_unit = unit_of(table, "yaw_unit", "rad", {Quantity::angle}).si * table.sign("yaw_sign");
    if (one.landmark.empty() == one.name.empty()) {
      table.fail("needs frames, or one of landmark (a field) and name, expected one of them");
    }
    if (!one.position.empty() && !(one.range.empty() && one.bearing.empty())) {
      table.fail("has a position and a range or bearing, expected one of them");
    }
  }
  table.finish();
  return one;
}

FixMap fixes_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[fixes]");
  FixMap fixes;
  fixes.line = table.line();
  fixes.topic = table.text("topic");
  fixes.x = table.text("x");
  fixes.y = table.text("y");
  fixes.latitude = table.text("latitude");
  fixes.longitude = table.text("longitude");
  fixes.sd = table.text("sd");
  fixes.quality = table.text("quality");
  fixes.unit = unit_of(table, "unit", "m", {Quantity::length}).si;
  fixes.sd_unit = unit_of(table, "sd_unit", "m", {Quantity::length}).si;
  fixes.clock = table.number("clock", 0.0);
  if (fixes.x.empty() != fixes.y.empty() || fixes.latitude.empty() != fixes.longitude.empty()) {
    table.fail("has one of two coordinates, expected x and y, or latitude and longitude");
  }
  table.finish();
  return fixes;
}

TruthMap truth_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[truth]");
  TruthMap truth;
  truth.line = table.line();
  truth.pose = table.text("pose");
  truth.x = table.text("x");
  truth.y = table.text("y");
  truth.heading = table.text("heading");
  truth.unit = unit_of(table, "unit", "m", {Quantity::length}).si;
  truth.heading_unit =
      unit_of(table, "heading_unit", "rad", {Quantity::angle}).si * table.sign("heading_sign");
  truth.clock = table.number("clock", 0.0);
  const bool columns = !truth.x.empty() && !truth.y.empty() && !truth.heading.empty();
  if (truth.pose.empty() != columns) {
    table.fail("needs either a pose, or x, y and heading, expected one of them");
  }
  table.finish();
  return truth;
}

std::vector<SurveyPoint> survey_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[survey]");
  std::vector<SurveyPoint> survey;
  const std::string name = table.text("file");
  if (!name.empty()) survey = read_survey(fs::path(file).parent_path() / name);
  if (const toml::node* landmarks = table.find("landmarks")) {
    if (!landmarks->is_table()) table.fail(*landmarks, "landmarks is no table");
    for (const auto& [key, value] : *landmarks->as_table()) {
      const toml::array* numbers = value.as_array();
      std::vector<double> found;
      for (std::size_t k = 0; numbers != nullptr && k < numbers->size(); ++k) {
        found.push_back((*numbers)[k].value<double>().value_or(kAbsent));
      }
      const bool whole = std::all_of(found.begin(), found.end(), [](double v) { return v == v; });
      if ((found.size() != 2 && found.size() != 3) || !whole) {
        table.fail(value,
                   std::string(key.str()) +
                       " is no list of numbers, expected [x, y] or [x, y, heading] (m, rad)");
      }
      survey.push_back({std::string(key.str()), found[0], found[1], kAbsent,
                        found.size() == 3 ? found[2] : kAbsent});
    }
  }
  table.finish();
  return survey;
}

const toml::table& table_at(const toml::node& node, const std::string& file,
                            const std::string& name) {
  if (node.is_table()) return *node.as_table();
  throw InputError(file, node.source().begin.line, name + " is no table, expected [" + name + "]");
}

void read_part(const std::string& key, const toml::node& node, const std::string& file,
               LogMap& map) {
  const auto table = [&]() -> const toml::table& { return table_at(node, file, key); };
  if (key == "time") {
    map.time = time_of(table(), file);
  } else if (key == "odometry") {
    TomlFields fields(table(), file, "[odometry]");
    map.odometry = {fields.text("twist"), fields.text("pose"), fields.number("clock", 0.0),
                    fields.line()};
    if (map.odometry.twist.empty() == map.odometry.pose.empty()) {
      fields.fail("needs either a twist or a pose, expected the path of one");
    }
    fields.finish();
  } else if (key == "wheels") {
    for (const auto& [name, wheel] : table()) {
      const std::string column(name.str());
      map.wheels.emplace_back(column,
                              wheel_of(table_at(wheel, file, "wheels." + column), file, column,
                                       is_steering_column(map.model.robot, column)));
    }
  } else if (key == "heading") {
    map.heading = heading_of(table(), file);
  } else if (key == "yaw_rate") {
    map.yaw_rate = yaw_rate_of(table(), file);
  } else if (key == "covariates") {
    for (const auto& [name, one] : table()) {
      map.covariates.emplace_back(name.str(), covariate_of(one, file, std::string(name.str())));
    }
  } else if (key == "sightings") {
    const toml::array* all = node.as_array();
    if (all == nullptr || !all->is_array_of_tables()) {
      throw InputError(file, node.source().begin.line,
                       "sightings is no list of tables, expected [[sightings]]");
    }
    for (const toml::node& one : *all) {
      map.sightings.push_back(sighting_of(*one.as_table(), file));
    }
  } else if (key == "fixes") {
    map.fixes = fixes_of(table(), file);
  } else if (key == "truth") {
    map.truth = truth_of(table(), file);
  } else if (key == "survey") {
    map.survey = survey_of(table(), file);
  } else if (key == "rows") {
    TomlFields fields(table(), file, "[rows]");
    map.period = fields.positive("period", 0.0);
    fields.finish();
  } else {
    throw InputError(file, node.source().begin.line,
                     "[" + key +
                         "] is unknown, expected time, robot, noise, odometry, wheels, "
                         "heading, yaw_rate, covariates, sightings, fixes, truth, survey or rows");
  }
}

LogMap map_of(toml::table root, const fs::path& path) {
  const std::string file = path.string();
  LogMap map;
  map.file = path;
  toml::table model;
  for (const char* key : {"robot", "noise"}) {
    if (toml::node* node = root.get(key)) {
      model.insert(key, std::move(*node));
      root.erase(key);
    }
  }
  map.model = model_of(model, file);
  for (const auto& [key, node] : root) read_part(std::string(key.str()), node, file, map);
  if (map.wheels.empty() == (map.odometry.line == 0)) {
    throw InputError(file, 0,
                     "needs either [odometry] or [wheels.left] and [wheels.right], "
                     "expected one of them");
  }
  return map;
}

}  // namespace

bool is_steering_column(const Robot& robot, const std::string& column) {
  return (robot.drive == DriveKind::tricycle || robot.drive == DriveKind::ackermann) &&
         robot.columns.size() == 2 && robot.columns[1] == column;
}

LogMap read_log_map(const fs::path& file) {
  const std::string text = read_file(file);
  try {
    return map_of(toml::parse(text), file);
  } catch (const toml::parse_error& error) {
    throw InputError(file.string(), error.source().begin.line,
                     "no TOML: " + std::string(error.description()));
  } catch (const TomlAssertion&) {
    throw InputError(file.string(), 0, "no TOML: keys or values are malformed");
  }
}

}  // namespace trussmap
