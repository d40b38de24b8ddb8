// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The fit of many sessions, each of them but a quadratic (session_summary.hpp): a further one costs
// what it costs itself, a few factorisations of the sum, and those that are relinearised.
//
//   x        all landmarks, orientations and coefficients
//   Phi(x)   sum of phi_s(x) over the sessions + survey + priors of the coefficients
//
//   add      the new session's rows are taken at x; the sum's minimum is the next x, at which what
//            moved is relinearised:
//
//     x <- x - H^-1 G(x)          H, G the sums of the summaries
//     session s was taken at x_s, and its summary misses its gradient at x by about
//         e_s (q/q_s),   q = (x - x_s)' diag(H_s) (x - x_s)
//     of which e_s, q_s are known from a trial, a move drawn from x's own uncertainty at which the
//     session's gradient is reckoned exactly, or from the last time that it was relinearised, where
//     that was worse. Sessions whose H^-1 e_s (q/q_s) add up to more than the tolerance are taken
//     anew at x, the largest first, until the rest is below it.
//
// So the result is that of the adjustment of all sessions at once (recording_adjustment.hpp) to
// about the tolerance. What a summary misses goes with the square of the move, so how far the map
// may move before old sessions are relinearised goes with the root of the tolerance: of a map good
// to 2 mm most are at every add for 1e-8 m, hardly any for 1e-7 m.
//
// The frame is the first session's: where nothing measures a position its first landmark is held,
// and where nothing measures a direction the coordinate that turning the map (about that landmark,
// or the place that is known) moves most. (Held by a heading, as a fit of all at once is, the map
// would turn by far more than it changes its shape, and nothing but that would have every session
// relinearised.)
#pragma once

#include "estimation/session_summary.hpp"
#include "linalg/dense.hpp"
#include "trussmap/recording.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::estimation {

struct SummaryOptions {
  double tolerance = 1e-8;  ///< of the result by what summaries miss: m, rad, units of coefficients
};

/// A place that is known beside the sessions; a landmark that none has sighted counts not yet.
struct KnownPlace {
  std::string landmark;
  Vector2 place = Vector2::Zero();  ///< m, map frame
  double sd = 0.0;                  ///< m per coordinate; infinite: the heading alone is known
  double heading = kAbsent;         ///< rad, of the landmark's own axis; NaN: not known
  double sd_heading = 0.0;          ///< rad
};

class SummarisedSessions {
 public:
  explicit SummarisedSessions(const SummaryOptions& options = {}) : options_(options) {}

  /// Takes a session in; the known places count beside the sessions, the same numbers once. The
  /// state of the session is near the map's where both have a landmark, and in its frame: nothing
  /// of it may give a position or direction where the first session left one to be held. Throws
  /// SolveError where the sum has no minimum or neither truth, two places (landmarks, fixes) nor
  /// one and a direction tie the session to the map, std::invalid_argument where its coefficients
  /// are others; whatever is thrown, all is then as it was.
  void add(SessionRows rows, const std::vector<KnownPlace>& known = {});

  [[nodiscard]] int sessions() const { return static_cast<int>(sessions_.size()); }
  /// In order of first sighting.
  [[nodiscard]] const std::vector<std::string>& landmarks() const { return sum_.names; }
  [[nodiscard]] bool has(const std::string& landmark) const {
    return sum_.number.contains(landmark);
  }
  [[nodiscard]] Vector2 position(int landmark) const {
    return sum_.x.segment<2>(sum_.at[idx(landmark)]);
  }
  [[nodiscard]] bool has_orientation(const std::string& landmark) const {
    return has(landmark) && sum_.orientation.contains(sum_.number.at(landmark));
  }
  /// rad, not wrapped; nothing where no yaw was read.
  [[nodiscard]] std::optional<double> orientation(int landmark) const;
  /// The unknown ones.
  [[nodiscard]] Eigen::VectorXd coefficients() const { return sum_.x.head(sum_.coefficients); }
  /// Of the measurements and the coefficients' priors, as the summaries have it.
  [[nodiscard]] double chi2() const;
  /// Measured values less unknowns.
  [[nodiscard]] int dof() const;
  /// Of each landmark alone, m^2; zero where held.
  [[nodiscard]] std::vector<Matrix2> landmark_covariances() const;
  [[nodiscard]] Eigen::MatrixXd coefficient_covariance() const;
  /// How often a session was relinearised by the last add, the new one's own times apart.
  [[nodiscard]] int relinearised() const { return sum_.relinearised; }
  /// Largest difference that one exact step from here would make: what is really left. Takes every
  /// session's gradient: for checks.
  [[nodiscard]] double exact_error();

 private:
  /// A session, and what its summary is known to miss.
  struct Member {
    SessionSummary summary;
    std::vector<Eigen::Index> at;  ///< in x, of each of its shared unknowns
    Eigen::VectorXd missed;        ///< by a trial move, of the gradient
    double trial = 0.0;            ///< the move's q
    /// What it was before the session that is being added, where it has been relinearised since.
    struct Before {
      SessionSummary::Taken taken;
      Eigen::VectorXd missed;
      double trial = 0.0;
    };
    std::optional<Before> before = std::nullopt;
  };

  /// What the sessions and all that is known beside them add up to.
  struct Sum {
    std::vector<std::string> names;
    std::map<std::string, int> number;        ///< of a landmark
    std::vector<Eigen::Index> at;             ///< in x, of each landmark
    std::map<int, Eigen::Index> orientation;  ///< in x, of a landmark
    std::vector<KnownPlace> known;
    Eigen::VectorXd x;       ///< coefficients, then what was met, in order
    Eigen::VectorXd origin;  ///< x as first met: differences from it keep their digits
    int coefficients = 0;
    Eigen::VectorXd prior;           ///< information of each coefficient
    std::vector<Eigen::Index> held;  ///< places in x
    Eigen::MatrixXd information;     ///< H
    Eigen::VectorXd pull;            ///< G(x) = H (x - origin) - pull
    int relinearised = 0;
  };

  void require_tied(const SessionRows& rows, const std::vector<KnownPlace>& known) const;
  void begin(const EffectParameters& border);
  void know(const std::vector<KnownPlace>& known);
  void take_in(SessionRows rows, const std::vector<KnownPlace>& known);
  void go_back(Sum before, std::size_t sessions);
  void hold(bool position, bool direction);
  [[nodiscard]] Eigen::VectorXd turn_of_map(bool position) const;
  [[nodiscard]] Member joined(SessionRows rows);
  [[nodiscard]] Eigen::VectorXd local(const Member& member) const;
  void count(const Member& member, double sign);
  void count_known();
  void count_all();
  void take_anew(Member& member, SecondDerivatives kind);
  void take_anew(Member& member, const linalg::DenseCholesky& factor);
  [[nodiscard]] double effect_of(const Member& member, const Eigen::VectorXd& missed,
                                 const linalg::DenseCholesky& factor) const;
  void try_out(Member& member, const linalg::DenseCholesky& factor);
  [[nodiscard]] std::vector<Eigen::Index> apart() const;
  [[nodiscard]] linalg::DenseCholesky factor() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;
  [[nodiscard]] linalg::DenseCholesky safe_factor();
  [[nodiscard]] Eigen::VectorXd step(const linalg::DenseCholesky& factor) const;
  [[nodiscard]] std::vector<double> effects_of_moves(const linalg::DenseCholesky& factor) const;
  [[nodiscard]] std::vector<std::size_t> worth_taking_anew(const std::vector<double>& effects,
                                                           double safety) const;
  [[nodiscard]] bool take_wholly();
  void settle();

  SummaryOptions options_;
  std::vector<Member> sessions_;
  Sum sum_;
};

}  // namespace trussmap::estimation
