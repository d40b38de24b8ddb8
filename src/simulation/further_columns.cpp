// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/further_columns.hpp"

#include "recording/variable_names.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::simulation {

void check_covariates(const std::vector<std::string>& names) {
  std::vector<std::string> taken = recording::reserved_variables();
  for (const char* name : {"left", "right", "payload_kg", "lights", "temperature_C"}) {
    taken.emplace_back(name);
  }
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (const std::string& name : names) {
    const bool well_formed = !name.empty() && is_letter(name.front()) &&
                             std::all_of(name.begin(), name.end(), [&](char c) {
                               return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
                             });
    if (!well_formed)
      throw std::invalid_argument(
          fmt::format("a covariate's name is \"{}\", expected a letter, then "
                      "letters, digits, _",
                      name));
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      throw std::invalid_argument(
          fmt::format("a covariate's name is \"{}\", which is taken", name));
    }
    taken.push_back(name);
  }
}

std::vector<Covariate> further_columns(const TrueMotion& motion,
                                       const std::vector<std::string>& names, std::uint64_t seed) {
  std::mt19937_64 random = random_stream(seed, Stream::covariates);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Covariate> columns;
  for (const std::string& name : names) {
    Covariate column{name, {}};
    double level = 0.0;
    for (std::size_t stop = 0; stop < motion.stops.size(); ++stop) {
      const bool changes = stop == 0 || uniform(random) < 0.5;
      const double drawn = std::round(100.0 * uniform(random)) / 100.0;
      if (changes) level = drawn;
      const std::size_t end =
          stop + 1 < motion.stops.size() ? motion.stops[stop + 1].rows : motion.rows.size();
      column.values.resize(end, level);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

std::vector<Covariate> ordered_columns(const TrueMotion& motion, const DrivingStyle& style) {
  std::vector<Covariate> columns;
  for (std::size_t k = 0; k < style.covariates.size(); ++k) {
    Covariate column{style.covariates[k], {}};
    for (std::size_t leg = 0; leg < style.orders.size(); ++leg) {
      column.values.resize(motion.stops[leg + 1].rows, style.orders[leg].further[k]);
    }
    column.values.resize(motion.rows.size(), style.orders.back().further[k]);
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace trussmap::simulation
