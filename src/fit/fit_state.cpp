// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fit_state.hpp"

#include "drive/wheels_and_gyro.hpp"
#include "effects/steering.hpp"
#include "estimation/common_errors.hpp"
#include "estimation/recording_descent.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/segment_noise.hpp"
#include "estimation/student_tails.hpp"
#include "fit/cleared_recording.hpp"
#include "fit/noise_free.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace trussmap {
namespace {

constexpr double kMostDispersion = 4.0;  // chi^2/dof
constexpr int kMisfitRounds = 4;
constexpr int kShortStretch = 20;  // poses
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::map<std::string, Vector2> places_in(const RecordingProblem& problem,
                                         const RecordingState& state) {
  std::map<std::string, Vector2> places;
  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    places[problem.landmarks[k]] = state.landmarks[k];
  }
  return places;
}

/// Rounds of fitting and looking at the path again.
class Fitter {
 public:
  Fitter(const std::vector<Recording>& recordings, const Model& model, const FitterOptions& options)
      : raw_(recordings),
        together_(has_gyro(recordings) ? with_gyro(recordings, model.robot, model.noise)
                                       : std::vector<Recording>()),
        recorded_(together_.empty() ? recordings : together_),
        options_(options) {
    fit_.model = model;
    if (options.free_common_errors) {
      for (const Effect& effect : common_errors(recordings)) fit_.model.effects.push_back(effect);
      fit_.common_errors = fit_.model.effects.size() - model.effects.size();
    }
    for (Effect& effect : fit_.model.effects) {
      effect.coefficients = coefficients_of(effect, recordings.size());
    }
    given_ = fit_.model.effects;
    for (const Effect& effect : fit_.model.effects) {
      not_fitted_.emplace_back(effect.coefficients.size());
    }
  }

  FitState run() {
    lay_out();
    start(StartKind::common_errors);
    for (int round = 0; round < options_.max_rounds; ++round) {
      round_ = round;
      const bool again = round > 0 && layout_moved();
      if (again) lay_out_again();
      build_columns();
      // What is laid out anew is linearised along its record, and not at the noise believed so far.
      if (again) static_cast<void>(relinearised());
      if (round == 0 && options_.fit_effects) hold_unobservable();
      if (round == 0) {
        adjust_from_starts();
      } else {
        adjust_once(false);
      }
      fit_.settled = settled();
      const bool last = fit_.settled || round + 1 == options_.max_rounds;
      if ((round == 0 || last) && options_.fit_effects && fix_unobservable()) {
        fit_.settled = false;
        continue;
      }
      if (fit_.settled) break;
    }
    if (options_.paths && !columns_see_paths()) lay_paths();
    report();
    return std::move(fit_);
  }

 private:
  /// Whether it is one of the common errors, which have a prior and so are always determined.
  [[nodiscard]] bool is_common(std::size_t effect) const {
    return effect + fit_.common_errors >= fit_.model.effects.size();
  }

  /// Since delays and steering were laid out, by more than their columns can stand for.
  [[nodiscard]] bool layout_moved() const {
    constexpr double kMoved = 0.02;  // standard deviations
    if (steering_sees_path()) return true;
    const std::vector<int> unknown = unknown_coefficients(fit_.columns.border);
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const Coefficient& one = fit_.columns.coefficients[idx(unknown[k])];
      const Effect& effect = fit_.model.effects[one.effect];
      if (!is_laid_out(effect.channel)) continue;
      const auto at = static_cast<Eigen::Index>(k);
      const double sd = std::sqrt(fit_.adjustment.coefficient_covariance(at, at));
      const double moved =
          effect.coefficients[one.place] - laid_out_[one.effect].coefficients[one.place];
      if (std::abs(moved) > kMoved * sd) return true;
    }
    return false;
  }

  /// Then what was laid out by another path is not what its columns say.
  [[nodiscard]] bool steering_sees_path() const {
    return std::any_of(
        fit_.model.effects.begin(), fit_.model.effects.end(), [](const Effect& effect) {
          return is_steering(effect.channel) &&
                 std::any_of(effect.shape.begin(), effect.shape.end(), [](const Shape& shape) {
                   const std::vector<std::string>& names = shape.variables();
                   return std::any_of(names.begin(), names.end(), [](const std::string& name) {
                     return name == "heading" || name == "x" || name == "y";
                   });
                 });
        });
  }

  /// What was recorded, driven as the steering effects say.
  [[nodiscard]] std::vector<Recording> as_steered() const {
    if (!steers(fit_.model.effects)) return recorded_;
    std::vector<Recording> result = steered(raw_, fit_.model.effects, fit_.model.robot, fit_.paths);
    return has_gyro(result) ? with_gyro(result, fit_.model.robot, fit_.model.noise) : result;
  }

  void lay_out() {
    laid_out_ = fit_.model.effects;
    fit_.recordings = retimed(as_steered(), fit_.model.effects, fit_.model.robot);
    fit_.used = problem_options();
    fit_.problem = make_problem(fit_.recordings, fit_.model, fit_.used);
  }

  [[nodiscard]] ProblemOptions problem_options() const {
    ProblemOptions result = options_.problem;
    if (result.left_out.size() > recorded_.size()) {
      throw std::invalid_argument(joined("spans are left out of ", result.left_out.size(),
                                         " recordings, of which there are ", recorded_.size()));
    }
    result.left_out.resize(result.left_out.empty() ? 0 : recorded_.size());
    for (std::size_t s = 0; s < result.left_out.size(); ++s) {
      std::vector<double> ends;
      for (const TimeSpan& span : result.left_out[s]) {
        ends.push_back(span.from);
        ends.push_back(span.to);
      }
      ends = retimed(ends, recorded_[s], s, recorded_.size(), fit_.model.effects, fit_.model.robot,
                     delay_of_legs(recorded_[s]));
      for (std::size_t k = 0; k < result.left_out[s].size(); ++k) {
        result.left_out[s][k] = {ends[2 * k], ends[2 * k + 1]};
      }
    }
    return result;
  }

  /// The poses of the new instants lie on the old path.
  void lay_out_again() {
    const std::map<std::string, Vector2> landmarks = places_in(fit_.problem, state_);
    lay_out();
    place(landmarks);
  }

  void place(const std::map<std::string, Vector2>& landmarks) {
    state_.landmarks.clear();
    for (const std::string& name : fit_.problem.landmarks) {
      state_.landmarks.push_back(landmarks.at(name));
    }
    state_.noise.resize(0);
    state_.poses.clear();
    for (const PoseNode& node : fit_.problem.poses) {
      const std::size_t session = idx(node.session);
      state_.poses.push_back(pose_at(fit_.recordings[session].drive, fit_.paths[session], node.t));
    }
    state_.orientations = orientations_seen_from(fit_.problem, state_.poses);
  }

  /// More sightings contradict the rest than are ever wrong or, where none may go and no compass
  /// led the start, the errors are far too large: perhaps the start was lost.
  [[nodiscard]] bool lost() const {
    constexpr double kFarTooLarge = 10.0;  // chi^2/dof
    if (options_.near != nullptr) return false;
    if (fit_.common_errors > 0 && options_.most_left_out < 1.0) {
      return fit_.adjustment.gate_widened > 1.0;
    }
    const bool led = std::any_of(recorded_.begin(), recorded_.end(),
                                 [](const Recording& one) { return one.drive.has_compass(); });
    return !led && fit_.adjustment.chi2 > kFarTooLarge * std::max(1, fit_.adjustment.dof);
  }

  /// How a start may be laid down, in the order in which they are tried.
  enum class StartKind { common_errors, none_wrong, short_stretches, careful };

  /// A start may be so far off that the adjustment runs away from it and finds all of it loose:
  /// others are tried before that is believed.
  void adjust_from_starts() {
    try {
      adjust_once(true);
    } catch (const SolveError&) {
      if (options_.near != nullptr || !start_again(false)) throw;
      return;
    }
    if (lost()) static_cast<void>(start_again(true));
  }

  /// From other starts, unless they lead to nothing better than what is `adjusted`. False where
  /// there is no adjustment then.
  bool start_again(bool adjusted) {
    FitState best = fit_;
    RecordingState best_state = state_;
    for (const StartKind kind :
         {StartKind::none_wrong, StartKind::short_stretches, StartKind::careful}) {
      for (std::size_t e = 0; e < fit_.model.effects.size(); ++e) {
        std::vector<double>& values = fit_.model.effects[e].coefficients;
        if (is_common(e)) std::fill(values.begin(), values.end(), 0.0);
      }
      start(kind);
      build_columns();
      try {
        adjust_once(true);
      } catch (const SolveError&) {
        continue;
      }
      if (!adjusted || fit_.adjustment.gate_widened < best.adjustment.gate_widened ||
          (fit_.adjustment.gate_widened == best.adjustment.gate_widened &&
           fit_.adjustment.chi2 < best.adjustment.chi2)) {
        best = fit_;
        best_state = state_;
        adjusted = true;
      }
      if (!lost()) break;
      // Without a gate a careful start is like any other.
      if (!options_.gate && kind == StartKind::short_stretches) break;
    }
    fit_ = std::move(best);
    state_ = std::move(best_state);
    return adjusted;
  }

  void start(StartKind kind) {
    if (options_.near != nullptr) {
      fit_.paths = options_.near->paths;
      if (has_nodes_of(*options_.near)) {
        state_ = options_.near->adjustment.state;
      } else {
        place(landmark_places(*options_.near));
      }
      return;
    }
    StartOptions how;
    how.careful = kind == StartKind::careful;
    if (kind == StartKind::short_stretches) how.first_stretch = kShortStretch;
    if (options_.gate) how.gate = *options_.gate;
    static_cast<void>(choose_gauge(fit_.problem));  // refuses what has no start
    // A start is laid along unbroken drives and, for a map, freed from the model's own effects: the
    // common errors are what is left.
    const bool freed = fit_.common_errors > 0 && !only_common();
    const bool as_fitted = options_.problem.left_out.empty() && !freed;
    const std::vector<Recording> without = freed ? without_own_effects() : std::vector<Recording>();
    const std::vector<Recording>& recordings = freed ? without : fit_.recordings;
    ProblemOptions all = options_.problem;
    all.left_out.clear();
    const RecordingProblem problem =
        as_fitted ? fit_.problem : make_problem(recordings, fit_.model, all);
    const Robot& robot = fit_.model.robot;
    const EffectParameters common = kind == StartKind::none_wrong
                                        ? EffectParameters()
                                        : common_error_columns(recordings, robot);
    RecordingStart start = start_of(problem, common, how);
    if (!common.empty()) take_common_errors(start.coefficients);
    if (!as_fitted || columns_see_paths()) {
      fit_.paths = fitted_paths(recordings, robot, problem, {}, {}, start.state);
    }
    if (as_fitted) {
      state_ = std::move(start.state);
    } else {
      place(places_in(problem, start.state));
    }
  }

  [[nodiscard]] std::vector<Recording> without_own_effects() const {
    Model own = fit_.model;
    own.effects.resize(fit_.model.effects.size() - fit_.common_errors);
    std::vector<Recording> result;
    for (ClearedRecording& one : cleared(raw_, own)) {
      result.push_back(std::move(one.recording));
    }
    return result;
  }

  /// Common errors alone need no path: their columns follow from the record.
  [[nodiscard]] bool only_common() const {
    return fit_.common_errors > 0 && fit_.common_errors == fit_.model.effects.size();
  }

  [[nodiscard]] bool columns_see_paths() const {
    return !fit_.model.effects.empty() && !only_common();
  }

  [[nodiscard]] bool has_nodes_of(const FitState& other) const {
    const auto same = [](const PoseNode& a, const PoseNode& b) {
      return a.session == b.session && a.t == b.t;
    };
    return fit_.problem.landmarks == other.problem.landmarks &&
           std::equal(fit_.problem.poses.begin(), fit_.problem.poses.end(),
                      other.problem.poses.begin(), other.problem.poses.end(), same);
  }

  [[nodiscard]] bool reads_compass() const {
    return std::any_of(fit_.model.effects.begin(), fit_.model.effects.end(),
                       [](const Effect& effect) { return effect.channel == Channel::compass; });
  }

  void build_common_columns() {
    Eigen::VectorXd values;
    fit_.columns = {};
    for (std::size_t e = 0; e < fit_.model.effects.size(); ++e) {
      const Effect& effect = fit_.model.effects[e];
      for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
        fit_.columns.coefficients.push_back({e, k, k, 1.0});
        values.conservativeResize(values.size() + 1);
        values[values.size() - 1] = effect.coefficients[k];
      }
    }
    fit_.columns.border = common_error_columns(fit_.recordings, fit_.model.robot, values);
  }

  void take_common_errors(const Eigen::VectorXd& coefficients) {
    Eigen::Index next = 0;
    for (std::size_t e = 0; e < fit_.model.effects.size(); ++e) {
      if (!is_common(e)) continue;
      for (double& one : fit_.model.effects[e].coefficients) one = coefficients[next++];
    }
  }

  void build_columns() {
    if (fit_.model.effects.empty()) return;
    if (only_common()) {
      build_common_columns();
      return;
    }
    const ShapeContext context(fit_.recordings, fit_.model.robot, fit_.paths);
    fit_.columns = effect_columns(fit_.model.effects, context);
    for (std::size_t k = 0; k < fit_.columns.border.size(); ++k) {
      const Coefficient& one = fit_.columns.coefficients[k];
      if (is_laid_out(fit_.model.effects[one.effect].channel)) {
        fit_.columns.border[k].reference = laid_out_[one.effect].coefficients[one.place];
      }
      if (is_common(one.effect)) {
        fit_.columns.border[k].prior_sd = common_error_sd(fit_.model.effects[one.effect]);
      } else if (!options_.fit_effects || not_fitted_[one.effect][one.place]) {
        fit_.columns.border[k].held = fit_.model.effects[one.effect].coefficients[one.place];
      }
    }
  }

  [[nodiscard]] Eigen::VectorXd unknown_values() const {
    const std::vector<int> unknown = unknown_coefficients(fit_.columns.border);
    Eigen::VectorXd values(static_cast<Eigen::Index>(unknown.size()));
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const Coefficient& one = fit_.columns.coefficients[idx(unknown[k])];
      values[static_cast<Eigen::Index>(k)] = fit_.model.effects[one.effect].coefficients[one.place];
    }
    return values;
  }

  void hold(int coefficient, NotFitted why, double uncertainty = 0.0) {
    const Coefficient& one = fit_.columns.coefficients[idx(coefficient)];
    not_fitted_[one.effect][one.place] = UnfittedCoefficient{one.place, why, uncertainty};
    const double value = given_[one.effect].coefficients[one.place];
    fit_.model.effects[one.effect].coefficients[one.place] = value;
    fit_.columns.border[idx(coefficient)].held = value;
  }

  /// Coefficients that no measurement tells from the unknowns, looked for at the best fit without
  /// them: far from it large residuals make anything appear observable.
  void hold_unobservable() {
    const std::vector<int> unknown = unknown_coefficients(fit_.columns.border);
    if (unknown.empty()) return;
    EffectParameters without = fit_.columns.border;
    for (const int k : unknown) {
      const Coefficient& one = fit_.columns.coefficients[idx(k)];
      without[idx(k)].held = fit_.model.effects[one.effect].coefficients[one.place];
    }
    RecordingAdjustmentOptions how;
    how.gate = options_.gate;
    fit_.adjustment = adjust_from(state_, fit_.problem, without, how);
    adjusted_ = fit_.problem.measurements.size();
    state_ = fit_.adjustment.state;
    take_paths();
    build_columns();
    while (fix_unobservable()) {
    }
  }

  /// The last coefficient that the data tell nothing of, or too little, gives way. Judged at a
  /// state without noise of its own: noise that a smaller map shrinks is no evidence of a scale.
  bool fix_unobservable() {
    const std::vector<int> free = unknown_coefficients(fit_.columns.border);
    if (free.empty()) return false;
    const NoiseFree clean(fit_.recordings, fit_.model, fit_.problem, fit_.columns.border,
                          offsets_of(fit_), state_);
    RecordingSystem system(clean.problem, clean.border);
    system.linearise(clean.state, unknown_values());
    try {
      system.factorise();
    } catch (const NotPositiveDefinite& error) {
      if (error.column() >= 0) throw;
    }
    const std::vector<int> lost = find_undetermined(system);
    if (lost.empty()) return hold_the_uncertain(system);
    give_way(free[idx(lost.back())]);
    return true;
  }

  /// The one added last gives way: the others may be determined without it.
  void give_way(int coefficient) { hold(coefficient, NotFitted::undetermined); }

  /// What the first time left out is only looked at again later.
  void adjust_once(bool first) {
    RecordingAdjustmentOptions how;
    how.gate = options_.gate;
    how.most_left_out = options_.most_left_out;
    how.landmark_uncertainties = options_.landmark_uncertainties;
    // A delay may move sightings out of the drive, or back into it: then all is looked at anew.
    const std::size_t measured = fit_.problem.measurements.size();
    if (!first) {
      if (adjusted_ == measured) how.near = &fit_.adjustment;
    } else if (options_.near != nullptr && options_.near->problem.measurements.size() == measured) {
      how.near = &options_.near->adjustment;
    }
    // What misfit without the effects hid may show only now, at the best fit with them.
    for (;;) {
      how.coefficients = unknown_values();
      try {
        RecordingAdjustment next = adjust_from(state_, fit_.problem, fit_.columns.border, how);
        fit_.adjustment = std::move(next);
        adjusted_ = measured;
        break;
      } catch (const UndeterminedError& error) {
        give_way(unknown_coefficients(fit_.columns.border)[idx(error.coefficients().back())]);
      }
    }
    state_ = fit_.adjustment.state;
    change_ = 0.0;
    const std::vector<int> unknown = unknown_coefficients(fit_.columns.border);
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const Coefficient& one = fit_.columns.coefficients[idx(unknown[k])];
      double& value = fit_.model.effects[one.effect].coefficients[one.place];
      const auto at = static_cast<Eigen::Index>(k);
      const double now = fit_.adjustment.coefficients[at];
      const double sd = std::sqrt(fit_.adjustment.coefficient_covariance(at, at));
      change_ =
          std::max(change_, std::abs(now - value) / (1e-9 * std::abs(now) + options_.still * sd));
      value = now;
    }
    take_paths();
  }

  void take_paths() {
    // Without effects nothing depends on the path but what asks for it afterwards.
    const std::vector<SessionPath> before = std::move(fit_.paths);
    if (columns_see_paths()) lay_paths();
    offset_change_ = relinearised();
    moved_ = 0.0;
    for (std::size_t s = 0; s < std::min(before.size(), fit_.paths.size()); ++s) {
      for (std::size_t row = 0; row < before[s].ends.size(); ++row) {
        const Pose& a = before[s].ends[row];
        const Pose& b = fit_.paths[s].ends[row];
        moved_ = std::max({moved_, (a.position() - b.position()).norm(),
                           std::abs(wrap_angle(a.heading - b.heading))});
      }
    }
  }

  /// The largest change of a measurement's value by it, in standard deviations.
  double relinearised() {
    // The residuals of a misfit are no estimate of noise, and need not come to rest; but where they
    // are is where the rows have to be linear, or what is missing explains too little of them.
    const bool noise = options_.relinearise &&
                       (round_ < kMisfitRounds ||
                        fit_.adjustment.chi2 < kMostDispersion * std::max(1, fit_.adjustment.dof));
    const EffectParameters& border = fit_.columns.border;
    const Eigen::VectorXd offsets = offsets_of(fit_);
    const double tails = take_tails(fit_.problem, border, offsets, state_);
    return noise ? std::max(tails, relinearise(fit_.problem, fit_.recordings, fit_.model, border,
                                               offsets, state_))
                 : tails;
  }

  void lay_paths() {
    fit_.paths = fitted_paths(fit_.recordings, fit_.model.robot, fit_.problem, fit_.columns.border,
                              offsets_of(fit_), state_);
  }

  /// The last of those that the data tell too little of gives way, as in give_way.
  bool hold_the_uncertain(const RecordingSystem& system) {
    const Eigen::MatrixXd covariance = system.coefficient_covariance();
    const std::vector<int> unknown = unknown_coefficients(fit_.columns.border);
    for (std::size_t k = unknown.size(); k-- > 0;) {
      const Coefficient& one = fit_.columns.coefficients[idx(unknown[k])];
      const Effect& effect = fit_.model.effects[one.effect];
      const auto at = static_cast<Eigen::Index>(k);
      const double share =
          1.0 / (covariance(at, at) * std::max(system.border().col(at).squaredNorm(), 1e-300));
      const double uncertainty =
          std::sqrt(covariance(at, at)) * one.largest / facts_of(effect.channel).prior_sd;
      if (share >= kLeastShare && uncertainty <= kLargestUncertainty) continue;
      hold(unknown[k], uncertainty > kLargestUncertainty ? NotFitted::uncertain : NotFitted::faint,
           uncertainty);
      return true;
    }
    return false;
  }

  /// Instants that a delay moves cut rows anew, whose rounding comes back larger.
  [[nodiscard]] double still_enough() const {
    constexpr double kCutAnew = 100.0;
    const bool delays = std::any_of(fit_.model.effects.begin(), fit_.model.effects.end(),
                                    [](const Effect& effect) { return is_delay(effect.channel); });
    return delays ? kCutAnew : 1.0;
  }

  /// Neither a coefficient nor the path has moved, from which the columns were made.
  [[nodiscard]] bool settled() const {
    constexpr double kStill = 1e-6;  // m and rad
    if (offset_change_ > options_.still_offset) return false;
    if (fit_.columns.border.empty() || (only_common() && !reads_compass())) return true;
    return unknown_coefficients(fit_.columns.border).empty() ? moved_ < kStill
                                                             : change_ < still_enough();
  }

  void report() {
    for (std::size_t e = 0; e < fit_.model.effects.size(); ++e) {
      const Effect& effect = fit_.model.effects[e];
      EffectEstimate estimate{effect, std::vector<double>(effect.coefficients.size(), 0.0), {}};
      for (std::size_t place = 0; place < effect.coefficients.size(); ++place) {
        if (!not_fitted_[e][place]) continue;
        estimate.sd[place] = kInfinity;
        estimate.not_fitted.push_back(*not_fitted_[e][place]);
      }
      fit_.effects.push_back(std::move(estimate));
    }
    const std::vector<int> unknown = unknown_coefficients(fit_.columns.border);
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const Coefficient& one = fit_.columns.coefficients[idx(unknown[k])];
      const auto at = static_cast<Eigen::Index>(k);
      fit_.effects[one.effect].sd[one.place] =
          std::sqrt(fit_.adjustment.coefficient_covariance(at, at));
    }
    for (const NoiseProcess& one : fit_.model.noise.processes) {
      if (!(one.tails > 0.0) || has_used_tails(one)) continue;
      fit_.adjustment.warnings.push_back(
          joined("the tails of the noise ", name_of(one.channel), ", ", name_of(one.process),
                 " are not used: only white noise of sightings has them"));
    }
    if (!fit_.settled) {
      fit_.adjustment.warnings.push_back(
          joined("shapes and path did not settle in ", options_.max_rounds,
                 " rounds; in the last the path moved by up to ", moved_,
                 " m or rad, a measurement by up to ", offset_change_, " standard deviations"));
    }
  }

  const std::vector<Recording>& raw_;
  std::vector<Recording> together_;  ///< with the gyro taken in, where there is one
  const std::vector<Recording>& recorded_;
  FitterOptions options_;
  FitState fit_;
  RecordingState state_;
  std::size_t adjusted_ = 0;      ///< measurements of the last adjustment
  std::vector<Effect> given_;     ///< with the coefficients at first
  std::vector<Effect> laid_out_;  ///< with those by which delays and steering are laid out
  /// Per effect and place; nothing where fitted.
  std::vector<std::vector<std::optional<UnfittedCoefficient>>> not_fitted_;
  double change_ = 0.0;  ///< of the coefficients, in what is negligible
  int round_ = 0;
  double offset_change_ = 0.0;  ///< of the linearisation offsets, in sds
  double moved_ = 0.0;          ///< of the path, m and rad
};

}  // namespace

RecordingProblem whole_problem(const FitState& fit) {
  ProblemOptions all = fit.used;
  all.left_out.clear();
  return make_problem(fit.recordings, fit.model, all);
}

std::map<std::string, Vector2> landmark_places(const FitState& fit) {
  return places_in(fit.problem, fit.adjustment.state);
}

Eigen::VectorXd offsets_of(const FitState& fit) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(fit.columns.border.size()));
  for (std::size_t k = 0; k < fit.columns.border.size(); ++k) {
    const Coefficient& one = fit.columns.coefficients[k];
    result[static_cast<Eigen::Index>(k)] =
        fit.model.effects[one.effect].coefficients[one.place] - fit.columns.border[k].reference;
  }
  return result;
}

FitState fit_recordings(const std::vector<Recording>& recordings, const Model& model,
                        const FitterOptions& options) {
  return Fitter(recordings, model, options).run();
}

}  // namespace trussmap
