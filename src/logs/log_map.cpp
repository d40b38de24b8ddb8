// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/log_map.hpp"

#include "io/model_toml.hpp"
#include "io/recording_streams.hpp"
#include "io/toml_values.hpp"
#include "logs/motion_map.hpp"
#include "logs/signal_map.hpp"
#include "logs/toml_fields.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

SightingMap sighting_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[[sightings]]");
  SightingMap one;
  one.line = table.line();
  one.file = table.text("file");
  one.frames = table.text("frames");
  one.base = table.text("base", "base_link");
  one.tf = table.text("tf", "/tf");
  one.prefix = table.text("prefix");
  one.none = table.texts("none");
  one.clock = table.clock();
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
  fixes.file = table.text("file");
  fixes.topic = table.text("topic");
  fixes.x = table.text("x");
  fixes.y = table.text("y");
  fixes.latitude = table.text("latitude");
  fixes.longitude = table.text("longitude");
  fixes.sd = table.text("sd");
  fixes.quality = table.text("quality");
  fixes.unit = unit_of(table, "unit", "m", {Quantity::length}).si;
  fixes.sd_unit = unit_of(table, "sd_unit", "m", {Quantity::length}).si;
  fixes.clock = table.clock();
  if (fixes.x.empty() != fixes.y.empty() || fixes.latitude.empty() != fixes.longitude.empty()) {
    table.fail("has one of two coordinates, expected x and y, or latitude and longitude");
  }
  table.finish();
  return fixes;
}

std::vector<SurveyPoint> survey_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[survey]");
  std::vector<SurveyPoint> survey;
  const std::string name = table.text("file");
  if (!name.empty()) {
    try {
      survey = io::read_survey(fs::path(file).parent_path() / name);
    } catch (const InputError& error) {
      table.fail(*table.find("file"), error.what());
    }
  }
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
  std::set<std::string> names;
  for (const SurveyPoint& one : survey) {
    if (!names.insert(one.landmark).second) {
      table.fail("has landmark " + one.landmark + " twice, expected each once");
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
    map.times = times_of(node, file);
  } else if (key == "odometry") {
    map.odometry = odometry_of(table(), file);
  } else if (key == "wheels") {
    for (const auto& [name, wheel] : table()) {
      if (!wheel.is_table()) continue;  // of all wheels: each has it
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
    const std::string log = TomlFields(table(), file, "[covariates]").text("file");
    for (const auto& [name, one] : table()) {
      if (name.str() == "file") continue;  // of all that state none
      if (!is_covariate_name(name.str())) {
        throw InputError(file, name.source().begin.line,
                         "\"" + std::string(name.str()) +
                             "\" cannot be a covariate's name, expected a letter, then letters, "
                             "digits or _, and no variable's name");
      }
      map.covariates.emplace_back(name.str(), covariate_of(one, file, std::string(name.str())));
      std::string& own = map.covariates.back().second.file;
      if (own.empty()) own = log;
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

/// What [wheels] states for all, each wheel gets that does not state it itself.
void share_constants(toml::table& wheels, const Robot& robot) {
  for (auto&& [key, value] : wheels) {
    if (value.is_table()) continue;
    for (auto&& [name, wheel] : wheels) {
      const bool steers = is_steering_column(robot, std::string(name.str()));
      if (!wheel.is_table() || (steers && key.str() != "file")) continue;
      wheel.as_table()->insert(key, value);
    }
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
  map.model = io::model_of(model, file);
  if (toml::table* wheels = root["wheels"].as_table()) share_constants(*wheels, map.model.robot);
  for (const auto& [key, node] : root) read_part(std::string(key.str()), node, file, map);
  for (const auto& [name, signal] : map.covariates) {
    for (const std::string& column : map.model.robot.columns) {
      if (column != name) continue;
      throw InputError(file, signal.line,
                       "covariate " + name + " is called like a wheel, expected another name");
    }
  }
  return map;
}

/// Lines with a value whose comment still asks for it.
std::vector<std::size_t> lines_to_state(const std::string& text) {
  std::vector<std::size_t> found;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    const std::size_t comment = line.find('#');
    const std::size_t mark = line.find("STATE IT");
    if (mark != std::string::npos && comment < mark && line.find('=') < comment) {
      found.push_back(number);
    }
  }
  return found;
}

}  // namespace

bool is_steering_column(const Robot& robot, const std::string& column) {
  return (robot.drive == DriveKind::tricycle || robot.drive == DriveKind::ackermann) &&
         robot.columns.size() == 2 && robot.columns[1] == column;
}

LogMap read_log_map(const fs::path& file) {
  LogMap map = parse_log_map(read_file(file), file);
  const bool drives = map.odometry.line != 0 && !map.odometry.compare;
  if (map.wheels.empty() != drives) {
    throw InputError(file.string(), map.odometry.line,
                     "needs either [odometry] or [wheels.left] and [wheels.right], "
                     "expected one of them (or both, the first with compare = true)");
  }
  return map;
}

LogMap parse_log_map(const std::string& text, const fs::path& file) {
  try {
    LogMap map = map_of(toml::parse(text), file);
    map.to_state = lines_to_state(text);
    return map;
  } catch (const toml::parse_error& error) {
    throw InputError(file.string(), error.source().begin.line, io::toml_fault(error));
  } catch (const io::TomlAssertion&) {
    throw InputError(file.string(), 0, "no TOML: keys or values are malformed");
  }
}

}  // namespace trussmap::logs
