// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map builder: what exploration code calls at every landmark.
//
//   MapBuilder builder;                         // the elastic truss with limited gain
//   builder.start("dock");
//   Arrival a = builder.arrive("door", {displacement, covariance});   // by this leg
//   a.kind, a.landmarks_moved, a.largest_move   // what was corrected, by how much
//
// A leg is given in map axes. From the wheels (arc.hpp), with the heading h at its start and h's
// variance v, a compass's or what turning has left of it:
//
//   Motion leg;
//   for (const WheelTravel& row : rows) leg = then(leg, arc_motion(row, wheelbase, noise));
//   const Matrix2 R = rotation(h);
//   const Vector2 d = R * leg.displacement.position();
//   const Matrix2 C = R * leg.covariance.topLeftCorner<2, 2>() * R.transpose() +
//                     v * quarter_turn(d) * quarter_turn(d).transpose();
//   builder.arrive("door", {d, C});
//   h += leg.displacement.heading;
//   v += leg.covariance(2, 2);          // until a compass says better
//
// The builder takes legs as independent; those that share a drifting heading are not, and a map of
// them is better adjusted as a whole (build_map.hpp).
//
// Methods (their names stand in every output):
//   elastic          the paper's two phases, the gain of a refinement limited to one half
//   elastic_printed  the paper's two phases as printed: diverges on unequal routes
//   gauss_markov     exact increments: the least-squares map after every traversal
//
// A refinement acts on the eta landmarks nearest to the route (a floating piece; the map as a
// whole is counted as shifted so that the first landmark stays), on all of them with the first one
// held, or on an eta estimated for each correction. Cost per arrival with a fixed eta: bounded by
// eta, whatever the size of the map, but for the logarithm in the spatial index.
// gauss_markov acts on the whole map always.
//
// A call that throws leaves the builder as it was.
#pragma once

#include "trussmap/gate.hpp"
#include "trussmap/landmark_map.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// `adjustment`, least squares of whole recordings, is build_map's: a map builder refuses it.
enum class Method { elastic, elastic_printed, gauss_markov, adjustment };

/// How many landmarks a refinement may move.
struct Eta {
  enum class Kind { all, fixed, estimated };
  Kind kind = Kind::fixed;
  int count = 50;  ///< for Kind::fixed; 2 at least
  /// When the structure is the whole map: hold its first landmark (as the reference numbers have
  /// it), or let it float, which is a little better and much better where the first landmark is
  /// tied to the map by few or poor routes.
  bool hold_first = true;
};

struct MapBuilderOptions {
  Method method = Method::elastic;
  Eta eta = {};
  double gain_limit = 0.5;  ///< of `elastic`: part of the desired change reached at most, (0, 1]
  bool refine = true;       ///< false: first sight only (a known route only updates its averages)
  bool pooled = false;      ///< `gauss_markov`: weights by the route's mean covariance, not by each
                            ///< traversal's own
  /// `gauss_markov`: an arrival whose misfit is beyond so many standard deviations, of leg and map
  /// together, is left out: a landmark was taken for another. Where misfits have been large lately
  /// the gate is as much wider, and what was left out comes back: a systematic error is no wrong
  /// landmark. Infinity: none is left out.
  double gate = kMapGate;
};

/// What an arrival did to the map.
struct Arrival {
  enum class Kind {
    new_landmark,  ///< placed by its measurement
    first_sight,   ///< a loop closed: the chain of fresh routes was corrected
    new_route,     ///< between two settled landmarks: nothing moved, its averages began
    refinement,    ///< a known route was driven again
    left_out,      ///< contradicts the map (MapBuilderOptions::gate), or leads from such a place
                   ///< back to where the map still has the robot: nothing moved
  };
  Kind kind = Kind::new_landmark;
  int landmark = -1;                 ///< where the robot is now, or was said to be
  int route = -1;                    ///< the route it came by, -1 where it was left out
  int landmarks_moved = 0;           ///< displaced by more than 1e-12 m
  double largest_move = 0.0;         ///< m
  Vector2 misfit = Vector2::Zero();  ///< measured displacement - the map's before, m
  int eta = 0;   ///< landmarks in the structure that a refinement solved, else 0
  int back = 0;  ///< of those left out earlier that came back now
};

/// An arrival or a side measurement that was left out and has not come back.
struct LeftOutArrival {
  std::string from;
  std::string to;
  Traversal leg;     ///< from there, map axes
  double sds = 0.0;  ///< how far off it was, in standard deviations of leg and map together
};

/// Threads may ask at once (const calls) while none drives it on.
class MapBuilder {
 public:
  /// Throws std::invalid_argument on options out of range.
  explicit MapBuilder(const MapBuilderOptions& options = {});

  /// Goes on with a map that was made before: its landmarks are settled, its routes have their
  /// averages, and the first landmark stays for ever. The robot must start() on one of them. Throws
  /// std::invalid_argument, too, on a route without traversals or with a displacement or covariance
  /// that no leg may have; SolveError where a landmark is tied to nothing.
  explicit MapBuilder(const LandmarkGraph& map, const MapBuilderOptions& options = {});

  ~MapBuilder();
  MapBuilder(MapBuilder&&) noexcept;
  MapBuilder& operator=(MapBuilder&&) noexcept;

  /// The robot stands on a landmark: the map's first (which gets `position`, and keeps it for
  /// ever), or one that the map has (a new session). Throws SolveError for any other: nothing
  /// would tie it to the map.
  void start(const std::string& landmark, const Vector2& position = Vector2::Zero());

  /// The robot drove from the landmark it stood on to this one; `leg` in map axes. Throws
  /// std::invalid_argument if it stood nowhere, on this landmark already, or if the leg is not
  /// finite with a positive definite covariance. After an arrival that is left out the robot counts
  /// as still on its way: the next leg goes on from this one.
  Arrival arrive(const std::string& landmark, const Traversal& leg);

  /// A side measurement from the landmark the robot stands on, as by sighting another one from
  /// there: like a drive there and back with one traversal; the robot stays.
  Arrival observe(const std::string& landmark, const Traversal& from_here);

  /// `elastic` only: refines every route once more towards its averages, without a new measurement
  /// and with this gain limit. Routes driven only once, which moved nothing, have their say.
  /// Returns the largest move, m. Rounds with falling limits (1/2, 1/4, 1/6, ...) come to rest
  /// close to the least-squares map. Cost: one refinement per route.
  double settle(double gain_limit);

  /// `elastic` only: the whole truss comes to rest at once, every route pulling towards its
  /// averages with the stiffness that it has; the first landmark stays. What settle's rounds tend
  /// to, where every landmark may move: after the drive, when cost does not matter. Returns the
  /// largest move, m. Cost: one solution of the whole truss.
  double rest();

  [[nodiscard]] const MapBuilderOptions& options() const;

  /// Changes what refinements do from now on. The method and the kind of eta must stay as they
  /// are, else std::invalid_argument.
  void set_options(const MapBuilderOptions& options);

  /// What was left out and has not come back, in the order in which it came.
  [[nodiscard]] const std::vector<LeftOutArrival>& left_out() const;

  /// Landmark the robot stands on, -1 before start(). After an arrival that was left out the one
  /// that it stood on before.
  [[nodiscard]] int here() const;

  [[nodiscard]] int landmarks() const;
  [[nodiscard]] std::optional<int> find(const std::string& landmark) const;

  /// Present position, m. Throws std::invalid_argument on a number that no landmark has.
  [[nodiscard]] Vector2 position(int landmark) const;

  /// Averages of the route between two landmarks, if it was ever driven.
  [[nodiscard]] std::optional<Route> route_between(int a, int b) const;

  /// The map: present positions, and the routes with their averages. A builder knows no covariances
  /// of positions: marginal_covariances (pose_graph.hpp) has them, of a graph with a displacement
  /// edge per route; build_map's adjustment as well.
  [[nodiscard]] LandmarkGraph map() const;

 private:
  friend class BuilderAccess;  // for map_store.hpp
  class State;
  explicit MapBuilder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// "elastic", "elastic_printed", "gauss_markov", "adjustment".
[[nodiscard]] std::string name_of(Method method);

}  // namespace trussmap
