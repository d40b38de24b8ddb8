// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// A model fitted to recordings: map, poses and, where wanted, the coefficients of its effects.
//
//   recordings, model --fit_model--> ModelFit --> compare, diagnose, predict_held_out, pages
//
// Least squares of all that was measured, each by the noise that the model states for it. Shapes
// see the path of the fit itself, so path and coefficients are estimated in turn until they stay.
//
// Nothing is fitted that the data cannot show: such a coefficient keeps the model's value (0 where
// it has none), and EffectEstimate says so.
#pragma once

#include "trussmap/dead_reckoning.hpp"
#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

struct FitOptions {
  bool use_survey = true;   ///< survey.csv as measurements
  bool use_truth = true;    ///< truth.csv likewise
  bool use_fixes = true;    ///< fixes.csv likewise
  bool use_loops = true;    ///< loops.csv likewise
  bool fit_effects = true;  ///< false: coefficients stay as the model has them
  /// Sightings, fixes and loops that the others contradict by more are left out: squared standard
  /// deviations, 16 for one right sighting in 3000. Absent: all stay.
  std::optional<double> gate = std::nullopt;
  /// Share of these: where more would be left out the gate widens, at last to none. Few are
  /// ever misread; where many contradict the rest, the model is wrong.
  double most_left_out = 1.0;
  /// Per recording, in its own time (or none at all): what is sighted or known within is not used,
  /// nor is what is driven between two such instants, if a part of it is within.
  std::vector<std::vector<TimeSpan>> excluded = {};
};

/// Why a coefficient was not fitted.
enum class NotFitted {
  undetermined,  ///< no measurement tells it from the map, the poses or the rest
  faint,         ///< the map and the poses absorb it almost completely
  uncertain      ///< its standard error is a large share of the size that it may have
};

struct UnfittedCoefficient {
  std::size_t place = 0;  ///< in the effect's list of coefficients
  NotFitted why = NotFitted::undetermined;
  double uncertainty = 0.0;  ///< standard error over the prior standard deviation; of `uncertain`
};

struct EffectEstimate {
  Effect effect;                                ///< with channel, shape and coefficients
  std::vector<double> sd;                       ///< 0 where held, infinite where not fitted
  std::vector<UnfittedCoefficient> not_fitted;  ///< the coefficients that were not
};

struct FittedLandmark {
  std::string name;
  Vector2 position = Vector2::Zero();            ///< m, map frame
  Matrix2 covariance = Matrix2::Zero();          ///< m^2; zero where held
  std::optional<Vector2> survey = std::nullopt;  ///< m, where surveyed
};

namespace fitting {
/// All that the fit knows, for the library's own use.
struct FitState;
}  // namespace fitting

struct ModelFit {
  Model model;  ///< effects with channel, shape and the coefficients found
  FitOptions options;
  std::vector<EffectEstimate> effects;    ///< in the model's order
  std::vector<FittedLandmark> landmarks;  ///< in order of first sighting
  double chi2 = 0.0;
  int dof = 0;           ///< measured values less unknowns; coefficients held are no unknowns
  int coefficients = 0;  ///< estimated, each of which costs a degree of freedom
  double p_value = 1.0;  ///< chance of a chi^2 as large where the model is right
  bool settled = true;   ///< shapes and path agree
  std::vector<std::string> left_out;  ///< sightings, fixes and loops that the gate left out
  std::vector<std::string> warnings;
  std::shared_ptr<const fitting::FitState> state;
};

/// Throws SolveError where something cannot be determined (a landmark, a pose, sessions that
/// nothing connects), InputError where a recording has nothing to fit, std::invalid_argument on an
/// effect that cannot be applied to these recordings.
[[nodiscard]] ModelFit fit_model(const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const FitOptions& options = {});
[[nodiscard]] inline ModelFit fit_model(const std::vector<Recording>& recordings,
                                        const Model& model, const FitOptions& options = {}) {
  return fit_model(with_wheels(recordings, model.robot), model, options);
}

// ----------------------------------------
// Day after day. A session that has been fitted enters the next fit as what it says of landmarks
// and coefficients, its path eliminated: the quadratic of its own least squares there, with all
// second derivatives. Adding a day costs a day, a few factorisations of the sum, and a step of each
// session that is linearised again, from the rows that are kept of it, for the map has moved so far
// from where its quadratic was taken that it would matter.
//
//   SummarisedFit fit(model);
//   for (const Recording& day : days) fit.add(day);
//   fit.landmarks(), fit.model()
//
// Every session's rows are laid when it is added, on the map that there is then: its effects'
// columns, and the noise of its segments, are those of its path on that map, and what the gate left
// out of it stays out. Of these rows the result is the least squares solution, of all sessions at
// once, to the tolerance. fit_model of all recordings lays the rows on the map of all, and so
// differs by a share of the map's uncertainty (docs/methods.md).
//
// The frame is the first session's, as that of fit_model, but that where nothing measures a
// direction one coordinate of a landmark is held instead of a heading.

struct SummarisedFitOptions {
  FitOptions fit;
  /// m, rad, units of coefficients: how far the result may be from the least squares solution.
  double tolerance = 1e-8;
};

class SummarisedFit {
 public:
  /// Throws std::invalid_argument where the model has what cannot be summarised: an effect per
  /// session or of the variable `session`, a delay, steering, noise with heavy tails; where the
  /// tolerance is not positive, or where spans of time are excluded.
  explicit SummarisedFit(const Model& model, const SummarisedFitOptions& options = {});
  ~SummarisedFit();
  SummarisedFit(SummarisedFit&&) noexcept;
  SummarisedFit& operator=(SummarisedFit&&) noexcept;

  /// Takes a session in, or where it throws leaves all as it was. The first one defines the datum,
  /// and has to show every coefficient. Throws as fit_model does, InputError where no landmark was
  /// sighted, SolveError where a further session is not tied to the map by two places or by one and
  /// a direction, or brings what gives a position or a direction (truth, fixes, compass, surveyed
  /// landmarks) to a map whose first session had none.
  void add(const DrivenRecording& recording);
  void add(const Recording& recording);

  [[nodiscard]] int sessions() const;
  [[nodiscard]] Model model() const;  ///< with the coefficients found
  [[nodiscard]] std::vector<EffectEstimate> effects() const;
  /// In order of first sighting; covariances by chi^2's whole second derivatives.
  [[nodiscard]] std::vector<FittedLandmark> landmarks() const;
  [[nodiscard]] double chi2() const;  ///< of all sessions
  [[nodiscard]] int dof() const;      ///< measured values less unknowns, as ModelFit's
  /// Sightings, fixes and loops that the gate left out, session by session.
  [[nodiscard]] const std::vector<std::string>& left_out() const;
  /// How often the last add took an older session anew.
  [[nodiscard]] int relinearised() const;
  /// How far the result is from the least squares solution, m, rad, units of coefficients, by every
  /// session's exact gradient: for checks, it costs a step of all sessions.
  [[nodiscard]] double exact_error();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The map of a fit, as it is drawn.
struct FittedMap {
  std::vector<FittedLandmark> landmarks;
  std::vector<std::vector<Vector2>> paths;  ///< m, one per session, thinned out
};

/// At most about `points` points of paths in all.
[[nodiscard]] FittedMap fitted_map(const ModelFit& fit, std::size_t points = 2000);

// ----------------------------------------
// Where the robot was, by a model: at the start of the drive and at the end of every row.

struct TimedPose {
  double t = 0.0;  ///< s
  PoseEstimate estimate = {};
};

/// By wheels, compass and the model's effects, nothing else: from (0, 0, 0), in the axes of the
/// robot as it starts. The covariance is that of the model's noise; with a compass it holds what
/// the readings leave of the first heading, too. Effects act with the coefficients that the model
/// states, none is fitted. Throws std::invalid_argument, naming the effect, where one cannot be
/// applied.
[[nodiscard]] std::vector<TimedPose> dead_reckoned_poses(const DrivenRecording& recording,
                                                         const Model& model);
[[nodiscard]] inline std::vector<TimedPose> dead_reckoned_poses(const Recording& recording,
                                                                const Model& model) {
  return dead_reckoned_poses(with_wheels(recording, model.robot), model);
}

/// By everything that was measured, of one session of a fit, in the map's frame. Covariances are
/// exact where something was measured (zero where the frame is held); between two such instants
/// they go over from one to the other, and grow by the noise of what was driven there. Before the
/// first and after the last they are dead-reckoned on. Throws std::invalid_argument on a session
/// that the fit has not, SolveError where the fit determines no covariance.
[[nodiscard]] std::vector<TimedPose> adjusted_poses(const ModelFit& fit, std::size_t session = 0);

// ----------------------------------------
// Sightings whose errors last: a camera at ten frames a second that misjudges a range does so in
// the next frame, too. A fit takes sightings as independent; frames that are nearer in time than
// their errors last then count several times over, and bias what they are weighed against (scale,
// losses), while a larger noise would hide the symptom alone. One frame per so long as errors last
// is nearly as good as all, and honest.
//
//   correlation of whitened errors of ranges and bearings, same landmark
//     1 |*
//       |   *                      lasts: from where on it stays below 0.3
//   0.3 |--------*--------------
//       |            *    *
//       +----------------------> lag

struct LastingErrors {
  double lasts = 0.0;  ///< s; 0: errors are independent, or sightings too few and far between
  int sightings = 0;   ///< seen from afar, by the fit
};

/// From the errors that a fit leaves. At most 5 s: what lasts longer is no matter of frames.
[[nodiscard]] LastingErrors lasting_errors(const ModelFit& fit);

/// One frame (sightings of one instant) in so long, from the first on; sightings of a landmark that
/// the robot stands on stay all.
[[nodiscard]] std::vector<DrivenRecording> thinned_frames(
    const std::vector<DrivenRecording>& recordings, double lasts);

/// Of each `every` s the frame that tells most, a sighting of a landmark counting the more the
/// fewer there are of it; sightings of a landmark that the robot stands on stay all.
[[nodiscard]] std::vector<DrivenRecording> richest_frames(
    const std::vector<DrivenRecording>& recordings, double every);

/// Whether there are enough frames that are near each other, and see the same, for lasting_errors.
[[nodiscard]] bool has_dense_frames(const std::vector<DrivenRecording>& recordings);

}  // namespace trussmap
