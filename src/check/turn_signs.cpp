// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/turn_signs.hpp"

#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace trussmap::check {
namespace {

constexpr double kBackwards = -0.5;  // share of the way, of a robot that drives backwards

constexpr Turning kAll[] = {Turning::wheels,      Turning::compass,     Turning::gyro,
                            Turning::bearings,    Turning::yaws,        Turning::survey,
                            Turning::fixes,       Turning::whole_truth, Turning::truth_heading,
                            Turning::truth_course};

struct Blame {
  const char* file;
  std::string column;
  const char* kind;
  std::string words;
  std::string remedy;
};

/// A robot that seems to drive backwards nearly all the time has its wheels negated, not exchanged.
Blame blame_of_wheels(const MotionRows& drive, double forward) {
  const bool steered = !drive.wheels.empty() && drive.wheels.back().steers;
  if (drive.of_two_wheels()) {
    if (forward < kBackwards) {
      return {"drive.csv", "left,right", "wheels negated", "both wheels negated",
              "change the sign of left and right"};
    }
    return {"drive.csv", "left,right", "wheels exchanged", "wheels exchanged",
            "exchange the columns left and right"};
  }
  const std::string columns = wheel_columns(drive);
  const bool unicycle = !drive.unicycle.empty();
  if (forward < kBackwards) {
    const std::string travels = steered    ? drive.wheels.front().name
                                : unicycle ? drive.unicycle.front()
                                           : columns;
    return {"drive.csv", travels, "wheels negated", "the wheels negated",
            "change the sign of " + travels};
  }
  if (unicycle) {
    const std::string& name = drive.unicycle.back();
    return {"drive.csv", name, "turn clockwise", "a turn that is positive to the right",
            "change the sign of " + name};
  }
  if (steered) {
    const std::string& name = drive.wheels.back().name;
    return {"drive.csv", name, "steering clockwise",
            "a steering angle that is positive to the right", "change the sign of " + name};
  }
  return {"drive.csv", columns, "wheels exchanged", "wheels exchanged, left with right",
          "name the columns in the order that the drive has, the left side's and the right side's"};
}

Blame blame_of(Turning quantity, const MotionRows& drive, double forward) {
  switch (quantity) {
    case Turning::wheels:
      return blame_of_wheels(drive, forward);
    case Turning::compass:
      return {"drive.csv", "heading", "compass clockwise", "a compass that counts clockwise",
              "change the sign of heading; where it counts from north, too: pi/2 - heading"};
    case Turning::gyro:
      return {"drive.csv", "yaw_rate", "gyro clockwise", "a gyro that counts clockwise",
              "change the sign of yaw_rate"};
    case Turning::bearings:
      return {"sightings.csv", "bearing", "bearings clockwise", "bearings that count clockwise",
              "change the sign of bearing"};
    case Turning::yaws:
      return {"sightings.csv", "yaw", "yaws clockwise",
              "yaws that count clockwise, or from the landmark's axis to the robot's",
              "change the sign of yaw: the landmark's axis less the robot's heading"};
    case Turning::survey:
      return {"survey.csv", "x,y", "survey mirrored", "a survey with x and y exchanged",
              "exchange x and y, or change the sign of one of them"};
    case Turning::fixes:
      return {"fixes.csv", "x,y", "fixes mirrored", "fixes with x and y exchanged",
              "x to the east and y to the north, or as in the map"};
    case Turning::whole_truth:
    case Turning::truth_heading:
    case Turning::truth_course:
      break;
  }
  return {"truth.csv", "x,y,heading", "truth mirrored", "a truth with axes exchanged",
          "make x, y and heading right-handed: counter-clockwise from x to y"};
}

/// Share of the way that leads forward.
double forward_share(const MotionRows& drive) {
  double forward = 0.0;
  double all = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double path = drive.forward[row];
    forward += path;
    all += std::abs(path);
  }
  return all > 0.0 ? forward / all : 0.0;
}

}  // namespace

void TurnSigns::add(Turning a, Turning b, int sign, const char* words) {
  if (sign == 0) return;
  known_.push_back({a, b, sign});
  if (sign < 0) seen_ += std::string(seen_.empty() ? "" : ", ") + words;
}

std::vector<Turning> TurnSigns::culprits() const {
  std::vector<Turning> result;
  const bool wrong =
      std::any_of(known_.begin(), known_.end(), [](const Known& one) { return one.sign < 0; });
  if (!wrong) return result;
  for (const Turning q : kAll) {
    const auto is_of = [q](Turning one) {
      return one == q || (q == Turning::whole_truth &&
                          (one == Turning::truth_heading || one == Turning::truth_course));
    };
    const auto explains = [&is_of](const Known& one) {
      return (is_of(one.a) || is_of(one.b)) == (one.sign < 0);
    };
    if (std::all_of(known_.begin(), known_.end(), explains)) result.push_back(q);
  }
  return result.empty() ? suspects() : result;
}

/// Where no mistake alone explains all: whatever is contradicted.
std::vector<Turning> TurnSigns::suspects() const {
  std::set<Turning> all;
  for (const Known& one : known_) {
    if (one.sign < 0) all.insert({one.a, one.b});
  }
  if (all.contains(Turning::truth_heading) && all.contains(Turning::truth_course)) {
    all.erase(Turning::truth_heading);
    all.erase(Turning::truth_course);
    all.insert(Turning::whole_truth);
  }
  return {all.begin(), all.end()};
}

void blame(Checked& checked, const TurnSigns& signs) {
  const std::vector<Turning> culprits = signs.culprits();
  if (culprits.empty()) return;
  const MotionRows& drive = checked.recording.drive;
  const double forward = forward_share(drive);
  const Blame first = blame_of(culprits.front(), drive, forward);
  if (culprits.size() == 1) {
    checked.add(first.file, first.column, first.kind, signs.seen(), first.remedy);
    return;
  }
  std::string words;
  std::string columns;
  for (const Turning one : culprits) {
    const Blame each = blame_of(one, drive, forward);
    words += text::joined(words.empty() ? "" : ", or ", each.words, " (", each.file, ")");
    if (std::string(each.file) == first.file) {
      columns += text::joined(columns.empty() ? "" : ",", each.column);
    }
  }
  checked.add(first.file, columns, "turns opposite", signs.seen() + ": " + words,
              "drive a left turn and look which of them gets it wrong");
}

}  // namespace trussmap::check
