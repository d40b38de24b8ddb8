// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Many drives among landmarks with an axis, whose yaws are read: with and without a compass, seen
// from afar as well or stood on alone, surveyed or mapped. Is chi^2 per degree of freedom 1, do
// intervals hold the truth, is anything named where nothing is missing, and is a camera that is
// mounted turned named?
#include "bench_program.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// The k-th drive of a row, with this of the effects.
DrivenRecording marked_drive(int k, std::uint64_t first_seed, const std::vector<Effect>& effects) {
  const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(k);
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  WheeledRobot robot;
  robot.markers = true;
  robot.compass = k % 2 == 0;
  robot.range_sensor = k / 2 % 2 == 0;
  return with_wheels(
      simulate_drive(mesh, tours.walk, {}, robot, seed, SimulatedEffects{effects}).recording,
      Robot());
}

struct Options {
  int drives = 500;
  std::uint64_t seed = 1;
};

/// Each with a yaw offset and a wheelbase of its own, which are fitted.
void intervals(const Options& options) {
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  double squares = 0.0;
  int held = 0;
  int count = 0;
  for (int k = 0; k < options.drives; ++k) {
    const std::vector<Effect> hidden{catalogue_effect("yaw offset", {0.03 * normal(random)}),
                                     catalogue_effect("wheelbase", {0.01 * normal(random)})};
    Model model;
    for (Effect one : hidden) {
      one.coefficients.clear();
      model.effects.push_back(std::move(one));
    }
    const ModelFit fit = fit_model({marked_drive(k, options.seed, hidden)}, model);
    const double ratio = fit.chi2 / fit.dof;
    sum += ratio;
    squares += ratio * ratio;
    for (std::size_t e = 0; e < hidden.size(); ++e) {
      const double off =
          fit.effects[e].effect.coefficients.front() - hidden[e].coefficients.front();
      held += std::abs(off) < 1.96 * fit.effects[e].sd.front() ? 1 : 0;
      ++count;
    }
  }
  const double mean = sum / options.drives;
  const double variance = squares / options.drives - mean * mean;
  fmt::print("chi^2/dof {:.4f} +- {:.4f}, 95 % intervals hold the truth in {:.1f} % of {}\n", mean,
             std::sqrt(variance / options.drives), 100.0 * held / count, count);
}

/// Drives in which nothing is missing.
void alarms(const Options& options) {
  int wrong = 0;
  for (int k = 0; k < options.drives; ++k) {
    const Diagnosis found = diagnose({marked_drive(k, options.seed, {})}, Model{});
    if (found.verdict != Diagnosis::Verdict::missing) continue;
    ++wrong;
    fmt::print(stderr, "  drive {}: {}\n", k, found.findings.front().effect.name);
  }
  fmt::print("without effect: {} of {} drives miss something\n", wrong, options.drives);
}

bool is_named(const Finding& finding, const std::string& name) {
  return finding.effect.name == name ||
         std::any_of(finding.look_alikes.begin(), finding.look_alikes.end(),
                     [&name](const LookAlike& rival) { return rival.effect.name == name; });
}

/// Drives with three times what is just seen of a yaw offset, to either side.
void identify(const Options& options) {
  const std::string name = "yaw offset";
  int named = 0;
  int tried = 0;
  int alike = 0;
  double size = 0.0;
  for (int k = 0; k < options.drives; ++k) {
    const Diagnosis none = diagnose({marked_drive(k, options.seed, {})}, Model{});
    const auto seen = std::find_if(none.findings.begin(), none.findings.end(),
                                   [&](const Finding& one) { return one.effect.name == name; });
    if (seen == none.findings.end()) continue;
    ++tried;
    const double g = (k % 8 < 4 ? 3.0 : -3.0) * seen->minimal_detectable.front();
    size += std::abs(g);
    const Diagnosis found =
        diagnose({marked_drive(k, options.seed, {catalogue_effect(name, {g})})}, Model{});
    const bool missing = found.verdict == Diagnosis::Verdict::missing;
    const bool right = missing && is_named(found.findings.front(), name);
    named += right ? 1 : 0;
    if (right && found.findings.front().effect.name != name) ++alike;
    if (!right && !found.findings.empty()) {
      fmt::print(stderr, "  drive {}: {} instead\n", k, found.findings.front().effect.name);
    }
  }
  fmt::print(
      "yaw offset of {:.4f} rad (mean): named first in {} of {}, {} of these by a "
      "look-alike\n",
      size / std::max(1, tried), named, tried, alike);
}

}  // namespace
}  // namespace trussmap

int main(int argc, char** argv) {
  using trussmap::Options;
  using trussmap::bench::Part;
  return trussmap::bench::run_bench<Options>(
      argc, argv, "Drives among landmarks with an axis",
      {Part<Options>{"intervals", trussmap::intervals}, Part<Options>{"alarms", trussmap::alarms},
       Part<Options>{"identify", trussmap::identify}},
      [](CLI::App& app, Options& options) {
        app.add_option("--drives", options.drives, "How many")
            ->capture_default_str()
            ->check(CLI::Range(2, 1000000));
        app.add_option("--seed", options.seed, "Of the first drive")->capture_default_str();
      });
}
