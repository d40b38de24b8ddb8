// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Several effects at once, of the catalogue and of formulas: does a diagnosis name them, does it
// list the true set, and are its probabilities what they say?
//
//   doubles, triples   effects at 3 times the smallest detectable size each, columns' cosines below
//                      0.9, every other recording with one of them a formula
//   masked             two of the catalogue that hide each other: a single candidate leaves 200 of
//                      the chi^2 that they make together
//   none               nothing is missing
//
// Found: named, with 0.95 of the true trace. Further: named, and none of the true. Listed: a set
// of just the true effects is among the explanations. A share of time is processor time of one
// diagnosis. Probabilities are counted by deciles over all that is listed.
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "criticism/candidates.hpp"
#include "criticism/tested_candidate.hpp"
#include "fit/fit_state.hpp"
#include "linalg/dense.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace criticism;
namespace {

constexpr double kSame = 0.95;       // cosine
constexpr double kApart = 0.9;       // likewise
constexpr double kLeftOver = 200.0;  // chi^2 that the best single candidate leaves of a masked pair

struct Options {
  std::uint64_t first = 1;
  int doubles = 100;
  int triples = 60;
  int masked = 40;
  int none = 100;
  bool discovers = false;
  bool verbose = false;
};

/// True and all, by deciles of what was said.
struct Calibration {
  std::array<int, 10> count{};
  std::array<int, 10> right{};
  std::array<double, 10> said{};

  void add(double probability, bool is_right) {
    const auto k = static_cast<std::size_t>(std::clamp(10.0 * probability, 0.0, 9.0));
    ++count[k];
    right[k] += is_right ? 1 : 0;
    said[k] += probability;
  }
};

struct Tally {
  int recordings = 0;
  int all_found = 0;
  int further = 0;
  int listed = 0;
  int discovered = 0;
  std::vector<double> seconds;
  std::size_t sets = 0;
};

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::vector<Subject> formulas() {
  std::vector<Subject> list;
  const auto add = [&list](Channel channel, const std::vector<Shape>& shape) {
    list.push_back(
        {{fmt::format("{} x {}", name_of(channel), shape.front().text()), channel, shape, {}},
         channel == Channel::compass,
         false});
  };
  add(Channel::travel, {"payload_kg*speed"});
  add(Channel::creep, {"payload_kg*turn_rate"});
  add(Channel::turn, {"payload_kg*abs(turn_rate)"});
  add(Channel::compass, {"payload_kg*speed"});
  add(Channel::wheels, {"payload_kg^2"});
  add(Channel::turn, {"turn_rate^2"});
  add(Channel::travel, {"speed^2"});
  add(Channel::turn, {"sqrt(abs(turn_rate))"});
  add(Channel::compass, {"sin(4*heading)", "cos(4*heading)"});
  add(Channel::travel, {"sin(4*heading)", "cos(4*heading)"});
  return list;
}

struct Trial {
  World world;
  std::vector<Effect> truths;
};

/// So many effects that the world shows apart from each other.
std::optional<Trial> draw_several(std::uint64_t seed, std::size_t count) {
  Trial trial{draw_world(seed + 500000), {}};
  const World& world = trial.world;
  std::mt19937_64 random(seed);
  std::vector<Subject> list = subjects(world);
  std::shuffle(list.begin(), list.end(), random);
  if (seed % 2 == 0) {
    std::vector<Subject> more = formulas();
    std::shuffle(more.begin(), more.end(), random);
    list.insert(list.begin(), more.begin(), more.begin() + 1);
  }
  std::erase_if(list, [&](const Subject& one) { return !shows(world, one); });
  const ModelFit clean = fit_model({record_in(world, {})}, world.model);
  const ScoreTest tests(*clean.state);
  for (const Subject& subject : list) {
    Effect truth = subject.effect;
    truth.coefficients = sized(subject, world, tests, 3.0, seed);
    if (truth.coefficients.empty()) continue;
    const bool alike =
        std::any_of(trial.truths.begin(), trial.truths.end(), [&](const Effect& other) {
          return cosine(truth, other, tests) >= kApart || cosine(other, truth, tests) >= kApart;
        });
    if (!alike) trial.truths.push_back(std::move(truth));
    if (trial.truths.size() == count) return trial;
  }
  return std::nullopt;
}

/// A trace along a direction that the effect's shapes span, and its coefficients.
struct Trace {
  Effect effect;
  Eigen::VectorXd trace;
  std::vector<double> most;  ///< |coefficient| that is plausible
};

std::optional<Trace> trace_of(const Subject& subject, const ScoreTest& tests,
                              std::mt19937_64& random) {
  const Score score = tests.test({subject.effect}).front();
  if (score.dof < static_cast<int>(subject.effect.shape.size())) return std::nullopt;
  Trace one{subject.effect, {}, {}};
  std::normal_distribution<double> normal;
  Eigen::VectorXd direction(score.projected.cols());
  for (double& d : direction) d = normal(random);
  one.trace = score.projected * direction;
  direction /= one.trace.norm();
  one.trace.normalize();
  one.effect.coefficients = {direction.begin(), direction.end()};
  for (const double largest : score.largest) {
    one.most.push_back(facts_of(subject.effect.channel).prior_sd / largest);
  }
  return one;
}

/// The largest share of a trace's square that a candidate without a family shows.
double most_shown(const Eigen::VectorXd& trace, const ScoreTest& tests, const ModelFit& clean) {
  std::vector<Candidate> plain = candidates_for(*clean.state, tests.context());
  std::erase_if(plain, [](const Candidate& one) {
    return !one.family.empty() || one.effect.shape.size() > 4;
  });
  double most = 0.0;
  visit_scores(tests, plain, Resolution::quick, [&](std::size_t, const Score& score) {
    if (score.dof == 0) return;
    const Eigen::VectorXd shown = score.projected * linalg::least_squares(score.projected, trace);
    most = std::max(most, shown.squaredNorm() / trace.squaredNorm());
  });
  return most;
}

std::optional<Trial> draw_masked(std::uint64_t seed) {
  Trial trial{draw_world(seed + 600000), {}};
  const World& world = trial.world;
  std::mt19937_64 random(seed);
  std::vector<Subject> list = subjects(world);
  std::erase_if(list, [&](const Subject& one) { return !shows(world, one); });
  const ModelFit clean = fit_model({record_in(world, {})}, world.model);
  const ScoreTest tests(*clean.state);
  std::vector<Trace> traces;
  for (const Subject& one : list) {
    if (auto trace = trace_of(one, tests, random)) traces.push_back(*std::move(trace));
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < traces.size(); ++a) {
    for (std::size_t b = a + 1; b < traces.size(); ++b) {
      const double c = std::abs(traces[a].trace.dot(traces[b].trace));
      if (c > 0.6 && c < kApart) pairs.emplace_back(a, b);
    }
  }
  std::shuffle(pairs.begin(), pairs.end(), random);
  for (const auto& [a, b] : pairs) {
    Trace one = traces[a];
    Trace other = traces[b];
    const double c = one.trace.dot(other.trace);
    const double sign = c > 0.0 ? -1.0 : 1.0;
    const Eigen::VectorXd both = one.trace + sign * other.trace;
    const double left = both.squaredNorm() * (1.0 - most_shown(both, tests, clean));
    const double size = std::sqrt(kLeftOver / left);
    bool plausible = true;
    for (Trace* each : {&one, &other}) {
      for (std::size_t k = 0; k < each->most.size(); ++k) {
        double& coefficient = each->effect.coefficients[k];
        coefficient *= each == &one ? size : sign * size;
        plausible = plausible && std::abs(coefficient) < each->most[k];
      }
    }
    if (cosine(one.effect, other.effect, tests) >= kApart ||
        cosine(other.effect, one.effect, tests) >= kApart || !plausible) {
      continue;
    }
    trial.truths = {one.effect, other.effect};
    return trial;
  }
  return std::nullopt;
}

std::string names_of(const std::vector<Effect>& effects) {
  std::string names;
  for (const Effect& one : effects) names += " [" + one.name + "]";
  return names;
}

/// Whether each truth has an effect of its own among as many.
bool are_the_true(const std::vector<Effect>& effects, const std::vector<Effect>& truths,
                  const ScoreTest& tests) {
  if (effects.size() != truths.size()) return false;
  return std::all_of(truths.begin(), truths.end(), [&](const Effect& truth) {
    return std::any_of(effects.begin(), effects.end(),
                       [&](const Effect& one) { return cosine(truth, one, tests) >= kSame; });
  });
}

void diagnose_one(const Trial& trial, const Options& options, const std::string& part, Tally& tally,
                  Calibration& calibration) {
  const World& world = trial.world;
  const std::vector<Effect>& truths = trial.truths;
  const ModelFit clean = fit_model({record_in(world, {})}, world.model);
  const ScoreTest tests(*clean.state);
  const auto is_true = [&](const Effect& one) {
    return std::any_of(truths.begin(), truths.end(),
                       [&](const Effect& truth) { return cosine(truth, one, tests) >= kSame; });
  };
  const std::vector<DrivenRecording> recordings{record_in(world, truths)};
  const double begun = processor_seconds();
  const Diagnosis result = diagnose(recordings, world.model);
  tally.seconds.push_back(processor_seconds() - begun);
  ++tally.recordings;
  std::vector<Effect> named;
  for (const Finding* one : found_by(result)) named.push_back(one->effect);
  const bool found = std::all_of(truths.begin(), truths.end(), [&](const Effect& truth) {
    return std::any_of(named.begin(), named.end(),
                       [&](const Effect& one) { return cosine(truth, one, tests) >= kSame; });
  });
  const bool further =
      std::any_of(named.begin(), named.end(), [&](const Effect& one) { return !is_true(one); });
  bool listed = false;
  for (const EffectSet& one : result.explanations.sets) {
    std::vector<Effect> effects;
    for (const ExplainingEffect& effect : one.effects) effects.push_back(effect.effect);
    listed = listed || are_the_true(effects, truths, tests);
  }
  for (const EffectChance& one : result.explanations.effects) {
    calibration.add(one.probability, is_true(one.effect));
  }
  tally.all_found += found && !truths.empty() ? 1 : 0;
  tally.further += further ? 1 : 0;
  tally.listed += listed ? 1 : 0;
  tally.sets += result.explanations.sets.size();
  if (options.discovers) {
    const std::vector<Effect> models = discover(recordings, world.model).found.model.effects;
    tally.discovered += are_the_true(models, truths, tests) ? 1 : 0;
  }
  if (options.verbose && (further || ((!found || !listed) && !truths.empty()))) {
    std::string chances;
    for (const EffectChance& one : result.explanations.effects) {
      chances += fmt::format(" {:.2f} {};", one.probability, one.effect.name);
    }
    fmt::print("  {} world {}:{} ->{}{}{};{}\n", part, world.seed, names_of(truths),
               names_of(named), listed ? "" : " (not listed)", further ? " (further)" : "",
               chances);
  }
}

void report(const std::string& part, Tally tally, bool any, bool discovers) {
  const int n = tally.recordings;
  std::sort(tally.seconds.begin(), tally.seconds.end());
  const auto at = [&](double share) {
    return tally.seconds.empty() ? 0.0
                                 : tally.seconds[static_cast<std::size_t>(
                                       share * static_cast<double>(tally.seconds.size() - 1))];
  };
  if (any) {
    fmt::print(
        "{}: all found in {} of {} ({:.1f} %), a further one in {} ({:.1f} %), true set "
        "listed in {} ({:.1f} %), {:.1f} sets on average",
        part, tally.all_found, n, percent(tally.all_found, n), tally.further,
        percent(tally.further, n), tally.listed, percent(tally.listed, n),
        static_cast<double>(tally.sets) / std::max(1, n));
  } else {
    fmt::print("{}: an effect named in {} of {} ({:.1f} %)", part, tally.further, n,
               percent(tally.further, n));
  }
  if (discovers) fmt::print(", discover finds just the true ones in {}", tally.discovered);
  fmt::print("; {:.2f} s a diagnosis (median), {:.2f} s (nine in ten)\n", at(0.5), at(0.9));
}

void report(const std::string& part, const Calibration& calibration) {
  for (std::size_t k = 0; k < 10; ++k) {
    const int n = calibration.count[k];
    if (n == 0) continue;
    fmt::print("{}: said {:.2f} on average, true in {} of {} ({:.2f})\n", part,
               calibration.said[k] / n, calibration.right[k], n,
               static_cast<double>(calibration.right[k]) / n);
  }
}

template <typename Draw>
void run_part(const Options& options, const std::string& part, int count, const Draw& draw) {
  Tally tally;
  Calibration calibration;
  for (std::uint64_t seed = options.first; tally.recordings < count; ++seed) {
    if (seed > options.first + 20U * static_cast<std::uint64_t>(count)) break;
    const std::optional<Trial> trial = draw(seed);
    if (trial) diagnose_one(*trial, options, part, tally, calibration);
  }
  report(part, tally, part != "none", options.discovers);
  report(part, calibration);
}

void doubles(const Options& options) {
  run_part(options, "doubles", options.doubles,
           [](std::uint64_t seed) { return draw_several(seed, 2); });
}

void triples(const Options& options) {
  run_part(options, "triples", options.triples,
           [](std::uint64_t seed) { return draw_several(seed + 20000, 3); });
}

void masked(const Options& options) {
  run_part(options, "masked", options.masked, draw_masked);
}

void none(const Options& options) {
  run_part(options, "none", options.none, [](std::uint64_t seed) {
    return std::optional(Trial{draw_world(seed), {}});
  });
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--first", options.first, "First seed")->capture_default_str();
  app.add_option("--doubles", options.doubles, "Recordings with two effects")
      ->capture_default_str();
  app.add_option("--triples", options.triples, "Recordings with three")->capture_default_str();
  app.add_option("--masked", options.masked, "Recordings with a masked pair")
      ->capture_default_str();
  app.add_option("--none", options.none, "Recordings without effects")->capture_default_str();
  app.add_flag("--discover", options.discovers, "Ask discover, too");
  app.add_flag("--verbose", options.verbose, "Tell of each that was missed");
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  return run_bench<Options>(
      argc, argv, "Several effects at once: named, listed, calibrated",
      {{"doubles", doubles}, {"triples", triples}, {"masked", masked}, {"none", none}},
      add_options);
}
