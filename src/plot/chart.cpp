// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::plot {
namespace {

using nlohmann::ordered_json;

struct KindFacts {
  const char* name;
  std::size_t places;
  bool one_mark;
};

/// In the order of LayerKind.
constexpr std::array<KindFacts, 11> kKinds = {{{"dots", 2, false},
                                               {"line", 2, true},
                                               {"net", 2, true},
                                               {"band", 3, true},
                                               {"segments", 4, false},
                                               {"ellipses", 5, false},
                                               {"intervals", 4, false},
                                               {"bars", 2, false},
                                               {"labels", 2, false},
                                               {"level", 1, false},
                                               {"upright", 1, false}}};

const KindFacts& facts(LayerKind kind) {
  return kKinds[static_cast<std::size_t>(kind)];
}

/// Six digits, and null for what is no number.
ordered_json short_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == std::round(value) && std::abs(value) < 1e6) return static_cast<std::int64_t>(value);
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

ordered_json values(const std::vector<double>& numbers) {
  ordered_json result = ordered_json::array();
  for (const double value : numbers) result.push_back(short_number(value));
  return result;
}

std::size_t rows_of(const ChartLayer& layer) {
  return layer.columns.empty() ? 0 : layer.columns.front().size();
}

void check(const Chart& chart) {
  for (const ChartLayer& layer : chart.layers) {
    const std::string where = fmt::format("chart {}, layer \"{}\": ", chart.id, layer.name);
    const std::size_t needed = facts(layer.kind).places + (layer.kind == LayerKind::labels ? 1 : 0);
    if (layer.columns.size() < needed) throw std::invalid_argument(where + "too few columns");
    for (const ChartColumn& column : layer.columns) {
      if (column.size() != rows_of(layer)) {
        throw std::invalid_argument(where + "columns of different length");
      }
    }
    if (!layer.shade.empty() && layer.shade.size() != rows_of(layer)) {
      throw std::invalid_argument(where + "not as many shades as marks");
    }
  }
  if (mark_count(chart) > kMostMarks) {
    throw std::invalid_argument(
        fmt::format("chart {} has more than {} marks", chart.id, kMostMarks));
  }
}

ordered_json json(const ChartAxis& axis) {
  ordered_json result = {{"title", axis.title}};
  if (axis.log) result["log"] = true;
  if (axis.zero) result["zero"] = true;
  if (axis.range) result["range"] = {axis.range->low, axis.range->high};
  if (!axis.categories.empty()) result["categories"] = axis.categories;
  return result;
}

ordered_json json(const ChartLayer& layer) {
  ordered_json columns = ordered_json::array();
  for (const ChartColumn& column : layer.columns) {
    columns.push_back(
        {{"name", column.name},
         {"values", column.numbers.empty() ? ordered_json(column.texts) : values(column.numbers)}});
  }
  ordered_json result = {{"kind", facts(layer.kind).name},
                         {"name", layer.name},
                         {"places", facts(layer.kind).places},
                         {"colour", layer.colour},
                         {"columns", columns}};
  if (layer.size > 0.0) result["size"] = layer.size;
  if (layer.dashed) result["dashed"] = true;
  if (layer.offset != 0.0) result["offset"] = layer.offset;
  if (!layer.shade.empty()) result["shade"] = values(layer.shade);
  if (!layer.key.empty()) result["key"] = layer.key;
  return result;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::size_t mark_count(const Chart& chart) {
  std::size_t count = 0;
  for (const ChartLayer& layer : chart.layers) {
    count += facts(layer.kind).one_mark ? 1 : rows_of(layer);
  }
  return count;
}

std::size_t place_columns(LayerKind kind) {
  return facts(kind).places;
}

std::string chart_json(const Chart& chart) {
  check(chart);
  ordered_json layers = ordered_json::array();
  for (const ChartLayer& layer : chart.layers) layers.push_back(json(layer));
  const ordered_json result = {{"id", chart.id},           {"title", chart.title},
                               {"caption", chart.caption}, {"x", json(chart.x)},
                               {"y", json(chart.y)},       {"equal", chart.equal_aspect},
                               {"height", chart.height},   {"layers", std::move(layers)}};
  // A name may hold anything, bytes that are no UTF-8 included.
  const std::string text = result.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string chart_csv(const Chart& chart) {
  check(chart);
  std::string text;
  for (const ChartLayer& layer : chart.layers) {
    text += "layer";
    for (const ChartColumn& column : layer.columns) text += "," + csv_cell(column.name);
    text += "\r\n";
    for (std::size_t row = 0; row < rows_of(layer); ++row) {
      text += csv_cell(layer.name);
      for (const ChartColumn& column : layer.columns) {
        text += ",";
        if (!column.numbers.empty()) {
          const double value = column.numbers[row];
          text += std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
        } else {
          text += csv_cell(column.texts[row]);
        }
      }
      text += "\r\n";
    }
  }
  return text;
}

}  // namespace trussmap::plot
