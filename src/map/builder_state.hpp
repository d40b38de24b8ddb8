// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a map builder is: its memory, and the truss that the memory's averages make.
//
//   a measurement --averages--> elements of the truss --first sight, relaxation--> positions
//
// A step changes copies of averages and the truss, which takes everything back where something
// fails; what is remembered changes last, by what cannot fail.
#pragma once

#include "map/builder_memory.hpp"
#include "map/map_mechanics.hpp"
#include "trussmap/map_builder.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::map {

/// A measured way from one landmark to another, ready to be taken in.
struct MeasuredLeg {
  int from = -1;
  Traversal in_map;                     ///< m, map axes
  const Chord* chord = nullptr;         ///< of a leg in the robot's own axes
  std::optional<MeasuredAngle> corner;  ///< with the chord that came from `corner_from`
  int corner_from = -1;
  std::optional<MeasuredAngle> direction;  ///< of the way, map axes
  bool by_compass = false;                 ///< the direction is
};

/// Nothing moves.
[[nodiscard]] Arrival left_out_at(int landmark);

}  // namespace trussmap::map

namespace trussmap {

class __attribute__((visibility("hidden"))) MapBuilder::State {
 public:
  State(const MapBuilderOptions& options, map::BuilderMemory memory);

  void set_options(const MapBuilderOptions& options);
  void start(const std::string& landmark, const LandmarkOffset& seen, const Vector2& position);
  void compass(double reading, double sd);
  Arrival arrive(const std::string& landmark, const Traversal& leg);
  Arrival observe(const std::string& landmark, const Traversal& from_here);
  Arrival arrive(const std::string& landmark, const Motion& motion, const LandmarkOffset& seen);
  Arrival observe(const std::string& landmark, const LandmarkOffset& seen);
  double relax();

  [[nodiscard]] std::optional<PoseEstimate> pose() const;
  [[nodiscard]] Matrix2 covariance_between(int a, int b) const;
  [[nodiscard]] std::vector<Matrix2> covariances() const;
  [[nodiscard]] std::vector<double> expected_falls(const std::vector<std::vector<int>>& ways) const;
  [[nodiscard]] const MapBuilderOptions& options() const { return options_; }
  /// Its positions may be behind: position(), map().
  [[nodiscard]] const LandmarkGraph& graph() const { return m_.graph; }
  [[nodiscard]] Vector2 position(int landmark) const { return at(landmark); }
  [[nodiscard]] LandmarkGraph map() const;
  /// Its graph's positions may be behind, but for the others.
  [[nodiscard]] const map::BuilderMemory& memory() const { return m_; }
  [[nodiscard]] map::BuilderMemory settled_memory() const;
  const map::BuilderMemory& settle_memory() noexcept;
  [[nodiscard]] const map::MapMechanics& mechanics() const { return mechanics_; }

  std::vector<map::BuilderCall>* journal = nullptr;

 private:
  /// Elements of a route in the truss, -1: none.
  struct RouteElements {
    int bar = -1;
    int length = -1;
    int direction = -1;
  };
  /// Averages as a step leaves them, not yet remembered.
  struct Step {
    int from = -1;
    int to = -1;
    int route = -1;  ///< its number, now or then
    bool new_landmark = false;
    bool new_route = false;
    bool ends_first_heading = false;  ///< a compass gives the map its direction from now on
    Route average;
    std::optional<map::ReckonedRoute> reckoned;
    int reckoned_place = -1;
    std::optional<map::WeighedRoute> weighed;
    RouteElements elements;
    std::optional<map::CornerAverage> corner;
    int corner_place = -1;
    int corner_element = -1;
  };

  [[nodiscard]] StiffnessLaw law() const { return map::law_of(options_); }
  [[nodiscard]] bool printed() const { return options_.method == Method::elastic_printed; }
  [[nodiscard]] Vector2 at(int landmark) const { return mechanics_.position(landmark); }
  void make_truss();
  [[nodiscard]] State by_variance() const;
  [[nodiscard]] double usual_corner_variance() const;
  [[nodiscard]] std::vector<truss::Element> measured_along(const std::vector<int>& way,
                                                           double corner_variance) const;

  [[nodiscard]] int standing() const;
  [[nodiscard]] std::optional<int> other_landmark(const std::string& name) const;
  Arrival travel(const std::string& landmark, const map::MeasuredLeg& leg);
  Arrival travel_gated(const std::string& landmark, const map::MeasuredLeg& leg);
  [[nodiscard]] Matrix2 along_the_surest_way(int i, int j) const;
  [[nodiscard]] Matrix2 known_of_route(int number) const;
  [[nodiscard]] std::optional<int> corner_of(int i, int j, int k) const;
  [[nodiscard]] double angle_variance(int i, int j, int k) const;
  [[nodiscard]] Matrix2 known_between(int i, int j);
  [[nodiscard]] double squared_misfit(int i, int j, const Traversal& leg);
  void bring_back(std::size_t place, const map::MeasuredLeg& leg, Arrival& arrival);
  void take_back_in(Arrival& arrival);
  Arrival reach(const std::string& landmark, const map::MeasuredLeg& leg, bool past_left_out);
  Arrival pass_to(int landmark, const map::MeasuredLeg& leg);
  void take_late(const std::string& landmark, const map::MeasuredLeg& leg, Arrival& arrival);
  [[nodiscard]] bool fits_from_said(int to, const Motion& motion, const LandmarkOffset& seen) const;
  Arrival drive(const std::string& landmark, const Motion& motion, const LandmarkOffset& seen);
  Arrival drive_back(const Motion& whole, const LandmarkOffset& seen);
  Arrival drive_from_said(const std::string& landmark, const Motion& motion,
                          const LandmarkOffset& seen);
  Arrival take_in(const std::string& landmark, const map::MeasuredLeg& leg);

  [[nodiscard]] Step averaged(int to, bool is_new, const map::MeasuredLeg& leg) const;
  void average_corner(Step& step, const map::MeasuredLeg& leg) const;
  [[nodiscard]] truss::Element bar_of(const Step& step) const;
  void put_elements(Step& step);
  void close_chain(const Step& step, const map::OpenChain::Closing& closing,
                   const map::MeasuredLeg& leg);
  [[nodiscard]] map::TurningLeg turning_leg(int from, int to, const RouteElements& elements,
                                            int corner_element) const;
  int refine(const Step& step);
  int refine_as_printed(const Step& step);
  void remember(const Step& step, const std::string& landmark, const Traversal& in_map);
  void note_moves(Arrival& arrival) noexcept;
  void write_positions(LandmarkGraph& graph) const noexcept;

  [[nodiscard]] HeadingEstimate heading_for(const std::optional<int>& to,
                                            const map::Chord& chord) const;
  [[nodiscard]] map::MeasuredLeg reckoned(const HeadingEstimate& heading, const map::Chord& chord,
                                          bool takes_reading) const;
  [[nodiscard]] map::MeasuredAngle direction_by(const HeadingEstimate& heading,
                                                const map::Chord& chord) const;
  [[nodiscard]] HeadingEstimate heading_after(bool was_known, int to, const map::Chord& chord,
                                              const HeadingEstimate& before,
                                              const LandmarkOffset& seen) const;
  void settle_frame() noexcept;
  void turn_map(double angle);

  MapBuilderOptions options_;
  map::BuilderMemory m_;
  map::MapMechanics mechanics_;
  std::vector<int> unwritten_;           ///< landmarks that have moved, and in the graph not yet
  bool all_unwritten_ = false;           ///< any may have
  std::vector<RouteElements> elements_;  ///< per route
  std::vector<int> reckoned_at_;         ///< per route: its place in m_.reckoned, or -1
  std::vector<int> corner_elements_;     ///< per corner
  std::map<std::array<int, 3>, int> corner_at_;  ///< by its landmarks i, j, k
};

}  // namespace trussmap
