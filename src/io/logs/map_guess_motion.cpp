// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/named_fields.hpp"

namespace trussmap {
namespace {

struct WheelFields {
  const NamedFacts* left = nullptr;
  const NamedFacts* right = nullptr;
};

std::optional<WheelFields> wheel_fields(const FreeFields& fields, const FreeFields::Words& what,
                                        const FreeFields::Words& without) {
  static const FreeFields::Words kLeft{"left", "l_", "_l", "lf", "enc_l", "encl"};
  static const FreeFields::Words kRight{"right", "r_", "_r", "rf", "enc_r", "encr"};
  FreeFields rest = fields;
  const NamedFacts* left = rest.take({kLeft, what}, without);
  const NamedFacts* right = left == nullptr ? nullptr : rest.find({kRight, what}, without);
  if (right == nullptr) return std::nullopt;
  return WheelFields{left, right};
}

/// What both wheels have in common. How many figures are left to state.
int guess_wheel_constants(const NamedFacts& field, MapText& text) {
  int to_state = 0;
  text.blank();
  text.table("wheels");
  const std::optional<Unit> unit = unit_in(field.path);
  const bool speed = has_word(field.path, {"vel", "speed", "rate"}) ||
                     is_of(unit, {Quantity::speed, Quantity::turn_rate});
  const bool whole = field.facts->is_whole && field.facts->largest - field.facts->least > 50.0;
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
  } else {
    text.text("unit", speed ? "m/s" : "m", "a guess: its name states none");
  }
  if (!speed) {
    const bool sum = is_cumulative(*field.facts);
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
  text.text("field", field.path);
  text.number("sign", 1, "-1 where it counts down ahead");
}

void guess_angle(const NamedFacts& field, const char* table, bool rate, MapText& text) {
  text.blank();
  text.table(table);
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
  static const FreeFields::Words kNot{"power",    "current", "volt",    "target",
                                      "goal",     "range",   "tag",     "temp",
                                      "setpoint", "command", "applied", "output"};
  FreeFields::Words slow = kNot;
  slow.insert(slow.end(), kSpeed.begin(), kSpeed.end());
  std::optional<WheelFields> found = wheel_fields(fields, kTravel, slow);
  if (!found) found = wheel_fields(fields, {""}, slow);
  if (!found) found = wheel_fields(fields, kSpeed, kNot);
  if (!found) return std::nullopt;
  fields.mark_taken(*found->left);
  fields.mark_taken(*found->right);
  text.blank();
  text.table("robot");
  text.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
  const int to_state = 1 + guess_wheel_constants(*found->left, text);
  guess_wheel("left", *found->left, text);
  guess_wheel("right", *found->right, text);
  return to_state;
}

void guess_headings(FreeFields& fields, MapText& text) {
  static const FreeFields::Words kNot{"tag",  "target",  "goal", "setpoint", "truth",
                                      "temp", "bearing", "gps",  "accel",    "pitch",
                                      "roll", "_x",      "_y"};
  if (const NamedFacts* rate = fields.take(
          {{"gyro", "yaw", "heading", "angular"}, {"rate", "vel", "omega", "/s", "dps", "angular"}},
          kNot)) {
    guess_angle(*rate, "yaw_rate", true, text);
  } else if (const NamedFacts* omega =
                 fields.take({{"omega", "yawrate", "gyro_z", "gyroz", "gz"}}, kNot)) {
    guess_angle(*omega, "yaw_rate", true, text);
  } else if (const NamedFacts* sum = fields.take({{"gyro", "navx", "pigeon", "imu"}}, kNot)) {
    guess_angle(*sum, "yaw_rate",
                !is_cumulative(*sum->facts) && !is_of(unit_in(sum->path), {Quantity::angle}), text);
  }
  if (const NamedFacts* compass = fields.take({{"compass", "magnet", "heading", "yaw"}}, kNot)) {
    text.blank();
    text.comment("If this is a compass; a gyro's sum is [yaw_rate] with the same keys:");
    guess_angle(*compass, "heading", false, text);
  }
}

}  // namespace trussmap
