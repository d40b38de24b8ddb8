// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// All that is known of an effect of the catalogue. Each is a file of catalogue/, of which
// catalogue_maker.cpp makes these records when the library is built; docs/adding-to-it.md says what
// stands in it.
#pragma once

#include "trussmap/catalogue.hpp"

#include <string_view>
#include <vector>

namespace trussmap::effects {

/// What an effect does to a robot, in its owner's words. "{}" stands for the covariate's name in
/// words.
struct ExplanationText {
  std::string_view does;   ///< to the robot
  std::string_view look;   ///< at what, on the robot or round it
  std::string_view drive;  ///< what, to be sure
  /// Sign of the coefficients that the text is about, and what the other sign does; 0: either.
  int sign = 0;
  std::string_view otherwise;
};

/// A drawing of effect_drawings.hpp, of one of its parts where effects are drawn alike.
struct DrawingChoice {
  std::string_view of;
  std::string_view part;
};

/// How simulate --hide draws it.
struct HiddenDraw {
  bool drawn = true;
  bool needs_survey = false;              ///< a map takes it up in its scale or rotation otherwise
  bool needs_compass = false;             ///< besides what acts on the compass
  int sign = 0;                           ///< of its coefficients; 0: either
  std::vector<std::string_view> columns;  ///< for "{}", as simulated recordings have them
};

struct FormerName {
  std::string_view former;
  std::string_view present;
};

struct CatalogueRecord {
  CatalogueEntry entry;
  std::string_view known_as;   ///< in sentences
  bool well_known = false;     ///< an owner asks for it, whether or not it is there
  bool common_motion = false;  ///< systematic, and of nearly every robot's drive
  /// A number that every robot with such a drive or sensor has: it is sought before noise is.
  bool robot_constant = false;
  std::vector<FormerName> former_names = {};
  ExplanationText explanation;
  DrawingChoice drawing;
  HiddenDraw hidden;
};

/// In the order of the catalogue.
[[nodiscard]] const std::vector<CatalogueRecord>& catalogue_records();

/// As find_entry.
[[nodiscard]] const CatalogueRecord* find_record(std::string_view name);

}  // namespace trussmap::effects
