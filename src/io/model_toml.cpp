// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_physics.hpp"
#include "fit/noise_reml.hpp"
#include "io/csv.hpp"
#include "io/model_tables.hpp"
#include "io/toml_text.hpp"
#include "text/plain_text.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

struct NoiseKey {
  const char* name;
  double Noise::*value;
  const char* unit;
};

constexpr NoiseKey kNoise[] = {
    {"left", &Noise::left, "m^1/2: variance of a wheel's travel = left^2 * |travel|"},
    {"right", &Noise::right, "m^1/2"},
    {"compass", &Noise::compass, "rad per reading"},
    {"sighting", &Noise::sighting, "m: how exactly the robot stands on a landmark"},
    {"range", &Noise::range, "m, per range reading"},
    {"bearing", &Noise::bearing, "rad, per bearing reading"},
    {"survey", &Noise::survey, "m, where survey.csv has no sd"},
    {"truth", &Noise::truth, "m"},
    {"truth_heading", &Noise::truth_heading, "rad, per row of truth.csv"},
    {"range_relative", &Noise::range_relative, "fraction of the range"},
    {"heading_per_s", &Noise::heading_per_s, "rad/s^1/2"},
    {"heading_per_rad", &Noise::heading_per_rad, "rad/rad^1/2 turned"},
    {"travel_per_s", &Noise::travel_per_s, "m/s^1/2"},
    {"gyro", &Noise::gyro, "rad/s^1/2: angle random walk"},
    {"fix", &Noise::fix, "m, where fixes.csv has no sd"},
    {"loop", &Noise::loop, "m, where loops.csv has no sd"},
    {"loop_heading", &Noise::loop_heading, "rad, where loops.csv has no sd_heading"},
    {"steer", &Noise::steer, "rad m^1/2: of the mean steering angle over a metre"},
    {"yaw", &Noise::yaw, "rad, per yaw of a landmark"},
};

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
      {DriveKind::skid_steer, {{"wheelbase", "columns"}, {"wheelbase"}, 2, {"left", "right"}}},
      {DriveKind::tricycle, {{"length", "columns"}, {"length"}, 2, {"wheel", "steer"}}},
      {DriveKind::ackermann,
       {{"length", "wheel_left", "columns"}, {"length"}, 2, {"wheel", "steer"}}},
      {DriveKind::omni3, {{"radius", "columns"}, {"radius"}, 3, {"wheel1", "wheel2", "wheel3"}}},
      {DriveKind::mecanum,
       {{"wheelbase", "length", "columns"},
        {"wheelbase", "length"},
        4,
        {"front_left", "front_right", "rear_left", "rear_right"}}},
      {DriveKind::wheels, {{"columns", "matrix", "wheel"}, {}, 0, {}}}};
  return all.at(drive);
}

/// Reads from one file, with its name for the errors.
class ModelReader {
 public:
  explicit ModelReader(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] Model read(const toml::table& root) const {
    Model model;
    model.robot.wheelbase_stated = false;
    for (const auto& [key, node] : root) {
      if (key == "robot") {
        read_robot(table(node, "robot"), model.robot);
      } else if (key == "noise") {
        read_noise(table(node, "noise"), model.noise);
      } else if (key == "effect") {
        read_effects(node, model);
      } else {
        fail(key.source(),
             "key \"" + std::string(key.str()) + "\" is unknown, expected robot, noise or effect");
      }
    }
    for (const Effect& effect : model.effects) {
      if (is_of_drive(effect.channel, model.robot)) continue;
      throw InputError(
          file_, effect.line,
          fmt::format("effect \"{}\": channel \"{}\" is of another drive than {}", effect.name,
                      name_of(effect.channel), name_of(model.robot.drive)));
    }
    return model;
  }

 private:
  [[noreturn]] void fail(const toml::source_region& where, const std::string& what) const {
    throw InputError(file_, where.begin.line, what);
  }

  /// What `read` refuses is told with its place, and with the effect's name where one is given.
  template <typename Read>
  [[nodiscard]] auto told(const toml::node& node, const std::string& effect,
                          const Read& read) const {
    try {
      return read();
    } catch (const std::invalid_argument& error) {
      fail(node.source(), (effect.empty() ? "" : "effect \"" + effect + "\": ") + error.what());
    }
  }

  [[nodiscard]] const toml::table& table(const toml::node& node, const std::string& name) const {
    if (!node.is_table()) fail(node.source(), name + " is no table, expected [" + name + "]");
    return *node.as_table();
  }

  [[nodiscard]] double number(const toml::node& node, const std::string& name) const {
    const auto value = node.value<double>();
    if (!node.is_number() || !value) fail(node.source(), name + " is no number, expected one");
    if (!std::isfinite(*value)) fail(node.source(), name + " is not finite, expected a number");
    // Beyond all that robots have, in any unit: squares of larger ones overflow.
    constexpr double kLargest = 1e12;
    if (std::abs(*value) > kLargest) {
      fail(node.source(), name + " is " + csv_number(*value) + ", expected at most 1e12 in size");
    }
    return *value;
  }

  [[nodiscard]] std::string text(const toml::node& node, const std::string& name) const {
    if (!node.is_string()) fail(node.source(), name + " is no text, expected \"...\"");
    return *node.value<std::string>();
  }

  [[nodiscard]] double positive(const toml::node& node, const char* name) const {
    const double value = number(node, name);
    if (value > 0.0) return value;
    fail(node.source(),
         std::string(name) + " is " + csv_number(value) + ", expected more than 0 (m)");
  }

  void read_robot(const toml::table& robot, Robot& result) const {
    if (const toml::node* drive = robot.get("drive")) {
      result.drive = told(*drive, "", [&] { return drive_named(text(*drive, "drive")); });
    }
    const DriveKeys& keys = keys_of(result.drive);
    for (const auto& [key, node] : robot) {
      const std::string_view name = key.str();
      if (name != "drive" && keys.names.find(name) == keys.names.end()) {
        std::string expected;
        for (const std::string_view one : keys.names) expected += ", " + std::string(one);
        fail(key.source(), fmt::format("key \"{}\" in [robot] is unknown for drive {}, expected "
                                       "drive{}",
                                       name, name_of(result.drive), expected));
      }
      if (name == "wheelbase") {
        result.wheelbase = positive(node, "wheelbase");
        result.wheelbase_stated = true;
      } else if (name == "length" || name == "radius") {
        result.length = positive(node, std::string(name).c_str());
      } else if (name == "wheel_left") {
        result.wheel_left = number(node, "wheel_left");
      } else if (name == "columns") {
        read_columns(node, result);
      } else if (name == "wheel") {
        read_places(node, result);
      }
    }
    for (const std::string_view needed : keys.needed) {
      if (!robot.contains(needed)) {
        fail(robot.source(), fmt::format("[robot] has no {}, expected one of drive {}", needed,
                                         name_of(result.drive)));
      }
    }
    finish_robot(robot, keys, result);
  }

  void read_columns(const toml::node& node, Robot& result) const {
    const toml::array* columns = node.as_array();
    if (columns == nullptr) fail(node.source(), "columns is no list, expected [\"...\", ...]");
    for (const toml::node& one : *columns) {
      result.columns.push_back(text(one, "a column"));
      const auto twin =
          std::find(result.columns.begin(), result.columns.end() - 1, result.columns.back());
      if (twin != result.columns.end() - 1) {
        fail(one.source(), "column \"" + *twin + "\" is named twice, expected each wheel once");
      }
    }
  }

  void read_places(const toml::node& node, Robot& result) const {
    const toml::array* wheels = node.as_array();
    if (wheels == nullptr || !wheels->is_array_of_tables()) {
      fail(node.source(), "wheel is no list of tables, expected [[robot.wheel]]");
    }
    for (const toml::node& one : *wheels) {
      WheelPlace place;
      for (const auto& [key, value] : *one.as_table()) {
        if (key == "column") {
          result.columns.push_back(text(value, "column"));
        } else if (key == "x") {
          place.x = number(value, "x");
        } else if (key == "y") {
          place.y = number(value, "y");
        } else if (key == "direction") {
          place.direction = number(value, "direction");
        } else if (key == "roller") {
          place.roller = number(value, "roller");
          if (!(std::abs(std::cos(place.roller)) > 1e-3)) {
            fail(value.source(), "roller is " + csv_number(place.roller) +
                                     ", expected the angle from the wheel's direction to its "
                                     "rollers' axes, less than a quarter turn (rad)");
          }
        } else {
          fail(key.source(), "key \"" + std::string(key.str()) +
                                 "\" in [[robot.wheel]] is unknown, expected column, x, y, "
                                 "direction, roller");
        }
      }
      result.places.push_back(place);
      if (result.columns.size() != result.places.size()) {
        fail(one.source(), "a wheel has no column, expected the name of its column of drive.csv");
      }
    }
  }

  void read_matrix(const toml::node& node, Robot& result) const {
    const toml::array* rows = node.as_array();
    const auto count = result.columns.size();
    if (rows == nullptr || rows->size() != 3) {
      fail(node.source(), "matrix is no list of three rows, expected forward, sideways and turn");
    }
    result.matrix.resize(3, static_cast<Eigen::Index>(count));
    for (std::size_t row = 0; row < 3; ++row) {
      const toml::array* numbers = (*rows)[row].as_array();
      if (numbers == nullptr || numbers->size() != count) {
        fail((*rows)[row].source(),
             fmt::format("a row of matrix is no list of {} numbers, expected one per column",
                         count));
      }
      for (std::size_t k = 0; k < count; ++k) {
        result.matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k)) =
            number((*numbers)[k], "an entry of matrix");
      }
    }
  }

  /// How many columns, what they are called if nothing is said, and what else is asked.
  void finish_robot(const toml::table& robot, const DriveKeys& keys, Robot& result) const {
    constexpr std::size_t kMostWheels = 6;  // wheel1 ... wheel6
    if (result.columns.empty()) result.columns = keys.columns;
    const std::size_t count = result.columns.size();
    if (result.drive == DriveKind::wheels) {
      const toml::node* matrix = robot.get("matrix");
      if ((matrix == nullptr) == result.places.empty()) {
        fail(robot.source(),
             "drive wheels needs either [[robot.wheel]] or columns and a matrix, expected one");
      }
      if (count < 2 || count > kMostWheels) {
        fail(robot.source(),
             fmt::format("drive wheels has {} columns, expected 2 to {}", count, kMostWheels));
      }
      if (matrix != nullptr) {
        read_matrix(*matrix, result);
      } else {
        result.matrix = told(robot, "", [&] { return wheel_matrix(result.places); });
      }
    } else if (result.drive == DriveKind::skid_steer
                   ? count != 2 && count != 4 && count != 6
                   : !result.columns.empty() && count != keys.columns_wanted) {
      fail(robot.source(),
           fmt::format("drive {} has {} columns, expected {}", name_of(result.drive), count,
                       result.drive == DriveKind::skid_steer
                           ? "2, 4 or 6, those of the left side first"
                           : std::to_string(keys.columns_wanted)));
    }
    if (keys.names.find("wheelbase") != keys.names.end()) return;
    // Of no meaning then but for how turns are written as travels of two wheels.
    if (result.length > 0.0) result.wheelbase = result.length;
    result.wheelbase_stated = true;
  }

  void read_noise(const toml::table& noise, Noise& result) const {
    for (const auto& [key, node] : noise) {
      if (key == "process") {
        read_processes(node, result);
        continue;
      }
      if (key == "wheel") {
        const double value = number(node, "wheel");
        if (value < 0.0) fail(node.source(), "wheel is negative, expected 0 or more");
        result.left = result.right = value;
        continue;
      }
      const NoiseKey* known = nullptr;
      std::string names;
      for (const NoiseKey& one : kNoise) {
        if (key.str() == one.name) known = &one;
        names += std::string(names.empty() ? "" : ", ") + one.name;
      }
      const std::string name(key.str());
      if (known == nullptr) {
        fail(key.source(),
             fmt::format("key \"{}\" in [noise] is unknown, expected one of {}, process", name,
                         names));
      }
      const double value = number(node, name);
      if (value < 0.0) fail(node.source(), name + " is negative, expected 0 or more");
      result.*(known->value) = value;
    }
  }

  void read_processes(const toml::node& node, Noise& noise) const {
    const toml::array* processes = node.as_array();
    if (processes == nullptr || !processes->is_array_of_tables()) {
      fail(node.source(), "process is no list of tables, expected [[noise.process]]");
    }
    for (const toml::node& one : *processes) {
      const NoiseProcess process = read_process(*one.as_table());
      const auto twin = std::find_if(
          noise.processes.begin(), noise.processes.end(), [&process](const NoiseProcess& other) {
            return other.channel == process.channel && other.process == process.process;
          });
      if (twin != noise.processes.end()) {
        fail(one.source(),
             fmt::format("a noise process {} {} is there already, in line {}, expected "
                         "one of each",
                         name_of(process.channel), name_of(process.process), twin->line));
      }
      noise.processes.push_back(process);
    }
  }

  [[nodiscard]] NoiseProcess read_process(const toml::table& table) const {
    NoiseProcess result;
    result.line = static_cast<int>(table.source().begin.line);
    for (const auto& [key, node] : table) {
      const toml::node& value = node;
      if (key == "channel") {
        result.channel = told(value, "", [&] { return channel_named(text(value, "channel")); });
      } else if (key == "process") {
        result.process = told(value, "", [&] { return process_named(text(value, "process")); });
      } else if (key == "sd" || key == "length" || key == "tails") {
        const std::string name(key.str());
        const double size = number(value, name);
        const double least = key == "tails" ? 2.0 : 0.0;
        if (size <= least) {
          fail(value.source(),
               name + " is " + csv_number(size) + ", expected more than " + csv_number(least));
        }
        (key == "sd" ? result.sd : key == "length" ? result.length : result.tails) = size;
      } else {
        fail(key.source(), "key \"" + std::string(key.str()) +
                               "\" in [[noise.process]] is unknown, expected channel, process, "
                               "sd, length or tails");
      }
    }
    check_process(table, result);
    return result;
  }

  void check_process(const toml::table& table, const NoiseProcess& process) const {
    for (const char* needed : {"channel", "process", "sd"}) {
      if (!table.contains(needed)) {
        fail(table.source(), std::string("a noise process has no ") + needed +
                                 ", expected channel, process and sd");
      }
    }
    const std::string name(name_of(process.process));
    const char* unit = process.process == ProcessKind::correlated_in_t ? "s" : "m";
    if (is_correlated(process.process) && process.length == 0.0) {
      fail(table.source(), "a process " + name + " has no length, expected one (" + unit + ")");
    }
    if (!is_correlated(process.process) && process.length != 0.0) {
      fail(table.get("length")->source(), "a process " + name + " has a length, expected none");
    }
    const bool passes =
        acts_on(process.channel) == ActsOn::views && !acts_on_fixes(process.channel);
    if (process.process == ProcessKind::per_pass && !passes) {
      fail(table.source(), "channel " + std::string(name_of(process.channel)) +
                               " has no passes, expected lever, lever_left, range, range_scale, "
                               "bearing or delay");
    }
  }

  void read_effects(const toml::node& node, Model& model) const {
    const toml::array* effects = node.as_array();
    if (effects == nullptr || !effects->is_array_of_tables()) {
      fail(node.source(), "effect is no list of tables, expected [[effect]]");
    }
    for (const toml::node& one : *effects) model.effects.push_back(read_effect(*one.as_table()));
  }

  [[nodiscard]] Effect read_effect(const toml::table& table) const {
    Effect effect = spelt_out(table);
    const std::size_t shapes = effect.shape.size();
    const std::size_t coefficients = effect.coefficients.size();
    const bool fits = effect.per_session ? coefficients % shapes == 0
                                         : coefficients == 0 || coefficients == shapes;
    if (!fits) {
      fail(table.get("coefficients")->source(),
           "effect \"" + effect.name + "\" has " + std::to_string(coefficients) +
               " coefficients, expected " + std::to_string(shapes) + ", one per shape" +
               (effect.per_session ? ", per session" : ""));
    }
    return effect;
  }

  /// The effect with the catalogue's channel and shapes where the file has none.
  [[nodiscard]] Effect spelt_out(const toml::table& table) const {
    const toml::node* named = table.get("name");
    const std::string name = named == nullptr ? "" : text(*named, "name");
    if (!is_plain_text(name)) {
      fail(named->source(), "name holds a control character, expected printable text");
    }
    if (name.empty()) fail(table.source(), "an effect has no name, expected name = \"...\"");
    const toml::node* channel = table.get("channel");
    const toml::node* shape = table.get("shape");
    Effect effect;
    std::vector<double> coefficients;
    for (const auto& entry : table) {
      const toml::key& key = entry.first;
      const toml::node& node = entry.second;
      if (key == "channel") {
        effect.channel = told(node, name, [&] { return channel_named(text(node, "channel")); });
      } else if (key == "shape") {
        for (const toml::node& one : list(node, "shape")) {
          effect.shape.push_back(read_shape(one, name));
        }
      } else if (key == "coefficients") {
        for (const toml::node& value : list(node, "coefficients")) {
          coefficients.push_back(number(value, "a coefficient"));
        }
      } else if (key == "per") {
        if (text(node, "per") != "session") {
          fail(node.source(), "per is \"" + text(node, "per") + "\", expected \"session\"");
        }
        effect.per_session = true;
      } else if (key != "name") {
        fail(key.source(), "key \"" + std::string(key.str()) +
                               "\" in [[effect]] is unknown, expected name, channel, shape, "
                               "coefficients or per");
      }
    }
    if ((channel == nullptr) != (shape == nullptr)) {
      fail(table.source(),
           "effect \"" + name + "\" has a " +
               (shape == nullptr ? "channel but no shape" : "shape but no channel") +
               ", expected both or neither");
    }
    if (shape == nullptr) {
      const Effect known = told(table, "", [&] { return catalogue_effect(name); });
      effect.channel = known.channel;
      effect.shape = known.shape;
    } else if (effect.shape.empty()) {
      fail(shape->source(), "effect \"" + name + "\" has no shape, expected one or more");
    }
    effect.name = name;
    effect.coefficients = std::move(coefficients);
    // What can still be wrong with it is most likely its formula.
    effect.line = static_cast<int>((shape != nullptr ? *shape : table).source().begin.line);
    return effect;
  }

  [[nodiscard]] Shape read_shape(const toml::node& node, const std::string& effect) const {
    const std::string expression = text(node, "a shape");
    if (expression.find_first_not_of(" \t") == std::string::npos) {
      fail(node.source(), "effect \"" + effect + "\" has an empty shape, expected an expression");
    }
    return told(node, effect, [&] { return Shape(expression); });
  }

  [[nodiscard]] const toml::array& list(const toml::node& node, const std::string& name) const {
    if (!node.is_array()) fail(node.source(), name + " is no list, expected [ ... ]");
    return *node.as_array();
  }

  std::string file_;
};

/// -0 would be read as a whole number, without its sign.
std::string toml_number(double value) {
  return csv_number(value == 0.0 ? 0.0 : value);
}

std::string list_text(const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& one : values) text += (text.empty() ? "" : ", ") + one;
  return "[" + text + "]";
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
  return text;
}

std::string process_text(const NoiseProcess& process) {
  std::string text =
      "\n[[noise.process]]\nchannel = " + toml_string(std::string(name_of(process.channel))) +
      "\nprocess = " + toml_string(std::string(name_of(process.process))) +
      "\nsd = " + toml_number(process.sd) + "\n";
  if (process.length > 0.0) {
    text += "length = " + toml_number(process.length) +
            (process.process == ProcessKind::correlated_in_t ? "  # s\n" : "  # m\n");
  }
  if (process.tails > 0.0) text += "tails = " + toml_number(process.tails) + "\n";
  return text;
}

}  // namespace

Model model_of(const toml::table& root, const std::string& file) {
  return ModelReader(file).read(root);
}

Model model_from_text(const std::string& text, const std::string& file) {
  try {
    return model_of(toml::parse(text), file);
  } catch (const toml::parse_error& error) {
    throw InputError(file, error.source().begin.line,
                     "no TOML: " + std::string(error.description()));
  } catch (const TomlAssertion&) {
    throw InputError(file, 0, "no TOML: keys or values are malformed");
  }
}

Model read_model(const std::filesystem::path& file) {
  return model_from_text(read_file(file), file.string());
}

std::string format_model(const Model& model) {
  std::string text = robot_text(model.robot) + "\n[noise]\n";
  const Noise defaults;
  const bool two = model.robot.drive == DriveKind::differential;
  const bool steers = is_of_drive(Channel::steer, model.robot);
  if (!two) {
    text += "wheel = " + toml_number(mean_wheel_noise(model.noise)) +
            "  # m^1/2: variance of each wheel's travel = wheel^2 * |travel|\n";
  }
  for (const NoiseKey& key : kNoise) {
    const double value = model.noise.*(key.value);
    // An optional law that is off, or of a stream that few recordings have.
    const bool rare = key.value == &Noise::gyro || key.value == &Noise::fix ||
                      key.value == &Noise::loop || key.value == &Noise::loop_heading ||
                      (key.value == &Noise::steer && !steers);
    if (!two && (key.value == &Noise::left || key.value == &Noise::right)) continue;
    if (value == defaults.*(key.value) && (value == 0.0 || rare)) continue;
    text += std::string(key.name) + " = " + toml_number(value) + "  # " + key.unit + "\n";
  }
  for (const NoiseProcess& process : model.noise.processes) text += process_text(process);
  for (const Effect& effect : model.effects) {
    text += "\n[[effect]]\nname = " + toml_string(effect.name) + "\n";
    text += "channel = " + toml_string(std::string(name_of(effect.channel))) + "\nshape = [";
    for (std::size_t k = 0; k < effect.shape.size(); ++k) {
      text += (k == 0 ? "" : ", ") + toml_string(effect.shape[k].text());
    }
    text += "]\n";
    if (!effect.coefficients.empty()) {
      text += "coefficients = [";
      for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
        text += (k == 0 ? "" : ", ") + toml_number(effect.coefficients[k]);
      }
      text += "]\n";
    }
    if (effect.per_session) text += "per = \"session\"\n";
  }
  return text;
}

void write_model(const std::filesystem::path& file, const Model& model) {
  write_file(file, format_model(model));
}

}  // namespace trussmap
