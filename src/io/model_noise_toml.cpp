// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_physics.hpp"
#include "fit/noise_reml.hpp"
#include "io/csv.hpp"
#include "io/model_sections.hpp"
#include "io/toml_text.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace trussmap::io {
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

/// nullptr where there is none.
const NoiseKey* noise_key_named(std::string_view name) {
  const auto* found = std::find_if(std::begin(kNoise), std::end(kNoise),
                                   [name](const NoiseKey& one) { return name == one.name; });
  return found == std::end(kNoise) ? nullptr : found;
}

std::string noise_key_names() {
  std::string names;
  for (const NoiseKey& one : kNoise) names += std::string(names.empty() ? "" : ", ") + one.name;
  return names;
}

void check_process(const toml::table& table, const NoiseProcess& process) {
  for (const char* needed : {"channel", "process", "sd"}) {
    if (!table.contains(needed)) {
      refuse(table.source(), std::string("a noise process has no ") + needed +
                                 ", expected channel, process and sd");
    }
  }
  const std::string name(name_of(process.process));
  const char* unit = process.process == ProcessKind::correlated_in_t ? "s" : "m";
  if (is_correlated(process.process) && process.length == 0.0) {
    refuse(table.source(), "a process " + name + " has no length, expected one (" + unit + ")");
  }
  if (!is_correlated(process.process) && process.length != 0.0) {
    refuse(table.get("length")->source(), "a process " + name + " has a length, expected none");
  }
  const bool passes = effects::acts_on(process.channel) == effects::ActsOn::views &&
                      !effects::acts_on_fixes(process.channel);
  if (process.process == ProcessKind::per_pass && !passes) {
    refuse(table.source(), "channel " + std::string(name_of(process.channel)) +
                               " has no passes, expected lever, lever_left, range, range_scale, "
                               "bearing or delay");
  }
}

NoiseProcess read_process(const toml::table& table) {
  NoiseProcess result;
  result.line = static_cast<int>(table.source().begin.line);
  for (const auto& [key, node] : table) {
    const toml::node& value = node;
    if (key == "channel") {
      result.channel = told(value, "", [&] { return channel_named(toml_words(value, "channel")); });
    } else if (key == "process") {
      result.process = told(value, "", [&] { return process_named(toml_words(value, "process")); });
    } else if (key == "sd" || key == "length" || key == "tails") {
      const std::string name(key.str());
      const double size = toml_figure(value, name);
      const double least = key == "tails" ? 2.0 : 0.0;
      if (size <= least) {
        refuse(value.source(),
               name + " is " + csv_number(size) + ", expected more than " + csv_number(least));
      }
      (key == "sd" ? result.sd : key == "length" ? result.length : result.tails) = size;
    } else {
      refuse(key.source(), "key \"" + std::string(key.str()) +
                               "\" in [[noise.process]] is unknown, expected channel, process, "
                               "sd, length or tails");
    }
  }
  check_process(table, result);
  return result;
}

std::vector<NoiseProcess> read_processes(const toml::node& node) {
  std::vector<NoiseProcess> processes;
  for (const toml::node& one : toml_tables(node, "process", "[[noise.process]]")) {
    const NoiseProcess process = read_process(*one.as_table());
    const auto twin =
        std::find_if(processes.begin(), processes.end(), [&process](const NoiseProcess& other) {
          return other.channel == process.channel && other.process == process.process;
        });
    if (twin != processes.end()) {
      refuse(one.source(),
             fmt::format("a noise process {} {} is there already, in line {}, expected "
                         "one of each",
                         name_of(process.channel), name_of(process.process), twin->line));
    }
    processes.push_back(process);
  }
  return processes;
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

Noise read_noise(const toml::table& noise) {
  Noise result;
  for (const auto& [key, node] : noise) {
    const std::string name(key.str());
    if (name == "process") {
      result.processes = read_processes(node);
    } else if (name == "wheel") {
      result.left = result.right = toml_spread(node, name);
    } else if (const NoiseKey* known = noise_key_named(name)) {
      result.*(known->value) = toml_spread(node, name);
    } else {
      refuse(key.source(),
             fmt::format("key \"{}\" in [noise] is unknown, expected one of {}, process", name,
                         noise_key_names()));
    }
  }
  return result;
}

std::string noise_text(const Model& model) {
  std::string text = "[noise]\n";
  const Noise defaults;
  const bool two =
      model.robot.drive == DriveKind::differential || model.robot.drive == DriveKind::unicycle;
  const bool steers = effects::is_of_drive(Channel::steer, model.robot);
  if (!two) {
    text += "wheel = " + toml_number(fitting::mean_wheel_noise(model.noise)) +
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
  return text;
}

}  // namespace trussmap::io
