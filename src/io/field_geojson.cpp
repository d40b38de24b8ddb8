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
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(field.columns) +
                      static_cast<std::size_t>(column);
      if (std::isnan(field.mean[at])) continue;
      const Vector2 centre = Vector2(field.x, field.y) + field.cell * Vector2(column, row);
      features.push_back(geojson_square(centre, field.cell,
                                        {{"channel", name_of(field.channel)},
                                         {"unit", facts_of(field.channel).unit},
                                         {"mean", field.mean[at]},
                                         {"sd", field.sd[at]}}));
    }
  }
  return geojson_text(features);
}

}  // namespace trussmap
