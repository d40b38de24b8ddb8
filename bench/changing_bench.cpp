// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A coefficient that changes while driving: is it recognised, is its form told, and does its course
// lie within its band?
//
//   constant   the effect is the same all the time
//   step       it jumps at a moment between 1/4 and 3/4 of the drive
//   walk       it walks at random (twelve terms of Karhunen and Loeve)
//
// The model has the effect, whose mean size is 3 times the smallest detectable; so is the change:
// the chi^2 that a constant leaves of it is 9 x 24.4. Steps and walks are simulated anew each.
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "criticism/coefficient_course.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace criticism;
namespace {

struct Options {
  std::uint64_t first = 1;
  int count = 60;
  double times = 3.0;
  bool verbose = false;
};

constexpr int kTerms = 12;

/// What is added to the coefficient over the drive: sum of amplitude_k f_k(t).
struct Change {
  std::vector<std::string> shapes;
  std::vector<double> amplitudes;
  std::function<double(double)> at;  ///< t, before scaling
};

Change step_at(double t) {
  return {{fmt::format("(t>{})", t)}, {1.0}, [t](double at) { return at > t ? 1.0 : 0.0; }};
}

Change walk_over(double duration, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Change change;
  std::vector<double> rates;
  for (int k = 0; k < kTerms; ++k) {
    rates.push_back((k + 0.5) * std::numbers::pi / duration);
    change.shapes.push_back(fmt::format("sin({}*t)", rates.back()));
    change.amplitudes.push_back(normal(random) / (k + 0.5));
  }
  change.at = [rates, amplitudes = change.amplitudes](double t) {
    double sum = 0.0;
    for (std::size_t k = 0; k < rates.size(); ++k) sum += amplitudes[k] * std::sin(rates[k] * t);
    return sum;
  };
  return change;
}

/// The true change of each part, at its middle.
Eigen::VectorXd over_parts(const Change& change, const std::vector<DrivePart>& parts) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(parts.size()));
  for (std::size_t k = 0; k < parts.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] = change.at(0.5 * (parts[k].from + parts[k].until));
  }
  return values;
}

struct Tally {
  int worlds = 0;
  int named = 0;
  int form = 0;
  double within = 0.0;  ///< parts of those named
  double parts = 0.0;
  int other_verdict = 0;
  double seconds = 0.0;
};

void try_world(std::uint64_t seed, const std::string& form, const Options& options, Tally& tally) {
  const World world = draw_world(seed);
  std::vector<Subject> possible;
  for (const Subject& one : subjects(world)) {
    if (one.effect.shape.size() == 1 && shows(world, one)) possible.push_back(one);
  }
  if (possible.empty()) return;
  std::mt19937_64 random(seed * 7919 + 17);
  const Subject subject =
      possible[std::uniform_int_distribution<std::size_t>(0, possible.size() - 1)(random)];
  const ModelFit clean = fit_model({record_in(world, {})}, world.model);
  const ScoreTest tests(*clean.state);
  Effect effect = subject.effect;
  effect.coefficients = sized(subject, world, tests, 3.0, seed);
  if (effect.coefficients.empty()) return;
  Model model = world.model;
  model.effects = {subject.effect};
  const DrivenRecording constant = record_in(world, {effect});
  std::optional<ModelFit> fit;
  try {
    fit = fit_model({constant}, model);
  } catch (const std::exception&) {
    return;
  }
  const auto course = course_of(0, *fit->state, ScoreTest(*fit->state));
  if (!course) return;
  const double duration = constant.drive.t.back() - constant.drive.t.front();
  std::vector<Effect> truth{effect};
  Change change;
  double scale = 0.0;
  if (form != "constant") {
    change = form == "step"
                 ? step_at(constant.drive.t.front() +
                           duration * std::uniform_real_distribution<double>(0.25, 0.75)(random))
                 : walk_over(duration, random);
    const Eigen::VectorXd d = over_parts(change, course->parts);
    const double shown = d.dot(about_constant(*course).G * d);
    if (!(shown > 0.0)) return;
    scale = options.times * std::sqrt(kDetectableScore / shown);
    Effect moving = effect;
    moving.name = "change";
    moving.shape.clear();
    moving.coefficients.clear();
    for (std::size_t k = 0; k < change.shapes.size(); ++k) {
      moving.shape.emplace_back("(" + effect.shape.front().text() + ")*" + change.shapes[k]);
      moving.coefficients.push_back(scale * change.amplitudes[k]);
    }
    truth.push_back(std::move(moving));
  }
  const std::vector<DrivenRecording> recordings{record_in(world, truth)};
  const std::clock_t begun = std::clock();
  const Diagnosis result = diagnose(recordings, model);
  tally.seconds += static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  ++tally.worlds;
  const auto found =
      std::find_if(result.changing.begin(), result.changing.end(),
                   [&](const ChangingCoefficient& one) { return one.effect.name == effect.name; });
  const bool named = found != result.changing.end();
  tally.named += named ? 1 : 0;
  std::string told;
  if (named) {
    const bool steps = found->form == ChangingCoefficient::Form::step;
    tally.form += steps == (form == "step") ? 1 : 0;
    for (const CoursePart& part : found->course) {
      const double true_value =
          effect.coefficients.front() +
          (change.at ? scale * change.at(0.5 * (part.from + part.until)) : 0.0);
      tally.parts += 1.0;
      tally.within += std::abs(part.value - true_value) < 1.96 * part.sd ? 1.0 : 0.0;
    }
    told = fmt::format("{}, p {:.1e}", steps ? "step" : "walk", found->p_value);
  }
  if (options.verbose) {
    std::string missing;
    for (const Finding* one : found_by(result)) missing += " " + one->effect.name + ";";
    fmt::print("  {} world {} {} ({} legs): {}; chi2/dof {:.2f}; missing:{}; noise {}\n", form,
               seed, effect.name, world.walk.size() - 1, named ? told : "not named",
               result.chi2 / result.dof, missing,
               result.under && result.under->noise.changed() ? "changed" : "as stated");
  }
}

void run(const std::string& form, const Options& options) {
  Tally tally;
  for (std::uint64_t seed = options.first;
       tally.worlds < options.count &&
       seed < options.first + 10U * static_cast<std::uint64_t>(options.count);
       ++seed) {
    try_world(seed, form, options, tally);
  }
  fmt::print("{}: change named in {} of {} ({:.1f} %)", form, tally.named, tally.worlds,
             percent(tally.named, tally.worlds));
  if (form != "constant" && tally.named > 0) {
    fmt::print(", its form right in {}, course within its 95 % band at {:.1f} % of parts",
               tally.form, 100.0 * tally.within / tally.parts);
  }
  fmt::print("; {:.2f} s a diagnosis\n", tally.seconds / std::max(1, tally.worlds));
}

void constant(const Options& options) {
  run("constant", options);
}
void step(const Options& options) {
  run("step", options);
}
void walk(const Options& options) {
  run("walk", options);
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--first", options.first, "First seed")->capture_default_str();
  app.add_option("--count", options.count, "Worlds of each part")->capture_default_str();
  app.add_option("--times", options.times, "Size of a change, in smallest detectable ones")
      ->capture_default_str();
  app.add_flag("--verbose", options.verbose, "Tell of each world");
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  return run_bench<Options>(argc, argv, "Coefficients that change while driving",
                            {{"constant", constant}, {"step", step}, {"walk", walk}}, add_options);
}
