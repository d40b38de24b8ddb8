// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Results as the command prints them: a verdict, then tables and sentences, a line each, that end
// with an end of line. Same input, same bytes.
//
//   results --comparison_text ...--> what stands on a terminal
//
// `style`: plain, or with the colours of a terminal (ANSI): the verdict's word in its colour,
// headings of tables dim. A caller that prints knows which one suits.
#pragma once

#include "trussmap/build_map.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/check.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/monitor.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/session.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/table.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

struct RunContrast;

enum class TextStyle { plain, coloured };

// Parts.

enum class Mood { good, doubt, bad };

/// A sentence that begins with its verdict, "misfit: ...": the word up to the colon in colour and
/// bold; all of it where there is no colon. Without an end of line.
[[nodiscard]] std::string verdict_text(Mood mood, std::string_view sentence, TextStyle style);
/// format_table, its heading dim.
[[nodiscard]] std::string table_text(const TextTable& table, TextStyle style);
/// "warning: ..." and an end of line.
[[nodiscard]] std::string warning_text(std::string_view warning, TextStyle style);
/// One each, after an empty line; nothing where there are none.
[[nodiscard]] std::string warnings_text(const std::vector<std::string>& warnings, TextStyle style);
/// "note: ...", a line each.
[[nodiscard]] std::string notes_text(const std::vector<std::string>& notes);

/// Noise that was estimated: a line and, where anything is not as stated, a table.
[[nodiscard]] std::string noise_text(const FittedNoise& noise, TextStyle style = TextStyle::plain);
/// What dead reckoning owes to each source, after an empty line; nothing where there is one alone.
[[nodiscard]] std::string budget_text(const std::vector<NoiseBudget>& budget,
                                      TextStyle style = TextStyle::plain);

// Results.

/// `stated`: the model's noise; `worst`: legs, routes and outliers to list.
[[nodiscard]] std::string comparison_text(const Comparison& result, const Noise& stated,
                                          const std::vector<NoiseBudget>& budget,
                                          std::size_t worst = 5,
                                          TextStyle style = TextStyle::plain);
/// `list`: candidates, and events, to list.
[[nodiscard]] std::string diagnosis_text(const Diagnosis& result,
                                         const std::vector<NoiseBudget>& budget,
                                         std::size_t list = 8, TextStyle style = TextStyle::plain);
/// `files`: where the waypoints were written; empty: nowhere.
[[nodiscard]] std::string plan_text(const PlannedDrive& drive, const std::string& files = "",
                                    TextStyle style = TextStyle::plain);
/// `given`: the noise of the model given.
[[nodiscard]] std::string discovery_text(const Discovery& result, const Noise& given,
                                         const std::vector<NoiseBudget>& budget,
                                         TextStyle style = TextStyle::plain);
/// `noise`, where it was estimated before.
[[nodiscard]] std::string fit_text(const EffectGain& result,
                                   const std::optional<FittedNoise>& noise = {},
                                   TextStyle style = TextStyle::plain);
/// `method` as it is to be called; `several`: of more than one recording, so that sightings say
/// which.
[[nodiscard]] std::string map_text(const BuiltMap& built, const std::string& method, bool several,
                                   TextStyle style = TextStyle::plain);
/// Where the poses are from, and how well the last is known.
[[nodiscard]] std::string poses_text(const std::vector<TimedPose>& poses, bool adjusted);
/// Of dead-reckoned poses a warning where covariances are too small by a model's noise that lasts;
/// else empty.
[[nodiscard]] std::string lasting_noise_text(const Noise& noise,
                                             TextStyle style = TextStyle::plain);
/// A line per finding and below it the remedy; or that there is none.
[[nodiscard]] std::string check_text(const std::vector<CheckFinding>& findings,
                                     TextStyle style = TextStyle::plain);

/// Whether the model held, and if not what ceased to, since when, and what looks the same. `rate`:
/// false alarms per hour that the monitor was asked for.
[[nodiscard]] std::string watch_text(const Watch& result, double rate,
                                     TextStyle style = TextStyle::plain);

/// A line per coefficient, under a heading.
[[nodiscard]] std::string effects_text(const std::vector<Effect>& effects,
                                       TextStyle style = TextStyle::plain);
/// What acts beside what a model says of it, in the same words and units, and the score.
[[nodiscard]] std::string score_text(const AnswerScore& score, TextStyle style = TextStyle::plain);
/// `folder`: where it was written; empty: nowhere. Hidden effects are not named.
[[nodiscard]] std::string simulation_text(const SimulatedRecording& simulated,
                                          const SimulationSettings& settings,
                                          const std::string& folder,
                                          TextStyle style = TextStyle::plain);

/// Dead reckoning of drives that a calibration has not seen, one of each per drive.
struct TestedDrives {
  std::vector<std::string> names;
  std::vector<DriveError> nominal;     ///< by the model given
  std::vector<DriveError> calibrated;  ///< by the model found
};
[[nodiscard]] std::string calibration_text(const WheelCalibration& found,
                                           const CalibrationValidation& held,
                                           const std::optional<TestedDrives>& test = {},
                                           TextStyle style = TextStyle::plain);
/// What the held-out legs say of a calibration, and whether it explains its recordings, in a
/// sentence: a page's verdict.
[[nodiscard]] std::string calibration_verdict(const WheelCalibration& found,
                                              const CalibrationValidation& held);

/// A table of the figures of both runs, and what changed.
[[nodiscard]] std::string contrast_text(const RunContrast& contrast,
                                        TextStyle style = TextStyle::plain);

/// Constants to paste: lines of TOML, then those of other programs; nothing where there are none.
[[nodiscard]] std::string constants_text(const RobotConstants& constants,
                                         TextStyle style = TextStyle::plain);

/// Of the last round, with the systematic error of each.
[[nodiscard]] std::string square_text(const std::vector<SquareRound>& rounds, SquareMethod method,
                                      TextStyle style = TextStyle::plain);
/// "worth correcting", "nothing left to correct", or "doubtful": there are doubts.
[[nodiscard]] std::string_view square_verdict(const SquareRound& round);
/// What other paths, driven alone, would have hidden; "" without any.
[[nodiscard]] std::string paths_alone_text(const std::vector<PathAlone>& paths,
                                           TextStyle style = TextStyle::plain);
/// `constants`: taped_constants of the model that the robot calculated with.
[[nodiscard]] std::string tape_text(const TapeCalibration& found,
                                    const std::vector<TapedConstant>& constants,
                                    TextStyle style = TextStyle::plain);
[[nodiscard]] std::string_view name_of(TapeVerdict verdict);  ///< "worth correcting"
[[nodiscard]] std::string wheel_noise_text(const NoiseAnalysis& result,
                                           TextStyle style = TextStyle::plain);

/// `left_out`: edges, of a robust adjustment; `seconds`: what it took.
[[nodiscard]] std::string pose_graph_text(const PoseGraph& graph, const PoseGraphAdjustment& result,
                                          std::optional<std::size_t> left_out, double seconds,
                                          TextStyle style = TextStyle::plain);

}  // namespace trussmap
