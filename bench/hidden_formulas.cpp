// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "hidden_formulas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

namespace trussmap::bench {
namespace {

/// Constants of one world.
class Constants {
 public:
  Constants(const Extent& extent, std::uint64_t seed)
      : extent_(extent), random_(seed * 7919 + 101) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double seconds(double low, double high) {
    return std::round(extent_.duration * uniform(low, high));
  }
  /// Beyond a line at any angle, through the middle third of the floor.
  std::string beyond_line() {
    const double angle = uniform(-std::numbers::pi, std::numbers::pi);
    const Vector2 normal(std::cos(angle), std::sin(angle));
    const Vector2 at =
        extent_.low + (extent_.high - extent_.low)
                          .cwiseProduct(Vector2(uniform(0.33, 0.67), uniform(0.33, 0.67)));
    return fmt::format("{:.3f}*x+({:.3f})*y>({:.2f})", normal.x(), normal.y(), normal.dot(at));
  }
  /// A wave across the floor, 0.4 to 1.2 of its extent long.
  std::string wave() {
    const double angle = uniform(-std::numbers::pi, std::numbers::pi);
    const double length = (extent_.high - extent_.low).maxCoeff() * uniform(0.4, 1.2);
    const double k = 2.0 * std::numbers::pi / length;
    return fmt::format("sin({:.4f}*x+({:.4f})*y+({:.2f}))", k * std::cos(angle),
                       k * std::sin(angle), uniform(-std::numbers::pi, std::numbers::pi));
  }

 private:
  const Extent& extent_;
  std::mt19937_64 random_;
};

}  // namespace

Extent extent_of(const SimulatedRecording& world) {
  Extent extent{world.mesh.positions.front(), world.mesh.positions.front(),
                world.drive.motion.rows.back().t};
  for (const Vector2& one : world.mesh.positions) {
    extent.low = extent.low.cwiseMin(one);
    extent.high = extent.high.cwiseMax(one);
  }
  return extent;
}

std::vector<HiddenFormula> hidden_formulas(const Extent& extent, std::uint64_t seed) {
  Constants draw(extent, seed);
  std::vector<HiddenFormula> list;
  const auto add = [&list](const std::string& name, Channel channel,
                           const std::vector<Shape>& shapes) {
    HiddenFormula one;
    one.name = name;
    one.effect = {
        fmt::format("{} x {}", name_of(channel), shapes.front().text()), channel, shapes, {}};
    one.needs_compass = channel == Channel::compass;
    one.needs_gyro = channel == Channel::gyro;
    list.push_back(std::move(one));
  };
  const auto f = [](const char* pattern, double value) {
    return fmt::format(fmt::runtime(pattern), value);
  };
  add("load*speed", Channel::travel, {"payload_kg*speed"});
  add("load*turn_rate", Channel::creep, {"payload_kg*turn_rate"});
  add("load*|turn_rate|", Channel::turn, {"payload_kg*abs(turn_rate)"});
  add("speed*turn_rate", Channel::difference, {"speed*turn_rate"});
  add("temperature*t", Channel::gyro, {"(temperature_C-20)*t"});
  add("speed^2", Channel::travel, {"speed^2"});
  add("|turn_rate|^2", Channel::turn, {"turn_rate^2"});
  add("sqrt|turn_rate|", Channel::turn, {"sqrt(abs(turn_rate))"});
  add("1/(c+speed)", Channel::travel, {f("1/({:.2f}+abs(speed))", draw.uniform(0.05, 0.2))});
  add("load^2", Channel::wheels, {"payload_kg^2"});
  add("sqrt load", Channel::left, {"sqrt(payload_kg)"});
  add("exp(-t/T) travel", Channel::travel, {f("exp(-t/{:.0f})", draw.seconds(0.08, 0.3))});
  add("1-exp(-t/T) wheels", Channel::wheels, {f("1-exp(-t/{:.0f})", draw.seconds(0.08, 0.3))});
  add("exp(-t/T) turn", Channel::turn, {f("exp(-t/{:.0f})", draw.seconds(0.08, 0.3))});
  add("1-exp(-t/T) gyro", Channel::gyro, {f("1-exp(-t/{:.0f})", draw.seconds(0.08, 0.3))});
  add("threshold speed", Channel::travel, {f("max(0, speed-{:.2f})", draw.uniform(0.4, 0.65))});
  add("speed>c", Channel::difference, {f("speed>{:.2f}", draw.uniform(0.4, 0.65))});
  add("step in t", Channel::turn, {f("t>{:.0f}", draw.seconds(0.3, 0.7))});
  add("load>c", Channel::travel, {f("payload_kg>{:.1f}", draw.uniform(6.0, 14.0))});
  add("saturation turn", Channel::turn,
      {f("turn_rate^2/({:.2f}+turn_rate^2)", draw.uniform(0.1, 0.3))});
  add("four per turn", Channel::compass, {"sin(4*heading)", "cos(4*heading)"});
  add("four per turn travel", Channel::travel, {"sin(4*heading)", "cos(4*heading)"});
  add("load*|speed| compass", Channel::compass, {"payload_kg*speed"});
  add("two floors wheels", Channel::wheels, {draw.beyond_line()});
  add("two floors creep", Channel::creep, {draw.beyond_line()});
  add("two floors turn", Channel::turn, {draw.beyond_line()});
  add("wave travel", Channel::travel, {draw.wave()});
  add("wave creep", Channel::creep, {draw.wave()});
  add("wave compass", Channel::compass, {draw.wave()});
  return list;
}

}  // namespace trussmap::bench
