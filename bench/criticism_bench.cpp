// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How well diagnose and discover do, on recordings drawn from seeds 1, 2, ...:
//
//   false-alarms   effect-free recordings in which an effect is named
//   identify       one effect, 2 and 3 times the smallest detectable size: is its look-alike class
//                  first? And does the error fall as far as with the true model?
//   two            two effects at 3 times, columns' cosine below 0.7: are both found?
//   odd            shapes outside the catalogue at 3 times: right channel and variable?
//   events         one row of 5 sds; one landmark moved by 5 sds between two sessions: first among
//                  the events? And an effect named for it?
//   noise          a law of noise that the model does not state, a leg's spread doubled, 56 legs:
//                  first of the four? And an effect named for it?
//   cost           time of a diagnosis and of 200 of its candidates against one fit of the same
//                  recording, 180 to 10 000 legs
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "criticism/candidates.hpp"
#include "criticism/known_events.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <random>

#include <fmt/format.h>

namespace trussmap::bench {
namespace {

struct Options {
  std::uint64_t first = 1;
  int recordings = 20;  ///< per effect and size
  int clean = 1000;
  std::vector<double> times = {2.0, 3.0};  ///< of the smallest detectable size
  bool loops = false;                      ///< without survey
  bool ladder = true;
  bool verbose = false;
};

void false_alarms(const Options& options) {
  int named = 0;
  int misfits = 0;
  std::size_t least_tried = 1000000;
  for (int k = 0; k < options.clean; ++k) {
    const World world = draw_world(options.first + static_cast<std::uint64_t>(k));
    const Diagnosis result = diagnose({record_in(world, {})}, world.model);
    least_tried = std::min(least_tried, result.tried);
    if (result.verdict == Diagnosis::Verdict::missing) {
      ++named;
      if (options.verbose) {
        const Finding& one = result.findings.front();
        fmt::print(
            "  seed {}: {} (score {:.1f}, dof {}, p {:.3f}); legs {} survey {} compass {} "
            "range {}\n",
            world.seed, result.missing, one.score, one.dof, one.p_adjusted, world.walk.size() - 1,
            world.surveyed, world.robot.compass, world.robot.range_sensor);
      }
    }
    misfits += result.verdict == Diagnosis::Verdict::unexplained_misfit ? 1 : 0;
  }
  fmt::print("false alarms: {} of {} ({:.1f} %), unexplained misfits {}; at least {} tests each\n",
             named, options.clean, percent(named, options.clean), misfits, least_tried);
}

struct Tally {
  int shown = 0;
  int first = 0;
  int named = 0;
  int predicted = 0;  ///< first steps whose score and error came as predicted
  int fell = 0;
  int wrong = 0;
  int ladders = 0;
  double ratios = 0.0;  ///< sum: held-out error under the true model to the effect-free one's
};

void identify(const Options& options) {
  const std::size_t count = subjects(draw_world(1)).size();
  for (const double times : options.times) {
    std::map<std::string, Tally> tallies;
    Tally all;
    for (std::size_t e = 0; e < count; ++e) {
      int done = 0;
      for (std::uint64_t seed = options.first; done < options.recordings && seed < 5000; ++seed) {
        const World world = draw_world(seed * 100 + e, options.loops ? Survey::no : Survey::either);
        const Subject subject = subjects(world)[e];
        const std::string name = subject.effect.name.substr(0, subject.effect.name.find(" (x="));
        if (seed > options.first + 10U * static_cast<std::uint64_t>(options.recordings)) break;
        if (!shows(world, subject)) continue;
        const ModelFit clean = fit_model({record_in(world, {})}, world.model);
        const ScoreTest tests(*clean.state);
        Effect truth = subject.effect;
        truth.coefficients = sized(subject, world, tests, times, seed);
        if (truth.coefficients.empty()) continue;
        ++done;
        const std::vector<Recording> recordings{record_in(world, {truth})};
        Tally& tally = tallies[name];
        ++tally.shown;
        Discovery ladder;
        if (options.ladder) ladder = discover(recordings, world.model);
        const Diagnosis result =
            options.ladder ? std::move(ladder.first) : diagnose(recordings, world.model);
        const bool named = result.verdict == Diagnosis::Verdict::missing;
        const bool right = named && cosine(truth, result.findings.front().effect, tests) >= 0.95;
        tally.named += named ? 1 : 0;
        tally.first += right ? 1 : 0;
        if (!right && options.verbose) {
          fmt::print("  x{:.0f} {} (world {}): {} {}\n", times, truth.name, world.seed,
                     named ? result.missing : "not named",
                     named ? fmt::format("cosine {:.3f} score {:.1f}",
                                         cosine(truth, result.findings.front().effect, tests),
                                         result.findings.front().score)
                           : "");
        }
        if (!options.ladder) continue;
        Model with = world.model;
        with.effects = {truth};
        with.effects[0].coefficients.clear();
        const ModelFit best = fit_model(recordings, with);
        const double floor = predict_held_out(recordings, best, {}).arrival_rms;
        ++tally.ladders;
        tally.ratios += floor / predict_held_out({record_in(world, {})}, clean, {}).arrival_rms;
        if (ladder.steps.size() > 1) {
          const DiscoveryStep& before = ladder.steps[0];
          const DiscoveryStep& after = ladder.steps[1];
          const double fell = before.chi2 - after.chi2;
          const bool score_kept = std::abs(after.predicted_chi2 - fell) <= 0.1 * fell;
          const bool error_kept =
              std::abs(after.predicted.arrival_rms - after.held_out.arrival_rms) <=
              0.2 * after.held_out.arrival_rms;
          tally.predicted += score_kept && error_kept ? 1 : 0;
        }
        const double reached = ladder.steps.back().held_out.arrival_rms;
        tally.fell += reached <= 1.10 * floor ? 1 : 0;
        tally.wrong += ladder.found.model.effects.size() > 1 ? 1 : 0;
        if (options.verbose && (reached > 1.10 * floor || ladder.found.model.effects.size() > 1)) {
          std::string found;
          for (const Effect& one : ladder.found.model.effects) found += " [" + one.name + "]";
          fmt::print("  x{:.0f} {} (world {}): ladder {:.1f} mm, true model {:.1f} mm:{} ({})\n",
                     times, truth.name, world.seed, 1e3 * reached, 1e3 * floor, found,
                     stop_in_words(ladder));
        }
      }
    }
    for (const auto& [name, one] : tallies) {
      all.shown += one.shown;
      all.first += one.first;
      all.named += one.named;
      all.fell += one.fell;
      all.wrong += one.wrong;
      all.ladders += one.ladders;
      all.ratios += one.ratios;
      all.predicted += one.predicted;
      fmt::print("  x{:.0f} {:<34} first {:3d}/{:3d} named {:3d} fell {:3d} more {:2d}\n", times,
                 name, one.first, one.shown, one.named, one.fell, one.wrong);
    }
    fmt::print(
        "identify at {:.0f} times, {}: class first in {} of {} ({:.1f} %), not named {:.1f} "
        "%; error within 1.10 of the true model's in {:.1f} %, a further effect in {:.1f} %; true "
        "model's error {:.3f} of the effect-free one's; first steps as predicted {:.1f} %\n",
        times, options.loops ? "loop closures alone" : "all worlds", all.first, all.shown,
        percent(all.first, all.shown), percent(all.shown - all.named, all.shown),
        percent(all.fell, all.ladders), percent(all.wrong, all.ladders),
        all.ladders > 0 ? all.ratios / all.ladders : 0.0, percent(all.predicted, all.ladders));
  }
}

void two(const Options& options) {
  int shown = 0;
  int both = 0;
  for (std::uint64_t seed = options.first; shown < 5 * options.recordings; ++seed) {
    const World world = draw_world(seed + 500000);
    std::mt19937_64 random(seed);
    std::vector<Subject> list = subjects(world);
    std::shuffle(list.begin(), list.end(), random);
    std::erase_if(list, [&](const Subject& one) { return !shows(world, one); });
    const ModelFit clean = fit_model({record_in(world, {})}, world.model);
    const ScoreTest tests(*clean.state);
    std::vector<Effect> truths;
    for (const Subject& subject : list) {
      Effect truth = subject.effect;
      truth.coefficients = sized(subject, world, tests, 3.0, seed);
      if (truth.coefficients.empty()) continue;
      if (!truths.empty() &&
          (cosine(truth, truths[0], tests) >= 0.7 || cosine(truths[0], truth, tests) >= 0.7)) {
        continue;
      }
      truths.push_back(truth);
      if (truths.size() == 2) break;
    }
    if (truths.size() < 2) continue;
    ++shown;
    const Discovery found = discover({record_in(world, truths)}, world.model);
    int hit = 0;
    for (const Effect& truth : truths) {
      hit += std::any_of(found.found.model.effects.begin(), found.found.model.effects.end(),
                         [&](const Effect& one) { return cosine(truth, one, tests) >= 0.95; })
                 ? 1
                 : 0;
    }
    both += hit == 2 ? 1 : 0;
    if (hit < 2 && options.verbose) {
      std::string names;
      for (const Effect& one : found.found.model.effects) names += " [" + one.name + "]";
      fmt::print("  world {}: {} + {} ->{} ({})\n", world.seed, truths[0].name, truths[1].name,
                 names, stop_in_words(found));
    }
  }
  fmt::print("two effects at 3 times: both found in {} of {} ({:.1f} %)\n", both, shown,
             percent(both, shown));
}

void odd(const Options& options) {
  int shown = 0;
  int right = 0;
  const std::size_t count = odd_subjects(draw_world(1)).size();
  for (std::size_t e = 0; e < count; ++e) {
    int done = 0;
    for (std::uint64_t seed = options.first; done < options.recordings; ++seed) {
      const World world = draw_world(seed * 100 + e + 900000);
      const Subject subject = odd_subjects(world)[e];
      if (seed > options.first + 10U * static_cast<std::uint64_t>(options.recordings)) break;
      if (!shows(world, subject)) continue;
      const ModelFit clean = fit_model({record_in(world, {})}, world.model);
      const ScoreTest tests(*clean.state);
      Effect truth = subject.effect;
      truth.coefficients = sized(subject, world, tests, 3.0, seed);
      if (truth.coefficients.empty()) continue;
      ++done;
      ++shown;
      const Diagnosis result = diagnose({record_in(world, {truth})}, world.model);
      std::string word = "payload_kg";
      if (truth.shape.front().speaks_of("speed")) word = "speed";
      if (truth.shape.front().speaks_of("t")) word = "t";
      const auto says = [&](const Effect& one) {
        if (one.channel != truth.channel) return false;
        return std::any_of(one.shape.begin(), one.shape.end(),
                           [&](const Shape& shape) { return shape.speaks_of(word); });
      };
      bool ok = false;
      if (result.verdict == Diagnosis::Verdict::missing) {
        const Finding& first = result.findings.front();
        ok = says(first.effect) ||
             std::any_of(first.look_alikes.begin(), first.look_alikes.end(),
                         [&](const LookAlike& one) { return says(one.effect); });
      }
      right += ok ? 1 : 0;
      if (!ok && options.verbose) {
        fmt::print("  {} (world {}): {}\n", truth.name, world.seed,
                   result.missing.empty() ? "not named" : result.missing);
      }
    }
  }
  fmt::print("odd shapes at 3 times: right channel and variable in {} of {} ({:.1f} %)\n", right,
             shown, percent(right, shown));
}

struct Asked {
  int first = 0;
  int named = 0;
};

void report_asked(const std::string& what, const Asked& asked, int whole) {
  fmt::print("{}: first in {} of {} ({:.1f} %), an effect named for it in {} ({:.1f} %)\n", what,
             asked.first, whole, percent(asked.first, whole), asked.named,
             percent(asked.named, whole));
}

void count_named(const Diagnosis& result, const Options& options, std::uint64_t seed,
                 Asked& asked) {
  if (result.verdict != Diagnosis::Verdict::missing) return;
  ++asked.named;
  if (options.verbose) fmt::print("  seed {}: {}\n", seed, result.missing);
}

void events(const Options& options) {
  const int whole = 10 * options.recordings;
  Asked bump;
  Asked moved;
  for (int k = 0; k < whole; ++k) {
    const std::uint64_t seed = options.first + static_cast<std::uint64_t>(k);
    const testing::Bump one = testing::bumped({}, 5.0, seed);
    const Diagnosis of_bump = diagnose(one.world.recordings, one.world.model);
    const EventTest& leg = of_bump.events.front();
    bump.first += leg.kind == EventKind::leg && leg.name == one.name ? 1 : 0;
    count_named(of_bump, options, seed, bump);
    std::string landmark;
    const testing::NoisyDrive world = testing::with_moved_landmark(5.0, seed, landmark);
    const Diagnosis of_move = diagnose(world.recordings, world.model);
    const EventTest& place = of_move.events.front();
    moved.first += place.kind == EventKind::landmark && place.name == landmark ? 1 : 0;
    count_named(of_move, options, seed, moved);
  }
  report_asked("a leg's row wrong by 5 sds", bump, whole);
  report_asked("a landmark moved by 5 sds", moved, whole);
}

void noise(const Options& options) {
  const int whole = 5 * options.recordings;
  const std::vector<std::string> laws = {"per metre", "per second", "per start", "per spin"};
  for (const std::string& law : laws) {
    Asked asked;
    for (int k = 0; k < whole; ++k) {
      const std::uint64_t seed = options.first + static_cast<std::uint64_t>(k);
      testing::NoisyDrive world = testing::simulate_world({}, seed);
      testing::add_noise(world, law, 2.0, seed);
      const Diagnosis result = diagnose(world.recordings, world.model);
      const auto best =
          std::find_if(result.noise.begin(), result.noise.end(), [&](const NoiseTest& one) {
            return std::find(laws.begin(), laws.end(), one.law) != laws.end();
          });
      asked.first += best != result.noise.end() && best->law == law ? 1 : 0;
      count_named(result, options, seed, asked);
    }
    report_asked(fmt::format("noise {}", law), asked, whole);
  }
}

template <typename Work>
double seconds(const Work& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

void cost() {
  const World world = draw_world(1, Survey::yes);
  for (const int legs : {180, 600, 2000, 10000}) {
    const World here = with_legs(world, legs);
    const std::vector<Recording> recordings{record_in(here, {})};
    std::optional<ModelFit> fit;
    const double fitting = seconds([&] { fit = fit_model(recordings, here.model); });
    std::optional<ScoreTest> tests;
    const double preparing = seconds([&] { tests.emplace(*fit->state); });
    const std::vector<Candidate> candidates = candidates_for(*fit->state, tests->context());
    std::vector<Effect> effects;
    for (std::size_t k = 0; k < 200 && k < candidates.size(); ++k) {
      effects.push_back(candidates[k * candidates.size() / 200].effect);
    }
    double scores = 0.0;
    const double testing = seconds([&] {
      for (std::size_t k = 0; k < effects.size(); k += 25) {
        const auto from = effects.begin() + static_cast<std::ptrdiff_t>(k);
        for (const Score& one : tests->test({from, from + 25}, Resolution::screening)) {
          scores += one.score;
        }
      }
    });
    const double whole = seconds([&] { scores += diagnose(recordings, *fit, {}).chi2; });
    fmt::print(
        "cost of {} legs, {} rows: fit {:.2f} s; 200 candidates {:.2f} s, {:.2f} of the fit (of "
        "which {:.2f} s once); all of a diagnosis ({} tests) {:.2f} s, {:.2f} ms a leg{}\n",
        legs, recordings.front().drive.rows(), fitting, preparing + testing,
        (preparing + testing) / fitting, preparing, candidates.size(), whole, 1e3 * whole / legs,
        scores < 0.0 ? "!" : "");
  }
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--first", options.first, "First seed")->capture_default_str();
  app.add_option("--recordings", options.recordings, "Recordings per effect and size")
      ->capture_default_str();
  app.add_option("--clean", options.clean, "Effect-free recordings")->capture_default_str();
  app.add_option("--times", options.times, "Sizes to identify, times the smallest detectable")
      ->capture_default_str();
  app.add_flag("--loops", options.loops, "Without a survey throughout");
  app.add_flag("!--no-ladder", options.ladder, "Do not run discover beside diagnose");
  app.add_flag("--verbose", options.verbose, "Name what went wrong");
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  const std::vector<Part<Options>> parts{{"false-alarms", false_alarms},
                                         {"identify", identify},
                                         {"two", two},
                                         {"odd", odd},
                                         {"events", events},
                                         {"noise", noise},
                                         {"cost", [](const Options&) { cost(); }}};
  return run_bench<Options>(argc, argv, "How well diagnose and discover do on simulated recordings",
                            parts, add_options);
}
