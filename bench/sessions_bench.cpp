// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a further session costs a fit that keeps the sessions before as summaries, beside the fit of
// all at once; and how far its result is from the least squares solution, and from that fit.
//
//   world, a tour a day --simulate_drive--> days 1 ... N --SummarisedFit::add--> map
//                                                  day N + 1 --add--> its processor time
//                                            days 1 ... N + 1 --fit_model--> its processor time
#include "trussmap/catalogue.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace trussmap;

struct Options {
  int days = 100;
  int further = 1;
  int side = 6;
  int tours = 1;
  std::uint64_t seed = 1;
  double tolerance = 1e-8;
  bool no_compass = false;
  bool survey = false;
  bool gyro = false;
  bool range = false;
  std::vector<std::string> effects;
};

double processor_seconds(const auto& work) {
  const std::clock_t before = std::clock();
  work();
  return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
}

std::vector<DrivenRecording> days_of(const Options& options, int count) {
  const Mesh mesh = even_mesh({options.side, options.side}, 5.0);
  WheeledRobot robot;
  robot.compass = !options.no_compass;
  robot.gyro = options.gyro;
  robot.range_sensor = options.range;
  std::vector<DrivenRecording> days;
  for (int day = 0; day < count; ++day) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(day);
    std::mt19937_64 random = random_stream(seed, Stream::walk);
    const Tours tours = make_tours(mesh, WalkKind::euler, options.tours, random);
    days.push_back(
        with_wheels(simulate_drive(mesh, tours.walk, {}, robot, seed).recording, Robot()));
    days.back().name = fmt::format("day {}", day + 1);
    if (!options.survey) days.back().survey.clear();
  }
  return days;
}

double largest_difference(const SummarisedFit& fit, const ModelFit& all) {
  double largest = 0.0;
  const std::vector<FittedLandmark> own = fit.landmarks();
  for (const FittedLandmark& one : all.landmarks) {
    const auto same = std::find_if(own.begin(), own.end(), [&](const FittedLandmark& other) {
      return other.name == one.name;
    });
    largest = std::max(largest, (one.position - same->position).norm());
  }
  return largest;
}

double median_sd(const SummarisedFit& fit) {
  std::vector<double> sds;
  for (const FittedLandmark& one : fit.landmarks()) {
    sds.push_back(std::sqrt(one.covariance.trace()));
  }
  std::nth_element(sds.begin(), sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2),
                   sds.end());
  return sds[sds.size() / 2];
}

void run(const Options& options) {
  const std::vector<DrivenRecording> days = days_of(options, options.days + options.further);
  Model model;
  for (const std::string& name : options.effects) {
    model.effects.push_back(catalogue_effect(name));
  }
  SummarisedFitOptions how;
  how.tolerance = options.tolerance;
  SummarisedFit fit(model, how);
  double before = 0.0;
  int anew = 0;
  for (int day = 0; day < options.days; ++day) {
    before += processor_seconds([&] { fit.add(days[static_cast<std::size_t>(day)]); });
    anew += fit.relinearised();
    if ((day + 1) % 10 == 0) {
      fmt::print("{:>4} days: {:.2f} s in all, {} sessions taken anew\n", day + 1, before, anew);
    }
  }
  double most = 0.0;
  double sum = 0.0;
  for (std::size_t day = static_cast<std::size_t>(options.days); day < days.size(); ++day) {
    const double seconds = processor_seconds([&] { fit.add(days[day]); });
    fmt::print("day {}: {:.1f} ms, {} of {} sessions taken anew\n", day + 1, 1e3 * seconds,
               fit.relinearised(), fit.sessions() - 1);
    most = std::max(most, seconds);
    sum += seconds;
  }
  fmt::print("{} landmarks, chi2 {:.1f} for {} degrees of freedom, median sd {:.2f} mm\n",
             fit.landmarks().size(), fit.chi2(), fit.dof(), 1e3 * median_sd(fit));
  fmt::print("from the least squares solution: {:.1e} m\n", fit.exact_error());
  ModelFit all;
  const double at_once = processor_seconds([&] { all = fit_model(days, model); });
  fmt::print("all {} days at once: {:.2f} s; a day added: {:.2f} % of it (largest {:.2f} %)\n",
             days.size(), at_once, 100.0 * sum / options.further / at_once, 100.0 * most / at_once);
  if (options.no_compass && !options.survey) return;  // its frame is another
  fmt::print("from the fit of all, whose rows are laid on its own map: {:.1e} m\n",
             largest_difference(fit, all));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    CLI::App app("A further session beside many, and all at once");
    Options options;
    app.add_option("--days", options.days, "Sessions before")->capture_default_str();
    app.add_option("--further", options.further, "Sessions added, and timed")
        ->capture_default_str();
    app.add_option("--side", options.side, "Landmarks along a side of the mesh, 5 m apart")
        ->capture_default_str();
    app.add_option("--tours", options.tours, "A day's tours")->capture_default_str();
    app.add_option("--seed", options.seed)->capture_default_str();
    app.add_option("--tolerance", options.tolerance, "m")->capture_default_str();
    app.add_option("--effects", options.effects, "Effects of the catalogue that are fitted");
    app.add_flag("--no-compass", options.no_compass);
    app.add_flag("--survey", options.survey);
    app.add_flag("--gyro", options.gyro);
    app.add_flag("--range", options.range, "A range sensor");
    CLI11_PARSE(app, argc, argv);
    run(options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
