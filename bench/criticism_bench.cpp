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
//   riddles        effects hidden as simulate --hide does: are they found?
//   cost           time of a diagnosis and of 200 of its candidates against one fit of the same
//                  recording, 180 to 10 000 legs
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "criticism/candidates.hpp"
#include "criticism/known_events.hpp"
#include "criticism_parts.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace criticism;
namespace {

using Options = CriticismOptions;

void false_alarms(const Options& options) {
  int named = 0;
  int misfits = 0;
  std::size_t least_tried = 1000000;
  for (int k = 0; k < options.clean; ++k) {
    const auto outcome = options.trials->next([&] {
      const World world = draw_world(options.first + static_cast<std::uint64_t>(k));
      const Diagnosis result = diagnose({record_in(world, {})}, world.model);
      Outcome one{{"tried", result.tried},
                  {"named", result.verdict == Diagnosis::Verdict::missing},
                  {"misfit", result.verdict == Diagnosis::Verdict::unexplained_misfit}};
      if (one["named"] && options.verbose) {
        const Finding& first = result.findings.front();
        one["said"] = fmt::format(
            "  seed {}: {} (score {:.1f}, dof {}, p {:.3f}); legs {} survey {} compass {} "
            "range {}\n",
            world.seed, result.missing, first.score, first.dof, first.p_adjusted,
            world.walk.size() - 1, world.surveyed, world.robot.compass, world.robot.range_sensor);
      }
      return one;
    });
    if (!outcome) continue;
    least_tried = std::min(least_tried, outcome->at("tried").get<std::size_t>());
    named += outcome->at("named") ? 1 : 0;
    misfits += outcome->at("misfit") ? 1 : 0;
  }
  if (!options.trials->whole()) return;
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

/// One subject at one size, in as many worlds as show it.
Outcome identify_subject(const Options& options, double times, std::size_t e) {
  Tally tally;
  std::string name;
  std::string said;
  int done = 0;
  for (std::uint64_t seed = options.first; done < options.recordings && seed < 5000; ++seed) {
    const World world = draw_world(seed * 100 + e, options.loops ? Survey::no : Survey::either);
    const Subject subject = subjects(world)[e];
    name = subject.effect.name.substr(0, subject.effect.name.find(" (x="));
    if (seed > options.first + 10U * static_cast<std::uint64_t>(options.recordings)) break;
    if (!shows(world, subject)) continue;
    const ModelFit clean = fit_model({record_in(world, {})}, world.model);
    const ScoreTest tests(*clean.state);
    Effect truth = subject.effect;
    truth.coefficients = sized(subject, world, tests, times, seed);
    if (truth.coefficients.empty()) continue;
    ++done;
    const std::vector<DrivenRecording> recordings{record_in(world, {truth})};
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
      said += fmt::format("  x{:.0f} {} (world {}): {} {}\n", times, truth.name, world.seed,
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
      const bool score_kept = std::abs(after.predicted_decrease - fell) <= 0.1 * fell;
      const bool error_kept = std::abs(after.predicted.arrival_rms - after.held_out.arrival_rms) <=
                              0.2 * after.held_out.arrival_rms;
      tally.predicted += score_kept && error_kept ? 1 : 0;
    }
    const double reached = ladder.steps.back().held_out.arrival_rms;
    tally.fell += reached <= 1.10 * floor ? 1 : 0;
    tally.wrong += ladder.found.model.effects.size() > 1 ? 1 : 0;
    if (options.verbose && (reached > 1.10 * floor || ladder.found.model.effects.size() > 1)) {
      std::string found;
      for (const Effect& one : ladder.found.model.effects) found += " [" + one.name + "]";
      said += fmt::format(
          "  x{:.0f} {} (world {}): ladder {:.1f} mm, true model {:.1f} mm:{} ({})\n", times,
          truth.name, world.seed, 1e3 * reached, 1e3 * floor, found, stop_in_words(ladder));
    }
  }
  return {{"name", name},         {"shown", tally.shown},         {"first", tally.first},
          {"named", tally.named}, {"predicted", tally.predicted}, {"fell", tally.fell},
          {"wrong", tally.wrong}, {"ladders", tally.ladders},     {"ratios", tally.ratios},
          {"said", said}};
}

void add(const Outcome& outcome, Tally& tally) {
  tally.shown += outcome.at("shown").get<int>();
  tally.first += outcome.at("first").get<int>();
  tally.named += outcome.at("named").get<int>();
  tally.predicted += outcome.at("predicted").get<int>();
  tally.fell += outcome.at("fell").get<int>();
  tally.wrong += outcome.at("wrong").get<int>();
  tally.ladders += outcome.at("ladders").get<int>();
  tally.ratios += outcome.at("ratios").get<double>();
}

void identify(const Options& options) {
  const std::size_t count = subjects(draw_world(1)).size();
  for (const double times : options.times) {
    std::map<std::string, Tally> tallies;
    Tally all;
    for (std::size_t e = 0; e < count; ++e) {
      const auto outcome =
          options.trials->next([&] { return identify_subject(options, times, e); });
      if (outcome && outcome->at("shown") > 0) {
        add(*outcome, tallies[outcome->at("name").get<std::string>()]);
      }
    }
    if (!options.trials->whole()) continue;
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

/// Two effects that a world shows apart from each other; of worlds, the next that has such.
struct Pair {
  World world;
  std::vector<Effect> truths;
};

std::optional<Pair> draw_pair(std::uint64_t seed) {
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
  if (truths.size() < 2) return std::nullopt;
  return Pair{world, truths};
}

Outcome find_two(const Options& options, const Pair& pair) {
  const auto& [world, truths] = pair;
  const ModelFit clean = fit_model({record_in(world, {})}, world.model);
  const ScoreTest tests(*clean.state);
  std::string said;
  const Discovery found = discover({record_in(world, truths)}, world.model);
  int hit = 0;
  for (const Effect& truth : truths) {
    hit += std::any_of(found.found.model.effects.begin(), found.found.model.effects.end(),
                       [&](const Effect& one) { return cosine(truth, one, tests) >= 0.95; })
               ? 1
               : 0;
  }
  if (hit < 2 && options.verbose) {
    std::string names;
    for (const Effect& one : found.found.model.effects) names += " [" + one.name + "]";
    said = fmt::format("  world {}: {} + {} ->{} ({})\n", world.seed, truths[0].name,
                       truths[1].name, names, stop_in_words(found));
  }
  return {{"both", hit == 2}, {"said", said}};
}

void two(const Options& options) {
  const int whole = 5 * options.recordings;
  int both = 0;
  // Which worlds count follows from those before: every share draws them, up to its own.
  std::uint64_t seed = options.first;
  int drawn = 0;
  for (int trial = 0; trial < whole; ++trial) {
    const auto outcome = options.trials->next([&] {
      for (;; ++seed) {
        const std::optional<Pair> pair = draw_pair(seed);
        if (!pair || drawn++ < trial) continue;
        ++seed;
        return find_two(options, *pair);
      }
    });
    if (outcome) both += outcome->at("both") ? 1 : 0;
  }
  if (!options.trials->whole()) return;
  fmt::print("two effects at 3 times: both found in {} of {} ({:.1f} %)\n", both, whole,
             percent(both, whole));
}

/// One shape, in as many worlds as show it.
Outcome odd_subject(const Options& options, std::size_t e) {
  int shown = 0;
  int right = 0;
  std::string said;
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
      ok =
          says(first.effect) || std::any_of(first.look_alikes.begin(), first.look_alikes.end(),
                                            [&](const LookAlike& one) { return says(one.effect); });
    }
    right += ok ? 1 : 0;
    if (!ok && options.verbose) {
      said += fmt::format("  {} (world {}): {}\n", truth.name, world.seed,
                          result.missing.empty() ? "not named" : result.missing);
    }
  }
  return {{"shown", shown}, {"right", right}, {"said", said}};
}

void odd(const Options& options) {
  int shown = 0;
  int right = 0;
  const std::size_t count = odd_subjects(draw_world(1)).size();
  for (std::size_t e = 0; e < count; ++e) {
    const auto outcome = options.trials->next([&] { return odd_subject(options, e); });
    if (!outcome) continue;
    shown += outcome->at("shown").get<int>();
    right += outcome->at("right").get<int>();
  }
  if (!options.trials->whole()) return;
  fmt::print("odd shapes at 3 times: right channel and variable in {} of {} ({:.1f} %)\n", right,
             shown, percent(right, shown));
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
  app.add_option("--shard", options.shard, "Do a share of the trials alone, like 3/16")
      ->type_name("K/N");
  app.add_option("--out", options.out, "With --shard: its results");
  app.add_option("--merge", options.merged, "Files of all shares: print what the whole run would");
}

/// All that trials depend on.
std::string settings_of(const Options& options, const std::vector<std::string>& parts) {
  return Outcome{{"first", options.first},     {"recordings", options.recordings},
                 {"clean", options.clean},     {"times", options.times},
                 {"loops", options.loops},     {"ladder", options.ladder},
                 {"verbose", options.verbose}, {"parts", parts}}
      .dump();
}

void take_settings(const std::string& text, Options& options, std::vector<std::string>& parts) {
  const Outcome settings = Outcome::parse(text);
  settings.at("first").get_to(options.first);
  settings.at("recordings").get_to(options.recordings);
  settings.at("clean").get_to(options.clean);
  settings.at("times").get_to(options.times);
  settings.at("loops").get_to(options.loops);
  settings.at("ladder").get_to(options.ladder);
  settings.at("verbose").get_to(options.verbose);
  settings.at("parts").get_to(parts);
}

/// Shares have all parts but the one that measures time.
void begin(Options& options, std::vector<std::string>& parts) {
  if (!options.merged.empty()) {
    take_settings(options.trials->take_results(options.merged), options, parts);
  } else if (!options.shard.empty()) {
    if (options.out.empty()) throw std::invalid_argument("--shard needs --out");
    if (parts.empty())
      parts = {"false-alarms", "identify", "two", "odd", "events", "noise", "riddles"};
    if (std::find(parts.begin(), parts.end(), "cost") != parts.end()) {
      throw std::invalid_argument("cost measures time, and is of no share");
    }
    options.trials->take_share(parse_shard(options.shard));
  }
}

void end(const Options& options, const std::vector<std::string>& parts) {
  if (!options.shard.empty()) options.trials->write(settings_of(options, parts), options.out);
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
                                         {"riddles", riddles},
                                         {"cost", [](const Options&) { cost(); }}};
  return run_bench<Options>(argc, argv, "How well diagnose and discover do on simulated recordings",
                            parts, add_options, {begin, end});
}
