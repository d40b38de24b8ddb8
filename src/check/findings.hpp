// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What each part of a check looks at, and what it adds to the list.
#pragma once

#include "check/counter_jumps.hpp"
#include "check/survey_legs.hpp"
#include "check/track.hpp"
#include "trussmap/check.hpp"

#include <complex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace trussmap::check {

using CheckFindings = std::vector<CheckFinding>;

/// A recording with its own finding list; parts that come later do not trust what earlier ones
/// found wrong.
struct Checked {
  const DrivenRecording& recording;
  CheckFindings& findings;
  std::set<std::string> wrong = {};  ///< columns that something was found of
  double wheelbase = 0.0;            ///< m, the model's or what stands for it
  bool wheelbase_known = false;      ///< the model's, or found from the compass
  const Robot* robot = nullptr;      ///< the model's, where its drive is not of two wheels
  bool broken = false;               ///< a gap or spike: no track leads through it
  double angle_unit = 1.0;           ///< rad per unit of bearings
  double yaw_unit = 1.0;             ///< rad per unit of yaws

  void add(const char* file, const std::string& column, const char* kind,
           const std::string& evidence, const std::string& remedy);
  /// Wheels or clock: then nothing else is compared with them.
  [[nodiscard]] bool wheels_wrong() const {
    return wrong.contains("left") || wrong.contains("right") || wrong.contains("t");
  }
  /// The same of a few rows alone: the column is trusted otherwise.
  void note(const char* file, const std::string& column, const char* kind,
            const std::string& evidence, const std::string& remedy);
};

/// Times, travels and covariates by themselves: units, spikes, gaps, wheels that stand still.
void check_drive_values(Checked& checked);

/// Travel of the wheel that goes further in this row, m; of other drives of two that would show it.
[[nodiscard]] double larger_travel(const MotionRows& drive, std::size_t row, double wheelbase);

/// What rows are like: medians.
struct UsualRow {
  double duration = 0.0;  ///< s
  double speed = 0.0;     ///< m/s of the faster wheel, of rows that move
};
/// Rows that are missing, but for those of a robot that stood still.
void check_gaps(Checked& checked, const UsualRow& usual);
/// Rows in which the clock was set, counted from 0; none where there are so many that it is a
/// logger's that sleeps.
[[nodiscard]] std::vector<std::size_t> clock_jumps(const DriveColumns& drive,
                                                   const UsualRow& usual);
/// Times in another unit, a clock that was set, files with other times than the drive's.
void check_clocks(Checked& checked, const UsualRow& usual);
/// Counters that were wrong for some samples.
void check_glitches(Checked& checked, const std::vector<CounterJump>& jumps);

/// A wheel that stands still for so long that no turn about it is meant, or that nothing shows one.
void check_still_wheels(Checked& checked);
/// The same of the columns of other drives, and of a steering angle that never changes.
void check_still_columns(Checked& checked);

/// Columns of drives with other wheels than two, with signs or places that are not theirs: reported
/// where the drive agrees with the other sensors without the mistake, and with it by none of
/// theirs.
void check_other_drive(Checked& checked);
/// A steering angle in degrees, by its values alone. `drive` is as recorded, its columns
/// covariates.
[[nodiscard]] bool steers_in_degrees(const Recording& recording, const Robot& robot);

/// "left" or "right", of a mistake with one wheel; and the finding that it is negated.
[[nodiscard]] const char* lone_wheel(WheelMistake mistake);
void add_lone_wheel(Checked& checked, WheelMistake mistake, const std::string& evidence);

/// Blanks in names of landmarks.
void check_names(Checked& checked);
/// Names that differ in upper and lower case alone.
void check_case(Checked& checked);
/// Rows of sightings and loops that stand twice.
void check_repeats(Checked& checked);
/// Columns of one number, which the robot's motion would have to change.
void check_constant_columns(Checked& checked, const Track& track);
/// Wheels that turn the robot, but never travel.
void check_no_travel(Checked& checked, const Track& track);
/// Wheels that travel, but never turn it.
void check_no_turning(Checked& checked, const Track& track);
/// One name at two places, and sightings under another landmark's name. Places are the truth's
/// where that is trusted, else the track's.
void check_labels(Checked& checked, const Track& track, bool by_truth);

/// Ranges' and bearings' units by themselves, before anything is asked of them.
void check_bearing_unit(Checked& checked);

/// How one quantity's turns go with another's.
struct TurnAgreement {
  int sign = 0;        ///< 1 alike, -1 opposite, 0: cannot be told, or neither
  double slope = 0.0;  ///< turn per turn of the wheels
  double correlation = 0.0;
  int turns = 0;  ///< samples
  /// On the spot, where the wheels go straight on: what unsigned wheels make of a turn.
  bool unsigned_wheels = false;
};

/// Whether a turn (rad) is what unsigned wheels, that show this turn (rad) and way ahead (m), make
/// of one on the spot: no drive along an arc turns so much.
[[nodiscard]] bool looks_unsigned(double turn, double shown, double ahead, double wheelbase);

/// Of the compass with the wheels, reported where it is in degrees or fits another mistake better.
[[nodiscard]] TurnAgreement check_compass(Checked& checked);
/// Of the gyro with the wheels, reported where it is in degrees.
[[nodiscard]] TurnAgreement check_gyro(Checked& checked);

/// Of views with the wheels: of the landmark's shift as seen with the robot's motion. Reported
/// where another unit or mistake of the wheels fits better.
[[nodiscard]] TurnAgreement check_views(Checked& checked, const Track& track);
/// Median error of views predicted from earlier ones, by the size of the shift, at most 1; of those
/// within [from, to] s, where there are enough.
[[nodiscard]] std::optional<double> views_misfit(const DrivenRecording& recording,
                                                 const Track& track, double range_unit,
                                                 double bearing_unit, double from, double to);

/// Units of yaws and of surveyed headings by themselves.
void check_yaw_units(Checked& checked);
/// Of yaws with the wheels' turns: 1 as they should go, -1 as yaws of the other sign would, 0:
/// cannot be told.
[[nodiscard]] int yaws_sign(const Checked& checked, const Track& track);

/// Whether a sighting says where its landmark is, as place_seen has it from a pose of a track.
[[nodiscard]] bool tells_place(const Sighting& sighting);
[[nodiscard]] Vector2 place_seen(const Sighting& sighting, const Pose& from, double bearing_unit);

/// Of the survey with the way from landmark to landmark (wheels), or with views of both (bearings).
struct SurveyAgreement {
  int by_way = 0;  ///< sign, as TurnAgreement
  int by_views = 0;
  double way_ratio = 0.0;  ///< survey's lengths by those of the way; 0: none
  double views_ratio = 0.0;
  bool contradicts = false;  ///< neither alike nor mirrored, by the way
  bool unsigned_wheels = false;
  std::vector<SurveyLeg> way;  ///< what it is judged by
  std::vector<SurveyLeg> views;
};
[[nodiscard]] SurveyAgreement survey_agreement(const Checked& checked, const Track& track);
/// Where corners do not tell: by the stops' places, whatever the wheels' scale and the size of
/// their turns.
void settle_by_places(const Checked& checked, const Track& track, SurveyAgreement& agreement);
/// Of the fixes' corners with those of the way.
[[nodiscard]] int sign_of_fixes(const Checked& checked, const Track& track);
/// Of the places that ranges to surveyed landmarks give.
[[nodiscard]] int sign_of_ranges(const Checked& checked, const Track& track);
/// What of it is wrong by itself: names, spread, units; `compass`: whether its turns agree.
void check_survey(Checked& checked, const Track& track, const SurveyAgreement& agreement,
                  bool compass);

/// Points that lie elsewhere, exchanged labels.
void check_survey_points(Checked& checked, const SurveyAgreement& agreement);

struct TruthAgreement {
  int by_heading = 0;  ///< sign of the truth's turns against the wheels'
  int by_course = 0;   ///< of its positions'
  bool in_degrees = false;
  bool contradicts = false;  ///< neither alike nor opposite
  bool unsigned_wheels = false;
};
[[nodiscard]] TruthAgreement truth_agreement(const Checked& checked, const Track& track);
void check_truth(Checked& checked, const Track& track, const TruthAgreement& agreement);

/// A mean direction and how far directions are alike.
class MeanAngle {
 public:
  void add(double angle) {
    sum_ += std::polar(1.0, angle);
    ++count_;
  }
  [[nodiscard]] double angle() const { return std::arg(sum_); }
  [[nodiscard]] int count() const { return count_; }
  /// Enough of them, and alike.
  [[nodiscard]] bool is_clear() const {
    constexpr int kFewest = 10;
    constexpr double kAlike = 0.9;
    return count_ >= kFewest && std::abs(sum_) > kAlike * count_;
  }

 private:
  std::complex<double> sum_;
  int count_ = 0;
};

/// Offset (rad) of a compass that counts from elsewhere than the map's x axis, north perhaps.
inline constexpr double kCompassTurned = 0.35;

/// "12.3 m/s", without figures that mean nothing.
[[nodiscard]] std::string figure(double value, const char* unit = "");

/// The unit that a ratio to metres looks like: "mm", "cm", "inches", "feet", or nothing.
[[nodiscard]] std::string unit_of_ratio(double ratio);
/// Whether it, or its inverse, looks like one.
[[nodiscard]] bool looks_like_a_unit(double ratio);

}  // namespace trussmap::check
