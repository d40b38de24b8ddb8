// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/chart_scales.hpp"

#include "trussmap/recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

Range range_of(int axis, const Chart& chart) {
  const ChartAxis& of = axis == 0 ? chart.x : chart.y;
  if (of.range) return *of.range;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto take = [&](double value) {
    if (!std::isfinite(value) || (of.log && !(value > 0.0))) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const ChartLayer& layer : chart.layers) {
    for (const std::size_t k : columns_on(axis, layer, chart)) {
      for (const double value : layer.columns[k].numbers) take(value);
      if (layer.kind == LayerKind::bars && k == 1) take(0.0);
    }
    if (layer.kind != LayerKind::ellipses) continue;
    for (std::size_t row = 0; row < layer.columns[0].size(); ++row) {
      const double at = layer.columns[static_cast<std::size_t>(axis)].numbers[row];
      const double reach = std::max(layer.columns[2].numbers[row], layer.columns[3].numbers[row]);
      take(at - reach);
      take(at + reach);
    }
  }
  if (of.zero) take(0.0);
  if (!(low <= high)) return of.log ? Range{0.1, 1.0} : Range{0.0, 1.0};
  if (of.log) return low < high ? Range{0.9 * low, 1.1 * high} : Range{0.5 * low, 2.0 * high};
  if (low == high) {
    const double half = low == 0.0 ? 0.5 : 0.5 * std::abs(low);
    return {low - half, high + half};
  }
  const double margin = 0.03 * (high - low);
  return {of.zero && low == 0.0 ? 0.0 : low - margin, of.zero && high == 0.0 ? 0.0 : high + margin};
}

void stretch(ChartScale& scale, double unit) {
  const double middle = 0.5 * (scale.range.low + scale.range.high);
  const double half = 0.5 * unit * std::abs(scale.last - scale.first);
  scale.range = {middle - half, middle + half};
}

}  // namespace

double ChartScale::pixel(double value) const {
  if (!std::isfinite(value) || (log && !(value > 0.0))) return kAbsent;
  const double share = log ? std::log(value / range.low) / std::log(range.high / range.low)
                           : (value - range.low) / (range.high - range.low);
  return first + share * (last - first);
}

double ChartScale::pixel(const ChartColumn& column, std::size_t row) const {
  if (categories.empty()) return column.numbers.empty() ? kAbsent : pixel(column.numbers[row]);
  if (column.texts.empty()) return kAbsent;
  const auto found = std::find(categories.begin(), categories.end(), column.texts[row]);
  if (found == categories.end()) return kAbsent;
  const double place = static_cast<double>(found - categories.begin()) + 0.5;
  return first + (last - first) * place / static_cast<double>(categories.size());
}

std::vector<std::pair<double, std::string>> ChartScale::ticks() const {
  std::vector<std::pair<double, std::string>> result;
  const auto count = static_cast<double>(categories.size());
  for (std::size_t k = 0; k < categories.size(); ++k) {
    result.emplace_back(first + (last - first) * (static_cast<double>(k) + 0.5) / count,
                        categories[k]);
  }
  if (!categories.empty()) return result;
  std::vector<double> values;
  if (log) {
    const int low = static_cast<int>(std::floor(std::log10(range.low)));
    for (int power = low; std::pow(10.0, power) <= range.high; ++power) {
      for (const double digit : {1.0, 2.0, 5.0}) values.push_back(digit * std::pow(10.0, power));
    }
  } else {
    const double pixels = std::abs(last - first);
    values = round_ticks(range, std::max(2, static_cast<int>(pixels / 45.0)));
  }
  const double step = (range.high - range.low) * 1e-9;
  for (const double value : values) {
    if (value < range.low - step || value > range.high + step) continue;
    result.emplace_back(pixel(value), fmt::format("{:.6g}", std::abs(value) < step ? 0.0 : value));
  }
  return result;
}

std::vector<std::size_t> columns_on(int axis, const ChartLayer& layer, const Chart& chart) {
  const bool sideways = !chart.y.categories.empty();
  const bool along = (axis == 0) == sideways;  // the axis that values of bars lie on
  switch (layer.kind) {
    case LayerKind::band:
      return axis == 0 ? std::vector<std::size_t>{0} : std::vector<std::size_t>{1, 2};
    case LayerKind::segments:
      return axis == 0 ? std::vector<std::size_t>{0, 2} : std::vector<std::size_t>{1, 3};
    case LayerKind::intervals:
      return along ? std::vector<std::size_t>{1, 2, 3} : std::vector<std::size_t>{0};
    case LayerKind::bars:
      return along ? std::vector<std::size_t>{1} : std::vector<std::size_t>{0};
    case LayerKind::level:
      return axis == 0 ? std::vector<std::size_t>{} : std::vector<std::size_t>{0};
    case LayerKind::upright:
      return axis == 0 ? std::vector<std::size_t>{0} : std::vector<std::size_t>{};
    default:
      return {static_cast<std::size_t>(axis)};
  }
}

std::pair<ChartScale, ChartScale> chart_scales(const Chart& chart, double left, double top,
                                               double right, double bottom) {
  ChartScale x{chart.x.categories, chart.x.log, range_of(0, chart), left, right};
  ChartScale y{chart.y.categories, chart.y.log, range_of(1, chart), bottom, top};
  if (!y.categories.empty()) std::swap(y.first, y.last);  // the first name stands on top
  if (chart.equal_aspect) {
    const double unit = std::max((x.range.high - x.range.low) / (right - left),
                                 (y.range.high - y.range.low) / (bottom - top));
    stretch(x, unit);
    stretch(y, unit);
  }
  return {x, y};
}

}  // namespace trussmap::plot
