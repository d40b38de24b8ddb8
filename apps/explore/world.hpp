// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A world for an exploring robot to drive in: landmarks on a mesh, walls between some of them, and
// a robot on two wheels that sees which ways lead out of where it stands.
//
// What the robot knows are readings: wheel travels, a compass, ranges and bearings, the names of
// landmarks and the ways out. Where it really is, the world keeps to itself; the truth is for those
// who judge its map.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace trussmap::explore {

struct WorldOptions {
  MeshSize size{8, 8};
  double spacing = 5.0;     ///< m
  bool uneven = false;      ///< routes of 1 to 10 m
  double walls = 0.15;      ///< share of the mesh's routes that are walled up; all stays connected
  double wheels = 0.003;    ///< k of both wheels, m^(1/2)
  double wheelbase = 0.34;  ///< m
  bool compass = true;
  double compass_sd = 0.03;  ///< rad
  double reach = 0.0;        ///< m, of the range sensor; 0: there is none
  double range_sd = 0.05;    ///< m
  double bearing_sd = 0.02;  ///< rad
  /// The left tyre loses air: its wheel is smaller by this share after so many legs.
  double air_loss = 0.0;
  int air_loss_leg = 0;
  std::uint64_t seed = 1;
};

/// What wheels said on the way to the next landmark.
struct Driven {
  std::vector<DrivenRow> rows;
  std::string landmark;  ///< where the way ended
  int way_back = 0;      ///< the way out of there that leads back
};

struct Seen {
  std::string landmark;
  double range = 0.0;    ///< m
  double bearing = 0.0;  ///< rad, counter-clockwise from ahead
};

class World {
 public:
  /// Throws std::invalid_argument on options that make no world.
  explicit World(const WorldOptions& options);

  [[nodiscard]] const WorldOptions& options() const { return options_; }
  [[nodiscard]] const std::string& landmark() const { return plan_.landmark(here_).name; }
  /// How many ways lead out of here, numbered from 0; another landmark's have numbers of their own.
  [[nodiscard]] std::size_t ways_out() const { return plan_.routes_at(here_).size(); }
  [[nodiscard]] std::optional<double> read_compass();
  [[nodiscard]] std::vector<Seen> look_round();
  Driven leave_by(int way);

  // For judges alone.
  /// Where landmarks are, and the routes between them; ways out are its routes at a landmark.
  [[nodiscard]] const LandmarkGraph& plan() const { return plan_; }
  [[nodiscard]] double length_of_all_routes() const;
  [[nodiscard]] double way_driven() const { return way_; }

 private:
  [[nodiscard]] Vector2 displacement_to(int landmark) const;

  WorldOptions options_;
  std::mt19937_64 random_;
  LandmarkGraph plan_;
  int here_ = 0;
  double heading_ = 0.0;  // rad, true
  double way_ = 0.0;      // m
  int legs_ = 0;
};

}  // namespace trussmap::explore
