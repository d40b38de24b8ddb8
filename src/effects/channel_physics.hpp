// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a channel does to a row of the drive, to a reading and to a view of a landmark: its physics,
// and with it its exact column, for both are linear in g. With f the shape's value, one unit of a
// coefficient adds
//
//   channel             per row of the drive                  shape taken at
//   travel              path f                                middle of the row
//   left, right         half the wheel's travel, and          middle
//                       -+ travel/wheelbase of turn
//   wheels              path f, turn f                        middle
//   difference          (right - left)/4 f, path/wheelbase f  middle
//   turn, drift, rotate turn f, duration f, f (turn)          middle
//   advance             f (path)                              middle
//   creep               path f, to the left                   middle
//   compass             f                                     the reading's instant
//   gyro, gyro_scale    -duration f, gyro's turn f (of what   middle
//                       the gyro says)
//   sideways            sideways travel f                     middle
//   wheel1 ... wheel6   f travel d(path, sideways, turn)/     middle
//                       d(travel)
//   steer, steer_gain   f, f angle times the same by the      middle
//                       steering angle
//   wheel_left, steer_left   f (path, turn) by the place  middle
//                       of the measured, the steered wheel
//   other_axle          f (rear travel - steered wheel's) middle
//   ... per sighting and truth row
//   lever, lever_left   f ahead, to the left                  its instant
//   range, range_scale, bearing   f (sightings only)          its instant
//   delay               -speed f ahead, -turn rate f          its instant
//   truth_heading     f further left (truth rows only)      its instant
//   ... per fix
//   antenna, antenna_left   f ahead, to the left            its instant
//   fix_delay           -speed f ahead, -turn rate f          its instant
//   fix_x, fix_y        f along the map's axes                its instant
//   ... per loop
//   scanner, scanner_left   f ahead, to the left            the instant it is seen from
//   scanner_yaw         f further left                        the same
//
// Path and turn are those of a row's wheels (drive/body_motion.hpp). The simulator finds readings
// by turning the physics round; it shares no formula with this file.
#pragma once

#include "drive/row_motion.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

namespace trussmap::effects {

/// Where a channel acts, and so where its shapes are taken.
enum class ActsOn { drives, readings, views };
[[nodiscard]] ActsOn acts_on(Channel channel);

/// Whether the robot's drive has what the channel acts on: one of its wheels, its steering, a way
/// to the side, a left and a right wheel.
[[nodiscard]] bool is_of_drive(Channel channel, const Robot& robot);
/// Throws std::invalid_argument, naming the effect, where it is not.
void require_of_drive(const Effect& effect, const Robot& robot);

/// What is added to a whole row.
struct DrivePattern {
  double advance = 0.0;  ///< m more forward travel
  double slip = 0.0;     ///< m sideways, to the left
  double turn = 0.0;     ///< rad more turn
  double compass = 0.0;  ///< rad by which the reading exceeds the heading
  double excess = 0.0;   ///< rad that the gyro's turn is more beyond the wheels'

  void add(double times, const DrivePattern& unit) {
    advance += times * unit.advance;
    slip += times * unit.slip;
    turn += times * unit.turn;
    compass += times * unit.compass;
    excess += times * unit.excess;
  }
};

using ViewVector = Eigen::Matrix<double, 9, 1>;  ///< a ViewPattern's numbers, in its order
using ByView = Eigen::Matrix<double, 4, 9>;      ///< a measurement's rows by them

/// What is added to a view of a landmark, to a truth row, to a fix or to both ends of a loop.
struct ViewPattern {
  double ahead = 0.0;        ///< m
  double left = 0.0;         ///< m
  double heading = 0.0;      ///< rad
  double range = 0.0;        ///< m
  double range_scale = 0.0;  ///< fraction
  double bearing = 0.0;      ///< rad
  double x = 0.0;            ///< m, map frame; of a fix
  double y = 0.0;            ///< m
  double yaw = 0.0;          ///< rad; of a landmark's yaw

  [[nodiscard]] ViewVector vector() const {
    return (ViewVector() << ahead, left, heading, range, range_scale, bearing, x, y, yaw)
        .finished();
  }

  void add(double times, const ViewPattern& unit) {
    ahead += times * unit.ahead;
    left += times * unit.left;
    heading += times * unit.heading;
    range += times * unit.range;
    range_scale += times * unit.range_scale;
    bearing += times * unit.bearing;
    x += times * unit.x;
    y += times * unit.y;
    yaw += times * unit.yaw;
  }
};

/// What g of this channel adds to a row; with g = f, the column of a coefficient. Nothing where the
/// channel acts on views. Where the gyro reads, the row moves by what wheels and gyro say together.
[[nodiscard]] DrivePattern drive_pattern(Channel channel, double g, const drive::RowMotion& row);
/// The same for a view, truth row or fix at this speed (m/s) and turn rate (rad/s).
[[nodiscard]] ViewPattern view_pattern(Channel channel, double g, double speed, double turn_rate);

/// Of what acts on views: on sightings (all but truth_heading and what acts on fixes or loops), on
/// truth rows (all but sighting_yaw and what acts on fixes or loops), on fixes, on loops.
[[nodiscard]] bool acts_on_sightings(Channel channel);
[[nodiscard]] bool acts_on_truth(Channel channel);
[[nodiscard]] bool acts_on_fixes(Channel channel);
[[nodiscard]] bool acts_on_loops(Channel channel);

/// delay or fix_delay: the instants of what it acts on are moved.
[[nodiscard]] bool is_delay(Channel channel);

/// Whether a recording without the effect can be written down: not so for creep, lever, lever_left,
/// delay, truth_heading and what acts on fixes or loops.
[[nodiscard]] bool is_recordable(Channel channel);

/// A yaw rate [rad/s] freed from g of the channel gyro or gyro_scale.
[[nodiscard]] double yaw_rate_without(Channel channel, double g, double yaw_rate);
/// A sighting freed from g of the channel range, range_scale, bearing or sighting_yaw.
[[nodiscard]] Sighting without(Channel channel, double g, const Sighting& sighting);

}  // namespace trussmap::effects
