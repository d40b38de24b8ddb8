// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// The relational graph of landmarks and routes: the map as knowledge, before any mechanics.
//
//        s, theta, d, C, t                    a route and what its traversals say on average
//   A o-------------------->o B               landmarks, where they are believed to be
//
//   t        number of traversals
//   s        stretch, running mean of the measured lengths                              m
//   theta    orientation of the route's own direction, source -> target: running mean of the
//            measured directions, each unwrapped next to the present mean; not folded   rad
//   d        running mean of the measured displacement vectors, source -> target        m
//   C        running mean of the traversals' covariances, map axes                      m^2
//
// Golfarelli, Maio & Rizzi (1998), section 3. The paper folds orientations to [0, pi), for a route
// has no direction; here neither memory nor files do, for each has a source: folded_orientation.
//
// Landmarks are numbered 0, 1, ... in the order they are added and have unique names; routes are
// numbered likewise, join two different landmarks, and there is at most one between a pair.
#pragma once

#include "trussmap/planar.hpp"

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace trussmap {

/// One drive along a route: what odometry measured, in map axes.
struct Traversal {
  Vector2 displacement = Vector2::Zero();  ///< from where it began to where it ended, m
  Matrix2 covariance = Matrix2::Zero();    ///< of the displacement, m^2
};

/// The same drive the other way round.
[[nodiscard]] Traversal reversed(const Traversal& traversal);

struct Route {
  int source = -1;  ///< landmark
  int target = -1;  ///< landmark
  int traversals = 0;
  double stretch = 0.0;                    ///< m
  double orientation = 0.0;                ///< rad, source -> target, not folded
  Vector2 displacement = Vector2::Zero();  ///< m, source -> target
  Matrix2 covariance = Matrix2::Zero();    ///< m^2, of one traversal

  /// s (cos theta, sin theta): what the paper's refinement steers to.
  [[nodiscard]] Vector2 mean_vector() const;
};

/// Takes a traversal from source to target into the averages.
void average_in(Route& route, const Traversal& traversal);

/// Orientation folded to [0, pi), as the paper has it.
[[nodiscard]] double folded_orientation(double orientation);

struct Landmark {
  std::string name;
  Vector2 position = Vector2::Zero();  ///< m
  std::optional<Matrix2> covariance;   ///< of the position, m^2, where known
  /// rad, direction of the landmark's own axis (a tag's, a floor code's) in map axes, where it has
  /// one, and its standard error, where known.
  std::optional<double> heading = {};
  std::optional<double> sd_heading = {};
};

/// A call that throws leaves the graph as it was. Threads may read it at once while none changes
/// it.
class LandmarkGraph {
 public:
  /// Throws std::invalid_argument if the name is empty or taken.
  int add_landmark(const std::string& name, const Vector2& position);

  /// A landmark where its first traversal puts it, with the route that leads there.
  int add_landmark(const std::string& name, int from, const Traversal& traversal);

  /// A route without traversals yet. Throws std::invalid_argument if the two are the same
  /// landmark, unknown, or joined already.
  int add_route(int source, int target);

  /// Takes the drive from `from` to `to` into the averages of their route, which is added if
  /// there is none (its direction is then from -> to). Returns the route.
  int add_traversal(int from, int to, const Traversal& traversal);

  /// Replaces a route's averages. Throws std::invalid_argument if its ends differ.
  void set_route(int number, const Route& route);

  void set_position(int landmark, const Vector2& position);
  void set_covariance(int landmark, const Matrix2& covariance);
  void set_heading(int landmark, double heading, std::optional<double> sd = std::nullopt);

  [[nodiscard]] int landmarks() const { return static_cast<int>(landmarks_.size()); }
  [[nodiscard]] int routes() const { return static_cast<int>(routes_.size()); }
  [[nodiscard]] const Landmark& landmark(int number) const;
  [[nodiscard]] const Route& route(int number) const;
  [[nodiscard]] Route& route(int number);

  [[nodiscard]] std::optional<int> find(const std::string& name) const;
  /// None where one of them is no landmark.
  [[nodiscard]] std::optional<int> route_between(int a, int b) const;
  /// The routes that end at a landmark, in the order they were added.
  [[nodiscard]] const std::vector<int>& routes_at(int landmark) const;

 private:
  std::vector<Landmark> landmarks_;
  std::vector<std::vector<int>> routes_at_;  ///< per landmark
  std::vector<Route> routes_;
  std::unordered_map<std::string, int> numbers_;
};

/// The landmark at the other end of the route.
[[nodiscard]] int other_end(const Route& route, int landmark);

/// What is least of a path, summed over its routes.
enum class PathBy {
  length,      ///< mean stretch, m: the shortest way
  uncertainty  ///< trace of the covariance of one traversal, m^2: the surest way
};

/// The landmarks from `from` to `to`, both included, along routes that were traversed, either way;
/// empty where no chain of them leads there. Of equally good paths the one of fewest routes, and of
/// these the one whose landmark has the lower number where they part. Throws std::invalid_argument
/// if a landmark is not of the map or a route met has a negative weight. Cost: 24 bytes of memory
/// per landmark of the map, to be cleared, and n log n of the n landmarks no farther from `to` than
/// `from`: at 10^6 landmarks a few ms to one nearby, about a second across the whole map.
[[nodiscard]] std::vector<int> path(const LandmarkGraph& graph, int from, int to,
                                    PathBy by = PathBy::length);

}  // namespace trussmap
