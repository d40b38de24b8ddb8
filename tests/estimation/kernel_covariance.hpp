// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a lasting noise does to all that is measured, by brute force: its kernel, integrated
// numerically over every pair of rows. Shares no formula with the library's states.
#pragma once

#include "estimation/kinds/kinds.hpp"
#include "estimation/recording_problem.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>
#include <vector>

#include <boost/math/quadrature/gauss.hpp>

namespace trussmap::testing {

/// A row of the drive, or the part of it in a segment.
struct Piece {
  double from = 0.0;       ///< s
  double to = 0.0;         ///< s
  double path_from = 0.0;  ///< m driven since the recording's start
  double path_to = 0.0;    ///< m
  double left = 0.0;       ///< m
  double right = 0.0;      ///< m
  double reading = kAbsent;
};

inline std::vector<Piece> pieces_between(const MotionRows& drive, double from, double to) {
  std::vector<Piece> pieces;
  double driven = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double end = drive.t[row];
    const double begin = row == 0 ? 2.0 * drive.t[0] - drive.t[1] : drive.t[row - 1];
    const double path = std::abs(0.5 * (drive.pair.left[row] + drive.pair.right[row]));
    const double a = std::max(begin, from);
    const double b = std::min(end, to);
    if (a < b) {
      const double first = (a - begin) / (end - begin);
      const double last = (b - begin) / (end - begin);
      const double part = (b - a) / (end - begin);
      const bool reads = end <= to && !drive.heading.empty();
      pieces.push_back({a, b, driven + first * path, driven + last * path,
                        part * drive.pair.left[row], part * drive.pair.right[row],
                        reads ? drive.heading[row] : kAbsent});
    }
    driven += path;
  }
  return pieces;
}

/// The four numbers of a segment whose pieces have so much g of a channel, as channel.hpp words it.
inline estimation::Vector4 numbers_with(const std::vector<Piece>& pieces, Channel channel,
                                        const std::vector<double>& g, double wheelbase) {
  std::complex<double> place;
  double heading = 0.0;
  double first = 0.0;
  double sum = 0.0;
  int readings = 0;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Piece& one = pieces[k];
    double left = one.left;
    double right = one.right;
    if (channel == Channel::left) left *= 1.0 + g[k];
    if (channel == Channel::difference) {
      left *= 1.0 - 0.5 * g[k];
      right *= 1.0 + 0.5 * g[k];
    }
    double path = 0.5 * (left + right);
    double turn = (right - left) / wheelbase;
    if (channel == Channel::travel) path *= 1.0 + g[k];
    if (channel == Channel::turn) turn *= 1.0 + g[k];
    if (channel == Channel::drift) turn += g[k] * (one.to - one.from);
    const double half = 0.5 * turn;
    const double chord = std::abs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
    place += std::polar(1.0, heading + half) * (path * chord);
    heading += turn;
    if (std::isnan(one.reading)) continue;
    const double angle = one.reading - (channel == Channel::compass ? g[k] : 0.0) - heading;
    if (readings++ == 0) first = angle;
    sum += wrap_angle(angle - first);
  }
  return {place.real(), place.imag(), heading, readings == 0 ? 0.0 : first + sum / readings};
}

/// What one unit of g in each piece adds to the four numbers: differences of fourth order.
inline std::vector<estimation::Vector4> slopes_by_piece(const std::vector<Piece>& pieces,
                                                        Channel channel, double wheelbase) {
  constexpr double kStep = 5e-4;
  std::vector<estimation::Vector4> slopes;
  std::vector<double> g(pieces.size(), 0.0);
  const estimation::Vector4 plain = numbers_with(pieces, channel, g, wheelbase);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto at = [&](double value) {
      g[k] = value;
      estimation::Vector4 change = numbers_with(pieces, channel, g, wheelbase) - plain;
      g[k] = 0.0;
      change[3] = wrap_angle(change[3]);
      return change;
    };
    slopes.emplace_back((8.0 * (at(kStep) - at(-kStep)) - at(2.0 * kStep) + at(-2.0 * kStep)) /
                        (12.0 * kStep));
  }
  return slopes;
}

/// Where a process acts: a piece, a reading's or a view's instant, and what a unit of it adds.
struct Source {
  Eigen::Index row = 0;  ///< of the stacked measurements
  Eigen::VectorXd unit;
  int session = 0;
  double from = 0.0;  ///< s or m since the recording's start
  double to = 0.0;
  int group = 0;  ///< leg or pass
  int landmark = -1;
};

inline double kernel(ProcessKind process, double length, double a, double b) {
  const bool walks = process == ProcessKind::walk_in_t || process == ProcessKind::walk_in_distance;
  return walks ? std::min(a, b) : std::exp(-std::abs(a - b) / length);
}

/// Mean of the kernel over two stretches, which are the same or do not overlap.
inline double mean_kernel(ProcessKind process, double length, const Source& a, const Source& b) {
  using Gauss = boost::math::quadrature::gauss<double, 15>;
  const auto k = [&](double s, double t) { return kernel(process, length, s, t); };
  const double width_a = a.to - a.from;
  const double width_b = b.to - b.from;
  if (a.from == b.from && a.to == b.to && width_a > 0.0) {  // smooth on either side of s = t
    return 2.0 * Gauss::integrate(
                     [&](double u) {
                       return u * Gauss::integrate(
                                      [&](double v) {
                                        return k(a.from + width_a * u, a.from + width_a * u * v);
                                      },
                                      0.0, 1.0);
                     },
                     0.0, 1.0);
  }
  return Gauss::integrate(
      [&](double u) {
        return Gauss::integrate(
            [&](double v) { return k(a.from + width_a * u, b.from + width_b * v); }, 0.0, 1.0);
      },
      0.0, 1.0);
}

inline double covariance_of(ProcessKind process, double length, std::size_t i, std::size_t j,
                            const std::vector<Source>& sources) {
  const Source& a = sources[i];
  const Source& b = sources[j];
  if (process == ProcessKind::white) return i == j ? 1.0 : 0.0;
  if (a.session != b.session) return 0.0;
  if (process == ProcessKind::per_session) return 1.0;
  if (process == ProcessKind::per_leg) return a.group == b.group ? 1.0 : 0.0;
  if (process == ProcessKind::per_pass) {
    return a.group == b.group && a.landmark == b.landmark ? 1.0 : 0.0;
  }
  return mean_kernel(process, length, a, b);
}

/// Covariance of all measured values, one below the other, for sd = 1. Channels: travel, left,
/// difference, turn, drift, compass; range and bearing. Legs are those between landmarks that the
/// robot stands on.
inline Eigen::MatrixXd process_covariance(const estimation::RecordingProblem& problem,
                                          const std::vector<DrivenRecording>& recordings,
                                          const Model& model, const NoiseProcess& process) {
  const bool by_distance = process.process == ProcessKind::correlated_in_distance ||
                           process.process == ProcessKind::walk_in_distance;
  const bool of_views = process.channel == Channel::range || process.channel == Channel::bearing;
  std::vector<Source> sources;
  std::map<std::pair<int, int>, std::pair<double, int>> passes;
  Eigen::Index rows = 0;
  for (const estimation::Measurement& one : problem.measurements) {
    Source source;
    source.row = rows;
    source.session = one.session;
    rows += one.rows;
    if (one.session < 0 || of_views == (one.kind == &estimation::kinds::segment)) continue;
    const DrivenRecording& recording = recordings[idx(one.session)];
    const double start = 2.0 * recording.drive.t[0] - recording.drive.t[1];
    const double t = problem.poses[idx(one.from - problem.landmark_count())].t;
    const auto leg_of = [&recording](double at) {
      return static_cast<int>(
          std::count_if(recording.sightings.begin(), recording.sightings.end(),
                        [at](const Sighting& seen) { return seen.standing() && seen.t < at; }));
    };
    if (of_views) {
      if (one.kind != &estimation::kinds::view) continue;
      if (process.channel == Channel::bearing && one.rows < 2) continue;
      auto& [seen, pass] = passes.try_emplace({one.session, one.to}, t, 0).first->second;
      if (t - seen > 5.0) ++pass;
      seen = t;
      source.unit = Eigen::VectorXd::Unit(one.rows, process.channel == Channel::range ? 0 : 1);
      source.landmark = one.to;
      source.group = process.process == ProcessKind::per_leg ? leg_of(t) : pass;
      const std::vector<Piece> driven = pieces_between(recording.drive, start, t);
      const double path = driven.empty() ? 0.0 : driven.back().path_to;
      source.from = source.to = by_distance ? path : t - start;
      sources.push_back(source);
      continue;
    }
    const double end = problem.poses[idx(one.to - problem.landmark_count())].t;
    const std::vector<Piece> pieces = pieces_between(recording.drive, t, end);
    const std::vector<estimation::Vector4> slopes =
        slopes_by_piece(pieces, process.channel, model.robot.wheelbase);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      source.unit = slopes[k].head(one.rows);
      source.from = by_distance ? pieces[k].path_from : pieces[k].from - start;
      source.to = by_distance ? pieces[k].path_to : pieces[k].to - start;
      if (process.channel == Channel::compass) source.from = source.to;
      source.group = leg_of(0.5 * (pieces[k].from + pieces[k].to));
      if (!source.unit.isZero(0.0)) sources.push_back(source);
    }
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, rows);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Source& a = sources[i];
      const Source& b = sources[j];
      const double size = covariance_of(process.process, process.length, i, j, sources);
      if (size == 0.0) continue;
      const Eigen::MatrixXd block = size * a.unit * b.unit.transpose();
      result.block(a.row, b.row, block.rows(), block.cols()) += block;
      if (i != j) result.block(b.row, a.row, block.cols(), block.rows()) += block.transpose();
    }
  }
  return result;
}

}  // namespace trussmap::testing
