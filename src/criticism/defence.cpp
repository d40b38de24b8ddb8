// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/defence.hpp"

#include "criticism/candidates.hpp"
#include "criticism/effect_or_process.hpp"
#include "criticism/formulas.hpp"
#include "criticism/refits.hpp"
#include "fit/process_columns.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {
namespace {

constexpr Eigen::Index kMostSteps = 256;  // of a process
/// Effects of the catalogue have half of the level, all others the other half, as in the search.
constexpr double kShareOfLevel = 0.5;

bool is_of_gyro(Channel channel) {
  return channel == Channel::gyro || channel == Channel::gyro_scale;
}

bool is_among(const NoiseProcess& process, const Noise& noise) {
  return std::any_of(
      noise.processes.begin(), noise.processes.end(),
      [&process](const NoiseProcess& other) { return fitting::is_same_source(process, other); });
}

bool is_of_catalogue(const Candidate& one) {
  return one.form == Form::catalogue && one.family.empty();
}

/// A fit as it would be laid out with some of its effects, from `first` on, known to be 0.
fitting::FitState lacking(const fitting::FitState& with, std::size_t first,
                          const std::vector<bool>& has) {
  fitting::FitState fit = with;
  const std::vector<int> unknown = estimation::unknown_coefficients(with.columns.border);
  std::vector<double> kept;
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const std::size_t effect = with.columns.coefficients[idx(unknown[k])].effect;
    if (effect < first || has[effect - first]) {
      kept.push_back(with.adjustment.coefficients[static_cast<Eigen::Index>(k)]);
      continue;
    }
    fit.columns.border[idx(unknown[k])].held = 0.0;
  }
  fit.adjustment.coefficients =
      Eigen::Map<const Eigen::VectorXd>(kept.data(), static_cast<Eigen::Index>(kept.size()));
  return fit;
}

/// The question of one recording's effects. Likelihoods are asked for where the fit with all of
/// them is: large effects bend the rows, and what a plane leaves of them would pass for noise.
class Defence {
 public:
  /// `with`: the fit with the effects, its last ones.
  Defence(const FitWithNoise& found, const ModelFit& with, const std::vector<Effect>& effects,
          const DefenceOptions& options)
      : fit_(*found.fit.state),
        with_(*with.state),
        noise_(found.fit.model.noise),
        effects_(effects),
        options_(options),
        tests_(fit_),
        stand_(effects.size(), true) {
    for (const Effect& one : effects) columns_.push_back(tests_.columns(one));
    fit_options_.errors = false;
  }

  std::vector<bool> run() {
    for (std::size_t k = 0; k < effects_.size(); ++k) stand_[k] = stands(k);
    return stand_;
  }

  /// Without those that do not stand.
  FittedNoise likeliest_noise() {
    FittedNoise result = noise_with(stand_);
    for (const NoiseSource& rival : rivals_) {
      const bool is_there = std::any_of(result.noise.processes.begin(),
                                        result.noise.processes.end(), [&](const NoiseProcess& one) {
                                          return is_of_sensor(one.channel, rival.process.channel);
                                        });
      if (is_there) continue;
      result.noise.processes.push_back(rival.process);
      result.sources.push_back(rival);
      result.gain += rival.gain;
    }
    return result;
  }

 private:
  [[nodiscard]] static bool is_of_sensor(Channel process, Channel effect) {
    return process == effect || (is_of_gyro(process) && is_of_gyro(effect));
  }

  [[nodiscard]] Eigen::MatrixXd together(const std::vector<bool>& wanted) const {
    Eigen::MatrixXd all(tests_.system().rows(), 0);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (wanted[k]) linalg::append_columns(all, columns_[k]);
    }
    return all;
  }

  [[nodiscard]] Eigen::MatrixXd others(std::size_t k) const {
    std::vector<bool> wanted(effects_.size(), true);
    wanted[k] = false;
    return together(wanted);
  }

  [[nodiscard]] std::size_t first() const { return with_.model.effects.size() - effects_.size(); }

  [[nodiscard]] FittedNoise noise_with(const std::vector<bool>& wanted) const {
    const fitting::FitState fit = lacking(with_, first(), wanted);
    fitting::NoiseReml reml(fit, options_.stated);
    return fitting::fit_noise(reml, {}, fit_options_);
  }

  /// With the wanted effects' coefficients at their likeliest, and not integrated out.
  [[nodiscard]] double minus_two_log(const std::vector<bool>& wanted, const Noise& noise) const {
    const fitting::FitState fit = lacking(with_, first(), wanted);
    fitting::NoiseReml reml(fit, options_.stated);
    const double integrated = fitting::minus_two_log_under(reml, noise, {});
    std::vector<Eigen::Index> own;
    const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      if (fit.columns.coefficients[idx(unknown[k])].effect >= first()) {
        own.push_back(static_cast<Eigen::Index>(k));
      }
    }
    if (own.empty()) return integrated;
    const Eigen::MatrixXd covariance = reml.system().coefficient_covariance()(own, own);
    return integrated + linalg::DenseLdlt(covariance).log_determinant();
  }

  [[nodiscard]] bool stands(std::size_t k) {
    std::optional<FittedNoise> without;
    std::vector<bool> others_alone(effects_.size(), true);
    others_alone[k] = false;
    if (!options_.as_stated) without = noise_with(others_alone);
    if (const std::optional<NoiseProcess> rival = rival_of(effects_[k], without)) {
      if (const std::optional<bool> answer = stands_against(k, *rival)) return *answer;
    }
    if (!without || without->noise == noise_) return true;
    if (!with_all_) with_all_ = minus_two_log(std::vector<bool>(effects_.size(), true), noise_);
    const double alone = minus_two_log(others_alone, without->noise);
    const double p = statistics::chi2_p_value(std::max(0.0, alone - *with_all_),
                                              static_cast<int>(columns_[k].cols()));
    return options_.tried * p < options_.level;
  }

  /// The process of its own sensor that would stand for it, where it does not stand beside it
  /// already.
  [[nodiscard]] std::optional<NoiseProcess> rival_of(
      const Effect& effect, const std::optional<FittedNoise>& without) const {
    if (without) {
      for (const NoiseProcess& one : without->noise.processes) {
        if (is_of_sensor(one.channel, effect.channel) && !is_among(one, noise_)) return one;
      }
    }
    NoiseProcess walk;
    walk.channel = Channel::gyro;
    walk.process = ProcessKind::walk_in_t;
    if (is_of_gyro(effect.channel) && !is_among(walk, noise_)) return walk;
    return std::nullopt;
  }

  /// The effect's own columns first, then those of the others that one asks of besides.
  [[nodiscard]] std::vector<Effect> asked_with(const Effect& effect) const {
    std::vector<Candidate> candidates = candidates_for(fit_, tests_.context());
    std::erase_if(candidates,
                  [&effect](const Candidate& one) { return one.effect.channel != effect.channel; });
    const bool known =
        std::any_of(candidates.begin(), candidates.end(), [&effect](const Candidate& one) {
          return is_of_catalogue(one) && one.effect.name == effect.name;
        });
    // Of a formula one asks all others besides.
    if (std::none_of(candidates.begin(), candidates.end(),
                     [&effect](const Candidate& one) { return one.effect.name == effect.name; })) {
      for (Candidate& one : FormulaGrammar(fit_, tests_.context()).of(effect.channel)) {
        candidates.push_back(std::move(one));
      }
    }
    std::vector<Effect> asked{effect};
    for (const Candidate& one : candidates) {
      const bool same = one.effect.name == effect.name && one.form != Form::formula;
      if (!same && (!known || is_of_catalogue(one))) asked.push_back(one.effect);
    }
    return asked;
  }

  [[nodiscard]] std::optional<bool> stands_against(std::size_t k, NoiseProcess rival) {
    ScoreTest tests = tests_;
    tests.condition_on(others(k));
    const std::optional<Eigen::MatrixXd> steps =
        fitting::process_columns(fit_, rival, tests.residuals().size(), kMostSteps);
    if (!steps || steps->isZero(0.0)) return std::nullopt;
    std::vector<Eigen::MatrixXd> columns;
    for (const Score& one : tests.test(asked_with(effects_[k]))) {
      if (one.dof > 0) {
        columns.push_back(one.projected);
      } else if (columns.empty()) {
        return std::nullopt;
      }
    }
    const EffectOrProcess question(tests.residuals(), tests.projected(*steps), columns);
    const double p = question.chance_of_process(0);
    if (p < kShareOfLevel * options_.level) return true;
    rival.sd = std::sqrt(question.likeliest_variance());
    NoiseSource source;
    source.name = fitting::name_of_source(rival);
    source.lasts = true;
    source.process = rival;
    source.sd = rival.sd;
    source.gain = question.gain_of_process();
    if (rival.sd > 0.0) rivals_.push_back(source);
    return false;
  }

  const fitting::FitState& fit_;
  const fitting::FitState& with_;
  const Noise& noise_;
  const std::vector<Effect>& effects_;
  const DefenceOptions& options_;
  ScoreTest tests_;
  NoiseFitOptions fit_options_;
  std::vector<Eigen::MatrixXd> columns_;
  std::vector<bool> stand_;
  std::optional<double> with_all_;   ///< -2 log likelihood; once asked for
  std::vector<NoiseSource> rivals_;  ///< that stand for an effect
};

}  // namespace

Defended defended_against_noise(const std::vector<DrivenRecording>& recordings,
                                const FitWithNoise& found, const std::optional<ModelFit>& with,
                                const std::vector<Effect>& effects, const DefenceOptions& options) {
  Defended result;
  if (!with) {  // nobody knows then
    result.effects.assign(effects.size(), true);
    return result;
  }
  Defence defence(found, *with, effects, options);
  result.effects = defence.run();
  if (std::find(result.effects.begin(), result.effects.end(), false) == result.effects.end()) {
    return result;
  }
  FitWithNoise otherwise{found.fit, defence.likeliest_noise()};
  otherwise.fit = refit_under(recordings, found.fit, otherwise.noise.noise);
  result.otherwise = std::move(otherwise);
  return result;
}

}  // namespace trussmap::criticism
