// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Many drives on other wheels than two, with the noise that the model states and each of the
// drive's constants off by a random amount: is chi^2 per degree of freedom 1, and do intervals hold
// the truth?
#include "other_drives.hpp"
#include "trussmap/fit_model.hpp"

#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace trussmap {
namespace {

struct Count {
  double ratio = 0.0;
  double ratio_squares = 0.0;
  int held = 0;
  int intervals = 0;
};

/// One drive with one constant off.
void take(testing::OtherDrive drive, Channel channel, std::mt19937_64& random, Count& count) {
  std::normal_distribution<double> normal;
  Noise& noise = drive.model.noise;
  noise.left = noise.right = 0.004;
  noise.steer = 0.003;
  const double g = 0.01 * normal(random);
  Recording recording = with_wheels(
      recorded(drive, noisy(drive, with_effect(drive, channel, g), random)), drive.model.robot);
  for (TruthRow& row : recording.truth) {
    row.x += noise.truth * normal(random);
    row.y += noise.truth * normal(random);
    row.heading += noise.truth_heading * normal(random);
  }
  drive.model.effects.push_back({"hidden", channel, {"1"}, {}, false});
  const ModelFit fit = fit_model({recording}, drive.model);
  const double ratio = fit.chi2 / fit.dof;
  count.ratio += ratio;
  count.ratio_squares += ratio * ratio;
  const double found = fit.model.effects.front().coefficients.front();
  if (std::abs(found - g) < 1.96 * fit.effects.front().sd.front()) ++count.held;
  ++count.intervals;
}

void run(int drives, std::uint64_t seed) {
  fmt::print("{:<12} {:>6}  {:<18} {}\n", "drive", "drives", "chi^2/dof", "95 % intervals hold");
  for (const DriveKind kind : {DriveKind::skid_steer, DriveKind::tricycle, DriveKind::ackermann,
                               DriveKind::omni3, DriveKind::mecanum, DriveKind::wheels}) {
    std::mt19937_64 random(seed);
    const testing::OtherDrive drive = testing::other_drive(kind);
    Count count;
    for (int k = 0; k < drives; ++k) {
      take(drive, drive.constants[static_cast<std::size_t>(k) % drive.constants.size()], random,
           count);
    }
    const double mean = count.ratio / drives;
    const double variance = count.ratio_squares / drives - mean * mean;
    fmt::print("{:<12} {:>6}  {:.4f} +- {:.4f}   {:.1f} %\n", name_of(kind), drives, mean,
               std::sqrt(variance / drives), 100.0 * count.held / count.intervals);
  }
}

}  // namespace
}  // namespace trussmap

int main(int argc, char** argv) {
  CLI::App app("Drives on other wheels than two: chi^2 per degree of freedom, and intervals");
  int drives = 500;
  std::uint64_t seed = 1;
  app.add_option("--drives", drives, "Of each kind")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000000));
  app.add_option("--seed", seed, "Of the random numbers")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  trussmap::run(drives, seed);
  return 0;
}
