// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

#include <string>

#include <fmt/format.h>

namespace trussmap {
namespace {

const char* what_differs(Channel channel) {
  return channel == Channel::compass ? "the compass's heading"
         : channel == Channel::turn  ? "turning"
         : channel == Channel::creep ? "creep to the left"
                                     : "travel";
}

}  // namespace

std::string field_in_words(Channel channel) {
  return fmt::format("{} differs from place to place", what_differs(channel));
}

std::string in_words(const FieldOfPlaces& field) {
  const std::string unit(facts_of(field.channel).unit);
  std::string text = fmt::format("{}: sd {}, over about {:.1f} m", field_in_words(field.channel),
                                 wording::shown(field.size, unit), field.length);
  for (std::size_t k = 0; k < field.rivals.size(); ++k) {
    text += (k == 0 ? "; or it is " : " or ") + std::string(what_differs(field.rivals[k]));
  }
  for (std::size_t k = 0; k < field.patches.size(); ++k) {
    text += (k == 0 ? "; explained as well by " : " and ") + field.patches[k];
  }
  return text;
}

}  // namespace trussmap
