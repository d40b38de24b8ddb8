// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/effect_columns.hpp"

#include "drive/row_motion.hpp"
#include "drive/row_variables.hpp"
#include "effects/corrected_recording.hpp"
#include "effects/steering.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace trussmap::fitting {
namespace {

using Instant = ShapeContext::Instant;

std::vector<effects::ViewPattern> views(Channel channel, const std::vector<double>& f,
                                        const RowVariables& variables) {
  const std::vector<double>& speed = variables.at("speed");
  const std::vector<double>& turn_rate = variables.at("turn_rate");
  std::vector<effects::ViewPattern> result;
  result.reserve(f.size());
  for (std::size_t k = 0; k < f.size(); ++k) {
    result.push_back(effects::view_pattern(channel, f[k], speed[k], turn_rate[k]));
  }
  return result;
}

double largest(const std::vector<std::vector<double>>& values) {
  double most = 0.0;
  for (const std::vector<double>& session : values) {
    most = std::max(most, largest_but_for_spikes(session));
  }
  return most;
}

template <typename Event>
RowVariables event_variables(const DrivenRecording& recording, const Robot& robot,
                             const SessionPath& path, const std::vector<Event>& events,
                             int session) {
  std::vector<double> instants;
  std::vector<Pose> poses;
  for (const Event& event : events) {
    instants.push_back(event.t);
    poses.push_back(pose_at(recording.drive, path, event.t));
  }
  return drive::instant_variables(recording.drive, robot, instants, poses, session);
}

}  // namespace

void add_noise(const Vector2& missing, double excess, drive::RowMotion& row) {
  Vector2 lacks = missing;
  if (row.gyro_reads) {
    // The noise of an excess is the wheels' in part, and the gyro's for the rest.
    row.gyro_turn += lacks[1] - (1.0 - row.gyro_share) * excess;
    lacks += excess * Vector2(row.gyro_along, row.gyro_share);
  }
  if (row.shown != nullptr) lacks = (*row.shown * lacks).eval();
  row.body = row.body + BodyMotion{lacks[0], 0.0, lacks[1]};
}

ShapeContext::ShapeContext(const std::vector<DrivenRecording>& recordings, const Robot& robot,
                           const std::vector<SessionPath>& paths)
    : recordings_(recordings), robot_(robot), paths_(paths) {}

drive::RowMotion ShapeContext::motion(std::size_t session, std::size_t row) const {
  drive::RowMotion motion = drive::row_motion(recordings_[session].drive, row, robot_);
  const SessionPath& path = paths_[session];
  if (path.missing.empty()) return motion;
  add_noise(path.missing[row], path.excess.empty() ? 0.0 : path.excess[row], motion);
  return motion;
}

const RowVariables& ShapeContext::variables(std::size_t session, Instant at) const {
  const auto key = std::make_pair(session, at);
  const auto found = variables_.find(key);
  if (found != variables_.end()) return found->second;
  const DrivenRecording& one = recordings_[session];
  const SessionPath& path = paths_[session];
  const int number = static_cast<int>(session);
  const auto made = [&]() -> RowVariables {
    switch (at) {
      case Instant::middle:
        return drive::row_variables(one.drive, robot_, path.start, path.ends, number);
      case Instant::end:
        return drive::instant_variables(one.drive, robot_, one.drive.t, path.ends, number);
      case Instant::sighting:
        return event_variables(one, robot_, path, one.sightings, number);
      case Instant::truth:
        return event_variables(one, robot_, path, one.truth, number);
      case Instant::fix:
        return event_variables(one, robot_, path, one.fixes, number);
      case Instant::loop:
        break;
    }
    return event_variables(one, robot_, path, one.loops, number);
  };
  return variables_.emplace(key, made()).first->second;
}

void ShapeContext::prepare(Instant at) const {
  for (std::size_t s = 0; s < recordings_.size(); ++s) static_cast<void>(variables(s, at));
}

std::vector<std::vector<double>> ShapeContext::values(const Shape& shape, Instant at) const {
  std::vector<std::vector<double>> result;
  result.reserve(recordings_.size());
  for (std::size_t s = 0; s < recordings_.size(); ++s) {
    result.push_back(shape.values(variables(s, at)));
  }
  return result;
}

namespace {

struct Column {
  estimation::EffectPattern pattern;
  double largest = 0.0;
};

void keep_session(std::vector<std::vector<double>>& values, int session) {
  for (std::size_t s = 0; s < values.size() && session >= 0; ++s) {
    if (s != idx(session)) std::fill(values[s].begin(), values[s].end(), 0.0);
  }
}

/// What fails within is told with the effect's name.
template <typename Action>
auto in_words_of(const Effect& effect, const Action& action) {
  try {
    return action();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
  }
}

/// Along the session's path, where there is one.
RowVariables variables_along(const MotionRows& drive, const Robot& robot,
                             const std::vector<SessionPath>& paths, std::size_t session) {
  const bool led = session < paths.size() && paths[session].ends.size() == drive.rows();
  const int number = static_cast<int>(session);
  return led ? drive::row_variables(drive, robot, paths[session].start, paths[session].ends, number)
             : drive::row_variables(drive, robot, Pose(), std::vector<Pose>(drive.rows()), number);
}

Column make_column(Channel channel, const Shape& shape, int session, const ShapeContext& context) {
  const std::vector<DrivenRecording>& recordings = context.recordings();
  Column column;
  if (effects::acts_on(channel) == effects::ActsOn::views) {
    const auto add = [&](Instant at, bool acts,
                         std::vector<std::vector<effects::ViewPattern>>& patterns) {
      if (!acts) return;
      auto values = context.values(shape, at);
      keep_session(values, session);
      for (std::size_t s = 0; s < recordings.size(); ++s) {
        patterns.push_back(views(channel, values[s], context.variables(s, at)));
      }
      column.largest = std::max(column.largest, largest(values));
    };
    add(Instant::sighting, effects::acts_on_sightings(channel), column.pattern.sightings);
    add(Instant::truth, effects::acts_on_truth(channel), column.pattern.truths);
    add(Instant::fix, effects::acts_on_fixes(channel), column.pattern.fixes);
    add(Instant::loop, effects::acts_on_loops(channel), column.pattern.loops);
    return column;
  }
  const bool readings = effects::acts_on(channel) == effects::ActsOn::readings;
  auto values = context.values(shape, readings ? Instant::end : Instant::middle);
  keep_session(values, session);
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    std::vector<effects::DrivePattern>& patterns = column.pattern.drives.emplace_back();
    patterns.reserve(values[s].size());
    for (std::size_t row = 0; row < values[s].size(); ++row) {
      patterns.push_back(effects::drive_pattern(channel, values[s][row], context.motion(s, row)));
    }
  }
  column.largest = adds_to_rows(channel, shape)
                       ? size_of_additions(channel, shape, session, context)
                       : largest(values);
  return column;
}

}  // namespace

double largest_but_for_spikes(const std::vector<double>& values) {
  constexpr double kShare = 0.05;
  constexpr int kBins = 32;
  double sum = 0.0;
  double limit = 0.0;
  for (const double f : values) {
    sum += std::abs(f);
    limit = std::max(limit, std::abs(f));
  }
  if (!(limit > 0.0) || !std::isfinite(sum)) return limit;
  // Sums by size; again within the lowest bin where all but spikes are in it.
  double above = 0.0;
  for (int round = 0; round < 8; ++round) {
    std::array<double, kBins> sums{};
    for (const double f : values) {
      const double size = std::abs(f);
      if (size > limit) continue;
      const int bin = std::min(kBins - 1, static_cast<int>(kBins * (size / limit)));
      sums[idx(bin)] += size;
    }
    int bin = kBins - 1;
    for (; bin > 0 && above + sums[idx(bin)] <= kShare * sum; --bin) above += sums[idx(bin)];
    if (bin == kBins - 1) return limit;
    limit *= (bin + 1.0) / kBins;
    if (bin > 0) return limit;
  }
  return limit;
}

bool adds_to_rows(Channel channel, const Shape& shape) {
  if (channel != Channel::advance && channel != Channel::rotate) return false;
  const std::vector<std::string>& names = shape.variables();
  return std::none_of(names.begin(), names.end(),
                      [](const std::string& name) { return recording::is_event(name); });
}

double size_of_additions(Channel channel, const Shape& shape, int session,
                         const ShapeContext& context) {
  const Channel gain = channel == Channel::advance ? Channel::travel : Channel::turn;
  double added = 0.0;
  double moved = 0.0;
  const auto values = context.values(shape, Instant::middle);
  for (std::size_t s = 0; s < values.size(); ++s) {
    if (session >= 0 && s != idx(session)) continue;
    for (std::size_t row = 0; row < values[s].size(); ++row) {
      const effects::DrivePattern unit = effects::drive_pattern(gain, 1.0, context.motion(s, row));
      added += std::abs(values[s][row]);
      moved += std::abs(gain == Channel::travel ? unit.advance : unit.turn);
    }
  }
  // A loss while the robot turns is often a tenth of what it travels meanwhile: no rarity.
  constexpr double kMoreThanGains = 3.0;
  const double share = moved > 0.0 ? added / moved / kMoreThanGains : 0.0;
  return share * facts_of(channel).prior_sd / facts_of(gain).prior_sd;
}

estimation::EffectPattern effect_column(Channel channel, const Shape& shape, int session,
                                        const ShapeContext& context) {
  return make_column(channel, shape, session, context).pattern;
}

std::size_t coefficient_count(const Effect& effect, std::size_t sessions) {
  return effect.shape.size() * (effect.per_session ? sessions : 1);
}

std::vector<double> coefficients_of(const Effect& effect, std::size_t sessions) {
  effects::require_shapes(effect);
  const std::size_t expected = coefficient_count(effect, sessions);
  if (effect.coefficients.empty()) return std::vector<double>(expected, 0.0);
  if (effect.coefficients.size() != expected) {
    throw std::invalid_argument(text::joined(
        "effect \"", effect.name, "\" has ", effect.coefficients.size(), " coefficients, expected ",
        expected, ": one per shape",
        effect.per_session ? text::joined(" and session, of which there are ", sessions) : ""));
  }
  return effect.coefficients;
}

bool is_laid_out(Channel channel) {
  return effects::is_delay(channel) || effects::is_steering(channel);
}

EffectColumns effect_columns(const std::vector<Effect>& effects, const ShapeContext& context) {
  EffectColumns result;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const Effect& effect = effects[e];
    const std::size_t sessions = effect.per_session ? context.recordings().size() : 1;
    const std::vector<double> coefficients = coefficients_of(effect, context.recordings().size());
    for (std::size_t place = 0; place < coefficients.size(); ++place) {
      const std::size_t shape = place % effect.shape.size();
      const int session = sessions == 1 ? -1 : static_cast<int>(place / effect.shape.size());
      Column column = in_words_of(effect, [&] {
        return make_column(effect.channel, effect.shape[shape], session, context);
      });
      column.pattern.name = effect.name;
      if (is_laid_out(effect.channel)) column.pattern.reference = coefficients[place];
      result.border.push_back(std::move(column.pattern));
      result.coefficients.push_back({e, shape, place, column.largest});
    }
  }
  return result;
}

std::vector<double> retimed(const std::vector<double>& instants, const DrivenRecording& recording,
                            std::size_t session, std::size_t sessions,
                            const std::vector<Effect>& effects, const Robot& robot, Channel delay) {
  std::vector<double> result = instants;
  const std::vector<Pose> nowhere(instants.size());
  for (const Effect& effect : effects) {
    if (effect.channel != delay) continue;
    const std::vector<double> coefficients = coefficients_of(effect, sessions);
    const RowVariables variables = drive::instant_variables(recording.drive, robot, instants,
                                                            nowhere, static_cast<int>(session));
    for (std::size_t k = 0; k < effect.shape.size(); ++k) {
      const std::vector<double> f =
          in_words_of(effect, [&] { return effect.shape[k].values(variables); });
      const std::size_t place = (effect.per_session ? session * effect.shape.size() : 0) + k;
      for (std::size_t n = 0; n < result.size(); ++n) result[n] -= coefficients[place] * f[n];
    }
  }
  return result;
}

std::vector<DrivenRecording> steered(const std::vector<DrivenRecording>& recordings,
                                     const std::vector<Effect>& effects, const Robot& robot,
                                     const std::vector<SessionPath>& paths) {
  std::vector<DrivenRecording> result = recordings;
  if (!effects::steers(effects)) return result;
  for (std::size_t s = 0; s < result.size(); ++s) {
    MotionRows& drive = result[s].drive;
    const RowVariables variables = variables_along(drive, robot, paths, s);
    drive = effects::steered(std::move(drive), robot, effects, variables, static_cast<int>(s));
  }
  return result;
}

bool leave_a_way(const std::vector<Effect>& effects, const std::vector<DrivenRecording>& recordings,
                 const Robot& robot, const std::vector<SessionPath>& paths) {
  if (!effects::steers(effects)) return true;
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const MotionRows& drive = recordings[s].drive;
    const RowVariables variables = variables_along(drive, robot, paths, s);
    if (!effects::leave_a_way(effects, drive, robot, variables, static_cast<int>(s))) return false;
  }
  return true;
}

Channel delay_of_legs(const DrivenRecording& recording) {
  const bool fixes_alone =
      recording.sightings.empty() && recording.truth.empty() && !recording.fixes.empty();
  return fixes_alone ? Channel::fix_delay : Channel::delay;
}

std::vector<DrivenRecording> retimed(const std::vector<DrivenRecording>& recordings,
                                     const std::vector<Effect>& effects, const Robot& robot) {
  std::vector<DrivenRecording> result = recordings;
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const auto shift = [&](auto& events, Channel delay) {
      std::vector<double> instants;
      instants.reserve(events.size());
      for (const auto& event : events) instants.push_back(event.t);
      instants = retimed(instants, recordings[s], s, recordings.size(), effects, robot, delay);
      for (std::size_t n = 0; n < events.size(); ++n) events[n].t = instants[n];
    };
    shift(result[s].sightings, Channel::delay);
    shift(result[s].truth, Channel::delay);
    shift(result[s].fixes, Channel::fix_delay);
  }
  for (DrivenRecording& recording : result) {
    const auto outside = [&recording](const auto& event) {
      return event.t < recording.drive.start() || event.t > recording.drive.t.back();
    };
    const auto earlier = [](const auto& a, const auto& b) { return a.t < b.t; };
    std::erase_if(recording.sightings, outside);
    std::erase_if(recording.truth, outside);
    std::erase_if(recording.fixes, outside);
    std::stable_sort(recording.sightings.begin(), recording.sightings.end(), earlier);
    std::stable_sort(recording.truth.begin(), recording.truth.end(), earlier);
    std::stable_sort(recording.fixes.begin(), recording.fixes.end(), earlier);
  }
  return result;
}

}  // namespace trussmap::fitting
