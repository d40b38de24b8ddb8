// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/session_summary.hpp"

#include "estimation/noise_states.hpp"
#include "estimation/recording_descent.hpp"
#include "trussmap/error.hpp"

#include <limits>
#include <stdexcept>
#include <utility>

namespace trussmap::estimation {
namespace {

/// m or rad: how far off a path may be. The gradient takes in one more step, which leaves of a
/// Newton's step the square, of a Gauss-Newton step a share.
constexpr double kStill = 1e-6;
constexpr double kVeryStill = 1e-9;
constexpr double kSlack = 1e-9;  // rad: slopes by the coefficients are not older than that
constexpr int kMostSteps = 50;

bool is_survey(const Measurement& one) {
  return one.session < 0;
}

void require_one_session(const SessionRows& rows) {
  bool good = rows.problem.sessions.size() == 1;
  for (const Measurement& one : rows.problem.measurements) good = good && !is_survey(one);
  if (!good) throw std::invalid_argument("a summary is of one session, and of no survey");
}

}  // namespace

void drop_survey(SessionRows& rows) {
  std::vector<Measurement>& all = rows.problem.measurements;
  while (!all.empty() && is_survey(all.back())) all.pop_back();
  const auto shorten = [&](auto& per_measurement) {
    if (!per_measurement.empty()) per_measurement.resize(all.size());
  };
  shorten(rows.weights);
  shorten(rows.problem.noise_terms);
  shorten(rows.problem.within);
}

/// Second derivatives and gradient, between own unknowns p and shared ones u.
struct SessionSummary::Coupled {
  linalg::SparseMatrix own_by_map;     ///< f_pu, landmarks and orientations
  Eigen::MatrixXd own_by_coefficient;  ///< f_pu, the rest
  Eigen::MatrixXd shared;              ///< f_uu
  Eigen::VectorXd gradient;            ///< f_u
};

SessionSummary::SessionSummary(SessionRows rows) {
  require_one_session(rows);
  for (EffectPattern& effect : rows.border) {
    effect.prior_sd =
        std::numeric_limits<double>::infinity();  // who takes sessions together has it
  }
  if (rows.state.noise.size() == 0) {
    rows.state.noise =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.problem.noise_states.size()));
  }
  rows_ = std::make_unique<SessionRows>(std::move(rows));
  system_ = std::make_unique<RecordingSystem>(rows_->problem, rows_->border,
                                              RecordingGauge{.hold_map = true});
  system_->set_slack(kSlack);
  if (!rows_->weights.empty()) system_->set_weights(rows_->weights);
  coefficients_ = static_cast<int>(unknown_coefficients(rows_->border).size());
  taken_.state = std::move(rows_->state);
}

int SessionSummary::shared() const {
  return first_orientation() + static_cast<int>(problem().oriented.size()) + coefficients_;
}

int SessionSummary::own_unknowns() const {
  return system_->unknowns() - coefficients_;
}

int SessionSummary::measured_values() const {
  int rows = static_cast<int>(problem().noise_states.size());  // each is told of by one more
  for (std::size_t k = 0; k < problem().measurements.size(); ++k) {
    if (rows_->weights.empty() || rows_->weights[k] > 0.0) rows += problem().measurements[k].rows;
  }
  return rows;
}

Eigen::VectorXd SessionSummary::shared_of(const RecordingState& state,
                                          const Eigen::VectorXd& coefficients) const {
  Eigen::VectorXd u(shared());
  for (int k = 0; k < problem().landmark_count(); ++k) {
    u.segment<2>(Eigen::Index{2} * k) = state.landmarks[idx(k)];
  }
  for (int k = first_orientation(); k < first_coefficient(); ++k) {
    u[k] = state.orientations[idx(k - first_orientation())];
  }
  u.tail(coefficients_) = coefficients;
  return u;
}

void SessionSummary::place(const Eigen::VectorXd& u, RecordingState& state) const {
  for (int k = 0; k < problem().landmark_count(); ++k) {
    state.landmarks[idx(k)] = u.segment<2>(Eigen::Index{2} * k);
  }
  for (int k = first_orientation(); k < first_coefficient(); ++k) {
    state.orientations[idx(k - first_orientation())] = u[k];
  }
}

/// What a measurement touches: its own unknowns, the map's, coefficients, in this order.
struct SessionSummary::Touched {
  std::vector<RecordingSystem::NodeRows> own;
  Eigen::Index own_width = 0;
  Eigen::Index width = 0;  ///< of the map's: 2 of a landmark, 1 of an orientation
  Eigen::Index at = 0;     ///< where these begin in u
};

SessionSummary::Touched SessionSummary::touched_by(std::size_t k) const {
  const Measurement& one = problem().measurements[k];
  Touched result{system_->node_rows(k)};
  for (const RecordingSystem::NodeRows& link : result.own) result.own_width += link.rows.cols();
  if (one.to < 0) return result;
  if (problem().is_landmark(one.to)) {
    result.width = 2;
    result.at = Eigen::Index{2} * one.to;
  } else if (problem().is_orientation(one.to)) {
    result.width = 1;
    result.at = first_orientation() + one.to - problem().pose_end();
  }
  return result;
}

/// How the numbers of second_order change with what the measurement touches.
Eigen::MatrixXd SessionSummary::numbers_by(std::size_t k, const Touched& touched) const {
  const Measurement& one = problem().measurements[k];
  Eigen::MatrixXd F =
      Eigen::MatrixXd::Zero(15, touched.own_width + touched.width + Eigen::Index{coefficients_});
  Eigen::Index column = 0;
  const auto add_pose = [&](Eigen::Index row) {
    F.block<3, 3>(row, column).setIdentity();
    column += 3;
  };
  add_pose(0);
  if (one.to >= 0 && touched.width == 0) add_pose(kSecondOrderTo);
  if (!problem().noise_terms.empty()) {
    for (const NoiseTerm& term : problem().noise_terms[k]) {
      if (!is_driven(one)) F.block<9, 1>(kSecondOrderView, column) = term.by;
      ++column;
    }
  }
  F.block(kSecondOrderTo, column, touched.width, touched.width).setIdentity();
  column += touched.width;
  for (const int effect : unknown_coefficients(rows_->border)) {
    const effects::ViewPattern* unit = unit_view_of(rows_->border[idx(effect)], one);
    if (unit != nullptr) F.block<9, 1>(kSecondOrderView, column) = unit->vector();
    ++column;
  }
  return F;
}

/// What Gauss and Newton leave out, by what the measurement touches.
Eigen::MatrixXd SessionSummary::curvature_of(std::size_t k, const Touched& touched,
                                             RecordingState& state,
                                             const Eigen::VectorXd& offsets) const {
  const Measurement& one = problem().measurements[k];
  Vector4 residual = Vector4::Zero();
  residual.head(one.rows) = system_->residuals().segment(system_->first_row(k), one.rows);
  const Vector4 weighted = system_->root_weight(k) * one.whitener.transpose() * residual;
  const bool plain = coefficients_ == 0 && problem().noise_terms.empty();
  const Eigen::MatrixXd F = plain ? Eigen::MatrixXd() : numbers_by(k, touched);
  const bool with_view = !plain && !F.bottomRows<9>().isZero(0.0);
  effects::ViewPattern view = view_of(rows_->border, offsets, one);
  if (!problem().noise_states.empty() && !is_driven(one)) {
    view = lasting_in_view(problem(), k, view, state.noise);
  }
  const SecondOrder whole = second_order(problem(), one, state, view, weighted, with_view);
  const Eigen::Index all = touched.own_width + touched.width;
  if (plain) return whole.topLeftCorner(all, all);  // of `to` what there is of it comes first
  Eigen::MatrixXd result = F.transpose() * whole * F;
  if (is_segment(one) && taken_.bends != nullptr) {
    for (std::size_t row = 0; row < SegmentBends().size(); ++row) {
      result.bottomRightCorner(coefficients_, coefficients_) -=
          weighted[static_cast<Eigen::Index>(row)] * (*taken_.bends)[k][row];
    }
  }
  return result;
}

/// Second derivatives by coefficients cost far more than the rest of a summary, and hardly change.
void SessionSummary::bend(const Eigen::VectorXd& offsets) {
  constexpr double kBent = 1e-4;  // of coefficients
  if (coefficients_ == 0) return;
  const bool before = taken_.bends != nullptr;
  if (before && (offsets - taken_.bent_at).cwiseAbs().maxCoeff() < kBent) return;
  std::vector<SegmentBends> bends(problem().measurements.size());
  for (std::size_t k = 0; k < bends.size(); ++k) {
    const Measurement& one = problem().measurements[k];
    if (!is_segment(one)) continue;
    bends[k] = segment_bends(problem(), one, rows_->border, offsets);
  }
  taken_.bends = std::make_shared<const std::vector<SegmentBends>>(std::move(bends));
  taken_.bent_at = offsets;
}

/// The system is linearised at the state; `curved` takes in what Gauss and Newton leave out.
SessionSummary::Coupled SessionSummary::couple(RecordingState& state,
                                               const Eigen::VectorXd& coefficients, bool curved) {
  const Eigen::VectorXd offsets = offsets_at(rows_->border, coefficients);
  const Eigen::MatrixXd& M = system_->border();
  const linalg::BlockSystem& normal = system_->normal_equations();
  const Eigen::Index C = coefficients_;
  Coupled result;
  result.shared = Eigen::MatrixXd::Zero(shared(), shared());
  result.gradient = Eigen::VectorXd::Zero(shared());
  result.own_by_coefficient = system_->transposed_times(M);
  result.shared.bottomRightCorner(C, C) = M.transpose() * M;
  result.gradient.tail(C) = M.transpose() * system_->residuals();
  std::vector<Eigen::Triplet<double>> by_map;
  for (std::size_t k = 0; k < problem().measurements.size(); ++k) {
    const Touched touched = touched_by(k);
    const auto [own, own_width, width, at] = touched;
    const int rows = problem().measurements[k].rows;
    const Eigen::Index all = own_width + width + C;
    Eigen::MatrixXd more = Eigen::MatrixXd::Zero(all, all);
    if (curved) {
      more = curvature_of(k, touched, state, offsets);
      system_->add_curvature(k, more.topLeftCorner(own_width, own_width));
      result.shared.bottomRightCorner(C, C) += more.bottomRightCorner(C, C);
    }
    const Eigen::MatrixXd to_rows = system_->rows_by_to(k).leftCols(width);
    Eigen::Index column = 0;
    for (const RecordingSystem::NodeRows& link : own) {
      const Eigen::Index size = link.rows.cols();
      const Eigen::Index row = normal.offset(link.node);
      result.own_by_coefficient.middleRows(row, size) += more.block(column, all - C, size, C);
      const Eigen::MatrixXd block =
          link.rows.transpose() * to_rows + more.block(column, own_width, size, width);
      for (Eigen::Index c = 0; c < width; ++c) {
        for (Eigen::Index r = 0; r < size; ++r) {
          by_map.emplace_back(static_cast<int>(row + r), static_cast<int>(at + c), block(r, c));
        }
      }
      column += size;
    }
    if (width == 0) continue;
    const int first = system_->first_row(k);
    result.shared.block(at, at, width, width) +=
        to_rows.transpose() * to_rows + more.block(own_width, own_width, width, width);
    const Eigen::MatrixXd cross =
        to_rows.transpose() * M.middleRows(first, rows) + more.block(own_width, all - C, width, C);
    result.shared.block(at, first_coefficient(), width, C) += cross;
    result.shared.block(first_coefficient(), at, C, width) += cross.transpose();
    result.gradient.segment(at, width) +=
        to_rows.transpose() * system_->residuals().segment(first, rows);
  }
  result.own_by_map.resize(normal.unknowns(), first_coefficient());
  result.own_by_map.setFromTriplets(by_map.begin(), by_map.end());
  return result;
}

/// Own unknowns go to where they are best for these of the map.
void SessionSummary::relax(RecordingState& state, const Eigen::VectorXd& coefficients,
                           double still) {
  linalg::BlockSystem& normal = system_->normal_equations();
  for (int step = 0; step < kMostSteps; ++step) {
    static_cast<void>(system_->linearise(state, coefficients));
    if (normal.unknowns() == 0) return;
    factorise();
    RecordingSystem::Step own;
    own.nodes = -system_->gradient();
    normal.solve_in_place(own.nodes);
    if (own.nodes.cwiseAbs().maxCoeff() <= still) return;
    state = system_->moved(state, own);
  }
  throw SolveError(problem().sessions.front() + ": its path does not settle on the map");
}

void SessionSummary::factorise() {
  try {
    system_->normal_equations().factorise();
  } catch (const linalg::NotPositiveDefinite&) {
    refuse_loose();
  }
}

void SessionSummary::refuse_loose() const {
  throw SolveError(
      problem().sessions.front() +
      ": its path is not determined where the landmarks are known; sight more of them");
}

SessionSummary::Quadratic SessionSummary::reduced(const Eigen::VectorXd& u, RecordingState& state,
                                                  SecondDerivatives kind, bool with_information) {
  place(u, state);
  const Eigen::VectorXd coefficients = u.tail(coefficients_);
  const bool whole = kind == SecondDerivatives::whole;
  relax(state, coefficients, whole ? kStill : kVeryStill);
  if (whole && with_information) bend(offsets_at(rows_->border, coefficients));
  linalg::BlockSystem& normal = system_->normal_equations();
  Coupled coupled = couple(state, coefficients, whole);
  try {
    factorise();
  } catch (const SolveError&) {
    if (!whole) throw;
    return reduced(u, state, SecondDerivatives::gauss_newton, with_information);
  }
  Eigen::VectorXd own = -system_->gradient();
  normal.solve_in_place(own);
  const Eigen::Index M = first_coefficient();
  Quadratic result{u,
                   0.5 * (system_->residuals().squaredNorm() + own.dot(system_->gradient())),
                   coupled.gradient,
                   {}};
  result.gradient.head(M) += coupled.own_by_map.transpose() * own;
  result.gradient.tail(coefficients_) += coupled.own_by_coefficient.transpose() * own;
  if (!with_information) return result;
  Eigen::MatrixXd across(normal.unknowns(), shared());
  across.leftCols(M) = coupled.own_by_map;
  across.rightCols(coefficients_) = coupled.own_by_coefficient;
  const Eigen::MatrixXd solved = normal.solve(across);
  Eigen::MatrixXd& H = coupled.shared;
  H.topRows(M) -= coupled.own_by_map.transpose() * solved;
  H.bottomRows(coefficients_) -= coupled.own_by_coefficient.transpose() * solved;
  result.information = 0.5 * (H + H.transpose());
  return result;
}

/// Whether it is does not depend on where it is summarised: asked once.
void SessionSummary::require_determined(const Eigen::VectorXd& u) {
  RecordingState state = taken_.state;
  place(u, state);
  static_cast<void>(system_->linearise(state, u.tail(coefficients_)));
  try {
    if (!find_loose_nodes(*system_).empty()) refuse_loose();
  } catch (const linalg::NotPositiveDefinite&) {
    refuse_loose();  // where all weights are 0
  }
}

void SessionSummary::linearise(const Eigen::VectorXd& u, SecondDerivatives kind) {
  if (quadratic().at.size() == 0) require_determined(u);
  RecordingState state = taken_.state;
  Quadratic next = reduced(u, state, kind, true);
  next.kind = kind;
  taken_.quadratic = std::move(next);
  taken_.state = std::move(state);
}

SessionSummary::Quadratic SessionSummary::value_at(const Eigen::VectorXd& u) {
  RecordingState state = taken_.state;
  return reduced(u, state, SecondDerivatives::whole, false);
}

}  // namespace trussmap::estimation
