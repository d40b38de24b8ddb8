// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/criticism/effect_words.hpp"

#include "trussmap/effects/channel.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// "2.04 +- 0.11 %", the error with two digits.
std::string with_error(double value, double sd, const char* unit) {
  if (!(sd > 0.0) || !std::isfinite(sd)) return fmt::format("{:.3g}{}", value, unit);
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(sd))));
  return fmt::format("{:.{}f} +- {:.{}f}{}", value, decimals, sd, decimals, unit);
}

struct Scale {
  double factor;
  const char* unit;
};

/// In what a person reads the channel's g.
Scale scale_of(Channel channel) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  switch (channel) {
    case Channel::drift:
      return {kDegrees * 60.0, " deg/min"};
    case Channel::advance:
    case Channel::lever:
    case Channel::lever_left:
    case Channel::range:
      return {1e3, " mm"};
    case Channel::rotate:
    case Channel::compass:
    case Channel::bearing:
      return {kDegrees, " deg"};
    case Channel::delay:
      return {1e3, " ms"};
    default:
      return {100.0, " %"};
  }
}

struct Phrase {
  const char* subject;  ///< followed by the size
  const char* more;
  const char* less;
};

Phrase phrase_of(Channel channel) {
  switch (channel) {
    case Channel::travel:
      return {"the robot travels", "further than its wheels say", "less far than its wheels say"};
    case Channel::left:
      return {"the left wheel rolls", "further than it says", "less far than it says"};
    case Channel::right:
      return {"the right wheel rolls", "further than it says", "less far than it says"};
    case Channel::wheels:
      return {"both wheels are", "larger than nominal", "smaller than nominal"};
    case Channel::difference:
      return {"the right wheel is", "larger than the left", "smaller than the left"};
    case Channel::turn:
      return {"the robot turns", "more than its wheels say", "less than its wheels say"};
    case Channel::drift:
      return {"the heading drifts by", "to the left", "to the right"};
    case Channel::advance:
      return {"each event moves the robot", "forward", "back"};
    case Channel::rotate:
      return {"each event turns the robot by", "to the left", "to the right"};
    case Channel::creep:
      return {"the robot slips by", "of its travel to the left", "of its travel to the right"};
    case Channel::lever:
      return {"the sensor sits", "ahead of the axle", "behind the axle"};
    case Channel::lever_left:
      return {"the sensor sits", "to the left of the axle's centre",
              "to the right of the axle's centre"};
    case Channel::compass:
      return {"the compass reads", "too much", "too little"};
    case Channel::range:
      return {"ranges read", "too much", "too little"};
    case Channel::range_scale:
      return {"ranges read", "too much", "too little"};
    case Channel::bearing:
      return {"bearings read", "too much", "too little"};
    case Channel::delay:
      return {"sightings and truth are stamped", "late", "early"};
  }
  return {"", "", ""};
}

std::string sentence(Channel channel, double value, double sd) {
  const Scale scale = scale_of(channel);
  const Phrase phrase = phrase_of(channel);
  return fmt::format("{} {} {}", phrase.subject,
                     with_error(scale.factor * std::abs(value), scale.factor * sd, scale.unit),
                     value < 0.0 ? phrase.less : phrase.more);
}

bool is_wave(const Effect& effect) {
  return effect.shape.size() == 2 && effect.shape[0].starts_with("sin(") &&
         effect.shape[1].starts_with("cos(") &&
         effect.shape[0].substr(4) == effect.shape[1].substr(4);
}

}  // namespace

std::string in_words(const Effect& effect, const std::vector<double>& sd) {
  const std::optional<Channel> channel = parse_channel(effect.channel);
  if (!channel || effect.coefficients.empty()) return effect.name + ": not fitted";
  if (effect.shape.size() == 1 && effect.shape[0] == "1" && !effect.per_session) {
    const double value = effect.coefficients[0];
    if (*channel == Channel::turn) {
      const double larger = 1.0 / (1.0 + value) - 1.0;
      return fmt::format("the wheelbase is {} {} than nominal",
                         with_error(100.0 * std::abs(larger), 100.0 * sd[0], " %"),
                         larger < 0.0 ? "smaller" : "larger");
    }
    return sentence(*channel, value, sd[0]);
  }
  if (is_wave(effect) && !effect.per_session) {
    const double size = std::hypot(effect.coefficients[0], effect.coefficients[1]);
    const double error =
        size > 0.0
            ? std::hypot(effect.coefficients[0] * sd[0], effect.coefficients[1] * sd[1]) / size
            : 0.0;
    const Scale scale = scale_of(*channel);
    const Phrase phrase = phrase_of(*channel);
    return fmt::format("{} up to {} {}, and as much the other way, as {} goes round",
                       phrase.subject,
                       with_error(scale.factor * size, scale.factor * error, scale.unit),
                       phrase.more, effect.shape[0].substr(4, effect.shape[0].size() - 5));
  }
  std::string text;
  for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
    const std::string& shape = effect.shape[k % effect.shape.size()];
    text += text.empty() ? "" : "; ";
    text += sentence(*channel, effect.coefficients[k], sd[k]);
    if (shape != "1") text += " per unit of " + shape;
    if (effect.per_session) text += fmt::format(" in session {}", k / effect.shape.size());
  }
  return text;
}

}  // namespace trussmap
