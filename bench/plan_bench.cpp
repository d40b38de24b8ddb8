// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Does the planned drive decide? Riddles by seed: a world, a robot, an effect of the catalogue that
// a recording shows but cannot tell from others.
//
//   world, effect --record--> recording --diagnose--> "one of these" --plan_drive--> plan
//                                 '------- diagnose both <-- recording of it <-- simulate_plan
//
//   right     both together: what is named first is the truth
//   decided   and none of the plan's rivals is left (12 of chi^2 behind at least)
//   three     the same with three more tours of every route in place of the plan
#include "bench_worlds.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace trussmap;
using namespace trussmap::bench;

struct BenchOptions {
  int riddles = 20;
  std::uint64_t first = 1;
  std::uint64_t last = 100000;
  int legs = 40;
  double times = 3.0;
  bool tours = false;
  bool verbose = false;
};

bool is_same(const Effect& a, const Effect& b) {
  return a.channel == b.channel && a.shape == b.shape;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A recording that shows an effect, and what it is.
struct Riddle {
  World world;
  Effect truth;
  DrivenRecording recording;
  Diagnosis diagnosis;
  std::vector<Effect> rivals;  ///< the first finding, and what it may be as well
};

/// What is named first and not told from it.
std::vector<Effect> left_open(const Diagnosis& diagnosis) {
  std::vector<Effect> open;
  if (diagnosis.verdict != Diagnosis::Verdict::missing) return open;
  open.push_back(diagnosis.findings.front().effect);
  for (const LookAlike& one : diagnosis.findings.front().look_alikes) {
    if (!one.told_apart()) open.push_back(one.effect);
  }
  return open;
}

bool has(const std::vector<Effect>& effects, const Effect& effect) {
  return std::any_of(effects.begin(), effects.end(),
                     [&effect](const Effect& one) { return is_same(one, effect); });
}

std::optional<Riddle> draw_riddle(std::uint64_t seed, const BenchOptions& options) {
  Riddle riddle;
  riddle.world = with_legs(draw_world(seed), options.legs);
  const World& world = riddle.world;
  std::vector<Subject> all = subjects(world);
  std::mt19937_64 random(seed * 65537 + 29);
  const Subject& subject =
      all[std::uniform_int_distribution<std::size_t>(0, all.size() - 1)(random)];
  if (!shows(world, subject)) return std::nullopt;
  const DrivenRecording plain = record_in(world, {});
  const ModelFit fit = fit_model({plain}, world.model);
  riddle.truth = subject.effect;
  riddle.truth.coefficients =
      sized(subject, world, criticism::ScoreTest(*fit.state), options.times, seed);
  if (riddle.truth.coefficients.empty()) return std::nullopt;
  riddle.recording = record_in(world, {riddle.truth});
  riddle.diagnosis = diagnose({riddle.recording}, world.model);
  riddle.rivals = left_open(riddle.diagnosis);
  if (riddle.rivals.size() < 2 || !has(riddle.rivals, riddle.truth)) return std::nullopt;
  return riddle;
}

DrivenRecording second_session(const Riddle& riddle, SimulatedDrive drive) {
  drive.recording.survey.clear();
  if (riddle.world.surveyed) drive.recording.survey = riddle.recording.survey;
  drive.recording.name = "plan";
  return with_wheels(drive.recording, riddle.world.model.robot);
}

double length_of(const SimulatedDrive& drive) {
  double sum = 0.0;
  for (const TrueRow& row : drive.motion.rows) {
    sum += std::hypot(row.speed, row.sideways) * row.duration;
  }
  return sum;
}

struct Answer {
  bool right = false;
  bool decided = false;
  std::string said;
};

/// Rivals of the plan that the named one is still not told from.
Answer answer_of(const Riddle& riddle, const DrivenRecording& further,
                 const std::vector<Effect>& planned) {
  const Diagnosis both = diagnose({riddle.recording, further}, riddle.world.model);
  Answer answer;
  const std::vector<Effect> open = left_open(both);
  if (open.empty()) {
    answer.said = "nothing";
    return answer;
  }
  answer.said = open.front().name;
  answer.right = is_same(open.front(), riddle.truth);
  answer.decided =
      answer.right && std::none_of(open.begin() + 1, open.end(),
                                   [&](const Effect& one) { return has(planned, one); });
  return answer;
}

struct Sums {
  int riddles = 0, planned = 0, right = 0, decided = 0, enough = 0, enough_right = 0,
      enough_decided = 0, short_enough = 0, tours_right = 0, tours_decided = 0;
  double length = 0.0, tours = 0.0, seconds = 0.0;
};

void try_riddle(const Riddle& riddle, const BenchOptions& options, Sums& sums) {
  const World& world = riddle.world;
  ++sums.riddles;
  const auto start = std::chrono::steady_clock::now();
  PlannedDrive drive;
  try {
    drive = plan_drive(riddle.diagnosis, {});
  } catch (const std::exception& error) {
    fmt::print("{:6} {}: no plan: {}\n", world.seed, riddle.truth.name, error.what());
    return;
  }
  const double seconds = seconds_since(start);
  sums.seconds += seconds;
  std::mt19937_64 random(world.seed * 31 + 6);
  const std::vector<int> walk = make_tours(world.mesh, WalkKind::euler, 3, random).walk;
  const SimulatedDrive tours = simulate_drive(world.mesh, walk, world.style, world.robot,
                                              world.seed + 1000003, {{riddle.truth}});
  const double three = length_of(tours);
  if (options.verbose) {
    for (const PlannedPair& one : drive.pairs) {
      fmt::print("       {} / {}: lambda {:.1f} -> {:.1f}, power {:.2f} -> {:.2f}{}\n",
                 one.truth.name, one.rival.name, one.before, one.after, one.power_before, one.power,
                 one.beyond ? ", beyond" : "");
    }
  }
  std::size_t beyond = 0;
  std::vector<Effect> planned;
  for (const PlannedPair& one : drive.pairs) {
    beyond += one.beyond ? 1 : 0;
    const bool about_truth = is_same(one.truth, riddle.truth);
    if (about_truth && !one.beyond) planned.push_back(one.rival);
  }
  Answer answer;
  if (!drive.plan.waypoints.empty()) {
    ++sums.planned;
    const SimulatedDrive driven = simulate_plan(world.mesh, drive.plan, world.style, world.robot,
                                                world.seed + 2000003, {{riddle.truth}});
    answer = answer_of(riddle, second_session(riddle, driven), planned);
    sums.right += answer.right ? 1 : 0;
    sums.decided += answer.decided ? 1 : 0;
    sums.enough += drive.enough ? 1 : 0;
    sums.enough_right += drive.enough && answer.right ? 1 : 0;
    sums.enough_decided += drive.enough && answer.decided ? 1 : 0;
    sums.short_enough += drive.length <= 0.5 * three ? 1 : 0;
    sums.length += drive.length;
    sums.tours += three;
  }
  std::string other;
  if (options.tours) {
    const Answer long_way = answer_of(riddle, second_session(riddle, tours), planned);
    sums.tours_right += long_way.right ? 1 : 0;
    sums.tours_decided += long_way.decided ? 1 : 0;
    other = fmt::format("; three tours: {}{}", long_way.right ? "right" : "wrong",
                        long_way.decided ? ", decided" : "");
  }
  fmt::print(
      "{:6} {} among {} ({} pairs of {} beyond): {:.0f} m of {:.0f}, {:.0f} s, power "
      "{:.2f}{}, planned in {:.1f} s: {}{} ({}){}\n",
      world.seed, riddle.truth.name, riddle.rivals.size(), beyond, drive.pairs.size(), drive.length,
      three, drive.duration, drive.power, drive.enough ? "" : " (not enough)", seconds,
      answer.right ? "right" : "WRONG", answer.decided ? ", decided" : "", answer.said, other);
  std::fflush(stdout);
}

void run(const BenchOptions& options) {
  Sums sums;
  for (std::uint64_t seed = options.first; seed <= options.last && sums.riddles < options.riddles;
       ++seed) {
    const std::optional<Riddle> riddle = draw_riddle(seed, options);
    if (riddle) try_riddle(*riddle, options, sums);
  }
  fmt::print(
      "{} riddles, {} planned: right {}, decided {}; with power as wished {}: right {}, "
      "decided {}\n",
      sums.riddles, sums.planned, sums.right, sums.decided, sums.enough, sums.enough_right,
      sums.enough_decided);
  fmt::print(
      "at most half as long as three tours: {}; together {:.0f} m of {:.0f}; {:.1f} s a "
      "plan\n",
      sums.short_enough, sums.length, sums.tours, sums.seconds / std::max(1, sums.riddles));
  if (options.tours) {
    fmt::print("three tours in place of the plan: right {}, decided {}\n", sums.tours_right,
               sums.tours_decided);
  }
}

}  // namespace

int main(int argc, char** argv) {
  BenchOptions options;
  CLI::App app{"Does the planned drive decide between effects that a recording cannot tell apart?"};
  app.add_option("--riddles", options.riddles, "How many")->capture_default_str();
  app.add_option("--first", options.first, "The first seed")->capture_default_str();
  app.add_option("--last", options.last, "The last seed")->capture_default_str();
  app.add_option("--legs", options.legs, "Of the recording")->capture_default_str();
  app.add_option("--times", options.times, "Size, times the minimal detectable one")
      ->capture_default_str();
  app.add_flag("--tours", options.tours, "Diagnose three more tours in place of the plan, too");
  app.add_flag("--verbose", options.verbose, "List pairs of rivals");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
