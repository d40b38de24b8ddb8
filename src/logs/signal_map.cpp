// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/signal_map.hpp"

#include "geometry/units.hpp"
#include "logs/motion_map.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::logs {

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

namespace {

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
  signal.file = table.text("file");
  signal.quaternion_fields = quaternion_of(table);
  signal.quaternion = !signal.quaternion_fields.empty();
  signal.field = signal.quaternion ? signal.quaternion_fields.front() : table.needed_text("field");
  signal.clock = table.clock();
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
  if (per_turn > 0.0 && radius > 0.0) return geometry::kFullTurn * radius / per_turn;
  table.fail("ticks need metres_per_tick, or ticks_per_turn and radius, expected them");
}

}  // namespace

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
  signal.quaternion = signal.quaternion || table.text("unit", "rad") == "quaternion";
  const double si = signal.quaternion ? 1.0 : unit_of(table, "unit", "rad", {Quantity::angle}).si;
  signal.scale = si * table.sign("sign");
  signal.offset = si * table.number("offset", 0.0);
  // Readings next to each other are less than half a turn apart: interpolated the short way.
  signal.kind = SignalMap::Kind::cumulative;
  signal.wraps = geometry::kFullTurn / si;
  table.finish();
  return signal;
}

SignalMap yaw_rate_of(const toml::table& node, const std::string& file) {
  TomlFields table(node, file, "[yaw_rate]");
  SignalMap signal = signal_of(table);
  signal.quaternion = signal.quaternion || table.text("unit", "rad/s") == "quaternion";
  if (signal.quaternion) {
    signal.kind = SignalMap::Kind::cumulative;
    signal.scale = table.sign("sign");
    signal.wraps = geometry::kFullTurn;
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
    signal.wraps = geometry::kFullTurn / unit.si;
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

}  // namespace trussmap::logs
