// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/marked_course.hpp"

#include "odometry/merge.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace trussmap::calibration {
namespace {

struct TimedMark {
  double t = 0.0;
  Mark mark;
};

/// On the robot, m.
Vector2 place_of(const std::optional<Mounting>& at) {
  return at ? Vector2(at->x, at->y) : Vector2::Zero().eval();
}

std::vector<TimedMark> marks_of(const DrivenRecording& recording, const Mountings& mounted) {
  const Vector2 sensor = place_of(mounted.sensor);
  const double yaw = mounted.sensor.value_or(Mounting()).yaw;
  std::map<std::string, Vector2> survey;
  for (const SurveyPoint& one : recording.survey) survey[one.landmark] = {one.x, one.y};
  std::vector<TimedMark> marks;
  for (const Sighting& one : recording.sightings) {
    if (!one.locates()) continue;
    Mark mark;
    mark.offset = sensor + rotation(yaw) * landmark_offset(one, {}).offset_robot;
    mark.landmark = one.landmark;
    if (const auto known = survey.find(one.landmark); known != survey.end()) {
      mark.known = known->second;
    }
    marks.push_back({one.t, mark});
  }
  const Vector2 antenna = place_of(mounted.antenna);
  for (const Fix& one : recording.fixes) {
    marks.push_back({one.t, {.offset = antenna, .known = Vector2(one.x, one.y)}});
  }
  const Vector2 tracked = place_of(mounted.tracked);
  for (const TruthRow& one : recording.truth) {
    marks.push_back({one.t, {.offset = tracked, .known = Vector2(one.x, one.y)}});
  }
  std::stable_sort(marks.begin(), marks.end(),
                   [](const TimedMark& a, const TimedMark& b) { return a.t < b.t; });
  return marks;
}

/// A few hundred stops at most, evenly in time, each with a few of its marks.
std::vector<TimedMark> thinned(const std::vector<TimedMark>& marks) {
  constexpr double kStops = 200.0;
  constexpr std::size_t kOfAStop = 3;
  if (marks.empty()) return marks;
  const double apart = (marks.back().t - marks.front().t) / kStops;
  std::vector<TimedMark> kept;
  std::size_t at_stop = 0;
  for (const TimedMark& one : marks) {
    const bool same = !kept.empty() && one.t == kept.back().t;
    if (!kept.empty() && !same && one.t - kept.back().t < apart) continue;
    at_stop = same ? at_stop + 1 : 1;
    if (at_stop <= kOfAStop) kept.push_back(one);
  }
  return kept;
}

void add_steps(const MotionRows& drive, double from, double to, std::vector<BodyMotion>& steps) {
  constexpr double kStraight = 0.05;  // rad
  BodyMotion sum;
  bool any = false;
  for (const odometry::DriveRow& row : odometry::rows_between(drive, from, to)) {
    const BodyMotion body = odometry::motion_of(drive, row);
    sum = {sum.forward + body.forward, sum.sideways + body.sideways, sum.turn + body.turn};
    any = true;
    if (std::abs(sum.turn) < kStraight) continue;
    steps.push_back(std::exchange(sum, {}));
    any = false;
  }
  if (any) steps.push_back(sum);
}

void find_chords(Course& course) {
  constexpr std::size_t kFurthest = 4;  // of the places known, one after the other
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < course.marks.size(); ++k) {
    if (course.marks[k].known) known.push_back(k);
  }
  for (std::size_t a = 0; a < known.size(); ++a) {
    for (std::size_t b = a + 1; b < known.size() && b <= a + kFurthest; ++b) {
      if (course.marks[known[a]].step == course.marks[known[b]].step) continue;  // seen, not driven
      const double length = (*course.marks[known[a]].known - *course.marks[known[b]].known).norm();
      if (length > kDefaultMinDrive) course.chords.push_back({known[a], known[b], length});
    }
  }
}

void find_returns(Course& course) {
  constexpr std::size_t kMost = 60;
  std::vector<double> path{0.0};
  for (const BodyMotion& one : course.steps) {
    path.push_back(path.back() + std::hypot(one.forward, one.sideways));
  }
  std::map<std::string, std::size_t> last;
  for (std::size_t k = 0; k < course.marks.size(); ++k) {
    const Mark& mark = course.marks[k];
    if (mark.landmark.empty()) continue;
    if (const auto before = last.find(mark.landmark); before != last.end()) {
      const double driven = path[mark.step] - path[course.marks[before->second].step];
      if (driven > kDefaultMinDrive) course.returns.push_back({before->second, k, driven});
    }
    last[mark.landmark] = k;
  }
  std::stable_sort(course.returns.begin(), course.returns.end(),
                   [](const Chord& a, const Chord& b) { return a.length < b.length; });
  if (course.returns.size() > kMost) course.returns.resize(kMost);
}

}  // namespace

Course course_of(const DrivenRecording& recording, const Robot& robot) {
  constexpr std::size_t kMostSteps = 1500;
  Course course;
  const MotionRows& drive = recording.drive;
  double from = drive.start();
  for (TimedMark& one : thinned(marks_of(recording, robot.mounted))) {
    if (one.t < drive.start() || one.t > drive.t.back()) continue;
    add_steps(drive, from, one.t, course.steps);
    if (course.steps.size() > kMostSteps) break;
    from = one.t;
    one.mark.step = course.steps.size();
    course.marks.push_back(std::move(one.mark));
  }
  find_chords(course);
  find_returns(course);
  return course;
}

}  // namespace trussmap::calibration
