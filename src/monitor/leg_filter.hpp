// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A Kalman filter over what a leg's end can be measured against, and what effects do to it.
//
//   z_1 ... z_n   lasting errors (lasting_error.hpp)
//   psi           heading, map axes, once something told it                            rad
//   o             where a point of the map is from the robot, once something told it   m, robot
//   frame y, x          of the leg: heading of its start as its compass readings have it; the
//   gyro's excess p_i           landmarks seen lately, from the robot m, robot frame
//
// Everything is seen from the robot: a leg (d, a) carries p to R(-a)(p - d), a sighting measures p
// itself, and how uncertain the robot's heading is in a map does no harm. Errors are those of the
// group of motions (Barrau & Bonnabel 2017): a leg carries them on without their size counting, and
// where an update turns the heading it turns the landmarks about the robot, exactly, by as much.
//
// Landmarks beyond a number are forgotten, the one not seen for longest first; seen again it is a
// new one. A landmark that is met without anything known of it says nothing of the odometry; it is
// put in as it is seen. So the innovations are those of a model in which it is another landmark,
// and independent of each other.
//
// Effects: U = d(state - its estimate)/d(coefficient), a column per effect and start, goes along
// (Friedland 1969, separate bias):
//
//   leg     U <- F U + J B           B = what one unit adds to the leg (leg_odometry.hpp)
//   measurement of H state          expected innovation: H U + d;  U <- U - K (H U + d)
//
//   d   what one unit adds to the reading itself: of a compass
//
// Cost per leg: (states)^2 and states x columns; nothing grows.
#pragma once

#include "monitor/lasting_error.hpp"
#include "monitor/leg_odometry.hpp"
#include "trussmap/arc.hpp"
#include "trussmap/planar.hpp"

#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace trussmap::monitor {

/// A place in the map that the robot is at: a fix, a point of a survey.
struct MapPlace {
  Vector2 position = Vector2::Zero();    ///< m, map frame
  Matrix2 covariance = Matrix2::Zero();  ///< m^2
};

class LegFilter {
 public:
  /// What an innovation says: whitened (its covariance is 1), and what one unit of each column
  /// adds.
  using Said = std::function<void(const Eigen::VectorXd& whitened, const Eigen::MatrixXd& columns)>;

  /// `capacity`: landmarks that are kept; `columns`: of U, at most.
  LegFilter(const std::vector<NoiseProcess>& lasting, int capacity, Eigen::Index columns);

  /// Columns of U that are in use; new ones are 0.
  void set_columns(Eigen::Index count);
  /// Columns from `first` on, `count` of them, go; those behind move up.
  void drop_columns(Eigen::Index first, Eigen::Index count);

  /// The robot drives a leg. `effects`: what one unit adds, a column per effect; each start has all
  /// of them. `lasting`: the same of lasting errors.
  void drive(const LegReckoning& leg, const LegColumns& effects, const LegColumns& lasting);

  /// The leg's compass readings, white noise `sd` (rad) each; `by`: what one unit of each effect
  /// adds to a reading.
  void read_compass(const LegReckoning& leg, double sd, const Eigen::RowVectorXd& by,
                    const Said& said);
  /// The gyro's excess is none.
  void read_gyro(const Said& said);
  /// The heading is told, rad.
  void know_heading(double heading, double variance, const Said& said);
  /// The robot is at a place of the map.
  void know_place(const MapPlace& place, const Said& said);
  /// It sees a landmark; `surveyed`: where it is in the map, nullptr: nothing knows.
  void see(const std::string& landmark, const LandmarkOffset& seen, const MapPlace* surveyed,
           const Said& said);

  /// The effect of a column has this coefficient, with this variance: what is believed is moved as
  /// far, and its uncertainty stays as an error that lasts.
  void believe(Eigen::Index column, double coefficient, double variance, const NoiseProcess& rest);
  /// From here on legs are corrected for an effect, whose coefficient is as unsure as this.
  void expect(double variance, const NoiseProcess& rest);

 private:
  using Block = Eigen::Index;
  struct Kept {
    std::string landmark;
    long seen = 0;  ///< when, in calls
  };

  [[nodiscard]] Eigen::Index states() const { return x_.size(); }
  [[nodiscard]] Eigen::Index heading_at() const { return lasting_count_; }
  [[nodiscard]] Eigen::Index anchor_at() const { return lasting_count_ + 1; }
  [[nodiscard]] Eigen::Index mean_at() const { return lasting_count_ + 3; }
  [[nodiscard]] Eigen::Index excess_at() const { return lasting_count_ + 4; }
  [[nodiscard]] Eigen::Index point_at(std::size_t k) const {
    return lasting_count_ + 5 + 2 * static_cast<Eigen::Index>(k);
  }

  void go_on(const LegReckoning& leg);
  void add_lasting(const Eigen::VectorXd& u, double variance, const NoiseProcess& rest);
  void put_point(Eigen::Index at, const Vector2& value, const Matrix2& covariance);
  void forget(Eigen::Index at, Eigen::Index count);
  void move_state(const Eigen::VectorXd& more);
  void tell_heading(double more);
  void meet(Vector2 off, Eigen::MatrixXd H, Matrix2 R, const Said& said);
  void anchor_near();
  void compare_with_map(Eigen::Index point, const Vector2& fixed, const MapPlace& place,
                        const Said& said);
  void update(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& H, const Eigen::MatrixXd& R,
              const Eigen::RowVectorXd& direct, const Said& said);
  [[nodiscard]] std::size_t slot_for(const std::string& landmark, bool& known);
  [[nodiscard]] auto by_effects() { return U_.leftCols(columns_); }

  std::vector<LastingError> lasting_;
  Eigen::Index lasting_count_ = 0;
  std::vector<Kept> kept_;
  std::unordered_map<std::string, std::size_t> slots_;
  long calls_ = 0;
  bool heading_known_ = false;
  bool place_known_ = false;
  Vector2 anchor_map_ = Vector2::Zero();  ///< what o is, m, map frame
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
  Eigen::MatrixXd U_;
  Eigen::Index columns_ = 0;
};

}  // namespace trussmap::monitor
