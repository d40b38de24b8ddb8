// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the noise is not what the model states (RoughNoise, noise processes), on recordings drawn
// from seeds:
//
//   clean       effect-free recordings of each kind of rough noise: is an effect named?
//   identify    one effect at 3 times the size that could be seen under the true noise, each kind:
//               is its look-alike class first? And do the 95 % intervals that discover gives hold?
//   white       recordings whose noise is as stated: does the estimate name a process?
//   sizes       recordings with one process or noise law, drawn anew from a fit: do its size's and
//               length's 95 % intervals hold?
//   posterior   given recordings: discovered, drawn anew from what was found, diagnosed: do
//   p-values
//               and intervals hold there?
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "fit/fit_state.hpp"
#include "fit/replicated_recording.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include <fmt/format.h>

namespace trussmap::bench {
namespace {

constexpr double kWithin = 1.959964;  // sds: 95 %

struct Options {
  std::vector<std::string> kinds = {"half", "memory", "haze", "tails", "floor", "all"};
  std::uint64_t first = 1;
  int recordings = 2;  ///< per kind and effect
  int clean = 60;      ///< per kind
  int white = 1000;
  int sizes = 200;  ///< per process
  int drawn = 200;  ///< per recording
  std::vector<std::string> given;
  bool verbose = false;
};

World rough_world(std::uint64_t seed, const std::string& kind) {
  World world = draw_world(seed);
  world.robot.rough = parse_rough(kind);
  return world;
}

FitOptions as_the_command_has_it() {
  FitOptions options;
  options.gate = kModelGate * kModelGate;
  options.most_left_out = kMostLeftOut;
  return options;
}

/// What the simulator does, as far as a model can say it: that wheels remember changes little over
/// a leg, and tails have the variance that is stated.
Noise true_noise(const World& world) {
  Noise noise = world.model.noise;
  const RoughNoise& rough = world.robot.rough;
  if (rough.half) {
    noise.left *= 2.0;
    noise.right *= 2.0;
    noise.compass *= 2.0;
  }
  if (rough.haze) {
    noise.processes.push_back(
        {Channel::compass, ProcessKind::correlated_in_t, noise.compass, 2.0, 0.0, 0});
    noise.compass *= 0.01;
  }
  if (rough.floor) {
    noise.processes.push_back({Channel::travel, ProcessKind::per_leg, 0.004, 0.0, 0.0, 0});
    noise.processes.push_back({Channel::turn, ProcessKind::per_leg, 0.01, 0.0, 0.0, 0});
  }
  return noise;
}

void clean(const Options& options) {
  for (const std::string& kind : options.kinds) {
    int named = 0;
    int misfits = 0;
    for (int k = 0; k < options.clean; ++k) {
      const World world = rough_world(options.first + static_cast<std::uint64_t>(k), kind);
      DiagnoseOptions diagnosing;
      diagnosing.fit = as_the_command_has_it();
      const Diagnosis result = diagnose({record_in(world, {})}, world.model, diagnosing);
      misfits += result.verdict == Diagnosis::Verdict::unexplained_misfit ? 1 : 0;
      if (result.verdict != Diagnosis::Verdict::missing) continue;
      ++named;
      if (!options.verbose) continue;
      fmt::print("  {} {}: {} (p {:.4f}, legs {}{}{}{})\n", kind, world.seed, result.missing,
                 result.p_value, world.walk.size() - 1, world.surveyed ? ", survey" : "",
                 world.robot.compass ? ", compass" : "", world.robot.range_sensor ? ", range" : "");
    }
    fmt::print("{}, no effect: one named in {} of {} ({:.1f} %), unexplained misfits {}\n", kind,
               named, options.clean, percent(named, options.clean), misfits);
  }
}

struct Coverage {
  int held = 0;
  int whole = 0;

  void ask(double value, double sd, double truth) {
    ++whole;
    held += std::abs(value - truth) <= kWithin * sd ? 1 : 0;
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} of {} ({:.1f} %)", held, whole, percent(held, whole));
  }
};

void identify(const Options& options) {
  constexpr double kTimes = 3.0;
  const std::size_t count = subjects(draw_world(1)).size();
  Coverage all;
  for (const std::string& kind : options.kinds) {
    int shown = 0;
    int first = 0;
    int more = 0;
    Coverage intervals;
    for (std::size_t e = 0; e < count; ++e) {
      int done = 0;
      for (std::uint64_t seed = options.first;
           done < options.recordings && seed < options.first + 40; ++seed) {
        const World world = rough_world(seed * 100 + e, kind);
        const Subject subject = subjects(world)[e];
        if (!shows(world, subject)) continue;
        Model true_model = world.model;
        true_model.noise = true_noise(world);
        const ModelFit fit = fit_model({record_in(world, {})}, true_model);
        const criticism::ScoreTest tests(*fit.state);
        Effect truth = subject.effect;
        truth.coefficients = sized(subject, world, tests, kTimes, seed);
        if (truth.coefficients.empty()) continue;
        ++done;
        ++shown;
        DiscoverOptions discovering;
        discovering.diagnosis.fit = as_the_command_has_it();
        const Discovery found = discover({record_in(world, {truth})}, world.model, discovering);
        const bool named = found.first.verdict == Diagnosis::Verdict::missing;
        const bool right =
            named && cosine(truth, found.first.findings.front().effect, tests) >= 0.95;
        first += right ? 1 : 0;
        more += found.found.effects.size() > 1 ? 1 : 0;
        for (const EffectEstimate& one : found.found.effects) {
          if (one.effect.name != truth.name) continue;
          for (std::size_t k = 0; k < truth.coefficients.size(); ++k) {
            const bool held =
                std::abs(one.effect.coefficients[k] - truth.coefficients[k]) <= kWithin * one.sd[k];
            intervals.ask(one.effect.coefficients[k], one.sd[k], truth.coefficients[k]);
            if (!held && options.verbose) {
              fmt::print("  {} {} (world {}): {:.5g} +- {:.5g}, truth {:.5g}\n", kind, truth.name,
                         world.seed, one.effect.coefficients[k], one.sd[k], truth.coefficients[k]);
            }
          }
        }
        if (!right && options.verbose) {
          fmt::print("  {} {} (world {}): {}\n", kind, truth.name, world.seed,
                     named ? found.first.missing : "not named");
        }
      }
    }
    all.held += intervals.held;
    all.whole += intervals.whole;
    fmt::print(
        "{}, one effect at 3 times: class first in {} of {} ({:.1f} %); a further effect in {} "
        "({:.1f} %); 95 % intervals hold in {}\n",
        kind, first, shown, percent(first, shown), more, percent(more, shown), intervals.text());
  }
  fmt::print("all kinds: 95 % intervals hold in {}\n", all.text());
}

void white(const Options& options) {
  int named = 0;
  std::map<std::string, int> names;
  for (int k = 0; k < options.white; ++k) {
    const World world = draw_world(options.first + static_cast<std::uint64_t>(k));
    const ModelFit fit = fit_model({record_in(world, {})}, world.model);
    NoiseFitOptions quick;
    quick.errors = false;
    const FittedNoise noise = fit_noise(fit, quick);
    bool any = false;
    for (const NoiseSource& one : noise.sources) {
      if (one.stated > 0.0) continue;
      any = true;
      ++names[one.name];
    }
    named += any ? 1 : 0;
  }
  fmt::print("noise as stated: a process named in {} of {} ({:.1f} %)\n", named, options.white,
             percent(named, options.white));
  for (const auto& [name, times] : names) fmt::print("  {}: {}\n", name, times);
}

/// One law or process on top of the world's noise.
struct Law {
  std::string name;
  double sd = 0.0;
  double length = 0.0;
  bool range = false;

  void put_into(Noise& noise) const {
    if (name == "heading_per_s") {
      noise.heading_per_s = sd;
    } else if (name == "heading_per_rad") {
      noise.heading_per_rad = sd;
    } else if (name == "travel_per_s") {
      noise.travel_per_s = sd;
    } else if (name == "wheels") {
      noise.left *= sd;
      noise.right *= sd;
    } else if (name == "compass") {
      noise.compass *= sd;
    } else {
      const std::size_t comma = name.find(", ");
      noise.processes.push_back({channel_named(name.substr(0, comma)),
                                 process_named(name.substr(comma + 2)), sd, length, 0.0, 0});
    }
  }
};

const std::vector<Law>& laws() {
  static const std::vector<Law> list = {{"wheels", 1.6},
                                        {"compass", 1.6},
                                        {"heading_per_s", 0.008},
                                        {"heading_per_rad", 0.015},
                                        {"travel_per_s", 0.006},
                                        {"travel, per leg", 0.006},
                                        {"turn, per leg", 0.015},
                                        {"difference, per leg", 0.003},
                                        {"drift, correlated in t", 0.005, 2.0},
                                        {"difference, correlated in distance", 0.008, 1.0},
                                        {"travel, correlated in distance", 0.02, 1.0},
                                        {"compass, correlated in t", 0.03, 2.0},
                                        {"compass, correlated in distance", 0.03, 2.0},
                                        {"range, correlated in t", 0.05, 10.0, true},
                                        {"bearing, correlated in t", 0.02, 10.0, true}};
  return list;
}

void sizes(const Options& options) {
  for (const Law& law : laws()) {
    int named = 0;
    int limits = 0;
    int others = 0;
    Coverage sd;
    Coverage length;
    for (int k = 0; k < options.sizes; ++k) {
      const auto seed = options.first + static_cast<std::uint64_t>(k);
      World world = draw_world(seed, Survey::yes);
      world.robot.compass = true;
      world.robot.range_sensor = law.range;
      world = with_legs(world, 120);
      const std::vector<DrivenRecording> base{record_in(world, {})};
      ModelFit fit = fit_model(base, world.model);
      Model rough = world.model;
      law.put_into(rough.noise);
      fit = fitting::refit(base, rough, fit);
      const std::vector<DrivenRecording> drawn = fitting::replicated(base, *fit.state, seed);
      const FittedNoise noise = fit_model_and_noise(drawn, world.model).noise;
      const auto found = std::find_if(noise.sources.begin(), noise.sources.end(),
                                      [&](const NoiseSource& one) { return one.name == law.name; });
      others += std::any_of(noise.sources.begin(), noise.sources.end(),
                            [&](const NoiseSource& one) {
                              return one.stated == 0.0 && one.name != law.name;
                            })
                    ? 1
                    : 0;
      if (found == noise.sources.end() || found->sd_error == 0.0) continue;
      ++named;
      limits += found->at_limit ? 1 : 0;
      const double truth = found->stated > 0.0 ? law.sd * found->stated : law.sd;
      // A size's error is one of its logarithm.
      sd.ask(std::log(found->sd), found->sd_error / found->sd, std::log(truth));
      if (law.length > 0.0) {
        length.ask(std::log(found->process.length), found->length_error / found->process.length,
                   std::log(law.length));
      }
      if (options.verbose) {
        fmt::print("  {} {}: {:.4g} +- {:.2g} ({:.4g}), {:.3g} +- {:.2g} ({:.3g})\n", law.name,
                   seed, found->sd, found->sd_error, truth, found->process.length,
                   found->length_error, law.length);
      }
    }
    fmt::print(
        "{}: named in {} of {}; size within its error in {}{}; at a limit {}, another "
        "process named {}\n",
        law.name, named, options.sizes, sd.text(),
        law.length > 0.0 ? ", length in " + length.text() : "", limits, others);
  }
}

void posterior(const Options& options) {
  for (const std::string& folder : options.given) {
    const std::vector<DrivenRecording> recordings{with_wheels(read_recording(folder), Robot())};
    const Model given = read_model(std::filesystem::path(folder) / "model.toml");
    DiscoverOptions discovering;
    discovering.diagnosis.fit = as_the_command_has_it();
    discovering.diagnosis.fit.use_truth = false;
    const Discovery found = discover(recordings, given, discovering);
    Model asked = found.found.model;
    int named = 0;
    int misfits = 0;
    std::map<std::string, Coverage> intervals;
    std::vector<double> p_values;
    for (int k = 0; k < options.drawn; ++k) {
      const std::vector<DrivenRecording> drawn = fitting::replicated(
          recordings, *found.found.state, options.first + static_cast<std::uint64_t>(k));
      const ModelFit fit = fit_model(drawn, asked, discovering.diagnosis.fit);
      p_values.push_back(fit.p_value);
      for (std::size_t e = 0; e < fit.effects.size(); ++e) {
        for (std::size_t c = 0; c < fit.effects[e].sd.size(); ++c) {
          intervals[fit.effects[e].effect.name].ask(fit.effects[e].effect.coefficients[c],
                                                    fit.effects[e].sd[c],
                                                    asked.effects[e].coefficients[c]);
        }
      }
      const Diagnosis result = diagnose(drawn, fit, discovering.diagnosis);
      named += result.verdict == Diagnosis::Verdict::missing ? 1 : 0;
      misfits += result.verdict == Diagnosis::Verdict::unexplained_misfit ? 1 : 0;
    }
    std::sort(p_values.begin(), p_values.end());
    double farthest = 0.0;  // Kolmogorov and Smirnov's distance
    const auto n = static_cast<double>(p_values.size());
    for (std::size_t k = 0; k < p_values.size(); ++k) {
      const double below = static_cast<double>(k) / n;
      farthest = std::max(
          {farthest, std::abs(p_values[k] - below), std::abs(p_values[k] - below - 1.0 / n)});
    }
    fmt::print(
        "{}: {} effects found; of {} drawn anew a further one named in {} ({:.1f} %), "
        "misfits {}; p of chi^2 below 0.05 in {}, farthest from uniform {:.3f} (5 %: "
        "{:.3f})\n",
        folder, found.found.effects.size(), options.drawn, named, percent(named, options.drawn),
        misfits, std::count_if(p_values.begin(), p_values.end(), [](double p) { return p < 0.05; }),
        farthest, 1.358 / std::sqrt(n));
    for (const auto& [name, one] : intervals) {
      fmt::print("  {}: 95 % intervals hold in {}\n", name, one.text());
    }
  }
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--kinds", options.kinds, "Kinds of rough noise")->capture_default_str();
  app.add_option("--first", options.first, "First seed")->capture_default_str();
  app.add_option("--recordings", options.recordings, "Recordings per kind and effect")
      ->capture_default_str();
  app.add_option("--clean", options.clean, "Effect-free recordings per kind")
      ->capture_default_str();
  app.add_option("--white", options.white, "Recordings with noise as stated")
      ->capture_default_str();
  app.add_option("--sizes", options.sizes, "Recordings per process")->capture_default_str();
  app.add_option("--drawn", options.drawn, "Drawn anew from each recording given")
      ->capture_default_str();
  app.add_option("--given", options.given,
                 "Folders of recordings with a model.toml, for posterior");
  app.add_flag("--verbose", options.verbose, "Say more of each");
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  const std::vector<Part<Options>> parts{{"clean", clean},
                                         {"identify", identify},
                                         {"white", white},
                                         {"sizes", sizes},
                                         {"posterior", posterior}};
  return run_bench<Options>(argc, argv, "How well noise is estimated, and effects found beside it",
                            parts, add_options);
}
