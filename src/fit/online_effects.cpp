// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/online_effects.hpp"

#include "effects/steering.hpp"
#include "fit/effect_columns.hpp"

#include <stdexcept>

namespace trussmap::fitting {

OnlineEffects::OnlineEffects(const std::vector<Effect>& effects,
                             const std::vector<std::string>& covariates) {
  for (const Effect& effect : effects) {
    const std::vector<double> coefficients = coefficients_of(effect, 1);
    OnlineTerms& terms = terms_of(effect.channel);
    for (std::size_t k = 0; k < effect.shape.size(); ++k) {
      try {
        terms.add({effect.channel, coefficients[k], effect.shape[k], effect.name}, covariates);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
      }
    }
  }
}

OnlineTerms& OnlineEffects::terms_of(Channel channel) {
  if (channel == Channel::delay) return delays_;
  const effects::ActsOn acts = effects::acts_on(channel);
  if (acts == effects::ActsOn::views) return views_;
  if (acts == effects::ActsOn::readings) return readings_;
  return effects::is_steering(channel) ? steering_ : drives_;
}

bool OnlineEffects::see_the_pose() const {
  return steering_.see_the_pose() || drives_.see_the_pose() || readings_.see_the_pose();
}

drive::SteeringChange OnlineEffects::steering(const OnlineFacts& facts, const Pose& middle,
                                              const std::vector<double>& readings) {
  steering_.fill(facts.row, middle, facts.covariates);
  drive::SteeringChange more;
  for (const OnlineTerm& term : steering_.all()) {
    effects::add_steering(term.channel, term.coefficient * steering_.value(term), readings.back(),
                          more);
  }
  return more;
}

effects::DrivePattern OnlineEffects::drive(const OnlineFacts& facts, const Pose& middle,
                                           const drive::RowMotion& shown) {
  effects::DrivePattern more;
  drives_.fill(facts.row, middle, facts.covariates);
  for (const OnlineTerm& term : drives_.all()) {
    more.add(term.coefficient, effects::drive_pattern(term.channel, drives_.value(term), shown));
  }
  return more;
}

double OnlineEffects::cleared_reading(double reading, const OnlineFacts& facts, const Pose& end) {
  readings_.fill(facts.row, end, facts.covariates);
  for (const OnlineTerm& term : readings_.all()) {
    reading -= term.coefficient * readings_.value(term);
  }
  return reading;
}

double OnlineEffects::cleared_time(double t, const OnlineFacts& facts) const {
  OnlineTerms delays = delays_;
  delays.fill(facts.row, {}, facts.covariates);
  for (const OnlineTerm& term : delays.all()) t -= term.coefficient * delays.value(term);
  return t;
}

effects::ViewPattern OnlineEffects::view(const OnlineFacts& facts, const Pose& end) const {
  OnlineTerms views = views_;
  views.fill(facts.row, end, facts.covariates);
  effects::ViewPattern sum;
  for (const OnlineTerm& term : views.all()) {
    const double g = term.coefficient * views.value(term);
    sum.add(1.0, effects::view_pattern(term.channel, g, 0.0, 0.0));
  }
  return sum;
}

}  // namespace trussmap::fitting
