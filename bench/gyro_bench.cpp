// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Many drives with a gyro, compass and survey: which effects of the gyro are named, and what is
// named where nothing is missing, or where the bias walks at random.
#include "bench_program.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap {
namespace {

struct Options {
  int drives = 100;
  std::uint64_t seed = 1;
  double times = 3.0;                              ///< of what is just seen
  std::vector<double> walks = {3e-6, 1e-5, 3e-5};  ///< rad/s per s^1/2
  std::vector<std::string> effects = {"gyro bias", "gyro warm-up",
                                      "gyro temperature drift (temperature_C)", "gyro scale",
                                      "gyro asymmetry"};
};

constexpr double kGyroNoise = 0.0005;  // rad/s^1/2

Model stated() {
  Model model;
  model.noise.gyro = kGyroNoise;
  return model;
}

/// As simulate --mesh 4x4 --tours 3 --gyro draws it.
DrivenRecording driven(std::uint64_t seed, double walk, const std::vector<Effect>& effects) {
  const Mesh mesh = even_mesh({4, 4}, 5.0);
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 3, random);
  WheeledRobot robot;
  robot.gyro = true;
  robot.noise.gyro = kGyroNoise;
  robot.noise.gyro_walk = walk;
  return with_wheels(simulate_drive(mesh, tours.walk, {}, robot, seed, {effects}).recording,
                     Robot());
}

bool is_named(const Finding& finding, const std::string& name) {
  if (finding.effect.name == name) return true;
  return std::any_of(finding.look_alikes.begin(), finding.look_alikes.end(),
                     [&name](const LookAlike& rival) { return rival.effect.name == name; });
}

bool misses_something(const Diagnosis& diagnosis) {
  return diagnosis.verdict == Diagnosis::Verdict::missing;
}

/// What is named, and of what noise it stands out.
void tell(std::uint64_t seed, const Diagnosis& found) {
  const bool missing = misses_something(found);
  const Finding* first = found.findings.empty() ? nullptr : &found.findings.front();
  fmt::print(stderr, "  seed {}: {}{}", seed, missing ? "" : "nothing; best ",
             first != nullptr ? first->effect.name : "");
  if (first != nullptr) fmt::print(stderr, ", p {:.2g}", first->p_adjusted);
  if (found.under) {
    for (const NoiseSource& one : found.under->noise.sources) {
      if (one.sd == one.stated) continue;
      fmt::print(stderr, "; {} {:.3g} for {:.3g}", one.name, one.sd, one.stated);
    }
  }
  fmt::print(stderr, "\n");
}

/// Of drives with so many times what is just seen of an effect.
void identify(const Options& options) {
  fmt::print("{:<40} {:>9}  named first, or as looking the same\n", "effect", "g");
  std::map<std::string, std::pair<int, int>> counts;
  std::map<std::string, double> sizes;
  for (int k = 0; k < options.drives; ++k) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(k);
    const Diagnosis none = diagnose({driven(seed, 0.0, {})}, stated());
    for (const std::string& name : options.effects) {
      const auto seen =
          std::find_if(none.findings.begin(), none.findings.end(),
                       [&name](const Finding& one) { return one.effect.name == name; });
      if (seen == none.findings.end()) continue;
      const double size = options.times * seen->minimal_detectable.front();
      const Diagnosis found =
          diagnose({driven(seed, 0.0, {catalogue_effect(name, {size})})}, stated());
      const bool right = misses_something(found) && is_named(found.findings.front(), name);
      auto& [named, tried] = counts[name];
      named += right ? 1 : 0;
      ++tried;
      sizes[name] += size;
      if (right) continue;
      fmt::print(stderr, "{}:", name);
      tell(seed, found);
    }
  }
  for (const auto& [name, count] : counts) {
    fmt::print("{:<40} {:>9.3g}  {} of {}\n", name, sizes[name] / count.second, count.first,
               count.second);
  }
}

/// How many of drives without an effect miss something.
void count_alarms(const Options& options, double walk) {
  int alarms = 0;
  int of_gyro = 0;
  for (int k = 0; k < options.drives; ++k) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(k);
    const Diagnosis found = diagnose({driven(seed, walk, {})}, stated());
    if (!misses_something(found)) continue;
    ++alarms;
    const Channel channel = found.findings.front().effect.channel;
    of_gyro += channel == Channel::gyro || channel == Channel::gyro_scale ? 1 : 0;
    tell(seed, found);
  }
  fmt::print("walk {:<8.3g} {} of {} miss something, {} of them an effect of the gyro\n", walk,
             alarms, options.drives, of_gyro);
}

void clean(const Options& options) {
  count_alarms(options, 0.0);
}

void walks(const Options& options) {
  for (const double walk : options.walks) count_alarms(options, walk);
}

/// What fit --noise says of a white noise and of a walk.
void sizes(const Options& options) {
  for (const double walk : options.walks) {
    struct Mean {
      double sum = 0.0;
      double squares = 0.0;
      int count = 0;
    };
    std::map<std::string, Mean> means;
    for (int k = 0; k < options.drives; ++k) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(k);
      const FitWithNoise found = fit_model_and_noise({driven(seed, walk, {})}, stated());
      for (const NoiseSource& one : found.noise.sources) {
        Mean& mean = means[one.name];
        mean.sum += one.sd;
        mean.squares += one.sd * one.sd;
        ++mean.count;
      }
    }
    fmt::print("walk {:.3g}, gyro {:.3g}\n", walk, kGyroNoise);
    for (const auto& [name, mean] : means) {
      const double middle = mean.sum / mean.count;
      const double variance = mean.squares / mean.count - middle * middle;
      fmt::print("  {:<28} {:.4g} +- {:.2g} in {} of {}\n", name, middle,
                 std::sqrt(std::max(0.0, variance) / std::max(1, mean.count - 1)), mean.count,
                 options.drives);
    }
  }
}

}  // namespace
}  // namespace trussmap

int main(int argc, char** argv) {
  using trussmap::Options;
  using trussmap::bench::Part;
  return trussmap::bench::run_bench<Options>(
      argc, argv, "Drives with a gyro",
      {Part<Options>{"identify", trussmap::identify}, Part<Options>{"clean", trussmap::clean},
       Part<Options>{"walks", trussmap::walks}, Part<Options>{"sizes", trussmap::sizes}},
      [](CLI::App& app, Options& options) {
        app.add_option("--drives", options.drives, "Of each kind")
            ->capture_default_str()
            ->check(CLI::Range(2, 1000000));
        app.add_option("--seed", options.seed, "Of the first drive; the next have the next")
            ->capture_default_str();
        app.add_option("--times", options.times, "An effect's size, of what is just seen")
            ->capture_default_str();
        app.add_option("--walks", options.walks, "How the bias walks [rad/s per s^1/2]")
            ->capture_default_str();
        app.add_option("--effects", options.effects, "Of the catalogue")->capture_default_str();
      });
}
