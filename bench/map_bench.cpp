// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How good the maps of `build` are where its assumptions are broken: robots whose wheels, wheelbase
// and compass are not what their model says, and sightings with a wrong name.
//
//   world --simulate_drive, some labels exchanged--> recording --build_map--> map, by every method
//           |                                                                     | rms error,
//           '-- the true model, the right sightings only --> the best that could be | ratio to it
//
// A line per world in a CSV file, and a summary beside the bounds that are aimed at.
#include "broken_world.hpp"
#include "trussmap/build_map.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace trussmap::bench {
namespace {

struct Outcome {
  double error = HUGE_VAL;
  double reckoned = HUGE_VAL;
  double seconds = 0.0;
  int wrong_out = 0;
  int right_out = 0;
  bool good = false;
  double expected = 0.0;
  std::string said;
};

Outcome build(const BrokenWorld& world, const Recording& recording, const Model& model,
              Method method, bool gated) {
  Outcome result;
  BuildMapOptions how;
  how.method = method;
  if (!gated) how.gate = HUGE_VAL;
  const auto before = std::clock();
  try {
    const BuiltMap built = build_map({recording}, model, how);
    result.error = error_of(positions_of(built.map), world.mesh);
    result.reckoned = error_of(built.dead_reckoned, world.mesh);
    for (const RejectedSighting& one : built.rejected) {
      ++(world.wrong.contains({one.t, one.landmark}) ? result.wrong_out : result.right_out);
    }
    result.good = built.good();
    result.expected = built.quality.median_sd;
    for (const std::string& text : built.warnings) result.said += text + " | ";
  } catch (const std::exception& error) {
    result.said = error.what();
  }
  result.seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  return result;
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap;
  using namespace trussmap::bench;
  CLI::App app("Maps of worlds whose assumptions are broken");
  int from = 0;
  int count = 100;
  std::string out = "map_bench.csv";
  std::vector<std::string> methods{"adjustment"};
  BrokenWorldOptions worlds;
  app.add_option("--from", from);
  app.add_option("--count", count);
  app.add_option("--out", out);
  app.add_option("--methods", methods);
  app.add_flag("--clean", worlds.clean);
  CLI11_PARSE(app, argc, argv);
  const std::map<std::string, Method> by_name{{"adjustment", Method::adjustment},
                                              {"elastic", Method::elastic},
                                              {"elastic_printed", Method::elastic_printed},
                                              {"gauss_markov", Method::gauss_markov}};
  std::FILE* file = std::fopen(out.c_str(), "w");
  fmt::print(file,
             "seed,method,best,error,reckoned,seconds,sightings,wrong,wrong_out,right_out,good,"
             "expected,what,said\n");
  for (int k = from; k < from + count; ++k) {
    const BrokenWorld world = draw_broken_world(static_cast<std::uint64_t>(k), worlds);
    const Outcome best = build(world, world.right, world.true_model, Method::adjustment, false);
    for (const std::string& name : methods) {
      const Outcome one = build(world, world.recording, world.nominal, by_name.at(name), true);
      fmt::print(file, "{},{},{:.4f},{:.4f},{:.4f},{:.2f},{},{},{},{},{:d},{:.4f},{},\"{}\"\n", k,
                 name, best.error, one.error, one.reckoned, one.seconds,
                 world.recording.sightings.size(), world.wrong.size(), one.wrong_out, one.right_out,
                 one.good, one.expected, world.what, one.said);
      std::fflush(file);
    }
  }
  std::fclose(file);
  return 0;
}
