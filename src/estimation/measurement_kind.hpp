// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A kind of measurement: all that the adjustment, the reckoning of a start, the prediction of legs,
// the search for noise, the tests of lasting noise, the drawing of recordings anew and the reports
// have to know of it. A sensor is a kind of its own, in a file of its own (kinds/); nothing else
// asks which one it has before it, but for the facts below.
#pragma once

#include "estimation/measurement.hpp"
#include "statistics/normal_draws.hpp"
#include "trussmap/channel.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::estimation {

/// Where the row stands that measured it.
enum class RecordingStream { drive, sightings, survey, truth, fixes, loops };

enum class NodeType { none, pose, landmark, orientation };

/// What it says in the map's frame, whatever was driven.
enum class InMap { nothing, place, heading, pose };

/// What Gauss and Newton leave out of its second derivatives (second_order.hpp).
enum class Curvature {
  none,                   ///< linear in all but the view
  of_a_way,               ///< rows R(theta)'(end - start) - something by which nothing moves
  of_a_way_by_view,       ///< the same, R(theta + heading of the view)
  of_a_way_without_view,  ///< the same, where the view adds nothing
  general
};

struct KindFacts {
  std::string_view words;         ///< "sight of", before what it is of and when
  std::string_view several = {};  ///< "sightings"
  RecordingStream stream = RecordingStream::drive;
  NodeType from = NodeType::pose;
  NodeType to = NodeType::none;
  InMap in_map = InMap::nothing;
  /// The model's key of the noise of its rows, and of those from a row on.
  std::string_view noise;
  int other_from = 4;
  std::string_view other_noise = {};
  /// Of which a search for noise looks for the size.
  bool noise_is_sought = false;
  /// As a whole, and is then left out: a landmark misread, a fix by an echo, a place taken for
  /// another.
  bool may_be_wrong = false;
  Curvature curvature = Curvature::general;
};

/// Values of the unknowns that a measurement lies between; of a kind's own nodes.
struct Ends {
  Pose from;
  Pose to;
  Vector2 landmark = Vector2::Zero();
  double orientation = 0.0;
};

/// A residual to look at, and the channel that moves it.
struct NamedResidual {
  std::string name;
  Channel channel = Channel::travel;
};

class MeasurementKind {
 public:
  constexpr explicit MeasurementKind(const KindFacts& facts) : facts_(facts) {}
  MeasurementKind(const MeasurementKind&) = delete;
  MeasurementKind& operator=(const MeasurementKind&) = delete;

  [[nodiscard]] const KindFacts& facts() const { return facts_; }

  /// `value` is what was measured, with what effects and lasting noise add to a drive; `view` what
  /// they add to all else. m, rad.
  [[nodiscard]] virtual MeasurementRows rows(const Measurement& one, const Ends& at,
                                             const Vector4& value,
                                             const effects::ViewPattern& view) const = 0;

  /// The model's key of the noise that a row has.
  [[nodiscard]] std::string_view noise(Eigen::Index row) const {
    return row < facts_.other_from ? facts_.noise : facts_.other_noise;
  }

  /// What of its covariance no size in a search for noise changes: all of it, or nothing.
  [[nodiscard]] virtual Matrix4 fixed_covariance(const Measurement& one, const Noise& stated) const;

  /// Whether what acts on a channel changes it.
  [[nodiscard]] virtual bool shows(Channel channel, const Measurement& one) const;
  /// Variance of its rows by a white g of variance 1, of a channel that is a reading (range,
  /// bearing).
  [[nodiscard]] virtual Matrix4 reading_variance(Channel channel, const Measurement& one) const;
  /// What a unit of g adds to its view, at this speed (m/s) and turn rate (rad/s).
  [[nodiscard]] virtual effects::ViewVector unit_view(Channel channel, const Measurement& one,
                                                      double speed, double turn_rate) const;

  /// Where it has what it measures, m, map frame: the landmark, or the point that truth and fixes
  /// track. Nothing where it does not say: a range or a bearing alone.
  [[nodiscard]] virtual std::optional<Vector2> seen_from(const Measurement& one, const Pose& pose,
                                                         const effects::ViewPattern& view) const;
  /// By its rows' errors, m.
  [[nodiscard]] virtual Eigen::Matrix<double, 2, 4> seen_by_rows(
      const Measurement& one, const Pose& pose, const effects::ViewPattern& view) const;
  /// m by which a sighting from there misses a landmark; NaN where it does not say.
  [[nodiscard]] virtual double missed(const Measurement& one, const Pose& pose,
                                      const Vector2& landmark,
                                      const effects::ViewPattern& view) const;
  /// Covariance that its rows get while poses are reckoned for a start: landmarks lie within
  /// `map_sd`, m. rows x rows.
  [[nodiscard]] virtual Eigen::MatrixXd slack(const Measurement& one, const MeasurementRows& rows,
                                              double map_sd) const;

  /// Residuals of its own that may go with a variable, where it has so many rows.
  [[nodiscard]] virtual std::vector<NamedResidual> residuals(int rows) const;

  /// A sighting's row drawn anew; `exact` are its values without noise.
  virtual void draw(const Vector4& exact, const Noise& noise, statistics::NormalDraws& draws,
                    Sighting& sighting) const;

 protected:
  ~MeasurementKind() = default;

 private:
  KindFacts facts_;
};

/// Of the drive: what its rows add up to.
[[nodiscard]] inline bool is_driven(const Measurement& one) {
  return one.kind->facts().stream == RecordingStream::drive;
}

[[nodiscard]] inline bool is_between_poses(const Measurement& one) {
  return one.kind->facts().to == NodeType::pose;
}

/// The drive from one pose to the next.
[[nodiscard]] inline bool is_segment(const Measurement& one) {
  return is_driven(one) && is_between_poses(one);
}

/// Between two poses, beside the drive.
[[nodiscard]] inline bool is_tie(const Measurement& one) {
  return is_between_poses(one) && !is_driven(one);
}

/// The drive with a compass.
[[nodiscard]] inline bool reads_compass(const Measurement& one) {
  return is_segment(one) && one.rows == 4;
}

/// Of a landmark: standing on it, or seeing it.
[[nodiscard]] inline bool is_sighting(const Measurement& one) {
  return one.kind->facts().to == NodeType::landmark;
}

/// Of a landmark's orientation, from a pose.
[[nodiscard]] inline bool is_yaw(const Measurement& one) {
  return one.kind->facts().to == NodeType::orientation;
}

/// A landmark's orientation in the map's frame.
[[nodiscard]] inline bool is_surveyed_heading(const Measurement& one) {
  return one.kind->facts().from == NodeType::orientation;
}

/// Of a landmark's orientation: it says nothing of a place.
[[nodiscard]] inline bool is_of_orientation(const Measurement& one) {
  return is_yaw(one) || is_surveyed_heading(one);
}

[[nodiscard]] inline bool tells_of_map(const Measurement& one) {
  return one.kind->facts().in_map != InMap::nothing;
}

/// Of a direction in the map's frame: a heading, or a landmark's axis.
[[nodiscard]] inline bool tells_heading(const Measurement& one) {
  const InMap in_map = one.kind->facts().in_map;
  return in_map == InMap::heading || in_map == InMap::pose;
}

/// Of a place in the map's frame.
[[nodiscard]] inline bool is_in_map_frame(const Measurement& one) {
  const InMap in_map = one.kind->facts().in_map;
  return in_map == InMap::place || in_map == InMap::pose;
}

/// A landmark's place in the map's frame.
[[nodiscard]] inline bool is_surveyed_place(const Measurement& one) {
  return is_in_map_frame(one) && one.kind->facts().from == NodeType::landmark;
}

/// The robot's place in the map's frame, without its heading.
[[nodiscard]] inline bool is_position(const Measurement& one) {
  const KindFacts& facts = one.kind->facts();
  return facts.in_map == InMap::place && facts.from == NodeType::pose;
}

/// The robot's place and heading in the map's frame.
[[nodiscard]] inline bool gives_pose(const Measurement& one) {
  return one.kind->facts().in_map == InMap::pose;
}

[[nodiscard]] inline bool may_be_wrong(const Measurement& one) {
  return one.kind->facts().may_be_wrong;
}

/// Whether the noise of its first row goes by this key of the model.
[[nodiscard]] inline bool begins_with(const Measurement& one, std::string_view noise) {
  return one.kind->noise(0) == noise;
}

/// On the landmark.
[[nodiscard]] inline bool is_standing(const Measurement& one) {
  return is_sighting(one) && begins_with(one, "sighting");
}

/// A sighting that says where its landmark is from the robot: a range or a bearing alone does not.
[[nodiscard]] inline bool locates(const Measurement& one) {
  return is_sighting(one) && one.rows >= 2;
}

}  // namespace trussmap::estimation
