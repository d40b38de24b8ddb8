// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/check.hpp"

#include "check/findings.hpp"
#include "check/turn_signs.hpp"
#include "drive/body_motion.hpp"
#include "drive/legs.hpp"
#include "drive/well_formed.hpp"
#include "geometry/units.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace trussmap {
using namespace check;

namespace {

constexpr double kNarrowest = 0.01;    // m: wheelbases that robots have
constexpr double kWidest = 5.0;        // m
constexpr double kLongest = 20.0;      // m from axle to axle
constexpr double kWheelbaseOff = 2.5;  // factor that skidding does not reach
constexpr int kHandful = 5;            // degrees of freedom that test nothing

/// Degrees of freedom of what was recorded, counted as the adjustment does but for what a compass
/// adds on the way.
int degrees_of_freedom(const DrivenRecording& recording, std::set<std::string_view>& landmarks) {
  std::set<double> instants;
  int rows = 0;
  for (const Sighting& one : recording.sightings) {
    instants.insert(one.t);
    landmarks.insert(one.landmark);
    rows += one.locates() ? 2 : 1;
  }
  for (const TruthRow& one : recording.truth) {
    instants.insert(one.t);
    rows += 3;
  }
  for (const Fix& one : recording.fixes) {
    if (one.t < recording.drive.start() || one.t > recording.drive.t.back()) continue;
    instants.insert(one.t);
    rows += 2;
  }
  for (const Loop& one : recording.loops) {
    instants.insert({one.t, one.t2});
    rows += 3;
  }
  const int poses = static_cast<int>(instants.size());
  const int segments = std::max(0, poses - 1);
  return rows + segments * (recording.drive.has_compass() ? 4 : 3) - 3 * poses;
}

void check_freedom(const std::vector<DrivenRecording>& recordings, CheckFindings& findings) {
  std::set<std::string_view> landmarks;
  std::set<std::string_view> surveyed;
  int dof = 0;
  bool framed = false;
  for (const DrivenRecording& one : recordings) {
    dof += degrees_of_freedom(one, landmarks);
    framed = framed || !one.truth.empty() || !one.fixes.empty();
    for (const SurveyPoint& point : one.survey) surveyed.insert(point.landmark);
  }
  std::erase_if(surveyed, [&](std::string_view name) { return !landmarks.contains(name); });
  dof -= 2 * static_cast<int>(landmarks.size());
  dof += 2 * static_cast<int>(surveyed.size());
  if (!framed && surveyed.empty()) dof += 2 + (recordings.front().drive.has_compass() ? 0 : 1);
  // What a compass adds between sightings is not counted: where it has many readings, enough.
  constexpr std::size_t kManyReadings = 50;
  const bool reads =
      std::any_of(recordings.begin(), recordings.end(), [](const DrivenRecording& one) {
        return one.drive.has_compass() && one.drive.rows() >= kManyReadings;
      });
  if (dof >= kHandful || (reads && dof > -kHandful)) return;
  Checked all{recordings.front(), findings};
  const DrivenRecording& one = recordings.front();
  all.add(!one.sightings.empty() ? "sightings.csv"
          : !one.truth.empty()   ? "truth.csv"
          : !one.fixes.empty()   ? "fixes.csv"
          : !one.loops.empty()   ? "loops.csv"
                                 : "drive.csv",
          "", "nothing to test",
          text::joined("what was measured exceeds what is unknown by ", dof,
                       " values: a model can hardly fail there"),
          "drive routes again, or survey landmarks");
}

/// What the model states of the wheels' distances: a wrong one makes all turns too large or too
/// small.
struct Geometry {
  const char* key = "wheelbase";
  const char* kind = "impossible wheelbase";
  double stated = 0.0;  ///< m
  double widest = kWidest;
};

Geometry geometry_of(const Robot& robot) {
  switch (robot.drive) {
    case DriveKind::tricycle:
    case DriveKind::ackermann:
      return {"length", "impossible length", robot.length, kLongest};
    case DriveKind::omni3:
      return {"radius", "impossible length", robot.length};
    case DriveKind::mecanum:
      return {"wheelbase,length", "impossible wheelbase", robot.wheelbase + robot.length};
    case DriveKind::wheels:
      return {"wheel,matrix", "impossible length", robot.wheelbase};
    default:
      return {"wheelbase", "impossible wheelbase", robot.wheelbase};
  }
}

void check_wheelbase(Checked& checked, const Model& model, const std::string& model_file,
                     const TurnAgreement& turns, CheckFindings& findings) {
  const Geometry geometry = geometry_of(model.robot);
  const char* const key = geometry.key;
  const double stated = geometry.stated;
  const bool wheelbase = std::string(key) == "wheelbase";
  const auto add = [&](const std::string& evidence, const std::string& remedy) {
    findings.push_back({model_file, key, geometry.kind, evidence, remedy});
  };
  if (stated < kNarrowest || stated > geometry.widest) {
    add(text::joined("the ", wheelbase ? key : "distance of the wheels", " is ",
                     figure(stated, "m")),
        text::joined("state ", wheelbase ? "it" : key, " in metres"));
    return;
  }
  if (turns.sign == 0 || checked.wrong.contains("left") || checked.wrong.contains("heading")) {
    return;
  }
  const double times = 1.0 / std::abs(turns.slope);
  if (std::abs(std::log(times)) < std::log(kWheelbaseOff)) return;
  if (wheelbase) {
    add(text::joined("the wheelbase is ", figure(stated, "m"),
                     ", but the wheels turn with the compass as if "
                     "it were ",
                     figure(times * stated, "m")),
        "measure it again; if it is right, look at the units of left, right and heading");
    return;
  }
  add(text::joined("the wheels turn with the compass as if distances were ", figure(times),
                   " times as long as the model's"),
      text::joined("measure ", key,
                   " again; if it is right, look at the units of the columns and of ", "heading"));
}

/// The same travels, readings and sightings, to the last digit: a programme driven twice has its
/// own readings.
bool same_session(const DrivenRecording& a, const DrivenRecording& b) {
  const auto same_sighting = [](const Sighting& one, const Sighting& other) {
    return one.landmark == other.landmark && one.t == other.t;
  };
  const auto same_reading = [](double one, double other) {
    return one == other || (std::isnan(one) && std::isnan(other));
  };
  const auto same_truth = [](const TruthRow& one, const TruthRow& other) {
    return one.x == other.x && one.y == other.y && one.heading == other.heading;
  };
  return a.drive.forward == b.drive.forward && a.drive.turn == b.drive.turn &&
         std::equal(a.drive.heading.begin(), a.drive.heading.end(), b.drive.heading.begin(),
                    b.drive.heading.end(), same_reading) &&
         std::equal(a.sightings.begin(), a.sightings.end(), b.sightings.begin(), b.sightings.end(),
                    same_sighting) &&
         std::equal(a.truth.begin(), a.truth.end(), b.truth.begin(), b.truth.end(), same_truth);
}

void check_twice(const std::vector<DrivenRecording>& recordings, CheckFindings& findings) {
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    for (std::size_t other = 0; other < k; ++other) {
      if (!same_session(recordings[k], recordings[other])) continue;
      Checked both{recordings[k], findings};
      both.add("drive.csv", "", "same session twice",
               text::joined("all ", recordings[k].drive.rows(), " rows travel as those of ",
                            recordings[other].name),
               "give each session once: counted twice it makes errors look smaller and alike");
      break;
    }
  }
}

bool never_negative(const MotionRows& drive) {
  const auto negative = [](double travel) { return travel < 0.0; };
  if (!drive.wheels.empty()) {
    return std::none_of(drive.wheels.begin(), drive.wheels.end(), [&](const WheelColumn& one) {
      return !one.steers && std::any_of(one.reading.begin(), one.reading.end(), negative);
    });
  }
  return std::none_of(drive.pair.left.begin(), drive.pair.left.end(), negative) &&
         std::none_of(drive.pair.right.begin(), drive.pair.right.end(), negative);
}

/// Where the wheels agree with nothing as they are: with one of them negated?
void check_lone_wheel(Checked& checked, bool by_survey, bool by_truth) {
  for (const WheelMistake mistake : {WheelMistake::left_negated, WheelMistake::right_negated}) {
    const Track track(checked.recording.drive, mistake, checked.wheelbase);
    const bool survey = by_survey && survey_agreement(checked, track).by_way > 0;
    const bool truth = by_truth && truth_agreement(checked, track).by_heading > 0;
    if (!survey && !truth) continue;
    add_lone_wheel(
        checked, mistake,
        text::joined("with the ", lone_wheel(mistake),
                     " wheel's sign changed the wheels turn with the ",
                     survey ? "survey's corners" : "truth", ", as recorded they do not"));
    return;
  }
}

/// What the sensors say of a recording's turns.
struct Turns {
  TurnAgreement compass;
  TurnAgreement gyro;
  TurnAgreement views;
  int fixes = 0;   ///< sign
  int ranges = 0;  ///< sign, to surveyed landmarks
  int yaws = 0;    ///< sign
};

/// What each pair of quantities says of the other's turns, and which of them has to be wrong.
void check_turns(Checked& checked, const Turns& turns, const SurveyAgreement& surveyed,
                 const TruthAgreement& truth) {
  TurnSigns signs;
  signs.add(Turning::wheels, Turning::compass, turns.compass.sign,
            "the compass turns against the wheels");
  signs.add(Turning::wheels, Turning::gyro, turns.gyro.sign, "the gyro turns against the wheels");
  signs.add(Turning::wheels, Turning::bearings, turns.views.sign,
            "landmarks shift against the wheels' turns");
  signs.add(Turning::wheels, Turning::yaws, turns.yaws,
            "the landmarks' yaws turn with the robot, not against it");
  signs.add(Turning::wheels, Turning::survey, surveyed.by_way,
            "the survey's corners turn against the wheels");
  signs.add(Turning::wheels, Turning::survey, turns.ranges,
            "the places that ranges to surveyed landmarks give turn against the wheels");
  signs.add(Turning::bearings, Turning::survey, surveyed.by_views,
            "the survey's corners turn against what is seen");
  signs.add(Turning::wheels, Turning::fixes, turns.fixes,
            "the fixes' corners turn against the wheels");
  signs.add(Turning::wheels, Turning::truth_heading, truth.by_heading,
            "the truth's heading turns against the wheels");
  signs.add(Turning::wheels, Turning::truth_course, truth.by_course,
            "the truth's course turns against the wheels");
  blame(checked, signs);
}

/// One of two wheels, or unsigned ones, where the wheels agree with nothing as they are.
void check_contradicted_wheels(Checked& checked, const TurnAgreement& turns,
                               const SurveyAgreement& surveyed, const TruthAgreement& truth) {
  const MotionRows& drive = checked.recording.drive;
  const bool two = drive.of_two_wheels();
  if (two && (surveyed.contradicts || truth.contradicts)) {
    check_lone_wheel(checked, surveyed.contradicts, truth.contradicts);
  }
  const bool skids = checked.robot != nullptr && checked.robot->drive == DriveKind::skid_steer;
  const bool sides = two || (skids && turns.sign == 0);
  const bool contradicted =
      turns.unsigned_wheels || surveyed.unsigned_wheels || truth.unsigned_wheels;
  if (checked.wheels_wrong() || !sides || !contradicted || !never_negative(drive)) return;
  checked.add("drive.csv", wheel_columns(drive), "wheels unsigned",
              text::joined("no travel is negative, and the wheels go straight on where ",
                           turns.unsigned_wheels      ? "the compass turns"
                           : surveyed.unsigned_wheels ? "the survey has corners"
                                                      : "the truth turns",
                           " on the spot"),
              "record travels with their sign: a turn on the spot has one wheel going backwards");
}

/// Two wheels are so far apart, m: by that they turn the drive from now on, which is the checked
/// recording's.
void take_wheelbase(double wheelbase, Checked& checked, MotionRows& drive) {
  checked.wheelbase = wheelbase;
  checked.wheelbase_known = true;
  for (std::size_t row = 0; row < drive.pair.left.size(); ++row) {
    drive.turn[row] = drive::body_motion(drive.pair.at(row), wheelbase).turn;
  }
}

/// Of one recording, with its drive. Returns what its compass says of the wheels.
TurnAgreement check_recording(Checked& checked, MotionRows& drive) {
  const DrivenRecording& recording = checked.recording;
  check_names(checked);
  check_case(checked);
  check_repeats(checked);
  check_drive_values(checked);
  check_bearing_unit(checked);
  check_yaw_units(checked);
  if (!recording.drive.wheels.empty()) {
    if (checked.robot == nullptr) return {};  // what they do is not known
    check_still_columns(checked);
    check_other_drive(checked);
  }
  const TurnAgreement turns = check_compass(checked);
  if (!checked.wheelbase_known && turns.sign != 0) {
    take_wheelbase(checked.wheelbase / std::abs(turns.slope), checked, drive);
  }
  if (!checked.wheelbase_known) return turns;
  const Track track(recording.drive);
  check_no_travel(checked, track);
  check_no_turning(checked, track);
  SurveyAgreement surveyed = survey_agreement(checked, track);
  settle_by_places(checked, track, surveyed);
  if (checked.wheels_wrong()) {  // nothing is to be compared with them
    check_survey(checked, track, {}, false);
    return turns;
  }
  const TurnAgreement gyro = check_gyro(checked);
  const TurnAgreement views = check_views(checked, track);
  if (checked.wheels_wrong()) return turns;
  const TruthAgreement truth = truth_agreement(checked, track);
  check_contradicted_wheels(checked, turns, surveyed, truth);
  if (checked.wheels_wrong()) return turns;
  check_survey(checked, track, surveyed, turns.sign > 0);
  check_truth(checked, track, truth);
  const std::size_t before = checked.findings.size();
  check_turns(checked,
              {turns, gyro, views, sign_of_fixes(checked, track), sign_of_ranges(checked, track),
               yaws_sign(checked, track)},
              surveyed, truth);
  if (checked.findings.size() > before) return turns;
  check_constant_columns(checked, track);
  if (!checked.broken && !checked.wrong.contains("x") && !checked.wrong.contains("range")) {
    check_survey_points(checked, surveyed);
  }
  if (checked.broken) return turns;
  const bool by_truth = truth.by_heading > 0 && truth.by_course > 0 &&
                        !checked.wrong.contains("truth heading") &&
                        !checked.wrong.contains("truth x");
  const bool by_compass = turns.sign > 0 && !checked.wrong.contains("heading");
  for (const char* column : {"left", "right", "t", "range", "bearing"}) {
    if (checked.wrong.contains(column)) return turns;
  }
  if (by_truth || !by_compass) {
    check_labels(checked, track, by_truth);
  } else {
    check_labels(checked,
                 Track(recording.drive, WheelMistake::none, checked.wheelbase, Heading::of_compass),
                 false);
  }
  return turns;
}

/// Fixes that hardly move while the robot drives: degrees of latitude and longitude.
void check_fix_unit(Checked& checked) {
  constexpr double kApart = 1.0;         // m driven
  constexpr double kFarTooShort = 1e-4;  // a degree is 111 km
  constexpr double kStuck = 1e-7;
  constexpr int kFewest = 3;
  const DrivenRecording& recording = checked.recording;
  const std::vector<double> path = drive::driven_path(recording.drive);
  double driven = 0.0;
  double moved = 0.0;
  int ways = 0;
  const Fix* last = nullptr;
  double begun = 0.0;
  for (const Fix& fix : recording.fixes) {
    if (fix.t < recording.drive.start() || fix.t > recording.drive.t.back()) continue;
    if (std::abs(fix.x) > 180.0 || std::abs(fix.y) > 180.0) return;
    const double at = drive::path_at(recording.drive, path, fix.t);
    if (last != nullptr && at - begun < kApart) continue;
    if (last != nullptr) {
      driven += at - begun;
      moved += std::hypot(fix.x - last->x, fix.y - last->y);
      ++ways;
    }
    last = &fix;
    begun = at;
  }
  if (ways < kFewest || moved > kFarTooShort * driven || moved < kStuck * driven) return;
  checked.add("fixes.csv", "x,y", "fix unit",
              text::joined("the fixes move by ", figure(moved), " in all while the wheels drive ",
                           figure(driven, "m"), ": degrees of latitude and longitude?"),
              "project them into metres, x to the east and y to the north");
}

/// With its wheels taken in; a steering angle in degrees, which may lead nowhere, as what it is.
DrivenRecording by_its_columns(Recording recording, const Robot& robot) {
  if (steers_in_degrees(recording, robot)) {
    for (Covariate& one : recording.drive.covariates) {
      if (one.name != robot.columns[1]) continue;
      for (double& angle : one.values) angle *= geometry::kDegree;
    }
  }
  return with_wheels(std::move(recording), robot);
}

void add_degrees(Checked& checked) {
  const std::string& name = checked.robot->columns[1];
  const bool tricycle = checked.robot->drive == DriveKind::tricycle;
  checked.add("drive.csv", name, "angle unit",
              text::joined(name, " is beyond ", tricycle ? "a whole turn" : "a right angle",
                           " in many rows, if it is in radians: it looks like degrees"),
              "convert it to radians, left positive");
}

}  // namespace

std::vector<CheckFinding> check_recordings(const std::vector<Recording>& recordings,
                                           const Model* model, const std::string& model_file) {
  CheckFindings findings;
  if (recordings.empty()) return findings;
  const bool by_columns = model != nullptr && !model->robot.columns.empty();
  const Robot robot = model != nullptr ? model->robot : Robot();
  std::vector<DrivenRecording> all;
  all.reserve(recordings.size());
  for (const Recording& one : recordings) all.push_back(by_its_columns(one, robot));
  for (const DrivenRecording& one : all) drive::require_well_formed(one, robot);
  if (model != nullptr && !model->robot.wheelbase_stated) {
    findings.push_back({model_file, "wheelbase", "no wheelbase",
                        text::joined("[robot] has no wheelbase: ",
                                     figure(model->robot.wheelbase, "m"), " is taken"),
                        "state the distance of the wheels"});
  }
  bool said = false;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::vector<CounterJump> glitches = counter_glitches(all[k].drive);
    if (!glitches.empty()) {  // the rest is checked without
      Checked with_glitches{all[k], findings};
      check_glitches(with_glitches, glitches);
      all[k] = by_its_columns(
          without_glitches(recordings[k], glitches, names_of_wheels(all[k].drive)), robot);
    }
    Checked checked{all[k], findings};
    checked.wheelbase_known = model != nullptr && model->robot.wheelbase_stated;
    checked.wheelbase = robot.wheelbase;
    if (by_columns && model->robot.drive != DriveKind::differential) {
      checked.robot = &model->robot;
      if (steers_in_degrees(recordings[k], model->robot)) add_degrees(checked);
    }
    check_fix_unit(checked);
    const TurnAgreement turns = check_recording(checked, all[k].drive);
    if (model == nullptr || !model->robot.wheelbase_stated || said) continue;
    const std::size_t before = findings.size();
    check_wheelbase(checked, *model, model_file, turns, findings);
    said = findings.size() > before;
  }
  check_twice(all, findings);
  check_freedom(all, findings);
  return findings;
}

}  // namespace trussmap
