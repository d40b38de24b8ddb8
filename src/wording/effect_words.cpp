// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "wording/effect_words.hpp"

#include "trussmap/catalogue.hpp"
#include "trussmap/channel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

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

/// "heading" of sin(heading), cos(heading): what a wave of two shapes goes round with.
std::optional<std::string> round_of(const Effect& effect) {
  if (effect.shape.size() != 2) return std::nullopt;
  std::optional<std::string> sine = effect.shape[0].argument_of("sin");
  return sine && sine == effect.shape[1].argument_of("cos") ? sine : std::nullopt;
}

/// What a channel's error is called in a name.
const char* noun_of(Channel channel) {
  switch (channel) {
    case Channel::travel:
      return "travel error";
    case Channel::left:
      return "left wheel's error";
    case Channel::right:
      return "right wheel's error";
    case Channel::wheels:
      return "error of both wheels";
    case Channel::difference:
      return "difference of the wheels";
    case Channel::turn:
      return "turning error";
    case Channel::drift:
      return "heading drift";
    case Channel::advance:
      return "travel error per event";
    case Channel::rotate:
      return "turning error per event";
    case Channel::creep:
      return "sideways slip";
    case Channel::lever:
      return "sensor's place ahead";
    case Channel::lever_left:
      return "sensor's place to the left";
    case Channel::compass:
      return "compass error";
    case Channel::range:
      return "range error";
    case Channel::range_scale:
      return "error of the range's scale";
    case Channel::bearing:
      return "bearing error";
    case Channel::delay:
      return "delay of sightings";
  }
  return "";
}

/// "turn rate" for the word turn_rate, and so on.
std::string variables_in_words(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, space - at);
    result += word == "turn_rate"  ? "turn rate"
              : word == "t"        ? "time"
              : word == "distance" ? "distance driven"
                                   : word;
    if (space < text.size()) result += ' ';
    at = space + 1;
  }
  return result;
}

std::string place_text(const Vector2& place) {
  return fmt::format("x {:.1f} m, y {:.1f} m", place.x(), place.y());
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// "too much or too little", "to the left or right", "larger or smaller than nominal": what both
/// begin and end with is said once.
std::string either_way(const std::string& one, const std::string& other) {
  const std::vector<std::string> a = words_of(one);
  const std::vector<std::string> b = words_of(other);
  const std::size_t most = std::min(a.size(), b.size());
  std::size_t begin = 0;
  while (begin < most && a[begin] == b[begin]) ++begin;
  if (begin < 2) begin = 0;
  std::size_t end = 0;
  while (end + begin < most && a[a.size() - 1 - end] == b[b.size() - 1 - end]) ++end;
  const auto joined = [](const std::vector<std::string>& words, std::size_t from, std::size_t to) {
    return fmt::format("{}", fmt::join(words.begin() + static_cast<std::ptrdiff_t>(from),
                                       words.begin() + static_cast<std::ptrdiff_t>(to), " "));
  };
  return joined(a, 0, a.size() - end) + " or " + joined(b, begin, b.size());
}

/// What an event is, by the shape that counts it.
std::string event_of(const Shape& shape) {
  if (shape == "starts") return "each start";
  if (shape == "spins") return "each turn on the spot";
  if (shape == "reverses_left") return "each change of direction of the left wheel";
  if (shape == "reverses_right") return "each change of direction of the right wheel";
  return "each event";
}

/// " per m/s": what a coefficient's size is the size of, by its shape.
std::string per_shape(const Shape& shape) {
  if (shape == "1") return "";
  if (shape == "speed") return " per m/s";
  if (shape == "turn_rate") return " per rad/s turned to the left";
  if (shape == "abs(turn_rate)") return " per rad/s turned";
  if (shape == "sign(turn_rate)") {
    return " when turning to the left, and as much the other way to the right";
  }
  if (shape == "acceleration") return " per m/s^2";
  if (shape == "distance") return " per m driven";
  if (shape == "t") return " per s";
  return " per unit of " + shape.text();
}

/// "each event turns ..." with the event named, where the shape is one.
std::string with_event_named(std::string sentence, const Shape& shape) {
  constexpr std::string_view kEvent = "each event";
  if (sentence.starts_with(kEvent)) sentence.replace(0, kEvent.size(), event_of(shape));
  return sentence;
}

bool counts_events(const Shape& shape) {
  return event_of(shape) != "each event";
}

bool is_plain_factor(const Effect& effect) {
  return effect.is_constant() && !effect.per_session;
}

/// The speed above which an effect acts, m/s.
std::optional<double> threshold_of(const Effect& effect) {
  return effect.shape.size() == 1 ? effect.shape.front().parameter("speed") : std::nullopt;
}

}  // namespace

std::string two_digits(double value) {
  return std::abs(value) < 99.5 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

std::optional<Vector2> place_of(const Effect& effect) {
  if (effect.shape.size() != 1 || effect.per_session) return std::nullopt;
  const Shape& shape = effect.shape.front();
  if (shape.variables() != std::vector<std::string>{"x", "y"}) return std::nullopt;
  const std::optional<double> x = shape.parameter("x");
  const std::optional<double> y = shape.parameter("y");
  return x && y ? std::optional(Vector2(*x, *y)) : std::nullopt;
}

std::string short_name(const Effect& effect) {
  const CatalogueEntry* entry = find_entry(effect.name);
  return entry == nullptr ? name_in_words(effect) : std::string(entry->name);
}

std::string name_in_words(const Effect& effect) {
  const std::string& name = effect.name;
  if (const CatalogueEntry* entry = find_entry(name)) {
    const std::size_t open = name.rfind(" (");
    const std::string rest =
        open == std::string::npos ? "" : name.substr(open + 2, name.size() - open - 3);
    if (entry->of_covariate() && !rest.empty()) {
      return fmt::format("{} with {}", entry->name, variables_in_words(rest));
    }
    if (const std::optional<double> v0 = threshold_of(effect); v0 && entry->has_parameters()) {
      return fmt::format("{} above {} m/s", entry->name, two_digits(*v0));
    }
    const std::optional<Vector2> place = place_of(effect);
    const std::optional<double> r = place ? effect.shape.front().parameter("r") : std::nullopt;
    if (r && entry->has_parameters()) {
      return fmt::format("{} at {}, radius {} m", entry->name, place_text(*place), two_digits(*r));
    }
    return name;
  }
  const std::string_view channel = name_of(effect.channel);
  if (!name.starts_with(std::string(channel) + " ")) return name;
  const std::string rest = name.substr(channel.size());
  const std::optional<Vector2> place = place_of(effect);
  if ((rest == " at a place" || rest == " within a circle") && place) {
    return fmt::format("{} at {}", noun_of(effect.channel), place_text(*place));
  }
  if (!rest.starts_with(" with ") && !rest.starts_with(" of its own")) return name;
  return noun_of(effect.channel) + variables_in_words(rest);
}

std::string size_in_words(const Effect& effect, double least, double most) {
  const Channel channel = effect.channel;
  const double extreme = std::abs(least) > std::abs(most) ? least : most;
  const double other = extreme == least ? most : least;
  const bool both = extreme * other < 0.0 && std::abs(other) > 0.3 * std::abs(extreme);
  if (is_plain_factor(effect) && channel == Channel::turn) {
    const double larger = 1.0 / (1.0 + extreme) - 1.0;
    return fmt::format("the wheelbase is {} % {} than nominal",
                       two_digits(100.0 * std::abs(larger)), larger < 0.0 ? "smaller" : "larger");
  }
  const Scale scale = scale_of(channel);
  const Phrase phrase = phrase_of(channel);
  std::string subject = phrase.subject;
  const bool event = channel == Channel::advance || channel == Channel::rotate;
  if (effect.shape.size() == 1) {
    subject = with_event_named(std::move(subject), effect.shape.front());
  }
  return fmt::format("{} {}{}{} {}", subject, is_plain_factor(effect) || event ? "" : "up to ",
                     two_digits(scale.factor * std::abs(extreme)), scale.unit,
                     both            ? either_way(phrase.more, phrase.less)
                     : extreme < 0.0 ? phrase.less
                                     : phrase.more);
}

std::string in_words(const Effect& effect, const std::vector<double>& sd) {
  const Channel channel = effect.channel;
  if (effect.coefficients.empty()) return effect.name + ": not fitted";
  if (is_plain_factor(effect)) {
    const double value = effect.coefficients[0];
    if (channel == Channel::turn) {
      const double larger = 1.0 / (1.0 + value) - 1.0;
      return fmt::format("the wheelbase is {} {} than nominal",
                         with_error(100.0 * std::abs(larger), 100.0 * sd[0], " %"),
                         larger < 0.0 ? "smaller" : "larger");
    }
    return sentence(channel, value, sd[0]);
  }
  if (const auto round = round_of(effect); round && !effect.per_session) {
    const double size = std::hypot(effect.coefficients[0], effect.coefficients[1]);
    const double error =
        size > 0.0
            ? std::hypot(effect.coefficients[0] * sd[0], effect.coefficients[1] * sd[1]) / size
            : 0.0;
    const Scale scale = scale_of(channel);
    const Phrase phrase = phrase_of(channel);
    return fmt::format(
        "{} up to {} {}, and as much the other way, as {} goes round", phrase.subject,
        with_error(scale.factor * size, scale.factor * error, scale.unit), phrase.more, *round);
  }
  std::string text;
  const std::optional<Vector2> place = place_of(effect);
  for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
    const Shape& shape = effect.shape[k % effect.shape.size()];
    text += text.empty() ? "" : "; ";
    if (channel == Channel::compass && shape == "turn_rate") {
      text += fmt::format("the compass is {} {}",
                          with_error(1e3 * std::abs(effect.coefficients[k]), 1e3 * sd[k], " ms"),
                          effect.coefficients[k] > 0.0 ? "early" : "late");
      continue;
    }
    std::string one = sentence(channel, effect.coefficients[k], sd[k]);
    if (counts_events(shape) && one.starts_with("each event")) {
      one = with_event_named(std::move(one), shape);
    } else if (place) {
      one += " around " + place_text(*place);
    } else {
      one += per_shape(shape);
    }
    text += one;
    if (effect.per_session) text += fmt::format(" in session {}", k / effect.shape.size());
  }
  return text;
}

}  // namespace trussmap
