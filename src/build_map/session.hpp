// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One recording on its way into the map.
#pragma once

#include "build_map/leg_by_leg.hpp"
#include "recording/legs.hpp"
#include "trussmap/map_builder.hpp"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// Places at which a landmark that is not in the map was sighted.
class Candidates {
 public:
  explicit Candidates(const LegByLegOptions& options) : options_(&options) {}

  /// Adds a sighting; true if enough of them, this one included, agree.
  bool confirmed(const std::string& landmark, const PositionEstimate& place);

  [[nodiscard]] std::vector<std::string> unconfirmed() const;

 private:
  const LegByLegOptions* options_;
  std::map<std::string, std::vector<PositionEstimate>> places_;
};

class Session {
 public:
  /// `guide`: where an earlier look at the recordings put the landmarks. Counts go to `result`.
  Session(const SightedDrive& drive, const LegByLegOptions& options, const LandmarkPositions& guide,
          MapBuilder& builder, Candidates& candidates, BuiltMap& result);

  /// Hands every leg to the builder.
  void run();

 private:
  /// A sighting that the gate let through.
  struct Accepted {
    const Sighting* sighting = nullptr;
    LandmarkOffset offset;
  };

  void resume(const Stop& stop);
  void begin(const Stop& stop, const Sighting& at, const HeadingEstimate& heading);
  void visit(const Stop& stop);
  void consider(const Sighting& sighting, std::vector<Accepted>& accepted);
  void reject(const Sighting& sighting, double misfit);
  void arrive(const Stop& stop, const Accepted& at);
  void observe(const std::vector<Accepted>& others);
  [[nodiscard]] bool dilutes(const std::string& landmark, const Matrix2& covariance) const;
  void settle(const Stop& stop, const Accepted& at, const HeadingEstimate& heading);
  [[nodiscard]] LandmarkOffset offset_of(const Sighting& sighting) const;
  [[nodiscard]] std::optional<Vector2> believed(const std::string& landmark) const;
  [[nodiscard]] HeadingEstimate heading_after(const Accepted& at,
                                              const PositionEstimate& place) const;

  const SightedDrive& drive_;
  const Recording& recording_;
  const LegByLegOptions& options_;
  const LandmarkPositions& guide_;
  MapBuilder& builder_;
  Candidates& candidates_;
  BuiltMap& result_;
  std::vector<double> path_;
  const Sighting* reference_ = nullptr;  // where the present leg began
  PoseEstimate pose_;                    // from that landmark, map axes
  double time_ = 0.0;                    // of pose_
  double leg_start_ = 0.0;               // driven path at the leg's start
  double start_heading_variance_ = 0.0;
  double readings_used_until_ =
      -std::numeric_limits<double>::infinity();  // compass readings that the start heading rests on
};

}  // namespace trussmap
