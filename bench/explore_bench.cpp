// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What exploring is worth: the map of a robot that does not know its world (apps/explore), beside
// that of the same robot after three Euler tours of the same length, for which it would have to
// know it (explore_trial.hpp). Medians over worlds of 5 x 5 to 9 x 9 landmarks.
#include "explore_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace trussmap::bench {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

void print_group(const std::string& name, const std::vector<ExploreTrial>& trials) {
  std::vector<double> ratios;
  std::vector<double> earlier;
  std::vector<double> reached;
  int missing = 0;
  double logarithms = 0.0;
  for (const ExploreTrial& one : trials) {
    missing += one.landmarks - one.found;
    ratios.push_back(one.explored / one.euler);
    earlier.push_back(one.earlier / one.euler);
    reached.push_back(one.reached);
    logarithms += std::log(one.explored / one.euler);
  }
  fmt::print("  {:12} {:6} {:9} {:9.3f} {:10.3f} {:9.3f} {:9.3f}\n", name, trials.size(), missing,
             median(ratios), std::exp(logarithms / static_cast<double>(trials.size())),
             median(earlier), median(reached));
}

void measure(std::uint64_t from, std::uint64_t count, const MapBuilderOptions& how,
             const std::string& out) {
  std::map<std::string, std::vector<ExploreTrial>> groups;
  std::FILE* file = out.empty() ? nullptr : std::fopen(out.c_str(), "w");
  if (file != nullptr) {
    fmt::print(file, "seed,columns,rows,uneven,compass,wheels,walls,way,euler,explored,reached\n");
  }
  for (std::uint64_t seed = from; seed < from + count; ++seed) {
    const explore::WorldOptions world = drawn_world(seed);
    const ExploreTrial one = explore_trial(world, how);
    if (file != nullptr) {
      fmt::print(file, "{},{},{},{:d},{:d},{},{},{:.0f},{:.4f},{:.4f},{:.3f}\n", seed,
                 world.size.columns, world.size.rows, world.uneven, world.compass, world.wheels,
                 world.walls, one.way, one.euler, one.explored, one.reached);
    }
    groups["all"].push_back(one);
    groups[world.compass ? "compass" : "no compass"].push_back(one);
    groups[world.walls > 0.0 ? "walls" : "no walls"].push_back(one);
    groups[world.uneven ? "uneven" : "even"].push_back(one);
    groups[world.wheels > 0.002 ? "k = 0.003" : "k = 0.001"].push_back(one);
  }
  if (file != nullptr) std::fclose(file);
  fmt::print("  errors of exploring over those of three Euler tours, medians\n");
  fmt::print("  worlds       number   missing  same way  geom. mean   80 % of  reached,\n");
  fmt::print("                      landmarks                       the way  of the way\n");
  for (const auto& [name, trials] : groups) print_group(name, trials);
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap;
  try {
    CLI::App app("What exploring is worth, beside three Euler tours");
    std::uint64_t from = 1;
    std::uint64_t count = 50;
    std::string out;
    bool gauss_markov = false;
    app.add_option("--from", from, "First seed");
    app.add_option("--count", count, "How many worlds")->check(CLI::PositiveNumber);
    app.add_option("--out", out, "A line per world (CSV)");
    app.add_flag("--gauss-markov", gauss_markov, "Maps by least squares in place of elastic ones");
    CLI11_PARSE(app, argc, argv);
    MapBuilderOptions how;
    if (gauss_markov) how.method = Method::gauss_markov;
    bench::measure(from, count, how, out);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
