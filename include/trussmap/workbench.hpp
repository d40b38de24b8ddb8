// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// A workbench for models: effects are looked at before they are added, added, taken off again.
//
//   recordings, model --> TriedModel: fit, diagnosis, what each candidate would save
//                           preview(effect)   its curve, and what it would leave of the error:
//                                             score tests, no fit
//                           shown(effect)     one that the model has, as the recordings show it
//                                             beside the others
//                           legs()            where, when, whether they count; both of the above
//                                             can look at some legs alone
//
//   Workbench   the steps: given --add--> + hard iron --add--> + wheelbase --exclude--> 3 legs
//                                             '------remove--> ...
//               Each is a model without fitted coefficients, which follow from it and from what is
//               excluded alone: a step that is returned to has the same figures to the last digit.
//
// Held-out legs are the same at every step, and no fit that is judged by them sees them.
#pragma once

#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/noise_fit.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// An effect explained to a robot's owner, in whole sentences: one of the catalogue by a text of
/// its own, any other by its channel and what it goes with.
struct Explanation {
  std::string does;   ///< what it does to the robot
  std::string look;   ///< what to look at on the robot; empty where that is said already
  std::string drive;  ///< what to drive to be sure
  /// Its coefficients have the sign that such effects seldom have, and the drawing does not show.
  bool unusual = false;
};
/// By the sign of its coefficients, where it has any.
[[nodiscard]] Explanation explanation_of(const Effect& effect);

/// What an effect does to a robot, as SVG of 320 x 170: dashed as the robot believes it to be, blue
/// as it is, orange the cause. Each effect of the catalogue has a drawing of its own; any other has
/// that of the catalogue's plainest effect of its channel, or none (empty) where there is none. In
/// a page its colours are the page's.
[[nodiscard]] std::string effect_drawing(const Effect& effect);

/// Both, with cause and remedy, as JSON for the workbench's page.
[[nodiscard]] std::string explanation_json(const Effect& effect);

/// An effect that a model does not have, as it would be.
struct EffectPreview {
  EffectEvidence evidence;  ///< coefficients as a score test estimates them
  double score = 0.0;       ///< chi^2 that adding it would take away
  int dof = 0;              ///< coefficients that can be seen; 0: these recordings do not show it
  double p_value = 1.0;     ///< of this effect alone, as if no other had been tried
  /// Of the held-out legs with it; none where that cannot be foretold (an effect that changes the
  /// order of what was measured).
  std::optional<HeldOutMetrics> predicted;
  /// The same of each rival that was asked for.
  std::vector<std::optional<HeldOutMetrics>> rivals_predicted;
  /// And chi^2 by which it explains less than the effect (LookAlike::behind); below 0: more.
  std::vector<double> rivals_behind;
};

/// A number within an effect that no fit estimates, and how far a search may move it.
struct EffectParameter {
  ShapeParameter parameter;
  double step = 0.0;  ///< between values that are worth telling apart
  double least = 0.0;
  double most = 0.0;
  std::string unit = {};  ///< of its value, "" = none
};

/// Chance of as much as a finding's score, were all noise `factor` times as large as it is believed
/// to be: of score over max(factor^2, what the effect leaves of chi^2 per degree of freedom), times
/// the tests, at most 1. Less noise than believed makes nothing surer: the errors are as large as
/// they are.
[[nodiscard]] double p_with_noise(const Diagnosis& diagnosis, std::size_t finding, double factor);

/// A leg of the recordings.
struct TriedLeg {
  std::size_t number = 0;  ///< among all legs, as LegPrediction's
  std::size_t recording = 0;
  std::string from;  ///< landmarks; empty between truth rows or fixes
  std::string to;
  TimeSpan time;                    ///< as recorded
  Vector2 begin = Vector2::Zero();  ///< m, map frame, where the robot was
  Vector2 end = Vector2::Zero();
  bool held_out = false;  ///< the model is judged by it: it cannot be excluded
  bool excluded = false;  ///< no fit sees it
};

/// What a model is being tried for at the moment.
enum class TryingStage { fitting, searching, comparing };

/// A model with all that a workbench shows of it. Copies share everything. Calls from several
/// threads wait for each other.
class TriedModel {
 public:
  /// The model's effects are fitted whether or not they have coefficients. Throws like fit_model.
  TriedModel(std::shared_ptr<const std::vector<DrivenRecording>> recordings, const Model& model,
             const DiagnoseOptions& options = {},
             const std::function<void(TryingStage)>& progress = {});

  /// Of recordings as this model has them; `recordings` are those of them that it is judged by.
  TriedModel(PreparedRecordings rows, const Model& model, const DiagnoseOptions& options = {},
             const std::function<void(TryingStage)>& progress = {});

  [[nodiscard]] const std::vector<DrivenRecording>& recordings() const;
  [[nodiscard]] const DiagnoseOptions& options() const;
  /// By the noise that it is judged by: estimated, where the options say so.
  [[nodiscard]] const ModelFit& fit() const;
  [[nodiscard]] const Diagnosis& diagnosis() const;
  [[nodiscard]] const std::vector<FindingSize>& sizes() const;  ///< one per finding
  [[nodiscard]] const Comparison& comparison() const;
  [[nodiscard]] const FittedMap& map() const;
  [[nodiscard]] const std::vector<NoiseBudget>& budget() const;

  /// What a finding (its place in the diagnosis) has that can be moved; may be empty.
  [[nodiscard]] std::vector<EffectParameter> parameters(std::size_t finding) const;
  /// The finding's effect with other values of these; without coefficients. Throws
  /// std::invalid_argument where they are not as many.
  [[nodiscard]] Effect moved(std::size_t finding, const std::vector<double>& values) const;
  /// The values near these that explain the most; `only`: that one moves, the others stay.
  [[nodiscard]] std::vector<double> best_near(std::size_t finding,
                                              const std::vector<double>& values,
                                              std::optional<std::size_t> only = {}) const;

  /// Throws std::invalid_argument, in a sentence, on an effect that cannot be applied to these
  /// recordings (a variable that they do not have, a value that is not finite).
  /// The response is that of the legs of these numbers; of all without any.
  [[nodiscard]] EffectPreview preview(const Effect& effect, const std::vector<Effect>& rivals = {},
                                      const std::vector<std::size_t>& legs = {}) const;

  /// An effect of the model by its place there, as the measurements show it beside the others.
  /// Throws std::out_of_range.
  [[nodiscard]] EffectEvidence shown(std::size_t effect,
                                     const std::vector<std::size_t>& legs = {}) const;

  /// All of them, in order of their numbers.
  [[nodiscard]] const std::vector<TriedLeg>& legs() const;

 private:
  struct Tried;
  std::shared_ptr<const Tried> tried_;
};

/// Numbers of the legs of which the straight way crosses the rectangle between two corners, m, map
/// frame.
[[nodiscard]] std::vector<std::size_t> legs_in_area(const TriedModel& model, const Vector2& corner,
                                                    const Vector2& opposite);
/// Of those that a span of time has a part of; recordings one after the other, from 0 on.
[[nodiscard]] std::vector<std::size_t> legs_in_time(const TriedModel& model,
                                                    const TimeSpan& elapsed);

/// One model on the way.
struct WorkbenchStep {
  enum class Kind { given, add, remove, exclude, include };
  Kind kind = Kind::given;
  std::string effect;                 ///< that was added or removed
  std::size_t from = 0;               ///< the step that it began at; of the first its own
  std::string label = {};             ///< what its maker calls it; empty: nothing
  std::vector<Effect> could_be = {};  ///< that recordings could not tell from what was added then
  Model model;                        ///< what was added has no coefficients
  /// FitOptions::excluded here.
  std::vector<std::vector<TimeSpan>> excluded = {};
  std::size_t excluded_legs = 0;
  double arrival_rms = 0.0;                            ///< m, of the held-out legs; 0 without any
  double expected_rms = 0.0;                           ///< m, likewise, by the noise
  std::optional<double> predicted_rms = std::nullopt;  ///< m, before the fit
  double chi2 = 0.0;
  int dof = 0;
};

/// Steps, and at which of them the work is.
struct WorkbenchLog {
  std::vector<WorkbenchStep> steps;  ///< the first is the model given
  std::size_t at = 0;
};

/// From the given model to this step, by `from`.
[[nodiscard]] std::vector<std::size_t> way_to(const WorkbenchLog& log, std::size_t step);

/// What is told while a step is made; each may be empty.
struct WorkbenchWatch {
  std::function<void(TryingStage)> progress = {};
  /// The model by the noise that it states, and the log with its step, while the noise is still
  /// being estimated: a first look, whose figures change a little. Only where that changes
  /// anything.
  std::function<void(const TriedModel&, const WorkbenchLog&)> provisional = {};
};

class Workbench {
 public:
  /// Begins with the model as given.
  Workbench(std::vector<DrivenRecording> recordings, const Model& model,
            const DiagnoseOptions& options = {}, const WorkbenchWatch& watch = {});
  /// Goes on where a log ends. Throws std::invalid_argument on a log without steps or with steps
  /// that come from none.
  Workbench(std::vector<DrivenRecording> recordings, WorkbenchLog log,
            const DiagnoseOptions& options = {}, const WorkbenchWatch& watch = {});

  /// Both, of recordings as the model given has them: which of their sightings a model is judged by
  /// is asked of each (prepared_again).
  Workbench(PreparedRecordings rows, const Model& model, const DiagnoseOptions& options = {},
            const WorkbenchWatch& watch = {});
  Workbench(PreparedRecordings rows, WorkbenchLog log, const DiagnoseOptions& options = {},
            const WorkbenchWatch& watch = {});

  [[nodiscard]] const TriedModel& now() const { return *now_; }
  [[nodiscard]] const WorkbenchLog& log() const { return log_; }

  // Each makes a step, or throws like fit_model (std::invalid_argument: an effect of this name is
  // there already, or cannot be applied; std::out_of_range) and leaves all as it was.

  void add(const Effect& effect, const WorkbenchWatch& watch = {});
  void remove(std::size_t effect, const WorkbenchWatch& watch = {});
  /// Fits without the legs of these numbers, too, from here on, and without what only they tie to
  /// the map. Held-out legs stay; std::invalid_argument where there are no others.
  void exclude(const std::vector<std::size_t>& legs, const WorkbenchWatch& watch = {});
  /// Takes back in what has been excluded here.
  void include_all(const WorkbenchWatch& watch = {});
  /// What a step is called from now on; empty: nothing. Throws std::out_of_range.
  void rename(std::size_t step, std::string label);
  /// Back, or on, to a step that was made.
  void go_to(std::size_t step, const WorkbenchWatch& watch = {});

 private:
  [[nodiscard]] TriedModel tried(const WorkbenchLog& log, const WorkbenchWatch& watch) const;
  [[nodiscard]] TriedModel tried(const Model& model, const DiagnoseOptions& options,
                                 const WorkbenchWatch& watch) const;
  [[nodiscard]] WorkbenchStep from_here(WorkbenchStep::Kind kind) const;
  void take(WorkbenchStep step, const WorkbenchWatch& watch);

  PreparedRecordings rows_;  ///< without recordings of its own
  std::shared_ptr<const std::vector<DrivenRecording>> recordings_;
  DiagnoseOptions options_;
  WorkbenchLog log_;
  std::optional<TriedModel> now_;
  /// The last few, so that undoing takes no time: step and what it came to.
  std::vector<std::pair<std::size_t, TriedModel>> kept_;
};

// ----------------------------------------
// Its log as JSON, with what tells its recordings from others.

[[nodiscard]] std::string format_workbench_log(const WorkbenchLog& log,
                                               const std::vector<DrivenRecording>& recordings);

/// Numbers and models read back exactly. Throws InputError: no such file, no log, or one of other
/// recordings.
[[nodiscard]] WorkbenchLog read_workbench_log(const std::filesystem::path& file,
                                              const std::vector<DrivenRecording>& recordings);

}  // namespace trussmap
