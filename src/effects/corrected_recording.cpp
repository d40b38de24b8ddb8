// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/corrected_recording.hpp"

#include "effects/shape.hpp"
#include "geometry/index.hpp"
#include "trussmap/channel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// g of one effect, row by row.
std::vector<double> gains(const Effect& effect, const RowVariables& variables, int session,
                          std::size_t rows) {
  std::vector<double> g(rows, 0.0);
  if (effect.coefficients.empty()) return g;
  const std::size_t shapes = effect.shape.size();
  const std::size_t first = effect.per_session ? idx(session) * shapes : 0;
  if (first + shapes > effect.coefficients.size()) {
    throw std::invalid_argument(
        fmt::format("has {} coefficients, expected {} for each of the sessions",
                    effect.coefficients.size(), shapes));
  }
  for (std::size_t k = 0; k < shapes; ++k) {
    const std::vector<double> f = evaluate_shape(effect.shape[k], variables);
    for (std::size_t row = 0; row < rows; ++row) g[row] += effect.coefficients[first + k] * f[row];
  }
  return g;
}

/// Forward travel and turn of a row, changed, as wheels would show them.
void change_motion(Channel channel, double g, double duration, double wheelbase, double& left,
                   double& right) {
  const double travel = 0.5 * (left + right);
  const double turn = (right - left) / wheelbase;
  double more_travel = 0.0;
  double more_turn = 0.0;
  switch (channel) {
    case Channel::left:
      left *= 1.0 + g;
      return;
    case Channel::right:
      right *= 1.0 + g;
      return;
    case Channel::wheels:
      left *= 1.0 + g;
      right *= 1.0 + g;
      return;
    case Channel::difference:
      left *= 1.0 - 0.5 * g;
      right *= 1.0 + 0.5 * g;
      return;
    case Channel::travel:
      more_travel = g * travel;
      break;
    case Channel::advance:
      more_travel = g;
      break;
    case Channel::turn:
      more_turn = g * turn;
      break;
    case Channel::drift:
      more_turn = g * duration;
      break;
    case Channel::rotate:
      more_turn = g;
      break;
    default:
      throw std::invalid_argument("has no place in the wheels' travels");
  }
  left += more_travel - 0.5 * wheelbase * more_turn;
  right += more_travel + 0.5 * wheelbase * more_turn;
}

void apply(const Effect& effect, Channel channel, const std::vector<double>& g, double wheelbase,
           Recording& recording) {
  Drive& drive = recording.drive;
  switch (channel) {
    case Channel::compass:
      for (std::size_t row = 0; row < drive.heading.size(); ++row) drive.heading[row] -= g[row];
      return;
    case Channel::range:
    case Channel::range_scale:
    case Channel::bearing:
      for (Sighting& sighting : recording.sightings) {
        if (sighting.standing()) continue;
        const double here = g[row_at(drive, sighting.t)];
        if (channel == Channel::bearing) sighting.bearing = wrap_angle(sighting.bearing - here);
        if (channel == Channel::range) sighting.range -= here;
        if (channel == Channel::range_scale) sighting.range /= 1.0 + here;
        if (!(sighting.range > 0.0)) {
          throw std::invalid_argument(
              fmt::format("leaves a range of {:g} m at t = {:g} s", sighting.range, sighting.t));
        }
      }
      return;
    case Channel::creep:
    case Channel::lever:
    case Channel::lever_left:
    case Channel::delay:
      throw std::invalid_argument(fmt::format(
          "has channel \"{}\", which only an adjustment can take into account", effect.channel));
    default:
      for (std::size_t row = 0; row < drive.rows(); ++row) {
        const double begin = row == 0 ? drive.start() : drive.t[row - 1];
        change_motion(channel, g[row], drive.t[row] - begin, wheelbase, drive.left[row],
                      drive.right[row]);
      }
  }
}

}  // namespace

Recording corrected_recording(const Recording& recording, const Model& model,
                              const RowVariables& variables, int session) {
  Recording corrected = recording;
  for (const Effect& effect : model.effects) {
    try {
      const std::optional<Channel> channel = parse_channel(effect.channel);
      if (!channel) {
        throw std::invalid_argument("has channel \"" + effect.channel +
                                    "\", which is unknown, expected one of " + channel_names());
      }
      const std::vector<double> g = gains(effect, variables, session, recording.drive.rows());
      apply(effect, *channel, g, model.robot.wheelbase, corrected);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
    }
  }
  return corrected;
}

}  // namespace trussmap
