// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings made backwards: the true path is laid down first, and what wheels, compass and sensors
// record of it is found by inverting the definitions of the channels. Nothing here uses the
// library's motion, effects or variables.
//
//   rest, turn on the spot, one arc to the next landmark, rest, ...     every rate is constant
//                                                                       within one kind of motion,
//   so the library's smoothing over a second leaves speeds and turn rates as they are.
//
// With creep g the body moves by ds (1, g): the course differs from the heading by atan g.
#pragma once

#include "driven.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace trussmap::testing {

inline constexpr double kInvertedWheelbase = 0.34;  // m
inline constexpr double kInvertedRow = 0.1;         // s

/// A row as recorded, and what else is known of it.
struct RecordedRow {
  double left = 0.0;
  double right = 0.0;
  double t = 0.0;         ///< s, its middle
  double heading = 0.0;   ///< rad, true, its middle
  double distance = 0.0;  ///< m recorded before it
  double payload = 0.0;
  bool starts = false;
  bool spins = false;

  [[nodiscard]] double ds() const { return 0.5 * (left + right); }
  [[nodiscard]] double dtheta() const { return (right - left) / kInvertedWheelbase; }
  [[nodiscard]] double speed() const { return ds() / kInvertedRow; }
  [[nodiscard]] double turn_rate() const { return dtheta() / kInvertedRow; }
};

struct Travelled {
  double ds = 0.0;
  double dtheta = 0.0;
};

/// What disturbs the robot.
struct Disturbance {
  /// True motion of a row in terms of what was recorded.
  std::function<Travelled(const RecordedRow&)> motion = [](const RecordedRow& row) {
    return Travelled{row.ds(), row.dtheta()};
  };
  std::function<double(double heading)> creep = [](double) { return 0.0; };
  std::function<double(double heading, double turn_rate)> compass = [](double, double) {
    return 0.0;
  };
  double lever = 0.0;  // m
  double lever_left = 0.0;
  double range = 0.0;  // m
  double range_scale = 0.0;
  double bearing = 0.0;  // rad
  double delay = 0.0;    // s
};

struct InvertedOptions {
  int rounds = 4;  ///< each landmark is visited once in a round
  bool straight = false;
  bool compass = true;
  bool survey = true;
  bool views = false;       ///< range and bearing of three others at every stop
  bool on_the_way = false;  ///< and of one in the middle of every leg
  bool noisy = false;       ///< by the default Noise
};

struct InvertedRecording {
  DrivenRecording recording;
  std::map<std::string, std::complex<double>> landmarks;
  std::vector<std::complex<double>> places;  ///< true, of the axle, at the end of each row
  std::vector<double> headings;
};

class Inverter {
 public:
  using Point = std::complex<double>;

  Inverter(const Disturbance& disturbance, const InvertedOptions& options, std::uint64_t seed)
      : disturbance_(disturbance), options_(options), random_(seed), noise_(seed + 1000003) {}

  InvertedRecording run() {
    const std::vector<Point> grid = {{0.0, 0.0}, {1.7, 0.3},  {3.9, -0.2}, {0.4, 1.9}, {2.2, 2.1},
                                     {4.1, 1.6}, {-0.3, 3.8}, {1.8, 4.2},  {3.6, 3.7}, {5.5, 2.9}};
    for (std::size_t k = 0; k < grid.size(); ++k) {
      result_.landmarks["P" + std::to_string(k)] = grid[k];
    }
    DrivenRecording& recording = result_.recording;
    recording.name = "inverted";
    recording.drive.covariates.push_back({"payload_kg", {}});
    int at = 0;
    place_ = grid[0] + off() - turned(lever(), heading_);
    sight_standing(at, grid[0]);
    rest(3);
    for (const int next : walk(grid.size())) {
      if (next == at) continue;
      payload_ = 5.0 * std::floor(uniform(0.0, 5.0));
      drive_to(grid[static_cast<std::size_t>(next)]);
      at = next;
      sight_standing(at, grid[static_cast<std::size_t>(at)]);
      if (options_.views) {
        for (int k = 1; k <= 3; ++k) sight(time_, place_, heading_, (at + 3 * k) % 10);
      }
      if (uniform(0.0, 1.0) < 0.4) rest(5);
    }
    rest(20);  // what is stamped late stays within the drive
    if (!options_.compass) recording.drive.heading.clear();
    if (options_.survey) {
      for (const auto& [name, point] : result_.landmarks) {
        recording.survey.push_back(
            {name, point.real() + noise(0.001), point.imag() + noise(0.001), kAbsent});
      }
    }
    return std::move(result_);
  }

 private:
  static Point turned(Point p, double angle) { return p * std::polar(1.0, angle); }
  [[nodiscard]] Point lever() const { return {disturbance_.lever, disturbance_.lever_left}; }
  double uniform(double a, double b) {
    return a + (b - a) * static_cast<double>(random_() >> 11) / 9007199254740992.0;
  }
  double noise(double sd) { return options_.noisy ? sd * normal_(noise_) : 0.0; }
  /// Where the robot truly stands, less the landmark.
  Point off() {
    const double ahead = noise(0.005);
    return {ahead, noise(0.005)};
  }

  std::vector<int> walk(std::size_t count) {
    std::vector<int> order(count);
    for (std::size_t k = 0; k < count; ++k) order[k] = static_cast<int>(k);
    std::vector<int> result;
    for (int round = 0; round < options_.rounds; ++round) {
      for (std::size_t k = count; k-- > 1;) {
        std::swap(order[k], order[static_cast<std::size_t>(random_() % (k + 1))]);
      }
      result.insert(result.end(), order.begin(), order.end());
    }
    return result;
  }

  /// Body displacement in the frame of the row's start.
  static Point arc(Point step, double turn) {
    if (std::abs(turn) < 1e-7) return step * Point(1.0 - turn * turn / 6.0, 0.5 * turn);
    return step * (std::polar(1.0, turn) - 1.0) / Point(0.0, turn);
  }

  void drive_to(Point landmark) {
    const Point goal_point = landmark + off();
    const double bend = options_.straight ? 0.0 : uniform(-0.6, 0.6);
    const bool back = uniform(0.0, 1.0) < 0.25;
    double start = 0.0;
    double g = 0.0;
    Point chord;
    for (int round = 0; round < 200; ++round) {
      chord = goal_point - turned(lever(), start + bend) - place_;
      start = std::arg(chord) - 0.5 * bend - std::atan(g) - (back ? M_PI : 0.0);
      g = disturbance_.creep(start);
    }
    spin_to(start);
    const double half = 0.5 * bend;
    const double length = std::abs(chord) * (bend == 0.0 ? 1.0 : half / std::sin(half));
    const int rows = static_cast<int>(std::ceil(length / kInvertedRow / uniform(0.25, 0.9)));
    const double ds = (back ? -length : length) / std::sqrt(1.0 + g * g) / rows;
    for (int k = 0; k < rows; ++k) {
      if (options_.on_the_way && k == rows / 2) {
        const double share = 0.37;
        const Point there =
            place_ + turned(arc(share * ds * Point(1.0, g), share * bend / rows), heading_);
        sight(time_ + share * kInvertedRow, there, heading_ + share * bend / rows,
              static_cast<int>(random_() % 10));
      }
      add_row(ds, g, bend / rows, k == 0, false);
    }
  }

  void spin_to(double heading) {
    double angle = std::remainder(heading - heading_, 2.0 * M_PI);
    if (std::abs(angle) < 0.4) angle += angle < 0.0 ? -2.0 * M_PI : 2.0 * M_PI;
    const int rows =
        static_cast<int>(std::ceil(std::abs(angle) / kInvertedRow / uniform(0.4, 1.1)));
    for (int k = 0; k < rows; ++k) add_row(0.0, 0.0, angle / rows, false, k == 0);
  }

  void rest(int rows) {
    for (int k = 0; k < rows; ++k) add_row(0.0, 0.0, 0.0, false, false);
  }

  void add_row(double ds, double g, double dtheta, bool starts, bool spins) {
    RecordedRow row;
    row.t = time_ + 0.5 * kInvertedRow;
    row.heading = heading_ + 0.5 * dtheta;
    row.payload = payload_;
    row.starts = starts;
    row.spins = spins;
    Travelled sought{ds, dtheta};
    for (int round = 0; round < 100; ++round) {
      row.left = sought.ds - 0.5 * kInvertedWheelbase * sought.dtheta;
      row.right = sought.ds + 0.5 * kInvertedWheelbase * sought.dtheta;
      row.distance = distance_ + 0.5 * std::abs(row.ds());
      const Travelled found = disturbance_.motion(row);
      sought.ds += ds - found.ds;
      sought.dtheta += dtheta - found.dtheta;
    }
    distance_ += std::abs(row.ds());
    time_ = kInvertedRow * static_cast<double>(++rows_);
    place_ += turned(arc(ds * Point(1.0, g), dtheta), heading_);
    heading_ += dtheta;
    MotionRows& drive = result_.recording.drive;
    drive.t.push_back(time_);
    const double left = row.left + noise(0.003 * std::sqrt(std::abs(row.left)));
    const double right = row.right + noise(0.003 * std::sqrt(std::abs(row.right)));
    add_travels(drive, left, right, kInvertedWheelbase);
    const double reading = heading_ + disturbance_.compass(heading_, row.turn_rate()) + noise(0.02);
    drive.heading.push_back(std::remainder(reading, 2.0 * M_PI));
    drive.covariates[0].values.push_back(payload_);
    result_.places.push_back(place_);
    result_.headings.push_back(heading_);
  }

  void sight_standing(int landmark, Point) {
    result_.recording.sightings.push_back(
        {time_ + disturbance_.delay, "P" + std::to_string(landmark), kAbsent, kAbsent});
  }

  void sight(double t, Point place, double heading, int landmark) {
    const std::string name = "P" + std::to_string(landmark);
    const Point seen =
        turned(result_.landmarks.at(name) - place - turned(lever(), heading), -heading);
    if (std::abs(seen) < 0.5) return;
    const double range =
        std::abs(seen) * (1.0 + disturbance_.range_scale) + disturbance_.range + noise(0.05);
    const double bearing = std::arg(seen) + disturbance_.bearing + noise(0.02);
    result_.recording.sightings.push_back(
        {t + disturbance_.delay, name, range, std::remainder(bearing, 2.0 * M_PI)});
  }

  const Disturbance& disturbance_;
  InvertedOptions options_;
  std::mt19937_64 random_;
  std::mt19937_64 noise_;
  std::normal_distribution<double> normal_;
  InvertedRecording result_;
  Point place_;
  double heading_ = 0.0;
  double time_ = 0.0;
  double distance_ = 0.0;
  double payload_ = 0.0;
  int rows_ = 0;
};

inline InvertedRecording invert(const Disturbance& disturbance, const InvertedOptions& options,
                                std::uint64_t seed) {
  return Inverter(disturbance, options, seed).run();
}

inline Model inverted_model(std::vector<Effect> effects = {}) {
  Model model;
  model.robot.wheelbase = kInvertedWheelbase;
  model.effects = std::move(effects);
  return model;
}

}  // namespace trussmap::testing
