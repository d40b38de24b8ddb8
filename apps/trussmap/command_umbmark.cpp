// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap umbmark: wheel diameters and wheelbase from squares driven both ways.
#include "commands.hpp"
#include "option_checks.hpp"
#include "results/common.hpp"
#include "results/experiments.hpp"
#include "results/json.hpp"
#include "tape_options.hpp"
#include "terminal.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;
struct UmbmarkOptions {
  std::vector<std::string> files;
  double side = 4.0;  // m
  std::string solution = "exact";
  std::string straight;
  std::vector<std::string> alone;
  int rounds = 1;
  std::optional<double> true_e_s;
  TapeOptions tape;
};

SquareMethod method_of(const UmbmarkOptions& options) {
  return options.solution == "exact" ? SquareMethod::exact : SquareMethod::formulas;
}

SquareRuns simulated_runs(const UmbmarkOptions& options, const TapeRobot& robot,
                          std::mt19937_64& random) {
  // Without scatter they would have no standard errors.
  const TapeOptions& tape = options.tape;
  const bool measures_headings =
      tape.scatter_heading > 0.0 || tape.true_k_left > 0.0 || tape.true_k_right > 0.0;
  SquareRuns runs;
  for (const auto& [sense, sample] :
       {std::pair(Direction::cw, &runs.cw), std::pair(Direction::ccw, &runs.ccw)}) {
    auto& headings = sense == Direction::cw ? runs.cw_headings : runs.ccw_headings;
    for (const Pose& end :
         drive_often(robot, square_path(options.side, sense), options.tape.runs, random)) {
      sample->push_back(end.position());
      if (measures_headings) headings.push_back(end.heading);
    }
  }
  return runs;
}

TapeRobot robot_of(const UmbmarkOptions& options, double wheelbase) {
  TapeRobot robot = simulated_robot(options.tape, wheelbase);
  robot.left_share *= options.true_e_s.value_or(1.0);
  robot.right_share *= options.true_e_s.value_or(1.0);
  return robot;
}

/// Three straight runs of 10 m, taped.
std::vector<StraightRun> simulated_straight(const TapeRobot& robot, std::uint64_t seed) {
  constexpr double kLength = 10.0;  // m
  constexpr int kRuns = 3;
  std::mt19937_64 random = random_stream(seed, Stream::path);
  std::vector<StraightRun> runs;
  for (const Pose& end : drive_often(robot, {{kLength, 0.0}}, kRuns, random)) {
    runs.push_back({std::hypot(kLength + end.x, end.y), kLength});
  }
  return runs;
}

double length_of(const std::string& text, const std::string& option) {
  const std::optional<double> value = finite_number(text);
  if (!value || !(*value > 0.0)) {
    throw UsageError("--straight " + option + ": \"" + text +
                     "\" is no length, expected MEASURED:REPORTED in metres, 10.032:10 for "
                     "instance, several separated by commas");
  }
  return *value;
}

std::vector<StraightRun> straight_runs(const std::string& text) {
  constexpr double kFarOff = 1.5;  // no wheel is that much larger than believed
  std::vector<StraightRun> runs;
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string one = text.substr(begin, comma - begin);
    const std::size_t colon = std::min(one.find(':'), one.size());
    const StraightRun run{length_of(one.substr(0, colon), text),
                          length_of(one.substr(std::min(colon + 1, one.size())), text)};
    if (run.measured > kFarOff * run.reported || run.reported > kFarOff * run.measured) {
      throw UsageError("--straight " + one +
                       ": the lengths differ by half and more, expected metres for both (is one in "
                       "centimetres, 100 times too long?)");
    }
    runs.push_back(run);
    begin = comma + 1;
  }
  return runs;
}

SquareRuns runs_of(const UmbmarkOptions& options, const std::optional<WallSensors>& walls,
                   const std::string& file) {
  const double longest = path_length(square_path(options.side, {}));
  return walls ? read_square_wall_runs(file, *walls, longest) : read_square_runs(file, longest);
}

std::vector<SquareRound> all_rounds(const UmbmarkOptions& options, const Model& model) {
  GeometryErrors in_force;
  try {
    in_force = geometry_errors(model);
  } catch (const std::invalid_argument& error) {
    throw UsageError((options.tape.model.empty() ? "umbmark" : options.tape.model) + ": " +
                     error.what());
  }
  const double wheelbase = model.robot.wheelbase;
  const SquareMethod method = method_of(options);
  if (!options.tape.simulate) {
    const std::optional<WallSensors> walls = wall_sensors(options.tape);
    return square_rounds(
        options.files.size(), options.side, wheelbase, in_force, method,
        [&](std::size_t round, const SquareSetup& /*setup*/, const GeometryErrors& /*in_force*/) {
          return runs_of(options, walls, options.files[round]);
        },
        straight_runs(options.straight));
  }
  const auto programmed = [&](const GeometryErrors& corrected, double believed) {
    return reprogrammed(robot_of(options, wheelbase), corrected.left_factor(),
                        corrected.right_factor(), believed);
  };
  std::vector<StraightRun> straight;
  if (options.true_e_s) {
    straight = simulated_straight(programmed(in_force, wheelbase * in_force.wheelbase_ratio),
                                  options.tape.seed);
  }
  std::mt19937_64 random = random_stream(options.tape.seed, Stream::wheels);
  return square_rounds(
      static_cast<std::size_t>(options.rounds), options.side, wheelbase, in_force, method,
      [&](std::size_t /*round*/, const SquareSetup& setup, const GeometryErrors& corrected) {
        return simulated_runs(options, programmed(corrected, setup.wheelbase), random);
      },
      straight);
}

/// By the robot as the last round found it.
std::vector<PathAlone> paths_alone(const UmbmarkOptions& options, const SquareRound& last) {
  std::vector<PathAlone> paths;
  for (const std::string& text : options.alone) {
    try {
      paths.push_back({text, tune_by_path(last.exact.errors(), last.setup, parse_path(text))});
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  }
  return paths;
}

Page page_of(const std::vector<SquareRound>& rounds, const UmbmarkOptions& options) {
  const SquareCorrections use = corrections_after(rounds.back(), method_of(options));
  const SquareCalibration shown{rounds,          options.side,     use.wheelbase,
                                use.left_factor, use.right_factor, all_doubts(rounds)};
  return square_page(shown,
                     options.tape.simulate ? "a simulated robot" : subject_of(options.files, ""));
}

/// RUNS.csv, RUNS_2.csv, RUNS_3.csv ...
fs::path round_file(const fs::path& first, std::size_t round) {
  if (round == 0) return first;
  return first.parent_path() /
         fmt::format("{}_{}{}", first.stem().string(), round + 1, first.extension().string());
}

void run_umbmark(const UmbmarkOptions& options) {
  const Model model = starting_model(options.tape);
  const std::vector<SquareRound> rounds = all_rounds(options, model);
  const std::vector<PathAlone> alone = paths_alone(options, rounds.back());
  const RobotConstants constants = robot_constants(model, rounds, method_of(options));
  Files files;
  if (!options.tape.out.empty()) {
    const SquareCorrections use = corrections_after(rounds.back(), method_of(options));
    files.emplace_back(options.tape.out, format_model(with_geometry(model, use.errors)));
  }
  if (!options.tape.json.empty()) {
    const results::SquareReport report{&rounds, method_of(options), &alone};
    files.emplace_back(
        options.tape.json,
        results::json_text(results::WithConstants<results::SquareReport>{report, &constants}));
  }
  if (!options.tape.page.plots.empty()) {
    std::vector<SquareRuns> runs;
    runs.reserve(rounds.size());
    for (const SquareRound& round : rounds) runs.push_back(round.runs);
    files.add_plot(options.tape.page.plots, "umbmark.svg", square_picture(runs, options.side));
  }
  if (!options.tape.page.html.empty()) {
    add_page(files, with_constants(page_of(rounds, options), constants),
             {options.tape.page.html, {}});
  }
  for (std::size_t k = 0; k < rounds.size() && !options.tape.write.empty(); ++k) {
    files.emplace_back(round_file(options.tape.write, k), format_square_runs(rounds[k].runs));
  }
  files.write();
  fmt::print("{}{}{}", square_text(rounds, method_of(options), style_of(stdout)),
             paths_alone_text(alone, style_of(stdout)),
             constants_text(constants, style_of(stdout)));
}

constexpr const char* kSquareFooter =
    "RUNS.csv has the columns direction,x,y and a row per run: direction is cw (turning right) or\n"
    "ccw (turning left); x and y [m] are where the robot was measured to stand after the square\n"
    "minus where its odometry had it, x along the first leg and y to its left. Two runs or more "
    "in\n"
    "each direction, five are usual. A column heading (counter-clockwise, rad) is optional: it\n"
    "finds the same errors another way, and a warning says where both contradict each other.\n"
    "Semicolons or tabs may part the fields, numbers may have decimal commas.\n\n"
    "Several rounds: give their files in the order driven. Each was driven with the corrections\n"
    "that all files before it call for; what to use from now on is their product. --model gives\n"
    "corrections that were in force from the start (its effects wheelbase, wheel diameter ratio\n"
    "and wheel scale). --out has the wheelbase in [robot], the wheels as effects.\n\n"
    "A closed path closes at any size of the wheels, so that squares say nothing of their mean:\n"
    "--straight does. Wheelbase and travel factors then hold it as well.";

}  // namespace

void setup_umbmark(const Command& app) {
  auto options = std::make_shared<UmbmarkOptions>();
  const Command command = app.add_subcommand(
      "umbmark",
      "Calibrate wheel diameters and wheelbase with a tape measure: squares driven in both "
      "directions (UMBmark; Borenstein & Feng 1996), by the papers' formulas and exactly.");
  command.add_option("RUNS", options->files, "End errors of the runs (CSV), a file per round")
      .type_name("FILE");
  command.add_option("--side", options->side, "Side of the square [m]")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option("--solution", options->solution,
                  "What to correct by: exact (right for large errors too) or formulas (the "
                  "papers', for small angles)")
      .check(one_of({"exact", "formulas"}))
      .capture_default_str();
  command
      .add_option(
          "--straight", options->straight,
          "Straight runs beside a tape with the settings of the first round, MEASURED:REPORTED: "
          "length by the tape and by the odometry [m], 10.031:10 for instance, several "
          "separated by commas")
      .type_name("LENGTHS");
  command
      .add_option("--alone", options->alone,
                  "Say what this path (as of noise --path), driven alone, would have hidden of "
                  "this robot: \"eight@1\" for instance, a figure-eight. Repeat it for more")
      .one_value_each()
      .type_name("PATH");
  add_tape_options(command, options->tape);
  command
      .add_option("--true-E-s", options->true_e_s,
                  "Its true mean wheel size over the believed one; it then drives three straight "
                  "runs of 10 m besides")
      .check(above_zero())
      .group("Rehearsal with a simulated robot");
  command
      .add_option("--rounds", options->rounds, "Rounds, each with the corrections of those before")
      .check(whole_number(1))
      .capture_default_str()
      .group("Rehearsal with a simulated robot");
  command.footer(std::string(kSquareFooter) + kWallHelp);
  command.callback([options, command] {
    check_source(command, options->tape, !options->files.empty());
    if (options->tape.simulate && !options->straight.empty()) {
      throw UsageError("--straight is given with --simulate, expected --true-E-s");
    }
    run_umbmark(*options);
  });
}

}  // namespace trussmap::app
