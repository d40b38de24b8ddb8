// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/geojson.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/map_files.hpp"

#include <cmath>
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

namespace trussmap {

std::string format_geojson(const FieldOfPlaces& field) {
  nlohmann::json features = nlohmann::json::array();
  for (const FieldCell& one : field.cells_driven()) {
    features.push_back(io::geojson_square(one.centre, field.cell,
                                          {{"channel", name_of(field.channel)},
                                           {"unit", facts_of(field.channel).unit},
                                           {"mean", one.mean},
                                           {"sd", one.sd}}));
  }
  return io::geojson_text(features);
}

}  // namespace trussmap
