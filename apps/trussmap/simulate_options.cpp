// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulate_options.hpp"

#include "command_line.hpp"
#include "option_checks.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <initializer_list>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap::app {
namespace {

/// Kinds of rough noise.
Check rough_kinds() {
  return {[](const std::string& text) -> std::string {
            try {
              (void)parse_rough(text);
              return "";
            } catch (const std::invalid_argument& error) {
              return error.what();
            }
          },
          ""};
}

void add_driving_options(const Command& command, SimulateOptions& options) {
  const auto add_pair = [&](const char* name, std::vector<double>& value, const char* help) {
    command.add_option(name, value, help)
        .delimiter(',')
        .expected(2)
        .check(above_zero())
        .capture_default_str();
  };
  add_pair("--speeds", options.speeds, "Slowest and fastest leg [m/s], like 0.25,0.9");
  add_pair("--turn-rates", options.turn_rates,
           "Slowest and fastest turn on the spot [rad/s], like 0.3,1.1");
  command
      .add_option("--ramp", options.ramp,
                  "Time in which a drive reaches its speed and leaves it [s]")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option("--overrun", options.overrun,
                  "How far the robot drives on before it turns, so that it sees landmarks in "
                  "passing [m]; 0.4 with a delay of the sightings, else 0")
      .check(zero_or_more());
  command
      .add_option("--covariate", options.covariates,
                  "A further column, between 0 and 1, anew at one stop in two; payload_kg, lights "
                  "and temperature_C are always there; again for more")
      .type_name("NAME")
      .one_value_each();
}

void add_world_options(const Command& command, SimulateOptions& options) {
  command.add_option("--mesh", options.mesh, "Landmarks along x and along y, like 6x6")
      .type_name("NxN")
      .capture_default_str();
  command.add_option("--spacing", options.spacing, "Distance between neighbours [m]")
      .check(above_zero())
      .capture_default_str();
  command.add_flag("--uneven", options.uneven,
                   "Random distances (0.6 to 1.4 of the spacing) and landmarks a little off the "
                   "lines");
  command
      .add_option("--walk", options.walk, "How a tour covers the routes; each tour is drawn anew")
      .check(one_of({"euler", "face", "depth-first", "random"}))
      .capture_default_str();
  command.add_option("--tours", options.tours, "Number of tours")
      .check(whole_number(1))
      .capture_default_str();
  command
      .add_option("--seed", options.seed,
                  "The same seed gives the same recording; --hide without it draws one")
      .check(whole_number(0))
      .capture_default_str();
  command.add_flag("--rests", options.rests, "Rest for 2 to 20 s at one stop in ten");
  command
      .add_option("--full-turns", options.full_turns,
                  "Stops at which the robot turns round twice to the left and twice to the right")
      .check(whole_number(0))
      .capture_default_str();
  command
      .add_option("--plan", options.plan_file,
                  "Drive these waypoints (trussmap plan --out) in place of tours, as a further "
                  "session of the world and robot of --seed, with noise of its own; without --mesh "
                  "the waypoints' own places are the landmarks. Tours then matter for --hide alone")
      .type_name("FILE");
  add_driving_options(command, options);
}

void add_positive(const Command& command, const char* name, double& value, const char* help) {
  command.add_option(name, value, help).check(above_zero()).capture_default_str();
}

void add_wheel_options(const Command& command, SimulateOptions& options) {
  command
      .add_option("--drive", options.drive,
                  "How wheels move the robot: two wheels, or others with the columns that "
                  "docs/formats.md names (wheels: four omni wheels across its diagonals)")
      .check(one_of({"differential", "unicycle", "skid-steer", "tricycle", "ackermann", "omni3",
                     "mecanum", "wheels"}))
      .capture_default_str();
  command
      .add_option("--wheelbase", options.wheelbase,
                  "Distance of the wheels on the left from those on the right [m]")
      .check(length_of_robot())
      .capture_default_str();
  command
      .add_option("--length", options.length,
                  "From the rear axle to the steered wheel (tricycle, ackermann: 0.5) or to the "
                  "front axle (mecanum: 0.3), from the centre to a wheel (omni3, wheels: 0.2) [m]")
      .check(length_of_robot());
  command.add_option("--wheel-left", options.wheel_left,
                     "How far to the left of the rear axle's centre the measured wheel of an "
                     "ackermann robot is [m]");
  command.add_option("--steer-left", options.steer_left,
                     "How far to the left of the middle the wheel is whose steering angle is read "
                     "(tricycle, ackermann) [m]");
}

void add_noise_options(const Command& command, SimulateOptions& options) {
  add_positive(command, "--wheel-noise", options.wheel_noise,
               "k of each wheel [m^1/2]: a travel d is recorded with variance k^2 |d|");
  add_positive(command, "--steer-noise", options.steer_noise,
               "Noise of the steering [rad m^1/2]: of the mean angle over a metre");
  add_positive(command, "--compass-noise", options.compass_noise,
               "Standard deviation of a reading [rad]");
  add_positive(command, "--sighting-noise", options.sighting_noise,
               "How far off a landmark the robot stops [m, standard deviation per coordinate]");
  add_positive(command, "--survey-noise", options.survey_noise,
               "Standard deviation of the survey [m per coordinate]");
  command.add_flag("--noise-free", options.noise_free,
                   "Leave all noise out of the recording (model.toml still states it)");
  command
      .add_option(
          "--rough", options.rough,
          "Noise other than model.toml states, one or more with commas between: half (wheels "
          "and compass: twice as large), memory (the wheels' errors last 1 s), haze (the "
          "compass's 2 s), tails (wheels and compass: Student's t with 3 degrees of freedom), "
          "floor (each leg misreads its travel by 0.4 %, its turns by 1 %), or all")
      .type_name("KINDS")
      .check(rough_kinds())
      .excludes("--noise-free");
}

void add_sensor_options(const Command& command, SimulateOptions& options) {
  command.add_flag("--no-compass", options.no_compass, "The robot has no compass");
  command.add_flag("--gyro", options.gyro,
                   "The robot has a gyro: drive.csv gets a column yaw_rate");
  add_positive(command, "--gyro-noise", options.gyro_noise,
               "Angle random walk of the gyro [rad/s^1/2]: how its heading errs after a second");
  command
      .add_option("--gyro-walk", options.gyro_walk,
                  "How the gyro's bias walks [rad/s per s^1/2]; model.toml does not state it")
      .check(zero_or_more())
      .capture_default_str();
  command.add_flag(
      "--range-sensor", options.range_sensor,
      "From each stop the robot also sees landmarks in reach (half of them, at random) "
      "by range (within 0.05 m) and bearing (within 0.02 rad)");
  command
      .add_flag("--beacons", options.ranges_alone,
                "The same by ranges alone, as radio beacons are seen")
      .excludes("--range-sensor");
  command
      .add_flag("--camera", options.bearings_alone, "The same by bearings alone, as a camera sees")
      .excludes("--range-sensor")
      .excludes("--beacons");
  command
      .add_option("--fixes", options.fix_rate,
                  "A receiver also gives the place of its antenna so often [Hz] (fixes.csv)")
      .check(between(0.0, 1000.0));
  add_positive(command, "--fix-noise", options.fix_noise,
               "Standard deviation of a fix [m per coordinate]");
  command.add_flag("--loops", options.loops,
                   "At each stop the robot also measures its pose from its last stop at the same "
                   "landmark, as scan matching does (loops.csv)");
  add_positive(command, "--loop-noise", options.loop_noise,
               "Standard deviation of a loop [m per coordinate]");
  add_positive(command, "--loop-heading-noise", options.loop_heading_noise,
               "Standard deviation of a loop's turn [rad]");
  command.add_flag("--markers", options.markers,
                   "Landmarks have an axis, as tags and floor codes do: each sighting also reads "
                   "its yaw, and the survey its heading");
  add_positive(command, "--yaw-noise", options.yaw_noise,
               "Standard deviation of a landmark's yaw [rad]");
  command
      .add_option("--scans", options.scan_every,
                  "Scan matching also tells the motion from scan to scan, so long each [s] "
                  "(loops.csv)")
      .check(zero_or_more());
  const auto add_place = [&](const char* name, std::vector<double>& place, int count,
                             const char* help) {
    command.add_option(name, place, help)
        .delimiter(',')
        .expected(count)
        .check(length_to_place())
        .type_name(count == 2 ? "X,Y" : "X,Y,YAW");
  };
  add_place("--sensor", options.sensor, 3,
            "Where the sensor of sightings sits, as model.toml states it: ahead of the axle's "
            "centre, to its left [m], looking so far to the left [rad]");
  add_place("--antenna", options.antenna, 2, "Where the antenna sits that fixes are of [m]");
  add_place("--scanner", options.scanner, 3,
            "Where the scanner sits whose motion loops tell, and looks");
  add_positive(command, "--reach", options.reach, "Reach of the range sensor [m]");
}

}  // namespace

void check_drive_options(const Command& command, const SimulateOptions& options) {
  const auto refuse_unless = [&](const char* option, std::initializer_list<const char*> drives) {
    const bool has_it = std::find(drives.begin(), drives.end(), options.drive) != drives.end();
    if (has_it || command.count(option) == 0) return;
    throw UsageError(fmt::format("simulate: {} is not of drive {}, expected one of {}", option,
                                 options.drive, fmt::join(drives, ", ")));
  };
  refuse_unless("--wheelbase", {"differential", "unicycle", "skid-steer", "mecanum"});
  refuse_unless("--length", {"tricycle", "ackermann", "omni3", "mecanum", "wheels"});
  refuse_unless("--wheel-left", {"ackermann"});
  refuse_unless("--steer-left", {"tricycle", "ackermann"});
  refuse_unless("--steer-noise", {"tricycle", "ackermann"});
}

Mountings mounted_by(const SimulateOptions& options) {
  const auto place = [](const std::vector<double>& at) -> std::optional<Mounting> {
    if (at.empty()) return std::nullopt;
    return Mounting{at[0], at[1], at.size() > 2 ? at[2] : 0.0};
  };
  Mountings mounted;
  mounted.sensor = place(options.sensor);
  mounted.antenna = place(options.antenna);
  mounted.scanner = place(options.scanner);
  return mounted;
}

void add_simulate_options(const Command& command, SimulateOptions& options) {
  add_world_options(command, options);
  add_wheel_options(command, options);
  add_noise_options(command, options);
  add_sensor_options(command, options);
  add_effect_options(command, options.effects);
  command.add_flag("--true-rates", options.true_rates,
                   "Let effects of speed and turn_rate follow the true rates; otherwise the "
                   "recorded ones, so that a fit finds their values exactly");
  command
      .add_flag("--hide", options.hide,
                "Draw one or two effects from the catalogue; truth.json seals which (see reveal)")
      .excludes("--effect")
      .excludes("--effects");
  command.footer(catalogue_text());
  command.add_flag("--no-survey", options.no_survey, "Write no survey.csv");
  command
      .add_option("--out", options.out,
                  "Folder to write drive.csv, sightings.csv, survey.csv, fixes.csv (with --fixes), "
                  "loops.csv (with --loops) and model.toml to; a recording that is there already "
                  "is replaced")
      .required()
      .type_name("DIR");
  command.add_option("--json", options.json, "Write every figure as JSON").type_name("FILE");
}

}  // namespace trussmap::app
