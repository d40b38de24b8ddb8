// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Mistakes of meaning in recordings: what can be read, and is not what it should be. Units, signs
// and axes, names, clocks, surveys of something else. Without a fit: what one column says is
// compared with what another one says of the same motion, so that a check costs next to nothing.
//
//   compass    turns of its readings       against those of the wheels
//   sightings  where a landmark is seen    against where the wheels have led the robot since
//   survey     from landmark to landmark   against the way driven, and against views of both
//   truth      motion and heading          against the wheels
//   gyro, fixes   turns, corners           against the wheels
//   ranges     places by surveyed beacons  against the wheels
//   times      of each file                against the drive's, and what robots do in a row
//
// Of a drive with other wheels than two, the body's motion by its columns stands for the wheels,
// and mistakes with single columns are looked for: signs, order, a steering angle in degrees.
//
// A quantity is reported where it contradicts another by far more than any robot's errors, and one
// mistake explains all that is contradicted. Where several would, the finding names them all.
//
// Of pose graphs: what a quick fit says of the graph as it stands is compared with what it would
// say without a mistake. Near linear in edges.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/recording.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct CheckFinding {
  std::string file;      ///< of a recording's folder, the model's, or a pose graph's
  std::string column;    ///< one, or several with commas; empty: the file as a whole
  std::string kind;      ///< one of check_kinds(), or of check_graph_kinds()
  std::string evidence;  ///< what it looks like, with figures
  std::string remedy;
};

/// What check_recordings can find.
[[nodiscard]] const std::vector<std::string>& check_kinds();

/// Findings by recording, the columns of drives first. Without a model the wheelbase is found from
/// the compass where there is one. Recordings are read_recording's, or as well formed
/// (recording.hpp; otherwise std::invalid_argument); columns that the model names are taken in as
/// with_wheels does, if they are not yet, and it throws as that does. `model_file` is named in
/// findings of the model.
[[nodiscard]] std::vector<CheckFinding> check_recordings(const std::vector<Recording>& recordings,
                                                         const Model* model = nullptr,
                                                         const std::string& model_file = "");

/// The same, and of the files of recordings that were read from the folders they are named after:
/// a last row that was cut off. InputError where one has changed since and can no longer be read.
[[nodiscard]] std::vector<CheckFinding> check_read_recordings(
    const std::vector<Recording>& recordings, const Model* model = nullptr,
    const std::string& model_file = "");

struct MendedRecording {
  Recording recording;
  std::vector<std::string> notes;  ///< what was put right, a line each
};

/// A recording as read, without what check_recordings names and can be put right by itself: of a
/// counter that was wrong in some samples the two rows share what they travel together, rows that
/// stand twice stand once, later times count on where the clock was set. `model` where it names the
/// columns that are wheels; throws as with_wheels does.
[[nodiscard]] MendedRecording mended(Recording recording, const Model* model = nullptr);

/// What check_graph can find.
[[nodiscard]] const std::vector<std::string>& check_graph_kinds();

/// Loops the wrong way round, information in another order than documented (where it was read by
/// InformationOrder::either), covariance for information, degrees, identity information, duplicate
/// edges, vertices that nothing ties or holds. `file` is named in findings. Throws
/// std::invalid_argument on a graph without edges or with a fault (find_fault).
[[nodiscard]] std::vector<CheckFinding> check_graph(const PoseGraph& graph,
                                                    const std::string& file);

/// "DIR/drive.csv, left,right: ...; remedy: ...": one line.
[[nodiscard]] std::string in_words(const CheckFinding& finding);

}  // namespace trussmap
