// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects that no catalogue has: does a diagnosis find them, and what formula does it give them?
//
//   formulas   a formula per recording, at so many times the smallest detectable size; with and
//              without a compass. Found: the first finding shows 0.95 of the true trace. Left: what
//              the model with all that is missing, fitted, leaves on the noise-free twin beside the
//              true effect, as a share of what noise alone leaves (both dead reckoned over 10 s,
//              rms)
//   clean      recordings with nothing missing, and with rough noise: how many miss something
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "hidden_formulas.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap::bench {
namespace {

struct Options {
  std::uint64_t seed = 1;
  int worlds = 1;  ///< per formula, size and robot
  int clean = 20;  ///< recordings per kind of noise
  std::vector<double> times = {3.0, 5.0};
  std::string only;  ///< formulas whose name has this
  bool discovers = false;
  std::string mesh = "5x5";
};

constexpr double kWindow = 10.0;  // s

SimulationSettings settings_of(const Options& options, std::uint64_t seed, bool compass) {
  SimulationSettings settings;
  settings.mesh = options.mesh;
  settings.uneven = true;
  settings.rests = true;
  settings.seed = seed;
  settings.no_compass = !compass;
  return settings;
}

/// Way of each window, in map axes where a compass tells them, else in the robot's at its start.
std::vector<Vector2> ways(const std::vector<double>& t, const std::vector<Pose>& poses,
                          bool compass) {
  std::vector<Vector2> found;
  std::size_t to = 0;
  double next = 0.0;
  for (std::size_t from = 0; from < t.size(); ++from) {
    if (t[from] < next) continue;
    while (to < t.size() && t[to] < t[from] + kWindow) ++to;
    if (to == t.size()) break;
    const Vector2 way = poses[to].position() - poses[from].position();
    found.emplace_back(compass ? way : rotation(-poses[from].heading) * way);
    next = t[from] + 0.5 * kWindow;
  }
  return found;
}

std::vector<Vector2> reckoned(const SimulatedRecording& world, const Model& model, bool compass) {
  std::vector<double> t;
  std::vector<Pose> poses;
  for (const TimedPose& one : dead_reckoned_poses(world.drive.recording, model)) {
    t.push_back(one.t);
    poses.push_back(one.estimate.pose);
  }
  return ways(t, poses, compass);
}

/// rms, after the rotation that takes the one best to the other: of a compass's first reading.
double apart(const std::vector<Vector2>& a, const std::vector<Vector2>& b) {
  const std::size_t count = std::min(a.size(), b.size());
  double along = 0.0;
  double across = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    along += a[k].dot(b[k]);
    across += a[k].x() * b[k].y() - a[k].y() * b[k].x();
  }
  const Matrix2 turned = rotation(std::atan2(across, along));
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += (turned * a[k] - b[k]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, a.size())));
}

struct Outcome {
  std::string formula;
  bool missing = false;
  bool found = false;
  double cosine = 0.0;
  double left = 0.0;      ///< of the noise
  double by_truth = 0.0;  ///< the same, of the true formula fitted
  double before = 0.0;    ///< the same, of the model without effects
  double seconds = 0.0;
  std::string first;
  std::string second;
  std::size_t count = 0;
};

std::string told(const Effect& effect) {
  std::string shapes;
  for (const Shape& one : effect.shape) shapes += (shapes.empty() ? "" : ", ") + one.text();
  return fmt::format("{} x {}", name_of(effect.channel), shapes);
}

/// Of a model that was found: what it leaves on the twin.
double left_by(const Model& model, const SimulatedRecording& twin,
               const std::vector<Vector2>& truth, bool compass) {
  return apart(reckoned(twin, model, compass), truth);
}

std::optional<Outcome> outcome_of(const Options& options, std::size_t at, std::uint64_t seed,
                                  double times, bool compass) {
  SimulationSettings settings = settings_of(options, seed, compass);
  const SimulatedRecording plan = simulate(settings, {});
  HiddenFormula hidden = hidden_formulas(extent_of(plan), seed)[at];
  if (hidden.needs_compass && !compass) return std::nullopt;
  settings.gyro = hidden.needs_gyro;
  const Robot robot;
  const SimulatedRecording clean = simulate(settings, {});
  const ModelFit fit = fit_model({with_wheels(clean.drive.recording, robot)}, clean.model);
  const criticism::ScoreTest tests(*fit.state);
  World drawn;
  drawn.seed = 7;  // of the direction, with the recording's
  hidden.effect.coefficients = sized({hidden.effect}, drawn, tests, times, seed);
  if (hidden.effect.coefficients.empty()) return std::nullopt;
  const SimulatedRecording world = simulate(settings, {hidden.effect});
  settings.noise_free = true;
  const SimulatedRecording twin = simulate(settings, {hidden.effect});

  Outcome one;
  one.formula = hidden.name;
  const std::vector<DrivenRecording> recordings{with_wheels(world.drive.recording, robot)};
  const auto begun = std::chrono::steady_clock::now();
  const Diagnosis result = diagnose(recordings, world.model);
  one.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  one.missing = result.verdict == Diagnosis::Verdict::missing;
  Model found = world.model;
  if (result.under) found.noise = result.under->fit.model.noise;
  if (one.missing) {
    one.cosine = cosine(hidden.effect, result.findings.front().effect, tests);
    one.found = one.cosine >= 0.95;
    one.first = told(result.findings.front().effect);
    for (const Finding& finding : result.findings) {
      if (finding.status != Status::missing) continue;
      ++one.count;
      if (one.count == 2) one.second = told(finding.effect);
      found.effects.push_back(finding.effect);
      found.effects.back().coefficients.clear();
    }
    if (one.count < 2 && !result.findings.front().look_alikes.empty()) {
      one.second = "~ " + told(result.findings.front().look_alikes.front().effect);
    }
  }
  if (options.discovers) found = discover(recordings, world.model).found.model;
  if (!options.discovers && !found.effects.empty()) found = fit_model(recordings, found).model;
  Model true_model = world.model;
  true_model.effects = {hidden.effect};
  const std::vector<Vector2> truth = reckoned(twin, true_model, compass);
  std::vector<double> t{0.0};
  std::vector<Pose> poses{world.drive.motion.start};
  for (const TrueRow& row : world.drive.motion.rows) {
    t.push_back(row.t);
    poses.push_back(row.pose);
  }
  const double noise = apart(reckoned(world, true_model, compass), ways(t, poses, compass));
  one.before = left_by(world.model, twin, truth, compass) / noise;
  one.left = left_by(found, twin, truth, compass) / noise;
  true_model.effects.front().coefficients.clear();
  one.by_truth = left_by(fit_model(recordings, true_model).model, twin, truth, compass) / noise;
  return one;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(
      std::lround(share * static_cast<double>(values.size() - 1)))];
}

void formulas(const Options& options) {
  const SimulatedRecording plan = simulate(settings_of(options, 1, true), {});
  const std::vector<HiddenFormula> list = hidden_formulas(extent_of(plan), 1);
  for (const double times : options.times) {
    std::vector<double> left;
    std::vector<double> before;
    std::vector<double> by_truth;
    std::vector<double> seconds;
    int missing = 0;
    int found = 0;
    int same = 0;
    for (std::size_t at = 0; at < list.size(); ++at) {
      if (list[at].name.find(options.only) == std::string::npos) continue;
      for (const bool compass : {false, true}) {
        for (int k = 0; k < options.worlds; ++k) {
          const std::uint64_t seed =
              1000 * (options.seed + static_cast<std::uint64_t>(k)) + 2 * at + (compass ? 1 : 0);
          const std::optional<Outcome> one = outcome_of(options, at, seed, times, compass);
          if (!one) continue;
          left.push_back(one->left);
          before.push_back(one->before);
          by_truth.push_back(one->by_truth);
          seconds.push_back(one->seconds);
          missing += one->missing ? 1 : 0;
          found += one->found ? 1 : 0;
          same += one->cosine >= 0.99 ? 1 : 0;
          fmt::print(
              "x{:.0f} {:<20} {} {} cos {:.3f} left {:.3f} (true {:.3f}, none {:.2f}) {:.1f} s "
              "[{}] {} | {}\n",
              times, one->formula, compass ? "c" : "-",
              one->found     ? "found"
              : one->missing ? "other"
                             : "-----",
              one->cosine, one->left, one->by_truth, one->before, one->seconds, one->count,
              one->first, one->second);
        }
      }
    }
    fmt::print(
        "{:.0f} times: {} recordings, something missing in {}, trace of 0.95 in {}, of 0.99 in {}; "
        "left {:.3f} (median) {:.3f} (90 %), by the true formula {:.3f} {:.3f}, by none {:.2f}; "
        "{:.2f} s (median) {:.2f} s (90 %)\n",
        times, left.size(), missing, found, same, quantile(left, 0.5), quantile(left, 0.9),
        quantile(by_truth, 0.5), quantile(by_truth, 0.9), quantile(before, 0.5),
        quantile(seconds, 0.5), quantile(seconds, 0.9));
  }
}

void clean(const Options& options) {
  for (const std::string kind : {"", "half", "memory", "haze", "tails", "floor"}) {
    int missing = 0;
    std::vector<double> seconds;
    for (int k = 0; k < options.clean; ++k) {
      SimulationSettings settings =
          settings_of(options, options.seed + static_cast<std::uint64_t>(k) + 500000,
                      k % 2 == 0 || kind == "haze");
      settings.rough = kind;
      settings.no_survey = k % 5 == 4;
      const SimulatedRecording world = simulate(settings, {});
      const auto begun = std::chrono::steady_clock::now();
      const Diagnosis result = diagnose({with_wheels(world.drive.recording, Robot())}, world.model);
      seconds.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
      if (result.verdict != Diagnosis::Verdict::missing) continue;
      ++missing;
      fmt::print("  {} seed {}: {}\n", kind, settings.seed, told(result.findings.front().effect));
    }
    fmt::print("{}: something missing in {} of {}; {:.2f} s (median)\n",
               kind.empty() ? "white" : kind, missing, options.clean, quantile(seconds, 0.5));
  }
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--seed", options.seed, "First seed")->capture_default_str();
  app.add_option("--worlds", options.worlds, "Recordings per formula, size and robot")
      ->capture_default_str();
  app.add_option("--clean", options.clean, "Effect-free recordings per kind of noise")
      ->capture_default_str();
  app.add_option("--times", options.times, "Sizes, in multiples of the smallest detectable")
      ->capture_default_str();
  app.add_option("--only", options.only, "Formulas whose name has this");
  app.add_option("--mesh", options.mesh, "Landmarks")->capture_default_str();
  app.add_flag("--discover", options.discovers, "What discover ends with is judged");
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  return run_bench<Options>(argc, argv, "Formulas that no catalogue has: found, and named?",
                            {{"formulas", formulas}, {"clean", clean}}, add_options);
}
