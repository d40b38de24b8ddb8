// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the effects of the catalogue do to a robot, in its owner's words.
#pragma once

#include <string_view>

namespace trussmap {

struct CatalogueEntry;
struct Effect;

/// "{}" stands for the covariate's name in words.
struct ExplanationText {
  std::string_view name;   ///< of the catalogue
  std::string_view does;   ///< to the robot
  std::string_view look;   ///< at what, on the robot or round it
  std::string_view drive;  ///< what, to be sure
  /// Sign of the coefficients that the text is about, and what the other sign does; 0: either.
  int sign = 0;
  std::string_view otherwise = {};
};

/// nullptr where there is none: the radii of single wheels, which are all alike.
[[nodiscard]] const ExplanationText* explanation_text(std::string_view name);

/// Whose cause and remedy are this effect's; nullptr beyond the catalogue, and for an effect that
/// has not its usual sign (Explanation::unusual).
[[nodiscard]] const CatalogueEntry* usual_entry(const Effect& effect);

}  // namespace trussmap
