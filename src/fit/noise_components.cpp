// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_components.hpp"

#include "effects/channel_physics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap::fitting {
namespace {

NoiseComponent white(const char* name, const char* unit, std::vector<double Noise::*> members,
                     double stated) {
  NoiseComponent one;
  one.name = name;
  one.unit = unit;
  one.white = std::move(members);
  one.stated = stated;
  return one;
}

NoiseComponent lasting(const NoiseProcess& process) {
  NoiseComponent one;
  one.name = name_of_source(process);
  one.unit = std::string(facts_of(process.channel).unit);
  if (process.process == ProcessKind::walk_in_t) one.unit += "/sqrt(s)";
  if (process.process == ProcessKind::walk_in_distance) one.unit += "/sqrt(m)";
  one.process = process;
  one.stated = process.sd;
  return one;
}

}  // namespace

const std::vector<ReadingKey>& reading_keys() {
  static const std::vector<ReadingKey> all{
      {"compass", "rad", &Noise::compass}, {"sighting", "m", &Noise::sighting},
      {"range", "m", &Noise::range},       {"fix", "m", &Noise::fix},
      {"bearing", "rad", &Noise::bearing}, {"yaw", "rad", &Noise::yaw},
      {"truth", "m", &Noise::truth},       {"truth_heading", "rad", &Noise::truth_heading}};
  return all;
}

double reading_sd(const Noise& noise, std::string_view key) {
  for (const ReadingKey& one : reading_keys()) {
    if (one.name == key) return noise.*one.member;
  }
  return 0.0;
}

std::set<std::string_view> noises_in(const estimation::RecordingProblem& problem) {
  std::set<std::string_view> found;
  for (const estimation::Measurement& one : problem.measurements) {
    for (Eigen::Index row = 0; row < one.rows && !one.own_sd; ++row) {
      found.insert(one.kind->noise(row));
    }
  }
  return found;
}

double mean_wheel_noise(const Noise& noise) {
  return std::sqrt(0.5 * (noise.left * noise.left + noise.right * noise.right));
}

Noise silent_noise() {
  Noise none;
  none.left = none.right = none.compass = none.sighting = none.range = none.bearing = 0.0;
  none.gyro = none.survey = none.truth = none.truth_heading = 0.0;
  none.fix = none.loop = none.loop_heading = none.steer = none.yaw = 0.0;
  return none;
}

std::string name_of_source(const NoiseProcess& process) {
  return std::string(name_of(process.channel)) + ", " + std::string(name_of(process.process));
}

std::vector<NoiseComponent> white_components(const FitState& fit, const Noise& noise) {
  std::vector<NoiseComponent> result;
  const double wheels = mean_wheel_noise(noise);
  if (wheels > 0.0) {
    result.push_back(white("wheels", "m^1/2", {&Noise::left, &Noise::right}, wheels));
  }
  const std::set<std::string_view> measured = noises_in(fit.problem);
  const auto add = [&](const char* name, const char* unit, double Noise::*member, bool there) {
    if (there && noise.*member > 0.0) result.push_back(white(name, unit, {member}, noise.*member));
  };
  for (const auto& [name, unit, member] : reading_keys()) {
    add(name, unit, member, measured.contains(name));
  }
  add("heading_per_s", "rad/s^1/2", &Noise::heading_per_s, true);
  add("heading_per_rad", "rad/rad^1/2", &Noise::heading_per_rad, true);
  add("travel_per_s", "m/s^1/2", &Noise::travel_per_s, true);
  add("gyro", "rad/s^1/2", &Noise::gyro, measured.contains("gyro"));
  return result;
}

std::vector<NoiseComponent> processes_of(const Noise& noise) {
  std::vector<NoiseComponent> result;
  for (const NoiseProcess& one : noise.processes) result.push_back(lasting(one));
  return result;
}

bool is_same_source(const NoiseProcess& a, const NoiseProcess& b) {
  return a.channel == b.channel && a.process == b.process;
}

double size_in(const Noise& noise, const NoiseComponent& component) {
  if (component.lasts()) {
    for (const NoiseProcess& one : noise.processes) {
      if (is_same_source(one, component.process)) return one.sd;
    }
    return 0.0;
  }
  double squares = 0.0;
  for (double Noise::*member : component.white) squares += std::pow(noise.*member, 2);
  return std::sqrt(squares / static_cast<double>(component.white.size()));
}

std::vector<NoiseComponent> candidate_components(const FitState& fit, const Noise& noise) {
  std::vector<NoiseComponent> result;
  const auto add = [&](Channel channel, ProcessKind process,
                       const std::vector<double>& lengths = {0.0}) {
    for (const double length : lengths) {
      NoiseProcess one;
      one.channel = channel;
      one.process = process;
      one.length = length;
      result.push_back(lasting(one));
    }
  };
  const auto add_white = [&](const char* name, const char* unit, double Noise::*member) {
    if (noise.*member == 0.0) result.push_back(white(name, unit, {member}, 0.0));
  };
  const std::set<std::string_view> measured = noises_in(fit.problem);
  const std::vector<double> times{0.5, 2.0, 10.0};
  const std::vector<double> ways{0.5, 3.0};
  add(Channel::travel, ProcessKind::per_leg);
  add(Channel::turn, ProcessKind::per_leg);
  add(Channel::difference, ProcessKind::per_leg);
  add(Channel::drift, ProcessKind::correlated_in_t, {2.0, 10.0});
  add(Channel::difference, ProcessKind::correlated_in_distance, ways);
  add(Channel::travel, ProcessKind::correlated_in_distance, ways);
  add_white("heading_per_s", "rad/s^1/2", &Noise::heading_per_s);
  add_white("heading_per_rad", "rad/rad^1/2", &Noise::heading_per_rad);
  add_white("travel_per_s", "m/s^1/2", &Noise::travel_per_s);
  if (measured.contains("compass")) {
    add(Channel::compass, ProcessKind::correlated_in_t, times);
    add(Channel::compass, ProcessKind::correlated_in_distance, ways);
    add(Channel::compass, ProcessKind::walk_in_t);
  }
  if (measured.contains("gyro")) {
    add(Channel::gyro, ProcessKind::walk_in_t);
    add(Channel::gyro, ProcessKind::per_session);
    add(Channel::gyro, ProcessKind::correlated_in_t, {10.0});
  }
  if (measured.contains("range")) {
    add(Channel::range, ProcessKind::correlated_in_t, times);
    add(Channel::bearing, ProcessKind::correlated_in_t, times);
    add(Channel::range, ProcessKind::per_pass);
    add(Channel::bearing, ProcessKind::per_pass);
  }
  return result;
}

void take_into(Noise& noise, const NoiseComponent& component, double sd, double length) {
  if (!component.lasts()) {
    const double factor = component.stated > 0.0 ? sd / component.stated : 0.0;
    for (double Noise::*member : component.white) {
      noise.*member = factor > 0.0 ? factor * noise.*member : sd;
    }
    return;
  }
  NoiseProcess process = component.process;
  process.sd = sd;
  process.length = length;
  for (NoiseProcess& one : noise.processes) {
    if (!is_same_source(one, process)) continue;
    one.sd = sd;
    one.length = length;
    return;
  }
  noise.processes.push_back(process);
}

}  // namespace trussmap::fitting
