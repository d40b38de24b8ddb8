// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Recordings of a simulated robot: a mesh of landmarks, a walk on it, the true motion, and what a
// robot with driven wheels, a compass and landmark recognition records on its way.
//
//   y ^   L0_2 ---- L1_2 ---- L2_2        columns along x, rows along y; L{column}_{row}
//     |    |         |         |          landmark number = column * rows + row, so that numbers
//     |   L0_1 ---- L1_1 ---- L2_1        and names have the same order
//     |    |         |         |          routes join neighbours of a column or a row
//     |   L0_0 ---- L1_0 ---- L2_0        v0 is landmark 0, the corner L0_0
//     +------------------------------> x
//
// Motion. At every landmark: rest perhaps, spin to the next leg's first direction, drive. A leg is
// a gentle bow or S, or has a corner with a spin half-way; the true stop lies a little off the
// landmark. In each row speed and turn rate are constant, so that a row is an arc. Robots whose
// wheels have rollers drive legs at an angle to ahead, robots that steer some of them backwards;
// in place of a spin these turn in arcs, to and fro where they steer as a car does.
//
//   v, w       speed [m/s] and turn rate [rad/s] of the body's reference point (of two wheels the
//              axle's centre), constant within a row
//   B          distance of the wheels                                            m
//   v -+ wB/2  speed of the left and right wheel over the floor                  m/s; of other
//              wheels each the way of its own place in the rigid body
//   k          wheel noise: a row's travel d is recorded with variance k^2 |d|   m^(1/2)
//   q          steering noise: a row's angle with variance q^2/|d|               rad m^(1/2)
//
// The compass is read at the end of each row and wrapped to (-pi, pi]. At every stop the robot
// sights the landmark it stands on, and with a range sensor some of the others in reach. Each kind
// of noise has a random stream of its own: leaving one sensor out, or its noise, changes nothing in
// the others. Noise may also be rough, other than stated. Physical effects change what the sensors
// say of the true motion; a coefficient is exact: without noise, the same effect in a model
// explains the recording fully. No formula here is one of an estimator's.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/test_path.hpp"

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

struct MeshSize {
  int columns = 0;  ///< landmarks along x
  int rows = 0;     ///< landmarks along y
};

struct MeshRoute {
  int from = -1;  ///< landmark
  int to = -1;    ///< landmark, to the right of `from` or above it; of a polygon the next corner
};

/// A mesh of a single column or row is a line of landmarks; two landmarks are the least. A polygon
/// is a row whose ends are joined.
struct Mesh {
  MeshSize size;
  std::vector<Vector2> positions;  ///< true landmark positions, m
  std::vector<MeshRoute> routes;   ///< every pair of neighbours once
  std::vector<std::string> names;  ///< of the landmarks; empty: by column and row

  [[nodiscard]] int landmarks() const { return size.columns * size.rows; }
  [[nodiscard]] int landmark(int column, int row) const { return column * size.rows + row; }
  [[nodiscard]] int column(int landmark) const { return landmark / size.rows; }
  [[nodiscard]] int row(int landmark) const { return landmark % size.rows; }
  /// From one landmark to another, m.
  [[nodiscard]] Vector2 displacement(int from, int to) const {
    return positions[static_cast<std::size_t>(to)] - positions[static_cast<std::size_t>(from)];
  }
};

/// "6x6": columns, then rows. Throws std::invalid_argument on anything else, and on fewer than two
/// or more than a million landmarks.
[[nodiscard]] MeshSize parse_mesh_size(std::string_view text);

/// Equal spacing [m] both ways, v0 at the origin.
[[nodiscard]] Mesh even_mesh(MeshSize size, double spacing);

/// Columns at the given x, rows at the given y [m], both increasing.
[[nodiscard]] Mesh mesh_of_lines(const std::vector<double>& x, const std::vector<double>& y);

/// A regular polygon of 3 to 10^6 corners with sides of this length [m]: v0 at the origin, its
/// first side along +x, counter-clockwise.
[[nodiscard]] Mesh regular_polygon(int corners, double side);

/// `count` coordinates from 0 on, with gaps drawn uniformly from [shortest, longest] m.
[[nodiscard]] std::vector<double> random_lines(int count, double shortest, double longest,
                                               std::mt19937_64& random);

/// The mesh with every landmark moved by up to `reach` m along x and along y, uniformly. The reach
/// must leave neighbours apart: below half the shortest route.
[[nodiscard]] Mesh jittered(Mesh mesh, double reach, std::mt19937_64& random);

/// "L{column}_{row}", where it has no name of its own.
[[nodiscard]] std::string landmark_name(const Mesh& mesh, int landmark);

/// Length of the shortest route, m.
[[nodiscard]] double shortest_route(const Mesh& mesh);

/// How a tour covers every route at least once. Golfarelli, Maio & Rizzi (1998), section 4, leave
/// it open.
enum class WalkKind {
  euler,         ///< every route once, some of the perimeter's twice; closed at v0; drawn anew
  face_by_face,  ///< faces row after row, there and back, each walked round
  depth_first,   ///< an undriven route, at random, else by the shortest way to one
  random         ///< uniform among the routes that meet here
};

/// "euler", "face", "depth-first" or "random"; std::invalid_argument on another name.
[[nodiscard]] WalkKind parse_walk_kind(std::string_view name);

/// The last landmark of a tour is the first of the next, so that tour k goes from ends[k - 1] (0
/// for the first) to ends[k].
struct Tours {
  std::vector<int> walk;          ///< landmarks met, first and last included
  std::vector<std::size_t> ends;  ///< index into `walk` of each tour's last landmark
};

/// `count` tours one after the other, each a walk of its own from where the last one ended; a walk
/// that starts at v0 is reached by the shortest way.
[[nodiscard]] Tours make_tours(const Mesh& mesh, WalkKind kind, int count, std::mt19937_64& random);

/// What else was the case during a row: the covariate columns.
struct Surroundings {
  double payload_kg = 0.0;
  double lights = 0.0;  ///< 1 switched on, 0 off
  double temperature_C = 20.0;
};

/// How a leg is to be driven, in place of what would be drawn: the robot stands, turns on the spot
/// (in circles where it cannot), drives.
struct LegOrder {
  double rest = 0.0;            ///< s
  double turn = 0.0;            ///< rad, + to the left; what is needed to set out, and whole turns
  double turn_rate = 0.5;       ///< rad/s
  double speed = 0.5;           ///< m/s
  double bend = 0.0;            ///< rad that it turns on its way, + to the left, at most a radian
  Surroundings surroundings;    ///< from its rest on; the temperature goes its own way
  std::vector<double> further;  ///< values of DrivingStyle::covariates
};

/// How the robot drives. Ranges are drawn from uniformly, anew for each leg or spin.
struct DrivingStyle {
  double row_duration = 0.1;       ///< s
  double slowest = 0.25;           ///< m/s
  double fastest = 0.9;            ///< m/s
  double slowest_turn = 0.3;       ///< rad/s, on the spot
  double fastest_turn = 1.1;       ///< rad/s
  double bend = 0.15;              ///< rad, standard deviation of each of a leg's three bends
  double corner_share = 0.1;       ///< fraction of legs with a corner half-way
  double corner_reach = 0.15;      ///< how far the corner lies off the straight leg, of its length
  double rest_share = 0.0;         ///< fraction of stops with a rest
  double shortest_rest = 2.0;      ///< s
  double longest_rest = 20.0;      ///< s
  int full_spins = 0;              ///< stops, spread evenly, with two full turns left, two right
  double standing = 0.005;         ///< m per coordinate, standard deviation of stop - landmark
  double load_change_share = 0.7;  ///< chance of another payload for the next leg
  double lights_change_share = 0.5;
  double first_rest = 0.0;  ///< s, before the first sighting
  double last_rest = 0.0;   ///< s, after the last
  double overrun = 0.0;     ///< m driven straight on after each landmark, before the spin
  double ramp = 0.0;        ///< s in which a drive reaches its speed, and leaves it
  std::vector<std::string> covariates;  ///< further columns: anew at one stop in two, from 0 to 1
  std::vector<LegOrder> orders;         ///< one per leg of the walk; empty: all is drawn
  double first_heading = 0.0;           ///< rad
};

enum class Activity { rest, spin, drive };

/// One odometry interval of true motion.
struct TrueRow {
  double t = 0.0;          ///< s, end of the interval
  double duration = 0.0;   ///< s
  double speed = 0.0;      ///< m/s, constant within the row
  double turn_rate = 0.0;  ///< rad/s, constant within the row
  Activity activity = Activity::rest;
  Pose pose;  ///< at t; heading not wrapped
  Surroundings surroundings;
  double slip_speed = 0.0;  ///< m/s to its left, constant within the row
  double jump = 0.0;        ///< m ahead beside its speed, all through the row
  double sideways = 0.0;    ///< m/s to its left as its wheels drive it, constant within the row
};

/// The robot at a landmark.
struct TrueStop {
  double t = 0.0;        ///< s, the end of a row, or the start of the first
  int landmark = -1;     ///< of the mesh
  std::size_t rows = 0;  ///< rows driven until then
  Pose pose;             ///< true pose of the axle; its position is off the landmark's
};

struct TrueMotion {
  Pose start;  ///< before the first row, at time 0
  std::vector<TrueRow> rows;
  std::vector<TrueStop> stops;     ///< one per landmark of the walk
  std::vector<Covariate> further;  ///< what else was the case, one value per row
  std::vector<int> segments;       ///< rows of each rest, spin, arc and drive, in order
  std::vector<double> turns;       ///< rad, about, of each turn in arcs, in order
};

/// Standard deviations; the stop's distance from its landmark is part of the path
/// (DrivingStyle::standing).
struct SensorNoise {
  double left = 0.003;         ///< k of the left wheel, m^(1/2)
  double right = 0.003;        ///< m^(1/2); k^2 of other wheels is the mean of both
  double compass = 0.02;       ///< rad per reading
  double range = 0.05;         ///< m
  double bearing = 0.02;       ///< rad
  double survey = 0.001;       ///< m per coordinate
  double fix = 0.05;           ///< m per coordinate
  double gyro = 0.001;         ///< rad/s^(1/2), angle random walk
  double gyro_walk = 0.0;      ///< rad/s per s^(1/2): how the bias walks
  double loop = 0.05;          ///< m per coordinate
  double loop_heading = 0.01;  ///< rad
  double yaw = 0.02;           ///< rad, of a landmark's yaw and of its surveyed heading
  double steer = 0.005;        ///< rad m^(1/2), of the steering angle
};

/// Exact sensors.
inline constexpr SensorNoise kNoiseFree{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                                        0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

/// Noise that SensorNoise does not state, as real robots have it, to try estimators on. Kinds
/// combine.
struct RoughNoise {
  bool half = false;    ///< wheels and compass: twice as large as stated
  bool memory = false;  ///< wheels: errors last, correlation exp(-lag / 1 s); smaller in each row,
                        ///< so that over a long leg their sum has the variance that is stated
  bool haze = false;    ///< compass: errors last, exp(-lag / 2 s); each has the variance stated
  bool tails = false;   ///< wheels and compass: Student's t, 3 degrees of freedom, same variance
  bool floor = false;   ///< from one landmark to the next the wheels misread all travel by one
                        ///< share (sd 0.4 %) and all turning by another (sd 1 %)
};

/// "half,haze", or "all". Throws std::invalid_argument, listing all names, on any other.
[[nodiscard]] RoughNoise parse_rough(std::string_view text);

/// Names of the kinds that it has.
[[nodiscard]] std::vector<std::string> rough_names(const RoughNoise& rough);

/// What the range sensor says of a landmark.
enum class SensorParts {
  both,
  range_alone,   ///< as radio beacons have it
  bearing_alone  ///< as a camera has it
};

/// A robot of this drive as it might be built, columns named: wheelbase 0.34 m; length 0.5 m
/// (tricycle, ackermann), 0.2 m (omni3) or 0.3 m (mecanum). `wheels` are four omni wheels 0.2 m
/// from the centre that roll at 45 degrees to ahead. Lengths [m] of 0 stay as they are.
[[nodiscard]] Robot usual_robot(DriveKind drive, double wheelbase = 0.0, double length = 0.0);

struct WheeledRobot {
  Robot geometry;  ///< its drive and wheels, nominal and true
  bool compass = true;
  bool gyro = false;
  bool range_sensor = false;
  SensorParts sensor_parts = SensorParts::both;
  double reach = 8.0;        ///< m, range sensor
  double recognition = 0.5;  ///< chance that a landmark in reach is recognised
  double fix_rate = 0.0;     ///< Hz: fixes of its antenna; 0: none
  /// At each stop it also measures its pose from the last stop at the same landmark.
  bool loops = false;
  double scan_every = 0.0;  ///< s: loops from scan to scan, one after the other; 0: none
  /// Landmarks have an axis, as tags and floor codes do: each sighting reads its yaw, and the
  /// survey its heading.
  bool markers = false;
  SensorNoise noise;
  RoughNoise rough;

  [[nodiscard]] bool sees_ranges() const {
    return range_sensor && sensor_parts != SensorParts::bearing_alone;
  }
  [[nodiscard]] bool sees_bearings() const {
    return range_sensor && sensor_parts != SensorParts::range_alone;
  }
};

/// What effects of speed and turn rate depend on: estimators know these by the wheels alone.
enum class Rates {
  true_motion,  ///< how fast the robot really is
  as_recorded,  ///< how fast its wheels say that it is, noise left out: a fit is exact then
};

/// Physical effects on a simulated drive; each with coefficients.
struct SimulatedEffects {
  std::vector<Effect> effects;
  Rates rates = Rates::as_recorded;
};

struct SimulatedDrive {
  Recording recording;
  TrueMotion motion;
};

/// Lays the path along the walk (landmarks of the mesh, successive ones different), records it and
/// adds the survey. The robot starts on the first landmark with its first heading at time 0. Under
/// a delay it rests before the first and after the last sighting, so that they stay within the
/// drive. The same seed gives the same recording. Throws std::invalid_argument on a walk of fewer
/// than two landmarks or of some too near each other (below 20 `standing`, 1 cm, or what the robot
/// needs to turn), a style, robot or noise that makes no sense, and effects that its drive does not
/// have or that leave no travel, a range of 0 or less or a sighting outside the drive. Of other
/// wheels than two the recording has the columns alone (with_wheels takes them in).
[[nodiscard]] SimulatedDrive simulate_drive(const Mesh& mesh, const std::vector<int>& walk,
                                            const DrivingStyle& style, const WheeledRobot& robot,
                                            std::uint64_t seed,
                                            const SimulatedEffects& effects = {});

/// Drives what is planned, its landmarks found by their names: loads beside payload_kg and lights
/// become further columns. Throws as simulate_drive does, and where a landmark is none of the
/// mesh's.
[[nodiscard]] SimulatedDrive simulate_plan(const Mesh& mesh, const DrivePlan& plan,
                                           const DrivingStyle& style, const WheeledRobot& robot,
                                           std::uint64_t seed,
                                           const SimulatedEffects& effects = {});

/// The style with the plan's orders in it.
[[nodiscard]] DrivingStyle style_of_plan(const DrivePlan& plan, DrivingStyle style);

/// One or two effects of the catalogue, drawn for a riddle: of a size that a recording of this walk
/// can show (3 to 6 times what the catalogue calls detectable), and of things that it has: with its
/// sensors, its covariates and its events, and apart from each other. Coefficients have four
/// digits. The same seed gives the same effects. `surveyed`: the survey is written. Throws
/// std::invalid_argument where the recording could show none.
[[nodiscard]] std::vector<Effect> draw_hidden_effects(const Mesh& mesh,
                                                      const std::vector<int>& walk,
                                                      const DrivingStyle& style,
                                                      const WheeledRobot& robot, bool surveyed,
                                                      std::uint64_t seed);

// One seed, many random streams: each use draws from a stream of its own, so that drawing more in
// one place changes nothing in another.

enum class Stream : std::uint32_t {
  mesh = 1,
  walk,
  path,
  wheels,
  compass,
  range,
  survey,
  covariates,
  hidden,
  wheel_tails,
  compass_tails,
  floor,
  fixes,
  gyro,
  loops,
  headings,
  steering
};

[[nodiscard]] inline std::mt19937_64 random_stream(std::uint64_t seed, Stream stream) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                         static_cast<std::uint32_t>(stream)};
  return std::mt19937_64(sequence);
}

/// What the wheels of a row say they have travelled, m.
struct DrivenRow {
  double left = 0.0;
  double right = 0.0;
};

/// Of a robot that turns on the spot at a landmark, by `turn` (rad), and
/// drives straight to the next one, `length` (m), exactly: what its two wheels say, row by row,
/// each travel d with the error k sqrt(|d|) e, e standard normal. `wheelbase` in m, `noise`: k of
/// both wheels, m^(1/2).
[[nodiscard]] std::vector<DrivenRow> drive_route(double turn, double length, double wheelbase,
                                                 double noise, std::mt19937_64& random);

// A robot for rehearsing calibrations with a tape measure: it drives a path exactly by its own
// odometry, and ends where its true wheels and the noise have brought it.
//
//   in small steps: what a wheel truly travels = share x what its odometry counts
//                                                + k sqrt(|what its odometry counts|) x normal
//
// Each step is a rigid motion about the true centre of rotation. The tape adds its own error once
// per run.

struct TapeRobot {
  double wheelbase_believed = 0.34;  ///< m, that its odometry takes for true
  double wheelbase = 0.34;           ///< m, true
  double left_share = 1.0;           ///< true travel of the left wheel per counted travel
  double right_share = 1.0;          ///< the same of the right wheel
  double left_noise = 0.0;           ///< k of the left wheel, m^(1/2)
  double right_noise = 0.0;          ///< k of the right wheel, m^(1/2)
  double step = 0.05;                ///< m: longest wheel travel per step, where there is noise
  double tape_sd = 0.0;              ///< m, per coordinate of a measured end position
  double tape_heading_sd = 0.0;      ///< rad, of a measured end heading
};

/// A robot of this nominal wheelbase (m) whose right wheel is `diameter_ratio` times as large as
/// its left (their mean as believed) and whose true wheelbase is `wheelbase_ratio` times as wide.
[[nodiscard]] TapeRobot misbuilt_robot(double wheelbase, double diameter_ratio,
                                       double wheelbase_ratio);

/// The robot once its software divides its counts by these shares and believes this wheelbase (m).
[[nodiscard]] TapeRobot reprogrammed(const TapeRobot& robot, double left_share, double right_share,
                                     double wheelbase_believed);

/// End error of one run, absolute - calculated, in the frame of the start; the heading is not
/// wrapped. Throws std::invalid_argument on a wheelbase or step that is not above 0.
[[nodiscard]] Pose drive_once(const TapeRobot& robot, const TestPath& path,
                              std::mt19937_64& random);

[[nodiscard]] std::vector<Pose> drive_often(const TapeRobot& robot, const TestPath& path, int runs,
                                            std::mt19937_64& random);

}  // namespace trussmap
