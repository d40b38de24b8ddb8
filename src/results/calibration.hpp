// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What calibrate writes.
#pragma once

#include "results/common.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/texts.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

[[nodiscard]] inline std::optional<double> value_in(const std::optional<Calibrated>& one) {
  return one ? std::optional(one->value) : std::nullopt;
}
[[nodiscard]] inline std::optional<double> sd_in(const std::optional<Calibrated>& one) {
  return one ? std::optional(one->sd) : std::nullopt;
}

// ----------------------------------------
// Legs and whole drives that it has not seen.

/// Nothing where no leg was held out.
template <auto kMember>
[[nodiscard]] std::optional<double> rms_of(const CalibrationValidation& held) {
  return held.legs() > 0 ? std::optional((held.*kMember).rms()) : std::nullopt;
}
[[nodiscard]] inline const char* scheme_of(const CalibrationValidation& held) {
  switch (held.scheme) {
    case HoldoutScheme::blocks:
      return "blocks of legs";
    case HoldoutScheme::recordings:
      return "recordings";
    case HoldoutScheme::none:
      break;
  }
  return nullptr;
}

template <>
inline constexpr auto kDescribed<CalibrationValidation> = described(
    field("legs", &CalibrationValidation::legs, "held out").at_least(0.0),
    field(
        "held_out",
        [](const CalibrationValidation& held) {
          const char* scheme = scheme_of(held);
          return scheme == nullptr ? std::nullopt : std::optional<std::string>(scheme);
        },
        "null: none")
        .one_of("blocks of legs | recordings"),
    field("arrival_rms_m", rms_of<&CalibrationValidation::calibrated>,
          "of dead reckoning over a leg, as calibrated"),
    field("arrival_rms_nominal_m", rms_of<&CalibrationValidation::nominal>, "by the model given"));

/// One drive of --test.
struct TestedDrive {
  std::string recording;
  DriveError nominal;
  DriveError calibrated;
};
template <>
inline constexpr auto kDescribed<TestedDrive> = described(
    field("recording", &TestedDrive::recording, "its name"),
    field("driven_m", through(&TestedDrive::nominal, &DriveError::driven), "by the wheels"),
    field("end_m", through(&TestedDrive::calibrated, &DriveError::end), "error, as calibrated"),
    field("end_nominal_m", through(&TestedDrive::nominal, &DriveError::end), "by the model given"),
    field("heading_rad_per_m", through(&TestedDrive::calibrated, &DriveError::heading_per_metre),
          "error, as calibrated"),
    field("heading_nominal_rad_per_m",
          through(&TestedDrive::nominal, &DriveError::heading_per_metre), "by the model given"));

[[nodiscard]] inline std::vector<TestedDrive> each_of(const TestedDrives& test) {
  std::vector<TestedDrive> each;
  for (std::size_t k = 0; k < test.names.size(); ++k) {
    each.push_back({test.names[k], test.nominal[k], test.calibrated[k]});
  }
  return each;
}

template <>
inline constexpr auto kDescribed<TestedDrives> = described(
    field(
        "recordings", [](const TestedDrives& test) { return test.names.size(); }, "of --test"),
    field("end_rms_m", through(&TestedDrives::calibrated, rms_end),
          "of whole drives, as calibrated"),
    field("end_rms_nominal_m", through(&TestedDrives::nominal, rms_end), "by the model given"),
    field("heading_rms_rad_per_m", through(&TestedDrives::calibrated, rms_heading_per_metre),
          "as calibrated"),
    field("heading_rms_nominal_rad_per_m", through(&TestedDrives::nominal, rms_heading_per_metre),
          "by the model given"),
    field("each", each_of));

// ----------------------------------------
// How truth, fixes and sensors are mounted.

/// The clock of a session's truth, or how late its fixes are.
struct SessionClock {
  int session = 0;
  TruthClock clock;
};
template <>
inline constexpr auto kDescribed<SessionClock> =
    described(field("session", &SessionClock::session, "its number, from 0").at_least(0.0),
              field("late_s", through(&SessionClock::clock, &TruthClock::late),
                    "rows are stamped late by this at the drive's start"),
              field("drift", through(&SessionClock::clock, &TruthClock::drift), "s/s"));

[[nodiscard]] inline std::vector<SessionClock> clocks_of(const TruthAlignment& truth) {
  std::vector<SessionClock> clocks;
  for (const auto& [session, clock] : truth.clocks) clocks.push_back({session, clock});
  return clocks;
}

template <>
inline constexpr auto kDescribed<TruthAlignment> = described(
    field("ahead_m", &TruthAlignment::ahead, "of the axle's centre, where the tracked point is"),
    field("left_m", &TruthAlignment::left, "likewise"),
    field("heading_rad", &TruthAlignment::heading, "the truth's less the robot's"),
    field("clocks", clocks_of));

struct LateFixes {
  int session = 0;
  double late = 0.0;  ///< s
};
template <>
inline constexpr auto kDescribed<LateFixes> =
    described(field("session", &LateFixes::session, "its number, from 0").at_least(0.0),
              field("late_s", &LateFixes::late, "fixes are stamped late by this"));

[[nodiscard]] inline std::vector<LateFixes> late_fixes_of(const FixAlignment& fixes) {
  std::vector<LateFixes> late;
  for (const auto& [session, one] : fixes.late) late.push_back({session, one});
  return late;
}

template <>
inline constexpr auto kDescribed<FixAlignment> =
    described(field("ahead_m", &FixAlignment::ahead,
                    "of the axle's centre, where the point is that fixes have"),
              field("left_m", &FixAlignment::left, "likewise"), field("sessions", late_fixes_of));

template <>
inline constexpr auto kDescribed<CalibratedMounting> =
    described(field("x", through(&CalibratedMounting::x, value_in), "m ahead"),
              field("sd_x", through(&CalibratedMounting::x, sd_in), "m"),
              field("y", through(&CalibratedMounting::y, value_in), "m to the left"),
              field("sd_y", through(&CalibratedMounting::y, sd_in), "m"),
              field("yaw", through(&CalibratedMounting::yaw, value_in), "rad; an antenna has none"),
              field("sd_yaw", through(&CalibratedMounting::yaw, sd_in), "rad"));

template <>
inline constexpr auto kDescribed<DriveConstant> =
    described(field("g", through(&DriveConstant::g, &Calibrated::value), "in the channel's unit"),
              field("sd", through(&DriveConstant::g, &Calibrated::sd), "its standard error"));

// ----------------------------------------
// The wheels.

/// A figure of the wheels and its standard error.
template <auto kMember>
[[nodiscard]] constexpr auto figure(const char* name, const char* sd_name, const char* about) {
  return std::tuple(field(name, through(kMember, value_in), about),
                    field(sd_name, through(kMember, sd_in), "standard error"));
}

[[nodiscard]] inline Keyed<DriveConstant> constants_by_channel(const WheelCalibration& found) {
  Keyed<DriveConstant> constants;
  for (const DriveConstant& one : found.constants) {
    constants.values.emplace_back(name_of(one.channel), one);
  }
  return constants;
}
[[nodiscard]] inline Keyed<CalibratedMounting> mountings_by_name(const WheelCalibration& found) {
  Keyed<CalibratedMounting> mountings;
  for (const CalibratedMounting& one : found.mountings) mountings.values.emplace_back(one.of, one);
  return mountings;
}

template <>
inline constexpr auto kDescribed<WheelCalibration> = described(
    figure<&WheelCalibration::diameter_ratio>(
        "E_d", "sd_E_d", "right over left wheel diameter; null: not determined"),
    figure<&WheelCalibration::wheelbase_ratio>(
        "E_b", "sd_E_b", "actual over nominal wheelbase; null: not determined"),
    figure<&WheelCalibration::scale>("E_s", "sd_E_s",
                                     "true over measured travel; null: not determined"),
    figure<&WheelCalibration::noise_left>("k_left", "sd_k_left",
                                          "wheel noise, m^(1/2); null: not determined"),
    figure<&WheelCalibration::noise_right>("k_right", "sd_k_right",
                                           "wheel noise, m^(1/2); null: not determined"),
    field("drive_constants", constants_by_channel,
          "of drives without a left and a right wheel, by channel")
        .if_any(),
    field("chi2", &WheelCalibration::chi2, "of the adjustment"),
    field("dof", &WheelCalibration::dof, "its degrees of freedom"),
    field("truth",
          [](const WheelCalibration& found) {
            return found.truth.clocks.empty() ? nullptr : &found.truth;
          })
        .if_any(),
    field("fixes",
          [](const WheelCalibration& found) {
            return found.fixes.late.empty() ? nullptr : &found.fixes;
          })
        .if_any(),
    field("mountings", mountings_by_name,
          "where sensors sit, by their keys in [robot]: sensor, antenna, tracked, scanner; m from "
          "the axle's centre, rad, with standard errors; null: not determined")
        .if_any(),
    field("settled", &WheelCalibration::settled,
          "false: the recordings contradict wheels that differ in these figures alone"),
    field("undetermined", &WheelCalibration::undetermined, "what was not determined, and why"),
    field("left_out", &WheelCalibration::left_out,
          "sightings, fixes and loops that contradict all others; nothing is made of them")
        .if_any());

/// What calibrate says.
struct CalibrationReport {
  const WheelCalibration* found = nullptr;
  const CalibrationValidation* held = nullptr;
  const std::optional<TestedDrives>* test = nullptr;
};
template <>
inline constexpr auto kDescribed<CalibrationReport> = described(
    keys_of("found", &CalibrationReport::found),
    field("heldout",
          [](const CalibrationReport& one) -> const CalibrationValidation& { return *one.held; }),
    field("test", [](const CalibrationReport& one) {
      return *one.test ? &**one.test : nullptr;
    }).if_any());

}  // namespace trussmap::results
