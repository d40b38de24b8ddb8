// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The catalogue of physical effects: names for channel x shape, with what causes them and what
// helps. A catalogue effect is no different from a user's own with the same channel and shapes.
//
// Effects of a covariate stand for one candidate per covariate column: their shapes hold "{}" where
// the column's name goes, and the name gets it in brackets, "load on both wheels (payload_kg)".
#pragma once

#include "trussmap/effects/channel.hpp"
#include "trussmap/effects/model.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

struct CatalogueEntry {
  std::string_view name;
  Channel channel;
  std::vector<std::string> shape;  ///< "{}" for a covariate's name
  std::string_view cause;          ///< what makes it, in words
  std::string_view remedy;         ///< what an owner can do about it

  [[nodiscard]] bool of_covariate() const;
};

[[nodiscard]] const std::vector<CatalogueEntry>& catalogue();

/// The entry of this name, nullptr where there is none. A covariate in brackets is not looked at.
[[nodiscard]] const CatalogueEntry* find_entry(std::string_view name);

/// The effect with channel and shape filled in from the catalogue where the model file has the name
/// alone. Throws std::invalid_argument on a name that is in no catalogue, on coefficients that do
/// not match, on an unknown channel.
[[nodiscard]] Effect resolved(const Effect& effect);

}  // namespace trussmap
