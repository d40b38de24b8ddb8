// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// UMBmark: wheel diameters and wheelbase of a differential drive, from a square driven several
// times in both directions and a tape measure (Borenstein & Feng 1996).
//
//        ccw            start at (0, 0), heading +x; error = absolute - calculated, in these axes
//     +--<--+           L      side                                                   m
//     v     ^           b      wheelbase that the robot calculates with               m
//     o-->--+           alpha  what a quarter turn lacks; > 0: wheels wider than b    rad
//                       beta   turn to the left over one leg; > 0: right wheel larger rad
//
//   E_d   D_R / D_L, ratio of the actual wheel diameters, right over left             -
//   E_b   actual over nominal wheelbase                                               -
//   c_L   factor for the left wheel's travel,  2 / (E_d + 1)                          -
//   c_R   factor for the right wheel's travel, 2 / (1/E_d + 1) = E_d c_L              -
//
//   E_s   average of the actual wheel diameters over the nominal one                  -
//
// The factors' mean is E_s, which a tape along a straight drive gives and squares do not: a closed
// path closes at any size (their 2.2, 2.3, 2.4, 4.29-4.33). They measure and correct it beforehand,
// and E_s is 1 then. Turns on the spot cannot tell larger wheels from a smaller wheelbase: where
// E_s is not corrected, squares give E_b / E_s, and both are needed.
//
// For small angles (their 4.10a, 4.20, 4.22, 4.24 repaired), with x and y of the centres of
// gravity:
//   cw centre   (-2L(alpha + beta), -2L(alpha + beta))
//   ccw centre  (-2L(alpha - beta),  2L(alpha - beta))
//   alpha = mean of (x_cw + x_ccw), (y_cw - y_ccw), over -4L
//   beta  = mean of (x_cw - x_ccw), (y_cw + y_ccw), over -4L
//   E_d = (L + b sin(beta/2)) / (L - b sin(beta/2)),   E_b = (pi/2) / (pi/2 - alpha)
// Chong & Kleeman (1997) print pi/(pi - alpha) for E_b, which removes half of the error.
//
// The formulas drop second-order terms: at E_d = 1.005 and E_b = 1.01 some 2 % of the error is left
// for a second round. The exact solution fits E_d and E_b to the kinematics, by least squares on
// the four coordinates of the centres, and needs no second round on that account. Standard errors
// follow from the scatter of the runs, whatever its distribution; without scatter there are none.
//
// Headings. Their "measure the position (and, optionally, orientation)": each turn lacks alpha and
// each leg turns by beta, so that the return orientation errors are, exactly,
//   cw  4 (beta + alpha),   ccw  4 (beta - alpha)
//   alpha = (cw - ccw) / 8,   beta = (cw + ccw) / 8,   E_b = E_s (pi/2) / (pi/2 - alpha)
//   E_d = (1 + q) / (1 - q),   q = beta b E_b / (2 L E_s)
// which checks alpha and beta by a measurement of another kind.
//
// Four coordinates determine two unknowns, so two combinations of them are left to contradict.
// Exchanged labels cw/ccw do so in a way of their own: alpha from x and alpha from y get opposite
// signs, and so do the betas. An axis y that points to the right does the same.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/test_path.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

/// A number with how sure it is: the standard error, and the degrees of freedom behind that error.
struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;
  double dof = 0.0;  ///< 0: there is no scatter to judge by, or none was needed
};

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Two-sided interval by Student's t. `confidence` in (0, 1).
[[nodiscard]] Interval confidence_interval(const Estimate& estimate, double confidence = 0.95);

/// Mean of a sample of plane vectors, and its covariance (scatter / n).
struct SampleMean {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  int count = 0;
};

/// The systematic errors of a differential drive, and what undoes them.
struct GeometryErrors {
  double diameter_ratio = 1.0;   ///< E_d
  double wheelbase_ratio = 1.0;  ///< E_b
  double scale = 1.0;            ///< E_s

  [[nodiscard]] double left_factor() const { return scale * 2.0 / (diameter_ratio + 1.0); }
  [[nodiscard]] double right_factor() const { return diameter_ratio * left_factor(); }
};

/// What is found by a robot that already corrects for `in_force`, on top of that: ratios multiply.
[[nodiscard]] GeometryErrors combined(const GeometryErrors& in_force, const GeometryErrors& found);

/// The effects `wheel scale` (channel wheels, E_s - 1), `wheel diameter ratio` (channel difference,
/// 2 E_s (E_d - 1)/(E_d + 1)) and `wheelbase` (channel turn, E_s/E_b - E_s: effects add up) of the
/// model; 1 where it has none. Throws std::invalid_argument where one of them has another channel
/// or shape than these.
[[nodiscard]] GeometryErrors geometry_errors(const Model& model);

/// The model corrected by them: its wheelbase times E_b in [robot], the wheels' ratio and scale as
/// effects, in place of what it said of them; an effect `wheelbase` that it had stays with 0, and
/// there is one with 0 where it had none, so that a fit shows what is left.
[[nodiscard]] Model with_geometry(Model model, const GeometryErrors& errors);

/// Puts them into the model, in place of what it said of them; no `wheel scale` where it had none
/// and E_s is 1.
void set_geometry_errors(Model& model, const GeometryErrors& errors);

/// How a path's end differs from what the robot calculates (absolute - calculated), exactly.
struct PathError {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< m, m, rad
  /// d error / d (E_d, E_b), at this E_s.
  Eigen::Matrix<double, 3, 2> jacobian = Eigen::Matrix<double, 3, 2>::Zero();
};

/// A robot drives the path exactly by its own odometry, which takes the wheels as equal and the
/// wheelbase as `wheelbase` [m]; its true geometry is off by `errors`.
[[nodiscard]] PathError path_error(const TestPath& path, double wheelbase,
                                   const GeometryErrors& errors);

/// End errors (absolute - calculated), m, in the frame of the start.
struct SquareRuns {
  std::vector<Eigen::Vector2d> cw;
  std::vector<Eigen::Vector2d> ccw;
  /// Return orientation errors, counter-clockwise, rad: one per run, or none in both directions.
  std::vector<double> cw_headings = {};
  std::vector<double> ccw_headings = {};
};

/// A straight drive beside a tape.
struct StraightRun {
  double measured = 0.0;  ///< m, from where the axle's centre started to where it stopped
  double reported = 0.0;  ///< m, by the odometry
};

/// E_s by least squares on measured = E_s reported, the tape's error alike in all runs; one run has
/// no standard error. `turn_per_metre` [rad/m]: what the robot turned while it believed that it
/// drove straight on; the tape is the chord of that arc. Throws std::invalid_argument on no run, on
/// lengths not above 0, and on a turn of a whole circle or more.
[[nodiscard]] Estimate wheel_scale(const std::vector<StraightRun>& runs,
                                   double turn_per_metre = 0.0);

struct SquareSetup {
  double side = 4.0;                 ///< m
  double wheelbase = 0.34;           ///< m, that the robot calculated with
  Estimate scale = {1.0, 0.0, 0.0};  ///< E_s that was not corrected while driving
};

/// What the runs say before any model of the robot.
struct SquareClusters {
  SampleMean cw;            ///< centre of gravity, m
  SampleMean ccw;           ///< m
  Estimate largest_offset;  ///< E_max,syst: distance of the farther centre from 0, m
  double sem = 0.0;  ///< standard error of a centre's coordinate (mean square of the four), m
  /// E_max,syst exceeds three standard errors: correcting it again can be seen to help.
  bool second_round_worthwhile = false;
};

/// Throws std::invalid_argument on fewer than two runs in a direction.
[[nodiscard]] SquareClusters square_clusters(const SquareRuns& runs);

/// alpha and beta from x alone and from y alone: they agree where E_d and E_b are all there is.
struct SquareAngles {
  Estimate alpha_x, alpha_y;  ///< rad
  Estimate beta_x, beta_y;    ///< rad
};

[[nodiscard]] SquareAngles square_angles(const SquareClusters& clusters, double side);

struct SquareSolution {
  Estimate alpha;            ///< rad
  Estimate beta;             ///< rad
  Estimate diameter_ratio;   ///< E_d
  Estimate wheelbase_ratio;  ///< E_b
  Estimate left_factor;      ///< c_L
  Estimate right_factor;     ///< c_R
  Estimate wheelbase;        ///< corrected, m

  double scale = 1.0;  ///< E_s, as given

  [[nodiscard]] GeometryErrors errors() const {
    return {diameter_ratio.value, wheelbase_ratio.value, scale};
  }
};

/// The papers' formulas. Throws SolveError where they have no answer (a turn of 90 degrees or more
/// missing, or a wheel ratio of 0).
[[nodiscard]] SquareSolution umbmark(const SquareClusters& clusters, const SquareSetup& setup);

/// E_d and E_b by Gauss-Newton on the exact kinematics. Throws SolveError where that does not
/// converge: errors as large as the square.
[[nodiscard]] SquareSolution solve_square(const SquareClusters& clusters, const SquareSetup& setup);

/// What the return orientations say, beside the positions.
struct SquareHeadings {
  Estimate cw, ccw;          ///< mean orientation errors, rad
  double largest = 0.0;      ///< the larger of both, as E_max,syst is of positions, rad
  Estimate alpha;            ///< rad
  Estimate beta;             ///< rad
  Estimate diameter_ratio;   ///< E_d
  Estimate wheelbase_ratio;  ///< E_b
  /// Headings less positions (the exact solution). The same runs give both, so that their standard
  /// errors are of the differences run by run.
  Estimate alpha_excess, beta_excess;  ///< rad
  /// Probability of excesses as large by the scatter of the runs alone; NaN without scatter.
  double p_value = 0.0;
};

/// None where the runs have no headings. `exact`: solve_square of these runs. Throws
/// std::invalid_argument where there is not one heading per run; SolveError where a heading error
/// is so large that no wheelbase explains it.
[[nodiscard]] std::optional<SquareHeadings> square_headings(const SquareRuns& runs,
                                                            const SquareSetup& setup,
                                                            const SquareSolution& exact);

/// Where headings and positions contradict each other, a sentence.
[[nodiscard]] std::vector<std::string> heading_doubts(const SquareHeadings& headings);

/// Whether the centres can be what they are said to be.
struct SquareConsistency {
  double residual = 0.0;  ///< root mean square of what the exact solution leaves of the centres, m
  double residual_exchanged = 0.0;  ///< the same with cw and ccw exchanged, m
  /// Probability of a contradiction as large by the scatter of the runs alone; NaN without scatter.
  double p_value = 0.0;
};

[[nodiscard]] SquareConsistency square_consistency(const SquareClusters& clusters,
                                                   const SquareSetup& setup);

/// Doubts, a sentence each, that a person can act on: exchanged labels, a contradiction, runs all
/// equal, millimetres.
[[nodiscard]] std::vector<std::string> square_doubts(const SquareClusters& clusters,
                                                     const SquareSetup& setup);

/// Runs that end far from the others of their direction (ten times as far as those scatter), a
/// sentence each: a wrong label, a slip, a misread tape. Nothing where a direction has fewer
/// than 4.
[[nodiscard]] std::vector<std::string> square_outliers(const SquareRuns& runs);

/// A round: runs driven with the corrections of all rounds before, and what they call for.
struct SquareRound {
  SquareRuns runs;
  SquareSetup setup;        ///< with the wheelbase that the robot calculated with
  GeometryErrors in_force;  ///< corrected for while driving
  SquareClusters clusters;
  SquareAngles angles;
  SquareSolution exact;
  SquareSolution formulas;
  SquareConsistency consistency;
  std::optional<SquareHeadings> headings;  ///< where they were measured
  std::vector<std::string> doubts;         ///< square_doubts, square_outliers and heading_doubts
};

/// Throws as the functions above do. Where the centres, or headings and positions, contradict each
/// other, both solutions' standard errors hold what that leaves, too: two of the four coordinates
/// are free to contradict, which is two degrees of freedom.
[[nodiscard]] SquareRound analyse_round(SquareRuns runs, const SquareSetup& setup,
                                        const GeometryErrors& in_force = {});

enum class SquareMethod { exact, formulas };

/// What the robot's software should use after a round: what was in force, times what was found.
struct SquareCorrections {
  GeometryErrors errors;
  Estimate wheelbase;     ///< m
  Estimate left_factor;   ///< c_L of the product, E_s in it
  Estimate right_factor;  ///< c_R of the product
};

[[nodiscard]] SquareCorrections corrections_after(const SquareRound& round, SquareMethod method);

/// Drives a round, or reads one: `setup` and `in_force` are what the robot works with.
using DriveRound = std::function<SquareRuns(std::size_t round, const SquareSetup& setup,
                                            const GeometryErrors& in_force)>;

/// Round after round, each with the corrections that the method found in those before.
/// `wheelbase`: nominal, m; `in_force`: corrected for in the first round. `straight`: runs beside a
/// tape with the first round's settings; where there are any, the rounds after it are driven with
/// E_s corrected as well.
[[nodiscard]] std::vector<SquareRound> square_rounds(std::size_t count, double side,
                                                     double wheelbase,
                                                     const GeometryErrors& in_force,
                                                     SquareMethod method, const DriveRound& drive,
                                                     const std::vector<StraightRun>& straight = {});

/// Of all rounds; named by their round where there are several.
[[nodiscard]] std::vector<std::string> all_doubts(const std::vector<SquareRound>& rounds);

/// What one direction alone hides (Borenstein & Feng 1996, Fig. 4): a robot with both errors, its
/// wheelbase alone tuned until the square closes in one direction.
struct OneWayTuning {
  double wheelbase_ratio = 1.0;  ///< tuned over nominal wheelbase
  double error_before = 0.0;     ///< m, in the direction driven
  double error_same_way = 0.0;   ///< m, after tuning, in the direction driven
  double error_other_way = 0.0;  ///< m, after tuning, in the other
};

[[nodiscard]] OneWayTuning tune_one_way(const GeometryErrors& errors, const SquareSetup& setup,
                                        Direction driven);

/// What another path alone hides, the figure-eight for instance (their 3.1): the wheelbase tuned
/// until the path's end error is least.
struct PathTuning {
  double wheelbase_ratio = 1.0;  ///< tuned over nominal wheelbase
  double error_before = 0.0;     ///< m, at the end of the path
  double error_after = 0.0;      ///< m, there, after tuning
  double square_cw = 0.0;        ///< m, at the end of a square after tuning
  double square_ccw = 0.0;       ///< m
};

[[nodiscard]] PathTuning tune_by_path(const GeometryErrors& errors, const SquareSetup& setup,
                                      const TestPath& path);

struct PathAlone {
  std::string path;  ///< as text
  PathTuning tuned;
};

// Single motions beside a tape and a protractor: straight runs, turns on the spot, rests.
//
//   tape T of a run that odometry has as D         T = E_s D sin(h/2)/(h/2)   h: turned, rad
//   turn theta that odometry has as phi            theta = r phi,             r = E_s / E_b
//   turn h of a run that odometry has as straight  h = r 2 q D / b,           E_d = (1 + q)/(1 - q)
//   gyro's turn G of a turn or a rest of t seconds theta = (1 + s) G - g t    s: gyro_scale, g:
//   gyro
//
// each by least squares through the origin. A tape shows no E_d: a run that ends aside bends, or
// was set off askew, y = L theta_0 + L^2 h/(2 D). Where no tape gives E_s, turns give E_b for 1.

enum class TapedKind { straight, spin, rest };

/// kAbsent: not measured. Angles counter-clockwise.
struct TapedRun {
  TapedKind kind = TapedKind::straight;
  double expected = 0.0;         ///< m, start to stop by the tape; rad by the protractor; 0 at rest
  double odometry = 0.0;         ///< m; rad
  double heading = kAbsent;      ///< rad turned on a straight run, less what the odometry says
  double aside = kAbsent;        ///< m to the left of where a straight run was aimed
  double gyro = kAbsent;         ///< rad, of a turn or a rest
  double seconds = kAbsent;      ///< s
  double sd = kAbsent;           ///< of `expected`, as the next four of one run, each its own error
  double sd_odometry = kAbsent;  ///< m; rad
  double sd_heading = kAbsent;   ///< rad
  double sd_gyro = kAbsent;      ///< rad
  double sd_start = kAbsent;     ///< rad, of where a straight run was aimed, alike in all runs
  std::size_t line = 0;          ///< of its table, for messages; 0: none
};

/// What runs beside a tape say, on top of what the robot corrects for. An estimate without degrees
/// of freedom has no standard error.
struct TapeCalibration {
  int straight_runs = 0;
  int turns = 0;
  int rests = 0;
  std::optional<Estimate> scale;            ///< E_s
  std::optional<Estimate> turn_factor;      ///< r, true turns over odometry's
  std::optional<Estimate> diameter_ratio;   ///< E_d
  std::optional<Estimate> wheelbase_ratio;  ///< E_b; E_b / E_s without straight runs
  std::optional<Estimate> gyro_scale;       ///< s
  std::optional<Estimate> gyro_bias;        ///< g, rad/s
  std::vector<std::string> look_alikes;     ///< effects that these turns do not tell from E_b
  std::vector<std::string> undetermined;    ///< what was not determined, and why
  std::vector<std::string> doubts;          ///< runs that contradict each other: errors are wider
  std::vector<std::string> notes;           ///< what would make it surer
};

/// `wheelbase`: that the robot calculates with, m. Throws std::invalid_argument on no run, on a
/// wheelbase, length or turn that is 0, a length below 0, and numbers that are not finite.
[[nodiscard]] TapeCalibration calibrate_by_tape(const std::vector<TapedRun>& runs,
                                                double wheelbase);

/// What was found, on top of what the model has: as set_geometry_errors, without effects for what
/// was not determined, and the effects `gyro scale` and `gyro bias`. Throws like geometry_errors.
void set_taped(Model& model, const TapeCalibration& found);

/// A constant in its owner's figures.
struct TapedConstant {
  std::string name;     ///< "wheelbase", "left wheel", "right wheel", "wheels", "gyro scale", ...
  double before = 0.0;  ///< m; what travels and gyro's turns are multiplied by; rad/s taken off
  Estimate now;
  std::string unit;
};

/// What `model` corrected for, and what it should from now on, of all that was determined. Throws
/// like set_taped.
[[nodiscard]] std::vector<TapedConstant> taped_constants(const Model& model,
                                                         const TapeCalibration& found);

/// What to make of it. `unsure`: nothing that was found has a standard error.
enum class TapeVerdict { worth_correcting, nothing_to_correct, unsure, doubtful };
[[nodiscard]] TapeVerdict tape_verdict(const TapeCalibration& found);
/// More than three standard errors from `nominal`.
[[nodiscard]] bool is_off(const std::optional<Estimate>& one, double nominal);

}  // namespace trussmap
