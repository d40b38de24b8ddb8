// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drawings of the catalogue's effects, by the part of the robot: name -> how it is drawn.
#pragma once

#include "plot/sketch.hpp"

#include <span>
#include <string_view>

namespace trussmap::plot {

struct EffectDrawing {
  std::string_view name;  ///< of an effect of the catalogue, or what its file says
  void (*draw)(Sketch& sketch) = nullptr;
  /// Where several effects are drawn alike: of which part ("left", "right", "" = both; "1" ...).
  void (*draw_part)(Sketch& sketch, std::string_view part) = nullptr;
};

[[nodiscard]] std::span<const EffectDrawing> drawings_of_wheels();
[[nodiscard]] std::span<const EffectDrawing> drawings_of_motion();
[[nodiscard]] std::span<const EffectDrawing> drawings_of_headings();
[[nodiscard]] std::span<const EffectDrawing> drawings_of_sensors();

}  // namespace trussmap::plot
