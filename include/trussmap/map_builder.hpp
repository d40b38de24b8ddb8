// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// The map builder: what exploration code calls at every landmark.
//
//   MapBuilder builder;                       // an elastic truss that relaxes at every arrival
//   builder.start("dock");                    // the map's first landmark, its origin
//   builder.compass(reading, sd);             // where there is one, as often as it is read
//   Arrival a = builder.arrive("door", motion);      // motion: from wheels (arc.hpp), with its
//                                                    // covariance, in the robot's own axes
//   builder.observe("lamp", seen_at(range, bearing, sd_range, sd_bearing));
//   builder.position(*builder.find("lamp")), builder.pose()
//   builder.save("map.txt");                  // all that it remembers; MapBuilder::load goes on
//
//                         motion: (x, y) and turn, axes of the robot at its start
//        robot at A ---------------------------------------> robot at B
//         |  seen (offset), if it does not stand on A              |  seen
//         A  - - - - - - - - - - - - route - - - - - - - - - - - - B
//
// What is measured becomes an element of the truss, with a rest shape that is the running average
// over its traversals (landmark_map.hpp) and a stiffness by its mean covariance (truss.hpp):
//
//   a route driven in map axes (Traversal)     a bar
//   a route driven in the robot's own axes     a length; and a corner: the angle between it and
//     (Motion)                                 the route that it came by, fastened to no compass
//   a compass reading                          the direction of the route that is driven next
//
// A landmark met for the first time is placed by its measurement. When a loop closes, the routes
// driven since the last settled landmark share out what is missing (first sight); then, as at every
// arrival by a known route, landmarks come to equilibrium within a scope (refinement). The truss's
// energy never rises by that.
//
// Methods (their names stand in every output). The first two are pairs of a law and a scope:
//   elastic          stiffness 1/mean error (the paper's law), scope `automatic`
//   gauss_markov     stiffness 1/variance, scope `all`: the least-squares map after every arrival
//   elastic_printed  refinement as the paper prints it: forces of a reference structure, applied to
//                    a larger one. It diverges where a route is some ten times as stiff along as
//                    across, or the other way round, and may where routes are of unequal length
//                    (docs/methods.md).
//
// Golfarelli, Maio & Rizzi (1998); refinement by relaxation in place of their section 3.3.
// Cost per arrival: with scope `nearest` bounded by eta, whatever the size of the map; with groups
// by eta log n. Of a map by legs in map axes every scale is there: its groups move as one, and
// their landmarks are moved when somebody asks for them. Where there are lengths and corners
// landmarks are visited, up to 6000 at a scale, and scales beyond are left out.
//
// A call that throws leaves the builder as it was.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/truss.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// `adjustment`, least squares of whole recordings, is build_map's: a map builder refuses it.
enum class Method { elastic, elastic_printed, gauss_markov, adjustment };

/// Which landmarks a refinement lets come to equilibrium, all others held.
struct RefinementScope {
  enum class Kind {
    automatic,  ///< all, while that is cheap (up to 10^4 landmarks); beyond, nearest with groups
    all,        ///< all: exact; cost: a pass over the factor of the stiffness matrix
    nearest,    ///< the `eta` nearest to the route's middle
    estimated   ///< nearest, eta estimated before each correction from the force and what is round
  };
  Kind kind = Kind::automatic;
  int eta = 50;        ///< of `nearest`, and of `automatic` beyond its limit; 2 at least
  bool groups = true;  ///< then the nearest groups of landmarks, each moved, turned and sheared as
                       ///< one, at every scale; false: the paper's neighbourhood alone
};

struct MapBuilderOptions {
  Method method = Method::elastic;
  RefinementScope scope = {};  ///< of `elastic` and `elastic_printed`
  /// Absent: the method's own.
  std::optional<StiffnessLaw> law = {};
  bool refine = true;   ///< false: first sight only (a known route only updates its averages)
  bool pooled = false;  ///< law `variance`: bars weigh all traversals of a route alike, by their
                        ///< mean covariance; else each by its own
  /// An arrival at a known landmark whose misfit is beyond so many standard deviations, of leg and
  /// map together, is left out: a landmark was taken for another. Where misfits have been large
  /// lately the gate is as much wider, and what was left out comes back: a systematic error is no
  /// wrong landmark. A leg in the robot's own axes that was left out comes in late, too, where the
  /// next landmark lies to its end as the map has the two: then the way was misjudged, not the
  /// landmark. Infinity: none is left out. `elastic_printed` has no gate.
  double gate = kMapGate;
};

/// What an arrival did to the map.
struct Arrival {
  enum class Kind {
    new_landmark,  ///< placed by its measurement
    first_sight,   ///< a loop closed: the chain of fresh routes was corrected
    new_route,     ///< between two settled landmarks
    refinement,    ///< a known route was driven again
    left_out,      ///< contradicts the map (MapBuilderOptions::gate), or leads from such a place
                   ///< back to where the map still has the robot: nothing moved
    found_again,   ///< at a landmark of the map, past one that was left out: no route joins it with
                   ///< the one before, and none was added; nothing moved
  };
  Kind kind = Kind::new_landmark;
  int landmark = -1;  ///< where the robot is now, or was said to be
  int route = -1;     ///< the route it came by, -1 where it was left out or found again
  /// Displaced by more than 1e-12 m, the landmarks of groups that were moved among them, and by how
  /// much at most, m: of landmarks in groups a bound.
  int landmarks_moved = 0;
  double largest_move = 0.0;
  Vector2 misfit = Vector2::Zero();  ///< measured displacement - the map's before, m
  int eta = 0;                       ///< landmarks that came to equilibrium each by itself
  int back = 0;                      ///< of those left out earlier that came back now
};

/// "new landmark", "loop closed", "new route", "known route", "left out", "found again".
[[nodiscard]] std::string name_of(Arrival::Kind kind);

/// An arrival or a side measurement that was left out and has not come back.
struct LeftOutArrival {
  std::string from;
  std::string to;
  Traversal leg;          ///< from there, map axes
  double sds = 0.0;       ///< how far off it was, in standard deviations of leg and map together
  bool own_axes = false;  ///< by a motion or sighting in the robot's own axes
};

/// Threads may ask at once (const calls) while none drives it on.
class MapBuilder {
 public:
  /// Throws std::invalid_argument on options out of range.
  explicit MapBuilder(const MapBuilderOptions& options = {});

  /// Goes on with a map that was made before: its landmarks are settled, its routes have their
  /// averages (as bars), and the first landmark stays for ever. The robot must start() on one of
  /// them. Throws std::invalid_argument, too, on a route without traversals or with a displacement
  /// or covariance that no leg may have; SolveError where a landmark is tied to nothing.
  explicit MapBuilder(const LandmarkGraph& map, const MapBuilderOptions& options = {});

  ~MapBuilder();
  MapBuilder(MapBuilder&&) noexcept;
  MapBuilder& operator=(MapBuilder&&) noexcept;

  /// The robot stands on a landmark: the map's first (which gets `position`, and keeps it for
  /// ever), or one that the map has (a new session). Throws SolveError for any other: nothing
  /// would tie it to the map.
  void start(const std::string& landmark, const Vector2& position = Vector2::Zero());

  /// The same at the first of the landmarks that it sees from afar.
  void start(const std::string& landmark, const LandmarkOffset& seen,
             const Vector2& position = Vector2::Zero());

  /// The compass reads this heading (rad, map axes) where the robot is now, between two motions;
  /// `sd` > 0. The first reading of a map that had none turns the map, so that it is right.
  void compass(double reading, double sd);

  /// The robot drove from the landmark it stood on to this one; `leg` in map axes. Throws
  /// std::invalid_argument if it stood nowhere, on this landmark already, or if the leg is not
  /// finite with a positive definite covariance. After an arrival that is left out the robot counts
  /// as still on its way: the next leg goes on from this one.
  Arrival arrive(const std::string& landmark, const Traversal& leg);

  /// The same in the robot's own axes where the motion began; the landmark is seen at an offset
  /// from where it ended, by default below the robot. Without a compass the first heading of the
  /// map is 0. Throws, too, SolveError where the landmark is new and nothing has told the robot's
  /// heading in this session yet (a compass, or a route between two landmarks of the map).
  Arrival arrive(const std::string& landmark, const Motion& motion,
                 const LandmarkOffset& seen = {});

  /// A side measurement from the landmark the robot stands on, as by sighting another one from
  /// there: like a drive there and back with one traversal; the robot stays.
  Arrival observe(const std::string& landmark, const Traversal& from_here);

  /// The same of a landmark that is seen from where the robot is, in its own axes.
  Arrival observe(const std::string& landmark, const LandmarkOffset& seen);

  /// All landmarks come to equilibrium, the first held: what refinement does within `all`. Returns
  /// the largest move, m. Throws SolveError where the stiffnesses span too many magnitudes.
  double relax();

  /// Strain energy of the map's truss: what refinement lets fall. Of law `variance` half of chi^2.
  /// 0 of `elastic_printed`, which has no elements that are strained. Cost: all routes.
  [[nodiscard]] double energy() const;

  [[nodiscard]] const MapBuilderOptions& options() const;

  /// Changes what refinements do from now on. The method and the law must stay as they are, else
  /// std::invalid_argument.
  void set_options(const MapBuilderOptions& options);

  /// What was left out and has not come back, in the order in which it came.
  [[nodiscard]] const std::vector<LeftOutArrival>& left_out() const;

  /// Landmark the robot stands on, -1 before start(). After an arrival that was left out the one
  /// that it stood on before.
  [[nodiscard]] int here() const;

  /// Where the robot is, in the map: with the covariance of its heading and of its place beside the
  /// landmark it stands on or sees. Absent before start(), and while its heading is not known.
  [[nodiscard]] std::optional<PoseEstimate> pose() const;

  [[nodiscard]] int landmarks() const;
  [[nodiscard]] std::optional<int> find(const std::string& landmark) const;

  /// Present position, m. Cost: at most log n. Throws std::invalid_argument on a number that no
  /// landmark has.
  [[nodiscard]] Vector2 position(int landmark) const;
  /// Throws likewise. Without the copy that map() makes.
  [[nodiscard]] const std::string& name(int landmark) const;

  /// The `count` landmarks nearest to a point, the nearest first. Throws std::invalid_argument
  /// unless count is above 0.
  [[nodiscard]] std::vector<int> nearest(const Vector2& point, int count) const;

  /// Averages of the route between two landmarks, if it was ever driven. Legs in the robot's own
  /// axes are in it as the robot's heading in the map turned them.
  [[nodiscard]] std::optional<Route> route_between(int a, int b) const;

  /// Covariance of where landmark b lies from landmark a, m^2, by all that the map was told: the
  /// flexibility of the truss with stiffness 1/variance. Exact to first order, as far as what was
  /// measured is independent; the refinement's scope may lie some percent above it. In the map's
  /// axes: without a compass these are those of the first leg, and what is not known of that leg's
  /// direction turns all, however often the rest is driven. Cost: one
  /// factorisation of the whole truss. Throws std::invalid_argument on numbers that no landmark
  /// has, SolveError where the traversals' covariances span so many magnitudes that rounding would
  /// leave fewer than four digits of the answer.
  [[nodiscard]] Matrix2 covariance_between(int a, int b) const;

  /// The same of every landmark from the first one, all at once; that of the first is zero. Cost:
  /// about two factorisations. Throws SolveError likewise.
  [[nodiscard]] std::vector<Matrix2> covariances() const;

  /// Per way (landmarks one after the other, along routes of the map): by how much the summed
  /// variance of all landmarks (m^2, as of covariances()) is expected to fall when the robot drives
  /// it, each route with the covariance that its traversals had on average. Legs in the robot's own
  /// axes measure corners as well; the first one too where the way starts at here(). Of a map
  /// without a compass, which covariances() has in the axes of its first leg, of the landmarks
  /// after the best rotation and translation instead. Where to drive next, for a better map. Throws
  /// std::invalid_argument on a way that leaves the map's routes; SolveError as covariances().
  /// Cost: one factorisation, and a solution per number that is measured, up to three per route.
  [[nodiscard]] std::vector<double> expected_falls(const std::vector<std::vector<int>>& ways) const;

  /// The landmarks along the shortest or the surest way over the map's routes (landmark_map.hpp);
  /// empty where there is none. A landmark seen from afar is joined by a route, too, and so is a
  /// new one with the last that was not left out: a robot that can only go where it went keeps a
  /// list of its ways, as apps/explore does.
  [[nodiscard]] std::vector<int> path(int from, int to, PathBy by = PathBy::length) const;

  /// The map: present positions, and the routes with their averages. A copy, made anew each time.
  [[nodiscard]] LandmarkGraph map() const;

  /// Writes all that the builder remembers into a file, whole or not at all (docs/formats.md; its
  /// name's ending does not matter). What is derived from that, as the factor of its matrix, is
  /// made anew as load() makes it: from here on the builder and one that is loaded do the same to
  /// the last bit. Throws InputError where the file cannot be written. Cost: what the map costs.
  void save(const std::filesystem::path& file);

  /// The builder that was saved, with its options. Throws InputError, which says file, line, what
  /// is wrong and what was expected, unless the file is there as save() wrote it.
  [[nodiscard]] static MapBuilder load(const std::filesystem::path& file);

 private:
  friend class BuilderAccess;  // for map_store.hpp
  class State;
  explicit MapBuilder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// "elastic", "elastic_printed", "gauss_markov", "adjustment".
[[nodiscard]] std::string name_of(Method method);

}  // namespace trussmap
