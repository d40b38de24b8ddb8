// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Normal equations of a recording problem: sparse in landmarks and poses, dense in the few
// coefficients of effects, which are eliminated last.
//
//   r    whitened errors of all measurements, one vector           chi^2 = r'r
//   J    their derivatives by landmarks and poses, sparse;  A = J'J
//   M    their derivatives by the coefficients, dense;      B = J'M,  D = M'M (+ prior)
//
//   [A  B] [dx]    [J'r]          S = D - B' A^-1 B, the Schur complement:
//   [B' D] [dc] = -[M'r]          its inverse is the coefficients' covariance
//
// The sparse pattern is laid out and analysed once; adding an effect never changes it.
//
// Noise that lasts has states of its own (noise_states.hpp): nodes of one unknown after the poses,
// columns of J; and rows of their own, one each, that follow those of all measurements in r and M.
//
// Held, where nothing measures it: the first landmark at the origin (without landmarks, the first
// pose's position), and the first pose's heading.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/recording_problem.hpp"
#include "linalg/block_system.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::estimation {

struct RecordingGauge {
  bool hold_landmark = false;  ///< the first one
  bool hold_heading = false;   ///< of the first pose
  bool hold_position = false;  ///< of the first pose, where there is no landmark to hold
  bool hold_map = false;       ///< all landmarks and orientations: poses and noise alone are free
};

/// What no measurement of the problem fixes. Throws SolveError where sessions have nothing in
/// common that would tie them together.
[[nodiscard]] RecordingGauge choose_gauge(const RecordingProblem& problem);

/// Poses that no common landmark, survey, truth, fix or loop ties to the map's frame or, where
/// nothing gives one, to the first pose. Measurements of weight 0 tie nothing (no weights: all
/// count).
[[nodiscard]] std::vector<int> untied_poses(const RecordingProblem& problem,
                                            const std::vector<double>& weights = {});

class RecordingSystem {
 public:
  /// Keeps references to the problem and the border.
  RecordingSystem(const RecordingProblem& problem, const EffectParameters& border);
  RecordingSystem(const RecordingProblem& problem, EffectParameters&& border) = delete;
  RecordingSystem(RecordingProblem&& problem, const EffectParameters& border) = delete;
  /// Holds what the caller says instead of what choose_gauge does.
  RecordingSystem(const RecordingProblem& problem, const EffectParameters& border,
                  const RecordingGauge& gauge);
  RecordingSystem(const RecordingProblem& problem, EffectParameters&& border,
                  const RecordingGauge& gauge) = delete;
  RecordingSystem(RecordingProblem&& problem, const EffectParameters& border,
                  const RecordingGauge& gauge) = delete;

  /// `coefficients` are the unknown ones. chi^2 (with priors), and with it r, J, M, A, B, D at
  /// these values. With headings held, a step moves positions (and coefficients) only.
  double linearise(const RecordingState& state, const Eigen::VectorXd& coefficients,
                   bool hold_headings = false);
  /// Segments' motions count as linear in the coefficients as long as these turn no segment by more
  /// than this since it was last reckoned, rad. An error e leaves a leg off by e^2/2 of its length.
  void set_slack(double turn) { slack_ = turn; }
  static constexpr double kFineSlack = 1e-6;   ///< what it is at first
  static constexpr double kRoughSlack = 1e-3;  ///< on the way to a fit
  /// Adds to A, until the next linearise, a symmetric matrix by what a measurement touches, in the
  /// order and the widths of node_rows: what Gauss and Newton leave out of chi^2's second
  /// derivatives. Zero by what is held.
  void add_curvature(std::size_t measurement, const Eigen::MatrixXd& curvature);
  /// Multiplies the information of each measurement from the next linearise on.
  void set_weights(const std::vector<double>& weights);

  struct Step {
    Eigen::VectorXd nodes;  ///< in the sparse system's order
    Eigen::VectorXd coefficients;
    double predicted = 0.0;  ///< decrease of chi^2 by the linear model
  };
  /// Solves with damping times the diagonal added. Throws NotPositiveDefinite (its column is -1
  /// where the coefficients are at fault).
  [[nodiscard]] Step solve_step(double damping = 0.0);

  [[nodiscard]] RecordingState moved(const RecordingState& state, const Step& step) const;

  /// Factorises A and S undamped, for what follows. Throws like solve_step.
  void factorise();
  /// Joint covariance of nodes and, after them, all coefficients. Zero where held.
  [[nodiscard]] Eigen::MatrixXd joint_covariance(const std::vector<int>& nodes) const;
  [[nodiscard]] Eigen::MatrixXd coefficient_covariance() const;
  /// Of each landmark alone, of each pose alone; zero where held. Cost: about two factorisations.
  [[nodiscard]] std::vector<Matrix2> landmark_covariances() const;
  /// rad^2, of each orientation alone.
  [[nodiscard]] std::vector<double> orientation_variances() const;
  [[nodiscard]] std::vector<Matrix3> pose_covariances() const;
  /// The landmarks' joint covariance times the columns of b, two rows per landmark.
  [[nodiscard]] Eigen::MatrixXd landmark_covariance_times(const Eigen::MatrixXd& b) const;
  /// Of the whole normal matrix, border included. Call after factorise.
  [[nodiscard]] double log_determinant() const;
  /// Inverse normal matrix (with border) times the columns of b (nodes, then coefficients).
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// A^-1 b, nodes only.
  [[nodiscard]] Eigen::MatrixXd solve_nodes(const Eigen::MatrixXd& b) const {
    return normal_.solve(b);
  }
  /// A^-1 B: by how much the nodes go the other way where a coefficient is one more. Call after
  /// factorise.
  [[nodiscard]] const Eigen::MatrixXd& nodes_by_coefficients() const { return A_inverse_B_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Where a measurement's rows begin in r and M; of one past the last, where those of all end.
  [[nodiscard]] int first_row(std::size_t measurement) const {
    return measurement < first_row_.size() ? first_row_[measurement] : measured_rows_;
  }
  [[nodiscard]] const Eigen::VectorXd& residuals() const { return residuals_; }
  [[nodiscard]] const Eigen::MatrixXd& border() const { return M_; }
  /// J'r, by the nodes.
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
  /// The square root of what a measurement's information counts.
  [[nodiscard]] double root_weight(std::size_t measurement) const {
    return root_weights_[measurement];
  }
  /// Squared whitened error of each measurement, as if all weights were 1; of one with heavy tails
  /// what is as unlikely (tail_deviance).
  [[nodiscard]] const std::vector<double>& squared_errors() const { return squared_errors_; }
  /// J'v and J x, J as linearised.
  [[nodiscard]] Eigen::MatrixXd transposed_times(const Eigen::MatrixXd& rows) const;
  [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& nodes) const;
  /// J as it is, rows x unknowns of normal_equations().
  [[nodiscard]] linalg::SparseMatrix rows_by_nodes() const;
  /// rows -= J nodes.
  void subtract_times(const Eigen::MatrixXd& nodes, Eigen::MatrixXd& rows) const;
  /// The columns less their projection on J: what landmarks and poses leave of them. Call after
  /// factorise.
  [[nodiscard]] Eigen::MatrixXd free_of_nodes(Eigen::MatrixXd columns) const;
  /// J's part of a measurement by the nodes that it touches: nodes of normal_equations().
  struct NodeRows {
    int node = -1;
    Eigen::MatrixXd rows;
  };
  [[nodiscard]] std::vector<NodeRows> node_rows(std::size_t measurement) const;
  /// Its part by the second node, rows x 3 (a landmark's third column is zero), held or not.
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 3> rows_by_to(std::size_t measurement) const {
    return J_[measurement].to.topRows(problem_.measurements[measurement].rows);
  }
  /// A measurement's rows of J and M as a dense matrix over all unknowns, transposed.
  [[nodiscard]] Eigen::MatrixXd transposed_rows(std::size_t measurement) const;

  [[nodiscard]] int unknowns() const;  ///< free ones, coefficients among them
  [[nodiscard]] const RecordingGauge& gauge() const { return gauge_; }
  [[nodiscard]] double gradient_norm() const;
  [[nodiscard]] linalg::BlockSystem& normal_equations() { return normal_; }
  [[nodiscard]] const linalg::BlockSystem& normal_equations() const { return normal_; }
  /// The Schur complement with its diagonal scaled by D's: 1 where a coefficient is independent of
  /// all else, 0 where it cannot be determined.
  [[nodiscard]] Eigen::MatrixXd scaled_schur() const;

 private:
  struct Whitened {
    RowsByNode from, to;
    std::vector<Vector4> states;  ///< of the measurement's noise terms
  };
  /// A node and a measurement's whitened rows by its unknowns.
  struct Link {
    int node;
    Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, 3> J;
  };
  /// A segment's four numbers with the effects, and where they were reckoned.
  struct Motion {
    Eigen::VectorXd at;  ///< offsets of the border; empty: never
    Vector4 value = Vector4::Zero();
    Eigen::Matrix<double, 4, Eigen::Dynamic> slopes{4, 0};
  };
  /// Of all that a measurement touches and that is not held.
  [[nodiscard]] std::vector<Link> links_of(std::size_t k) const;
  [[nodiscard]] int state_node(int state) const { return problem_.nodes() + state; }
  [[nodiscard]] int state_row(std::size_t state) const {
    return measured_rows_ + static_cast<int>(state);
  }
  /// Where the system is linearised, and what of each node it holds (held_unknowns.hpp).
  struct Point {
    const RecordingState& state;
    const Eigen::VectorXd& offsets;  ///< of the border
    const Eigen::VectorXd& noise;
    const std::vector<std::uint8_t>& held;
  };
  void linearise_measurement(std::size_t k, const Point& at);
  void linearise_states(const Eigen::VectorXd& states);
  void add_states_to_normal(std::size_t k, const Whitened& rows, const Vector4& error);
  void add_block(int node, const Eigen::MatrixXd& block);
  void add_block_between(int pair, const Eigen::MatrixXd& block);
  [[nodiscard]] Vector4 moved_by_effects(std::size_t k, const Eigen::VectorXd& offsets);
  [[nodiscard]] std::vector<std::uint8_t> held_nodes(bool hold_headings) const;
  void hold_unseen_orientations();
  void add_to_normal(std::size_t k, const Whitened& rows, const Vector4& error);
  void evaluate_effect_parameters(std::size_t k, const MeasurementRows& rows);
  /// J'v and J x for some columns.
  void add_transposed_times(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                            Eigen::Ref<Eigen::MatrixXd> result) const;
  void subtract_some(const Eigen::Ref<const Eigen::MatrixXd>& nodes,
                     Eigen::Ref<Eigen::MatrixXd> rows) const;
  void build_schur(double damping);
  template <int Size>
  [[nodiscard]] std::vector<Eigen::Matrix<double, Size, Size>> covariances(int first,
                                                                           int count) const;

  const RecordingProblem& problem_;
  const EffectParameters& border_;
  std::vector<int> unknown_;  ///< of the border
  RecordingGauge gauge_;
  std::vector<double> root_weights_;
  std::vector<int> first_row_;
  std::vector<int> pair_;        ///< of each measurement, -1: none
  std::vector<int> state_pair_;  ///< of each measurement: the first pair of its noise terms
  int step_pair_ = 0;            ///< the first of those between a state and the one before
  int measured_rows_ = 0;
  int rows_ = 0;
  linalg::BlockSystem normal_;
  std::vector<Whitened> J_;
  std::vector<Motion> motions_;  ///< per measurement, of segments; none without effects on drives
  double slack_ = kFineSlack;
  Eigen::MatrixXd M_;
  Eigen::VectorXd residuals_;
  std::vector<double> squared_errors_;
  Eigen::VectorXd gradient_;         ///< J'r
  Eigen::VectorXd border_gradient_;  ///< M'r and prior
  Eigen::MatrixXd B_;
  Eigen::MatrixXd D_;
  Eigen::MatrixXd A_inverse_B_;
  Eigen::MatrixXd schur_;
  Eigen::MatrixXd schur_inverse_;
};

}  // namespace trussmap::estimation
