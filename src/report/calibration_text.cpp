// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/number_text.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kFarTooLarge = 2.0;  // chi^2/dof: more than any choice of noise explains
constexpr int kFewest = 10;           // degrees of freedom that tell of noise stated too large

struct Verdict {
  Mood mood = Mood::doubt;
  std::string text;
};

bool nothing_determined(const WheelCalibration& found) {
  return !found.diameter_ratio && !found.wheelbase_ratio && !found.scale && !found.noise_left &&
         !found.noise_right && found.constants.empty();
}

/// What the held-out legs say of the calibration.
Verdict of_held_out(const CalibrationValidation& held) {
  const std::string errors = fmt::format(
      "{} {} end {:.1f} mm off (rms), nominal {:.1f} mm", held.legs(),
      held.scheme == HoldoutScheme::recordings ? "legs, each recording held out in turn,"
                                               : "held-out legs",
      1000.0 * held.calibrated.rms(), 1000.0 * held.nominal.rms());
  switch (held.gain()) {
    case CalibrationGain::unknown:
      return {Mood::doubt, "calibrated; no legs with truth could be held out to judge it by"};
    case CalibrationGain::uncertain:
      return {Mood::doubt,
              "calibrated: " + errors + "; too few legs, or too short, to tell which is better"};
    case CalibrationGain::better:
      return {Mood::good, "calibrated: " + errors};
    case CalibrationGain::worse:
      break;
  }
  return {Mood::bad, "calibration does not help: " + errors};
}

double dispersion_of(const WheelCalibration& found) {
  return found.dof > 0 ? found.chi2 / found.dof : 0.0;
}

/// The same, and whether the constants explain what they were found from.
Verdict verdict(const WheelCalibration& found, const CalibrationValidation& held) {
  if (nothing_determined(found)) {
    return {Mood::bad, "nothing determined: these recordings show none of the constants"};
  }
  Verdict result = of_held_out(held);
  const double dispersion = dispersion_of(found);
  if (dispersion > kFarTooLarge) {
    if (result.mood == Mood::good) result.mood = Mood::doubt;
    result.text += fmt::format("; but errors are {} times what the model's noise allows",
                               text::times_text(std::sqrt(dispersion)));
  }
  return result;
}

std::vector<std::string> cells_of(const std::string& name, const QuantityText& size,
                                  const std::string& unit) {
  return {name, size.value, size.error.empty() ? "" : "\u00b1 " + size.error, unit};
}

std::string told(const TestedDrives& test) {
  const auto line = [](const char* what, double before, double after, const char* unit) {
    return fmt::format("  {}  {:8.1f} -> {:.1f} {}\n", what, 1000.0 * before, 1000.0 * after, unit);
  };
  return fmt::format(
             "\n{} kept for the test, nominal -> calibrated (rms):\n",
             test.names.size() == 1 ? "1 drive" : fmt::format("{} drives", test.names.size())) +
         line("end point off by        ", rms_end(test.nominal), rms_end(test.calibrated), "mm") +
         line("heading off by, per metre", rms_heading_per_metre(test.nominal),
              rms_heading_per_metre(test.calibrated), "mrad/m");
}

/// "95 ms early", "20 ms early to 30 ms late" where sessions differ.
std::string lateness(const std::vector<double>& late) {
  const auto words = [](double one) {
    return fmt::format("{:.0f} ms {}", 1000.0 * std::abs(one), one < 0.0 ? "early" : "late");
  };
  const auto [least, most] = std::minmax_element(late.begin(), late.end());
  const std::string one = words(*least);
  const std::string other = words(*most);
  return one == other ? one : one + " to " + other;
}

std::string thousandths(double metres) {
  return text::without_sign_of_nothing(text::fixed_text(1000.0 * metres, 1));
}

std::string told(const TruthAlignment& truth) {
  std::vector<double> late;
  late.reserve(truth.clocks.size());
  for (const auto& [session, clock] : truth.clocks) late.push_back(clock.late);
  return fmt::format(
      "  truth: the point tracked is {} mm ahead and {} mm left of the axle's centre, its\n"
      "  heading is off by {} mrad, its rows are {} at the start\n",
      thousandths(truth.ahead), thousandths(truth.left), thousandths(truth.heading),
      lateness(late));
}

std::string told(const FixAlignment& fixes) {
  std::vector<double> late;
  late.reserve(fixes.late.size());
  for (const auto& [session, one] : fixes.late) late.push_back(one);
  return fmt::format(
      "  fixes: of a point {} mm ahead and {} mm left of the axle's centre, stamped {}\n",
      thousandths(fixes.ahead), thousandths(fixes.left), lateness(late));
}

/// A few of them by what they say.
std::string left_out_text(const std::vector<std::string>& left_out) {
  constexpr std::size_t kNamed = 5;
  std::string out =
      fmt::format("  {} measurement{} left out, for all others contradict {}:\n", left_out.size(),
                  left_out.size() == 1 ? "" : "s", left_out.size() == 1 ? "it" : "them");
  for (std::size_t k = 0; k < std::min(kNamed, left_out.size()); ++k) {
    out += "    " + left_out[k] + "\n";
  }
  if (left_out.size() > kNamed) out += fmt::format("    and {} more\n", left_out.size() - kNamed);
  return out;
}

std::string words_of(const CalibratedMounting& mounting) {
  return mounting.of == "tracked" ? "truth's point" : mounting.of;
}

}  // namespace

std::string calibration_text(const WheelCalibration& found, const CalibrationValidation& held,
                             const std::optional<TestedDrives>& test, TextStyle style) {
  const auto [mood, said] = verdict(found, held);
  std::string out = verdict_text(mood, said, style) + "\n";
  TextTable table;
  table.columns = {Align::left, Align::right, Align::left};
  const auto row = [&table](const char* name, const std::optional<Calibrated>& one,
                            const char* unit) {
    if (!one) return;
    table.rows.push_back(cells_of(name, quantity_text(one->value, one->sd), unit));
  };
  table.columns.push_back(Align::left);
  row("E_d  right wheel / left wheel", found.diameter_ratio, "");
  row("E_b  wheelbase / nominal", found.wheelbase_ratio, "");
  row("E_s  true / measured travel", found.scale, "");
  row("k    left wheel's noise", found.noise_left, "m^1/2");
  row("k    right wheel's noise", found.noise_right, "m^1/2");
  for (const DriveConstant& one : found.constants) {
    const std::string name(facts_of(one.channel).does_what);
    const std::string unit(facts_of(one.channel).unit);
    const double size = unit.empty() ? 100.0 : 1.0;
    table.rows.push_back(cells_of(name, quantity_text(size * one.g.value, size * one.g.sd),
                                  unit.empty() ? "%" : unit));
  }
  for (const CalibratedMounting& one : found.mountings) {
    const std::string of = words_of(one);
    row((of + ", ahead of the axle").c_str(), one.x, "m");
    row((of + ", to its left").c_str(), one.y, "m");
    row((of + ", turned to the left").c_str(), one.yaw, "rad");
  }
  out += "\n" + table_text(table, style);
  const double dispersion = dispersion_of(found);
  out += fmt::format("\n  chi2/dof {:.3f} with {} degrees of freedom\n", dispersion, found.dof);
  if (dispersion > kFarTooLarge) {
    out += fmt::format(
        "  take the \u00b1 {} times as large: that is how far errors are beyond the model's "
        "noise\n",
        text::times_text(std::sqrt(dispersion)));
  } else if (found.dof >= kFewest && dispersion < 1.0 / kFarTooLarge) {
    out += fmt::format(
        "  errors are {:.2g} times what the model's noise allows: it is stated too large, and so "
        "is the \u00b1\n",
        std::sqrt(dispersion));
  }
  if (!found.left_out.empty()) {
    out += left_out_text(found.left_out);
  }
  if (!found.truth.clocks.empty()) out += told(found.truth);
  if (!found.fixes.late.empty()) out += told(found.fixes);
  if (test) out += told(*test);
  for (const std::string& one : found.undetermined) out += "\nnot determined: " + one + "\n";
  if (!found.settled) {
    out += "\n" + warning_text(
                      "the last round still moved an estimate by more than a tenth of its standard "
                      "error: wheels that differ in these figures alone do not explain the "
                      "recordings (trussmap diagnose looks for what does)",
                      style);
  }
  return out;
}

std::string calibration_verdict(const WheelCalibration& found, const CalibrationValidation& held) {
  std::string sentence = verdict(found, held).text + ".";
  sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
  return sentence;
}

}  // namespace trussmap
