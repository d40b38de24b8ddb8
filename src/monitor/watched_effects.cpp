// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The monitor's own small set of effects, by the robot's drive: who only builds maps links no
// catalogue. A test holds names and channels to the catalogue's.
#include "effects/channel_physics.hpp"
#include "fit/row_at_hand.hpp"
#include "trussmap/monitor.hpp"

namespace trussmap {

std::vector<WatchedEffect> watched_effects(const Robot& robot, const OdometryInputs& inputs) {
  const std::vector<WatchedEffect> all{{"travel scale", Channel::travel, 0.01},
                                       {"wheelbase", Channel::turn, 0.03},
                                       {"wheel diameter ratio", Channel::difference, 0.01},
                                       {"left wheel", Channel::left, 0.01},
                                       {"right wheel", Channel::right, 0.01},
                                       {"heading drift", Channel::drift, 0.005},
                                       {"constant creep", Channel::creep, 0.03},
                                       {"radius of wheel 1", Channel::wheel1, 0.01},
                                       {"radius of wheel 2", Channel::wheel2, 0.01},
                                       {"radius of wheel 3", Channel::wheel3, 0.01},
                                       {"radius of wheel 4", Channel::wheel4, 0.01},
                                       {"radius of wheel 5", Channel::wheel5, 0.01},
                                       {"radius of wheel 6", Channel::wheel6, 0.01},
                                       {"steering offset", Channel::steer, 0.01},
                                       {"steering gain", Channel::steer_gain, 0.03},
                                       {"gyro bias", Channel::gyro, 0.003},
                                       {"gyro scale", Channel::gyro_scale, 0.01},
                                       {"compass offset", Channel::compass, 0.05}};
  std::vector<WatchedEffect> result;
  for (const WatchedEffect& one : all) {
    const bool of_gyro = one.channel == Channel::gyro || one.channel == Channel::gyro_scale;
    const bool beside_gyro = inputs.gyro && !fitting::turns_by_gyro(robot);
    if (!effects::is_of_drive(one.channel, robot) || (of_gyro && !beside_gyro) ||
        (one.channel == Channel::compass && !inputs.compass)) {
      continue;
    }
    result.push_back(one);
  }
  return result;
}

}  // namespace trussmap
