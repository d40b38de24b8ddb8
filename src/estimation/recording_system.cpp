// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_system.hpp"

#include "estimation/gyro_excess.hpp"
#include "estimation/held_unknowns.hpp"
#include "estimation/noise_states.hpp"
#include "estimation/student_tails.hpp"
#include "linalg/damped_step.hpp"
#include "linalg/dense.hpp"
#include "parallel/parallel_for.hpp"

#include <cmath>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
namespace {

constexpr std::size_t kMeasurementsAtOnce = 64;
constexpr std::size_t kColumnsAtOnce = 8;

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
void add_state_pairs(const RecordingProblem& problem, std::vector<NodePair>& pairs) {
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

std::vector<NodePair> pairs_of(const RecordingProblem& problem) {
  std::vector<NodePair> pairs;
  for (const Measurement& one : problem.measurements) {
    if (one.to >= 0) pairs.push_back({one.from, one.to});
  }
  add_state_pairs(problem, pairs);
  return pairs;
}

BlockSystem lay_out(const RecordingProblem& problem, const RecordingGauge& gauge) {
  const std::vector<NodePair> pairs = pairs_of(problem);
  const int nodes = problem.nodes() + static_cast<int>(problem.noise_states.size());
  return {sizes_of(problem, gauge), pairs, elimination_order(nodes, pairs)};
}

bool touches_drives(const EffectParameters& border) {
  for (const EffectPattern& effect : border) {
    if (!effect.drives.empty()) return true;
  }
  return false;
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

double RecordingSystem::linearise(const RecordingState& state, const Eigen::VectorXd& coefficients,
                                  bool hold_headings) {
  const std::vector<std::uint8_t> held = held_nodes(hold_headings);
  const auto take_held_out = [&held](int node, RowsByNode& rows) {
    if (node < 0 || held[idx(node)] == held_nothing) return;
    for (int k = 0; k < 3; ++k) {
      if (is_held(held[idx(node)], k)) rows.col(k).setZero();
    }
  };
  normal_.clear();
  gradient_ = Eigen::VectorXd::Zero(normal_.unknowns());
  M_.setZero();
  const bool with_drives = touches_drives(border_);
  if (with_drives) motions_.resize(problem_.measurements.size());
  const Eigen::VectorXd all = offsets_at(border_, coefficients);
  const auto states = static_cast<Eigen::Index>(problem_.noise_states.size());
  const Eigen::VectorXd noise =
      state.noise.size() == states ? state.noise : Eigen::VectorXd::Zero(states);
  const auto linearise_one = [&](std::size_t k) {
    const Measurement& one = problem_.measurements[k];
    const bool segment = is_driven(one.kind);
    Vector4 value =
        (segment && with_drives ? moved_by_effects(k, all) : one.value) + one.value_offset;
    ViewPattern view = view_of(border_, all, one);
    if (states > 0 && segment) value += lasting_in_segment(problem_, k, noise);
    if (states > 0 && !segment) view = lasting_in_view(problem_, k, view, noise);
    const MeasurementRows rows = measurement_rows(problem_, one, state, value, view);
    const Matrix4 W = root_weights_[k] * one.whitener;
    Whitened& J = J_[k];
    J.from = W * rows.by_from;
    J.to = W * rows.by_to;
    take_held_out(one.from, J.from);
    take_held_out(one.to, J.to);
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
  };
  parallel_ranges(problem_.measurements.size(), kMeasurementsAtOnce,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t k = begin; k < end; ++k) linearise_one(k);
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

std::vector<RecordingSystem::Link> RecordingSystem::links_of(std::size_t k) const {
  const Measurement& one = problem_.measurements[k];
  const Whitened& J = J_[k];
  std::vector<Link> links;
  for (const auto& [node, rows] : {std::pair(one.from, &J.from), std::pair(one.to, &J.to)}) {
    if (node < 0 || normal_.size(node) == 0) continue;
    links.push_back({node, rows->leftCols(normal_.size(node))});
  }
  for (std::size_t t = 0; t < J.states.size(); ++t) {
    links.push_back({state_node(problem_.noise_terms[k][t].state), J.states[t]});
  }
  return links;
}

std::vector<RecordingSystem::NodeRows> RecordingSystem::node_rows(std::size_t measurement) const {
  const int rows = problem_.measurements[measurement].rows;
  std::vector<NodeRows> result;
  for (const Link& link : links_of(measurement)) {
    result.push_back({link.node, link.J.topRows(rows)});
  }
  return result;
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
  if (one.kind == MeasurementKind::gyro) {
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
  if (is_driven(one.kind) && !motions_.empty()) {
    for (std::size_t c = 0; c < unknown_.size(); ++c) {
      const Vector4 column = -(W * motions_[k].slopes.col(unknown_[c]));
      M.col(static_cast<Eigen::Index>(c)) = column.head(one.rows);
    }
    return;
  }
  for (std::size_t c = 0; c < unknown_.size(); ++c) {
    const ViewPattern* unit = unit_view_of(border_[idx(unknown_[c])], one);
    if (unit == nullptr) continue;
    const Vector4 column = W * rows.by_view * unit->vector();
    M.col(static_cast<Eigen::Index>(c)) = column.head(one.rows);
  }
}

Eigen::MatrixXd RecordingSystem::transposed_times(const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(normal_.unknowns(), rows.cols());
  parallel_ranges(idx(rows.cols()), kColumnsAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<Eigen::Index>(begin);
    const auto columns = static_cast<Eigen::Index>(end - begin);
    add_transposed_times(rows.middleCols(first, columns), result.middleCols(first, columns));
  });
  return result;
}

void RecordingSystem::add_transposed_times(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                           Eigen::Ref<Eigen::MatrixXd> result) const {
  for (std::size_t k = 0; k < J_.size(); ++k) {
    const Measurement& one = problem_.measurements[k];
    const auto part = rows.middleRows(first_row_[k], one.rows);
    for (const auto& [node, J] : {std::pair(one.from, &J_[k].from), std::pair(one.to, &J_[k].to)}) {
      if (node < 0 || normal_.size(node) == 0) continue;
      const int size = normal_.size(node);
      result.middleRows(normal_.offset(node), size).noalias() +=
          J->topLeftCorner(one.rows, size).transpose().lazyProduct(part);
    }
    for (std::size_t t = 0; t < J_[k].states.size(); ++t) {
      const int at = normal_.offset(state_node(problem_.noise_terms[k][t].state));
      result.row(at) += J_[k].states[t].head(one.rows).transpose() * part;
    }
  }
  for (std::size_t k = 0; k < problem_.noise_states.size(); ++k) {
    const NoiseState& state = problem_.noise_states[k];
    const auto part = rows.row(state_row(k));
    result.row(normal_.offset(state_node(static_cast<int>(k)))) += part / state.sd;
    if (state.previous < 0) continue;
    result.row(normal_.offset(state_node(state.previous))) -= state.keep / state.sd * part;
  }
}

Eigen::MatrixXd RecordingSystem::times(const Eigen::MatrixXd& nodes) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows_, nodes.cols());
  subtract_times(nodes, result);
  result = -result;
  return result;
}

void RecordingSystem::subtract_times(const Eigen::MatrixXd& nodes, Eigen::MatrixXd& rows) const {
  parallel_ranges(idx(rows.cols()), kColumnsAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<Eigen::Index>(begin);
    const auto columns = static_cast<Eigen::Index>(end - begin);
    subtract_some(nodes.middleCols(first, columns), rows.middleCols(first, columns));
  });
}

void RecordingSystem::subtract_some(const Eigen::Ref<const Eigen::MatrixXd>& nodes,
                                    Eigen::Ref<Eigen::MatrixXd> rows) const {
  for (std::size_t k = 0; k < J_.size(); ++k) {
    const Measurement& one = problem_.measurements[k];
    auto part = rows.middleRows(first_row_[k], one.rows);
    for (const auto& [node, J] : {std::pair(one.from, &J_[k].from), std::pair(one.to, &J_[k].to)}) {
      if (node < 0 || normal_.size(node) == 0) continue;
      const int size = normal_.size(node);
      part.noalias() -= J->topLeftCorner(one.rows, size)
                            .lazyProduct(nodes.middleRows(normal_.offset(node), size));
    }
    for (std::size_t t = 0; t < J_[k].states.size(); ++t) {
      const int at = normal_.offset(state_node(problem_.noise_terms[k][t].state));
      part -= J_[k].states[t].head(one.rows) * nodes.row(at);
    }
  }
  for (std::size_t k = 0; k < problem_.noise_states.size(); ++k) {
    const NoiseState& state = problem_.noise_states[k];
    auto part = rows.row(state_row(k));
    part -= nodes.row(normal_.offset(state_node(static_cast<int>(k)))) / state.sd;
    if (state.previous < 0) continue;
    part += state.keep / state.sd * nodes.row(normal_.offset(state_node(state.previous)));
  }
}

Eigen::MatrixXd RecordingSystem::free_of_nodes(Eigen::MatrixXd columns) const {
  if (columns.cols() > 0) subtract_times(solve_nodes(transposed_times(columns)), columns);
  return columns;
}

Eigen::MatrixXd RecordingSystem::transposed_rows(std::size_t measurement) const {
  const Measurement& one = problem_.measurements[measurement];
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(normal_.unknowns() + M_.cols(), one.rows);
  for (const Link& link : links_of(measurement)) {
    result.middleRows(normal_.offset(link.node), link.J.cols()) =
        link.J.topRows(one.rows).transpose();
  }
  result.bottomRows(M_.cols()) = M_.middleRows(first_row_[measurement], one.rows).transpose();
  return result;
}

void RecordingSystem::build_schur(double damping) {
  A_inverse_B_ = B_.cols() > 0 ? normal_.solve(B_) : B_;
  schur_ = D_ - B_.transpose() * A_inverse_B_;
  schur_ = (0.5 * (schur_ + schur_.transpose())).eval();
  schur_.diagonal() += damping * D_.diagonal();
  if (schur_.cols() == 0) return;
  const DenseCholesky factor(schur_);
  if (!factor.positive_definite()) throw NotPositiveDefinite(-1);
  schur_inverse_ = factor.inverse();
}

RecordingSystem::Step RecordingSystem::solve_step(double damping) {
  factorise_damped(normal_, damping);
  build_schur(damping);
  Step step;
  step.nodes = -gradient_;
  normal_.solve_in_place(step.nodes);
  step.coefficients = Eigen::VectorXd::Zero(B_.cols());
  if (B_.cols() > 0) {
    step.coefficients = schur_inverse_ * (-border_gradient_ - B_.transpose() * step.nodes);
    step.nodes -= A_inverse_B_ * step.coefficients;
  }
  step.predicted = predicted_decrease(step.nodes, gradient_, normal_.diagonal(), damping) +
                   predicted_decrease(step.coefficients, border_gradient_, D_.diagonal(), damping);
  return step;
}

RecordingState RecordingSystem::moved(const RecordingState& state, const Step& step) const {
  RecordingState result = state;
  const auto states = static_cast<Eigen::Index>(problem_.noise_states.size());
  if (result.noise.size() != states) result.noise = Eigen::VectorXd::Zero(states);
  for (Eigen::Index k = 0; k < states; ++k) {
    result.noise[k] += step.nodes[normal_.offset(state_node(static_cast<int>(k)))];
  }
  for (int node = 0; node < problem_.nodes(); ++node) {
    if (normal_.size(node) == 0) continue;
    const int at = normal_.offset(node);
    if (problem_.is_landmark(node)) {
      result.landmarks[idx(node)] += step.nodes.segment<2>(at);
    } else if (problem_.is_orientation(node)) {
      result.orientations[idx(node - problem_.pose_end())] += step.nodes[at];
    } else {
      Pose& pose = result.poses[idx(node - problem_.landmark_count())];
      pose.x += step.nodes[at];
      pose.y += step.nodes[at + 1];
      pose.heading += step.nodes[at + 2];
    }
  }
  return result;
}

void RecordingSystem::factorise() {
  if (normal_.unknowns() > 0) normal_.factorise();
  build_schur(0.0);
}

Eigen::MatrixXd RecordingSystem::solve(const Eigen::MatrixXd& b) const {
  const Eigen::Index n = normal_.unknowns();
  Eigen::MatrixXd x(b.rows(), b.cols());
  if (b.cols() == 0) return x;
  x.topRows(n) = normal_.solve(b.topRows(n));
  if (B_.cols() > 0) {
    x.bottomRows(B_.cols()) =
        schur_inverse_ * (b.bottomRows(B_.cols()) - B_.transpose() * x.topRows(n));
    x.topRows(n) -= A_inverse_B_ * x.bottomRows(B_.cols());
  }
  return x;
}

Eigen::MatrixXd RecordingSystem::joint_covariance(const std::vector<int>& nodes) const {
  const Eigen::Index n = normal_.unknowns();
  Eigen::Index size = B_.cols();
  for (const int node : nodes) size += problem_.size_of(node);
  Eigen::MatrixXd selection = Eigen::MatrixXd::Zero(n + B_.cols(), size);
  Eigen::Index at = 0;
  for (const int node : nodes) {
    const int width = problem_.size_of(node);
    for (int k = 0; k < width && k < normal_.size(node); ++k) {
      const bool held =
          node == problem_.pose_node(0) && (k == 2 ? gauge_.hold_heading : gauge_.hold_position);
      if (!held) selection(normal_.offset(node) + k, at + k) = 1.0;
    }
    at += width;
  }
  selection.bottomRightCorner(B_.cols(), B_.cols()).setIdentity();
  const Eigen::MatrixXd covariance = selection.transpose() * solve(selection);
  return 0.5 * (covariance + covariance.transpose());
}

template <int Size>
std::vector<Eigen::Matrix<double, Size, Size>> RecordingSystem::covariances(int first,
                                                                            int count) const {
  const Eigen::MatrixXd blocks = normal_.inverse_blocks();
  std::vector<Eigen::Matrix<double, Size, Size>> result(idx(count),
                                                        Eigen::Matrix<double, Size, Size>::Zero());
  for (int k = 0; k < count; ++k) {
    const int node = first + k;
    if (normal_.size(node) == 0) continue;
    const Eigen::Index at = normal_.offset(node);
    auto& covariance = result[idx(k)];
    covariance = blocks.block<Size, Size>(0, at);
    if (B_.cols() == 0) continue;
    const auto own = A_inverse_B_.middleRows(at, Size);
    covariance += own * schur_inverse_ * own.transpose();
  }
  return result;
}

std::vector<Matrix2> RecordingSystem::landmark_covariances() const {
  return covariances<2>(0, problem_.landmark_count());
}

std::vector<double> RecordingSystem::orientation_variances() const {
  std::vector<double> result;
  const auto count = static_cast<int>(problem_.oriented.size());
  result.reserve(problem_.oriented.size());
  for (const auto& one : covariances<1>(problem_.pose_end(), count)) result.push_back(one(0, 0));
  return result;
}

std::vector<Matrix3> RecordingSystem::pose_covariances() const {
  std::vector<Matrix3> result =
      covariances<3>(problem_.landmark_count(), static_cast<int>(problem_.poses.size()));
  // The diagonal of what is held is there for the sake of the solution alone.
  if (gauge_.hold_heading) {
    result.front().row(2).setZero();
    result.front().col(2).setZero();
  }
  if (gauge_.hold_position) {
    result.front().topRows<2>().setZero();
    result.front().leftCols<2>().setZero();
  }
  return result;
}

Eigen::MatrixXd RecordingSystem::landmark_covariance_times(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd lifted = Eigen::MatrixXd::Zero(normal_.unknowns() + B_.cols(), b.cols());
  for (int node = 0; node < problem_.landmark_count(); ++node) {
    if (normal_.size(node) == 0) continue;
    lifted.middleRows(normal_.offset(node), 2) = b.middleRows(Eigen::Index{2} * node, 2);
  }
  const Eigen::MatrixXd solved = solve(lifted);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(b.rows(), b.cols());
  for (int node = 0; node < problem_.landmark_count(); ++node) {
    if (normal_.size(node) == 0) continue;
    result.middleRows(Eigen::Index{2} * node, 2) = solved.middleRows(normal_.offset(node), 2);
  }
  return result;
}

Eigen::MatrixXd RecordingSystem::coefficient_covariance() const {
  return B_.cols() == 0 ? B_.topRows(0) : schur_inverse_;
}

double RecordingSystem::log_determinant() const {
  double sum = normal_.unknowns() > 0 ? normal_.log_determinant() : 0.0;
  if (schur_.cols() == 0) return sum;
  return sum + DenseCholesky(schur_).log_determinant();
}

double RecordingSystem::gradient_norm() const {
  return 2.0 * std::hypot(gradient_.norm(), border_gradient_.norm());
}

Eigen::MatrixXd RecordingSystem::scaled_schur() const {
  const Eigen::VectorXd scale = D_.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  // Not D - B' A^-1 B, whose difference loses all digits where it matters, but what is left of M
  // when the nodes have taken what they can.
  const Eigen::MatrixXd left = M_ - times(A_inverse_B_);
  Eigen::MatrixXd schur = left.transpose() * left;
  for (Eigen::Index k = 0; k < schur.cols(); ++k) {
    const double prior_sd = border_[idx(unknown_[idx(k)])].prior_sd;
    schur(k, k) += 1.0 / (prior_sd * prior_sd);
  }
  return scale.asDiagonal() * schur * scale.asDiagonal();
}

}  // namespace trussmap
