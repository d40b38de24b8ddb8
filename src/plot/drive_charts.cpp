// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/drive_charts.hpp"

#include "effects/channel_physics.hpp"
#include "effects/wheel_places.hpp"
#include "geometry/index.hpp"
#include "geometry/units.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

/// Strokes seen from above: the page's x is to the right, its y ahead.
class Strokes {
 public:
  Strokes(const std::string& name, const std::string& colour, double size) {
    layer_ = {LayerKind::segments,
              name,
              {{"right [m]"}, {"ahead [m]"}, {"to right [m]"}, {"to ahead [m]"}},
              colour,
              size};
  }

  void dash() { layer_.dashed = true; }

  /// In the robot's axes, m.
  void add(const Vector2& from, const Vector2& to) {
    const std::array<double, 4> numbers = {-from.y(), from.x(), -to.y(), to.x()};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      layer_.columns[k].numbers.push_back(numbers[k]);
    }
  }

  void add_about(const Vector2& middle, double angle, double length) {
    const Vector2 half = 0.5 * length * Vector2(std::cos(angle), std::sin(angle));
    add(middle - half, middle + half);
  }

  void add_to(Chart& chart) const {
    if (!layer_.columns[0].numbers.empty()) chart.layers.push_back(layer_);
  }

 private:
  ChartLayer layer_;
};

/// Wheels that nothing is read of, of a robot that steers.
std::vector<Vector2> idle_wheels(const Robot& robot) {
  const double side = 0.35 * robot.length;
  if (robot.drive == DriveKind::tricycle) return {{0.0, side}, {0.0, -side}};
  if (robot.drive != DriveKind::ackermann) return {};
  const double track = std::max(side, std::abs(robot.wheel_left));
  return {{0.0, track}, {0.0, -track}};
}

std::string caption_of(const Robot& robot) {
  std::string text =
      "From above, ahead is up. A stroke is a wheel, with its column beside it, and lies along the "
      "way it rolls; the cross is the point whose way is reckoned.";
  if (robot.drive == DriveKind::mecanum) text += " Thin: the axes of the rollers on the floor.";
  if (robot.drive == DriveKind::skid_steer && robot.columns.size() > 2) {
    text += " How far the wheels of one side are apart matters nothing, and is made up.";
  }
  if (effects::is_of_drive(Channel::steer, robot)) {
    text +=
        " Dashed: the steered wheel at its smallest and largest angle. Grey wheels are not read, "
        "and how far they are apart is made up.";
  }
  return text;
}

/// Half of what the picture shows, m.
double reach_of(const Robot& robot, const std::vector<WheelPlace>& places,
                const std::vector<Vector2>& others) {
  double reach = effects::is_of_drive(Channel::steer, robot) ? 0.6 * robot.length : 0.0;
  for (const WheelPlace& one : places) reach = std::max(reach, std::hypot(one.x, one.y));
  for (const Vector2& one : others) reach = std::max(reach, one.norm());
  return reach > 0.0 ? reach : 1.0;
}

/// The layers of a robot's wheels, whose strokes are so long, m.
struct WheelLayers {
  double length = 0.0;
  Strokes frame{"", "faint", 1.5};
  Strokes wheels{"", "1", 8.0};
  Strokes others{"", "faint", 8.0};
  Strokes rollers{"", "2", 2.0};
  Strokes turned{"", "2", 2.0};
  ChartLayer names{LayerKind::labels, "", {{"right [m]"}, {"ahead [m]"}, {"column"}}, "ink"};

  /// Before a wheel in front, behind one in the rear, beside one between them.
  void name(const Vector2& at, const std::string& text) {
    const bool between = at.x() == 0.0 && at.y() != 0.0;
    const double beside = between ? std::copysign(length, at.y()) : 0.0;
    const double before = between ? 0.0 : at.x() > 0.0 ? 0.75 * length : -1.3 * length;
    names.columns[0].numbers.push_back(-at.y() - beside);
    names.columns[1].numbers.push_back(at.x() + before);
    names.columns[2].texts.push_back(text);
  }

  void add_read(const WheelPlace& one, const std::string& column) {
    const Vector2 at(one.x, one.y);
    frame.add(Vector2::Zero(), at);
    wheels.add_about(at, one.direction, length);
    if (one.roller != 0.0) rollers.add_about(at, one.direction + one.roller, 1.1 * length);
    name(at, column);
  }

  void add_idle(const Vector2& from, const Vector2& at) {
    frame.add(from, at);
    others.add_about(at, 0.0, length);
  }

  void add_steered(const Vector2& at, const std::optional<Range>& steered) {
    if (!steered) return;
    turned.add_about(at, steered->low, 1.3 * length);
    turned.add_about(at, steered->high, 1.3 * length);
  }

  /// `cross`: the arms of the cross in the middle, m.
  void add_to(Chart& chart, double cross) const {
    for (const Strokes* one : {&frame, &others, &wheels, &rollers, &turned}) one->add_to(chart);
    Strokes centre("", "ink", 2.0);
    centre.add_about(Vector2::Zero(), 0.0, cross);
    centre.add_about(Vector2::Zero(), 0.5 * std::numbers::pi, cross);
    centre.add_to(chart);
    chart.layers.push_back(names);
  }
};

WheelLayers wheel_layers(const Robot& robot, const std::vector<WheelPlace>& places,
                         const std::vector<Vector2>& idle, double length,
                         const std::optional<Range>& steered) {
  WheelLayers layers{length};
  layers.turned.dash();
  for (std::size_t k = 0; k < places.size(); ++k) {
    layers.add_read(places[k], robot.drive == DriveKind::tricycle
                                   ? robot.columns[0] + ", " + robot.columns[1]
                                   : robot.columns[k]);
  }
  for (const Vector2& at : idle) layers.add_idle(Vector2::Zero(), at);
  const Vector2 front(robot.length, 0.0);
  if (robot.drive == DriveKind::tricycle) layers.add_steered(front, steered);
  if (robot.drive == DriveKind::ackermann) {
    layers.frame.add(Vector2::Zero(), front);
    for (const Vector2& rear : idle) {
      layers.add_idle(front, front + rear);
      layers.add_steered(front + rear, steered);
    }
    layers.name(front, robot.columns[1]);
  }
  return layers;
}

}  // namespace

Chart wheels_chart(const Robot& robot, const std::optional<Range>& steered) {
  Chart chart;
  chart.id = "wheels";
  chart.title = fmt::format("The robot's wheels ({})", name_of(robot.drive));
  chart.caption = caption_of(robot);
  chart.x = {.title = "to the right [m]"};
  chart.y = {.title = "ahead [m]"};
  chart.equal_aspect = true;
  const std::vector<WheelPlace> places = effects::wheel_places(robot);
  if (places.empty()) return chart;

  const std::vector<Vector2> idle = idle_wheels(robot);
  const double reach = reach_of(robot, places, idle);
  const double length = 0.45 * reach;
  wheel_layers(robot, places, idle, length, steered).add_to(chart, 0.12 * reach);
  const bool steers = effects::is_of_drive(Channel::steer, robot);
  const double front = steers ? robot.length : reach;
  const double back = steers ? 0.0 : reach;
  chart.x.range = Range{-reach - 2.0 * length, reach + 2.0 * length};
  chart.y.range = Range{-back - 1.6 * length, front + 1.3 * length};
  return chart;
}

namespace {

/// Shares of the way in classes of the angle, in %.
struct Shares {
  double low = 0.0;   ///< rad, of the first class
  double wide = 0.0;  ///< rad
  std::vector<double> forwards;
  std::vector<double> backwards;
};

ChartLayer share_layer(const std::string& name, const std::string& colour, const Shares& shares,
                       const std::vector<double>& of, double sign) {
  ChartLayer layer{LayerKind::band, name, {{"angle [deg]"}, {"from [%]"}, {"share [%]"}}, colour};
  for (std::size_t k = 0; k < of.size(); ++k) {
    for (const double edge : {0.0, 1.0}) {
      const double angle = shares.low + (static_cast<double>(k) + edge) * shares.wide;
      layer.columns[0].numbers.push_back(geometry::kDegrees * angle);
      layer.columns[1].numbers.push_back(std::min(0.0, sign * of[k]));
      layer.columns[2].numbers.push_back(std::max(0.0, sign * of[k]));
    }
  }
  return layer;
}

}  // namespace

std::optional<Steering> steering_of(const std::vector<DrivenRecording>& recordings) {
  constexpr int kClasses = 40;
  Shares shares;
  Range angles{1e9, -1e9};
  double way = 0.0;
  const auto each_row = [&](const auto& take) {
    for (const DrivenRecording& one : recordings) {
      const std::vector<WheelColumn>& wheels = one.drive.wheels;
      if (wheels.size() != 2 || !wheels[1].steers) continue;
      for (std::size_t row = 0; row < one.drive.rows(); ++row) {
        if (wheels[0].reading[row] != 0.0) take(wheels[0].reading[row], wheels[1].reading[row]);
      }
    }
  };
  each_row([&](double travel, double angle) {
    angles.low = std::min(angles.low, angle);
    angles.high = std::max(angles.high, angle);
    way += std::abs(travel);
  });
  if (way == 0.0) return std::nullopt;
  shares.low = angles.low;
  shares.wide = std::max(angles.high - angles.low, 1e-3) / kClasses;
  shares.forwards.assign(idx(kClasses), 0.0);
  shares.backwards = shares.forwards;
  each_row([&](double travel, double angle) {
    const int at =
        std::clamp(static_cast<int>((angle - shares.low) / shares.wide), 0, kClasses - 1);
    (travel > 0.0 ? shares.forwards : shares.backwards)[idx(at)] += 100.0 * std::abs(travel) / way;
  });
  Steering steering;
  steering.angles = angles;
  Chart& chart = steering.chart;
  chart.id = "steering";
  chart.title = "How far it steered";
  chart.caption =
      "Share of the wheel's way by the steering angle, to the left above 0; driven forwards above "
      "the axis, backwards below it. A wrong zero acts on all of it, play in the steering by the "
      "difference of the two, a wrong scale on large angles.";
  chart.x = {.title = "steering angle [deg]"};
  chart.y = {.title = "way [%]", .zero = true};
  chart.layers.push_back(share_layer("forwards", "1", shares, shares.forwards, 1.0));
  const bool backs = std::any_of(shares.backwards.begin(), shares.backwards.end(),
                                 [](double one) { return one > 0.0; });
  if (backs) chart.layers.push_back(share_layer("backwards", "2", shares, shares.backwards, -1.0));
  chart.layers.push_back({LayerKind::upright, "", {{"straight ahead", {0.0}}}, "faint"});
  return steering;
}

}  // namespace trussmap::plot
