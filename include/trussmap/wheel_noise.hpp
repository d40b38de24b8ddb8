// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// How noisy each wheel is, from the end errors of one path driven many times (Chong & Kleeman
// 1997).
//
//   e_i     end error (absolute - calculated) of run i: x, y [m], heading [rad], start frame
//   k_L     noise of the left wheel: variance of its travel = k_L^2 |travel|, m^(1/2); k_R likewise
//   M_L     covariance of the path's end for k_L = 1, k_R = 0 (trussmap/arc.hpp); M_R likewise
//   Sigma   k_L^2 M_L + k_R^2 M_R + Sigma_sensor
//   S       mean of e_i e_i'; with the mean subtracted, divided by n - 1
//
// The paper finds k_L and k_R by trial and error. Here they maximise the likelihood,
//   -n/2 [log det Sigma + trace(Sigma^-1 S)]            (n - 1 for n with the mean subtracted),
// over k^2 = (k_L^2, k_R^2), by Fisher scoring. Standard errors are those of the Fisher information
//   F_ab = n/2 trace(Sigma^-1 M_a Sigma^-1 M_b),        sd(k) = sd(k^2)/(2 k).
//
// k^2 is estimated without a bound at 0, so that it is unbiased; k itself is some sd(k)^2/(2k) too
// small. Where sensor noise hides a wheel's own, k^2 may come out negative: k is then 0, the other
// wheel is fitted again without it, and an upper limit says what could be hidden.
//
// First order: M by linearisation, as in the paper, and a mean of 0. Right to 0.5 to 0.9 % of k^2
// for the paper's robot (k = 0.0005, 10 m out and back, B = 0.5 m); at ten times its noise the
// wandering heading moves the end as much as the wheels' own scatter does. Exact: mean and
// covariance without linearisation; the likelihood stays Gaussian, which the errors' long tails
// make a little less efficient, and unbiased.
//
// Does the model fit the runs? Ellipses: 95 % of the runs should end within the model's 95 %
// ellipse, in each plane and in all three coordinates. Distances: the squared Mahalanobis distances
// should be chi-square(3) (Kolmogorov-Smirnov; the constants come from the same runs, so that the
// test rejects a little too seldom). Shape: a covariance with two constants against one with all
// six entries free (likelihood ratio, chi-square(4), with Bartlett's correction), which sees a
// wrong wheelbase, degrees for radians, or noise that is not the wheels'.
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/test_path.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

using EndErrors = std::vector<Eigen::Vector3d>;  ///< x, y [m], heading [rad]; absolute - calculated

enum class NoiseOrder { first, exact };

struct NoiseExperiment {
  TestPath path = {{10.0, 0.0}, {-10.0, 0.0}};
  double wheelbase = 0.34;                              ///< m
  Eigen::Vector3d sensor_sd = Eigen::Vector3d::Zero();  ///< m, m, rad: known, per run
  /// Besides, known noise whose coordinates go together (WallError), per run.
  Matrix3 sensor_covariance = Matrix3::Zero();
  bool subtract_mean = false;  ///< the runs' mean is a systematic error, not noise
  NoiseOrder order = NoiseOrder::first;
};

/// Covariance of the end for k = 1 of one wheel and 0 of the other, in the frame of the start.
struct NoiseShape {
  Matrix3 left = Matrix3::Zero();
  Matrix3 right = Matrix3::Zero();
};

/// Throws std::invalid_argument on a wheelbase that is not above 0.
[[nodiscard]] NoiseShape noise_shape(const TestPath& path, double wheelbase);

struct WheelConstant {
  double k = 0.0;               ///< m^(1/2), 0 or more
  double standard_error = 0.0;  ///< m^(1/2); NaN where k is 0
  double upper_limit = 0.0;     ///< m^(1/2): k is below this with 95 % confidence
};

struct NoiseEstimate {
  WheelConstant left;
  WheelConstant right;
  Vector2 squared = Vector2::Zero();             ///< k_L^2, k_R^2, not bounded at 0, m
  Matrix2 squared_covariance = Matrix2::Zero();  ///< m^2
  int runs = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< of the errors
  /// Mean that the noise itself causes; 0 at first order.
  Eigen::Vector3d linearization_offset = Eigen::Vector3d::Zero();
  /// Probability of a mean as far from that offset if there were no systematic error (Hotelling's
  /// T^2); NaN with too few runs.
  double mean_p_value = 0.0;
  /// The mean if subtracted, else the offset.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Matrix3 observed = Matrix3::Zero();  ///< S
  Matrix3 modelled = Matrix3::Zero();  ///< Sigma at (k_L, k_R)
};

/// Throws std::invalid_argument on fewer than two runs, negative sensor noise or a bad wheelbase;
/// SolveError where the runs are all equal, or the path shows both wheels alike.
[[nodiscard]] NoiseEstimate estimate_wheel_noise(const EndErrors& errors,
                                                 const NoiseExperiment& experiment);

/// How many runs are within the 95 % ellipse (or ellipsoid) of the model.
struct EllipseCount {
  std::string coordinates;  ///< "x-y", "x-heading", "y-heading", "x-y-heading"
  int inside = 0;
  int runs = 0;
  double p_value = 0.0;  ///< two-sided, of a count as far from 95 %
};

struct NoiseFit {
  std::vector<EllipseCount> ellipses;
  double distance_p_value = 0.0;  ///< Kolmogorov-Smirnov; NaN where nonlinear
  double shape_p_value = 0.0;     ///< likelihood ratio; NaN there, and with fewer than 8 runs
  bool nonlinear = false;         ///< nonlinear_share above 0.2: the errors are not Gaussian
  bool good = false;              ///< no p-value below 0.01
};

/// The mean end error that the noise itself causes, in standard deviations of first order: of x or
/// y, the larger.
[[nodiscard]] double nonlinear_share(const NoiseExperiment& experiment,
                                     const NoiseEstimate& estimate);

[[nodiscard]] NoiseFit check_noise(const EndErrors& errors, const NoiseExperiment& experiment,
                                   const NoiseEstimate& estimate);

/// Doubts, a sentence each, that a person can act on: a systematic error, wrong units, a bad fit.
[[nodiscard]] std::vector<std::string> noise_doubts(const EndErrors& errors,
                                                    const NoiseExperiment& experiment,
                                                    const NoiseEstimate& estimate,
                                                    const NoiseFit& fit);

/// How many runs end within 1, 2 and 3 standard deviations of a stated model.
struct SigmaCount {
  std::string coordinates;              ///< as in EllipseCount
  std::array<int, 3> inside = {};       ///< Mahalanobis distance of 1, 2, 3 at most
  std::array<double, 3> expected = {};  ///< runs, of a normal distribution
  int runs = 0;
};

/// k as somebody states it: the paper fits k by eye, drawing the ellipses that k predicts over the
/// runs.
struct StatedNoise {
  double left = 0.0;                                 ///< k_L, m^(1/2)
  double right = 0.0;                                ///< k_R, m^(1/2)
  Matrix3 modelled = Matrix3::Zero();                ///< Sigma at that k
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the ellipses
  std::vector<SigmaCount> counts;
  /// Probability of runs that contradict it as much, against the estimate (likelihood ratio,
  /// chi-square(2)).
  double p_value = 0.0;
};

/// With the experiment's order. Throws std::invalid_argument on a k that is not above 0.
[[nodiscard]] StatedNoise stated_noise(const EndErrors& errors, const NoiseExperiment& experiment,
                                       const NoiseEstimate& estimate, double k_left,
                                       double k_right);

/// Both estimates, the better one, and what to make of it.
struct NoiseAnalysis {
  NoiseExperiment experiment;  ///< with the order in use
  EndErrors errors;
  NoiseEstimate first_order;  ///< the paper's
  NoiseEstimate exact;
  NoiseEstimate estimate;             ///< in use: first order, or exact where nonlinear
  NoiseFit fit;                       ///< of the estimate in use
  std::optional<StatedNoise> stated;  ///< beside the estimate in use
  std::vector<std::string> doubts;
};

/// Throws as estimate_wheel_noise and stated_noise do; the experiment's order is chosen here.
/// `stated`: k_L and k_R to judge beside the estimate, m^(1/2).
[[nodiscard]] NoiseAnalysis analyse_wheel_noise(EndErrors errors, NoiseExperiment experiment,
                                                const std::optional<Vector2>& stated = {});

/// Square root of the 95 % quantile of chi-square: semi-axis of the ellipse per square root of the
/// covariance's eigenvalue. 2.4477 in a plane, 2.7955 in space.
[[nodiscard]] double ellipse95_scale(int dimensions);

// ----------------------------------------
// Where a robot stands, by three distances to two walls at right angles: the absolute measurement
// of Borenstein & Feng (1996, 3.1 and 5: "measuring the distance between three specific points on
// the robot and the walls", by tape or by three ultrasonic sensors, two of which face one wall) and
// of Chong & Kleeman (1997, 5.1).
//
//        wall B  |                 m_i     where sensor i is, robot axes (x ahead)   m
//                |   1     2       u_i     direction in which it faces its wall      -
//            3 --|---o-----o->     d_i     its distance from the wall, perpendicular m
//                |   |d1   |d2     p       the axle's centre, from the corner        m
//        --------+------------     theta   heading, counter-clockwise                rad
//                     wall A
//
//   d_i = -u_i . (p + R(theta) m_i)
//
// Axes are parallel to the walls, their origin is the corner, x points ahead of a robot whose
// sensors face their walls squarely (theta = 0). The two that face the same wall differ by the
// heading alone, which follows in closed form, and p from it:
//   u . R(theta) (m_1 - m_2) = d_2 - d_1
//
// Distances are perpendicular ones: what a tape finds by swinging it, and what an ultrasonic sensor
// measures while the wall is within its beam. (A laser that points askew measures d / cos(theta).)
// Sensors 0.4 m apart, good to 2 mm, give the heading to 7 mrad, 0.4 degrees, as the paper states.
// Where the start is measured as the end is, errors that are always alike cancel.

enum class Faces { ahead, left, behind, right };

struct WallSensor {
  Faces faces = Faces::left;
  Vector2 at = Vector2::Zero();  ///< m, robot axes: x ahead of the axle's centre, y to its left
  double sd = 0.0;               ///< m, standard deviation of a distance; 0: not stated
};

using WallSensors = std::array<WallSensor, 3>;
using WallDistances = std::array<double, 3>;  ///< m, perpendicular, in the order of the sensors

/// Throws std::invalid_argument unless two of them face the same wall, apart from each other along
/// it by more than their distances from it differ, and the third one a wall at right angles to it.
void check_wall_sensors(const WallSensors& sensors);

struct WallPose {
  Pose pose;                             ///< from the corner, m, m, rad
  Matrix3 covariance = Matrix3::Zero();  ///< by the sensors' standard deviations
};

/// Throws std::invalid_argument where the distances fit no heading, or one of more than 45 degrees.
[[nodiscard]] WallPose pose_by_walls(const WallSensors& sensors, const WallDistances& distances);

/// A run that starts and ends in the corner.
struct WallRun {
  WallDistances start = {};
  WallDistances end = {};
  Pose odometry;  ///< at the end, from the start: x ahead there
};

/// Absolute - calculated, in the frame of the start.
struct WallError {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< m, m, rad
  Matrix3 covariance = Matrix3::Zero();             ///< of both measurements
};

/// Throws as pose_by_walls does.
[[nodiscard]] WallError end_error(const WallSensors& sensors, const WallRun& run);

}  // namespace trussmap
