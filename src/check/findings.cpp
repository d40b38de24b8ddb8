// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/findings.hpp"

#include "text/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace trussmap::check {

void Checked::add(const char* file, const std::string& column, const char* kind,
                  const std::string& evidence, const std::string& remedy) {
  findings.push_back({recording.name + "/" + file, column, kind, evidence, remedy});
  std::string one;
  for (const char c : column + ",") {
    if (c != ',') {
      one += c;
      continue;
    }
    // "x" of the truth, or of a fix, is not that of the survey.
    wrong.insert(std::string(file) == "truth.csv"   ? "truth " + one
                 : std::string(file) == "fixes.csv" ? "fix " + one
                                                    : one);
    const std::vector<WheelColumn>& wheels = recording.drive.wheels;
    const bool wheel = std::any_of(wheels.begin(), wheels.end(),
                                   [&one](const WheelColumn& each) { return each.name == one; });
    if (wheel) wrong.insert({"left", "right"});  // which are made of it
    one.clear();
  }
}

void Checked::note(const char* file, const std::string& column, const char* kind,
                   const std::string& evidence, const std::string& remedy) {
  findings.push_back({recording.name + "/" + file, column, kind, evidence, remedy});
  broken = true;
}

const char* lone_wheel(WheelMistake mistake) {
  return mistake == WheelMistake::left_negated ? "left" : "right";
}

void add_lone_wheel(Checked& checked, WheelMistake mistake, const std::string& evidence) {
  const std::string name = lone_wheel(mistake);
  checked.add("drive.csv", name, "wheel negated", evidence, "change the sign of " + name);
}

std::string figure(double value, const char* unit) {
  const std::string text = text::short_text(value, 3);
  return *unit == '\0' ? text : text + " " + unit;
}

std::string unit_of_ratio(double ratio) {
  struct Unit {
    const char* name;
    double ratio;
  };
  static constexpr std::array<Unit, 4> kUnits{
      {{"mm", 1000.0}, {"cm", 100.0}, {"inches", 39.37}, {"feet", 3.281}}};
  for (const Unit& one : kUnits) {
    if (std::abs(std::log(ratio / one.ratio)) < 0.35) return one.name;
  }
  return {};
}

bool looks_like_a_unit(double ratio) {
  return !unit_of_ratio(ratio).empty() || !unit_of_ratio(1.0 / ratio).empty();
}

}  // namespace trussmap::check

namespace trussmap {

const std::vector<std::string>& check_kinds() {
  static const std::vector<std::string> kKinds = {"travel unit",
                                                  "time unit",
                                                  "range unit",
                                                  "survey unit",
                                                  "truth unit",
                                                  "fix unit",
                                                  "angle unit",
                                                  "other clock",
                                                  "clock set",
                                                  "counter glitch",
                                                  "spike",
                                                  "gap",
                                                  "no travel",
                                                  "no turning",
                                                  "constant column",
                                                  "still wheel",
                                                  "no motion",
                                                  "wheels exchanged",
                                                  "wheels negated",
                                                  "wheel negated",
                                                  "wheels unsigned",
                                                  "steering clockwise",
                                                  "still steering",
                                                  "gyro clockwise",
                                                  "compass clockwise",
                                                  "compass turned",
                                                  "bearings clockwise",
                                                  "yaws clockwise",
                                                  "survey mirrored",
                                                  "fixes mirrored",
                                                  "truth mirrored",
                                                  "truth turned",
                                                  "turns opposite",
                                                  "blank in a name",
                                                  "names differ in case",
                                                  "one name at two places",
                                                  "wrong label",
                                                  "rows twice",
                                                  "cut off",
                                                  "same session twice",
                                                  "other landmarks",
                                                  "survey at one point",
                                                  "survey on a line",
                                                  "survey point off",
                                                  "labels exchanged",
                                                  "no wheelbase",
                                                  "impossible wheelbase",
                                                  "impossible length",
                                                  "nothing to test"};
  return kKinds;
}

std::string in_words(const CheckFinding& finding) {
  return text::joined(finding.file, finding.column.empty() ? "" : ", " + finding.column, ": ",
                      finding.kind, ": ", finding.evidence, "; remedy: ", finding.remedy);
}

}  // namespace trussmap
