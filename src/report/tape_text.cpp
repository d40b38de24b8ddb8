// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "report/quantity_cells.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// "the wheelbase is 0.61 +- 0.01 % smaller than nominal".
std::string taped_in_words(const char* name, Channel channel, double g, double sd) {
  return in_words(Effect{name, channel, {"1"}, {g}, false}, {sd});
}

/// What is off, a sentence each.
std::vector<std::string> off_in_words(const TapeCalibration& found) {
  std::vector<std::string> words;
  if (is_off(found.scale, 1.0)) {
    words.push_back(taped_in_words("wheel scale", Channel::wheels, found.scale->value - 1.0,
                                   found.scale->standard_error));
  }
  if (is_off(found.wheelbase_ratio, 1.0)) {
    const Estimate& ratio = *found.wheelbase_ratio;
    words.push_back(taped_in_words("wheelbase", Channel::turn, 1.0 / ratio.value - 1.0,
                                   ratio.standard_error / (ratio.value * ratio.value)));
  }
  if (is_off(found.diameter_ratio, 1.0)) {
    const Estimate& ratio = *found.diameter_ratio;
    const double sum = ratio.value + 1.0;
    words.push_back(taped_in_words("wheel diameter ratio", Channel::difference,
                                   2.0 * (ratio.value - 1.0) / sum,
                                   4.0 * ratio.standard_error / (sum * sum)));
  }
  if (is_off(found.gyro_scale, 0.0)) {
    words.push_back(taped_in_words("gyro scale", Channel::gyro_scale, found.gyro_scale->value,
                                   found.gyro_scale->standard_error));
  }
  if (is_off(found.gyro_bias, 0.0)) {
    words.push_back(taped_in_words("gyro bias", Channel::gyro, found.gyro_bias->value,
                                   found.gyro_bias->standard_error));
  }
  return words;
}

std::string tape_verdict_text(const TapeCalibration& found, TextStyle style) {
  std::string off;
  for (const std::string& one : off_in_words(found)) off += (off.empty() ? "" : "; ") + one;
  switch (tape_verdict(found)) {
    case TapeVerdict::worth_correcting:
      if (off.empty()) off = "the robot turns otherwise than its odometry says";
      return verdict_text(Mood::doubt, "worth correcting: " + off, style);
    case TapeVerdict::nothing_to_correct:
      return verdict_text(Mood::good,
                          "nothing to correct: all that was found lies within three standard "
                          "errors of what the robot calculates with",
                          style);
    case TapeVerdict::unsure:
      return verdict_text(Mood::doubt,
                          "cannot tell: nothing that was found has a standard error to judge it by",
                          style);
    case TapeVerdict::doubtful:
      break;
  }
  return verdict_text(Mood::doubt,
                      "doubtful: correct by this once the warnings below are settled" +
                          (off.empty() ? off : "; " + off),
                      style);
}

std::string label_of(const TapedConstant& constant) {
  if (constant.name == "gyro scale") return "gyro's turns times";
  if (constant.name == "gyro bias") return "taken off the gyro's rate";
  if (constant.name == "wheelbase") return "wheelbase";
  return constant.name + (constant.name == "wheels" ? "' travel times" : "'s travel times");
}

std::string use_text(const std::vector<TapedConstant>& constants, bool doubtful, TextStyle style) {
  if (constants.empty()) return "";
  TextTable table{{Align::left, Align::right, Align::left, Align::left}, {}, false, 4};
  for (const TapedConstant& one : constants) {
    const std::vector<std::string> cells = report::quantity_cells(one.now);
    table.rows.push_back({label_of(one), cells[0], cells[1], one.unit});
  }
  return fmt::format("\n  {}:\n{}",
                     doubtful ? "What the runs come to as they are" : "Use from now on",
                     table_text(table, style));
}

std::string found_text(const TapeCalibration& found, TextStyle style) {
  TextTable table{{Align::left, Align::right, Align::left, Align::left, Align::left}, {}, true, 2};
  table.rows.push_back({"", "", "", "", "by"});
  const auto row = [&](const char* name, const std::optional<Estimate>& one, double size,
                       const char* unit, int runs, const char* what) {
    if (!one) return;
    const std::vector<std::string> cells =
        report::quantity_cells({size * one->value, size * one->standard_error, one->dof});
    table.rows.push_back(
        {name, cells[0], cells[1], unit, fmt::format("{} {}{}", runs, what, runs == 1 ? "" : "s")});
  };
  row("E_s  true / measured travel", found.scale, 1.0, "", found.straight_runs, "straight run");
  row("E_b  wheelbase / believed", found.wheelbase_ratio, 1.0, "", found.turns, "turn");
  row("E_d  right wheel / left wheel", found.diameter_ratio, 1.0, "", found.straight_runs,
      "straight run");
  row("     true / measured turning", found.turn_factor, 1.0, "", found.turns, "turn");
  row("gyro scale", found.gyro_scale, 100.0, "%", found.turns, "turn");
  if (found.rests > 0) {
    row("gyro bias", found.gyro_bias, geometry::kDegrees * 60.0, "deg/min", found.rests, "rest");
  } else {
    row("gyro bias", found.gyro_bias, geometry::kDegrees * 60.0, "deg/min", found.turns, "turn");
  }
  return table.rows.size() > 1 ? "\n" + table_text(table, style) : "";
}

std::string look_alikes_text(const TapeCalibration& found) {
  if (!found.wheelbase_ratio || found.look_alikes.empty()) return "";
  std::string names;
  for (const std::string& one : found.look_alikes) names += (names.empty() ? "" : ", ") + one;
  return fmt::format(
      "\n  E_b is turning as a whole: by these turns {} look{} the same as the wheelbase.\n", names,
      found.look_alikes.size() == 1 ? "s" : "");
}

}  // namespace

std::string_view name_of(TapeVerdict verdict) {
  switch (verdict) {
    case TapeVerdict::worth_correcting:
      return "worth correcting";
    case TapeVerdict::nothing_to_correct:
      return "nothing to correct";
    case TapeVerdict::unsure:
      return "cannot tell";
    case TapeVerdict::doubtful:
      break;
  }
  return "doubtful";
}

std::string tape_text(const TapeCalibration& found, const std::vector<TapedConstant>& constants,
                      TextStyle style) {
  std::string out = tape_verdict_text(found, style) + "\n" +
                    use_text(constants, !found.doubts.empty(), style) + found_text(found, style) +
                    look_alikes_text(found);
  for (const std::string& one : found.undetermined) out += "\nnot determined: " + one + "\n";
  if (!found.notes.empty()) out += "\n" + notes_text(found.notes);
  return out + warnings_text(found.doubts, style);
}

}  // namespace trussmap
