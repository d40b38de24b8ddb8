// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A wheel that stands still while the other one drives: an encoder that has lost its counts, or a
// robot that turns about it, which compass, gyro, truth or bearings show.
#include "check/findings.hpp"
#include "check/still_limits.hpp"
#include "drive/legs.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

namespace trussmap::check {
namespace {

constexpr double kStillShare = 1e-6;      // of the other wheel's way
constexpr double kStep = 0.5;             // rad by the wheels, to be compared
constexpr int kFewestSteps = 6;           // steps
constexpr double kClearSteps = 0.8;       // correlation
constexpr double kWheelbaseFactor = 2.5;  // factor

/// Turns of something against the wheels'.
class Turned {
 public:
  void add(double by_wheels, double by_other) {
    if (std::abs(by_wheels) > kUntold) return;
    wheels_ += by_wheels;
    other_ += by_other;
    if (std::abs(wheels_) < kStep) return;
    ww_ += wheels_ * wheels_;
    wo_ += wheels_ * other_;
    oo_ += other_ * other_;
    ++steps_;
    wheels_ = other_ = 0.0;
  }
  [[nodiscard]] bool tells() const { return steps_ >= kFewestSteps; }
  [[nodiscard]] bool agrees() const {
    return wo_ > kClearSteps * std::sqrt(ww_ * oo_) && wo_ < kWheelbaseFactor * ww_ &&
           ww_ < kWheelbaseFactor * wo_;
  }

 private:
  double wheels_ = 0.0;
  double other_ = 0.0;
  double ww_ = 0.0;
  double wo_ = 0.0;
  double oo_ = 0.0;
  int steps_ = 0;
};

/// Rows from `first` to the one before `end` in which a wheel stands still.
struct StillStretch {
  std::size_t first = 0;
  std::size_t end = 0;
  double travel = 0.0;  ///< m, of the other wheel
};

/// By the wheels at the end of each row, from 0 at the drive's start, rad.
std::vector<double> wheel_headings(const MotionRows& drive) {
  std::vector<double> headings;
  headings.reserve(drive.rows());
  double heading = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    heading += drive.turn[row];
    headings.push_back(heading);
  }
  return headings;
}

Turned by_compass(const MotionRows& drive, const StillStretch& stretch,
                  const std::vector<double>& wheels) {
  Turned turned;
  std::size_t last = drive.rows();
  for (std::size_t row = stretch.first; drive.has_compass() && row < stretch.end; ++row) {
    if (std::isnan(drive.heading[row])) continue;
    if (last < drive.rows()) {
      turned.add(wheels[row] - wheels[last], wrap_angle(drive.heading[row] - drive.heading[last]));
    }
    last = row;
  }
  return turned;
}

Turned by_gyro(const MotionRows& drive, const StillStretch& stretch) {
  Turned turned;
  for (std::size_t row = stretch.first; drive.has_gyro() && row < stretch.end; ++row) {
    if (std::isnan(drive.yaw_rate[row])) continue;
    turned.add(drive.turn[row], drive.yaw_rate[row] * drive.duration(row));
  }
  return turned;
}

Turned by_truth(const DrivenRecording& recording, const StillStretch& stretch,
                const std::vector<double>& wheels) {
  Turned turned;
  const MotionRows& drive = recording.drive;
  const TruthRow* last = nullptr;
  for (const TruthRow& one : recording.truth) {
    if (one.t < drive.t[stretch.first] || one.t > drive.t[stretch.end - 1]) continue;
    if (last != nullptr) {
      turned.add(drive::path_at(drive, wheels, one.t) - drive::path_at(drive, wheels, last->t),
                 wrap_angle(one.heading - last->heading));
    }
    last = &one;
  }
  return turned;
}

/// A landmark goes round a robot that turns.
Turned by_bearings(const DrivenRecording& recording, const StillStretch& stretch,
                   const std::vector<double>& wheels) {
  Turned turned;
  const MotionRows& drive = recording.drive;
  std::map<std::string_view, const Sighting*> seen;
  for (const Sighting& one : recording.sightings) {
    const bool within = one.t >= drive.t[stretch.first] && one.t <= drive.t[stretch.end - 1];
    if (!within || std::isnan(one.bearing)) continue;
    const Sighting*& last = seen[one.landmark];
    if (last != nullptr) {
      turned.add(drive::path_at(drive, wheels, one.t) - drive::path_at(drive, wheels, last->t),
                 wrap_angle(last->bearing - one.bearing));
    }
    last = &one;
  }
  return turned;
}

/// A turn about the wheel: at least one shows it, and none contradicts.
bool turns_about_it(const Checked& checked, const StillStretch& stretch,
                    const std::vector<double>& wheels) {
  const DrivenRecording& recording = checked.recording;
  bool shown = false;
  for (const Turned& one :
       std::array{by_compass(recording.drive, stretch, wheels), by_gyro(recording.drive, stretch),
                  by_truth(recording, stretch, wheels), by_bearings(recording, stretch, wheels)}) {
    if (!one.tells()) continue;
    if (!one.agrees()) return false;
    shown = true;
  }
  return shown;
}

/// Where a wheel stands still and the other one goes so far.
std::vector<StillStretch> still_stretches(const std::vector<double>& wheel,
                                          const std::vector<double>& other, double least) {
  std::vector<StillStretch> stretches;
  StillStretch now;
  for (std::size_t row = 0; row <= wheel.size(); ++row) {
    if (row < wheel.size() && wheel[row] == 0.0) {
      now.travel += std::abs(other[row]);
      continue;
    }
    now.end = row;
    if (now.travel > least) stretches.push_back(now);
    now = {row + 1, 0, 0.0};
  }
  return stretches;
}

double way_of(const std::vector<double>& wheel) {
  double way = 0.0;
  for (const double travel : wheel) way += std::abs(travel);
  return way;
}

void ask(Checked& checked, const std::vector<double>& wheels, const char* name,
         const std::vector<double>& wheel, const std::vector<double>& other) {
  const double others = way_of(other);
  if (others > 1.0 && way_of(wheel) < kStillShare * others) {
    if (turns_about_it(checked, {0, wheel.size(), others}, wheels)) return;
    checked.add("drive.csv", name, "still wheel",
                text::joined("the ", name, " wheel never moves, where the other one goes ",
                             figure(others, "m")),
                "look at the encoder's cable and at the column's source");
    return;
  }
  const double least = std::max(kStillTravel, kStillTurns * checked.wheelbase);
  std::vector<StillStretch> stretches = still_stretches(wheel, other, least);
  std::erase_if(stretches,
                [&](const StillStretch& one) { return turns_about_it(checked, one, wheels); });
  if (stretches.empty()) return;
  const StillStretch& longest = *std::max_element(
      stretches.begin(), stretches.end(),
      [](const StillStretch& a, const StillStretch& b) { return a.travel < b.travel; });
  checked.add("drive.csv", name, "still wheel",
              text::joined("the ", name, " wheel stands still until t = ",
                           figure(checked.recording.drive.t[longest.end - 1], "s"),
                           " while the other one goes ", figure(longest.travel, "m")),
              "look at the encoder: it seems to have lost its counts there");
}

}  // namespace

void check_still_wheels(Checked& checked) {
  const MotionRows& drive = checked.recording.drive;
  const std::vector<double> wheels = wheel_headings(drive);
  ask(checked, wheels, "left", drive.pair.left, drive.pair.right);
  ask(checked, wheels, "right", drive.pair.right, drive.pair.left);
}

}  // namespace trussmap::check
