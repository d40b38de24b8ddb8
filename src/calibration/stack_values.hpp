// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constants in the words of programs that robots are often driven by.
//
//   ros2_controllers   diff_drive_controller, mecanum_drive_controller,
//   omni_wheel_drive_controller,
//                      ackermann_steering_controller, tricycle_steering_controller: their
//                      parameters
//   Road Runner        TankDrive and MecanumDrive: inches per tick, track in ticks
//
// Road Runner turns by (right - left)/trackWidthTicks, in ticks: the track over the wheels' size.
#pragma once

#include "calibration/constant_values.hpp"
#include "trussmap/calibrate.hpp"

#include <vector>

namespace trussmap::calibration {

/// Of those constants of the list that were determined. `robot`: as the model given has it, of
/// which multipliers are multiples; `values`: all that was found; `mean`: whether the wheels' mean
/// size was.
[[nodiscard]] std::vector<StackValue> stack_values(const Robot& robot,
                                                   const std::vector<RobotConstant>& list,
                                                   const std::vector<ConstantValue>& values,
                                                   bool mean);

}  // namespace trussmap::calibration
