// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A recording as a folder of CSV streams: drive.csv, sightings.csv, fixes.csv, loops.csv,
// survey.csv, truth.csv (their columns: recording.hpp; angles in rad, lengths in m, times in s).
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wall_distances.hpp"
#include "trussmap/wheel_noise.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {

/// Reads a folder, strictly: InputError with file and line for whatever is wrong, nothing is
/// guessed. sightings.csv may be absent only where there is a truth.csv, fixes.csv or loops.csv, or
/// where a drive alone will do.
[[nodiscard]] Recording read_recording(const std::filesystem::path& folder,
                                       bool drive_alone = false);

/// What a covariate may be called: a letter, then letters, digits and _, and no name that shapes or
/// columns have.
[[nodiscard]] bool is_covariate_name(std::string_view name);

/// Texts by the names of their files.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// The streams that the recording has (a drive always; sightings unless there is none, but truth,
/// fixes or loops), in place of all that an earlier recording left in the folder. `comment`, if
/// any, becomes # lines at the top of drive.csv; `beside` are further files, by name and content.
/// Numbers read back exactly. Throws InputError where read_recording() would refuse the folder.
[[nodiscard]] FolderOfFiles recording_folder(const std::filesystem::path& folder,
                                             const Recording& recording,
                                             const std::string& comment = "",
                                             NamedTexts beside = {});

/// Writes that folder, whole or not at all, as write_files() does.
void write_recording(const std::filesystem::path& folder, const Recording& recording,
                     const std::string& comment = "", const NamedTexts& beside = {});

// ----------------------------------------
// The UTIAS multi-robot data sets (MRCLAM: Leung, Halpern, Barfoot & Liu, 2011) as recordings.
//
//   DIR/RobotN_Odometry.dat      time, forward velocity [m/s], angular velocity [rad/s]
//   DIR/RobotN_Measurement.dat   time, barcode, range [m], bearing [rad]
//   DIR/Barcodes.dat             subject, barcode: subjects 1-5 are robots, the rest landmarks
//   DIR/Landmark_Groundtruth.dat subject, x, y, sd of x, sd of y       (optional)
//   DIR/RobotN_Groundtruth.dat   time, x, y, heading                   (optional)
//
// each plain or with .xz. A velocity holds from its row's time until the next row's. Times that
// repeat or run backwards are merged into the row before; sightings of robots, of unknown barcodes
// and outside of the drive are dropped; sightings within 5 ms of one another are one camera frame
// and get its first time. All of that is counted. Times are counted from the epoch, a whole second.

struct MrclamRecording {
  Recording recording;
  Model model;  ///< the maker's wheelbase and noise that suits these robots

  double epoch = 0.0;           ///< s, Unix time of t = 0
  int merged_times = 0;         ///< odometry rows whose time repeats or runs backwards
  int robots_seen = 0;          ///< sightings of other robots, dropped
  int unknown_barcodes = 0;     ///< sightings of barcodes that belong to nothing, dropped
  int outside_drive = 0;        ///< sightings before or after the odometry, dropped
  int same_frame = 0;           ///< sightings whose time was set to their frame's
  int unordered_sightings = 0;  ///< sightings earlier than the one before, sorted in
};

/// True if `prefix` (DIR/RobotN) names such files, complete or not.
[[nodiscard]] bool is_mrclam(const std::filesystem::path& prefix);

/// Throws InputError with file and line.
[[nodiscard]] MrclamRecording read_mrclam(const std::filesystem::path& prefix);

// ----------------------------------------
// OptiOdom runs (Sousa, Petry, Costa & Moreira, 2022) as recordings.
//
//   SET_run-NN.csv   time [s], x, y [m], heading [rad], and of the cycle that ends then
//                      diff     ticks of the right wheel, of the left wheel
//                      tricyc   ticks of the steered wheel, its angle [rad]
//                      omni3    ticks of the three wheels
//                    no header; plain or .xz
//   SET_metadata.csv beside it: type, ngear, encRes (counts per turn of the motor), ...
//
// Nominal: wheels of 0.084 m and a wheelbase of 0.20 m; a wheel of 0.065 m, 0.15 m before the rear
// axle; wheels of 0.102 m, 0.195 m from the centre. With other wheels than two the drive's columns
// are covariates, and the model names them. (The metadata's own Li and Di are
// what the controller believed during the set.) There are no landmarks: truth.csv takes their
// place.

struct OptiOdomRecording {
  Recording recording;
  Model model;  ///< nominal wheelbase, and noise that suits this robot and its motion capture
  double metre_per_tick = 0.0;
};

/// True if the file's name is that of a run: ..._run-NN.csv or ..._run-NN.csv.xz.
[[nodiscard]] bool is_optiodom(const std::filesystem::path& file);

/// Throws InputError with file and line.
[[nodiscard]] OptiOdomRecording read_optiodom(const std::filesystem::path& file);

// ----------------------------------------
// Ranges to radio beacons along a drive (Djugash, Hamner & Roth, 2009; "Plaza1") as a recording.
//
//   PREFIX_DR.txt   time [s], distance [m] and turn [rad] since the row before
//   PREFIX_TD.txt   time [s], antenna, beacon, range [m]
//   PREFIX_GT.csv   time [s], x, y [m], heading [rad]; may be absent
//
// Plain or .xz. Of the wheels nothing is stated: they are those of a robot with a wheelbase of 1 m
// that drives and turns so. Ranges are sorted by time, those outside of the drive are dropped.

struct RangeRecording {
  Recording recording;
  Model model;  ///< that wheelbase, and noise that suits such radios

  double epoch = 0.0;        ///< s, time of t = 0
  int outside_drive = 0;     ///< ranges before or after the odometry, dropped
  int unordered_ranges = 0;  ///< ranges earlier than the one before, sorted in
};

/// True if `prefix` (DIR/NAME) names such files, complete or not.
[[nodiscard]] bool is_radio_ranges(const std::filesystem::path& prefix);

/// Throws InputError, with the line where there is one.
[[nodiscard]] RangeRecording read_radio_ranges(const std::filesystem::path& prefix);

// ----------------------------------------
// Drives with places that look alike (TUC SLAM: Neubert, Schubert & Protzel, 2019) as recordings.
//
//   PREFIX_Input.txt   odom2 time [s], velocity ahead and to the left [m/s], turn rate [rad/s],
//                      three variances; loop time, time [s], similarity
//
// Plain or .xz. A velocity holds from its row's time until the next row's; what is to the left is
// the motion of a point off the axle, and passed over. A loop says that the robot is at the same
// pose, to what its model says; many are wrong. Of wheels nothing is stated, as above.

struct PlaceLoopRecording {
  Recording recording;
  Model model;  ///< that wheelbase, and noise that suits such loops

  int outside_drive = 0;  ///< loops with an end before or after the odometry, dropped
};

/// True if `prefix` (DIR/NAME) names such a file.
[[nodiscard]] bool is_place_loops(const std::filesystem::path& prefix);

/// Throws InputError, with the line where there is one.
[[nodiscard]] PlaceLoopRecording read_place_loops(const std::filesystem::path& prefix);

// ----------------------------------------
// A truck with steering and GPS (Guivant & Nebot, 2001; "Victoria Park") as a recording.
//
//   PREFIX_dr.mat     time [ms], speed [m/s] of the rear left wheel, steering [rad]
//   PREFIX_gpsx.mat   timeGps [ms], Lo_m, La_m: to the east and to the north [m]
//   victoriaPark.txt  beside them, may be absent: the graph that comes with iSAM, plain or .xz; of
//                     ODOMETRY pose, next pose, dx, dy, dtheta; of LANDMARK pose, tree, x, y
//                     [m, rad, ahead and to the left of the rear axle's centre]
//
// MATLAB files of level 5. A speed and a steering angle hold from their row's time until the next
// row's. The graph has no times; but its odometry is that of the same log, summed up row by row
// from one laser frame to the next, to all its digits: so every edge is found again in the log, and
// its trees are sightings by range and bearing at the ends of rows.

struct TruckRecording {
  Recording recording;
  Model model;  ///< the truck's axles and wheel as stated, and noise that suits it

  int repeated_fixes = 0;  ///< with a time no later than the one before, dropped
  int graph_poses = 0;     ///< found in the log; 0: no graph
};

/// True if `prefix` (DIR/NAME) names such files, complete or not.
[[nodiscard]] bool is_steered_truck(const std::filesystem::path& prefix);

/// Throws InputError.
[[nodiscard]] TruckRecording read_steered_truck(const std::filesystem::path& prefix);

// ----------------------------------------
// Encoders of a tricycle's steered and driven front wheel under a tracker (G. Grisetti, Sapienza
// University of Rome: data of the course Probabilistic Robotics) as a recording.
//
//   #kinematic_model: traction_drive_wheel
//   #parameter_values: Ksteer Ktraction axis_length steer_offset     m, rad
//   #joints_max_enc_values: counts per turn of the steering, of the wheel
//   # translation: [x, y, z], # rotation: [quaternion]               of the tracked sensor
//   time: T ticks: S D model_pose: X Y TH tracker_pose: X Y TH       s, ticks, m, rad
//
// The steering stands at Ksteer 2 pi S/counts + steer_offset (S beyond half a turn counts back),
// the wheel travels Ktraction D/counts. D is an unsigned counter of 32 bits that begins again at 0,
// and comes late by a sample or two: five samples make a row. The truth is the robot's, by where
// the sensor is stated to be. The parameters are first guesses, off by factors: calibrate finds
// them.

struct EncoderLogRecording {
  Recording recording;
  Model model;         ///< the guesses, and noise that suits these counters and their tracker
  double epoch = 0.0;  ///< s, Unix time of t = 0
  int samples = 0;     ///< of which five make a row
};

/// True if the file begins as such a log does (.txt, plain or .xz).
[[nodiscard]] bool is_encoder_log(const std::filesystem::path& file);

/// Throws InputError with file and line.
[[nodiscard]] EncoderLogRecording read_encoder_log(const std::filesystem::path& file);

// ----------------------------------------
// A robot that drives to and fro on a line (Barfoot, "State Estimation for Robotics", 2017, data
// of the exercises: "dataset1") as a recording.
//
//   dataset1.csv   t [s], x_true [m], v [m/s] by the wheels, r [m]: range to a post by laser; a
//                  line of # at the top; plain or .xz
//
// A speed holds from its row's time until the next row's, and is both wheels'; the line is the x
// axis, the landmark "post" stands on it where the authors state it. Its ranges have no bearing,
// for none was measured.

struct LineRecording {
  Recording recording;
  Model model;  ///< a wheelbase of 1 m, which the data do not state, and the authors' noise
};

/// True if the file is called dataset1.csv, or dataset1.csv.xz.
[[nodiscard]] bool is_line_robot(const std::filesystem::path& file);

/// Throws InputError, with the line where there is one.
[[nodiscard]] LineRecording read_line_robot(const std::filesystem::path& file);

// ----------------------------------------
// A pose graph (g2o) as a recording: what SLAM benchmarks are kept in.
//
//   poses, in order of their ids   a second apart, the first at t = 0
//   edge from one to the next      a row of the drive `wheels`, whose columns forward, sideways [m]
//                                  and turn [rad] move the body evenly along one arc
//   every other edge of poses      a loop, with its own standard deviations
//   edge to a point                a sighting by range and bearing, of a landmark named by its id
//
// A recording has one noise for all rows and all sightings: the median of the edges'. The noise of
// a row arises evenly along it. Estimates of the vertices are not read.

struct GraphRecording {
  Recording recording;
  Model model;  ///< the drive, and the noise

  int uneven_edges = 0;  ///< rows whose noise is not half to twice the median
};

/// Throws InputError where consecutive poses have no edge between them, or where there are fewer
/// than three poses or edges between points.
[[nodiscard]] GraphRecording read_graph_recording(const std::filesystem::path& file);

// ----------------------------------------
// A Turtlebot's wheels and gyro under motion capture (PHIL, Worcester Polytechnic Institute, 2018)
// as a recording.
//
//   FOLDER/kobuki_data.csv   left_ticks, right_ticks (65536 is 0 again), time_s, time_ns
//   FOLDER/rio_data.csv      raw_gyro_z [deg/s, counter-clockwise], navx time [ms], and others
//   FOLDER/mocap_robot.csv   frame (100 Hz), rotation vector [rad], position [mm]; # header
//
// Plain or .xz. Counts come late by up to 60 ms: rows are 0.2 s long, where the robot moves, and
// end where a count is fresh. The gyro's clock is set to the wheels', by their turns alone; the
// truth's stays as it is (effect `sighting delay`). Headings are the robot's, not the tracked
// body's.

struct PhilRecording {
  Recording recording;
  Model model;  ///< the maker's wheelbase, and noise that suits these trials

  double epoch = 0.0;          ///< s, Unix time of t = 0
  bool aligned = false;        ///< whether the clocks of wheels and gyro could be compared
  double gyro_late = 0.0;      ///< s that the gyro's times were set back by
  double gyro_likeness = 0.0;  ///< correlation of their turns over 0.3 s then, -1 to 1
  int tick_rows = 0;           ///< rows of counts, of which several make one of the drive
  int stale_samples = 0;       ///< rows that repeat a sample of the gyro
  int lost_frames = 0;         ///< frames without the robot, or where it jumps, left out
};

/// True if the folder has such files, complete or not.
[[nodiscard]] bool is_phil(const std::filesystem::path& folder);

/// Throws InputError with file and line.
[[nodiscard]] PhilRecording read_phil(const std::filesystem::path& folder);

/// 16 hexadecimal digits that two recordings share only if their wheels, compass, gyro, sightings,
/// fixes and loops are the same, to the last bit: whatever the folders are called.
[[nodiscard]] std::string fingerprint(const Recording& recording);
[[nodiscard]] std::string fingerprint(const DrivenRecording& recording);

// ----------------------------------------
// Poses over time as text, for other programs. Numbers read back to the same bits.
//
//   CSV    t,x,y,heading,c_xx,c_xy,c_xh,c_yy,c_yh,c_hh   s, m, rad; covariances in their products
//   TUM    timestamp tx ty tz qx qy qz qw                s, m; tz = 0, the rotation about z alone
//   KITTI  r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz  m; a line per pose, without times

/// The CSV, with a header row. Headings are not wrapped: they go on from row to row.
[[nodiscard]] std::string format_poses(const std::vector<TimedPose>& poses);

/// The trajectory format of the TUM RGB-D benchmark (Sturm et al., 2012), which evo and others
/// read.
[[nodiscard]] std::string format_tum(const std::vector<TimedPose>& poses);

/// The trajectory format of the KITTI odometry benchmark (Geiger et al., 2012): the first three
/// rows of the pose's 4 x 4 matrix, row by row. Axes stay ours: x ahead, y to the left, z up.
/// KITTI's own files are a camera's, x to the right, y down, z ahead; programs that compare two
/// trajectories (evo) take any axes, as long as both have the same.
[[nodiscard]] std::string format_kitti(const std::vector<TimedPose>& poses);

// ----------------------------------------
// Runs of a calibration as tables, one row per run: end errors, absolute - calculated, in the frame
// of the start (x ahead, y to the left).
//
//   square    direction,x,y[,heading]   cw or ccw; m, rad
//   noise     x,y,heading               m, m, rad
//
// Measured in a corner, by distances to two walls [m], both have instead of x, y, heading
//   start1,start2,start3,end1,end2,end3,odometry_x,odometry_y,odometry_heading
// before and after the run, and where the odometry had the end, from the start.
//
//   tape      kind,expected,odometry    straight (m), spin (rad) or rest (0 or nothing)
//             heading, aside            of straight runs: rad, m (trussmap/umbmark.hpp, TapedRun)
//             gyro or yaw_rate          of spins and rests: rad, or rad/s; `heading` without these
//             seconds                   s, of spins and rests
//             sd, sd_odometry, sd_heading, sd_gyro, sd_start   of these
//
// Columns in any order, others are skipped. An error longer than the whole path cannot be one.
// Written by hand: semicolons or tabs may part the fields, and numbers have decimal commas.

/// Throws InputError with file and line: what CsvReader refuses, a direction that is neither cw nor
/// ccw, an error larger than `longest` (m), fewer than two runs in a direction.
[[nodiscard]] SquareRuns read_square_runs(const std::filesystem::path& file, double longest);

/// The same for x, y, heading; headings are brought into (-pi, pi]. Two runs or more.
[[nodiscard]] EndErrors read_end_errors(const std::filesystem::path& file, double longest);

/// Where the three sensors are: faces,x,y[,sd], a row each, in the order of the distances; `faces`
/// is ahead, left, behind or right, x and y [m] in the robot's axes. Throws InputError, also on
/// what check_wall_sensors refuses.
[[nodiscard]] WallSensors read_wall_sensors(const std::filesystem::path& file);

/// The same as read_square_runs, by distances to walls; with headings. Throws InputError on
/// distances that fit no pose, too.
[[nodiscard]] SquareRuns read_square_wall_runs(const std::filesystem::path& file,
                                               const WallSensors& sensors, double longest);

struct MeasuredEnds {
  EndErrors errors;
  Matrix3 covariance = Matrix3::Zero();  ///< of the measurement, m, rad; mean over the runs
};

/// The same as read_end_errors, by distances to walls.
[[nodiscard]] MeasuredEnds read_wall_end_errors(const std::filesystem::path& file,
                                                const WallSensors& sensors, double longest);

/// `degrees`: angles are in degrees. Throws InputError with file and line, also on lengths and
/// turns that only another unit explains, on signs that differ, and on a table without a run.
[[nodiscard]] std::vector<TapedRun> read_taped_runs(const std::filesystem::path& file,
                                                    bool degrees = false);
[[nodiscard]] std::string format_taped_runs(const std::vector<TapedRun>& runs);

/// With headings where all runs have them.
[[nodiscard]] std::string format_square_runs(const SquareRuns& runs);
[[nodiscard]] std::string format_end_errors(const EndErrors& errors);

}  // namespace trussmap
