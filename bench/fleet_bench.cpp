// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fleets of which everything is known: is what they have named, and nothing else?
//
//   tyres A, B, C   a third of the robots each; floor and software are dealt out at random
//   common          wheel diameter ratio, in all
//   batch           wheelbase, on tyres B alone
//   outliers        travel scale, in five robots
//   drift           one robot's wheel diameter ratio, from day to day
#include "trussmap/catalogue.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace trussmap::bench {
namespace {

struct Options {
  int fleets = 5;
  int first = 1;
  int robots = 300;
  int days = 3;
  int tours = 2;
  std::string stores;
};

constexpr double kCommon = 0.002;
constexpr double kBatch = 0.012;
constexpr double kOutlier = 0.006;
constexpr double kDriftPerDay = 0.0002;
constexpr double kSpacing = 3.0;  // m
constexpr int kBetweenDays = 10;
constexpr std::size_t kOutliers = 5;

struct Truth {
  std::set<std::string> outliers;
  std::string drifting;
};

std::string robot_name(int robot) {
  return fmt::format("R{:03}", robot);
}

Truth draw_truth(std::mt19937_64& random, int robots) {
  Truth truth;
  while (truth.outliers.size() < kOutliers) {
    truth.outliers.insert(robot_name(static_cast<int>(random() % static_cast<unsigned>(robots))));
  }
  do {
    truth.drifting = robot_name(static_cast<int>(random() % static_cast<unsigned>(robots)));
  } while (truth.outliers.contains(truth.drifting));
  return truth;
}

std::vector<FleetRow> drive_fleet(const Options& options, std::uint64_t seed,
                                  std::mt19937_64& random, const Truth& truth) {
  Model model;
  const std::string text = format_model(model);
  const Mesh mesh = even_mesh({3, 3}, kSpacing);
  std::vector<FleetRow> rows;
  for (int robot = 0; robot < options.robots; ++robot) {
    const std::string name = robot_name(robot);
    const std::string tyre(1, "ABC"[robot % 3]);
    const std::string floor = random() % 2 == 0 ? "hall 1" : "hall 2";
    const std::string software = random() % 2 == 0 ? "4.1" : "4.2";
    const double sign = random() % 2 == 0 ? 1.0 : -1.0;
    for (int day = 0; day < options.days; ++day) {
      const double drift = name == truth.drifting ? kDriftPerDay * kBetweenDays * day : 0.0;
      SimulatedEffects effects;
      effects.effects.push_back(catalogue_effect("wheel diameter ratio", {kCommon + drift}));
      if (tyre == "B") effects.effects.push_back(catalogue_effect("wheelbase", {kBatch}));
      if (truth.outliers.contains(name)) {
        effects.effects.push_back(catalogue_effect("travel scale", {sign * kOutlier}));
      }
      const std::uint64_t own = seed * 1000000U + static_cast<std::uint64_t>(robot * 10 + day);
      std::mt19937_64 walk_random = random_stream(own, Stream::walk);
      const Tours tours = make_tours(mesh, WalkKind::euler, options.tours, walk_random);
      const SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, {}, own, effects);
      FleetRow row = fleet_row(name, fmt::format("2026-03-{:02}", 1 + kBetweenDays * day),
                               {with_wheels(drive.recording, model.robot)}, model, text);
      row.metadata = {{"tyre batch", tyre}, {"floor", floor}, {"software", software}};
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

/// Driven, or read where its store is there.
std::vector<FleetRow> rows_of(const Options& options, std::uint64_t seed, Truth& truth) {
  std::mt19937_64 random(seed);
  truth = draw_truth(random, options.robots);
  const std::string store =
      options.stores.empty() ? std::string() : fmt::format("{}{}.db", options.stores, seed);
  if (!store.empty() && std::filesystem::exists(store)) return read_fleet(store);
  std::vector<FleetRow> rows = drive_fleet(options, seed, random, truth);
  if (!store.empty()) {
    for (const FleetRow& row : rows) add_to_fleet(store, row);
  }
  return rows;
}

/// What is said of a fleet, a claim a line.
std::set<std::string> claims_of(const FleetReport& report) {
  std::set<std::string> claims;
  for (const FleetFinding& finding : report.findings) {
    bool any = false;
    const auto claim = [&](const std::string& text) {
      claims.insert(fmt::format("{}: {}", finding.effect, text));
      any = true;
    };
    for (const FleetCoefficient& one : finding.coefficients) {
      if (one.common) claim("common");
      for (const FleetKey& key : one.goes_with) {
        for (const FleetGroup& group : key.groups) {
          if (!one.common && group.p_value < report.level) {
            claim(fmt::format("{} {}", key.key, group.value));
          }
        }
        if (one.common) claim(fmt::format("differs by {}", key.key));
      }
      if (one.all_drift) claim("all drift");
      if (one.p_tau < report.level) claim("robots scatter");
      for (const FleetRobot& robot : one.members) {
        if (robot.differs) claim(fmt::format("{} differs", robot.robot));
        if (robot.drifts) claim(fmt::format("{} drifts", robot.robot));
      }
    }
    if (!any) claim("found, but nothing is said of it");
  }
  return claims;
}

std::set<std::string> expected_of(const Truth& truth) {
  std::set<std::string> claims{"wheel diameter ratio: common", "wheelbase: tyre batch B",
                               fmt::format("wheel diameter ratio: {} drifts", truth.drifting)};
  for (const std::string& robot : truth.outliers) {
    claims.insert(fmt::format("travel scale: {} differs", robot));
  }
  return claims;
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void run(const Options& options) {
  int right = 0;
  for (int k = 0; k < options.fleets; ++k) {
    const auto seed = static_cast<std::uint64_t>(options.first + k);
    const double start = processor_seconds();
    Truth truth;
    const std::vector<FleetRow> rows = rows_of(options, seed, truth);
    const double driven = processor_seconds();
    const FleetReport report = fleet_report(rows);
    const double done = processor_seconds();
    const std::set<std::string> said = claims_of(report);
    const std::set<std::string> expected = expected_of(truth);
    right += said == expected ? 1 : 0;
    fmt::print("fleet {}: {} robots, {} days, rows in {:.0f} s, report in {:.1f} s: {}\n", seed,
               report.robots, report.days, driven - start, done - driven,
               said == expected ? "all named, nothing else" : "differs");
    for (const std::string& one : expected) {
      if (!said.contains(one)) fmt::print("  not named   {}\n", one);
    }
    for (const std::string& one : said) {
      if (!expected.contains(one)) fmt::print("  not there   {}\n", one);
    }
    for (const FleetFinding& one : report.findings) {
      for (const FleetLookAlike& rival : one.look_alikes) {
        fmt::print("  {} looks like {} ({:.3f})\n", one.effect, rival.effect, rival.cosine);
      }
    }
    std::fflush(stdout);
  }
  fmt::print("{} of {} fleets right\n", right, options.fleets);
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) try {
  trussmap::bench::Options options;
  CLI::App app{"Fleets of simulated robots: what is named of what they have",
               "trussmap_fleet_bench"};
  app.add_option("--fleets", options.fleets, "How many")->capture_default_str();
  app.add_option("--first", options.first, "Seed of the first")->capture_default_str();
  app.add_option("--robots", options.robots, "Robots of each")->capture_default_str();
  app.add_option("--days", options.days, "Days of each robot")->capture_default_str();
  app.add_option("--tours", options.tours, "Tours of a day")->capture_default_str();
  app.add_option("--stores", options.stores,
                 "Keep each fleet as NAME, its seed, .db; one that is there is read, not driven");
  CLI11_PARSE(app, argc, argv);
  trussmap::bench::run(options);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "trussmap_fleet_bench: %s\n", error.what());
  return 1;
}
