// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_record.hpp"
#include "effects/place.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"
#include "wording/everyday_factors.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace trussmap {
using namespace wording;

namespace {

/// "2.04 +- 0.11 %", the error with two digits.
std::string with_error(double value, double sd, const char* unit) {
  if (!(sd > 0.0) || !std::isfinite(sd)) return fmt::format("{:.3g}{}", value, unit);
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(sd))));
  return fmt::format("{:.{}f} +- {:.{}f}{}", value, decimals, sd, decimals, unit);
}

std::string sentence(Channel channel, double value, double sd) {
  const Scale scale = scale_of(channel);
  const effects::ChannelPhrase& phrase = effects::record_of(channel).phrase;
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

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// "too much or too little", "to the left or right", "larger or smaller than nominal": what both
/// begin and end with is said once.
std::string either_way(std::string_view one, std::string_view other) {
  const std::vector<std::string> a = words_of(std::string(one));
  const std::vector<std::string> b = words_of(std::string(other));
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
  if (shape == "arc_angle") return "each radian turned while driving";
  if (shape == "spin_angle") return "each radian turned on the spot";
  return "each event";
}

constexpr std::string_view kPerUnit = " per unit of ";

/// Of "u*v", where both have a unit of their own: " per m/s per kg of payload".
std::string per_shape(const Shape& shape);
std::optional<std::string> per_product(const std::string& text) {
  constexpr std::string_view kNoPlainFactor = "+-/^<>,";
  const std::size_t times = text.find('*');
  if (times == std::string::npos || times != text.rfind('*') ||
      text.find_first_of(kNoPlainFactor) != std::string::npos) {
    return std::nullopt;
  }
  const auto brackets = [&](char one) {
    return std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(times), one);
  };
  if (brackets('(') != brackets(')')) return std::nullopt;  // inside of one
  const std::string first = per_shape(text.substr(0, times));
  const std::string second = per_shape(text.substr(times + 1));
  if (first.starts_with(kPerUnit) || second.starts_with(kPerUnit)) return std::nullopt;
  return first + second;
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
  constexpr std::string_view kKilograms = "_kg";
  const std::string& text = shape.text();
  if (shape.variables() == std::vector{text} && text.ends_with(kKilograms)) {
    return " per kg of " + text.substr(0, text.size() - kKilograms.size());
  }
  if (text.find_first_of("<>") != std::string::npos) return " where " + text;
  // What goes from 0 to 1, or back, has no unit.
  if (text.starts_with("exp(-t/") || text.starts_with("1-exp(-t/")) return " times " + text;
  if (std::optional<std::string> product = per_product(text)) return *std::move(product);
  return std::string(kPerUnit) + text;
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

/// A curve of bells over one variable: what it comes to at each bell's middle. Single coefficients
/// say little, for bells overlap.
std::optional<std::string> curve_in_words(const Effect& effect) {
  constexpr std::size_t kFewest = 3;
  if (effect.shape.size() < kFewest || effect.per_session) return std::nullopt;
  const std::vector<std::string>& variables = effect.shape.front().variables();
  if (variables.size() != 1) return std::nullopt;
  const std::string& u = variables.front();
  std::vector<double> middles;
  for (const Shape& one : effect.shape) {
    const std::optional<double> middle = one.parameter(u);
    if (!one.text().starts_with("exp(") || one.variables() != variables || !middle) {
      return std::nullopt;
    }
    middles.push_back(*middle);
  }
  std::vector<double> values(middles.size(), 0.0);
  for (std::size_t k = 0; k < effect.shape.size(); ++k) {
    const std::vector<double> bell = effect.shape[k].values({{u, middles}});
    for (std::size_t j = 0; j < bell.size(); ++j) values[j] += effect.coefficients[k] * bell[j];
  }
  const Scale scale = scale_of(effect.channel);
  const effects::ChannelPhrase& phrase = effects::record_of(effect.channel).phrase;
  constexpr double kNothing = 1e-3;  // of the most
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  std::string text(phrase.subject);
  for (std::size_t j = 0; j < values.size(); ++j) {
    const std::string size =
        std::abs(values[j]) < kNothing * most
            ? std::string("nothing")
            : fmt::format("{}{} {}", two_digits(scale.factor * std::abs(values[j])), scale.unit,
                          values[j] < 0.0 ? phrase.less : phrase.more);
    text += fmt::format("{} {} at {} {:.3g}", j == 0 ? "" : ",", size, variable_in_words(u),
                        middles[j]);
  }
  return text;
}

bool is_plain_factor(const Effect& effect) {
  return effect.is_constant() && !effect.per_session;
}

/// What a constant comes to in the owner's figures, with how much a little of its coefficient adds.
struct Share {
  double larger = 0.0;  ///< by this share
  double slope = 1.0;
};

/// Of a factor 1 + g below zero, which no size of a wheel is; empty where it is one.
std::string_view wrong_sign_in_words(Channel channel, double g) {
  return g < -1.0 ? effects::record_of(channel).below_zero : std::string_view();
}

Share wheelbase_share(double turn) {
  const double ratio = 1.0 / (1.0 + turn);
  return {ratio - 1.0, ratio * ratio};
}

Share right_wheel_share(double difference) {
  const double left = 1.0 - 0.5 * difference;
  return {difference / left, 1.0 / (left * left)};
}

}  // namespace

std::string two_digits(double value) {
  return std::abs(value) < 99.5 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

std::string size_in_words(const Effect& effect, double least, double most) {
  const Channel channel = effect.channel;
  const double extreme = std::abs(least) > std::abs(most) ? least : most;
  const double other = extreme == least ? most : least;
  const bool both = extreme * other < 0.0 && std::abs(other) > 0.3 * std::abs(extreme);
  if (is_plain_factor(effect)) {
    const std::string_view words = wrong_sign_in_words(channel, extreme);
    if (!words.empty()) return std::string(words);
  }
  if (is_plain_factor(effect) && channel == Channel::turn) {
    const double larger = wheelbase_share(extreme).larger;
    return fmt::format("the wheelbase is {} % {} than nominal",
                       two_digits(100.0 * std::abs(larger)), larger < 0.0 ? "smaller" : "larger");
  }
  const Scale scale = scale_of(channel);
  const effects::ChannelPhrase& phrase = effects::record_of(channel).phrase;
  std::string subject(phrase.subject);
  if (is_plain_factor(effect) && channel == Channel::difference) {
    const double larger = right_wheel_share(extreme).larger;
    return fmt::format("{} {}{} {}", subject, two_digits(scale.factor * std::abs(larger)),
                       scale.unit, larger < 0.0 ? phrase.less : phrase.more);
  }
  const bool event = channel == Channel::advance || channel == Channel::rotate;
  if (effect.shape.size() == 1) {
    subject = with_event_named(std::move(subject), effect.shape.front());
  }
  return fmt::format("{} {}{}{} {}", subject, is_plain_factor(effect) || event ? "" : "up to ",
                     two_digits(scale.factor * std::abs(extreme)), scale.unit,
                     both            ? either_way(phrase.more, phrase.less)
                     : extreme < 0.0 ? std::string(phrase.less)
                                     : std::string(phrase.more));
}

std::vector<std::string> unfitted_in_words(const Model& model) {
  std::vector<std::string> warnings;
  for (const Effect& effect : model.effects) {
    if (!effect.coefficients.empty()) continue;
    warnings.push_back(
        fmt::format("effect {} has no coefficients yet: left out (see fit)", effect.name));
  }
  return warnings;
}

std::string in_words(const Effect& effect, const std::vector<double>& sd) {
  const Channel channel = effect.channel;
  if (effect.coefficients.empty()) return effect.name + ": not fitted";
  if (is_plain_factor(effect)) {
    const double value = effect.coefficients[0];
    const std::string hint = everyday_factor_in_words(channel, value, sd[0]);
    const std::string_view wrong = wrong_sign_in_words(channel, value);
    if (!wrong.empty()) return fmt::format("{} (g = {})", wrong, with_error(value, sd[0], ""));
    if (channel == Channel::turn) {
      const Share share = wheelbase_share(value);
      return fmt::format(
          "the wheelbase is {} {} than nominal{}",
          with_error(100.0 * std::abs(share.larger), 100.0 * share.slope * sd[0], " %"),
          share.larger < 0.0 ? "smaller" : "larger", hint);
    }
    if (channel == Channel::difference) {
      const Share share = right_wheel_share(value);
      return sentence(channel, share.larger, share.slope * sd[0]);
    }
    if (channel == Channel::left || channel == Channel::right) {
      return fmt::format("the {} wheel is {} {} than nominal{}", name_of(channel),
                         with_error(100.0 * std::abs(value), 100.0 * sd[0], " %"),
                         value < 0.0 ? "smaller" : "larger", hint);
    }
    return sentence(channel, value, sd[0]) + hint;
  }
  if (const auto round = round_of(effect); round && !effect.per_session) {
    const double size = std::hypot(effect.coefficients[0], effect.coefficients[1]);
    const double error =
        size > 0.0
            ? std::hypot(effect.coefficients[0] * sd[0], effect.coefficients[1] * sd[1]) / size
            : 0.0;
    const Scale scale = scale_of(channel);
    const effects::ChannelPhrase& phrase = effects::record_of(channel).phrase;
    return fmt::format(
        "{} up to {} {}, and as much the other way, as {} goes round", phrase.subject,
        with_error(scale.factor * size, scale.factor * error, scale.unit), phrase.more, *round);
  }
  if (const std::optional<std::string> curve = curve_in_words(effect)) return *curve;
  std::string text;
  const std::optional<Vector2> place = effects::place_of(effect);
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

std::string held_in_words(const Effect& effect) {
  const CatalogueEntry* entry = find_entry(effect.name);
  if (entry == nullptr || !entry->has_parameters()) return "";
  std::string names;
  for (const OpenParameter& one : entry->parameters) {
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  }
  return fmt::format(
      "{} {} held as the model has {}, and the standard errors are for that: trussmap discover "
      "seeks {} anew",
      names, entry->parameters.size() == 1 ? "is" : "are",
      entry->parameters.size() == 1 ? "it" : "them", entry->parameters.size() == 1 ? "it" : "them");
}

}  // namespace trussmap
