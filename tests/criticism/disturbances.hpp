// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects of the catalogue as disturbances of a robot: what a row truly was, by the definitions of
// the channels, from what was recorded.
#pragma once

#include "criticism/inverted_recordings.hpp"

#include <ostream>
#include <string>
#include <vector>

namespace trussmap::testing {

struct DisturbedCase {
  std::string effect;  ///< catalogue name
  std::vector<double> coefficients;
  Disturbance disturbance;
  InvertedOptions options;
};

inline void PrintTo(const DisturbedCase& one, std::ostream* stream) {
  *stream << one.effect;
}

inline std::vector<DisturbedCase> disturbed_cases() {
  using Motion = std::function<Travelled(const RecordedRow&)>;
  std::vector<DisturbedCase> cases;
  const auto add = [&cases](const std::string& effect,
                            std::vector<double> coefficients) -> DisturbedCase& {
    DisturbedCase one;
    one.effect = effect;
    one.coefficients = std::move(coefficients);
    cases.push_back(std::move(one));
    return cases.back();
  };
  const auto add_motion = [&add](const std::string& effect, double a, Motion motion) {
    add(effect, {a}).disturbance.motion = std::move(motion);
  };
  // Channels of the wheels: their travels change, then the two are reckoned as ever.
  const auto of_wheels = [](double left, double right) {
    return Travelled{0.5 * (left + right), (right - left) / kInvertedWheelbase};
  };
  add_motion("wheelbase", -0.02, [](const RecordedRow& row) {
    return Travelled{row.ds(), 0.98 * row.dtheta()};
  });
  add_motion("wheel diameter ratio", 0.006, [=](const RecordedRow& row) {
    return of_wheels(row.left * 0.997, row.right * 1.003);
  });
  add_motion("wheel scale", 0.015, [=](const RecordedRow& row) {
    return of_wheels(row.left * 1.015, row.right * 1.015);
  });
  add_motion("travel scale", -0.012, [](const RecordedRow& row) {
    return Travelled{0.988 * row.ds(), row.dtheta()};
  });
  add_motion("turn scrub", -0.045, [](const RecordedRow& row) {
    return Travelled{row.ds(), row.dtheta() * (1.0 - 0.045 * std::abs(row.turn_rate()))};
  });
  add_motion("turn asymmetry", 0.015, [](const RecordedRow& row) {
    return Travelled{row.ds(), row.dtheta() * (1.0 + (row.dtheta() > 0.0 ? 0.015 : -0.015))};
  });
  add_motion("slip with speed", -0.02, [](const RecordedRow& row) {
    return Travelled{row.ds() * (1.0 - 0.02 * row.speed()), row.dtheta()};
  });
  add_motion("loss per start", -0.008, [](const RecordedRow& row) {
    return Travelled{row.ds() - (row.starts ? 0.008 : 0.0), row.dtheta()};
  });
  add_motion("twist per spin", 0.015, [](const RecordedRow& row) {
    return Travelled{row.ds(), row.dtheta() + (row.spins ? 0.015 : 0.0)};
  });
  add_motion("load on the wheels (payload_kg)", -0.0008, [=](const RecordedRow& row) {
    const double gain = 1.0 - 0.0008 * row.payload;
    return of_wheels(gain * row.left, gain * row.right);
  });
  add_motion("load on one wheel (payload_kg)", -0.0004, [=](const RecordedRow& row) {
    return of_wheels((1.0 - 0.0004 * row.payload) * row.left, row.right);
  });
  add_motion("tyre drift with time", 5e-5, [=](const RecordedRow& row) {
    return of_wheels((1.0 + 5e-5 * row.t) * row.left, (1.0 + 5e-5 * row.t) * row.right);
  });
  add_motion("tyre drift with distance", -1.5e-4, [=](const RecordedRow& row) {
    const double gain = 1.0 - 1.5e-4 * row.distance;
    return of_wheels(gain * row.left, gain * row.right);
  });
  add_motion("heading drift", 0.002, [](const RecordedRow& row) {
    return Travelled{row.ds(), row.dtheta() + 0.002 * kInvertedRow};
  });
  add("constant creep", {0.02}).disturbance.creep = [](double) { return 0.02; };
  {
    DisturbedCase& one = add("cross-slope creep", {0.022, -0.011});
    one.disturbance.creep = [](double heading) {
      return 0.022 * std::sin(heading) - 0.011 * std::cos(heading);
    };
    one.options.straight = true;  // its laid path has one creep per leg
  }
  add("compass offset", {0.05}).disturbance.compass = [](double, double) { return 0.05; };
  add("hard iron", {0.03, -0.02}).disturbance.compass = [](double heading, double) {
    return 0.03 * std::sin(heading) - 0.02 * std::cos(heading);
  };
  add("soft iron", {-0.025, 0.015}).disturbance.compass = [](double heading, double) {
    return -0.025 * std::sin(2.0 * heading) + 0.015 * std::cos(2.0 * heading);
  };
  add("compass lag", {-0.036}).disturbance.compass = [](double, double turn_rate) {
    return -0.036 * turn_rate;
  };
  add("lever arm", {0.04}).disturbance.lever = 0.04;
  add("lever arm to the left", {-0.03}).disturbance.lever_left = -0.03;
  const auto add_seeing = [&add](const std::string& effect, double a) -> Disturbance& {
    DisturbedCase& one = add(effect, {a});
    one.options.views = true;
    return one.disturbance;
  };
  add_seeing("range bias", 0.06).range = 0.06;
  add_seeing("range scale", -0.02).range_scale = -0.02;
  add_seeing("bearing offset", 0.03).bearing = 0.03;
  add_seeing("sighting delay", 0.3).delay = 0.3;
  cases.back().options.on_the_way = true;
  return cases;
}

}  // namespace trussmap::testing
