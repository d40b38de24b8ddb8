// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/wheeled_robot.hpp"

#include "effects/channel_physics.hpp"
#include "geometry/index.hpp"
#include "simulation/driving_checks.hpp"
#include "simulation/rough_noise.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace simulation;

namespace {

constexpr double kPatience = 1.5;  // of the rests round a drive whose sightings are stamped late

/// Chance, of one kind.
class Dice {
 public:
  Dice(std::uint64_t seed, Stream stream) : random_(random_stream(seed, stream)) {}

  double deviation(double sd) { return sd * normal_(random_); }
  bool falls(double share) {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < share;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// What the wheels would show without noise. Without effects two wheels need no equations.
std::vector<ShownRow> shown_by_wheels(const TrueMotion& motion, const Robot& robot,
                                      const ChannelGains& gains) {
  if (robot.drive != DriveKind::differential || !gains.empty()) {
    return readings_under(motion, gains, robot);
  }
  std::vector<ShownRow> seen;
  for (const TrueRow& row : motion.rows) {
    const double speed_about_centre = row.turn_rate * 0.5 * robot.wheelbase;
    seen.push_back({{(row.speed - speed_about_centre) * row.duration,
                     (row.speed + speed_about_centre) * row.duration},
                    {row.speed, row.turn_rate}});
  }
  return seen;
}

/// As the wheels show a row of a leg that they misread.
std::vector<double> misread(const ShownRow& row, double duration, const LegMisreading& leg,
                            const Robot& robot) {
  std::vector<double> shown = row.readings;
  if (robot.drive == DriveKind::differential) {
    const double forward = 0.5 * (shown[0] + shown[1]) * leg.travel;
    const double apart = 0.5 * (shown[1] - shown[0]) * leg.turn;
    return {shown[0] + forward - apart, shown[1] + forward + apart};
  }
  const std::vector<double> more = misreading_of(row, duration, leg.travel, leg.turn, robot);
  for (std::size_t k = 0; k < shown.size(); ++k) shown[k] += more[k];
  return shown;
}

/// What a gyro would say of a row without noise, rad/s.
double yaw_rate(const TrueRow& motion, const ChannelGains& gains, std::size_t row) {
  return (motion.turn_rate + gain(gains, Channel::gyro, row)) /
         (1.0 + gain(gains, Channel::gyro_scale, row));
}

/// One per column of the robot, with its noise.
std::vector<std::vector<double>> record_wheels(const TrueMotion& motion, const WheeledRobot& robot,
                                               std::uint64_t seed, const ChannelGains& gains,
                                               SensorErrors& errors) {
  const Robot& geometry = robot.geometry;
  const std::vector<ShownRow> rows = shown_by_wheels(motion, geometry, gains);
  const std::vector<LegMisreading> legs = leg_misreadings(motion, robot.rough, seed);
  const bool steers = effects::is_of_drive(Channel::steer, geometry);
  std::vector<std::vector<double>> columns(rows.front().readings.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double duration = motion.rows[row].duration;
    const std::vector<double>& seen = rows[row].readings;
    const std::vector<double> shown =
        legs.empty() ? seen : misread(rows[row], duration, legs[row], geometry);
    for (std::size_t k = 0; k < shown.size(); ++k) {
      const double error =
          steers && k == 1 ? errors.steering(seen[0]) : errors.wheel(k, seen[k], duration);
      columns[k].push_back(shown[k] + error);
    }
  }
  return columns;
}

/// A unicycle's wheels are two, of which it shows what they do together.
WheeledRobot on_its_wheels(WheeledRobot robot) {
  if (robot.geometry.drive == DriveKind::unicycle) robot.geometry.drive = DriveKind::differential;
  return robot;
}

void show_together(std::vector<std::vector<double>>& columns, double wheelbase) {
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    const double left = columns[0][row];
    const double right = columns[1][row];
    columns[0][row] = 0.5 * (left + right);
    columns[1][row] = (right - left) / wheelbase;
  }
}

Drive record_drive(const TrueMotion& motion, const WheeledRobot& robot, std::uint64_t seed,
                   const ChannelGains& gains) {
  const WheeledRobot wheels = on_its_wheels(robot);
  SensorErrors errors(wheels, seed);
  std::vector<std::vector<double>> columns = record_wheels(motion, wheels, seed, gains, errors);
  if (robot.geometry.drive == DriveKind::unicycle) {
    show_together(columns, robot.geometry.wheelbase);
  }
  Dice gyro(seed, Stream::gyro);
  double bias = 0.0;  // rad/s
  Drive drive;
  Covariate payload{"payload_kg", {}};
  Covariate lights{"lights", {}};
  Covariate temperature{"temperature_C", {}};
  for (const TrueRow& row : motion.rows) {
    const std::size_t at = drive.rows();
    drive.t.push_back(row.t);
    if (robot.compass) {
      const double heading = row.pose.heading + gain(gains, Channel::compass, at);
      drive.heading.push_back(wrap_angle(heading + errors.compass(row.duration)));
    }
    if (robot.gyro) {
      const double walked = gyro.deviation(robot.noise.gyro_walk * std::sqrt(row.duration));
      const double error = gyro.deviation(robot.noise.gyro / std::sqrt(row.duration));
      drive.yaw_rate.push_back(yaw_rate(row, gains, at) + bias + 0.5 * walked + error);
      bias += walked;
    }
    payload.values.push_back(row.surroundings.payload_kg);
    lights.values.push_back(row.surroundings.lights);
    temperature.values.push_back(row.surroundings.temperature_C);
  }
  if (robot.geometry.drive == DriveKind::differential) {
    drive.left = std::move(columns[0]);
    drive.right = std::move(columns[1]);
  } else {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      drive.covariates.push_back({robot.geometry.columns[k], std::move(columns[k])});
    }
  }
  for (Covariate* one : {&payload, &lights, &temperature}) {
    drive.covariates.push_back(std::move(*one));
  }
  drive.covariates.insert(drive.covariates.end(), motion.further.begin(), motion.further.end());
  return drive;
}

/// rad: the golden angle takes them all round.
double orientation_of(int landmark) {
  return wrap_angle(2.399963229728653 * landmark);
}

/// Standing on the landmark first, then what the range sensor sees from there.
std::vector<Sighting> sight(const TrueStop& stop, const Mesh& mesh, const WheeledRobot& robot,
                            const ChannelGains& gains, Dice& dice) {
  const std::size_t row = stop.rows == 0 ? 0 : stop.rows - 1;
  const auto g = [&](Channel channel) { return gain(gains, channel, row); };
  // In whole nanoseconds, as all times of a path.
  const double delay = g(Channel::delay);
  const double t = delay == 0.0 ? stop.t : std::round((stop.t + delay) * 1e9) / 1e9;
  std::vector<Sighting> sightings = {{t, landmark_name(mesh, stop.landmark)}};
  const auto yaw_of = [&](int landmark) {
    if (!robot.markers) return kAbsent;
    return wrap_angle(orientation_of(landmark) - stop.pose.heading + g(Channel::sighting_yaw) +
                      dice.deviation(robot.noise.yaw));
  };
  sightings.front().yaw = yaw_of(stop.landmark);
  if (!robot.range_sensor) return sightings;
  const Vector2 sensor =
      stop.pose.position() +
      rotation(stop.pose.heading) * Vector2(g(Channel::lever), g(Channel::lever_left));
  for (int k = 0; k < mesh.landmarks(); ++k) {
    const Vector2 view = mesh.positions[idx(k)] - sensor;
    if (k == stop.landmark || view.norm() > robot.reach) continue;
    const bool recognised = dice.falls(robot.recognition);
    const double range = view.norm() * (1.0 + g(Channel::range_scale)) + g(Channel::range) +
                         dice.deviation(robot.noise.range);
    const double bearing = wrap_angle(direction(view) - stop.pose.heading + g(Channel::bearing) +
                                      dice.deviation(robot.noise.bearing));
    if (recognised && range > 0.0) {
      sightings.push_back({t, landmark_name(mesh, k), robot.sees_ranges() ? range : kAbsent,
                           robot.sees_bearings() ? bearing : kAbsent});
      sightings.back().yaw = yaw_of(k);
    }
  }
  return sightings;
}

/// Within a row all speeds are constant in the robot's axes.
Pose part_of_row(const Pose& begin, const TrueRow& row, double time) {
  const double turned = row.turn_rate * time;
  // Mean of the way ahead, and of the way to the left, over the angles turned through.
  const double ahead = turned == 0.0 ? 1.0 : std::sin(turned) / turned;
  const double aside = turned == 0.0 ? 0.0 : 2.0 * std::pow(std::sin(0.5 * turned), 2) / turned;
  const Vector2 moved =
      time * Vector2(row.speed + row.jump / row.duration, row.slip_speed + row.sideways);
  const Vector2 way(ahead * moved.x() - aside * moved.y(), aside * moved.x() + ahead * moved.y());
  const Vector2 place = begin.position() + rotation(begin.heading) * way;
  return {place.x(), place.y(), begin.heading + turned};
}

std::vector<Fix> fixes_of(const TrueMotion& motion, const WheeledRobot& robot, std::uint64_t seed,
                          const ChannelGains& gains) {
  std::vector<Fix> fixes;
  if (!(robot.fix_rate > 0.0)) return fixes;
  Dice dice(seed, Stream::fixes);
  Pose begin = motion.start;
  double since = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < motion.rows.size(); ++k) {
    const TrueRow& row = motion.rows[k];
    const auto g = [&](Channel channel) { return gain(gains, channel, k); };
    for (;; ++count) {
      // In whole nanoseconds, as all times of a path.
      const double t = std::round(static_cast<double>(count) / robot.fix_rate * 1e9) / 1e9;
      if (t > row.t) break;
      const Pose pose = part_of_row(begin, row, t - since);
      const Vector2 antenna =
          pose.position() +
          rotation(pose.heading) * Vector2(g(Channel::antenna), g(Channel::antenna_left));
      const double dx = g(Channel::fix_x) + dice.deviation(robot.noise.fix);
      const double dy = g(Channel::fix_y) + dice.deviation(robot.noise.fix);
      const double stamp = std::round((t + g(Channel::fix_delay)) * 1e9) / 1e9;
      if (!fixes.empty() && stamp <= fixes.back().t) continue;
      fixes.push_back({stamp, antenna.x() + dx, antenna.y() + dy});
    }
    begin = row.pose;
    since = row.t;
  }
  return fixes;
}

/// A pose and the row it ends, of a loop.
struct ScanPose {
  double t = 0.0;  ///< s
  Pose pose;
  std::size_t row = 0;
};

/// Where the robot's scanner is seen from where it was.
Loop loop_between(const ScanPose& from, const ScanPose& to, const WheeledRobot& robot,
                  const ChannelGains& gains, Dice& dice) {
  const auto scanner_at = [&gains](const ScanPose& at) {
    const auto g = [&](Channel channel) { return gain(gains, channel, at.row); };
    return compose(at.pose,
                   {g(Channel::scanner), g(Channel::scanner_left), g(Channel::scanner_yaw)});
  };
  const Pose step = relative(scanner_at(from), scanner_at(to));
  const double dx = step.x + dice.deviation(robot.noise.loop);
  const double dy = step.y + dice.deviation(robot.noise.loop);
  const double turned = step.heading + dice.deviation(robot.noise.loop_heading);
  return {from.t, to.t, dx, dy, wrap_angle(turned)};
}

/// The pose at each stop from that at the last stop at the same landmark, and from scan to scan.
std::vector<Loop> loops_of(const TrueMotion& motion, const WheeledRobot& robot, std::uint64_t seed,
                           const ChannelGains& gains) {
  std::vector<Loop> loops;
  if (!robot.loops && !(robot.scan_every > 0.0)) return loops;
  Dice dice(seed, Stream::loops);
  std::map<int, ScanPose> last;
  for (const TrueStop& stop : motion.stops) {
    if (!robot.loops) break;
    const ScanPose here{stop.t, stop.pose, stop.rows == 0 ? 0 : stop.rows - 1};
    const auto [before, first] = last.try_emplace(stop.landmark, here);
    if (first) continue;
    loops.push_back(loop_between(before->second, here, robot, gains, dice));
    before->second = here;
  }
  ScanPose scan{0.0, motion.start, 0};
  for (std::size_t k = 0; k < motion.rows.size() && robot.scan_every > 0.0; ++k) {
    const ScanPose here{motion.rows[k].t, motion.rows[k].pose, k};
    if (here.t - scan.t < robot.scan_every) continue;
    loops.push_back(loop_between(scan, here, robot, gains, dice));
    scan = here;
  }
  return loops;
}

/// The places of its sensors as effects.
std::vector<Effect> effects_of(const Mountings& mounted) {
  std::vector<Effect> effects;
  const auto add = [&effects](Channel channel, double g) {
    if (g == 0.0) return;
    effects.push_back({std::string(name_of(channel)), channel, {"1"}, {g}});
  };
  if (const auto& at = mounted.sensor) {
    add(Channel::lever, at->x);
    add(Channel::lever_left, at->y);
    add(Channel::bearing, -at->yaw);
    add(Channel::sighting_yaw, -at->yaw);
  }
  if (const auto& at = mounted.antenna) {
    add(Channel::antenna, at->x);
    add(Channel::antenna_left, at->y);
  }
  if (const auto& at = mounted.scanner) {
    add(Channel::scanner, at->x);
    add(Channel::scanner_left, at->y);
    add(Channel::scanner_yaw, at->yaw);
  }
  return effects;
}

void check(const WheeledRobot& robot) {
  const SensorNoise& noise = robot.noise;
  for (const double sd :
       {noise.left, noise.right, noise.compass, noise.range, noise.bearing, noise.fix, noise.gyro,
        noise.gyro_walk, noise.loop, noise.loop_heading, noise.yaw, noise.steer}) {
    if (!std::isfinite(sd) || sd < 0.0) {
      throw std::invalid_argument("a sensor's noise must be a number of 0 or more");
    }
  }
  check_wheels(robot.geometry);
  if (!(robot.scan_every >= 0.0)) {
    throw std::invalid_argument("scans must be 0 s or more apart");
  }
  if (!(robot.fix_rate >= 0.0) || !(robot.fix_rate <= 1e3)) {
    throw std::invalid_argument("the rate of fixes must be 0 to 1000 Hz");
  }
  if (!(robot.reach > 0.0) || !(robot.recognition >= 0.0 && robot.recognition <= 1.0)) {
    throw std::invalid_argument("the range sensor must reach above 0 m and recognise 0 to 1");
  }
}

}  // namespace

}  // namespace trussmap

namespace trussmap::simulation {

Recording record(const TrueMotion& motion, const Mesh& mesh, const WheeledRobot& robot,
                 std::uint64_t seed, const ChannelGains& gains) {
  check(robot);
  Dice dice(seed, Stream::range);
  Recording recording;
  recording.name = "simulation";
  recording.drive = record_drive(motion, robot, seed, gains);
  for (const TrueStop& stop : motion.stops) {
    for (const Sighting& sighting : sight(stop, mesh, robot, gains, dice)) {
      if (sighting.t < 0.0 || sighting.t > motion.rows.back().t) {
        throw std::invalid_argument(
            fmt::format("a sighting would be stamped {:g} s, outside the drive (0 to {:g} s)",
                        sighting.t, motion.rows.back().t));
      }
      recording.sightings.push_back(sighting);
    }
  }
  recording.fixes = fixes_of(motion, robot, seed, gains);
  recording.loops = loops_of(motion, robot, seed, gains);
  if (gains.contains(Channel::delay)) {
    std::stable_sort(recording.sightings.begin(), recording.sightings.end(),
                     [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
  }
  return recording;
}

std::vector<SurveyPoint> survey(const Mesh& mesh, double sd, std::uint64_t seed) {
  if (!std::isfinite(sd) || sd < 0.0) {
    throw std::invalid_argument("the survey's noise must be a number of 0 or more");
  }
  Dice dice(seed, Stream::survey);
  std::vector<SurveyPoint> points;
  for (int k = 0; k < mesh.landmarks(); ++k) {
    const Vector2& position = mesh.positions[idx(k)];
    const double dx = dice.deviation(sd);
    const double dy = dice.deviation(sd);
    points.push_back({landmark_name(mesh, k), position.x() + dx, position.y() + dy});
  }
  return points;
}

}  // namespace trussmap::simulation

namespace trussmap {

namespace {

/// `points` are those of all landmarks, in order.
void survey_headings(double sd, std::uint64_t seed, std::vector<SurveyPoint>& points) {
  Dice dice(seed, Stream::headings);
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k].heading = wrap_angle(orientation_of(static_cast<int>(k)) + dice.deviation(sd));
  }
}

}  // namespace

}  // namespace trussmap

namespace trussmap::simulation {

std::vector<SurveyPoint> survey(const Mesh& mesh, const WheeledRobot& robot, std::uint64_t seed) {
  std::vector<SurveyPoint> points = survey(mesh, robot.noise.survey, seed);
  if (robot.markers) survey_headings(robot.noise.yaw, seed, points);
  return points;
}

}  // namespace trussmap::simulation

namespace trussmap {

SimulatedDrive simulate_drive(const Mesh& mesh, const std::vector<int>& walk,
                              const DrivingStyle& style, const WheeledRobot& robot,
                              std::uint64_t seed, const SimulatedEffects& effects) {
  DrivingStyle patient = style;
  double latest = 0.0;
  for (const Effect& effect : effects.effects) {
    if (effect.channel != Channel::delay) continue;
    for (const double coefficient : effect.coefficients) latest += std::abs(coefficient);
  }
  if (latest > 0.0) {
    patient.first_rest = std::max(style.first_rest, kPatience * (1.0 + latest));
    patient.last_rest = std::max(style.last_rest, kPatience * (1.0 + latest));
  }
  check(robot);
  for (const std::string& name : style.covariates) {
    const std::vector<std::string>& wheels = robot.geometry.columns;
    if (std::find(wheels.begin(), wheels.end(), name) == wheels.end()) continue;
    throw std::invalid_argument(
        fmt::format("a covariate's name is \"{}\", which is taken by a wheel", name));
  }
  std::vector<Effect> acting = effects_of(robot.geometry.mounted);
  acting.insert(acting.end(), effects.effects.begin(), effects.effects.end());
  MotionUnderEffects laid =
      lay_path_under(mesh, walk, patient, robot.geometry, acting, effects.rates, seed);
  SimulatedDrive drive;
  drive.recording = record(laid.motion, mesh, robot, seed, laid.gains);
  drive.recording.survey = survey(mesh, robot, seed);
  drive.motion = std::move(laid.motion);
  return drive;
}

}  // namespace trussmap
