// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Odometries and truths in columns: x, y and a heading or a quaternion; or speeds.
#include "logs/named_fields.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

const std::vector<std::string> kAngleWords{"yaw", "theta", "heading", "angle",
                                           "=th", "=phi",  "=psi",    "=rz"};
const std::vector<std::string> kRateWords{"rate",  "vel",    "velocity", "speed", "dot",
                                          "twist", "linear", "angular",  "acc",   "accel"};
const std::vector<std::string> kRotationWords{"orientation", "quaternion", "quat", "rotation",
                                              "rot"};

bool is_rotation_part(const std::string& path) {
  if (has_word(path, kRotationWords)) return true;
  return has_word(path, {"=qx", "=qy", "=qz", "=qw"});
}

/// x or y of a position.
bool is_position(const NamedFacts& field, char axis) {
  static const std::vector<std::string> kNot{
      "cov",   "gyro",     "mag", "imu", "tag",    "marker", "goal",   "target", "cmd",
      "gps",   "gnss",     "uwb", "fix", "utm",    "pixel",  "camera", "laser",  "scan",
      "error", "landmark", "sd",  "std", "origin", "dock",   "beacon", "robot2"};
  return !field.facts->is_text && axis_of(field.path) == axis && !is_rotation_part(field.path) &&
         !has_word(field.path, kRateWords) && !has_word(field.path, kNot) &&
         !has_word(field.path,
                   {"=ax", "=ay", "=gx", "=gy", "=vx", "=vy", "=wx", "=wy", "=mx", "=my"});
}

struct PoseColumns {
  const NamedFacts* x = nullptr;
  const NamedFacts* y = nullptr;
  const NamedFacts* heading = nullptr;
  std::vector<const NamedFacts*> quaternion;  // x, y, z, w or z, w

  [[nodiscard]] bool moves() const { return x->facts->different > 0 || y->facts->different > 0; }
  [[nodiscard]] bool turns() const {
    if (heading != nullptr) return heading->facts->different > 0;
    return std::any_of(quaternion.begin(), quaternion.end(),
                       [](const NamedFacts* one) { return one->facts->different > 0; });
  }
};

/// Whether a column can be of a pose of this file: it may stand still, but not be taken.
bool is_open(const FreeFields& fields, const NamedFacts& field, const std::string& file) {
  return field.file == file && !fields.is_taken(field) && field.facts->values > 0;
}

std::vector<const NamedFacts*> quaternion_in(const FreeFields& fields, const std::string& file,
                                             const std::vector<std::string>& words) {
  std::vector<const NamedFacts*> parts;
  for (const char axis : {'x', 'y', 'z', 'w'}) {
    for (const NamedFacts& one : fields.all()) {
      if (!is_open(fields, one, file) || one.facts->is_text) continue;
      if (!is_rotation_part(one.path) || has_word(one.path, {"cov"})) continue;
      if (axis_of(one.path) != axis || !(words.empty() || has_word(one.path, words))) continue;
      parts.push_back(&one);
      break;
    }
  }
  if (parts.size() == 2 && axis_of(parts[0]->path) == 'z') return parts;
  return parts.size() == 4 ? parts : std::vector<const NamedFacts*>();
}

/// Poses of a file, which may stand still; `words`: that their names must have one of.
std::optional<PoseColumns> poses_in(const FreeFields& fields, const std::string& file,
                                    const std::vector<std::string>& words) {
  PoseColumns found;
  const auto fits = [&](const NamedFacts& one) {
    return is_open(fields, one, file) && (words.empty() || has_word(one.path, words));
  };
  for (const NamedFacts& one : fields.all()) {
    if (!fits(one)) continue;
    if (found.x == nullptr && is_position(one, 'x')) found.x = &one;
    if (found.y == nullptr && is_position(one, 'y')) found.y = &one;
    const bool angle = !one.facts->is_text && has_word(one.path, kAngleWords) &&
                       !has_word(one.path, kRateWords) && !has_word(one.path, {"cov", "gyro"});
    const bool better = found.heading == nullptr || found.heading->facts->different == 0;
    if (angle && better) found.heading = &one;
  }
  if (found.x == nullptr || found.y == nullptr) return std::nullopt;
  if (found.heading == nullptr || found.heading->facts->different == 0) {
    std::vector<const NamedFacts*> quaternion = quaternion_in(fields, file, words);
    if (!quaternion.empty()) {
      found.heading = nullptr;
      found.quaternion = std::move(quaternion);
    }
  }
  if (found.heading == nullptr && found.quaternion.empty()) return std::nullopt;
  return found;
}

/// A pose's heading may count its turns: some of them in radians are more than a turn, too, but
/// come in small steps.
bool is_in_degrees(const LogFieldFacts& heading) {
  if (!looks_like_degrees(heading)) return false;
  constexpr double kWide = 60.0;
  constexpr double kLarge = 0.1;  // mean step
  const double step = heading.total_step / std::max(1.0, static_cast<double>(heading.values) - 1.0);
  return heading.largest - heading.least > kWide || step > kLarge;
}

/// Lines of [odometry] or [truth]; `off`: before each.
void write_poses(const PoseColumns& poses, const std::string& off, MapText& text) {
  const auto line = [&](const char* key, const std::string& value, const char* why = "") {
    text.line(off + key + " = " + io::toml_string(value), why);
  };
  line("x", poses.x->path);
  line("y", poses.y->path);
  if (const auto unit = unit_in(poses.x->path); is_of(unit, {Quantity::length})) {
    line("unit", std::string(unit->name));
  }
  if (poses.heading != nullptr) {
    line("heading", poses.heading->path);
    const auto unit = unit_in(poses.heading->path);
    const bool stated = is_of(unit, {Quantity::angle});
    const bool degrees = stated ? unit->name == "deg" : is_in_degrees(*poses.heading->facts);
    line("heading_unit", degrees ? "deg" : "rad", stated ? "" : "a guess by its range");
    return;
  }
  std::string list;
  for (const NamedFacts* one : poses.quaternion) {
    list += (list.empty() ? "" : ", ") + io::toml_string(one->path);
  }
  text.line(off + "quaternion = [" + list + "]");
}

struct SpeedColumns {
  const NamedFacts* speed = nullptr;
  const NamedFacts* turn_rate = nullptr;
  const NamedFacts* sideways = nullptr;

  [[nodiscard]] bool moves() const {
    return speed->facts->different > 0 || turn_rate->facts->different > 0;
  }
};

std::optional<SpeedColumns> speeds_in(const FreeFields& fields, const std::string& file) {
  static const std::vector<std::string> kNot{"cov",     "cmd",  "target", "goal", "setpoint",
                                             "acc",     "left", "right",  "max",  "limit",
                                             "desired", "gyro", "imu"};
  SpeedColumns found;
  // One that changes before one that does not.
  const auto is_first = [](const NamedFacts* before) {
    return before == nullptr || before->facts->different == 0;
  };
  for (const NamedFacts& one : fields.all()) {
    if (!is_open(fields, one, file) || one.facts->is_text || has_word(one.path, kNot)) continue;
    if (is_rotation_part(one.path)) continue;
    const char axis = axis_of(one.path);
    const bool linear = has_word(one.path, {"linear", "speed", "vel", "=lin", "=v", "=vx", "=vy"});
    const bool turns = has_word(one.path, {"angular", "omega", "yaw", "theta", "heading", "turn",
                                           "gyro", "vth", "vyaw", "=ang", "=w", "=wz", "=om"});
    const bool rate = has_word(one.path, {"rate", "vel", "speed", "angular", "omega", "dot", "vth",
                                          "vyaw", "yawrate", "=ang", "=w", "=wz", "=om"});
    if (linear && !turns && (axis == 'x' || axis == '\0') && is_first(found.speed)) {
      found.speed = &one;
    } else if (linear && !turns && axis == 'y' && found.sideways == nullptr) {
      found.sideways = &one;
    } else if (turns && rate && axis != 'x' && axis != 'y' && is_first(found.turn_rate)) {
      found.turn_rate = &one;
    }
  }
  if (found.speed == nullptr || found.turn_rate == nullptr) return std::nullopt;
  if (found.sideways != nullptr && found.sideways->facts->different == 0) found.sideways = nullptr;
  return found;
}

void write_speeds(const SpeedColumns& speeds, const std::string& off, MapText& text) {
  const auto line = [&](const char* key, const std::string& value, const char* why = "") {
    text.line(off + key + " = " + io::toml_string(value), why);
  };
  line("speed", speeds.speed->path, "held since the row before");
  line("turn_rate", speeds.turn_rate->path);
  if (const auto unit = unit_in(speeds.speed->path); is_of(unit, {Quantity::speed})) {
    line("speed_unit", std::string(unit->name));
  }
  const auto unit = unit_in(speeds.turn_rate->path);
  const bool stated = is_of(unit, {Quantity::turn_rate});
  const bool degrees =
      stated ? unit->name == "deg/s" : looks_like_degrees(*speeds.turn_rate->facts);
  line("turn_rate_unit",
       stated    ? std::string(unit->name)
       : degrees ? "deg/s"
                 : "rad/s",
       stated ? "" : "a guess by its range");
  if (speeds.sideways != nullptr) line("sideways", speeds.sideways->path);
}

void take(const PoseColumns& poses, FreeFields& fields) {
  for (const NamedFacts* one : {poses.x, poses.y, poses.heading}) {
    if (one != nullptr) fields.mark_taken(*one);
  }
  for (const NamedFacts* one : poses.quaternion) fields.mark_taken(*one);
}

void take(const SpeedColumns& speeds, FreeFields& fields) {
  for (const NamedFacts* one : {speeds.speed, speeds.turn_rate, speeds.sideways}) {
    if (one != nullptr) fields.mark_taken(*one);
  }
}

/// Files in their order, one that is called an odometry first.
std::vector<std::string> files_of(const FreeFields& fields) {
  std::vector<std::string> files;
  for (const NamedFacts& one : fields.all()) {
    if (std::find(files.begin(), files.end(), one.file) == files.end()) files.push_back(one.file);
  }
  std::stable_partition(files.begin(), files.end(), [](const std::string& file) {
    return has_word(stem_of(file), {"odo", "wheel", "drive"});
  });
  return files;
}

void write_robot(MapText& text) {
  text.blank();
  text.table("robot");
  text.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
}

}  // namespace

std::optional<int> guess_odometry(FreeFields& fields, MapText& text) {
  for (const std::string& file : files_of(fields)) {
    std::optional<PoseColumns> poses = poses_in(fields, file, {});
    const bool estimate = has_word(stem_of(file), {"amcl", "gps", "gnss", "uwb", "fix"});
    if (estimate) poses.reset();
    const std::optional<SpeedColumns> speeds = speeds_in(fields, file);
    const bool driven = speeds && speeds->moves();
    // Poses that stand still, or a heading that does where there is a turn rate, are not filled in.
    const bool summed = poses && poses->moves() &&
                        (poses->turns() || !driven || speeds->turn_rate->facts->different == 0);
    if (!summed && !driven) continue;
    write_robot(text);
    text.blank();
    text.table("odometry", summed ? "from its poses" : "from its velocities");
    write_file_of(summed ? *poses->x : *speeds->speed, text);
    if (poses && !summed) {
      text.comment("its poses " + std::string(poses->moves() ? "never turn" : "never move") +
                   " where its velocities do: passed over");
    }
    if (summed) {
      write_poses(*poses, "", text);
    } else {
      write_speeds(*speeds, "", text);
    }
    if (summed && driven) {
      text.comment("In place of the poses, its velocities:");
      write_speeds(*speeds, "# ", text);
    }
    if (poses) take(*poses, fields);
    if (speeds) take(*speeds, fields);
    return 1;
  }
  return std::nullopt;
}

void pass_over_odometries(FreeFields& fields, MapText& text) {
  for (const std::string& file : files_of(fields)) {
    const std::optional<PoseColumns> poses = poses_in(fields, file, {});
    if (!poses || !poses->moves()) continue;
    text.blank();
    text.comment("Passed over: the poses " + poses->x->path + ", " + poses->y->path +
                 (file.empty() ? "" : " of " + file) +
                 ", which sum the wheels up, or are an estimate. What was measured apart is a "
                 "[truth].");
    take(*poses, fields);
    if (const auto speeds = speeds_in(fields, file)) take(*speeds, fields);
  }
}

bool guess_truth(FreeFields& fields, MapText& text) {
  static const std::vector<std::string> kTruth{"truth", "true",   "mocap", "vicon",
                                               "opti",  "ground", "gt_"};
  for (const std::string& file : files_of(fields)) {
    const bool called =
        !file.empty() && (has_word(stem_of(file), kTruth) || has_word(stem_of(file), {"=gt"}));
    const auto poses = poses_in(fields, file, called ? FreeFields::Words() : kTruth);
    if (!poses || !poses->moves() || (!called && !poses->turns())) continue;
    text.blank();
    text.table("truth");
    write_file_of(*poses->x, text);
    write_poses(*poses, "", text);
    take(*poses, fields);
    return true;
  }
  return false;
}

}  // namespace trussmap::logs
