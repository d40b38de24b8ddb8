// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/gross_starts.hpp"
#include "calibration/sensor_places.hpp"
#include "calibration/sought_constants.hpp"
#include "calibration/wheel_calibration.hpp"

#include <algorithm>
#include <vector>

namespace trussmap::calibration {
namespace {

/// The stated constants with those of a start in their place.
std::vector<double> at_start(std::vector<double> g, const GrossStart& start, const Robot& robot) {
  const std::vector<SoughtConstant> constants = sought_constants(robot);
  const bool wheels = std::ranges::any_of(
      constants, [](const SoughtConstant& one) { return one.channel == Channel::wheels; });
  const double way = start.travel.value_or(0.0);
  const double turned = wheels ? way : 0.0;  // larger wheels turn the robot further, too
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k].channel == Channel::turn) g[k] = (1.0 + start.turn) / (1.0 + turned) - 1.0;
    if (constants[k].channel == Channel::difference) g[k] = start.difference;
    if (constants[k].channel == Channel::steer) g[k] += start.steer;
    const bool scale =
        constants[k].channel == Channel::wheels || constants[k].channel == Channel::travel;
    if (scale && start.travel) g[k] = way;
  }
  return g;
}

}  // namespace

std::vector<std::vector<double>> likely_starts(const std::vector<DrivenRecording>& recordings,
                                               const Model& model,
                                               const WheelCalibrationOptions& options) {
  const std::vector<double> stated = in_force(model);
  std::vector<std::vector<double>> starts;
  Robot robot = model.robot;
  const auto add = [&] {
    for (const GrossStart& one : gross_starts(recordings, robot, options.problem)) {
      starts.push_back(at_start(stated, one, model.robot));
    }
  };
  add();
  // Places by turns that are wrong by a factor may be far off, those that are stated as well.
  const Mountings places = started_places(recordings, robot);
  if (places != robot.mounted) {
    robot.mounted = places;
    add();
  }
  starts.push_back(stated);
  return starts;
}

}  // namespace trussmap::calibration
