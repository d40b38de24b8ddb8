// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Wheels, wheelbase and wheel noise from recordings with truth, fixes, a survey, or a second
// odometer's motions (loops between poses that are apart): least squares over all that was
// measured.
//
//   E_d   right over left wheel diameter     effect `difference`, g = 2 (E_d - 1)/(E_d + 1)   -
//   E_b   actual over nominal wheelbase      effect `turn`,       g = 1/E_b - 1               -
//   E_s   true over measured travel          effect `wheels`,     g = E_s - 1                 -
//   k     wheel noise: variance of a wheel's travel = k^2 |travel|                      m^(1/2)
//
// Of drives with other wheels than a left and a right one, each drive's own constants instead: g of
// every wheel (channel wheel1 ...) and of `turn`, with `omni3` and `mecanum` of `sideways`, with
// `omni3` of `creep`; or of `steer`, `turn`, `wheels` and `steer_gain` where a wheel is steered
// (from several gains on, where the stated one is off by far). Their wheels' noise stays as the
// model states it.
//
// E_d, E_b and E_s are parameters of the adjustment, beside poses and landmarks; rows are corrected
// and fitted again until the parameters no longer change. k_L and k_R maximise the restricted
// likelihood (Patterson & Thompson 1971), which does not mistake the fit's degrees of freedom for
// low noise:
//
//   -2 log L = sum log det C + log det (J' C^-1 J) + chi^2       C, J: covariance and Jacobian
//
// All other noise is as the model states it. A parameter whose standard error would exceed 0.1 is
// reported as undetermined (of a steering's gain, 0.03 of it).
//
// How truth and fixes are mounted and clocked is estimated with the wheels (TruthAlignment,
// FixAlignment): rows that are late, or whose clock drifts, look like wheel errors otherwise. So is
// the place of a sensor that sees landmarks from afar, and of the scanner whose motion loops tell
// (Censi, Franchi, Marchionni & Oriolo 2013), from where the model states them: what is found goes
// back into Robot::mounted.
//
// Fails where the truth contradicts the wheels: with headings turned by more than about 90 degrees,
// or counted clockwise, the least chi^2 lies at a negative wheelbase or travel. No robot has that,
// so it is refused, and the message says how the headings lie to the direction of travel.
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/umbmark.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

struct CalibrationOptions {
  bool survey = true;    ///< use surveyed landmark positions
  bool truth = true;     ///< use truth rows
  bool fixes = true;     ///< use fixes
  bool noise = true;     ///< estimate k_L and k_R as well
  double holdout = 0.3;  ///< share of the legs that validate_calibration holds out; 0: none
  double leg = 1.0;      ///< m of driven path, length of such a leg
  /// Standard deviations by which a sighting, fix or loop contradicts all others and is left out,
  /// where these fit far better without the few that do; 0: none is.
  double gate = kModelGate;
};

/// An estimate and its standard error.
struct Calibrated {
  double value = 1.0;
  double sd = 0.0;
};

/// The clock of one session's truth.
struct TruthClock {
  double late = 0.0;   ///< s: rows are stamped late by this at `start`
  double drift = 0.0;  ///< s/s: and by so much more per second
  double start = 0.0;  ///< s, where the session's drive starts
};

/// How the truth is mounted on the robot, and how its clocks run.
struct TruthAlignment {
  double ahead = 0.0;                ///< m, tracked point from the axle's centre, robot axes
  double left = 0.0;                 ///< m
  double heading = 0.0;              ///< rad, the truth's heading less the robot's
  std::map<int, TruthClock> clocks;  ///< by session; none where no truth was used
};

/// Which point of the robot fixes are of, and how late they are.
struct FixAlignment {
  double ahead = 0.0;          ///< m, the antenna from the axle's centre, robot axes
  double left = 0.0;           ///< m
  std::map<int, double> late;  ///< s, by session; none where no fix was used
};

/// Where a sensor was found to sit, as Mountings have it; nothing of what the motion does not tell.
struct CalibratedMounting {
  std::string of;                      ///< "sensor", "antenna", "tracked" or "scanner"
  std::optional<Calibrated> x = {};    ///< m ahead of the axle's centre
  std::optional<Calibrated> y = {};    ///< m to its left
  std::optional<Calibrated> yaw = {};  ///< rad
};

/// A constant of a drive with other wheels than two: g of its channel, with the shape 1.
struct DriveConstant {
  Channel channel = Channel::turn;
  Calibrated g;  ///< in the channel's unit; 0: as the model has it
};

struct WheelCalibration {
  std::optional<Calibrated> diameter_ratio;   ///< E_d; none: the motion does not determine it
  std::optional<Calibrated> wheelbase_ratio;  ///< E_b
  std::optional<Calibrated> scale;            ///< E_s
  std::optional<Calibrated> noise_left;       ///< k_L, m^(1/2)
  std::optional<Calibrated> noise_right;      ///< k_R, m^(1/2)
  std::vector<DriveConstant> constants;       ///< of other drives than differential, instead
  Model model;                                ///< the given one with all of that in it
  TruthAlignment truth;
  FixAlignment fixes;
  std::vector<CalibratedMounting> mountings =
      {};  ///< of the sensors that measured; in the model, too
  double chi2 = 0.0;
  int dof = 0;
  /// False where the last round still moved an estimate by more than a tenth of its standard error:
  /// the recordings contradict wheels that differ in these figures alone, which then mean little.
  bool settled = true;
  /// Of all that were determined, in the order in which they correct the wheels, one after the
  /// other: channel, g with the shape 1, and the covariance of these.
  std::vector<Channel> channels = {};
  Eigen::VectorXd g = {};
  Eigen::MatrixXd covariance = {};
  std::vector<std::string> undetermined;  ///< what was not determined, and why
  /// Sightings, fixes and loops that contradict all others; nothing is made of them.
  std::vector<std::string> left_out = {};
};

/// Effects of `model` other than the three are taken out of the recordings first. Throws SolveError
/// where nothing can be determined or a ratio such as E_b is not positive, std::invalid_argument on
/// effects that cannot be applied.
[[nodiscard]] WheelCalibration calibrate_wheels(const std::vector<DrivenRecording>& recordings,
                                                const Model& model,
                                                const CalibrationOptions& options = {});
[[nodiscard]] inline WheelCalibration calibrate_wheels(const std::vector<Recording>& recordings,
                                                       const Model& model,
                                                       const CalibrationOptions& options = {}) {
  return calibrate_wheels(with_wheels(recordings, model.robot), model, options);
}

/// What a second odometer on the same robot measured while `drive` was driven, as loops for
/// calibrate_wheels: its motions one after the other, each from row to row of its own drive and
/// `every` s long at least, by dead reckoning with its own model. Their errors count as
/// independent: of a motion, sd is the root mean square of those ahead and aside. Both have the
/// same clock. Throws std::invalid_argument where the two drives have less than `every` s in
/// common, and like with_wheels.
[[nodiscard]] std::vector<Loop> second_odometer_loops(const Recording& second, const Model& model,
                                                      const DriveColumns& drive,
                                                      double every = 1.0);

// Validation: how well a calibration predicts legs that it has not seen.
//
// A leg ends at the first truth row that lies `leg` metres of driven path after its start. It is
// predicted by dead reckoning from its true start; the start's heading is the mean of what the
// truth rows of the last second say, brought there by the wheels.
//
//   blocks       legs are numbered through all sessions and taken in blocks of five; which blocks
//                are held out depends on their number alone, spread evenly; one calibration by the
//                other legs predicts them
//   recordings   where that leaves fewer than five held-out legs, as with a few short runs: each
//                recording is held out in turn and predicted by a calibration by all others. Its
//                clock is taken to be late by the mean of theirs

enum class HoldoutScheme { none, blocks, recordings };

/// Distances between predicted and true ends.
struct ArrivalErrors {
  std::vector<double> distances;  ///< m, per held-out leg

  [[nodiscard]] int legs() const { return static_cast<int>(distances.size()); }
  /// m; 0 without legs.
  [[nodiscard]] double rms() const;
};

/// Whether calibrated legs end nearer to the truth than nominal ones.
enum class CalibrationGain {
  unknown,    ///< no leg was held out
  uncertain,  ///< fewer than five legs, or a mean gain within two standard errors of 0
  better,
  worse
};

struct CalibrationValidation {
  HoldoutScheme scheme = HoldoutScheme::none;
  ArrivalErrors nominal;     ///< by the given model
  ArrivalErrors calibrated;  ///< by the calibrated model; the same legs in the same order

  [[nodiscard]] int legs() const { return calibrated.legs(); }
  /// By the mean of d_nominal^2 - d_calibrated^2 and its standard error over the legs.
  [[nodiscard]] CalibrationGain gain() const;
};

/// No legs without truth in use, with a holdout of 0, and where what is left of the recordings is
/// too little to calibrate by. Throws std::invalid_argument on effects that cannot be applied.
[[nodiscard]] CalibrationValidation validate_calibration(
    const std::vector<DrivenRecording>& recordings, const Model& model,
    const CalibrationOptions& options = {});
[[nodiscard]] inline CalibrationValidation validate_calibration(
    const std::vector<Recording>& recordings, const Model& model,
    const CalibrationOptions& options = {}) {
  return validate_calibration(with_wheels(recordings, model.robot), model, options);
}

/// Dead reckoning of one whole drive, from the pose of the first truth row to the time of the last.
struct DriveError {
  double end = 0.0;      ///< m, between reckoned and true end
  double heading = 0.0;  ///< rad: reckoned less true change of heading from start to end
  double driven = 0.0;   ///< m, mean of the wheels' travels, each counted forwards: turns count too

  [[nodiscard]] double heading_per_metre() const { return driven > 0.0 ? heading / driven : 0.0; }
};

/// One per recording, of the point that the truth tracks. Throws InputError where one has fewer
/// than two truth rows in its drive.
[[nodiscard]] std::vector<DriveError> drive_errors(const std::vector<DrivenRecording>& recordings,
                                                   const Model& model);
[[nodiscard]] inline std::vector<DriveError> drive_errors(const std::vector<Recording>& recordings,
                                                          const Model& model) {
  return drive_errors(with_wheels(recordings, model.robot), model);
}

/// The same, where a calibration has found how the truth is mounted: where the tracked point is on
/// the robot, and how its heading is turned. Clocks are of single recordings, and stay.
[[nodiscard]] std::vector<DriveError> drive_errors(const std::vector<DrivenRecording>& recordings,
                                                   const Model& model, const TruthAlignment& truth);

/// Root mean squares over the drives, of which there is at least one.
[[nodiscard]] double rms_end(const std::vector<DriveError>& errors);                ///< m
[[nodiscard]] double rms_heading_per_metre(const std::vector<DriveError>& errors);  ///< rad/m

// ----------------------------------------
// Constants to paste: what was found, as numbers for the robot's own software, old and new.
//
//   effects with the shape 1, by channel --> sizes of wheels, wheelbase, a gyro's scale ...
//
// Effects act side by side (channel.hpp), so that the wheels k with travels w_k move the body by
//
//   ahead  sum a_k (c + g_k - m) w_k     c = 1 + g_wheels + g_travel + m
//   turn   sum b_k (d + g_k - m) w_k     d = 1 + g_wheels + g_turn + m
//
//   g_k   left - difference/2, right + difference/2, or wheel k;   m   their mean
//
// A robot with the wheels' sizes c_k and its lengths (wheelbase, track, radius) times l turns by
// sum b_k c_k w_k / l. So
//
//   l = c/d            turns more than its wheels say: d > 1, and the wheelbase is smaller
//   c_k = c + l (g_k - m)
//
// which is right in every turn and in the mean travel. A travel scale of +2 % makes the wheels 1.02
// times as large, and the wheelbase as well: the turns were right before.
//
// Errors are first order, with all covariances where the fit is known.

/// A constant, in the words of the robot's software.
struct RobotConstant {
  std::string name;  ///< "left wheel", "wheelbase", "gyro bias"
  /// "times" (a factor of what the recordings were made with: of a wheel, of its radius or of the
  /// travel per tick), m, rad, s, rad/s, m^1/2.
  std::string unit;
  double before = 0.0;
  double after = 0.0;  ///< meaningless where not determined
  double sd = 0.0;     ///< standard error; 0: none is known
  bool determined = true;
  std::string note = {};  ///< how it is meant, or why it was not determined
};

/// A figure for another program's configuration.
struct StackValue {
  std::string stack;  ///< "ros2_controllers, diff_drive_controller"
  std::string key;    ///< "wheel_separation_multiplier"
  double value = 0.0;
  bool multiplies = false;  ///< what is there is to be multiplied by it; else it takes its place
  std::string note = {};
};

/// One wheel alone is larger or smaller, and explains all: the other one and the wheelbase are, by
/// these data, what the model had.
struct OneWheel {
  bool left = true;
  double larger = 0.0;   ///< by this share of the nominal size
  double sd = 0.0;       ///< of that
  double p_value = 1.0;  ///< of what contradicts it
};

struct RobotConstants {
  std::vector<RobotConstant> list;  ///< none that the drive does not have or nobody asked for
  std::vector<StackValue> stacks;   ///< of those that were determined; grouped
  std::optional<OneWheel> one_wheel;
  std::vector<std::string> others;  ///< effects that no constant undoes: they stay in the model
  std::vector<std::string> doubts;  ///< what else it could be, a sentence each

  [[nodiscard]] bool empty() const { return list.empty(); }
};

/// Of the effects that the fitted model has. `before`: the model as given, its own coefficients
/// count as what was in force.
[[nodiscard]] RobotConstants robot_constants(const Model& before, const ModelFit& after);

/// Of these effects on the robot of `before`, taken for independent: what a diagnosis predicts.
[[nodiscard]] RobotConstants robot_constants(const Model& before,
                                             const std::vector<EffectEstimate>& after);

/// Wheels, their noise, antenna and delays of a calibration from `before`.
[[nodiscard]] RobotConstants robot_constants(const Model& before, const WheelCalibration& found);

/// Of the last of these rounds. `before`: the model with what was in force in the first one.
[[nodiscard]] RobotConstants robot_constants(const Model& before,
                                             const std::vector<SquareRound>& rounds,
                                             SquareMethod method);

/// The same, and what robot_localization asks for: the variance of a velocity that is the motion of
/// one row over its duration, (m/s)^2 and (rad/s)^2, mean over the rows that move. By the model's
/// white noise of wheels, without the gyro. As it is without constants, and of recordings that do
/// not move.
[[nodiscard]] RobotConstants with_velocity_variances(RobotConstants constants,
                                                     const std::vector<DrivenRecording>& recordings,
                                                     const Model& model);

/// A calibrated model for a file: its effect `wheelbase` in [robot], where the length that turns go
/// by is divided by 1 + g, and the effect stays with 0, so that a fit shows what is left; the
/// others that a calibration seeks as effects that act side by side, as a fit has them. Where the
/// drive has no such length, or where more than turns goes by it (`wheels`; `ackermann` with a
/// wheel off the middle), `wheelbase` stays an effect. Recordings of which the wheels were taken in
/// by the robot as it was go on with the model as calibrated.
[[nodiscard]] Model with_wheelbase_in_robot(Model model);

}  // namespace trussmap
