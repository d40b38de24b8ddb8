// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap umbmark: wheel diameters and wheelbase from squares driven both ways.
#include "commands.hpp"
#include "option_checks.hpp"
#include "tape_options.hpp"
#include "terminal.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/umbmark.hpp"
#include "umbmark_output.hpp"

#include <filesystem>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

struct UmbmarkOptions {
  std::vector<std::string> files;
  double side = 4.0;  // m
  std::string solution = "exact";
  int rounds = 1;
  TapeOptions tape;
};

SquareMethod method_of(const UmbmarkOptions& options) {
  return options.solution == "exact" ? SquareMethod::exact : SquareMethod::formulas;
}

SquareRuns simulated_runs(const UmbmarkOptions& options, const TapeRobot& robot,
                          std::mt19937_64& random) {
  SquareRuns runs;
  for (const auto& [sense, sample] :
       {std::pair(Direction::cw, &runs.cw), std::pair(Direction::ccw, &runs.ccw)}) {
    for (const Pose& end :
         drive_often(robot, square_path(options.side, sense), options.tape.runs, random)) {
      sample->push_back(end.position());
    }
  }
  return runs;
}

std::vector<SquareRound> all_rounds(const UmbmarkOptions& options, const Model& model) {
  GeometryErrors in_force;
  try {
    in_force = geometry_errors(model);
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.tape.model + ": " + error.what());
  }
  const double wheelbase = model.robot.wheelbase;
  const SquareMethod method = method_of(options);
  if (!options.tape.simulate) {
    const double longest = path_length(square_path(options.side, {}));
    return square_rounds(
        options.files.size(), options.side, wheelbase, in_force, method,
        [&](std::size_t round, const SquareSetup& /*setup*/, const GeometryErrors& /*in_force*/) {
          return read_square_runs(options.files[round], longest);
        });
  }
  std::mt19937_64 random = random_stream(options.tape.seed, Stream::wheels);
  return square_rounds(
      static_cast<std::size_t>(options.rounds), options.side, wheelbase, in_force, method,
      [&](std::size_t /*round*/, const SquareSetup& setup, const GeometryErrors& corrected) {
        const TapeRobot robot =
            reprogrammed(simulated_robot(options.tape, wheelbase), corrected.left_factor(),
                         corrected.right_factor(), setup.wheelbase);
        return simulated_runs(options, robot, random);
      });
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
  Model model = starting_model(options.tape);
  const std::vector<SquareRound> rounds = all_rounds(options, model);
  Files files;
  if (!options.tape.out.empty()) {
    set_geometry_errors(model, corrections_after(rounds.back(), method_of(options)).errors);
    files.emplace_back(options.tape.out, format_model(model));
  }
  if (!options.tape.json.empty()) {
    files.emplace_back(options.tape.json, umbmark_json(rounds, method_of(options)).dump(2) + "\n");
  }
  if (!options.tape.page.plots.empty()) {
    std::vector<SquareRuns> runs;
    runs.reserve(rounds.size());
    for (const SquareRound& round : rounds) runs.push_back(round.runs);
    files.add_plot(options.tape.page.plots, "umbmark.svg", square_picture(runs, options.side));
  }
  if (!options.tape.page.html.empty()) {
    add_page(files, page_of(rounds, options), {options.tape.page.html, {}});
  }
  for (std::size_t k = 0; k < rounds.size() && !options.tape.write.empty(); ++k) {
    files.emplace_back(round_file(options.tape.write, k), format_square_runs(rounds[k].runs));
  }
  files.write();
  fmt::print("{}", square_text(rounds, method_of(options), style_of(stdout)));
}

constexpr const char* kFooter =
    "RUNS.csv has the columns direction,x,y and a row per run: direction is cw (turning right) or\n"
    "ccw (turning left); x and y [m] are where the robot was measured to stand after the square\n"
    "minus where its odometry had it, x along the first leg and y to its left. Two runs or more "
    "in\n"
    "each direction, five are usual.\n\n"
    "Several rounds: give their files in the order driven. Each was driven with the corrections\n"
    "that all files before it call for; what to use from now on is their product. --model gives\n"
    "corrections that were in force from the start (its effects wheelbase and wheel diameter\n"
    "ratio).";

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
  add_tape_options(command, options->tape);
  command
      .add_option("--rounds", options->rounds, "Rounds, each with the corrections of those before")
      .check(whole_number(1))
      .capture_default_str()
      .group("Rehearsal with a simulated robot");
  command.footer(kFooter);
  command.callback([options, command] {
    check_source(command, !options->files.empty());
    run_umbmark(*options);
  });
}

}  // namespace trussmap::app
