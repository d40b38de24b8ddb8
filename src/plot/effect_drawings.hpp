// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drawings of the catalogue's effects, by the part of the robot: name -> how it is drawn.
#pragma once

#include "plot/sketch.hpp"

#include <span>
#include <string_view>

namespace trussmap {

struct EffectDrawing {
  std::string_view name;  ///< of the catalogue
  void (*draw)(Sketch& sketch);
};

[[nodiscard]] std::span<const EffectDrawing> drawings_of_wheels();
[[nodiscard]] std::span<const EffectDrawing> drawings_of_motion();
[[nodiscard]] std::span<const EffectDrawing> drawings_of_headings();
[[nodiscard]] std::span<const EffectDrawing> drawings_of_sensors();

}  // namespace trussmap
