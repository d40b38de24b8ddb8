// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Many robots of one model: what all of them have, which differ, which drift, and what that goes
// with. From sums that are kept per robot and day, never from their recordings again.
//
//   recordings of a robot's day --fleet_row--> FleetRow --add_to_fleet, read_fleet--> rows
//   rows --fleet_report--> FleetReport           rows --pooled_tests--> score tests of all
//
//   M   whitened columns, landmarks and poses projected out, of the model's effects and of all
//       candidates of the catalogue with a fixed shape, at the coefficients that the model states
//   g = M' r,  S = M' M     kept whole, so that what all recordings together would say is a sum:
//                           g = sum g_i, S = sum S_i, chi^2 and dof likewise (Rao 1948)
//
// What the model has is projected out of the candidates on the sums. Where it has nothing fitted
// that is the joint diagnosis exactly; else it is one Gauss-Newton step from the stated
// coefficients. Places, thresholds and other fitted shapes differ from robot to robot: they do not
// pool, and are not among the candidates.
//
// Between robots: y_i = mu + u_i + e_i, u_i ~ N(0, tau^2), e_i ~ N(0, s_i^2); tau by restricted
// likelihood, mu with Hartung and Knapp's standard error (2001, modified: never below the plain
// one). Robots that this does not explain (Holm, both-sided) are left out of mu and tau until none
// is new, so that they cannot hide each other.
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/held_out.hpp"

#include <cmath>
#include <compare>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

/// One coefficient of an effect.
struct FleetColumn {
  bool of_model = false;  ///< the model has it; else a candidate
  std::string effect;
  std::string channel;
  std::string shape;
  int place = 0;  ///< among the effect's coefficients
  auto operator<=>(const FleetColumn& other) const = default;
};

/// A robot's day. Per column: an entry of each vector, a row and a column of S.
struct FleetRow {
  std::string robot;
  std::string date;                             ///< YYYY-MM-DD
  std::map<std::string, std::string> metadata;  ///< tyre batch, floor, service, ...
  std::string model;                            ///< as its file has it
  int recordings = 0;
  double chi2 = 0.0;
  int dof = 0;
  int held_out_legs = 0;
  double held_out_rms = 0.0;  ///< m
  double held_out_stretch = 0.0;
  double held_out_orientation = 0.0;  ///< rad
  std::vector<FleetColumn> columns;
  std::vector<double> reference;  ///< coefficient that the model states, unit of the effect
  std::vector<double> prior_sd;   ///< of the channel's largest g
  std::vector<double> largest;    ///< |f|
  std::vector<double> whole;      ///< |M|^2 before the projection
  Eigen::VectorXd g;
  Eigen::MatrixXd S;
};

/// Throws InputError on a date that is none, an effect of the model with coefficients per session,
/// and like fit_model. Of these recordings alone; a day of several has the same landmarks in all.
[[nodiscard]] FleetRow fleet_row(const std::string& robot, const std::string& date,
                                 const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const std::string& model_text, const FitOptions& fit = {},
                                 const LegOptions& legs = {});

/// Days from 1970-01-01. Throws InputError unless it is YYYY-MM-DD.
[[nodiscard]] int day_number(const std::string& date);

// ----------------------------------------
// Rows in a database: one per robot and day, all of one model (link trussmap::store). Programs that
// add at the same time wait for each other; none loses a row. Merged stores hold the same whatever
// the order of the shards.

/// Makes the store where it is not there. Throws InputError where it is no fleet store, has another
/// model, or has that robot's day already (unless `replace`).
void add_to_fleet(const std::filesystem::path& file, const FleetRow& row, bool replace = false);

/// By robot and date. Throws InputError where it is none, or is damaged.
[[nodiscard]] std::vector<FleetRow> read_fleet(const std::filesystem::path& file);

/// Adds all rows of the shards to a store, made where it is not there: all or none. A row may be in
/// several if it is the same in all; else InputError, as where models differ. Returns how many rows
/// the store then has.
std::size_t merge_fleets(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& shards);

// ----------------------------------------
// What they say together.

/// A score test of all rows together.
struct PooledTest {
  bool of_model = false;
  std::string effect;
  std::string channel;
  std::vector<std::string> shape;
  double score = 0.0;
  int dof = 0;
  double p_value = 1.0;              ///< against chi^2, as ScoreTest
  std::vector<double> coefficients;  ///< reference and step, of those that are seen
  std::vector<double> sd;            ///< infinite where unseen
};

/// Of every candidate alone, the model's effects projected out. Throws InputError where rows are of
/// different models.
[[nodiscard]] std::vector<PooledTest> pooled_tests(const std::vector<FleetRow>& rows);

struct FleetRobot {
  std::string robot;
  int days = 0;
  double value = 0.0;  ///< estimate; of one that drifts, on its first day
  double sd = 0.0;
  double shrunken = 0.0;  ///< towards the robots like it; one that differs keeps its own
  double shrunken_sd = 0.0;
  double p_differs = 1.0;  ///< Holm over robots, times findings
  bool differs = false;
  bool has_slope = false;
  double slope = 0.0;  ///< per day
  double slope_sd = 0.0;
  double p_drifts = 1.0;  ///< likewise; of one that differs Holm over these; two families
  bool drifts = false;
};

struct FleetGroup {
  std::string value;  ///< of the metadata's key
  int robots = 0;
  double mean = 0.0;
  double sd = 0.0;
  double p_value = 1.0;  ///< of mean 0, times groups and findings
};

struct FleetKey {
  std::string key;
  double p_adjusted = 1.0;  ///< of no difference between groups, times keys and findings
  std::vector<FleetGroup> groups;
  std::vector<std::string> same_as;  ///< keys that divide the robots the same way
};

/// One coefficient over all robots.
struct FleetCoefficient {
  std::string shape;
  int robots = 0;
  double mean = 0.0;
  double sd = 0.0;
  double p_common = 1.0;  ///< of mean 0, times findings
  bool common = false;    ///< all groups have it, where there are groups
  double tau = 0.0;       ///< between robots that do not differ
  double p_tau = 1.0;     ///< restricted likelihood ratio, chi^2 0 or 1 half and half
  double Q = 0.0;         ///< Cochran's
  int Q_dof = 0;
  double slope = 0.0;  ///< mean per day of all robots
  double slope_sd = 0.0;
  double p_slope = 1.0;
  bool all_drift = false;
  std::vector<FleetKey> goes_with;  ///< at most one; further keys that it explains are none
  std::vector<FleetRobot> members;
};

struct FleetLookAlike {
  std::string effect;
  double cosine = 0.0;
};

struct FleetFinding {
  bool of_model = false;
  std::string effect;
  std::string channel;
  double p_adjusted = 1.0;  ///< of there being anything, over all candidates
  std::vector<FleetCoefficient> coefficients;
  std::vector<FleetLookAlike> look_alikes;
};

struct FleetReport {
  std::size_t robots = 0;
  std::size_t days = 0;  ///< rows
  double chi2 = 0.0;
  int dof = 0;
  double level = 0.05;
  std::vector<PooledTest> tests;       ///< of every candidate alone
  std::vector<FleetFinding> findings;  ///< the model's own effects, then what is found
  std::vector<std::string> keys;       ///< of the metadata, that were tested
  std::vector<std::string> notes;
  std::map<std::string, double> held_out_rms;  ///< m, per robot
};

/// Throws InputError where rows are of different models or there are none, std::invalid_argument
/// unless 0 < level < 1. Rows in any order, same report.
[[nodiscard]] FleetReport fleet_report(std::vector<FleetRow> rows, double level = 0.05);

// ----------------------------------------
// Two runs of one robot: before and after a repair, or a change of its software. From what the
// commands wrote as JSON, not from recordings.

/// A figure that a run tells.
struct RunFigure {
  std::string name;    ///< "wheelbase", "effect hard iron: sin(heading)", "chi2/dof"
  std::string unit;    ///< "m"; empty: a number
  double value = 0.0;  ///< of "m" of legs' ends the root mean square
  double sd = 0.0;     ///< its standard error; 0: not told
  double dof = 0.0;    ///< of errors, in place of a standard error; else 0
};

struct RunFigures {
  std::string verdict;  ///< "misfit"; may be empty
  std::vector<RunFigure> figures;
};

/// What compare, fit, diagnose, discover or calibrate wrote with --json: errors, constants to
/// paste, effects. Throws InputError where it is none of that, or cannot be read.
[[nodiscard]] RunFigures read_run_figures(const std::filesystem::path& file);

/// A figure in both runs, or in one of them.
struct FigureChange {
  std::string name;
  std::string unit;
  std::optional<RunFigure> before, now;
  /// That chance alone makes them differ so much: of errors by the F distribution of the ratio of
  /// their mean squares, of what has standard errors by the normal one; none where a run does not
  /// tell it, or not how surely.
  std::optional<double> p_value;
  bool changed = false;  ///< at the level, over all that have a p-value (Holm)

  // Where both runs tell it.
  [[nodiscard]] double change() const { return now->value - before->value; }
  [[nodiscard]] double change_sd() const { return std::hypot(before->sd, now->sd); }
};

struct RunContrast {
  std::string before, now;  ///< verdicts
  double level = 0.05;
  std::vector<FigureChange> figures;

  [[nodiscard]] bool any_changed() const;
  [[nodiscard]] std::size_t told() const;  ///< figures that have a p-value
};

/// Of runs with different recordings: from the same ones differences are smaller than by chance.
[[nodiscard]] RunContrast contrast_runs(const RunFigures& before, const RunFigures& now,
                                        double level = 0.05);

}  // namespace trussmap
