// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// A recording as a folder of CSV streams: drive.csv, sightings.csv, fixes.csv, loops.csv,
// survey.csv, truth.csv (their columns: recording.hpp; angles in rad, lengths in m, times in s).
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/test_path.hpp"
#include "trussmap/umbmark.hpp"
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

/// The streams that the recording has (a drive always, and it may be alone), in place of all that
/// an earlier recording left in the folder. `comment`, if any, becomes # lines at the top of
/// drive.csv; `beside` are further files, by name and content. Numbers read back exactly. Throws
/// InputError where read_recording() would refuse the folder, of a drive alone as one.
[[nodiscard]] FolderOfFiles recording_folder(const std::filesystem::path& folder,
                                             const Recording& recording,
                                             const std::string& comment = "",
                                             NamedTexts beside = {});

/// Writes that folder, whole or not at all, as write_files() does.
void write_recording(const std::filesystem::path& folder, const Recording& recording,
                     const std::string& comment = "", const NamedTexts& beside = {});

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

// ----------------------------------------
// A planned drive (test_path.hpp) as a table, a row per waypoint, in the order driven:
//
//   number,landmark,x,y,heading,speed,bend,turn,turn_rate,stop_s[,LOAD ...]   m, rad, m/s, rad/s, s
//
// Columns in any order; all that are named above are columns that the driver sets.

/// Throws InputError with file and line: what CsvReader refuses, fewer than two waypoints, numbers
/// that do not count from 1, the same landmark twice running, a speed or rate that is not above 0
/// where something is driven or turned, a bend above a radian.
[[nodiscard]] DrivePlan read_plan(const std::filesystem::path& file);
/// Numbers read back exactly.
[[nodiscard]] std::string format_plan(const DrivePlan& plan);
/// A FeatureCollection: a Point per waypoint, a LineString per leg; metres in the map frame.
[[nodiscard]] std::string format_plan_geojson(const DrivePlan& plan);

}  // namespace trussmap
