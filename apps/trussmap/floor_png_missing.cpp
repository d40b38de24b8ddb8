// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Without libpng.
#include "floor_maps.hpp"

namespace trussmap::app {

bool draws_png() {
  return false;
}

std::string floor_png(const FieldOfPlaces&) {
  return "";
}

}  // namespace trussmap::app
