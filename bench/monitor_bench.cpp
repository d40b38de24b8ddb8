// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the monitor on the robot (monitor.hpp) says of drives whose truth is known:
//
//   clean    drives with no effect, the noise as stated or rough, and then estimated from a drive
//            before: alarms per hour, beside the rate that was asked for
//   power    an effect that begins in mid-drive, so many times as large as what 50 legs just show
//            (expected score 24.4 by the standard error of a fit to them): after how many legs it
//            is announced, and whether after 100 legs it is named, or among the look-alikes
//   cost     time per leg after so many legs
//
// Worlds are those of the criticism's figures, drawn from seeds.
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "fit/online_odometry.hpp"
#include "monitor/leg_filter.hpp"
#include "monitor/leg_odometry.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/monitor.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace monitor;
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::vector<std::string> kinds = {"stated", "half", "memory", "haze", "tails", "floor", "all"};
  std::uint64_t first = 1;
  double hours = 20.0;  ///< clean drives, per kind
  int legs = 600;       ///< per clean drive
  double rate = 0.1;    ///< asked for, per hour
  int drives = 20;      ///< with an effect, each
  double times = 3.0;
  long last_leg = 10'000;
  bool estimate = true;
  bool verbose = false;
};

World world_of(std::uint64_t seed, const std::string& kind) {
  World world = draw_world(seed);
  if (kind != "stated") world.robot.rough = parse_rough(kind);
  return world;
}

/// As a robot's owner would have it: by a drive of 300 legs before, with a survey where there is
/// one.
Model estimated_model(const World& world, const std::string& kind) {
  if (kind == "stated") return world.model;
  World before = with_legs(world, 300);
  before.seed += 1'000'000;
  Model model = world.model;
  model.noise = fit_model_and_noise({record_in(before, {})}, model).noise.noise;
  return model;
}

double hours_of(const Watch& watched, const DrivenRecording& recording) {
  const double end = watched.alarm ? watched.alarm_t : watched.legs.back().t;
  return (end - recording.drive.start()) / 3600.0;
}

WatchOptions watching(const Options& options) {
  WatchOptions how;
  how.monitor.false_alarms_per_hour = options.rate;
  return how;
}

void measure_clean(const Options& options) {
  fmt::print("\nclean: alarms where no effect is; {} per hour are asked for\n", options.rate);
  fmt::print("  noise     drives    hours  alarms  per hour  over asked for\n");
  for (const std::string& kind : options.kinds) {
    double hours = 0.0;
    int alarms = 0;
    int drives = 0;
    std::map<std::string, int> named;
    for (std::uint64_t seed = options.first; hours < options.hours; ++seed) {
      const World world = with_legs(world_of(seed, kind), options.legs);
      const Model model = options.estimate ? estimated_model(world, kind) : world.model;
      const DrivenRecording recording = record_in(world, {});
      const Watch watched = watch(recording, model, watching(options));
      hours += hours_of(watched, recording);
      alarms += watched.alarm ? 1 : 0;
      ++drives;
      if (!watched.alarm) continue;
      ++named[watched.alarm->found->effect.name];
      if (options.verbose) {
        fmt::print("  seed {}: {} at leg {}, {} survey, {} compass\n", seed,
                   watched.alarm->found->effect.name, watched.alarm->legs,
                   world.surveyed ? "with" : "no", world.robot.compass ? "with" : "no");
      }
    }
    fmt::print("  {:8} {:7} {:8.0f} {:7} {:9.4f} {:9.2f}   ", kind, drives, hours, alarms,
               alarms / hours, alarms / hours / options.rate);
    for (const auto& [name, count] : named) fmt::print(" {} {}", name, count);
    fmt::print("\n");
  }
}

// ----------------------------------------
// An effect that begins in mid-drive.

constexpr int kBefore = 100;
constexpr int kAfter = 100;
constexpr int kShown = 50;

/// Smallest size that so many legs show: 90 % power at p = 0.05/200.
double just_shown(const World& world, const Effect& effect) {
  Model model = world.model;
  model.effects.push_back(effect);
  const ModelFit fit = fit_model({record_in(with_legs(world, kShown), {})}, model);
  return std::sqrt(24.4) * fit.effects.front().sd.front();
}

struct Announced {
  bool at_all = false;
  bool false_alarm = false;  ///< before the effect began
  bool at_once = false;      ///< named when announced
  bool named = false;
  bool alike = false;  ///< another was named, and this among its look-alikes
  long legs = 0;       ///< after it began
  long since_off = 0;  ///< legs by which the beginning is misjudged
  std::string name;
};

Announced announced(const World& world, const WatchedEffect& watched, double g,
                    const Options& options) {
  const World driven = with_legs(world, kBefore + kAfter);
  const DrivenRecording clean = record_in(driven, {});
  const double begins = watch(clean, world.model).legs.at(kBefore - 1).t;
  const Effect effect{watched.name,
                      watched.channel,
                      {fmt::format("0.5*(1+sign(t-{:.9g}))", begins - clean.drive.start())},
                      {g}};
  const Watch seen = watch(record_in(driven, {effect}), world.model, watching(options));
  Announced result;
  if (!seen.alarm) return result;
  result.false_alarm = seen.alarm_t <= begins;
  result.at_all = !result.false_alarm;
  const FoundEffect& found = *seen.found;  // 50 legs after the alarm, or 100 after it began
  result.name = found.effect.name;
  result.at_once = seen.alarm->found->effect.name == watched.name;
  result.named = found.effect.name == watched.name;
  result.alike = std::any_of(found.look_alikes.begin(), found.look_alikes.end(),
                             [&](const auto& one) { return one.name == watched.name; });
  result.legs = seen.alarm->legs - kBefore;
  result.since_off = std::abs(found.leg - (kBefore + 1));
  return result;
}

struct Tally {
  int drives = 0, at_all = 0, at_once = 0, named = 0, alike = 0;
  std::vector<double> legs = {}, off = {};

  void add(const Announced& one) {
    ++drives;
    if (!one.at_all) return;
    ++at_all;
    at_once += one.at_once ? 1 : 0;
    named += one.named ? 1 : 0;
    alike += !one.named && one.alike ? 1 : 0;
    legs.push_back(static_cast<double>(one.legs));
    off.push_back(static_cast<double>(one.since_off));
  }
};

double middle_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void measure_power(const Options& options) {
  fmt::print("\npower: effects {} times as large as what {} legs just show, from leg {} on\n",
             options.times, kShown, kBefore);
  fmt::print(
      "  {:22} drives  within {} legs  named at once  at the end  look-alike   legs  off by\n",
      "effect", kAfter);
  std::map<std::string, Tally> tallies;
  for (int k = 0; k < options.drives; ++k) {
    const World world = draw_world(options.first + static_cast<std::uint64_t>(k), Survey::yes);
    OdometryInputs inputs;
    inputs.compass = world.robot.compass;
    for (const WatchedEffect& watched : watched_effects(world.model.robot, inputs)) {
      const double shown = just_shown(world, {watched.name, watched.channel, {"1"}, {}});
      if (!std::isfinite(shown) || !(shown > 0.0)) continue;
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      const Announced one = announced(world, watched, sign * options.times * shown, options);
      if (options.verbose && !(one.at_all && one.named)) {
        fmt::print("  seed {}: {} {:.4g}: {} after {} legs\n", options.first + std::uint64_t(k),
                   watched.name, sign * options.times * shown,
                   one.name.empty() ? "nothing" : one.name, one.legs);
      }
      tallies[watched.name].add(one);
      tallies["~ all"].add(one);
    }
  }
  for (const auto& [name, one] : tallies) {
    fmt::print("  {:22} {:6} {:16} {:14} {:11} {:11} {:6.0f} {:7.0f}\n", name, one.drives,
               one.at_all, one.at_once, one.named, one.alike, middle_of(one.legs),
               middle_of(one.off));
  }
}

// ----------------------------------------
// Innovations of clean drives: 0 on average, of variance 1, white.

/// Of numbers that should be standard normal.
struct Moments {
  long count = 0;
  double sum = 0.0;
  double squares = 0.0;
  double products = 0.0;  ///< with the one before of the same kind
  double last = 0.0;

  void add(double w) {
    ++count;
    sum += w;
    squares += w * w;
    products += w * last;
    last = w;
  }
};

using Innovations = std::map<std::string, Moments>;

/// By how much the robot turns between two landmarks, rad: on the spot, and in bends.
std::string kind_of_leg(double turned) {
  if (turned < 0.5) return "straight";
  if (turned < 2.4) return "turn";
  return turned < 5.0 ? "about turn" : "spin";
}

/// Drives until a sighting; by how much the robot turned, rad.
double drive_until(double t, const MotionRows& drive, std::size_t& row,
                   fitting::OnlineOdometry& odometry, LegOdometry& leg) {
  double turned = 0.0;
  for (; row < drive.rows() && drive.t[row] <= t + 1e-9; ++row) {
    WheelRow one{drive.duration(row), drive.pair.left[row], drive.pair.right[row]};
    if (drive.has_compass()) one.compass = drive.heading[row];
    const CorrectedRow corrected = odometry.drive(one, {});
    turned += std::abs(corrected.motion.displacement.heading);
    leg.take(corrected.motion, odometry.shown(), odometry.reading(), odometry.excess(), 0.0);
  }
  return turned;
}

void add_innovations(const World& world, Innovations& all) {
  const DrivenRecording recording = record_in(world, {});
  const Noise& noise = world.model.noise;
  OdometryInputs inputs;
  inputs.compass = recording.drive.has_compass();
  fitting::OnlineOdometry odometry(world.model, inputs);
  LegOdometry leg({});
  LegFilter filter({}, 24, 0);
  std::map<std::string, MapPlace> survey;
  for (const SurveyPoint& point : recording.survey) {
    survey[point.landmark] = {{point.x, point.y},
                              noise.survey * noise.survey * Matrix2::Identity()};
  }
  std::size_t row = 0;
  for (const Sighting& sighting : recording.sightings) {
    if (!sighting.standing()) continue;
    const std::string kind =
        kind_of_leg(drive_until(sighting.t, recording.drive, row, odometry, leg));
    const LegFilter::Said said = [&](const Eigen::VectorXd& w, const Eigen::MatrixXd&) {
      const bool compass = w.size() == 1;
      for (Eigen::Index k = 0; k < w.size(); ++k) {
        all[(compass  ? "compass, "
             : k == 0 ? "landmark ahead, "
                      : "landmark left, ") +
            kind]
            .add(w[k]);
      }
    };
    const LegReckoning done = leg.finish();
    filter.drive(done, LegColumns::Zero(5, 0), LegColumns::Zero(5, 0));
    filter.read_compass(done, noise.compass, {}, said);
    const auto known = survey.find(sighting.landmark);
    filter.see(sighting.landmark, landmark_offset(sighting, noise),
               known == survey.end() ? nullptr : &known->second, said);
  }
}

void measure_innovations(const Options& options) {
  fmt::print("\ninnovations: of clean drives, whitened; noise as stated\n");
  fmt::print("  what, leg                    number   mean            variance        lag 1\n");
  Innovations all;
  for (int k = 0; k < options.drives; ++k) {
    add_innovations(with_legs(draw_world(options.first + std::uint64_t(k)), options.legs), all);
  }
  for (const auto& [name, one] : all) {
    const auto n = static_cast<double>(one.count);
    const double mean = one.sum / n;
    fmt::print("  {:27} {:7} {:7.3f} +- {:.3f} {:7.3f} +- {:.3f} {:7.3f}\n", name, one.count, mean,
               1.0 / std::sqrt(n), one.squares / n - mean * mean, std::sqrt(2.0 / n),
               one.products / n);
  }
}

// ----------------------------------------
// Time per leg.

void measure_cost(const Options& options) {
  fmt::print("\ncost: microseconds per leg of 20 rows, median of the legs from n/2 to n\n");
  Model model;
  Monitor monitor(model);
  std::mt19937_64 random(options.first);
  std::normal_distribution<double> normal;
  const Mesh mesh = even_mesh({10, 10}, 5.0);
  for (int k = 0; k < mesh.landmarks(); ++k) {
    const Vector2& at = mesh.positions[static_cast<std::size_t>(k)];
    monitor.know({landmark_name(mesh, k), at.x(), at.y()});
  }
  double heading = 0.0;
  std::vector<double> times;
  long next = 100;
  double at_hundred = 0.0;
  int here = 0;
  std::vector<std::vector<int>> ways(static_cast<std::size_t>(mesh.landmarks()));
  for (const MeshRoute& route : mesh.routes) {
    ways[static_cast<std::size_t>(route.from)].push_back(route.to);
    ways[static_cast<std::size_t>(route.to)].push_back(route.from);
  }
  for (long leg = 1; leg <= options.last_leg; ++leg) {
    const std::vector<int>& out = ways[static_cast<std::size_t>(here)];
    const int to = out[random() % out.size()];
    const double towards = direction(mesh.displacement(here, to));
    const double turn = wrap_angle(towards - heading);
    const auto begin = Clock::now();
    for (int row = 0; row < 20; ++row) {
      const double spin = row < 10 ? 0.05 * turn * model.robot.wheelbase : 0.0;
      const double ahead = row < 10 ? 0.0 : 0.5;
      const auto noisy = [&](double way) {
        return way + 0.003 * std::sqrt(std::abs(way)) * normal(random);
      };
      (void)monitor.drive({0.5, noisy(ahead - spin), noisy(ahead + spin)});
    }
    (void)monitor.arrive({.sightings = {{0.0, landmark_name(mesh, to)}}});
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    heading = towards;
    here = to;
    if (leg != next) continue;
    const double median =
        middle_of({times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end()});
    if (next == 100) at_hundred = median;
    fmt::print("  leg {:7}: {:7.1f} us, {:.2f} times that of leg 100\n", leg, median,
               median / at_hundred);
    next *= 10;
  }
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  return run_bench<Options>(
      argc, argv, "The monitor on the robot: false alarms, power, cost",
      {{"clean", measure_clean},
       {"power", measure_power},
       {"innovations", measure_innovations},
       {"cost", measure_cost}},
      [](CLI::App& app, Options& options) {
        app.add_option("--kinds", options.kinds, "Noise: stated, or kinds of rough noise")
            ->capture_default_str();
        app.add_option("--first", options.first, "First seed")->capture_default_str();
        app.add_option("--hours", options.hours, "Of clean drives, per kind")
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
        app.add_option("--legs", options.legs, "Per clean drive")->capture_default_str();
        app.add_option("--rate", options.rate, "False alarms asked for, per hour")
            ->capture_default_str();
        app.add_option("--drives", options.drives, "Worlds with an effect, each")
            ->capture_default_str();
        app.add_option("--times", options.times, "Size of an effect, over what 50 legs just show")
            ->capture_default_str();
        app.add_option("--last-leg", options.last_leg, "How far the cost is followed")
            ->capture_default_str();
        app.add_flag("!--as-stated", options.estimate, "Rough noise is not estimated before");
        app.add_flag("--verbose", options.verbose, "A line per alarm, or per effect missed");
      });
}
