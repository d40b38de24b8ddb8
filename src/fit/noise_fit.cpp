// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_fit.hpp"

#include "fit/fit_numbers.hpp"
#include "fit/noise_mix.hpp"
#include "fit/noise_screening.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/noise_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace trussmap {
using namespace fitting;

namespace {

/// What is asked, the same for all stages.
struct Question {
  NoiseReml& reml;
  const NoiseFitOptions& options;
  std::vector<NoiseComponent> candidates;
  NoiseExtents extents;
};

NoiseMember member_of(const NoiseComponent& component, double sd, double length, bool free) {
  NoiseMember one;
  one.component = component;
  one.sd = sd;
  one.length = length;
  one.free = free;
  return one;
}

NoiseMix stated_mix(const NoiseReml& reml) {
  NoiseMix mix;
  for (const NoiseComponent& one : white_components(reml.fit(), reml.stated())) {
    mix.members.push_back(member_of(one, one.stated, 0.0, false));
  }
  for (const NoiseComponent& one : processes_of(reml.stated())) {
    mix.members.push_back(member_of(one, one.stated, one.process.length, true));
  }
  return mix;
}

/// The sizes that the fit was made with, and what it had more than was stated.
NoiseMix present_mix(const NoiseReml& reml, NoiseMix mix) {
  const Noise& present = reml.fit().model.noise;
  for (NoiseMember& one : mix.members) one.sd = size_in(present, one.component);
  for (const auto& more : {white_components(reml.fit(), present), processes_of(present)}) {
    for (NoiseComponent one : more) {
      if (mix.has(one.name)) continue;
      const double sd = one.stated;
      one.stated = 0.0;
      mix.members.push_back(member_of(one, sd, one.process.length, true));
    }
  }
  return mix;
}

/// Laid out, with the likelihood of its sizes.
NoiseMix taken(NoiseReml& reml, NoiseMix mix) {
  choose(reml, mix);
  mix.minus_two_log = deviance(reml, sizes_of(mix));
  return mix;
}

// ----------------------------------------
// White sizes: other than stated only where the likelihood insists.

NoiseMix stated_where_possible(const Question& asked, NoiseMix mix) {
  bool kept = false;
  for (std::size_t k = 0; k < mix.members.size(); ++k) {
    NoiseMember& one = mix.members[k];
    if (one.component.lasts() || one.component.stated == 0.0 || mix.is_beside_a_process(k)) {
      continue;
    }
    NoiseReml::Sizes as_stated = sizes_of(mix);
    as_stated.sd[k] = one.component.stated;
    const double value = deviance(asked.reml, as_stated);
    one.gain = value - mix.minus_two_log;
    const double off = std::abs(std::log(one.sd / one.component.stated));
    if (one.gain >= kAsStated && off > kNegligible) continue;
    one.sd = one.component.stated;
    mix.minus_two_log = value;
    one.gain = 0.0;
    one.free = false;
    kept = true;
  }
  if (!kept) return mix;
  return likeliest(asked.reml, mix, asked.extents, mix.free(), kMostSteps, kLeastGain);
}

NoiseMix with_white_sizes(const Question& asked, NoiseMix mix) {
  for (NoiseMember& one : mix.members) one.free = true;
  mix = likeliest(asked.reml, mix, asked.extents, mix.free(), kMostSteps, kLeastGain);
  return stated_where_possible(asked, std::move(mix));
}

// ----------------------------------------
// Processes, one after the other.

/// Half of chi^2's (a variance cannot be negative; Self & Liang 1987), times the kinds asked of: of
/// one kind, lengths are as good as one.
double p_value_of(const Question& asked, double gain, const NoiseComponent& one) {
  const int dof = one.process.length > 0.0 ? 2 : 1;
  const std::vector<NoiseComponent>& all = asked.candidates;
  std::size_t kinds = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    kinds += k == 0 || all[k].name != all[k - 1].name ? 1U : 0U;
  }
  return std::min(
      1.0, 0.5 * static_cast<double>(kinds) * statistics::chi2_p_value(std::max(gain, 0.0), dof));
}

/// What an earlier fit took in, perhaps for an effect that it lacked, goes where it is no longer
/// wanted.
NoiseMix without_superfluous(const Question& asked, NoiseMix mix) {
  for (std::size_t k = mix.members.size(); k-- > 0;) {
    NoiseMember& one = mix.members[k];
    if (one.component.stated > 0.0) continue;
    NoiseReml::Sizes without = sizes_of(mix);
    without.sd[k] *= kAlmostNothing;
    one.gain = deviance(asked.reml, without) - mix.minus_two_log;
    one.p_value = p_value_of(asked, one.gain, one.component);
    if (one.gain >= kStays) continue;
    mix.members.erase(mix.members.begin() + static_cast<std::ptrdiff_t>(k));
    mix = with_white_sizes(asked, taken(asked.reml, std::move(mix)));
  }
  return mix;
}

/// The candidates that are not there yet, asked of the present fit.
std::vector<ScreenedNoise> screen(const Question& asked, const NoiseMix& mix) {
  static_cast<void>(deviance(asked.reml, sizes_of(mix)));
  std::vector<NoiseComponent> present;
  for (const NoiseMember& one : mix.members) {
    if (!one.free) continue;
    present.push_back(one.component);
    present.back().process.length = one.length;
  }
  std::vector<NoiseComponent> missing = asked.candidates;
  std::erase_if(missing, [&mix](const NoiseComponent& one) { return mix.has(one.name); });
  return screened_noise(asked.reml.fit(), asked.reml, missing, present);
}

/// The few of the best scores, each with its own size: the length of a kind that scores best stands
/// for it.
std::vector<ScreenedNoise> worth_fitting(const std::vector<ScreenedNoise>& screened) {
  std::vector<ScreenedNoise> worth;
  for (const ScreenedNoise& one : screened) {
    if (one.z < kWorthFitting) continue;
    const auto twin = std::find_if(worth.begin(), worth.end(), [&](const ScreenedNoise& other) {
      return other.component.name == one.component.name;
    });
    if (twin == worth.end()) {
      worth.push_back(one);
    } else if (one.z > twin->z) {
      *twin = one;
    }
  }
  std::sort(worth.begin(), worth.end(),
            [](const ScreenedNoise& a, const ScreenedNoise& b) { return a.z > b.z; });
  if (worth.size() > kMostFitted) worth.resize(kMostFitted);
  return worth;
}

/// The best of a few sds about the score's guess.
double first_size(NoiseReml& reml, const NoiseMix& mix, std::size_t member) {
  double best = std::numeric_limits<double>::infinity();
  const double guess = mix.members[member].sd;
  double at = guess;
  for (const double factor : {0.3, 1.0, 3.0}) {
    NoiseReml::Sizes tried = sizes_of(mix);
    tried.sd[member] = factor * guess;
    const double value = deviance(reml, tried);
    if (value >= best) continue;
    best = value;
    at = tried.sd[member];
  }
  return at;
}

/// The member and the white source that it takes its part of, if free.
std::vector<bool> with_its_sensor(const NoiseMix& mix, std::size_t member) {
  std::vector<bool> free(mix.members.size(), false);
  free[member] = true;
  const std::string source = white_source_of(mix.members[member].component);
  for (std::size_t k = 0; k < mix.members.size(); ++k) {
    if (mix.members[k].free && mix.members[k].component.name == source) free[k] = true;
  }
  return free;
}

/// The mix and one more, roughly at its likeliest.
NoiseMix tried_with(const Question& asked, NoiseMix mix, const ScreenedNoise& more) {
  const std::size_t added = mix.members.size();
  const NoiseComponent& component = more.component;
  mix.members.push_back(
      member_of(component, std::max(more.sd, kLeastSize), component.process.length, true));
  for (std::size_t k = 0; k < mix.members.size(); ++k) {
    NoiseMember& one = mix.members[k];
    if (!one.component.lasts() && mix.is_beside_a_process(k)) one.free = true;
  }
  choose(asked.reml, mix);
  mix.members[added].sd = first_size(asked.reml, mix, added);
  return likeliest(asked.reml, mix, asked.extents, with_its_sensor(mix, added), kMostStepsOfOne,
                   kRoughly);
}

/// The likeliest of what is worth fitting: a length has to bring something.
std::optional<NoiseMix> best_addition(const Question& asked, const NoiseMix& mix,
                                      const std::vector<ScreenedNoise>& screened) {
  std::optional<NoiseMix> best;
  double least = 0.0;
  for (const ScreenedNoise& one : worth_fitting(screened)) {
    NoiseMix tried = tried_with(asked, mix, one);
    const double claim =
        tried.minus_two_log + (one.component.process.length > 0.0 ? kOfALength : 0.0);
    if (best && claim >= least) continue;
    least = claim;
    best = std::move(tried);
  }
  return best;
}

/// With one process more, if any is more than chance. Else the likelihood is left laid out for the
/// mix as it is.
std::optional<NoiseMix> with_one_more(const Question& asked, const NoiseMix& mix,
                                      const std::vector<ScreenedNoise>& screened) {
  if (std::optional<NoiseMix> best = best_addition(asked, mix, screened)) {
    choose(asked.reml, *best);
    NoiseMix more =
        likeliest(asked.reml, *best, asked.extents, best->free(), kMostSteps, kLeastGain);
    NoiseMember& added = more.members.back();
    added.gain = mix.minus_two_log - more.minus_two_log;
    added.p_value = p_value_of(asked, added.gain, added.component);
    if (added.gain > 0.0 && added.p_value < asked.options.level) return more;
  }
  choose(asked.reml, mix);
  return std::nullopt;
}

struct WithProcesses {
  NoiseMix mix;
  int tried = 0;  ///< at first
};

WithProcesses with_processes(const Question& asked, NoiseMix mix) {
  WithProcesses result{std::move(mix)};
  for (std::size_t round = 0; round < asked.options.most_processes; ++round) {
    const std::vector<ScreenedNoise> screened = screen(asked, result.mix);
    if (round == 0) result.tried = static_cast<int>(screened.size());
    std::optional<NoiseMix> more = with_one_more(asked, result.mix, screened);
    if (!more) break;
    result.mix = *std::move(more);
  }
  return result;
}

// ----------------------------------------

NoiseSource source_of(const NoiseMember& one) {
  NoiseSource source;
  source.name = one.component.name;
  source.lasts = one.component.lasts();
  source.process = one.component.process;
  source.process.sd = one.sd;
  source.process.length = one.length;
  source.unit = one.component.unit;
  source.stated = one.component.stated;
  source.sd = one.sd;
  source.gain = one.gain;
  source.p_value = one.p_value;
  return source;
}

void take_errors(const NoiseLogarithms& logarithms, const Eigen::VectorXd& errors,
                 std::size_t member, NoiseSource& source) {
  for (std::size_t place = 0; place < logarithms.places().size(); ++place) {
    if (logarithms.places()[place].member != member) continue;
    const double error = errors[static_cast<Eigen::Index>(place)];
    if (logarithms.places()[place].length) {
      source.length_error = error * source.process.length;
    } else {
      source.sd_error = error * source.sd;
    }
  }
}

FittedNoise report(const Question& asked, const NoiseMix& mix, double stated) {
  FittedNoise result;
  result.noise = asked.reml.stated();
  const NoiseLogarithms logarithms(mix, asked.extents, mix.free());
  Eigen::VectorXd errors;
  if (asked.options.errors && !logarithms.places().empty()) {
    errors = standard_errors(asked.reml, logarithms);
  }
  bool any = false;
  for (std::size_t k = 0; k < mix.members.size(); ++k) {
    const NoiseMember& one = mix.members[k];
    NoiseSource source = source_of(one);
    if (errors.size() > 0) take_errors(logarithms, errors, k, source);
    source.at_limit = one.free && logarithms.at_limit(k);
    source.no_noise = one.free && logarithms.at_largest(k);
    result.sources.push_back(std::move(source));
    if (!one.free) continue;
    any = true;
    take_into(result.noise, one.component, one.sd, one.length);
  }
  result.gain = any ? std::max(0.0, stated - mix.minus_two_log) : 0.0;
  for (NoiseSource& one : result.sources) one.gain = std::min(one.gain, result.gain);
  return result;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::fitting {

FittedNoise fit_noise(NoiseReml& reml, const Eigen::MatrixXd& nuisance,
                      const NoiseFitOptions& options) {
  reml.set_nuisance(nuisance);
  const Question asked{reml, options, candidate_components(reml.fit(), reml.stated()),
                       extents_of(reml.fit())};
  const NoiseMix stated = taken(reml, stated_mix(reml));
  NoiseMix mix = taken(reml, present_mix(reml, stated));
  mix = with_white_sizes(asked, std::move(mix));
  mix = without_superfluous(asked, std::move(mix));
  const WithProcesses found = with_processes(asked, std::move(mix));
  FittedNoise result = report(asked, found.mix, stated.minus_two_log);
  result.tried = found.tried;
  return result;
}

double minus_two_log_under(NoiseReml& reml, const Noise& noise, const Eigen::MatrixXd& columns) {
  reml.set_nuisance(columns);
  const FitState& fit = reml.fit();
  std::vector<NoiseComponent> components = white_components(fit, reml.stated());
  for (const auto& more : {white_components(fit, noise), processes_of(noise)}) {
    for (NoiseComponent one : more) {
      const bool known =
          std::any_of(components.begin(), components.end(),
                      [&one](const NoiseComponent& other) { return other.name == one.name; });
      if (known) continue;
      one.stated = 0.0;
      components.push_back(one);
    }
  }
  NoiseReml::Sizes sizes;
  for (const NoiseComponent& one : components) {
    sizes.sd.push_back(size_in(noise, one));
    sizes.length.push_back(one.process.length);
  }
  reml.choose(components);
  return reml.minus_two_log_at_best(sizes);
}

}  // namespace trussmap::fitting

namespace trussmap {

FittedNoise fit_noise(const ModelFit& fit, const NoiseFitOptions& options) {
  NoiseReml reml(*fit.state, fit.model.noise);
  return fit_noise(reml, Eigen::MatrixXd(), options);
}

FitWithNoise fit_model_and_noise(const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const FitOptions& fit, const NoiseFitOptions& options) {
  constexpr int kMostRounds = 3;
  FitWithNoise result{fit_model(recordings, model, fit), {}};
  double log_likelihood = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    NoiseReml reml(*result.fit.state, model.noise);
    result.noise = fit_noise(reml, Eigen::MatrixXd(), options);
    if (!result.noise.changed() || result.noise.gain - log_likelihood < kStillBetter) break;
    log_likelihood = result.noise.gain;
    Model better = result.fit.model;
    better.noise = result.noise.noise;
    result.fit = refit(recordings, better, result.fit);
  }
  return result;
}

}  // namespace trussmap
