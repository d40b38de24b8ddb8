// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism_parts.hpp"

#include "bench_worlds.hpp"
#include "criticism/candidates.hpp"
#include "criticism/known_events.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace criticism;
namespace {

using Options = CriticismOptions;

struct Asked {
  int first = 0;
  int named = 0;
};

void report_asked(const std::string& what, const Asked& asked, int whole) {
  fmt::print("{}: first in {} of {} ({:.1f} %), an effect named for it in {} ({:.1f} %)\n", what,
             asked.first, whole, percent(asked.first, whole), asked.named,
             percent(asked.named, whole));
}

/// Whether an effect was named, and which.
Outcome asked_of(const Diagnosis& result, const Options& options, std::uint64_t seed, bool first) {
  const bool named = result.verdict == Diagnosis::Verdict::missing;
  Outcome one{{"first", first}, {"named", named}};
  if (named && options.verbose) one["said"] = fmt::format("  seed {}: {}\n", seed, result.missing);
  return one;
}

void count(const std::optional<Outcome>& outcome, Asked& asked) {
  if (!outcome) return;
  asked.first += outcome->at("first") ? 1 : 0;
  asked.named += outcome->at("named") ? 1 : 0;
}

/// Effects hidden as simulate --hide does, and how many of them discover finds.
Outcome riddle(const Options& options, std::uint64_t seed) {
  const World world = draw_world(seed + 700000);
  std::vector<Effect> hidden;
  try {
    hidden =
        draw_hidden_effects(world.mesh, world.walk, world.style, world.robot, world.surveyed, seed);
  } catch (const std::invalid_argument&) {  // the recording could show none
    return {{"effects", 0}, {"found", 0}};
  }
  const ModelFit clean = fit_model({record_in(world, {})}, world.model);
  const ScoreTest tests(*clean.state);
  const Discovery result = discover({record_in(world, hidden)}, world.model);
  const std::vector<Effect>& effects = result.found.model.effects;
  int found = 0;
  Outcome one{{"effects", hidden.size()}};
  std::string said;
  for (const Effect& truth : hidden) {
    const bool hit = std::any_of(effects.begin(), effects.end(), [&](const Effect& effect) {
      return cosine(truth, effect, tests) >= 0.95;
    });
    found += hit ? 1 : 0;
    if (!hit && options.verbose) {
      said += fmt::format("  world {}: {} not found ({})\n", world.seed, truth.name,
                          stop_in_words(result));
    }
  }
  one["found"] = found;
  one["said"] = said;
  return one;
}

template <typename Work>
double seconds(const Work& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace

void events(const Options& options) {
  const int whole = 10 * options.recordings;
  Asked bump;
  Asked moved;
  for (int k = 0; k < whole; ++k) {
    const std::uint64_t seed = options.first + static_cast<std::uint64_t>(k);
    count(options.trials->next([&] {
      const testing::Bump one = testing::bumped({}, 5.0, seed);
      const Diagnosis result = diagnose(one.world.recordings, one.world.model);
      const EventTest& leg = result.events.front();
      return asked_of(result, options, seed, leg.kind == EventKind::leg && leg.name == one.name);
    }),
          bump);
    count(options.trials->next([&] {
      std::string landmark;
      const testing::NoisyDrive world = testing::with_moved_landmark(5.0, seed, landmark);
      const Diagnosis result = diagnose(world.recordings, world.model);
      const EventTest& place = result.events.front();
      return asked_of(result, options, seed,
                      place.kind == EventKind::landmark && place.name == landmark);
    }),
          moved);
  }
  if (!options.trials->whole()) return;
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
      count(options.trials->next([&] {
        testing::NoisyDrive world = testing::simulate_world({}, seed);
        testing::add_noise(world, law, 2.0, seed);
        const Diagnosis result = diagnose(world.recordings, world.model);
        const auto best =
            std::find_if(result.noise.begin(), result.noise.end(), [&](const NoiseTest& one) {
              return std::find(laws.begin(), laws.end(), one.law) != laws.end();
            });
        return asked_of(result, options, seed, best != result.noise.end() && best->law == law);
      }),
            asked);
    }
    if (!options.trials->whole()) continue;
    report_asked(fmt::format("noise {}", law), asked, whole);
  }
}

void riddles(const Options& options) {
  const int whole = 5 * options.recordings;
  int drawn = 0;
  int found = 0;
  for (int k = 0; k < whole; ++k) {
    const std::uint64_t seed = options.first + static_cast<std::uint64_t>(k);
    const auto outcome = options.trials->next([&] { return riddle(options, seed); });
    if (!outcome) continue;
    drawn += outcome->at("effects").get<int>();
    found += outcome->at("found").get<int>();
  }
  if (!options.trials->whole()) return;
  fmt::print("riddles: {} of {} hidden effects found ({:.1f} %) in {} recordings\n", found, drawn,
             percent(found, drawn), whole);
}

void cost() {
  const World world = draw_world(1, Survey::yes);
  for (const int legs : {180, 600, 2000, 10000}) {
    const World here = with_legs(world, legs);
    const std::vector<DrivenRecording> recordings{record_in(here, {})};
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

}  // namespace trussmap::bench
