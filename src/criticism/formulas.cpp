// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/formulas.hpp"

#include "criticism/driven_variables.hpp"
#include "effects/channel_physics.hpp"
#include "effects/channel_record.hpp"
#include "recording/variable_names.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

namespace trussmap::criticism {
namespace {

/// Belief, against a catalogue effect's: what is written down with one variable before what takes
/// two, or a floor.
constexpr double kOfOne = -2.5;
constexpr double kOfTwo = -3.0;
constexpr double kOfFloor = -3.0;
constexpr std::size_t kFewestValues = 3;  // that a variable has

Candidate formula(Channel channel, const std::string& said, const std::string& variable,
                  double log_prior) {
  Candidate one;
  one.effect.name = fmt::format("{} with {}", name_of(channel), said);
  one.effect.channel = channel;
  one.form = Form::formula;
  one.variable = variable;
  one.log_prior = log_prior;
  return one;
}

Candidate family(Channel channel, const std::string& said, const std::string& variable,
                 double log_prior, std::vector<std::string> pattern) {
  Candidate one = formula(channel, said, variable, log_prior);
  one.family = one.effect.name;
  one.pattern = std::move(pattern);
  return one;
}

/// From `begin` on all forms are as likely, whatever their number.
void share_belief(std::vector<Candidate>& all, std::size_t begin) {
  std::set<std::string> forms;
  for (std::size_t k = begin; k < all.size(); ++k) forms.insert(all[k].effect.name);
  for (std::size_t k = begin; k < all.size(); ++k) {
    all[k].log_prior -= std::log(static_cast<double>(forms.size()));
  }
}

bool is_of_wheels(Channel channel) {
  return channel == Channel::left || channel == Channel::right || channel == Channel::wheels;
}

bool is_of_time(Channel channel) {
  return channel == Channel::drift || channel == Channel::gyro;
}

}  // namespace

FormulaGrammar::FormulaGrammar(const fitting::FitState& fit, const fitting::ShapeContext& context) {
  for (const char* name : {"speed", "turn_rate", "t"}) add_term(name, context, false);
  for (const std::string& name : covariates_of(context)) add_term(name, context, true);
  const Area area = driven_area(fit);
  if (area.step > 0.0) {
    middle_ = 0.5 * (area.low + area.high);
    reach_ = 0.5 * (area.high - area.low).norm();
  }
}

void FormulaGrammar::add_term(const std::string& name, const fitting::ShapeContext& context,
                              bool covariate) {
  constexpr double kNoise = 0.05;  // of the most: a robot that spins drives a little to either side
  const Spread u = spread_of(name, context);
  if (u.sorted.empty() || !(u.most > u.least) || u.distinct < kFewestValues) return;
  if (name == "t") duration_ = u.most;
  // A covariate that is far from 0 throughout (a temperature) is taken from its mean.
  if (covariate && !u.two_sided() && std::abs(u.least + u.most) > 3.0 * (u.most - u.least)) {
    const double mean = text::rounded_within(u.mean, u.most - u.least);
    terms_.push_back({filled("(" + name + "-{mean})", {{"mean", mean}}), "", name, 0.0, 0.0, true});
    return;
  }
  if (u.least >= 0.0) {
    terms_.push_back({name, name, name, u.least, u.most, covariate});
    return;
  }
  const std::string size = "abs(" + name + ")";
  const double most = std::max(-u.least, u.most);
  if (-u.least < kNoise * u.most) {
    terms_.push_back({name, size, name, 0.0, most, covariate});
    return;
  }
  // What goes with the way it turns is another matter than how fast.
  terms_.push_back({name, "", name, 0.0, 0.0, covariate});
  if (!covariate) terms_.push_back({size, size, name, 0.0, most, covariate});
}

bool FormulaGrammar::speaks_of(Channel channel) {
  return effects::record_of(channel).varies && effects::acts_on(channel) != effects::ActsOn::views;
}

std::vector<Candidate> FormulaGrammar::of(Channel channel) const {
  std::vector<Candidate> all;
  if (!speaks_of(channel)) return all;
  add_powers(channel, all);
  add_saturations(channel, all);
  add_decays(channel, all);
  share_belief(all, 0);
  const std::size_t one = all.size();
  add_products(channel, all);
  share_belief(all, one);
  const std::size_t two = all.size();
  if (!is_of_time(channel)) add_planes(channel, all);
  share_belief(all, two);
  return all;
}

void FormulaGrammar::add_powers(Channel channel, std::vector<Candidate>& all) const {
  if (channel != Channel::drift && !is_of_wheels(channel)) {
    Candidate four = formula(channel, "four times the heading", "heading", kOfOne);
    four.effect.shape = {"sin(4*heading)", "cos(4*heading)"};
    all.push_back(std::move(four));
  }
  for (const Term& u : terms_) {
    if (u.size.empty() || u.variable == "t") continue;
    if (channel == Channel::drift && !u.covariate) continue;
    Candidate root = formula(channel, "the root of " + u.variable, u.variable, kOfOne);
    root.effect.shape = {"sqrt(" + u.size + ")"};
    all.push_back(std::move(root));
  }
}

void FormulaGrammar::add_products(Channel channel, std::vector<Candidate>& all) const {
  for (std::size_t a = 0; a < terms_.size(); ++a) {
    for (std::size_t b = a + 1; b < terms_.size(); ++b) {
      const Term& u = terms_[a];
      const Term& v = terms_[b];
      if (u.variable == v.variable) continue;
      // Clocks know nothing of motion.
      if (channel == Channel::drift && !(v.covariate && u.variable == "t")) continue;
      Candidate product = formula(channel, u.text + " times " + v.text,
                                  v.covariate ? v.variable : u.variable, kOfTwo);
      product.effect.shape = {u.text + "*" + v.text};
      all.push_back(std::move(product));
    }
  }
}

void FormulaGrammar::add_saturations(Channel channel, std::vector<Candidate>& all) const {
  for (const Term& u : terms_) {
    if (u.size.empty() || u.variable == "t") continue;
    if (channel == Channel::drift && !u.covariate) continue;
    const double range = u.most - u.least;
    const auto add = [&](Candidate one, double least) {
      one.parameters = {{"c", 0.0}};
      for (const double share : {0.1, 0.25, 0.5, 0.75}) {
        one.search = {{0.5 * share * range, least, u.least + 0.95 * range}};
        all.push_back(with_parameters(one, {u.least + share * range}));
      }
    };
    add(family(channel, u.variable + " that levels off", u.variable, kOfOne,
               {u.size + "/({c}+" + u.size + ")"}),
        0.02 * range);
    if (u.covariate || u.variable == "speed") continue;  // a plain candidate
    add(family(channel, u.size + " above a threshold", u.variable, kOfOne,
               {"max(0, " + u.size + "-{c})"}),
        u.least + 0.02 * range);
  }
}

void FormulaGrammar::add_decays(Channel channel, std::vector<Candidate>& all) const {
  if (!(duration_ > 0.0)) return;
  for (const bool falls : {true, false}) {
    Candidate one = family(channel, falls ? "what decays in time" : "what levels off in time", "t",
                           kOfOne, {falls ? "exp(-t/{T})" : "1-exp(-t/{T})"});
    one.parameters = {{"T", 0.0}};
    for (const double share : {0.025, 0.05, 0.1, 0.2, 0.4, 0.8}) {
      const double T = share * duration_;
      one.search = {{0.5 * T, 0.005 * duration_, 1.5 * duration_}};
      all.push_back(with_parameters(one, {T}));
    }
  }
}

void FormulaGrammar::add_planes(Channel channel, std::vector<Candidate>& all) const {
  if (!(reach_ > 0.0)) return;
  constexpr int kAngles = 16;
  constexpr double kFurthest = 0.6;  // of the reach
  const double turn = 2.0 * std::numbers::pi;
  Candidate line =
      family(channel, "a line across the floor", "place", kOfFloor, {"{a}*x+{b}*y>{c}"});
  line.writing = Writing::line;
  line.pivot = middle_;
  line.parameters = {{"angle", 0.0}, {"beyond", 0.0}};
  line.search = {{turn / kAngles, 0.0, 1.5 * turn}, {0.2 * reach_, -reach_, reach_}};
  for (int k = 0; k < kAngles; ++k) {
    for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      all.push_back(
          with_parameters(line, {turn * (k + 0.5) / kAngles, share * kFurthest * reach_}));
    }
  }
  // Where a wave's sine and cosine are free, its trace changes over half of a wave per floor.
  constexpr int kHalfWaves = 7;  // along the diagonal, of the shortest; of the longest 2
  const double diagonal = 2.0 * reach_;
  Candidate wave = family(channel, "a wave across the floor", "place", kOfFloor,
                          {"sin({kx}*x+{ky}*y)", "cos({kx}*x+{ky}*y)"});
  wave.writing = Writing::wave;
  wave.parameters = {{"angle", 0.0}, {"length", 0.0}};
  for (int halves = 2; halves <= kHalfWaves; ++halves) {
    const double waves = 0.5 * halves;
    const int angles = static_cast<int>(std::lround(std::numbers::pi * waves / 0.5));
    const double length = diagonal / waves;
    wave.search = {{0.5 * turn / angles, -turn, turn},
                   {0.25 * length / waves, 0.25 * diagonal, 1.3 * diagonal}};
    for (int k = 0; k < angles; ++k) {
      all.push_back(with_parameters(wave, {0.5 * turn * (k + 0.5) / angles, length}));
    }
  }
}

}  // namespace trussmap::criticism
