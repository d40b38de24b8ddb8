// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/noise_states.hpp"

#include "drive/body_motion.hpp"
#include "drive/row_motion.hpp"
#include "drive/row_variables.hpp"
#include "effects/channel_physics.hpp"
#include "estimation/student_tails.hpp"
#include "recording/legs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace trussmap {
namespace {

constexpr double kLeastRest = 0.5;       // s: a shorter rest ends no leg
constexpr double kLeastVariance = 1e-8;  // of a step of a unit process

/// What a unit process does over a lag, given where it was: z' = keep z + eta, and its mean over
/// the lag, mean_keep z + nu.
struct Lag {
  double keep = 1.0;
  double mean_keep = 1.0;
  double end = 0.0;   ///< var eta
  double both = 0.0;  ///< cov(eta, nu)
  double mean = 0.0;  ///< var nu
};

Lag correlated(double x) {
  if (x <= 0.0) return {};
  constexpr double kShort = 1e-2;
  const double lost = -std::expm1(-x);
  // Of a short lag all digits would cancel: a series, to 1e-11.
  const double mean =
      x < kShort
          ? x * (2.0 / 3.0 - x * (0.5 - x * (7.0 / 30.0 - x * (1.0 / 12.0 - x * 31.0 / 1260.0))))
          : (2.0 * (x - lost) - lost * lost) / (x * x);
  return {1.0 - lost, lost / x, -std::expm1(-2.0 * x), lost * lost / x, mean};
}

Lag walked(double lag) {
  return {1.0, 1.0, lag, 0.5 * lag, lag / 3.0};
}

Lag lag_of(ProcessKind process, double lag, double length) {
  lag = std::max(lag, 0.0);
  return is_correlated(process) ? correlated(lag / length) : walked(lag);
}

}  // namespace

bool goes_with_distance(ProcessKind process) {
  return process == ProcessKind::correlated_in_distance || process == ProcessKind::walk_in_distance;
}

bool is_walk(ProcessKind process) {
  return is_chain(process) && !is_correlated(process);
}

std::vector<double> ends_of_legs(const Recording& recording) {
  std::vector<double> ends;
  for (const Sighting& sighting : recording.sightings) {
    if (sighting.standing()) ends.push_back(sighting.t);
  }
  if (!ends.empty()) return ends;
  const Drive& drive = recording.drive;
  double rested = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const bool rests = drive.rests(row);
    rested = rests ? rested + drive.duration(row) : 0.0;
    const bool last = rests && row + 1 < drive.rows() && !drive.rests(row + 1);
    if (last && rested >= kLeastRest) ends.push_back(drive.t[row]);
  }
  return ends;
}

int leg_at(const std::vector<double>& ends, double t) {
  return static_cast<int>(std::lower_bound(ends.begin(), ends.end(), t) - ends.begin());
}

std::map<int, Vector4> sums_by_leg(const std::vector<SegmentRow>& rows,
                                   const std::vector<Vector4>& c, double from,
                                   const std::vector<double>& ends) {
  std::map<int, Vector4> sums;
  double t = from;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double middle = t + 0.5 * rows[row].duration;
    t += rows[row].duration;
    sums.try_emplace(leg_at(ends, middle), Vector4::Zero()).first->second += c[row];
  }
  return sums;
}

std::vector<Vector4> unit_columns(const Drive& drive, const std::vector<SegmentRow>& rows,
                                  const std::vector<Matrix4>& influences, Channel channel,
                                  const Robot& robot) {
  const bool reads = acts_on(channel) == ActsOn::readings;
  std::vector<Vector4> c(rows.size(), Vector4::Zero());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (reads && std::isnan(rows[row].reading)) continue;
    const std::size_t at = rows[row].row;
    const DrivePattern unit = drive_pattern(channel, 1.0, row_motion(drive, at, robot));
    c[row] = influences[row] * Vector4(unit.advance, unit.slip, unit.turn, unit.compass);
  }
  return c;
}

std::vector<Vector4> unit_excesses(const Drive& drive, const std::vector<SegmentRow>& rows,
                                   const std::vector<Vector4>& weights, Channel channel,
                                   const Robot& robot) {
  std::vector<Vector4> c(rows.size(), Vector4::Zero());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::size_t at = rows[row].row;
    const DrivePattern unit = drive_pattern(channel, 1.0, row_motion(drive, at, robot));
    c[row] = rows[row].part * unit.excess * weights[row];
  }
  return c;
}

ProcessMoments process_moments(const std::vector<SegmentRow>& rows, const std::vector<Vector4>& c,
                               ProcessKind process, double length, bool at_ends) {
  constexpr double kSame = 1e-12;  // of a lag: rows mostly last equally long, but for rounding
  ProcessMoments at;
  double last = -1.0;
  Lag lag;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double elapsed =
        goes_with_distance(process) ? std::abs(rows[row].path) : rows[row].duration;
    if (!(std::abs(elapsed - last) <= kSame * elapsed)) {
      lag = lag_of(process, elapsed, length);
      last = elapsed;
    }
    const Vector4& own = c[row];
    if (!at_ends) {
      at.by_start += lag.mean_keep * at.keep * own;
      at.uu += lag.mean_keep * (at.uw * own.transpose() + own * at.uw.transpose()) +
               (lag.mean_keep * lag.mean_keep * at.ww + lag.mean) * own * own.transpose();
      at.uw = (lag.keep * (at.uw + lag.mean_keep * at.ww * own) + lag.both * own).eval();
    } else {
      at.uw *= lag.keep;
    }
    at.ww = lag.keep * lag.keep * at.ww + lag.end;
    at.keep *= lag.keep;
    if (at_ends) {
      at.by_start += at.keep * own;
      at.uu += at.uw * own.transpose() + own * at.uw.transpose() + at.ww * own * own.transpose();
      at.uw += at.ww * own;
    }
  }
  return at;
}

/// Lays one process.
class ProcessLayout {
 public:
  ProcessLayout(const ProcessLayer& layer, Channel channel, ProcessKind process, double length)
      : layer_(layer),
        problem_(layer.problem_),
        channel_(channel),
        process_(process),
        length_(length) {
    laid_.terms.resize(problem_.measurements.size());
    laid_.within.assign(problem_.measurements.size(), Matrix4::Zero());
  }

  LaidProcess take() {
    if (is_chain(process_)) lay_instants();
    for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
      const Measurement& one = problem_.measurements[k];
      if (is_driven(one.kind)) {
        if (acts_on(channel_) != ActsOn::views) lay_segment(k, one);
      } else if (sees(one) && process_ == ProcessKind::white && is_reading()) {
        laid_.within[k] = white_reading(one);
      } else if (sees(one)) {
        const int state = state_of_view(one);
        laid_.terms[k].push_back({state, unit_view(one)});
      }
    }
    return std::move(laid_);
  }

 private:
  [[nodiscard]] const Recording& recording(int session) const {
    return layer_.recordings_[idx(session)];
  }
  [[nodiscard]] const PoseNode& pose(int node) const {
    return problem_.poses[idx(node - problem_.landmark_count())];
  }

  /// A white reading needs no state: its variance is the reading's own.
  [[nodiscard]] bool is_reading() const {
    return channel_ == Channel::range || channel_ == Channel::range_scale ||
           channel_ == Channel::bearing || channel_ == Channel::fix_x ||
           channel_ == Channel::fix_y || channel_ == Channel::sighting_yaw;
  }
  [[nodiscard]] Matrix4 white_reading(const Measurement& one) const {
    Matrix4 variance = Matrix4::Zero();
    if (one.kind == MeasurementKind::fix) {
      const Eigen::Index axis = channel_ == Channel::fix_x ? 0 : 1;
      variance(axis, axis) = 1.0;
    } else if (one.kind == MeasurementKind::cartesian_view) {
      const double size = channel_ == Channel::range ? 1.0 : one.value.head<2>().norm();
      variance(0, 0) = variance(1, 1) = size * size;
    } else if (one.kind == MeasurementKind::sighting_yaw) {
      variance(0, 0) = 1.0;
    } else if (channel_ == Channel::bearing) {
      const int row = one.kind == MeasurementKind::direction ? 0 : 1;
      variance(row, row) = 1.0;
    } else {
      variance(0, 0) = channel_ == Channel::range ? 1.0 : one.value[0] * one.value[0];
    }
    return variance;
  }

  /// Whether the channel acts on the view.
  [[nodiscard]] bool sees(const Measurement& one) const {
    if (acts_on(channel_) != ActsOn::views || one.session < 0) return false;
    if (one.kind == MeasurementKind::loop) return false;
    if (one.kind == MeasurementKind::fix || acts_on_fixes(channel_)) {
      return one.kind == MeasurementKind::fix && acts_on_fixes(channel_);
    }
    const bool yaw = one.kind == MeasurementKind::sighting_yaw;
    if (yaw || channel_ == Channel::sighting_yaw) {
      return yaw && (channel_ == Channel::sighting_yaw || channel_ == Channel::delay);
    }
    if (channel_ == Channel::range || channel_ == Channel::range_scale) {
      return one.kind == MeasurementKind::view || one.kind == MeasurementKind::cartesian_view;
    }
    if (channel_ == Channel::bearing) {
      return one.kind == MeasurementKind::direction ||
             (one.kind == MeasurementKind::view && one.rows == 2);
    }
    if (channel_ == Channel::truth_heading) return one.kind == MeasurementKind::truth;
    return !is_driven(one.kind);
  }

  [[nodiscard]] ViewVector unit_view(const Measurement& one) const {
    const Drive& drive = recording(one.session).drive;
    const std::size_t row = row_at(drive, pose(one.from).t);
    const double duration = std::max(drive.duration(row), 1e-9);
    const BodyMotion motion = body_motion(drive, row, layer_.robot_);
    ViewVector unit =
        view_pattern(channel_, 1.0, motion.forward / duration, motion.turn / duration).vector();
    if (one.kind != MeasurementKind::cartesian_view) return unit;
    // Of a near landmark the offset is measured: its error lies along the sight.
    const Vector2 away = -one.value.head<2>().normalized();
    const double size = channel_ == Channel::range         ? 1.0
                        : channel_ == Channel::range_scale ? one.value.head<2>().norm()
                                                           : 0.0;
    if (size > 0.0) {
      unit.setZero();
      unit.head<2>() = size * away;
    }
    return unit;
  }

  // ----------------------------------------
  // Chains: a state per instant.

  void lay_instants() {
    state_at_.assign(problem_.poses.size(), -1);
    std::vector<bool> wanted(problem_.poses.size(), acts_on(channel_) != ActsOn::views);
    for (const Measurement& one : problem_.measurements) {
      if (sees(one)) wanted[idx(one.from - problem_.landmark_count())] = true;
    }
    int last = -1;
    double elapsed = 0.0;  // from the session's start to the last
    std::vector<double> driven;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      if (!wanted[k]) continue;
      const PoseNode& node = problem_.poses[k];
      const Recording& session = recording(node.session);
      const bool first = last < 0 || problem_.poses[idx(last)].session != node.session;
      double at = node.t - session.drive.start();
      if (goes_with_distance(process_)) {
        if (first) driven = driven_path(session.drive);
        at = path_at(session.drive, driven, node.t);
      }
      state_at_[k] = static_cast<int>(laid_.states.size());
      if (first && is_correlated(process_)) {
        laid_.states.push_back({});
      } else {
        const Lag lag = over(first ? at : at - elapsed);
        laid_.states.push_back({0, first ? -1 : state_at_[idx(last)], first ? 0.0 : lag.keep,
                                std::sqrt(std::max(lag.end, kLeastVariance))});
      }
      last = static_cast<int>(k);
      elapsed = at;
    }
  }

  /// s or m.
  [[nodiscard]] Lag over(double lag) const { return lag_of(process_, lag, length_); }

  // ----------------------------------------
  // States that stay as long as a leg, a session or a pass.

  [[nodiscard]] int group(int session, int part, int landmark) {
    const auto [at, fresh] =
        groups_.try_emplace({session, part, landmark}, static_cast<int>(laid_.states.size()));
    if (fresh) laid_.states.push_back({});
    return at->second;
  }

  [[nodiscard]] const std::vector<double>& ends_in(int session) {
    auto at = legs_.find(session);
    if (at == legs_.end()) at = legs_.emplace(session, ends_of_legs(recording(session))).first;
    return at->second;
  }

  [[nodiscard]] int state_of_view(const Measurement& one) {
    if (is_chain(process_)) return state_at_[idx(one.from - problem_.landmark_count())];
    const double t = pose(one.from).t;
    switch (process_) {
      case ProcessKind::per_leg:
        return group(one.session, leg_at(ends_in(one.session), t), -1);
      case ProcessKind::per_session:
        return group(one.session, 0, -1);
      case ProcessKind::per_pass: {
        auto& [seen, pass] = passes_.try_emplace({one.session, one.to}, t, 0).first->second;
        if (t - seen > kLongestGap) ++pass;
        seen = t;
        return group(one.session, pass, one.to);
      }
      default:  // white: one each
        laid_.states.push_back({});
        return static_cast<int>(laid_.states.size()) - 1;
    }
  }

  // ----------------------------------------

  void lay_segment(std::size_t k, const Measurement& one) {
    const std::vector<SegmentRow>& rows = problem_.segments[one.source];
    const std::vector<Matrix4>& influences = layer_.influences_[one.source];
    const Drive& drive = recording(one.session).drive;
    const bool reads = acts_on(channel_) == ActsOn::readings;
    std::vector<Vector4> c =
        one.kind == MeasurementKind::gyro
            ? unit_excesses(drive, rows, problem_.gyro_weights[one.source], channel_, layer_.robot_)
            : unit_columns(drive, rows, influences, channel_, layer_.robot_);
    Vector4 sum = Vector4::Zero();
    for (Vector4& row : c) {
      if (one.rows < 4) row[3] = 0.0;
      sum += row;
    }
    if (process_ == ProcessKind::white) {
      for (const Vector4& row : c) laid_.within[k] += row * row.transpose();
      return;
    }
    if (process_ == ProcessKind::per_leg) {
      lay_legs(k, one, rows, c);
      return;
    }
    if (!is_chain(process_)) {
      const int state = group(one.session, 0, -1);
      if (!sum.isZero(0.0)) add_term(k, state, sum);
      return;
    }
    lay_chain(k, one, rows, c, reads);
  }

  /// A rest within a segment parts two legs.
  void lay_legs(std::size_t k, const Measurement& one, const std::vector<SegmentRow>& rows,
                const std::vector<Vector4>& c) {
    for (const auto& [leg, sum] : sums_by_leg(rows, c, pose(one.from).t, ends_in(one.session))) {
      const int state = group(one.session, leg, -1);
      if (!sum.isZero(0.0)) add_term(k, state, sum);
    }
  }

  void lay_chain(std::size_t k, const Measurement& one, const std::vector<SegmentRow>& rows,
                 const std::vector<Vector4>& c, bool reads) {
    const auto [by_start, keep, uu, uw, ww] = process_moments(rows, c, process_, length_, reads);
    const Vector4 K = ww > kLeastVariance ? Vector4(uw / ww) : Vector4(Vector4::Zero());
    laid_.within[k] = uu - K * uw.transpose();
    laid_.within[k] = (0.5 * (laid_.within[k] + laid_.within[k].transpose())).eval();
    // Which states a segment has must not depend on the length.
    if (by_start.isZero(0.0)) return;
    add_term(k, state_at_[idx(one.from - problem_.landmark_count())], by_start - keep * K);
    const int end = one.kind == MeasurementKind::gyro ? one.from + 1 : one.to;
    add_term(k, state_at_[idx(end - problem_.landmark_count())], K);
  }

  void add_term(std::size_t k, int state, const Vector4& by) {
    NoiseTerm term;
    term.state = state;
    term.by.head<4>() = by;
    laid_.terms[k].push_back(term);
  }

  const ProcessLayer& layer_;
  const RecordingProblem& problem_;
  Channel channel_;
  ProcessKind process_;
  double length_;
  LaidProcess laid_;
  std::vector<int> state_at_;  ///< per pose; -1: none
  std::map<std::array<int, 3>, int> groups_;
  std::map<int, std::vector<double>> legs_;
  /// Session and landmark: when last seen, and in which pass.
  std::map<std::pair<int, int>, std::pair<double, int>> passes_;
};

ProcessLayer::ProcessLayer(const RecordingProblem& problem,
                           const std::vector<Recording>& recordings, const Robot& robot)
    : problem_(problem), recordings_(recordings), robot_(robot) {
  influences_.reserve(problem.segments.size());
  for (const std::vector<SegmentRow>& rows : problem.segments) {
    influences_.push_back(row_influences(rows, {}, Eigen::VectorXd()));
  }
}

LaidProcess ProcessLayer::lay(Channel channel, ProcessKind process, double length) const {
  return ProcessLayout(*this, channel, process, length).take();
}

void put_processes(RecordingProblem& problem, const std::vector<LaidProcess>& laid,
                   const std::vector<double>& sds) {
  problem.noise_states.clear();
  problem.noise_terms.assign(laid.empty() ? 0 : problem.measurements.size(), {});
  problem.within.assign(laid.empty() ? 0 : problem.measurements.size(), Matrix4::Zero());
  for (std::size_t p = 0; p < laid.size(); ++p) {
    const int first = static_cast<int>(problem.noise_states.size());
    for (NoiseState state : laid[p].states) {
      state.process = static_cast<int>(p);
      if (state.previous >= 0) state.previous += first;
      problem.noise_states.push_back(state);
    }
    for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
      for (NoiseTerm term : laid[p].terms[k]) {
        term.state += first;
        term.by *= sds[p];
        problem.noise_terms[k].push_back(term);
      }
      problem.within[k] += sds[p] * sds[p] * laid[p].within[k];
    }
  }
}

void add_processes(RecordingProblem& problem, const std::vector<Recording>& recordings,
                   const Model& model) {
  if (model.noise.processes.empty()) return;
  const ProcessLayer layer(problem, recordings, model.robot);
  std::vector<LaidProcess> laid;
  std::vector<double> sds;
  for (const NoiseProcess& one : model.noise.processes) {
    laid.push_back(layer.lay(one.channel, one.process, one.length));
    sds.push_back(one.sd);
  }
  put_processes(problem, laid, sds);
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    Measurement& one = problem.measurements[k];
    one.whitener = whitener_with(one.whitener, problem.within[k], one.rows);
    for (std::size_t p = 0; p < laid.size(); ++p) {
      const NoiseProcess& process = model.noise.processes[p];
      if (!has_used_tails(process) || laid[p].within[k].isZero(0.0)) continue;
      one.tails = one.tails > 0.0 ? std::min(one.tails, process.tails) : process.tails;
    }
  }
}

Vector4 error_by(const Measurement& measurement, const ByView& by_view, const NoiseTerm& term) {
  if (is_driven(measurement.kind)) return -term.by.head<4>();
  return by_view * term.by;
}

Vector4 lasting_in_segment(const RecordingProblem& problem, std::size_t measurement,
                           const Eigen::VectorXd& states) {
  Vector4 sum = Vector4::Zero();
  if (problem.noise_terms.empty() || states.size() == 0) return sum;
  for (const NoiseTerm& term : problem.noise_terms[measurement]) {
    sum += states[term.state] * term.by.head<4>();
  }
  return sum;
}

ViewPattern lasting_in_view(const RecordingProblem& problem, std::size_t measurement,
                            const ViewPattern& view, const Eigen::VectorXd& states) {
  ViewPattern sum = view;
  if (problem.noise_terms.empty() || states.size() == 0) return sum;
  for (const NoiseTerm& term : problem.noise_terms[measurement]) {
    const double z = states[term.state];
    sum.ahead += z * term.by[0];
    sum.left += z * term.by[1];
    sum.heading += z * term.by[2];
    sum.range += z * term.by[3];
    sum.range_scale += z * term.by[4];
    sum.bearing += z * term.by[5];
    sum.x += z * term.by[6];
    sum.y += z * term.by[7];
    sum.yaw += z * term.by[8];
  }
  return sum;
}

std::vector<double> state_variances(const RecordingProblem& problem) {
  std::vector<double> variances;
  variances.reserve(problem.noise_states.size());
  for (const NoiseState& state : problem.noise_states) {
    const double before = state.previous < 0 ? 0.0 : variances[idx(state.previous)];
    variances.push_back(state.keep * state.keep * before + state.sd * state.sd);
  }
  return variances;
}

Matrix4 segment_prior_covariance(const RecordingProblem& problem,
                                 const std::vector<double>& variances, std::size_t measurement) {
  Matrix4 result = Matrix4::Zero();
  if (problem.noise_terms.empty()) return result;
  const std::vector<NoiseTerm>& terms = problem.noise_terms[measurement];
  for (const NoiseTerm& a : terms) {
    for (const NoiseTerm& b : terms) {
      double covariance = 0.0;
      if (a.state == b.state) covariance = variances[idx(a.state)];
      for (const auto& [early, late] : {std::pair(a.state, b.state), std::pair(b.state, a.state)}) {
        const NoiseState& state = problem.noise_states[idx(late)];
        if (state.previous == early) covariance = state.keep * variances[idx(early)];
      }
      result += covariance * a.by.head<4>() * b.by.head<4>().transpose();
    }
  }
  return result;
}

}  // namespace trussmap
