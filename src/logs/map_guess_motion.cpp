// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/named_fields.hpp"

namespace trussmap::logs {
namespace {

struct WheelFields {
  const NamedFacts* left = nullptr;
  const NamedFacts* right = nullptr;
};

std::optional<WheelFields> wheel_fields(const FreeFields& fields, const FreeFields::Words& what,
                                        const FreeFields::Words& without) {
  static const FreeFields::Words kLeft{"left", "lf", "encl", "=l", "=vl", "=wl", "=dl", "=sl"};
  static const FreeFields::Words kRight{"right", "rf", "encr", "=r", "=vr", "=wr", "=dr", "=sr"};
  FreeFields rest = fields;
  while (const NamedFacts* left = rest.take({kLeft, what}, without)) {
    FreeFields others = rest;
    others.look_at(left->file);
    const NamedFacts* right = others.find({kRight, what}, without);
    // Left and right in files of their own.
    if (right == nullptr && has_word(stem_of(left->file), {"left"})) {
      others.look_at(std::nullopt);
      right = others.find({kRight, what}, without);
    }
    if (right != nullptr) return WheelFields{left, right};
  }
  return std::nullopt;
}

/// What a row adds: called so, or metres that never come to half a one.
bool is_increment(const NamedFacts& field, const std::optional<Unit>& unit, bool ticks) {
  if (has_word(field.path, {"delta", "incr", "=dl", "=dr", "=inc"})) return true;
  constexpr std::size_t kMany = 100;
  constexpr double kShort = 0.5;  // m
  const bool length = !ticks && (!unit || is_of(unit, {Quantity::length}));
  const double range = (field.facts->largest - field.facts->least) * (unit ? unit->si : 1.0);
  return length && field.facts->values > kMany && range < kShort;
}

/// What both wheels have in common. How many figures are left to state.
int guess_wheel_constants(const NamedFacts& field, MapText& text) {
  int to_state = 0;
  text.blank();
  text.table("wheels");
  const std::optional<Unit> unit = unit_in(field.path);
  const bool speed = has_word(field.path, {"vel", "speed", "rate", "=vl", "=wl"}) ||
                     is_of(unit, {Quantity::speed, Quantity::turn_rate});
  const bool joint = field.path.find("position[") != std::string::npos ||
                     field.path.find("velocity[") != std::string::npos;
  const bool whole =
      !joint && field.facts->is_whole && field.facts->largest - field.facts->least > 50.0;
  const bool ticks = is_of(unit, {Quantity::ticks}) ||
                     (!unit && (whole || has_word(field.path, {"tick", "count"})));
  if (ticks) {
    text.text("unit", speed ? "tick/s" : "tick");
    text.number("ticks_per_turn", 1000, kState);
    text.number("radius", 0.05, std::string("m; ") + kState);
    to_state = 2;
  } else if (is_of(unit, {Quantity::angle, Quantity::turn_rate})) {
    text.text("unit", std::string(unit->name));
    text.number("radius", 0.05, std::string("m; ") + kState);
    to_state = 1;
  } else if (is_of(unit, {Quantity::length, Quantity::speed})) {
    text.text("unit", std::string(unit->name));
  } else if (joint) {
    text.text("unit", speed ? "rad/s" : "rad", "of a joint");
    text.number("radius", 0.05, std::string("m; ") + kState);
    to_state = 1;
  } else {
    text.text("unit", speed ? "m/s" : "m", "a guess: its name states none");
  }
  if (!speed) {
    const bool sum = is_cumulative(*field.facts) && !is_increment(field, unit, ticks);
    text.text("kind", sum ? "cumulative" : "per row",
              sum ? "the sum so far" : "what was added since the row before");
    const double top = field.facts->largest;
    for (const double wraps : {256.0, 65536.0, 4294967296.0}) {
      if (sum && ticks && field.facts->least >= 0.0 && top < wraps && top > 0.98 * wraps) {
        text.number("wraps", wraps, "where the counter begins again");
      }
    }
  }
  return to_state;
}

void guess_wheel(const char* name, const NamedFacts& field, MapText& text) {
  text.blank();
  text.table(std::string("wheels.") + name);
  write_file_of(field, text);
  text.text("field", field.path);
  text.number("sign", 1, "-1 where it counts down ahead");
}

void guess_angle(const NamedFacts& field, const char* table, bool rate, MapText& text) {
  text.blank();
  text.table(table);
  write_file_of(field, text);
  text.text("field", field.path);
  const std::optional<Unit> unit = unit_in(field.path);
  if (is_of(unit, {rate ? Quantity::turn_rate : Quantity::angle})) {
    text.text("unit", std::string(unit->name));
  } else if (is_of(unit, {Quantity::angle, Quantity::turn_rate})) {
    const bool degrees = unit->name.starts_with("deg");
    text.text("unit", std::string(degrees ? "deg" : "rad") + (rate ? "/s" : ""));
  } else {
    text.text("unit",
              std::string(looks_like_degrees(*field.facts) ? "deg" : "rad") + (rate ? "/s" : ""),
              "a guess by its range");
  }
  text.number("sign", 1, "-1 where it grows clockwise");
}

}  // namespace

std::optional<int> guess_wheels(FreeFields& fields, MapText& text) {
  static const FreeFields::Words kTravel{"enc", "tick",   "count", "dist",
                                         "pos", "travel", "odo",   "wheel"};
  static const FreeFields::Words kSpeed{"vel", "speed", "rate"};
  static const FreeFields::Words kNot{"power",   "current", "volt",  "target",   "goal",
                                      "range",   "tag",     "temp",  "setpoint", "command",
                                      "applied", "output",  "steer", "azimuth"};
  FreeFields::Words slow = kNot;
  slow.insert(slow.end(), kSpeed.begin(), kSpeed.end());
  std::optional<WheelFields> found = wheel_fields(fields, kTravel, slow);
  if (!found) found = wheel_fields(fields, {""}, slow);
  if (!found) found = wheel_fields(fields, kSpeed, kNot);
  const bool named = found.has_value();
  if (!named) {
    if (const auto pair = unnamed_wheels(fields)) found = WheelFields{pair->first, pair->second};
  }
  if (!found) return std::nullopt;
  fields.mark_taken(*found->left);
  fields.mark_taken(*found->right);
  text.blank();
  text.table("robot");
  text.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
  int to_state = 1 + guess_wheel_constants(*found->left, text);
  if (!named) {
    text.comment("STATE IT: the table has no header; two columns that grow alike, left or right?");
    ++to_state;
  }
  guess_wheel("left", *found->left, text);
  guess_wheel("right", *found->right, text);
  return to_state;
}

void guess_headings(FreeFields& fields, MapText& text) {
  static const FreeFields::Words kNot{"tag",  "target",  "goal", "setpoint", "truth",       "temp",
                                      "cov",  "bearing", "gps",  "accel",    "acc",         "pitch",
                                      "roll", "linear",  "cmd",  "frame",    "orientation", "quat"};
  // Of a rate's three components that about z alone is the yaw's.
  for (const NamedFacts& one : fields.all()) {
    const char axis = axis_of(one.path);
    if (axis == 'x' || axis == 'y') fields.mark_taken(one);
  }
  FreeFields::Words no_sum = kNot;
  no_sum.insert(no_sum.end(), {"=az", "=mz", "=vz", "=qz", "=qw", "=z"});
  static const FreeFields::Words kCompass{"compass", "magnet", "heading", "yaw"};
  if (const NamedFacts* rate = fields.take(
          {{"gyro", "yaw", "heading", "angular"}, {"rate", "vel", "omega", "/s", "dps", "angular"}},
          kNot)) {
    guess_angle(*rate, "yaw_rate", true, text);
  } else if (const NamedFacts* omega =
                 fields.take({{"omega", "yawrate", "gyro_z", "gyroz", "gz", "wz"}}, kNot)) {
    guess_angle(*omega, "yaw_rate", true, text);
  } else if (const NamedFacts* sum = fields.take({{"gyro", "navx", "pigeon", "imu"}}, no_sum)) {
    guess_angle(*sum, "yaw_rate",
                !is_cumulative(*sum->facts) && !is_of(unit_in(sum->path), {Quantity::angle}), text);
  }
  if (const NamedFacts* compass = fields.take({kCompass}, kNot)) {
    text.blank();
    text.comment("If this is a compass; a gyro's sum is [yaw_rate] with the same keys:");
    guess_angle(*compass, "heading", false, text);
  }
}

}  // namespace trussmap::logs
