// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Many drives on other wheels than two, with the noise that the model states and each of the
// drive's constants off by a random amount: is chi^2 per degree of freedom 1, and do intervals hold
// the truth?
#include "bench_program.hpp"
#include "other_drives.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

struct Count {
  double ratio = 0.0;
  double ratio_squares = 0.0;
  int held = 0;
  int intervals = 0;
};

/// The drive's noise, and its recording with g of this channel.
DrivenRecording drawn(testing::OtherDrive& drive, Channel channel, double g,
                      std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Noise& noise = drive.model.noise;
  noise.left = noise.right = 0.004;
  noise.steer = 0.003;
  DrivenRecording recording = with_wheels(
      recorded(drive, noisy(drive, with_effect(drive, channel, g), random)), drive.model.robot);
  for (TruthRow& row : recording.truth) {
    row.x += noise.truth * normal(random);
    row.y += noise.truth * normal(random);
    row.heading += noise.truth_heading * normal(random);
  }
  return recording;
}

/// One drive with one constant off.
void take(testing::OtherDrive drive, Channel channel, std::mt19937_64& random, Count& count) {
  const double g = 0.01 * std::normal_distribution<double>()(random);
  const DrivenRecording recording = drawn(drive, channel, g, random);
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

struct Hidden {
  DriveKind drive;
  const char* name;  ///< of the catalogue
};

constexpr Hidden kHidden[] = {
    {DriveKind::tricycle, "steering offset"}, {DriveKind::tricycle, "wheel scale"},
    {DriveKind::omni3, "radius of wheel 1"},  {DriveKind::omni3, "radius of wheel 3"},
    {DriveKind::skid_steer, "wheelbase"},     {DriveKind::skid_steer, "wheel scale"},
    {DriveKind::ackermann, "wheelbase"},      {DriveKind::ackermann, "wheel scale"},
    {DriveKind::mecanum, "roller slip"},      {DriveKind::mecanum, "radius of wheel 1"},
    {DriveKind::wheels, "radius of wheel 2"}, {DriveKind::wheels, "radius of wheel 3"}};

bool is_named(const Finding& finding, const std::string& name) {
  if (finding.effect.name == name) return true;
  return std::any_of(finding.look_alikes.begin(), finding.look_alikes.end(),
                     [&name](const LookAlike& rival) { return rival.effect.name == name; });
}

/// Of drives with three times what is just seen of an effect, and of drives with none.
void identify(int drives, std::uint64_t seed) {
  std::map<DriveKind, std::pair<int, int>> alarms;  // of so many
  fmt::print("{:<12} {:<20} {:>8}  named first, or as looking the same\n", "drive", "effect", "g");
  for (const Hidden& hidden : kHidden) {
    std::mt19937_64 random(seed);
    const Channel channel = catalogue_effect(hidden.name).channel;
    int named = 0;
    int tried = 0;
    double size = 0.0;
    for (int k = 0; k < drives; ++k) {
      testing::OtherDrive drive = testing::other_drive(hidden.drive);
      const Diagnosis none = diagnose({drawn(drive, channel, 0.0, random)}, drive.model);
      auto& [wrong, all] = alarms[hidden.drive];
      wrong += none.verdict == Diagnosis::Verdict::missing ? 1 : 0;
      ++all;
      const auto seen =
          std::find_if(none.findings.begin(), none.findings.end(),
                       [&hidden](const Finding& one) { return one.effect.name == hidden.name; });
      if (seen == none.findings.end()) continue;
      ++tried;
      size = 3.0 * seen->minimal_detectable.front();
      const Diagnosis found = diagnose({drawn(drive, channel, size, random)}, drive.model);
      const bool right = found.verdict == Diagnosis::Verdict::missing &&
                         is_named(found.findings.front(), hidden.name);
      named += right ? 1 : 0;
      if (!right && !found.findings.empty()) {
        fmt::print(stderr, "  {}: {} instead\n", hidden.name, found.findings.front().effect.name);
      }
    }
    fmt::print("{:<12} {:<20} {:>8.4f}  {} of {}\n", name_of(hidden.drive), hidden.name, size,
               named, tried);
  }
  for (const auto& [drive, counts] : alarms) {
    fmt::print("{:<12} without effect: {} of {} drives miss something\n", name_of(drive),
               counts.first, counts.second);
  }
}

}  // namespace
}  // namespace trussmap

int main(int argc, char** argv) {
  struct Options {
    int drives = 500;
    std::uint64_t seed = 1;
  };
  using trussmap::bench::Part;
  return trussmap::bench::run_bench<Options>(
      argc, argv, "Drives on other wheels than two",
      {Part<Options>{"intervals",
                     [](const Options& options) { trussmap::run(options.drives, options.seed); }},
       Part<Options>{
           "identify",
           [](const Options& options) { trussmap::identify(options.drives, options.seed); }}},
      [](CLI::App& app, Options& options) {
        app.add_option("--drives", options.drives, "Of each kind, or of each effect")
            ->capture_default_str()
            ->check(CLI::Range(2, 1000000));
        app.add_option("--seed", options.seed, "Of the random numbers")->capture_default_str();
      });
}
