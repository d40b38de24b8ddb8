// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/reading_scatter.hpp"

#include "effects/channel_physics.hpp"
#include "estimation/noise_states.hpp"
#include "odometry/wheels_and_gyro.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace trussmap::fitting {
namespace {

constexpr double kDiffuse = 1e4;  // rad^2
constexpr double kLeastVariance = 1e-12;

}  // namespace

bool shows_in_readings(const NoiseProcess& process) {
  if (process.process == ProcessKind::white) return false;
  if (process.channel == Channel::compass) return is_chain(process.process);
  const drive::RowMotion some = drive::row_motion(BodyMotion{0.75, 0.0, 1.0}, 1.0, Robot());
  return effects::acts_on(process.channel) == effects::ActsOn::drives &&
         effects::drive_pattern(process.channel, 1.0, some).turn != 0.0;
}

ReadingScatter::ReadingScatter(const FitState& fit) {
  const std::vector<std::vector<effects::DrivePattern>> effects =
      estimation::summed_patterns(fit.columns.border, offsets_of(fit), fit.recordings.size());
  Noise wheels_alone;
  wheels_alone.left = fit.model.noise.left;
  wheels_alone.right = fit.model.noise.right;
  std::vector<std::vector<Habits>> habits;
  for (const estimation::Measurement& one : fit.problem.measurements) {
    if (!estimation::reads_compass(one)) continue;
    const std::vector<estimation::SegmentRow>& rows = fit.problem.segments[one.source];
    if (estimation::readings_of(rows) < 3) continue;
    const std::size_t session = idx(one.session);
    const MotionRows& drive = fit.recordings[session].drive;
    if (!drive.gyro.empty() || !drive.wheels.empty()) continue;  // turns are not the wheels' alone
    const double start =
        fit.adjustment.state.poses[idx(one.from - fit.problem.landmark_count())].heading;
    std::vector<Row> result;
    std::vector<Habits> own;
    double turned = 0.0;
    double first = kAbsent;
    for (const estimation::SegmentRow& row : rows) {
      const estimation::SegmentRow moved = estimation::with_effects(row, effects[session]);
      turned += moved.turn;
      const Robot& robot = fit.model.robot;
      Row next;
      next.motion = drive::row_motion(row.part * drive.motion(row.row), row.duration, robot);
      next.way = std::abs(row.path);
      next.turn = std::abs(row.turn);
      next.wheels =
          odometry::wheels_noise(drive, row.row, row.part, row.duration, robot, wheels_alone)
              .heading;
      next.y = moved.reading - turned;  // of a row without one NaN
      if (!std::isnan(next.y)) {
        if (std::isnan(first)) first = next.y;
        next.y = wrap_angle(next.y - first);
      }
      result.push_back(next);
      own.push_back(habits_of(start + turned, turned));
    }
    segments_.push_back(std::move(result));
    habits.push_back(std::move(own));
  }
  free_of_habits(habits, fit.model.noise);
}

ReadingScatter::Habits ReadingScatter::habits_of(double heading, double turned) {
  Habits result;
  result << std::sin(heading), std::cos(heading), std::sin(2.0 * heading), std::cos(2.0 * heading),
      turned;
  return result;
}

void ReadingScatter::free_of_habits(const std::vector<std::vector<Habits>>& habits,
                                    const Noise& believed) {
  constexpr double kFarBeyondNoise = 100.0;  // of its variance: else habits are made of noise
  constexpr double kLeast = 1e-9;            // of the largest
  using Square = Eigen::Matrix<double, kHabits, kHabits>;
  const TurnLaws laws = {1.0, believed.heading_per_s, believed.heading_per_rad};
  Square S = Square::Zero();
  Habits g = Habits::Zero();
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    std::vector<std::size_t> read;
    double noise = 0.0;
    for (std::size_t k = 0; k < segments_[s].size(); ++k) {
      noise += segments_[s][k].turn_variance(laws);
      if (!std::isnan(segments_[s][k].y)) read.push_back(k);
    }
    const auto count = static_cast<double>(read.size());
    Habits middle = Habits::Zero();
    double mean = 0.0;
    for (const std::size_t k : read) {
      middle += habits[s][k] / count;
      mean += segments_[s][k].y / count;
    }
    Square own = Square::Zero();
    Habits seen = Habits::Zero();
    for (const std::size_t k : read) {
      const Habits x = habits[s][k] - middle;
      own += x * x.transpose();
      seen += x * (segments_[s][k].y - mean);
    }
    constexpr int kTurned = kHabits - 1;
    if (own(kTurned, kTurned) < kFarBeyondNoise * count * noise) continue;
    S += own;
    g += seen;
  }
  S.diagonal().array() += kLeast * std::max(S.diagonal().maxCoeff(), kLeast);
  const Habits size = S.ldlt().solve(g);
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    for (std::size_t k = 0; k < segments_[s].size(); ++k) {
      segments_[s][k].y -= size.dot(habits[s][k] - habits[s].front());
    }
  }
}

double ReadingScatter::minus_two_log(const ReadingNoise& noise) const {
  ReadingNoise matter = noise;
  std::erase_if(matter.processes, [](const NoiseProcess& one) { return !shows_in_readings(one); });
  switch (matter.processes.size()) {
    case 0:
      return filtered<0>(matter);
    case 1:
      return filtered<1>(matter);
    case 2:
      return filtered<2>(matter);
    case 3:
      return filtered<3>(matter);
    default:
      return filtered<4>(matter);
  }
}

/// Of a segment: start heading less b, then the processes.
template <int Count>
struct ReadingScatter::Filter {
  using Square = Eigen::Matrix<double, Count + 1, Count + 1>;
  using Column = Eigen::Matrix<double, Count + 1, 1>;
  struct Innovation {
    double error = 0.0;     ///< rad
    double variance = 0.0;  ///< rad^2
  };

  const ReadingNoise& noise;
  Column x = Column::Zero();
  Square P = Square::Zero();
  Column seen = Column::Ones();  ///< (1, then 1 for the compass's)
  Column keeps = Column::Ones();
  double last = -1.0;  ///< s; rows mostly last equally long

  explicit Filter(const ReadingNoise& by) : noise(by) {
    P(0, 0) = kDiffuse;
    for (int p = 0; p < Count; ++p) {
      const NoiseProcess& one = noise.processes[idx(p)];
      if (!estimation::is_walk(one.process)) P(p + 1, p + 1) = one.sd * one.sd;
      if (effects::acts_on(one.channel) == effects::ActsOn::drives) seen[p + 1] = 0.0;
    }
  }

  void drive(const Row& row) {
    P(0, 0) += row.turn_variance({noise.wheels, noise.heading_per_s, noise.heading_per_rad});
    for (int p = 0; p < Count; ++p) {
      const NoiseProcess& one = noise.processes[idx(p)];
      const int at = p + 1;
      const bool by_way = estimation::goes_with_distance(one.process);
      const double lag = by_way ? row.way : row.motion.duration;
      if (is_correlated(one.process) && (by_way || lag != last)) {
        keeps[at] = std::exp(-lag / one.length);
      }
      const double keep = keeps[at];
      if (seen[at] == 0.0) {
        const double turn =
            effects::drive_pattern(one.channel, 0.5 * (1.0 + keep), row.motion).turn;
        x[0] += turn * x[at];
        P.row(0) += turn * P.row(at);
        P.col(0) += turn * P.col(at);
      }
      if (!is_chain(one.process)) continue;
      x[at] *= keep;
      P.row(at) *= keep;
      P.col(at) *= keep;
      P(at, at) += one.sd * one.sd * (is_correlated(one.process) ? 1.0 - keep * keep : lag);
    }
    last = row.motion.duration;
  }

  Innovation take(double y) {
    const double white = noise.white * noise.white + kLeastVariance;
    const Column gain = P * seen;
    const double variance = seen.dot(gain) + white;
    const double error = y - seen.dot(x);
    x += gain * (error / variance);
    P -= gain * gain.transpose() / variance;
    return {error, variance};
  }
};

template <int Count>
double ReadingScatter::filtered(const ReadingNoise& noise) const {
  constexpr double kLargest = 1e100;
  double sum = 0.0;
  double product = 1.0;  // of variances: one logarithm for many
  for (const std::vector<Row>& rows : segments_) {
    Filter<Count> filter(noise);
    bool first = true;
    for (const Row& row : rows) {
      filter.drive(row);
      if (std::isnan(row.y)) continue;
      const auto [error, variance] = filter.take(row.y);
      if (!first) {
        product *= variance;
        sum += error * error / variance;
        if (product < 1.0 / kLargest || product > kLargest) {
          sum += std::log(product);
          product = 1.0;
        }
      }
      first = false;
    }
  }
  return sum + std::log(product);
}

}  // namespace trussmap::fitting
