// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wheels and gyro, row by row, as one motion.
//
//   s = (path, turn)   of the wheels, covariance Q (2 x 2) of their noise in the row; and the way
//                      to the side, where they show one
//   w, g               the wheels' turn and the gyro's, which errs by N(0, r), r = gyro^2 duration
//   e = g - w          the excess;  u = (0, 1)
//
//   G  = Q u/(u'Qu + r)                    how much of the excess is believed
//   s' = s + G e,   Q' = (I - G u')Q(I - G u')' + G r G'
//
// s' and e do not correlate (Kalman): the motion of a segment takes s', and what e says of wheels
// and gyro is a measurement of its own (estimation/gyro_excess.hpp). Q' in this form (Joseph's) is
// linear in the variances as long as G stays.
//
// A robot whose wheels both stand still is taken to stand: there e is the gyro's error alone.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::odometry {

/// Of one row, from its wheels' motion, its noise, and the gyro's reading (rad/s, NaN: none).
[[nodiscard]] GyroShare gyro_share(const BodyMotion& wheels, double yaw_rate, double duration,
                                   const Noise& noise, const ArcNoise& of_wheels);
/// The same of a drive's row, of two wheels or others, that lasts `duration` s and has this yaw
/// rate.
[[nodiscard]] GyroShare gyro_share(const MotionRows& drive, std::size_t row, double yaw_rate,
                                   double duration, const Robot& robot, const Noise& noise);
/// s'.
[[nodiscard]] BodyMotion together(const GyroShare& share);
/// Q' of a row, or of a part that lasts `duration` s, in which the wheels' noise is `wheels`.
[[nodiscard]] ArcNoise noise_together(const GyroShare& share, const ArcNoise& wheels,
                                      double duration, const Noise& noise);

/// The drive with its gyro taken in: its motion is s'. Unchanged where
/// there is no gyro, or where it has been taken in before.
[[nodiscard]] MotionRows with_gyro(const MotionRows& drive, const Robot& robot, const Noise& noise);
[[nodiscard]] std::vector<DrivenRecording> with_gyro(const std::vector<DrivenRecording>& recordings,
                                                     const Robot& robot, const Noise& noise);
[[nodiscard]] bool has_gyro(const std::vector<DrivenRecording>& recordings);

/// What the model knows of a motion's noise beside its wheels': per second, and per radian.
[[nodiscard]] ArcNoise laws_noise(double turn, double duration, const Noise& noise);

/// Where the noise of the wheels' motion in a row comes from, or in a part of it that lasts
/// `duration` s: of two wheels by their factors, where the drive has some.
[[nodiscard]] ArcNoise wheels_noise(const MotionRows& drive, std::size_t row, double part,
                                    double duration, const Robot& robot, const Noise& noise);

/// Where the noise of a row's motion, or of a part of it that lasts `duration` s, comes from: of
/// the wheels, and of the gyro that was taken in.
[[nodiscard]] ArcNoise row_noise(const MotionRows& drive, std::size_t row, double part,
                                 double duration, const Robot& robot, const Noise& noise);

/// Variance of a row's excess, or of a part of it, rad^2. Infinite without a reading.
[[nodiscard]] double excess_variance(const MotionRows& drive, std::size_t row, double part,
                                     double duration, const Robot& robot, const Noise& noise);

}  // namespace trussmap::odometry
