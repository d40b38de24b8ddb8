// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap umbmark: wheel diameters and wheelbase from squares driven both ways.
#include "commands.hpp"
#include "json_values.hpp"
#include "option_checks.hpp"
#include "plot/calibration_figures.hpp"
#include "report/calibration_pages.hpp"
#include "tape_options.hpp"
#include "terminal.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/random_stream.hpp"
#include "trussmap/runs_files.hpp"
#include "trussmap/table.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct UmbmarkOptions {
  std::vector<std::string> files;
  double side = 4.0;  // m
  std::string solution = "exact";
  int rounds = 1;
  TapeOptions tape;
};

/// Runs driven with the corrections of all rounds before.
struct Round {
  SquareRuns runs;
  SquareSetup setup;        // with the wheelbase that the robot calculated with
  GeometryErrors in_force;  // corrected for while driving
  SquareClusters clusters;
  SquareAngles angles;
  SquareSolution exact;
  SquareSolution formulas;
  SquareConsistency consistency;
  std::vector<std::string> doubts;
};

/// A solution together with what was in force: what the robot's software should use.
struct Total {
  GeometryErrors errors;
  Estimate wheelbase;  // m
  Estimate left_factor;
  Estimate right_factor;
};

Round analyse(SquareRuns runs, const SquareSetup& setup, const GeometryErrors& in_force) {
  Round round;
  round.runs = std::move(runs);
  round.setup = setup;
  round.in_force = in_force;
  round.clusters = square_clusters(round.runs);
  round.angles = square_angles(round.clusters, setup.side);
  round.exact = solve_square(round.clusters, setup);
  round.formulas = umbmark(round.clusters, setup);
  round.consistency = square_consistency(round.clusters, setup);
  round.doubts = square_doubts(round.clusters, setup);
  for (std::string& doubt : square_outliers(round.runs)) round.doubts.push_back(std::move(doubt));
  return round;
}

Total total(const Round& round, const SquareSolution& found) {
  Total result;
  result.errors = combined(round.in_force, found.errors());
  const double e_d = result.errors.diameter_ratio;
  // c_L = 2/(E_d + 1) of the product; its relative error is that of the ratio found.
  const double factor_se = 2.0 / std::pow(e_d + 1.0, 2) * round.in_force.diameter_ratio *
                           found.diameter_ratio.standard_error;
  result.wheelbase = found.wheelbase;
  result.left_factor = {result.errors.left_factor(), factor_se, found.diameter_ratio.dof};
  result.right_factor = {result.errors.right_factor(), factor_se, found.diameter_ratio.dof};
  return result;
}

const SquareSolution& chosen(const Round& round, const UmbmarkOptions& options) {
  return options.solution == "exact" ? round.exact : round.formulas;
}

SquareRuns simulated_square(const UmbmarkOptions& options, const Round& round, double nominal,
                            std::mt19937_64& random) {
  const TapeRobot robot =
      reprogrammed(simulated_robot(options.tape, nominal), round.in_force.left_factor(),
                   round.in_force.right_factor(), round.setup.wheelbase);
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

std::vector<Round> all_rounds(const UmbmarkOptions& options, const Model& model) {
  std::mt19937_64 random = random_stream(options.tape.seed, Stream::wheels);
  const auto count =
      options.tape.simulate ? static_cast<std::size_t>(options.rounds) : options.files.size();
  std::vector<Round> rounds;
  GeometryErrors in_force;
  try {
    in_force = geometry_errors(model);
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.tape.model + ": " + error.what());
  }
  for (std::size_t k = 0; k < count; ++k) {
    Round plan;
    plan.in_force = in_force;
    plan.setup = {options.side, model.robot.wheelbase * in_force.wheelbase_ratio};
    SquareRuns runs =
        options.tape.simulate
            ? simulated_square(options, plan, model.robot.wheelbase, random)
            : read_square_runs(options.files[k], path_length(square_path(options.side, {})));
    rounds.push_back(analyse(std::move(runs), plan.setup, in_force));
    in_force = total(rounds.back(), chosen(rounds.back(), options)).errors;
  }
  return rounds;
}

ordered_json solution_json(const Round& round, const SquareSolution& found) {
  const Total sum = total(round, found);
  const auto interval = [](const Estimate& estimate) {
    const Interval at = confidence_interval(estimate);
    return ordered_json{at.low, at.high};
  };
  return {{"alpha_rad", found.alpha.value},
          {"beta_rad", found.beta.value},
          {"E_d", found.diameter_ratio.value},
          {"E_b", found.wheelbase_ratio.value},
          {"c_left", sum.left_factor.value},
          {"c_right", sum.right_factor.value},
          {"wheelbase_m", sum.wheelbase.value},
          {"E_max_syst_m", round.clusters.largest_offset.value},
          {"sem_m", round.clusters.sem},
          {"second_round_worthwhile", round.clusters.second_round_worthwhile},
          {"sd_alpha_rad", found.alpha.standard_error},
          {"sd_beta_rad", found.beta.standard_error},
          {"sd_E_d", found.diameter_ratio.standard_error},
          {"sd_E_b", found.wheelbase_ratio.standard_error},
          {"sd_c_left", sum.left_factor.standard_error},
          {"sd_c_right", sum.right_factor.standard_error},
          {"sd_wheelbase_m", sum.wheelbase.standard_error},
          {"sd_E_max_syst_m", round.clusters.largest_offset.standard_error},
          {"interval95_E_d", interval(found.diameter_ratio)},
          {"interval95_E_b", interval(found.wheelbase_ratio)},
          {"total_E_d", sum.errors.diameter_ratio},
          {"total_E_b", sum.errors.wheelbase_ratio}};
}

ordered_json round_json(const Round& round) {
  ordered_json out = solution_json(round, round.formulas);
  out["exact"] = solution_json(round, round.exact);
  const auto centre = [](const SampleMean& mean) {
    return ordered_json{{"runs", mean.count},
                        {"x_m", mean.mean.x()},
                        {"y_m", mean.mean.y()},
                        {"sd_x_m", std::sqrt(mean.covariance(0, 0))},
                        {"sd_y_m", std::sqrt(mean.covariance(1, 1))}};
  };
  out["cw"] = centre(round.clusters.cw);
  out["ccw"] = centre(round.clusters.ccw);
  out["alpha_x_rad"] = round.angles.alpha_x.value;
  out["alpha_y_rad"] = round.angles.alpha_y.value;
  out["beta_x_rad"] = round.angles.beta_x.value;
  out["beta_y_rad"] = round.angles.beta_y.value;
  out["driven_with"] = {{"wheelbase_m", round.setup.wheelbase},
                        {"c_left", round.in_force.left_factor()},
                        {"c_right", round.in_force.right_factor()}};
  out["residual_m"] = round.consistency.residual;
  out["contradiction_p_value"] = number_or_null(round.consistency.p_value);
  out["warnings"] = round.doubts;
  return out;
}

/// The last round's figures; every round under `rounds`.
ordered_json json(const std::vector<Round>& rounds, const UmbmarkOptions& options) {
  ordered_json out = round_json(rounds.back());
  out["solution"] = options.solution;
  out["rounds"] = ordered_json::array();
  for (const Round& round : rounds) out["rounds"].push_back(round_json(round));
  return out;
}

std::string verdict(const Round& round, std::size_t number) {
  const SquareClusters& clusters = round.clusters;
  const QuantityText size =
      quantity_text(clusters.largest_offset.value, clusters.largest_offset.standard_error);
  const std::string again = number > 1 ? "still " : "";
  if (!(clusters.sem > 0.0)) {
    return fmt::format("systematic error {} m; the runs show no scatter to judge it by\n",
                       size.value);
  }
  const std::string limit =
      fmt::format("three standard errors of a centre, {:#.2g} m", 3.0 * clusters.sem);
  return clusters.second_round_worthwhile
             ? fmt::format("{}worth correcting: systematic error {} m, more than {}\n", again,
                           size.value, limit)
             : fmt::format("nothing left to correct: systematic error {} m, within {}\n",
                           size.value, limit);
}

std::string corrections_text(const Round& round, const UmbmarkOptions& options) {
  const Total use = total(round, chosen(round, options));
  TextTable table{{Align::left, Align::right, Align::left, Align::left}, {}, false, 4};
  const auto row = [&](const char* name, const Estimate& value, const char* unit) {
    std::vector<std::string> cells = quantity_cells(value);
    table.rows.push_back({name, cells[0], cells[1], unit});
  };
  row("wheelbase", use.wheelbase, "m");
  row("left wheel's travel times", use.left_factor, "");
  row("right wheel's travel times", use.right_factor, "");
  return fmt::format("\n  Use from now on ({}):\n{}",
                     options.solution == "exact" ? "exact solution" : "the papers' formulas",
                     table_text(table));
}

std::string solutions_text(const Round& round) {
  TextTable table;
  table.columns = {Align::left, Align::right, Align::left, Align::right, Align::left, Align::left};
  table.has_heading = true;
  table.rows.push_back({"", "exact", "", "formulas", "", "unit"});
  const auto row = [&](const char* name, Estimate SquareSolution::*member, const char* unit) {
    const std::vector<std::string> exact = quantity_cells(round.exact.*member);
    const std::vector<std::string> small = quantity_cells(round.formulas.*member);
    table.rows.push_back({name, exact[0], exact[1], small[0], small[1], unit});
  };
  row("E_d  right wheel / left wheel", &SquareSolution::diameter_ratio, "");
  row("E_b  wheelbase / believed", &SquareSolution::wheelbase_ratio, "");
  row("alpha  missing per quarter turn", &SquareSolution::alpha, "rad");
  row("beta  turned per leg", &SquareSolution::beta, "rad");
  return "\n" + table_text(table);
}

std::string clusters_text(const Round& round) {
  TextTable table;
  table.columns = {Align::left,  Align::right, Align::right, Align::left,
                   Align::right, Align::left,  Align::right};
  table.has_heading = true;
  table.rows.push_back({"centre", "runs", "x [m]", "", "y [m]", "", "distance [m]"});
  for (const auto& [name, mean] :
       {std::pair("cw", &round.clusters.cw), std::pair("ccw", &round.clusters.ccw)}) {
    const auto x = quantity_cells({mean->mean.x(), std::sqrt(mean->covariance(0, 0)), 0.0});
    const auto y = quantity_cells({mean->mean.y(), std::sqrt(mean->covariance(1, 1)), 0.0});
    table.rows.push_back({name, std::to_string(mean->count), x[0], x[1], y[0], y[1],
                          fmt::format("{:.4f}", mean->mean.norm())});
  }
  return "\n" + table_text(table);
}

std::string one_way_text(const Round& round) {
  const OneWayTuning one_way = tune_one_way(round.exact.errors(), round.setup, Direction::ccw);
  return fmt::format(
      "\n  Driven ccw alone, the wheelbase could be tuned until {:.3f} m became {:.3f} m; cw, "
      "{:.3f} "
      "m\n  would be left. That is why the square is driven both ways.\n",
      one_way.error_before, one_way.error_same_way, one_way.error_other_way);
}

std::vector<std::string> doubts_of(const std::vector<Round>& rounds) {
  std::vector<std::string> doubts;
  for (const Round& round : rounds) {
    for (const std::string& doubt : round.doubts) {
      doubts.push_back(rounds.size() == 1
                           ? doubt
                           : fmt::format("round {}: {}", &round - rounds.data() + 1, doubt));
    }
  }
  return doubts;
}

Page page_of(const std::vector<Round>& rounds, const UmbmarkOptions& options) {
  const Total use = total(rounds.back(), chosen(rounds.back(), options));
  SquareCalibration shown;
  for (const Round& round : rounds) {
    shown.rounds.push_back({round.runs, round.clusters, round.exact, round.formulas});
  }
  shown.side = options.side;
  shown.wheelbase = use.wheelbase;
  shown.left_factor = use.left_factor;
  shown.right_factor = use.right_factor;
  shown.doubts = doubts_of(rounds);
  return square_page(shown,
                     options.tape.simulate ? "a simulated robot" : subject_of(options.files, ""));
}

std::string text(const std::vector<Round>& rounds, const UmbmarkOptions& options) {
  std::string out =
      verdict_text(rounds.back().clusters.second_round_worthwhile ? Mood::doubt : Mood::good,
                   verdict(rounds.back(), rounds.size()));
  if (rounds.size() > 1) {
    TextTable table{{Align::left, Align::right, Align::left, Align::left}, {}, false, 2};
    for (std::size_t k = 0; k < rounds.size(); ++k) {
      const auto cells = quantity_cells(rounds[k].clusters.largest_offset);
      table.rows.push_back(
          {fmt::format("round {}: systematic error", k + 1), cells[0], cells[1], "m"});
    }
    out += "\n" + table_text(table);
  }
  const Round& last = rounds.back();
  if (rounds.size() > 1 && last.clusters.sem > 0.0 && !last.clusters.second_round_worthwhile) {
    out +=
        "\n  The last round's own corrections are within its scatter; those of the rounds before\n"
        "  would do as well.\n";
  }
  out += corrections_text(last, options) + solutions_text(last) + clusters_text(last);
  if (rounds.size() == 1 && last.clusters.second_round_worthwhile) out += one_way_text(last);
  return out + warnings_text(doubts_of(rounds));
}

/// RUNS.csv, RUNS_2.csv, RUNS_3.csv ...
fs::path round_file(const fs::path& first, std::size_t round) {
  if (round == 0) return first;
  return first.parent_path() /
         fmt::format("{}_{}{}", first.stem().string(), round + 1, first.extension().string());
}

void run_umbmark(const UmbmarkOptions& options) {
  Model model = starting_model(options.tape);
  const std::vector<Round> rounds = all_rounds(options, model);
  Files files;
  if (!options.tape.out.empty()) {
    set_geometry_errors(model, total(rounds.back(), chosen(rounds.back(), options)).errors);
    files.emplace_back(options.tape.out, format_model(model));
  }
  if (!options.tape.json.empty()) {
    files.emplace_back(options.tape.json, json(rounds, options).dump(2) + "\n");
  }
  if (!options.tape.page.plots.empty()) {
    std::vector<SquareRuns> runs;
    runs.reserve(rounds.size());
    for (const Round& round : rounds) runs.push_back(round.runs);
    files.emplace_back(fs::path(options.tape.page.plots) / "umbmark.svg",
                       draw_figure(square_figure(runs, options.side)));
    fs::create_directories(options.tape.page.plots);
  }
  if (!options.tape.page.html.empty()) {
    add_page(files, page_of(rounds, options), {options.tape.page.html, {}});
  }
  for (std::size_t k = 0; k < rounds.size() && !options.tape.write.empty(); ++k) {
    files.emplace_back(round_file(options.tape.write, k), format_square_runs(rounds[k].runs));
  }
  write_files(files);
  fmt::print("{}", text(rounds, options));
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

void setup_umbmark(CLI::App& app) {
  auto options = std::make_shared<UmbmarkOptions>();
  CLI::App* command = app.add_subcommand(
      "umbmark",
      "Calibrate wheel diameters and wheelbase with a tape measure: squares driven in both "
      "directions (UMBmark; Borenstein & Feng 1996), by the papers' formulas and exactly.");
  command->add_option("RUNS", options->files, "End errors of the runs (CSV), a file per round")
      ->type_name("FILE");
  command->add_option("--side", options->side, "Side of the square [m]")
      ->check(above_zero())
      ->capture_default_str();
  command
      ->add_option("--solution", options->solution,
                   "What to correct by: exact (right for large errors too) or formulas (the "
                   "papers', for small angles)")
      ->check(CLI::IsMember({"exact", "formulas"}))
      ->capture_default_str();
  add_tape_options(*command, options->tape);
  command
      ->add_option("--rounds", options->rounds, "Rounds, each with the corrections of those before")
      ->check(whole_number(1))
      ->capture_default_str()
      ->group("Rehearsal with a simulated robot");
  command->footer(kFooter);
  command->callback([options, command] {
    check_source(*command, !options->files.empty());
    run_umbmark(*options);
  });
}

}  // namespace trussmap::app
