// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise that lasts, in the adjustment: every process has states of its own, further unknowns with
// a prior, so that all stays as sparse as the drive is long.
//
//   g(t)    what the process adds to its channel's g: sd times a process of variance 1
//   z_k     that unit process at the k-th instant where something is measured (correlated, walk),
//           or over the k-th leg, session or pass
//
//   z_k = phi z_(k-1) + eta_k        a row of its own:  (z_k - phi z_(k-1))/sd(eta_k) ~ N(0, 1)
//   Ornstein-Uhlenbeck   phi = exp(-x), var eta = 1 - phi^2,   x = lag/length
//   walk                 phi = 1,       var eta = lag
//   constant             phi = 0,       var eta = 1
//
// A segment's numbers hold the process row by row, each row its mean over the row. With c_i what a
// unit of g in row i adds to them, e = sum c_i g_i is, given the states at the segment's ends,
//
//   e ~ N(K_from z_from + K_to z_to, sd^2 within)
//
// whose moments one pass over the rows gives (Kalman's recursion, the rows' means integrated
// exactly). So the measurement keeps its four rows: the states' columns and a larger covariance are
// all that it gets. Nothing is approximated but that the c_i are those of the motion as recorded.
//
// After eliminating the states this is generalised least squares under the whole correlated
// covariance (Henderson's mixed model equations, 1950).
#pragma once

#include "estimation/process_moments.hpp"
#include "estimation/recording_problem.hpp"
#include "trussmap/model.hpp"

#include <map>
#include <vector>

namespace trussmap::estimation {

inline constexpr double kLongestGap = 5.0;  ///< s: a landmark unseen for longer is met anew

/// Ends of a session's legs, s, ascending.
[[nodiscard]] std::vector<double> ends_of_legs(const DrivenRecording& recording);
/// The leg that time t lies in: how many have ended before.
[[nodiscard]] int leg_at(const std::vector<double>& ends, double t);
/// What rows add up to in each leg, the first of which begins at `from`, s: a row is of the leg
/// that its middle lies in, for a rest within a segment parts two.
[[nodiscard]] std::map<int, Vector4> sums_by_leg(const std::vector<SegmentRow>& rows,
                                                 const std::vector<Vector4>& c, double from,
                                                 const std::vector<double>& ends);

/// One process for sd = 1, laid over a problem.
struct LaidProcess {
  std::vector<NoiseState> states;             ///< `previous` counts from the process's first
  std::vector<std::vector<NoiseTerm>> terms;  ///< per measurement
  std::vector<Matrix4> within;                ///< per measurement, in its values
};

/// How a unit of g of a channel that acts on drives or readings changes the rows' four numbers.
[[nodiscard]] std::vector<Vector4> unit_columns(const MotionRows& drive,
                                                const std::vector<SegmentRow>& rows,
                                                const std::vector<Matrix4>& influences,
                                                Channel channel, const Robot& robot);

/// How a unit of g of a channel changes a gyro's numbers, row by row; weights as in
/// gyro_excess.hpp.
[[nodiscard]] std::vector<Vector4> unit_excesses(const MotionRows& drive,
                                                 const std::vector<SegmentRow>& rows,
                                                 const std::vector<Vector4>& weights,
                                                 Channel channel, const Robot& robot);

/// Keeps references to problem and recordings. The rows' influences are reckoned once.
class ProcessLayer {
 public:
  ProcessLayer(const RecordingProblem& problem, const std::vector<DrivenRecording>& recordings,
               const Robot& robot);

  /// Empty where the channel acts on nothing that is measured.
  [[nodiscard]] LaidProcess lay(Channel channel, ProcessKind process, double length) const;

 private:
  const RecordingProblem& problem_;
  const std::vector<DrivenRecording>& recordings_;
  Robot robot_;
  std::vector<std::vector<Matrix4>> influences_;  ///< per segment and row
};

/// Takes the model's processes into a problem: states, terms, and whiteners with what lasts within
/// each measurement. A process that acts on nothing measured adds nothing.
void add_processes(RecordingProblem& problem, const std::vector<DrivenRecording>& recordings,
                   const Model& model);

/// Takes the processes into the problem instead of those that it has: states, terms and `within`.
/// Whiteners stay as they are. One laid process per sd.
void put_processes(RecordingProblem& problem, const std::vector<LaidProcess>& laid,
                   const std::vector<double>& sds);

/// What one unit of a term's state adds to a measurement's error (predicted - measured).
[[nodiscard]] Vector4 error_by(const Measurement& measurement, const effects::ByView& by_view,
                               const NoiseTerm& term);

/// What the states add to a segment's four numbers.
[[nodiscard]] Vector4 lasting_in_segment(const RecordingProblem& problem, std::size_t measurement,
                                         const Eigen::VectorXd& states);
/// A view with what the states add to it. Its derivatives are to be taken there.
[[nodiscard]] effects::ViewPattern lasting_in_view(const RecordingProblem& problem,
                                                   std::size_t measurement,
                                                   const effects::ViewPattern& view,
                                                   const Eigen::VectorXd& states);

/// Of each state, where nothing is known of it.
[[nodiscard]] std::vector<double> state_variances(const RecordingProblem& problem);

/// Covariance that the states add to a segment's values, where nothing is known of them.
[[nodiscard]] Matrix4 segment_prior_covariance(const RecordingProblem& problem,
                                               const std::vector<double>& variances,
                                               std::size_t measurement);

}  // namespace trussmap::estimation
