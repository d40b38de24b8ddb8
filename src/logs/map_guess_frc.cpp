// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// FRC robots (WPILib): the speed of the chassis, and of robots whose wheels all steer the states of
// their modules. The encoders of such wheels, two of them left and right, are no wheels of a robot
// that turns by their difference.
#include "logs/named_fields.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

constexpr const char* kChassis = "struct:ChassisSpeeds";
constexpr const char* kModules = "struct:SwerveModuleState[]";

/// What the robot was to do, or does as the field sees it.
const std::vector<std::string> kNotDriven{"setpoint", "desired", "target",    "goal",   "cmd",
                                          "command",  "request", "reference", "wanted", "field"};

double range_of(const NamedFacts* field) {
  return field == nullptr ? 0.0 : field->facts->largest - field->facts->least;
}

const NamedFacts* field_of(const FreeFields& fields, const std::string& topic,
                           const std::string& file, const std::string& name) {
  const std::string path = topic + "/" + name;
  for (const NamedFacts& one : fields.all()) {
    if (one.topic == topic && one.file == file && one.path == path) return &one;
  }
  return nullptr;
}

/// The first of the topics of a type that moves; one that is called measured before others.
const NamedFacts* driven(const FreeFields& fields, const std::string& type,
                         const std::string& ending) {
  const NamedFacts* found = nullptr;
  bool is_measured = false;
  for (const NamedFacts& one : fields.all()) {
    if (one.type != type || !one.path.ends_with(ending) || !(range_of(&one) > 0.0)) continue;
    if (has_word(one.topic, kNotDriven)) continue;
    const bool measured = has_word(one.topic, {"measured", "actual", "current", "real"});
    if (found != nullptr && (is_measured || !measured)) continue;
    found = &one;
    is_measured = measured;
  }
  return found;
}

void write_body(MapText& text) {
  text.blank();
  text.table("robot");
  text.text("drive", "wheels", "that goes sideways, too: what drives it are its body's motions");
  text.line("columns = [\"ahead\", \"left\", \"turn\"]", "m, m, rad");
  text.line("matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]");
}

int guess_chassis(const NamedFacts& omega, bool sideways, MapText& text) {
  if (sideways) {
    write_body(text);
  } else {
    text.blank();
    text.table("robot");
    text.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
  }
  text.blank();
  text.table("odometry", "the speed of the chassis, held since the message before");
  write_file_of(omega, text);
  text.text("twist", omega.topic);
  return sideways ? 0 : 1;
}

int guess_modules(const NamedFacts& speed, const FreeFields& fields, MapText& text) {
  write_body(text);
  text.blank();
  text.table("odometry", "of the states of its modules");
  write_file_of(speed, text);
  text.text("modules", speed.topic);
  std::size_t count = 0;
  while (field_of(fields, speed.topic, speed.file, "[" + std::to_string(count) + "].speed") !=
         nullptr) {
    ++count;
  }
  std::string places;
  constexpr double kSide = 0.3;  // m
  for (std::size_t k = 0; k < count; ++k) {
    places += fmt::format("{}[{}, {}]", k == 0 ? "" : ", ", k < (count + 1) / 2 ? kSide : -kSide,
                          k % 2 == 0 ? kSide : -kSide);
  }
  text.line("places = [" + places + "]",
            "m, of each module: ahead, to the left; STATE IT: front left, front right, ...?");
  return 1;
}

}  // namespace

void pass_over_body_speeds(FreeFields& fields) {
  for (const NamedFacts& one : fields.all()) {
    const bool made = one.type.starts_with(kChassis) || one.type.starts_with("struct:SwerveModule");
    if (made) fields.mark_taken(one);
  }
}

std::optional<int> guess_body_speeds(const FreeFields& fields, bool holonomic_alone,
                                     MapText& text) {
  constexpr double kFew = 0.05;  // of the range ahead
  const NamedFacts* omega = driven(fields, kChassis, "/omega");
  if (omega == nullptr) omega = driven(fields, kChassis, "/vx");
  const auto range = [&](const char* name) {
    return omega == nullptr ? 0.0 : range_of(field_of(fields, omega->topic, omega->file, name));
  };
  const bool sideways = range("vy") > kFew * range("vx");
  const bool modules = std::any_of(
      fields.all().begin(), fields.all().end(),
      [](const NamedFacts& one) { return one.type.starts_with("struct:SwerveModule"); });
  if (omega != nullptr && (sideways || modules || !holonomic_alone)) {
    return guess_chassis(*omega, sideways || modules, text);
  }
  if (const NamedFacts* speed = driven(fields, kModules, "].speed")) {
    return guess_modules(*speed, fields, text);
  }
  return std::nullopt;
}

}  // namespace trussmap::logs
