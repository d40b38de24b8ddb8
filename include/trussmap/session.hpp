// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// The way from recordings and a model to what compare, fit, diagnose and discover say, as the
// command and Python go it:
//
//   recordings, model --open_session--> with their wheels, prepared
//                     --compare, fit, diagnose, discover--> a report: the result, what dead
//                       reckoning owes to which noise, the robot's constants, notes
//
// Each call tells the stages that its work goes through; whoever shows them adds those of his own,
// such as a page. stop_if_asked (running.hpp) ends a call between them.
#pragma once

#include "trussmap/calibrate.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/test_path.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

/// A part of a call, and which share of its time it takes, in any unit.
struct Stage {
  std::string what;  ///< "fitting the map"
  double share = 1.0;
};

/// Reading comes first; open_session and what is before it belong to it.
[[nodiscard]] std::vector<Stage> compare_stages();
[[nodiscard]] std::vector<Stage> fit_stages(bool noise);
[[nodiscard]] std::vector<Stage> diagnose_stages();
/// As if one effect were found.
[[nodiscard]] std::vector<Stage> discover_stages();

/// What of the recordings is used, and by what they judge.
struct SessionOptions {
  FitOptions fit = gated_fit();
  LegOptions legs = {};
  /// s between frames of sightings; 0: all; none: as long as their errors last
  std::optional<double> every = {};
  double level = kSignificance;
  bool estimate_noise = true;    ///< of diagnose and discover; else what the model states
  std::size_t most_effects = 6;  ///< that discover adds
};

/// Options of the calls that a session makes.
[[nodiscard]] CompareOptions compare_options(const SessionOptions& options);
[[nodiscard]] DiagnoseOptions diagnose_options(const SessionOptions& options);

/// Recordings of one robot and what is believed of it.
struct Session {
  PreparedRecordings rows;  ///< as the model has them; of diagnose and discover, as they end
  Model model;
  SessionOptions options;
};

/// Throws as fit_model does, and std::invalid_argument where times to leave out are none of their
/// recording's.
[[nodiscard]] Session open_session(std::vector<DrivenRecording> recordings, Model model,
                                   const SessionOptions& options = {});

/// Told when the next stage after reading begins.
using NextStage = std::function<void()>;

struct ComparisonReport {
  ModelFit fit;  ///< with the coefficients that the model has
  Comparison found;
  std::vector<NoiseBudget> noise_budget;
};

/// Throws like fit_model, as those below do.
[[nodiscard]] ComparisonReport compare(const Session& session, const NextStage& next = {});

struct FitReport {
  EffectGain gain;
  std::optional<FittedNoise> noise;
  RobotConstants constants;
};

/// `noise`: estimate it, too, before the effects are fitted.
[[nodiscard]] FitReport fit(const Session& session, bool noise, const NextStage& next = {});

struct DiagnosisReport {
  ModelFit fit;
  Diagnosis found;
  std::vector<NoiseBudget> noise_budget;
  RobotConstants constants;
};

[[nodiscard]] DiagnosisReport diagnose(Session& session, const NextStage& next = {});

struct DiscoveryReport {
  Discovery found;
  std::vector<NoiseBudget> noise_budget;
  RobotConstants constants;
};

/// `progress` as DiscoverOptions has it.
[[nodiscard]] DiscoveryReport discover(
    Session& session, const std::function<void(const DiscoveryStage&)>& progress = {});

// ----------------------------------------
// The next drive: the tour that decides between effects which recordings cannot tell apart, its
// speeds, turns, bends, stops and loads chosen among elementary manoeuvres on the map's routes.
//
//   lambda   by what chi^2 is to grow where a rival is fitted in place of the effect that is true,
//            over the recordings and the drive together: noncentrality (src/planning)
//   power    chance that it grows by more than the quantile of chi^2 at the level, and than
//            kToldApart: that a diagnosis of both tells them apart
//
// Every pair of rivals counts either way round; the tour raises the least of all lambdas to where
// the power is as wished, and then leaves out what it can do without.

struct PlanOptions {
  std::vector<std::string> rivals = {};  ///< effects by name; empty: what the diagnosis leaves open
  double max_speed = 0.0;                ///< m/s; 0: as fast as was driven
  double most_time = 1800.0;             ///< s
  double most_length = 1000.0;           ///< m
  double power = 0.95;
  double level = 0.01;     ///< chance that a wrong rival is preferred by so much
  std::string start = {};  ///< landmark; empty: where the last recording ended
};

/// One of two rivals is true.
struct PlannedPair {
  Effect truth;  ///< of the size that the recordings give it
  Effect rival;
  double before = 0.0;  ///< lambda of the recordings alone
  double after = 0.0;   ///< with the drive
  double power_before = 0.0;
  double power = 0.0;   ///< with the drive
  bool beyond = false;  ///< not even a thorough tour tells it: the drive was not planned for it
};

/// An effect that a tour has to show.
struct PlannedEffect {
  Effect effect;        ///< of the practical size, all shapes alike
  double size = 0.0;    ///< largest |g| that is practical, unit of the channel
  double lambda = 0.0;  ///< of the shape that is seen worst
  double power = 0.0;
  bool beyond = false;  ///< not even a thorough tour shows it: the drive was not planned for it
};

/// What else could be measured, and what it would change. Each on the same drive.
enum class Instrument {
  compass,
  gyro,
  range_sensor,  ///< half of the landmarks in reach, by range and bearing
  distance,      ///< one tape between two landmarks, 2 mm
  survey,        ///< of all landmarks, as the model states its noise
  truth          ///< poses, once a second
};
[[nodiscard]] std::string_view name_of(Instrument instrument);

struct InstrumentWorth {
  Instrument instrument = Instrument::gyro;
  bool there = false;     ///< the robot has it
  double factor = 1.0;    ///< of the least lambda that the drive was planned for
  std::size_t tells = 0;  ///< of what is beyond the drive, how much it would tell by that power
};

struct PlannedDrive {
  DrivePlan plan;                      ///< without waypoints: no drive helps
  double length = 0.0;                 ///< m
  double duration = 0.0;               ///< s
  bool enough = false;                 ///< all that a drive can tell is told by the wished power
  double power = 0.0;                  ///< the least of that
  std::vector<PlannedPair> pairs;      ///< of rivals
  std::vector<PlannedEffect> effects;  ///< of an acceptance test
  std::vector<InstrumentWorth> worth;  ///< the most useful first
  PlanOptions options;
};

/// To tell rivals of a diagnosis apart, from landmark to landmark that the robot stood on, by
/// routes that it drove. Throws std::invalid_argument on rivals or a start that are not there, on
/// limits that make no sense and where nothing is open; SolveError where the recordings show no
/// routes.
[[nodiscard]] PlannedDrive plan_drive(const Diagnosis& diagnosis, const PlanOptions& options = {});

/// What a robot is accepted by.
struct AcceptanceOptions : PlanOptions {
  bool compass = true;
  bool gyro = false;
  double slowest = 0.25;  ///< m/s; max_speed 0: 0.9
  /// Practical: so many times what the catalogue calls detectable (CatalogueEntry).
  double size = 3.0;
};

/// The tour of a new robot on a map's routes that shows every effect of the catalogue, but for
/// those at a place, of its practical size by itself. Landmarks are known as the map states it
/// (else as the model states a survey). The start is the first landmark where none is named. Throws
/// as plan_drive.
[[nodiscard]] PlannedDrive plan_acceptance(const LandmarkGraph& map, const Model& model,
                                           const AcceptanceOptions& options = {});

}  // namespace trussmap
