// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Which physical effect is missing?
//
//   fit of the present model --> score tests of all candidates --> winner, if any is significant
//        |                              ^                                |
//        '--> single events, noise      '------ conditioned on it <------'   a second, a third ...
//
//   candidates   the whole catalogue, and every channel against every variable and covariate
//   p adjusted   Holm's, over all that was tried, members of families counted one by one; judged
//                against the dispersion that the candidate itself would leave, or against that of
//                the very rows that speak for it where it is clearly larger: a wrong noise law or
//                a single bad leg makes no effect
//   order        evidence: log Bayes factor, sizes equally likely on a logarithmic scale, and a
//                little more belief in the catalogue than in a free form
//   look-alike   |P_r v| / |v| >= 0.95: of the winner's own trace v, what a rival's columns can
//                show as well; whether all measurements tell it apart is decided by fits with
//                either, since what is alike to first order may differ beyond
//   absent       where even the minimal detectable size would raise the arrival error by less than
//                5 %
//   sets         all that explain about as much as what is missing does, with probabilities
//   misfit       where no effect is missing: by the rule of compare.hpp
//
// Laws of noise (beyond what the model states) and single events are asked of what the findings
// leave. All else is judged by noise that is estimated: where the model states too little, or takes
// errors that last for independent ones, everything would look like an effect.
#pragma once

#include "trussmap/compare.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/planar.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

struct RobotConstants;

enum class Status { missing, absent, negligible, cannot_tell };

/// chi^2 behind another from which on measurements tell two effects apart: odds of 400 to 1.
inline constexpr double kToldApart = 12.0;

/// An effect that would leave nearly the same trace.
struct LookAlike {
  Effect effect;
  double cosine = 0.0;
  /// chi^2 by which the fit with it explains less than that with what it looks like, in units of
  /// the errors that that leaves: a trace may be much alike, and the measurements many. Below 0:
  /// more.
  double behind = 0.0;

  [[nodiscard]] bool told_apart() const { return behind >= kToldApart; }
};

/// The most alike of those that are not told apart; nullptr where all are.
[[nodiscard]] const LookAlike* closest_rival(const std::vector<LookAlike>& alike);

struct Finding {
  Effect effect;          ///< with the estimated coefficients
  bool catalogue = true;  ///< false: a channel with a free form of a variable
  double score = 0.0;     ///< chi^2 that adding it would take away
  int dof = 0;
  double p_value = 1.0;
  double p_adjusted = 1.0;
  double evidence = 0.0;
  std::vector<double> sd;
  std::vector<double> minimal_detectable;  ///< per coefficient alone: 90 % power at p = 0.05/200
  Status status = Status::cannot_tell;
  /// More than three times as large as such effects are at most: look for another cause, a wrong
  /// unit or a sensor at fault.
  bool implausible = false;
  HeldOutMetrics held_out;             ///< predicted, with it added
  std::vector<LookAlike> look_alikes;  ///< of those that are missing
  /// Of those that are missing: the coefficients with all that is missing added at once.
  std::vector<double> joint;
  std::vector<double> joint_sd;
  /// By what its standard errors are larger for a place or threshold that was sought, one per
  /// coefficient; empty where none was.
  std::vector<double> sd_inflation;
  int tried = 1;  ///< members of its family
  /// By itself it explains next to nothing: it and others that are missing hide each other.
  bool only_together = false;
};

/// Why recordings cannot show an effect.
enum class Unseen {
  never_happens,  ///< what it goes with never occurs
  in_the_map,     ///< without measured positions the map absorbs it
  absorbed,       ///< map and poses absorb it completely
  too_small       ///< it would have to be implausibly large
};

struct Unobservable {
  Effect effect;
  Unseen why = Unseen::absorbed;
  bool positions = false;  ///< some were measured: by a survey, or as truth
};

/// More noise than the model states, by one law.
struct NoiseTest {
  std::string law;     ///< "per metre", "per second", "per start", ...; a variant after a comma
  double score = 0.0;  ///< fall of -2 log of the restricted likelihood
  int dof = 1;
  double p_value = 1.0;
  double p_adjusted = 1.0;  ///< Holm, over the laws
  double size = 0.0;        ///< standard deviation that the law adds, in `unit`
  double stated = 0.0;      ///< that the model states, same unit; of a law that the model has
  std::string unit;         ///< "m/sqrt(m)", "m per start", ...; empty: a shape of noise, no amount
};

enum class EventKind { leg, landmark, sighting, session };

/// What a single event did, and what its sizes are.
enum class EventChange {
  left_wheel,    ///< that wheel's travel jumped: m, + is more than it said
  right_wheel,   ///< likewise
  motion,        ///< the robot was moved: m ahead, m to the left, rad
  position_off,  ///< a sighting is off: m, m
  range_off,     ///< a reading is off: m
  bearing_off,   ///< the same: rad
  view_off,      ///< a reading is off: m and rad
  survey_off,    ///< a landmark is not where the survey has it: m along x, m along y
  moved,         ///< a landmark was moved: m along x, m along y
  session_off,  ///< a session is not like the others: travel, turn, compass (rad, NaN: none), delay
                ///< (s)
  left_out      ///< a sighting that the gate left out: no size
};

/// When a landmark was moved.
struct MovedWhen {
  std::optional<double> before_t = std::nullopt;  ///< s; none: between two sessions
  std::string session;                            ///< named only where there are several
  std::string next_session;                       ///< of a move between two
};

struct EventTest {
  EventKind kind = EventKind::leg;
  std::string name;  ///< "12 -> 13 at t = 45.2 s", "12", "run 3"
  EventChange change = EventChange::motion;
  std::vector<double> size;
  MovedWhen when;
  double score = 0.0;
  int dof = 0;
  double p_value = 1.0;     ///< of score/phi, times the places tried for this event
  double p_adjusted = 1.0;  ///< Holm, over all events
};

/// Two effects that a drive could tell apart.
struct NextDrive {
  Effect effect;
  Effect rival;
  std::vector<std::string> slow;  ///< covariates that vary slowly over the recordings
};

// ----------------------------------------
// Sets of effects.

/// An effect of a set, with its size beside the others of the set.
struct ExplainingEffect {
  Effect effect;
  std::vector<double> sd;              ///< one per coefficient
  std::vector<std::string> otherwise;  ///< names of look-alikes that explain about as much
};

/// Effects that explain the recordings together.
struct EffectSet {
  std::vector<ExplainingEffect> effects;
  double behind = 0.0;         ///< of log evidence behind the best set
  double probability = 0.0;    ///< its own and that of sets which only add to it
  double chi2_decrease = 0.0;  ///< that adding them takes away, to first order
  bool named = false;          ///< what the findings say is missing
};

/// How likely an effect, or one that looks like it, is part of the explanation.
struct EffectChance {
  Effect effect;  ///< without coefficients
  std::vector<std::string> otherwise;
  double probability = 0.0;
};

/// All sets of effects about as good as the best: 6 units of log evidence behind at most, odds of
/// 400 to 1. Every candidate, pair and triple was weighed, larger sets begun with the best ones
/// (criticism/subset_search.hpp): sizes equally likely on a logarithmic scale, numbers of effects
/// by Poisson's law of mean 1, look-alikes sharing one belief. What only adds to a likelier set
/// counts as that one. Empty where nothing is missing, or even with it chi^2 is above 3 dof.
struct Explanations {
  std::vector<EffectSet> sets;        ///< best first
  std::vector<EffectChance> effects;  ///< likeliest first, from 0.01 on
  double none_of_these = 0.0;         ///< probability of all other sets, that of no effect included
};

// ----------------------------------------
// Coefficients that change.

/// An effect's size over a while of driving.
struct CoursePart {
  std::size_t session = 0;  ///< place among the recordings
  double from = 0.0;        ///< s, the recording's clock
  double until = 0.0;       ///< s
  double value = 0.0;       ///< as ChangingCoefficient::fitted
  double sd = 0.0;
};

/// A coefficient that is not the same all the time, though the model has it so: tested against a
/// step at an unknown moment and against a walk at random (criticism/changing_coefficients.hpp).
struct ChangingCoefficient {
  enum class Form { step, walk };
  Form form = Form::step;  ///< that explains more
  Effect effect;           ///< as fitted, the same all the time
  /// What values are of: the coefficient of an effect that has one, else a factor of all.
  double fitted = 1.0;
  double p_value = 1.0;        ///< times the forms and effects tried
  double chi2_decrease = 0.0;  ///< that allowing for it takes away; of a walk the gain in -2 log
                               ///< likelihood, times the dispersion that it leaves
  // A step:
  std::size_t session = 0;   ///< where it is: place among the recordings
  std::string session_name;  ///< named only where there are several
  bool between = false;      ///< before the first drive of that session
  double t = 0.0;            ///< s, likeliest
  double earliest = 0.0;     ///< s: with 95 % within; both in the session of the step
  double latest = 0.0;       ///< s
  double before = 0.0;
  double before_sd = 0.0;
  double after = 0.0;
  double after_sd = 0.0;
  /// A walk: standard deviation of what an hour of driving changes.
  double per_root_hour = 0.0;
  std::vector<CoursePart> course;  ///< of either form, in order of time
  /// Columns that the course follows, and "t" of a single recording, closest first: with one of
  /// them nothing of the change is left to explain.
  std::vector<std::string> goes_with;
};

// ----------------------------------------
// Fields of places.

/// A square of a field that the robot was in.
struct FieldCell {
  int column = 0;                    ///< along x
  int row = 0;                       ///< along y
  Vector2 centre = Vector2::Zero();  ///< m
  double mean = 0.0;                 ///< in the channel's unit
  double sd = 0.0;                   ///< its standard error
};

/// A channel that differs from place to place: a smooth field over the floor (travel, turn, creep:
/// the floor map; compass: the magnetic map), beside what is the same everywhere.
struct FieldOfPlaces {
  Channel channel = Channel::travel;
  double size = 0.0;  ///< sd over the way that was driven, in the channel's unit
  /// m, of Matern's correlation, smoothness 1, the likeliest: 0.14 is left so far apart.
  double length = 0.0;
  double p_value = 1.0;        ///< of none, times the channels asked
  double chi2_decrease = 0.0;  ///< gain in -2 log likelihood, times the dispersion that it leaves
  double told = 0.0;           ///< share of its variance along the way that the recordings tell
  /// Others that a field of would explain it as well: within kToldApart of chi^2.
  std::vector<Channel> rivals;
  /// Findings at a place that explain it as well: then it is these, and no field.
  std::vector<std::string> patches;
  /// Centre of the first cell, m; cells are squares, those of a row along x one after the other,
  /// the row of least y first.
  double x = 0.0;
  double y = 0.0;
  double cell = 0.0;  ///< m, its side
  int columns = 0;
  int rows = 0;
  /// Less its mean over the way, in the channel's unit; NaN where the robot never was.
  std::vector<double> mean;
  std::vector<double> sd;  ///< its standard error

  [[nodiscard]] bool is_field() const { return patches.empty(); }
  /// Those that the robot was in, row by row.
  [[nodiscard]] std::vector<FieldCell> cells_driven() const;
  /// The largest |mean|.
  [[nodiscard]] double most() const;
};

struct Diagnosis {
  enum class Verdict { missing, nothing_missing, unexplained_misfit };
  Verdict verdict = Verdict::nothing_missing;
  Objection objection = Objection::none;  ///< what an unexplained misfit shows in
  std::string missing;                    ///< name of the first finding, if it is missing
  double p_value = 1.0;                   ///< its, adjusted; else of chi^2
  double level = kSignificance;           ///< by which it was judged
  double chi2 = 0.0;
  int dof = 0;
  int coefficients = 0;           ///< estimated in this fit
  UsedSightings sightings;        ///< of prepared recordings
  HeldOut held_out;               ///< of the present model
  HeldOutMetrics with_missing;    ///< predicted, with all that is missing added
  std::vector<Finding> findings;  ///< best first
  Explanations explanations;
  /// Of the model's effects and of those that are missing, surest first.
  std::vector<ChangingCoefficient> changing;
  std::vector<FieldOfPlaces> places;  ///< channels that differ by place, surest first
  std::vector<Unobservable> unobservable;
  std::vector<NoiseTest> noise;   ///< best explanation first
  std::vector<EventTest> events;  ///< likeliest first
  std::vector<DataLack> lacks;
  std::optional<NextDrive> next_drive;  ///< to tell the first finding from its rivals
  std::size_t tried = 0;                ///< tests
  /// The fit that is judged, and the noise that it goes by; none where noise was not estimated.
  std::shared_ptr<const FitWithNoise> under;
  std::vector<std::string> warnings;
};

struct DiagnoseOptions {
  FitOptions fit = {};
  LegOptions legs = {};
  double level = kSignificance;  ///< chance of naming an effect where none is missing
  /// Judge by noise estimated from these recordings (noise_fit.hpp), beside what may be missing;
  /// else by what the model states.
  bool estimate_noise = true;
  std::size_t most_missing = 4;
};

/// Throws like fit_model.
[[nodiscard]] Diagnosis diagnose(const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const DiagnoseOptions& options = {});
[[nodiscard]] inline Diagnosis diagnose(const std::vector<Recording>& recordings,
                                        const Model& model, const DiagnoseOptions& options = {}) {
  return diagnose(with_wheels(recordings, model.robot), model, options);
}

/// The same where the fit of these recordings is there already.
[[nodiscard]] Diagnosis diagnose(const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& fit, const DiagnoseOptions& options = {});

/// The same of recordings as the fit's model has them. Where with what is missing many more of
/// their sightings may be used, the diagnosis is made again by these, and `recordings` and `fit`
/// are those on return.
[[nodiscard]] Diagnosis diagnose(PreparedRecordings& recordings, ModelFit& fit,
                                 const DiagnoseOptions& options = {});

/// What is missing as constants to paste, with all of it added at once, beside the model's effects
/// as they were fitted: sizes by the score tests, their errors taken for independent. None where
/// nothing is missing. `before`: the model that was diagnosed.
[[nodiscard]] RobotConstants robot_constants(const Diagnosis& diagnosis, const Model& before);

/// An unexplained misfit of chi^2 as a whole that noise alone makes in more than one of a thousand
/// recordings: too little to prefer another model for.
[[nodiscard]] bool is_slight_misfit(const Diagnosis& diagnosis);

/// Findings that are missing, or there but too small to matter.
[[nodiscard]] std::vector<const Finding*> found_by(const Diagnosis& diagnosis);

}  // namespace trussmap
