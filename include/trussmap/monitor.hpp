// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// A monitor on the robot: does the odometry model still hold? Leg by leg, as the robot drives.
//
//   Monitor monitor(model, {.compass = true});
//   monitor.drive(row);                                  // each odometry row, as it is read
//   MonitorReport now = monitor.arrive({.sightings = {{t, "door"}}});    // the leg ends
//   if (now.alarm) now.found: which effect, how large, since which leg, what looks like it
//   monitor.take_in();                                   // counts the effect in from here on
//
// What a leg's end measures (landmarks seen before or surveyed, a fix, the compass on the way, the
// gyro beside the wheels) is compared with what the model's odometry predicts, by a Kalman filter
// over the landmarks seen lately. Its whitened innovations w are independent, of variance 1, while
// the model holds. A constant effect of coefficient b that began with leg t adds b h to them, with
// h by the physics of its channel. For each effect and each start,
//
//   A = sum h psi(w),  Q = sum h^2,  psi(w) = w clipped to +-2.5
//   E = (1 + s^2 k^2 Q)^(-1/2) exp(s^2 A^2/(2 (1 + s^2 k^2 Q))), 1 on average while it holds
//   M = sum over starts and effects of r T_t E/(number of effects); an alarm where M reaches 1
//
//   s    usual size of the effect (WatchedEffect)     r    false alarms per hour, as asked for
//   k    noise margin                                 T_t  how long leg t took, hours
//
// False alarms. M - r (hours) is a supermartingale, whatever the instant at which one looks: within
// H hours an alarm is false with probability r H at most, and on average at most r an hour are. It
// holds while, given the past, psi(w) is no more spread than a normal number of standard deviation
// k: E exp(l psi(w)) <= exp(l^2 k^2/2). Tails do not spoil that, noise that lasts does where the
// model does not state it (Noise::processes), and so does white noise larger than k times what it
// states: estimate it before (fit_model, `trussmap fit --noise`). docs/mathematics.md has the
// proof, which is of first order in the errors of a leg; measured (bench/README.md) are a fifth of
// the false alarms that are asked for, and as many at most whatever the noise.
//
// Evidence is that of the last 200 legs: what they do not show is not announced.
//
// Look-alikes: effects of which h goes the same way over the legs since the start, |cosine| of 0.95
// or more, and those that the legs do not speak against 20 to 1. Effects are reckoned in first
// order: of very large ones, ten times what 50 legs show, the name errs in one of seven.
//
// Cost per leg: (numbers of the filter: 2 per landmark kept)^2 and (these x effects x starts kept);
// per row: a product of 5 x 5 matrices, and that per effect. Neither grows with the way.
//
// What it does not see: what acts on ranges, bearings and times of sightings; loops; sightings by a
// range or a bearing alone; an error that no landmark, fix or compass ever shows, as the scale of a
// map without survey that has been wrong from the beginning.
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/corrected_odometry.hpp"
#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace trussmap {

/// An effect that is watched for: a constant g of its channel.
struct WatchedEffect {
  std::string name;  ///< as in the catalogue, where it is there
  Channel channel = Channel::travel;
  double usual = 0.01;  ///< s, unit of the channel: its prior is N(0, s^2)
};

/// The basic constants of a robot with this drive: travel scale, wheelbase, heading drift; of two
/// wheels each wheel's radius and their ratio; of other drives each wheel and the steering; with a
/// gyro its bias and scale, with a compass its offset.
[[nodiscard]] std::vector<WatchedEffect> watched_effects(const Robot& robot,
                                                         const OdometryInputs& inputs);

struct MonitorOptions {
  double false_alarms_per_hour = 0.01;      ///< of driving, above 0
  double noise_margin = 1.1;                ///< k, at least 1
  int landmarks = 24;                       ///< that are kept; 2 at least
  std::vector<WatchedEffect> effects = {};  ///< none: watched_effects of the robot
};

/// What is measured where a leg ends.
struct MeasuredEnd {
  /// By standing on a landmark, or by range and bearing; others are passed over. Uncertain as the
  /// model says.
  std::vector<Sighting> sightings = {};
  std::optional<Fix> fix = {};
  std::optional<TruthRow> pose = {};  ///< by whatever tracks the robot
};

/// An effect that looks the same as the one that was found.
struct MonitorLookAlike {
  std::string name;
  double cosine = 0.0;  ///< between what both add to the innovations, -1 to 1
  double share = 0.0;   ///< of the evidence, 0 to 1
};

struct FoundEffect {
  Effect effect;       ///< with its coefficient
  double sd = 0.0;     ///< of the coefficient
  double share = 0.0;  ///< of the evidence, 0 to 1
  /// The first leg with it, counted from 1: the likeliest one, of an alarm none after it.
  long leg = 0;
  long earliest = 0;  ///< between these two it began, as far as the evidence goes (90 %)
  long latest = 0;
  std::vector<MonitorLookAlike> look_alikes = {};  ///< the one with most evidence first
};

struct MonitorReport {
  long legs = 0;          ///< so far; where the robot starts is the end of none
  double hours = 0.0;     ///< of driving
  double evidence = 0.0;  ///< M: at 1 the model has ceased to hold
  bool alarm = false;     ///< M has reached 1 since the model was changed
  /// The effect that most of the evidence is for, once something speaks for one.
  std::optional<FoundEffect> found = {};
};

/// Movable. Equal legs give equal results. One thread at a time.
class Monitor {
 public:
  /// Throws std::invalid_argument on options out of range, an effect that the robot's drive does
  /// not have or that acts on neither rows nor compass, and as CorrectedOdometry does.
  explicit Monitor(const Model& model, const OdometryInputs& inputs = {},
                   const MonitorOptions& options = {});
  ~Monitor();
  Monitor(Monitor&&) noexcept;
  Monitor& operator=(Monitor&&) noexcept;

  /// Where a landmark is in the map, as measured independently. Before it is seen first.
  void know(const SurveyPoint& point);

  /// The next row. Throws as CorrectedOdometry::drive.
  CorrectedRow drive(const WheelRow& row, std::span<const double> covariates = {});

  /// The leg ends. Throws std::invalid_argument, and leaves all as it was, on numbers that are not
  /// finite, and where no row was driven since the last leg but for the first.
  MonitorReport arrive(const MeasuredEnd& end);

  /// As arrive() left it.
  [[nodiscard]] const MonitorReport& report() const;

  /// The effect that was found belongs to the model from here on, as large as was found; what the
  /// monitor believes is corrected for it, the coefficient stays as uncertain as it is, and the
  /// watch begins anew. Throws std::logic_error where nothing was found. Right to first order: who
  /// has all legs since the effect began, and finds it large, drives them again past a monitor that
  /// had it from there on (add).
  Effect take_in();

  /// Between legs: this constant effect belongs to the model from here on, its coefficient as
  /// uncertain as `sd`, and the watch begins anew. Throws std::invalid_argument on an effect that
  /// is no constant or that the drive does not have, std::logic_error where a leg is under way.
  void add(const Effect& effect, double sd);

  /// The model with what was taken in.
  [[nodiscard]] const Model& model() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// What a monitor says of a leg of a recording.
struct WatchedLeg {
  long leg = 0;     ///< counted from 1
  double t = 0.0;   ///< s, at its end
  std::string end;  ///< the landmark that it ends at, "" by a fix or a pose
  double evidence = 0.0;
};

struct Watch {
  std::vector<WatchedLeg> legs;
  double alarm_t = kAbsent;            ///< s; NaN: none
  std::optional<MonitorReport> alarm;  ///< as it was given
  /// What it is, 50 legs after the alarm or at the end: by then the evidence has settled, and the
  /// beginning is not yet beyond what it reaches back.
  std::optional<FoundEffect> found;
  MonitorReport last;        ///< after all legs
  double since_t = kAbsent;  ///< s, where the first leg with the effect begins
  int passed_over = 0;       ///< sightings by a range or a bearing alone
};

/// A recording leg by leg, as the robot would have had it. Legs end at sightings that are
/// `min_drive` of driven path behind the last end, and, where there are no sightings, at fixes or
/// truth rows `leg` m behind it. Survey, fixes and truth are used where they are there. Throws
/// std::invalid_argument as Monitor does, and on a recording that nothing of this kind ties to a
/// place.
struct WatchOptions {
  MonitorOptions monitor = {};
  double min_drive = kDefaultMinDrive;  ///< m
  double leg = 1.0;                     ///< m
};
[[nodiscard]] Watch watch(const DrivenRecording& recording, const Model& model,
                          const WatchOptions& options = {});
[[nodiscard]] inline Watch watch(const Recording& recording, const Model& model,
                                 const WatchOptions& options = {}) {
  return watch(with_wheels(recording, model.robot), model, options);
}

}  // namespace trussmap
