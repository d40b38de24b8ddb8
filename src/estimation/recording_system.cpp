// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_system.hpp"

#include "estimation/gyro_excess.hpp"
#include "estimation/held_unknowns.hpp"
#include "estimation/noise_states.hpp"
#include "estimation/student_tails.hpp"
#include "parallel/parallel_for.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

constexpr std::size_t kMeasurementsAtOnce = 64;

std::vector<int> sizes_of(const RecordingProblem& problem, const RecordingGauge& gauge) {
  std::vector<int> sizes(idx(problem.nodes()));
  for (int node = 0; node < problem.nodes(); ++node) {
    const bool of_map = problem.is_landmark(node) || problem.is_orientation(node);
    sizes[idx(node)] = gauge.hold_map && of_map ? 0 : problem.size_of(node);
  }
  if (gauge.hold_landmark) sizes[0] = 0;
  sizes.resize(sizes.size() + problem.noise_states.size(), 1);
  return sizes;
}

/// Of each measurement's noise terms with its nodes and with those before them; then of each state
/// with the one before it.
void add_state_pairs(const RecordingProblem& problem, std::vector<linalg::NodePair>& pairs) {
  for (std::size_t k = 0; k < problem.noise_terms.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    const std::vector<NoiseTerm>& terms = problem.noise_terms[k];
    for (std::size_t t = 0; t < terms.size(); ++t) {
      const int node = problem.nodes() + terms[t].state;
      pairs.push_back({one.from, node});
      if (one.to >= 0) pairs.push_back({one.to, node});
      for (std::size_t other = 0; other < t; ++other) {
        pairs.push_back({problem.nodes() + terms[other].state, node});
      }
    }
  }
  for (std::size_t state = 0; state < problem.noise_states.size(); ++state) {
    const int previous = problem.noise_states[state].previous;
    if (previous < 0) continue;
    pairs.push_back({problem.nodes() + previous, problem.nodes() + static_cast<int>(state)});
  }
}

std::vector<linalg::NodePair> pairs_of(const RecordingProblem& problem) {
  std::vector<linalg::NodePair> pairs;
  for (const Measurement& one : problem.measurements) {
    if (one.to >= 0) pairs.push_back({one.from, one.to});
  }
  add_state_pairs(problem, pairs);
  return pairs;
}

linalg::BlockSystem lay_out(const RecordingProblem& problem, const RecordingGauge& gauge) {
  const std::vector<linalg::NodePair> pairs = pairs_of(problem);
  const int nodes = problem.nodes() + static_cast<int>(problem.noise_states.size());
  return {sizes_of(problem, gauge), pairs, linalg::elimination_order(nodes, pairs)};
}

bool touches_drives(const EffectParameters& border) {
  for (const EffectPattern& effect : border) {
    if (!effect.drives.empty()) return true;
  }
  return false;
}

void take_held_out(const std::vector<std::uint8_t>& held, int node, RowsByNode& rows) {
  if (node < 0 || held[idx(node)] == held_nothing) return;
  for (int k = 0; k < 3; ++k) {
    if (is_held(held[idx(node)], k)) rows.col(k).setZero();
  }
}

}  // namespace

RecordingSystem::RecordingSystem(const RecordingProblem& problem, const EffectParameters& border)
    : RecordingSystem(problem, border, choose_gauge(problem)) {}

RecordingSystem::RecordingSystem(const RecordingProblem& problem, const EffectParameters& border,
                                 const RecordingGauge& gauge)
    : problem_(problem),
      border_(border),
      unknown_(unknown_coefficients(border)),
      gauge_(gauge),
      root_weights_(problem.measurements.size()),
      normal_(lay_out(problem, gauge_)),
      J_(problem.measurements.size()) {
  int pair = 0;
  for (const Measurement& one : problem.measurements) {
    first_row_.push_back(rows_);
    rows_ += one.rows;
    pair_.push_back(one.to >= 0 ? pair++ : -1);
  }
  for (std::size_t k = 0; k < problem.noise_terms.size(); ++k) {
    const int terms = static_cast<int>(problem.noise_terms[k].size());
    state_pair_.push_back(pair);
    pair += terms * (problem.measurements[k].to >= 0 ? 2 : 1) + terms * (terms - 1) / 2;
  }
  step_pair_ = pair;
  set_weights(std::vector<double>(problem.measurements.size(), 1.0));
  measured_rows_ = rows_;
  rows_ += static_cast<int>(problem.noise_states.size());
  residuals_.resize(rows_);
  squared_errors_.resize(problem.measurements.size());
  M_.resize(rows_, static_cast<Eigen::Index>(unknown_.size()));
}

void RecordingSystem::set_weights(const std::vector<double>& weights) {
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Measurement& one = problem_.measurements[k];
    root_weights_[k] = std::sqrt(weights[k] * tail_information(one.tails, one.rows));
  }
}

int RecordingSystem::unknowns() const {
  return normal_.unknowns() - (gauge_.hold_heading ? 1 : 0) - (gauge_.hold_position ? 2 : 0) +
         static_cast<int>(unknown_.size());
}

/// Of poses: the first one's part that nothing measures, and headings where these are held.
std::vector<std::uint8_t> RecordingSystem::held_nodes(bool hold_headings) const {
  std::vector<std::uint8_t> held(idx(problem_.nodes()), held_nothing);
  for (int node = problem_.landmark_count(); node < problem_.pose_end(); ++node) {
    if (hold_headings) held[idx(node)] = held_heading;
  }
  if (gauge_.hold_heading) held[idx(problem_.pose_node(0))] |= held_heading;
  if (gauge_.hold_position) held[idx(problem_.pose_node(0))] |= held_position;
  return held;
}

void RecordingSystem::linearise_measurement(std::size_t k, const Point& at) {
  const Measurement& one = problem_.measurements[k];
  const bool driven = is_driven(one);
  Vector4 value = one.value;
  if (driven && !motions_.empty()) value = moved_by_effects(k, at.offsets);
  value += one.value_offset;
  effects::ViewPattern view = view_of(border_, at.offsets, one);
  if (at.noise.size() > 0 && driven) value += lasting_in_segment(problem_, k, at.noise);
  if (at.noise.size() > 0 && !driven) view = lasting_in_view(problem_, k, view, at.noise);
  const MeasurementRows rows = measurement_rows(problem_, one, at.state, value, view);
  const Matrix4 W = root_weights_[k] * one.whitener;
  Whitened& J = J_[k];
  J.from = W * rows.by_from;
  J.to = W * rows.by_to;
  take_held_out(at.held, one.from, J.from);
  take_held_out(at.held, one.to, J.to);
  if (!problem_.noise_terms.empty()) {
    J.states.clear();
    for (const NoiseTerm& term : problem_.noise_terms[k]) {
      J.states.push_back(W * error_by(one, rows.by_view, term));
    }
  }
  const Vector4 error = W * rows.error;
  const Vector4 plain = one.tails > 0.0 ? rows.error + one.value_offset : rows.error;
  squared_errors_[k] = tail_deviance(one.tails, one.rows, (one.whitener * plain).squaredNorm());
  residuals_.segment(first_row_[k], one.rows) = error.head(one.rows);
  evaluate_effect_parameters(k, rows);
}

double RecordingSystem::linearise(const RecordingState& state, const Eigen::VectorXd& coefficients,
                                  bool hold_headings) {
  const std::vector<std::uint8_t> held = held_nodes(hold_headings);
  normal_.clear();
  gradient_ = Eigen::VectorXd::Zero(normal_.unknowns());
  M_.setZero();
  if (touches_drives(border_)) motions_.resize(problem_.measurements.size());
  const Eigen::VectorXd offsets = offsets_at(border_, coefficients);
  const auto states = static_cast<Eigen::Index>(problem_.noise_states.size());
  const Eigen::VectorXd noise =
      state.noise.size() == states ? state.noise : Eigen::VectorXd::Zero(states);
  const Point at{state, offsets, noise, held};
  parallel::parallel_ranges(problem_.measurements.size(), kMeasurementsAtOnce,
                            [&](std::size_t begin, std::size_t end) {
                              for (std::size_t k = begin; k < end; ++k)
                                linearise_measurement(k, at);
                            });
  for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
    Vector4 error = Vector4::Zero();
    error.head(problem_.measurements[k].rows) =
        residuals_.segment(first_row_[k], problem_.measurements[k].rows);
    add_to_normal(k, J_[k], error);
    if (!J_[k].states.empty()) add_states_to_normal(k, J_[k], error);
  }
  linearise_states(noise);
  hold_unknowns(normal_, gradient_, held);
  hold_unseen_orientations();
  double chi2 = residuals_.squaredNorm();
  B_ = transposed_times(M_);
  D_ = M_.transpose() * M_;
  border_gradient_ = M_.transpose() * residuals_;
  for (Eigen::Index c = 0; c < D_.cols(); ++c) {
    const double prior_sd = border_[idx(unknown_[idx(c)])].prior_sd;
    const double information = 1.0 / (prior_sd * prior_sd);
    D_(c, c) += information;
    border_gradient_[c] += information * coefficients[c];
    chi2 += information * coefficients[c] * coefficients[c];
  }
  return chi2;
}

/// One of which every yaw has been left out stays where it is.
void RecordingSystem::hold_unseen_orientations() {
  if (problem_.oriented.empty() || gauge_.hold_map) return;
  const Eigen::VectorXd diagonal = normal_.diagonal();
  for (int node = problem_.pose_end(); node < problem_.nodes(); ++node) {
    if (diagonal[normal_.offset(node)] > 0.0) continue;
    normal_.add_diagonal<1>(node, Eigen::Matrix<double, 1, 1>(1.0));
  }
}

void RecordingSystem::add_to_normal(std::size_t k, const Whitened& rows, const Vector4& error) {
  const Measurement& one = problem_.measurements[k];
  const auto add = [&](int node, const RowsByNode& J) {
    const int size = normal_.size(node);
    if (size == 0) return;
    const Matrix3 block = J.transpose() * J;
    const Eigen::Vector3d force = J.transpose() * error;
    if (size == 1) {
      normal_.add_diagonal<1>(node, block.topLeftCorner<1, 1>());
    } else if (size == 2) {
      normal_.add_diagonal<2>(node, block.topLeftCorner<2, 2>());
    } else {
      normal_.add_diagonal<3>(node, block);
    }
    gradient_.segment(normal_.offset(node), size) += force.head(size);
  };
  add(one.from, rows.from);
  if (one.to < 0) return;
  add(one.to, rows.to);
  const Matrix3 coupling = rows.from.transpose() * rows.to;
  if (problem_.is_landmark(one.to)) {
    normal_.add_coupling<3, 2>(pair_[k], coupling.leftCols<2>());
  } else if (problem_.is_orientation(one.to)) {
    normal_.add_coupling<3, 1>(pair_[k], coupling.leftCols<1>());
  } else {
    normal_.add_coupling<3, 3>(pair_[k], coupling);
  }
}

void RecordingSystem::add_states_to_normal(std::size_t k, const Whitened& rows,
                                           const Vector4& error) {
  const Measurement& one = problem_.measurements[k];
  const std::vector<NoiseTerm>& terms = problem_.noise_terms[k];
  int pair = state_pair_[k];
  const auto couple = [&](int node, const RowsByNode& J, const Vector4& column) {
    const Eigen::Vector3d coupling = J.transpose() * column;
    if (problem_.is_landmark(node)) {
      normal_.add_coupling<2, 1>(pair, Eigen::Vector2d(coupling.head<2>()));
    } else if (problem_.is_orientation(node)) {
      normal_.add_coupling<1, 1>(pair, Eigen::Matrix<double, 1, 1>(coupling[0]));
    } else {
      normal_.add_coupling<3, 1>(pair, coupling);
    }
    ++pair;
  };
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const int node = state_node(terms[t].state);
    const Vector4& column = rows.states[t];
    normal_.add_diagonal<1>(node, Eigen::Matrix<double, 1, 1>(column.squaredNorm()));
    gradient_[normal_.offset(node)] += column.dot(error);
    couple(one.from, rows.from, column);
    if (one.to >= 0) couple(one.to, rows.to, column);
    for (std::size_t other = 0; other < t; ++other) {
      normal_.add_coupling<1, 1>(pair++,
                                 Eigen::Matrix<double, 1, 1>(rows.states[other].dot(column)));
    }
  }
}

void RecordingSystem::linearise_states(const Eigen::VectorXd& states) {
  int pair = step_pair_;
  for (std::size_t k = 0; k < problem_.noise_states.size(); ++k) {
    const NoiseState& state = problem_.noise_states[k];
    const int node = state_node(static_cast<int>(k));
    const double own = 1.0 / state.sd;
    const double before = state.previous < 0 ? 0.0 : -state.keep / state.sd;
    double error = own * states[static_cast<Eigen::Index>(k)];
    if (state.previous >= 0) error += before * states[state.previous];
    residuals_[state_row(k)] = error;
    normal_.add_diagonal<1>(node, Eigen::Matrix<double, 1, 1>(own * own));
    gradient_[normal_.offset(node)] += own * error;
    if (state.previous < 0) continue;
    const int previous = state_node(state.previous);
    normal_.add_diagonal<1>(previous, Eigen::Matrix<double, 1, 1>(before * before));
    normal_.add_coupling<1, 1>(pair++, Eigen::Matrix<double, 1, 1>(own * before));
    gradient_[normal_.offset(previous)] += before * error;
  }
}

Vector4 RecordingSystem::moved_by_effects(std::size_t k, const Eigen::VectorXd& offsets) {
  Motion& motion = motions_[k];
  if (motion.at.size() == offsets.size()) {
    const Vector4 change = motion.slopes * (offsets - motion.at);
    if (std::abs(change[2]) <= slack_ && std::abs(change[3]) <= slack_) {
      return motion.value + change;
    }
  }
  const Measurement& one = problem_.measurements[k];
  if (!is_segment(one)) {
    motion.at = offsets;
    motion.slopes = excess_slopes(problem_.segments[one.source], problem_.gyro_weights[one.source],
                                  drive_patterns(border_, idx(one.session)));
    motion.value = one.value + motion.slopes * offsets;
    return motion.value;
  }
  const SegmentWithEffects segment = segment_motion(
      problem_.segments[one.source], drive_patterns(border_, idx(one.session)), offsets);
  const Pose& d = segment.motion.displacement;
  motion.at = offsets;
  motion.value << d.x, d.y, d.heading, one.rows == 4 ? segment.motion.mean_heading : one.value[3];
  motion.slopes = segment.derivatives;
  return motion.value;
}

void RecordingSystem::evaluate_effect_parameters(std::size_t k, const MeasurementRows& rows) {
  const Measurement& one = problem_.measurements[k];
  const Matrix4 W = root_weights_[k] * one.whitener;
  auto M = M_.middleRows(first_row_[k], one.rows);
  if (is_driven(one) && !motions_.empty()) {
    for (std::size_t c = 0; c < unknown_.size(); ++c) {
      const Vector4 column = -(W * motions_[k].slopes.col(unknown_[c]));
      M.col(static_cast<Eigen::Index>(c)) = column.head(one.rows);
    }
    return;
  }
  for (std::size_t c = 0; c < unknown_.size(); ++c) {
    const effects::ViewPattern* unit = unit_view_of(border_[idx(unknown_[c])], one);
    if (unit == nullptr) continue;
    const Vector4 column = W * rows.by_view * unit->vector();
    M.col(static_cast<Eigen::Index>(c)) = column.head(one.rows);
  }
}

}  // namespace trussmap::estimation
