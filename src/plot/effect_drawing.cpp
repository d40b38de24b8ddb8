// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/effect_drawings.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/workbench.hpp"

namespace trussmap {
namespace {

const EffectDrawing* drawing_named(std::string_view name) {
  for (const auto& all : {drawings_of_wheels(), drawings_of_motion(), drawings_of_headings(),
                          drawings_of_sensors()}) {
    for (const EffectDrawing& one : all) {
      if (one.name == name) return &one;
    }
  }
  return nullptr;
}

/// The catalogue's plainest effect of a channel: one that acts everywhere alike, where it has one.
const CatalogueEntry* plainest(Channel channel) {
  const CatalogueEntry* found = nullptr;
  for (const CatalogueEntry& one : catalogue()) {
    if (one.channel != channel) continue;
    if (found == nullptr || (found->pattern.front() != "1" && one.pattern.front() == "1")) {
      found = &one;
    }
  }
  return found;
}

}  // namespace

std::string effect_drawing(const Effect& effect) {
  const CatalogueEntry* entry = find_entry(effect.name);
  if (entry == nullptr) entry = plainest(effect.channel);
  const EffectDrawing* drawing = entry == nullptr ? nullptr : drawing_named(entry->name);
  if (drawing == nullptr) return "";
  Sketch sketch;
  drawing->draw(sketch);
  return sketch.svg(entry->name);
}

}  // namespace trussmap
