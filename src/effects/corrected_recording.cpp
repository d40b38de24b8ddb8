// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/corrected_recording.hpp"

#include "drive/body_motion.hpp"
#include "drive/row_motion.hpp"
#include "drive/row_variables.hpp"
#include "effects/channel_physics.hpp"
#include "effects/steering.hpp"
#include "geometry/index.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap::effects {
namespace {

void free_sightings(Channel channel, const std::vector<double>& g, DrivenRecording& recording) {
  for (Sighting& sighting : recording.sightings) {
    if (sighting.standing() && channel != Channel::sighting_yaw) continue;
    sighting = without(channel, g[drive::row_at(recording.drive, sighting.t)], sighting);
    if (!std::isnan(sighting.range) && !(sighting.range > 0.0)) {
      throw std::invalid_argument("leaves a range of " + text::short_text(sighting.range) +
                                  " m at t = " + text::short_text(sighting.t) + " s");
    }
  }
}

void apply(Channel channel, const std::vector<double>& g, const Robot& robot,
           DrivenRecording& recording) {
  // A tracker's affair, or a receiver's.
  if (channel == Channel::truth_heading || acts_on_fixes(channel) || acts_on_loops(channel)) {
    return;
  }
  if (std::all_of(g.begin(), g.end(), [](double one) { return one == 0.0; })) return;
  // A drive that goes sideways has a place for what it slips.
  const bool creeps = channel == Channel::creep && !recording.drive.sideways.empty();
  if (!creeps && !is_recordable(channel)) {
    throw std::invalid_argument("has channel \"" + std::string(name_of(channel)) +
                                "\", which only an adjustment can take into account");
  }
  switch (acts_on(channel)) {
    case ActsOn::readings:
      for (std::size_t row = 0; row < recording.drive.heading.size(); ++row) {
        recording.drive.heading[row] -= g[row];
      }
      return;
    case ActsOn::views:
      return free_sightings(channel, g, recording);
    case ActsOn::drives:
      return free_drive(channel, g, robot, recording.drive);
  }
}

}  // namespace

std::vector<double> gains_of(const Effect& effect, const RowVariables& variables, int session,
                             std::size_t rows) {
  std::vector<double> g(rows, 0.0);
  if (effect.coefficients.empty()) return g;
  const std::size_t shapes = effect.shape.size();
  const std::size_t first = effect.per_session ? idx(session) * shapes : 0;
  if (first + shapes > effect.coefficients.size()) {
    throw std::invalid_argument("has " + std::to_string(effect.coefficients.size()) +
                                " coefficients, expected " + std::to_string(shapes) +
                                " for each of the sessions");
  }
  for (std::size_t k = 0; k < shapes; ++k) {
    const std::vector<double> f = effect.shape[k].values(variables);
    for (std::size_t row = 0; row < rows; ++row) g[row] += effect.coefficients[first + k] * f[row];
  }
  return g;
}

void free_drive(Channel channel, const std::vector<double>& g, const Robot& robot,
                MotionRows& drive) {
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const DrivePattern more =
        drive_pattern(channel, g[row], drive::shown_motion(drive, row, robot));
    drive::add_motion(drive, row, {more.advance, more.slip, more.turn}, robot);
    if (drive.has_gyro())
      drive.yaw_rate[row] = yaw_rate_without(channel, g[row], drive.yaw_rate[row]);
  }
}

void require_shapes(const Effect& effect) {
  if (!effect.shape.empty()) return;
  throw std::invalid_argument("effect \"" + effect.name +
                              "\" has no shape, expected at least one (catalogue_effect gives one "
                              "of the catalogue's with its own)");
}

DrivenRecording corrected_recording(const DrivenRecording& recording, const Model& model,
                                    const RowVariables& variables, int session) {
  DrivenRecording corrected = recording;
  for (const Effect& effect : model.effects) require_shapes(effect);
  corrected.drive =
      steered(std::move(corrected.drive), model.robot, model.effects, variables, session);
  for (const Effect& effect : model.effects) {
    if (is_steering(effect.channel)) continue;
    try {
      const std::vector<double> g = gains_of(effect, variables, session, recording.drive.rows());
      apply(effect.channel, g, model.robot, corrected);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
    }
  }
  return corrected;
}

}  // namespace trussmap::effects
