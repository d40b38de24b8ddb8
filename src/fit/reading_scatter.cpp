// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/reading_scatter.hpp"

#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace trussmap {
namespace {

constexpr double kDiffuse = 1e4;  // rad^2
constexpr double kLeastVariance = 1e-12;

}  // namespace

ReadingScatter::ReadingScatter(const FitState& fit) {
  const Eigen::VectorXd offsets = offsets_of(fit);
  std::vector<std::vector<Habits>> habits;
  for (const Measurement& one : fit.problem.measurements) {
    if (one.kind != MeasurementKind::segment || one.rows < 4) continue;
    const std::vector<SegmentRow>& rows = fit.problem.segments[one.source];
    if (readings_of(rows) < 3) continue;
    const std::size_t session = idx(one.session);
    const Drive& drive = fit.recordings[session].drive;
    const auto patterns = drive_patterns(fit.columns.border, session);
    const double start =
        fit.adjustment.state.poses[idx(one.from - fit.problem.landmark_count())].heading;
    std::vector<Row> result;
    std::vector<Habits> own;
    double turned = 0.0;
    double first = kAbsent;
    for (const SegmentRow& row : rows) {
      const SegmentMotion motion = segment_motion({row}, patterns, offsets).motion;
      turned += motion.displacement.heading;
      const WheelTravel travel{row.part * drive.left[row.row], row.part * drive.right[row.row]};
      Row next;
      next.lag = row.duration;
      next.way = std::abs(row.path);
      next.wheels = arc_covariance(travel, row.duration, fit.model.robot, fit.model.noise)(2, 2);
      // The row's own mean heading is its reading less its turn.
      next.y = std::isnan(row.reading) ? kAbsent
                                       : motion.mean_heading + motion.displacement.heading - turned;
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
  free_of_habits(habits);
}

ReadingScatter::Habits ReadingScatter::habits_of(double heading, double turned) {
  Habits result;
  result << std::sin(heading), std::cos(heading), std::sin(2.0 * heading), std::cos(2.0 * heading),
      turned;
  return result;
}

void ReadingScatter::free_of_habits(const std::vector<std::vector<Habits>>& habits) {
  constexpr double kLeast = 1e-9;  // of the largest, lest a robot that never turns be singular
  using Square = Eigen::Matrix<double, kHabits, kHabits>;
  Square S = Square::Zero();
  Habits g = Habits::Zero();
  const auto each_step = [&](const auto& visit) {
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      std::size_t last = segments_[s].size();
      for (std::size_t k = 0; k < segments_[s].size(); ++k) {
        if (std::isnan(segments_[s][k].y)) continue;
        if (last < segments_[s].size()) visit(s, last, k);
        last = k;
      }
    }
  };
  each_step([&](std::size_t s, std::size_t a, std::size_t b) {
    const Habits x = habits[s][b] - habits[s][a];
    S += x * x.transpose();
    g += x * (segments_[s][b].y - segments_[s][a].y);
  });
  S.diagonal().array() += kLeast * std::max(S.diagonal().maxCoeff(), kLeast);
  const Habits size = S.ldlt().solve(g);
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    for (std::size_t k = 0; k < segments_[s].size(); ++k) {
      segments_[s][k].y -= size.dot(habits[s][k] - habits[s].front());
    }
  }
}

double ReadingScatter::minus_two_log(double white, double wheels,
                                     const std::vector<ReadingProcess>& processes) const {
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
  const auto count = static_cast<Eigen::Index>(std::min<std::size_t>(processes.size(), 3));
  double sum = 0.0;
  for (const std::vector<Row>& rows : segments_) {
    Column x = Column::Zero(count + 1);  // start heading less b, then the processes
    Square P = Square::Zero(count + 1, count + 1);
    P(0, 0) = kDiffuse;
    for (Eigen::Index p = 0; p < count; ++p) {
      const ReadingProcess& one = processes[static_cast<std::size_t>(p)];
      if (is_correlated(one.process)) P(p + 1, p + 1) = one.sd * one.sd;
    }
    bool first = true;
    double last = -1.0;  // rows mostly last equally long
    Column keeps = Column::Ones(count + 1);
    for (const Row& row : rows) {
      P(0, 0) += wheels * row.wheels;
      for (Eigen::Index p = 0; p < count; ++p) {
        const ReadingProcess& one = processes[static_cast<std::size_t>(p)];
        const bool by_way = one.process == ProcessKind::correlated_in_distance ||
                            one.process == ProcessKind::walk_in_distance;
        const double lag = by_way ? row.way : row.lag;
        if ((by_way || row.lag != last) && is_correlated(one.process)) {
          keeps[p + 1] = std::exp(-lag / one.length);
        }
        const double keep = keeps[p + 1];
        const double fresh = is_correlated(one.process) ? 1.0 - keep * keep : lag;
        x[p + 1] *= keep;
        P.row(p + 1) *= keep;
        P.col(p + 1) *= keep;
        P(p + 1, p + 1) += one.sd * one.sd * fresh;
      }
      last = row.lag;
      if (std::isnan(row.y)) continue;
      const Column gain = P.rowwise().sum();  // P H', H = (1, 1, ...)
      const double variance = gain.sum() + white * white + kLeastVariance;
      const double error = row.y - x.sum();
      if (!first) sum += std::log(variance) + error * error / variance;
      first = false;
      x += gain * (error / variance);
      P -= gain * gain.transpose() / variance;
    }
  }
  return sum;
}

}  // namespace trussmap
