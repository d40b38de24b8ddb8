// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/catalogue_record.hpp"
#include "plot/effect_drawings.hpp"
#include "trussmap/workbench.hpp"

namespace trussmap {
using namespace plot;

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
const effects::CatalogueRecord* plainest(Channel channel) {
  const effects::CatalogueRecord* found = nullptr;
  for (const effects::CatalogueRecord& one : effects::catalogue_records()) {
    if (one.entry.channel != channel) continue;
    if (found == nullptr ||
        (found->entry.pattern.front() != "1" && one.entry.pattern.front() == "1")) {
      found = &one;
    }
  }
  return found;
}

}  // namespace

std::string effect_drawing(const Effect& effect) {
  const effects::CatalogueRecord* record = effects::find_record(effect.name);
  if (record == nullptr) record = plainest(effect.channel);
  const EffectDrawing* drawing = record == nullptr ? nullptr : drawing_named(record->drawing.of);
  if (drawing == nullptr) return "";
  Sketch sketch;
  if (drawing->draw_part != nullptr) {
    drawing->draw_part(sketch, record->drawing.part);
  } else {
    drawing->draw(sketch);
  }
  return sketch.svg(record->entry.name);
}

}  // namespace trussmap
