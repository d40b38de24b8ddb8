// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model's effects, for one row at a time, by what they act on.
#pragma once

#include "drive/steered_motion.hpp"
#include "effects/channel_physics.hpp"
#include "fit/online_terms.hpp"
#include "trussmap/model.hpp"

#include <span>
#include <string>
#include <vector>

namespace trussmap::fitting {

/// What shapes see besides the pose.
struct OnlineFacts {
  drive::CausalRow row;
  std::span<const double> covariates;
};

/// Each throws std::invalid_argument, naming the effect, where a shape has no finite value.
class OnlineEffects {
 public:
  /// Throws std::invalid_argument, naming the effect, as OnlineTerms::add does.
  OnlineEffects(const std::vector<Effect>& effects, const std::vector<std::string>& covariates);

  [[nodiscard]] bool steer() const { return !steering_.all().empty(); }
  /// Whether a shape that acts on rows or compass readings speaks of heading, x or y.
  [[nodiscard]] bool see_the_pose() const;

  /// What is added to steering that reads so; `middle`: where the robot is in the middle of the
  /// row.
  drive::SteeringChange steering(const OnlineFacts& facts, const Pose& middle,
                                 const std::vector<double>& readings);
  /// What is added to a row that the wheels show so.
  effects::DrivePattern drive(const OnlineFacts& facts, const Pose& middle,
                              const drive::RowMotion& shown);
  /// A compass reading at the row's end less what is added to it, rad.
  double cleared_reading(double reading, const OnlineFacts& facts, const Pose& end);

  /// A time of sighting less its delay, s.
  [[nodiscard]] double cleared_time(double t, const OnlineFacts& facts) const;
  /// What is added to a sighting.
  [[nodiscard]] effects::ViewPattern view(const OnlineFacts& facts, const Pose& end) const;

 private:
  OnlineTerms& terms_of(Channel channel);

  OnlineTerms steering_{OnlineTerms::Instant::middle};
  OnlineTerms drives_{OnlineTerms::Instant::middle};
  OnlineTerms readings_{OnlineTerms::Instant::end};
  OnlineTerms views_{OnlineTerms::Instant::end};
  OnlineTerms delays_{OnlineTerms::Instant::end};
};

}  // namespace trussmap::fitting
