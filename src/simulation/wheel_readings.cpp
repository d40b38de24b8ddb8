// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/wheel_readings.hpp"

#include "effects/channel_physics.hpp"
#include "effects/wheel_places.hpp"
#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace trussmap::simulation {
namespace {

using RowGain = std::function<double(Channel)>;

[[noreturn]] void refuse(double t) {
  throw std::invalid_argument(fmt::format(
      "the effects leave no wheel travels that could be shown at t = {:g} s, expected gains "
      "above -1",
      t));
}

/// What the wheels of a row have to show, once what is added per row is taken off.
Eigen::Vector3d asked_of_wheels(const TrueRow& row, const RowGain& g) {
  return {row.speed * row.duration + row.jump - g(Channel::advance), row.sideways * row.duration,
          row.turn_rate * row.duration - g(Channel::rotate) - g(Channel::drift) * row.duration};
}

ShownRow two_wheels(const TrueRow& row, const RowGain& g, double wheelbase) {
  // Each wheel's own share of what it shows, whatever the other does.
  const double left = 1.0 + g(Channel::wheels) + g(Channel::left) - 0.5 * g(Channel::difference);
  const double right = 1.0 + g(Channel::wheels) + g(Channel::right) + 0.5 * g(Channel::difference);
  // Twice the travel and B times the turn, freed from what is added per row:
  //   (left + travel) L + (right + travel) R = sum,   (right + turn) R - (left + turn) L = skew
  const double travel = g(Channel::travel);
  const double turn = g(Channel::turn);
  const double sum = 2.0 * (row.speed * row.duration + row.jump - g(Channel::advance));
  const double skew = wheelbase * (row.turn_rate * row.duration - g(Channel::rotate) -
                                   g(Channel::drift) * row.duration);
  const double determinant = (left + travel) * (right + turn) + (right + travel) * (left + turn);
  if (!(std::abs(determinant) > 1e-6)) refuse(row.t);
  const double L = ((right + turn) * sum - (right + travel) * skew) / determinant;
  const double R = ((left + turn) * sum + (left + travel) * skew) / determinant;
  return {{L, R}, {0.5 * (L + R) / row.duration, (R - L) / (wheelbase * row.duration), 0.0}};
}

/// Wheels that do not steer.
class RollingWheels {
 public:
  explicit RollingWheels(const Robot& robot) {
    const std::vector<WheelPlace> places = effects::wheel_places(robot);
    if (places.empty()) {
      together_ = robot.matrix;
      ways_ = together_.completeOrthogonalDecomposition().pseudoInverse();
      return;
    }
    ways_.resize(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t k = 0; k < places.size(); ++k) {
      // The place goes by (f - a y, s + a x). Rollers let it slip across their axes, so that the
      // wheel rolls until its way along them is right.
      const WheelPlace& one = places[k];
      const Vector2 axis = unit(one.direction + one.roller) / std::cos(one.roller);
      ways_.row(static_cast<Eigen::Index>(k)) << axis.x(), axis.y(),
          one.x * axis.y() - one.y * axis.x();
    }
    ways_ = ways_.unaryExpr([](double way) { return std::abs(way) < 1e-15 ? 0.0 : way; });
    together_ = ways_.completeOrthogonalDecomposition().pseudoInverse();
  }

  [[nodiscard]] Eigen::VectorXd readings(const TrueRow& row, const RowGain& g) const {
    Eigen::VectorXd D(ways_.rows());
    for (Eigen::Index k = 0; k < D.size(); ++k) {
      const auto wheel = static_cast<Channel>(static_cast<int>(Channel::wheel1) + k);
      D[k] = 1.0 + g(Channel::wheels) + g(wheel);
    }
    const Eigen::Vector3d T(g(Channel::travel), g(Channel::sideways), g(Channel::turn));
    const Eigen::MatrixXd travels = D.cwiseInverse().asDiagonal() * ways_;
    const Eigen::Matrix3d A =
        Eigen::Matrix3d::Identity() + T.asDiagonal() * Eigen::Matrix3d(together_ * travels);
    if (!(D.cwiseAbs().minCoeff() > 1e-6) || !(std::abs(A.determinant()) > 1e-6)) refuse(row.t);
    return travels * A.inverse() * asked_of_wheels(row, g);
  }

  /// f, s, a by the travels alone.
  [[nodiscard]] Eigen::Vector3d motion(const Eigen::VectorXd& travels) const {
    return together_ * travels;
  }

  [[nodiscard]] Eigen::VectorXd ways(const Eigen::Vector3d& motion) const { return ways_ * motion; }

 private:
  static Vector2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

  Eigen::MatrixXd ways_;      ///< J
  Eigen::MatrixXd together_;  ///< J+
};

/// A wheel's travel and a steering angle.
class SteeredWheel {
 public:
  explicit SteeredWheel(const Robot& robot) : robot_(robot) {}

  /// The angle [rad] where the steering was before is where it stays at rest.
  [[nodiscard]] Eigen::Vector2d readings(const TrueRow& row, const RowGain& g, double angle) const {
    const Eigen::Vector3d asked = asked_of_wheels(row, g);
    const double L = robot_.length;
    const Eigen::Vector2d wanted(asked[0], L * asked[2]);
    if (wanted.norm() < 1e-12) return {0.0, angle};
    const auto shown = [&](double at) -> Eigen::Vector2d {
      const double points = at + g(Channel::steer) + g(Channel::steer_gain) * at;
      const Eigen::Vector2d per =
          shares(points, g(Channel::wheel_left) / L, g(Channel::steer_left) / L);
      // A reading of the rear axle is its own way; one of the front a length ahead goes aside, too.
      const double other = robot_.drive == DriveKind::tricycle ? 1.0 / std::max(per[0], kLeastWay)
                                                               : 1.0 / std::hypot(1.0, per[1]);
      const double common = 1.0 + g(Channel::wheels) + g(Channel::other_axle) * (other - 1.0);
      return {(common + g(Channel::travel)) * per[0], (common + g(Channel::turn)) * per[1]};
    };
    if (robot_.drive == DriveKind::tricycle) {
      const double sense = row.speed < 0.0 ? -1.0 : 1.0;
      angle = std::atan2(sense * wanted[1], sense * wanted[0]);
    } else if (std::abs(wanted[0]) < 1e-12) {
      throw std::invalid_argument(fmt::format(
          "the effects would turn the robot where it stands, at t = {:g} s, which the wheels of "
          "drive ackermann cannot show, expected a robot that does not rest",
          row.t));
    } else {
      angle = std::atan(wanted[1] / wanted[0]);
    }
    angle = aligned(shown, wanted, angle, row.t);
    const Eigen::Vector2d per = shown(angle);
    return {per.dot(wanted) / per.squaredNorm(), angle};
  }

  [[nodiscard]] Eigen::Vector3d motion(const Eigen::Vector2d& reading) const {
    const Eigen::Vector2d moved = reading[0] * shares(reading[1]);
    return {moved[0], 0.0, moved[1] / robot_.length};
  }

 private:
  /// Of a metre of travel: the way ahead, and length x turn [m]. The wheels stand so many lengths
  /// further left than stated.
  [[nodiscard]] Eigen::Vector2d shares(double angle, double measured = 0.0,
                                       double steered = 0.0) const {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double z = robot_.steer_left / robot_.length + steered;
    // The steered wheel is the front one, and goes where it points; the middle of the axle goes
    // ahead, and past the wheel's side the more the wheel turns about it.
    if (robot_.drive == DriveKind::tricycle) return {c + z * s, s};
    // All turn about a point on the rear axle, so far to the left that the wheel points across it,
    // from where that stands; the measured wheel is nearer to it than the middle.
    const double y = robot_.wheel_left / robot_.length + measured;
    if (s == 0.0) return {1.0, 0.0};
    const double centre = c / s + z;  // lengths to the left
    return {centre / (centre - y), 1.0 / (centre - y)};
  }

  /// Newton's method for the angle at which what is shown is along what is wanted.
  template <typename Shown>
  static double aligned(const Shown& shown, const Eigen::Vector2d& wanted, double angle, double t) {
    constexpr double kStep = 1e-6;  // rad
    const Eigen::Vector2d across = Eigen::Vector2d(-wanted[1], wanted[0]).normalized();
    const auto error = [&](double at) { return across.dot(shown(at)); };
    for (int pass = 0; pass < 50; ++pass) {
      const double slope = (error(angle + kStep) - error(angle - kStep)) / (2.0 * kStep);
      const double change = -error(angle) / slope;
      if (!(std::abs(change) < 1.0)) refuse(t);
      angle += change;
      if (std::abs(change) < 1e-15) break;
    }
    return angle;
  }

  static constexpr double kLeastWay = 0.1;  // of the rear axle, per metre of the steered wheel

  const Robot& robot_;
};

std::vector<double> listed(const Eigen::VectorXd& numbers) {
  return {numbers.begin(), numbers.end()};
}

RowRates rates_of(const Eigen::Vector3d& motion, double duration) {
  return {motion[0] / duration, motion[2] / duration, motion[1] / duration};
}

Eigen::VectorXd as_vector(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                           static_cast<Eigen::Index>(numbers.size()));
}

bool steers(const Robot& robot) {
  return effects::is_of_drive(Channel::steer, robot);
}

}  // namespace

double gain(const ChannelGains& gains, Channel channel, std::size_t row) {
  const auto found = gains.find(channel);
  return found == gains.end() ? 0.0 : found->second[row];
}

std::vector<ShownRow> readings_under(const TrueMotion& motion, const ChannelGains& gains,
                                     const Robot& robot) {
  std::vector<ShownRow> result;
  result.reserve(motion.rows.size());
  const bool two = robot.drive == DriveKind::differential || robot.drive == DriveKind::unicycle;
  const RollingWheels rolling(two || steers(robot) ? Robot() : robot);
  const SteeredWheel steered(robot);
  double angle = 0.0;
  for (std::size_t k = 0; k < motion.rows.size(); ++k) {
    const TrueRow& row = motion.rows[k];
    const RowGain g = [&](Channel channel) { return gain(gains, channel, k); };
    if (two) {
      result.push_back(two_wheels(row, g, robot.wheelbase));
    } else if (steers(robot)) {
      const Eigen::Vector2d shown = steered.readings(row, g, angle);
      angle = shown[1];
      result.push_back({listed(shown), rates_of(steered.motion(shown), row.duration)});
    } else {
      const Eigen::VectorXd shown = rolling.readings(row, g);
      result.push_back({listed(shown), rates_of(rolling.motion(shown), row.duration)});
    }
  }
  return result;
}

std::vector<double> misreading_of(const ShownRow& row, double duration, double travel_share,
                                  double turn_share, const Robot& robot) {
  const RowRates& shown = row.rates;
  if (!steers(robot)) {
    const Eigen::Vector3d more(travel_share * shown.speed, travel_share * shown.sideways,
                               turn_share * shown.turn_rate);
    return listed(RollingWheels(robot).ways(duration * more));
  }
  TrueRow misread;
  misread.duration = duration;
  misread.speed = (1.0 + travel_share) * shown.speed;
  misread.turn_rate = (1.0 + turn_share) * shown.turn_rate;
  const RowGain none = [](Channel) { return 0.0; };
  const Eigen::Vector2d reading = as_vector(row.readings);
  return listed(SteeredWheel(robot).readings(misread, none, reading[1]) - reading);
}

}  // namespace trussmap::simulation
