// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One recording on its way into the map.
#pragma once

#include "build_map/leg_by_leg.hpp"
#include "drive/legs.hpp"
#include "trussmap/map_builder.hpp"

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace trussmap::map_building {

class MappedSession {
 public:
  /// Counts go to `result`.
  MappedSession(const SightedDrive& drive, const LegByLegOptions& options, MapBuilder& builder,
                BuiltMap& result);

  /// Hands every leg to the builder.
  void run();

 private:
  /// A sighting that was not left out.
  struct Accepted {
    const Sighting* sighting = nullptr;
    LandmarkOffset offset;
  };

  void begin(const drive::Stop& stop);
  void visit(const drive::Stop& stop);
  [[nodiscard]] std::vector<Accepted> accepted_at(const drive::Stop& stop) const;
  void arrive(const drive::Stop& stop, const Accepted& at);
  void observe(const std::vector<Accepted>& others);
  [[nodiscard]] bool has_map_axes() const;
  [[nodiscard]] Arrival arrive_at(const Accepted& at);
  [[nodiscard]] std::vector<std::size_t> tour_ends() const;
  void note_tour();
  [[nodiscard]] bool dilutes(const std::string& landmark, const Matrix2& covariance) const;
  [[nodiscard]] Traversal in_map(const PositionEstimate& place) const;
  void settle(const drive::Stop& stop, const Accepted& at, const HeadingEstimate& heading);
  [[nodiscard]] HeadingEstimate first_heading(const Sighting& at, const InitialHeading& first);
  [[nodiscard]] HeadingEstimate heading_after(const Accepted& at, const PositionEstimate& place);
  [[nodiscard]] HeadingEstimate with_yaw(const Sighting& at, const HeadingEstimate& heading);
  [[nodiscard]] HeadingEstimate with_own_yaw(const Sighting& at, const HeadingEstimate& heading);

  const SightedDrive& drive_;
  bool own_axes_;  // legs are handed on in the robot's own axes: no compass, no guide
  const DrivenRecording& recording_;
  const LegByLegOptions& options_;
  MapBuilder& builder_;
  BuiltMap& result_;
  std::vector<double> path_;
  const Sighting* reference_ = nullptr;  // where the present leg began
  PoseEstimate pose_;                    // from that landmark, map axes
  LandmarkOffset reference_offset_;      // of that landmark, where the leg began
  double time_ = 0.0;                    // of pose_
  double leg_start_ = 0.0;               // driven path at the leg's start
  double start_heading_variance_ = 0.0;
  std::size_t legs_ = 0;                // driven
  std::vector<std::size_t> tour_ends_;  // legs at which all routes have been driven (again)
  LandmarkPositions survey_;
  std::map<std::string, HeadingEstimate> orientations_;  // of landmarks, on the way
  double readings_used_until_ =
      -std::numeric_limits<double>::infinity();  // compass readings that the start heading rests on
};

}  // namespace trussmap::map_building
