// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/chart_svg.hpp"

#include "geometry/units.hpp"
#include "plot/chart_scales.hpp"
#include "plot/svg_marks.hpp"
#include "text/xml_text.hpp"
#include "trussmap/table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

constexpr double kWidth = 800.0;  // pixels
constexpr double kEdge = 14.0;
constexpr double kCharacter = 6.6;        // mean width of one at 12 px
constexpr std::size_t kLongestName = 40;  // characters, of a category

/// The page's colours for paper (src/report/page/page.css).
std::string paper(const std::string& role) {
  static const std::map<std::string, std::string> kColours = {
      {"ink", "#1b1f24"}, {"muted", "#57606a"}, {"faint", "#9aa3ad"}, {"good", "#12724a"},
      {"bad", "#b3381b"}, {"1", "#0072b2"},     {"2", "#d55e00"},     {"3", "#00805d"},
      {"4", "#b3477f"},   {"5", "#6b5b00"},     {"6", "#5b4bc4"},     {"7", "#3a8ec4"},
      {"8", "#6e7781"}};
  const auto found = kColours.find(role);
  return found == kColours.end() ? "#1b1f24" : found->second;
}

const char* shade_colour(double shade) {
  constexpr const char* kShades[] = {"#0b4fa0", "#3f86cc", "#8fb9df", "#a9b0b8",
                                     "#e5a58b", "#d9673f", "#b22a0e"};
  return kShades[static_cast<std::size_t>(std::lround(3.0 * (std::clamp(shade, -1.0, 1.0) + 1.0)))];
}

/// Draws layers between two scales.
struct Pen {
  const Chart& chart;
  const ChartScale& x;
  const ChartScale& y;

  [[nodiscard]] std::string colour(const ChartLayer& layer, std::size_t row) const {
    return layer.shade.empty() ? paper(layer.colour) : shade_colour(layer.shade[row]);
  }
  [[nodiscard]] double shift(const ChartScale& scale, const ChartLayer& layer) const {
    return scale.categories.empty() ? 0.0 : layer.offset;
  }
  [[nodiscard]] double at_x(const ChartLayer& layer, std::size_t column, std::size_t row) const {
    return x.pixel(layer.columns[column], row) + shift(x, layer);
  }
  [[nodiscard]] double at_y(const ChartLayer& layer, std::size_t column, std::size_t row) const {
    return y.pixel(layer.columns[column], row) + shift(y, layer);
  }

  [[nodiscard]] bool sideways() const { return !y.categories.empty(); }

  [[nodiscard]] std::string path(const ChartLayer& layer) const;
  [[nodiscard]] std::string band(const ChartLayer& layer) const;
  [[nodiscard]] std::string segment(const ChartLayer& layer, std::size_t row) const;
  [[nodiscard]] std::string ellipse(const ChartLayer& layer, std::size_t row) const;
  [[nodiscard]] std::string interval(const ChartLayer& layer, std::size_t row) const;
  [[nodiscard]] std::string bar(const ChartLayer& layer, std::size_t row) const;
  [[nodiscard]] std::string mark(const ChartLayer& layer, std::size_t row) const;
  [[nodiscard]] std::string draw(const ChartLayer& layer) const;
};

std::string rule(double x1, double y1, double x2, double y2, const std::string& colour,
                 double width, bool dashed, const char* ends = "round") {
  if (!std::isfinite(x1 + y1 + x2 + y2)) return {};
  return fmt::format(
      "<path d=\"M{} {}L{} {}\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"{}\"{}/>\n",
      px(x1), px(y1), px(x2), px(y2), colour, px(width), ends,
      dashed ? " stroke-dasharray=\"6 4\"" : "");
}

std::string dot(double x, double y, double radius, const std::string& colour) {
  if (!std::isfinite(x + y)) return {};
  return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" fill-opacity=\"0.8\"/>\n",
                     px(x), px(y), px(radius), colour);
}

std::string Pen::path(const ChartLayer& layer) const {
  std::string d;
  bool drawing = false;
  for (std::size_t row = 0; row < layer.columns[0].size(); ++row) {
    const double px_x = at_x(layer, 0, row);
    const double px_y = at_y(layer, 1, row);
    if (!std::isfinite(px_x + px_y)) {
      drawing = false;
      continue;
    }
    d += (drawing ? "L" : "M") + px(px_x) + " " + px(px_y);
    drawing = true;
  }
  const double width = layer.size > 0.0 ? layer.size : layer.kind == LayerKind::net ? 1.0 : 2.0;
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", d,
                     paper(layer.colour), px(width),
                     layer.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

std::string Pen::band(const ChartLayer& layer) const {
  std::string upper;
  std::string lower;
  for (std::size_t row = 0; row < layer.columns[0].size(); ++row) {
    const double px_x = at_x(layer, 0, row);
    const double low = at_y(layer, 1, row);
    const double high = at_y(layer, 2, row);
    if (!std::isfinite(px_x + low + high)) continue;
    upper += (upper.empty() ? "M" : "L") + px(px_x) + " " + px(high);
    lower.insert(0, "L" + px(px_x) + " " + px(low));
  }
  return fmt::format("<path d=\"{}{}Z\" fill=\"{}\" fill-opacity=\"0.2\"/>\n", upper, lower,
                     paper(layer.colour));
}

std::string Pen::segment(const ChartLayer& layer, std::size_t row) const {
  double width = layer.size > 0.0 ? layer.size : layer.shade.empty() ? 2.5 : 1.0;
  if (!layer.shade.empty()) width *= 2.0 + 4.0 * std::min(1.0, std::abs(layer.shade[row]));
  return rule(at_x(layer, 0, row), at_y(layer, 1, row), at_x(layer, 2, row), at_y(layer, 3, row),
              colour(layer, row), width, layer.dashed);
}

std::string Pen::ellipse(const ChartLayer& layer, std::size_t row) const {
  const std::string ink = colour(layer, row);
  const double unit =
      std::abs(x.pixel(x.range.high) - x.pixel(x.range.low)) / (x.range.high - x.range.low);
  return fmt::format(
      "<ellipse rx=\"{}\" ry=\"{}\" transform=\"translate({} {}) rotate({})\" fill=\"{}\" "
      "fill-opacity=\"0.18\" stroke=\"{}\" stroke-width=\"1.2\"/>\n",
      px(std::max(1.5, unit * layer.columns[2].numbers[row])),
      px(std::max(1.5, unit * layer.columns[3].numbers[row])), px(at_x(layer, 0, row)),
      px(at_y(layer, 1, row)), px(-layer.columns[4].numbers[row] * geometry::kDegrees), ink, ink);
}

std::string Pen::interval(const ChartLayer& layer, std::size_t row) const {
  const std::string ink = colour(layer, row);
  const double radius = layer.size > 0.0 ? layer.size : 4.0;
  if (sideways()) {
    const double across = at_y(layer, 0, row);
    return rule(at_x(layer, 2, row), across, at_x(layer, 3, row), across, ink, 2.0, false) +
           dot(at_x(layer, 1, row), across, radius, ink);
  }
  const double along = at_x(layer, 0, row);
  return rule(along, at_y(layer, 2, row), along, at_y(layer, 3, row), ink, 2.0, false) +
         dot(along, at_y(layer, 1, row), radius, ink);
}

std::string Pen::bar(const ChartLayer& layer, std::size_t row) const {
  const std::string ink = colour(layer, row);
  const ChartScale& names = sideways() ? y : x;
  const double room = std::abs(names.last - names.first) /
                      static_cast<double>(std::max<std::size_t>(1, names.categories.size()));
  const double width = layer.size > 0.0 ? layer.size : names.categories.empty() ? 3.0 : 0.7 * room;
  return sideways() ? rule(x.pixel(0.0), at_y(layer, 0, row), at_x(layer, 1, row),
                           at_y(layer, 0, row), ink, width, false, "butt")
                    : rule(at_x(layer, 0, row), y.pixel(0.0), at_x(layer, 0, row),
                           at_y(layer, 1, row), ink, width, false, "butt");
}

std::string Pen::mark(const ChartLayer& layer, std::size_t row) const {
  switch (layer.kind) {
    case LayerKind::dots:
      return dot(at_x(layer, 0, row), at_y(layer, 1, row), layer.size > 0.0 ? layer.size : 4.0,
                 colour(layer, row));
    case LayerKind::segments:
      return segment(layer, row);
    case LayerKind::ellipses:
      return ellipse(layer, row);
    case LayerKind::intervals:
      return interval(layer, row);
    case LayerKind::bars:
      return bar(layer, row);
    case LayerKind::labels:
      return fmt::format(
          "<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
          px(at_x(layer, 0, row)), px(at_y(layer, 1, row) - 7.0),
          text::xml_escaped(layer.columns[2].texts[row]));
    case LayerKind::level:
      return rule(x.first, at_y(layer, 0, row), x.last, at_y(layer, 0, row), colour(layer, row),
                  1.5, layer.dashed);
    case LayerKind::upright:
      return rule(at_x(layer, 0, row), y.first, at_x(layer, 0, row), y.last, colour(layer, row),
                  1.5, layer.dashed);
    default:
      return {};
  }
}

std::string Pen::draw(const ChartLayer& layer) const {
  if (layer.kind == LayerKind::line || layer.kind == LayerKind::net) return path(layer);
  if (layer.kind == LayerKind::band) return band(layer);
  std::string svg;
  for (std::size_t row = 0; row < layer.columns[0].size(); ++row) svg += mark(layer, row);
  return svg;
}

/// Squares with names, in rows; `top` moves below them.
std::string legend(const Chart& chart, double& top) {
  std::vector<std::pair<std::string, std::string>> entries;
  const auto add = [&entries](const std::string& name, const std::string& colour) {
    for (const auto& [known, ignored] : entries) {
      if (known == name) return;
    }
    entries.emplace_back(name, colour);
  };
  for (const ChartLayer& layer : chart.layers) {
    if (!layer.name.empty() && layer.key.empty()) add(layer.name, paper(layer.colour));
    for (std::size_t k = 0; k < layer.key.size(); ++k) {
      if (layer.key[k].empty()) continue;
      add(layer.key[k], shade_colour(static_cast<double>(k) - 1.0));
    }
  }
  std::string svg;
  double x = kEdge;
  for (const auto& [name, colour] : entries) {
    const double wide = 34.0 + kCharacter * static_cast<double>(name.size());
    if (x + wide > kWidth - kEdge && x > kEdge) {
      x = kEdge;
      top += 20.0;
    }
    svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"11\" height=\"11\" fill=\"{}\"/>\n", px(x),
                       px(top), colour);
    svg += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", px(x + 16.0), px(top + 10.0),
                       text::xml_escaped(name));
    x += wide;
  }
  if (!entries.empty()) top += 26.0;
  return svg;
}

std::string axes(const Chart& chart, const ChartScale& x, const ChartScale& y, double left,
                 double top, double right, double bottom) {
  std::string grid;
  std::string text;
  for (const auto& [at, name] : x.ticks()) {
    if (x.categories.empty()) grid += fmt::format("M{} {}V{}", px(at), px(top), px(bottom));
    text += fmt::format("<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                        px(at), px(bottom + 16.0), text::xml_escaped(name));
  }
  for (const auto& [at, name] : y.ticks()) {
    if (y.categories.empty()) grid += fmt::format("M{} {}H{}", px(left), px(at), px(right));
    text +=
        fmt::format("<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n",
                    px(left - 6.0), px(at + 4.0), text::xml_escaped(shortened(name, kLongestName)));
  }
  text +=
      fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                  px(0.5 * (left + right)), px(bottom + 36.0), text::xml_escaped(chart.x.title));
  text += fmt::format(
      "<text x=\"{0}\" y=\"{1}\" text-anchor=\"middle\" transform=\"rotate(-90 {0} {1})\">{2}"
      "</text>\n",
      px(kEdge + 4.0), px(0.5 * (top + bottom)), text::xml_escaped(chart.y.title));
  return fmt::format("<path class=\"grid\" d=\"{}\"/>\n", grid) + text;
}

/// For charts alone, since one in a page would style all of it.
constexpr const char* kStyle =
    "<style>.trussmap-chart text{font:12px system-ui,'Liberation Sans',sans-serif;fill:#1b1f24}"
    ".trussmap-chart .title{font-size:16px;font-weight:600}.trussmap-chart .tick{fill:#57606a}"
    ".trussmap-chart .grid{stroke:#e6e9ed;fill:none}</style>\n";

}  // namespace

std::string draw_chart(const Chart& chart) {
  static_cast<void>(chart_json(chart));  // the same checks
  double top = kEdge + 30.0;
  const std::string entries = legend(chart, top);
  std::size_t longest = 6;
  for (const std::string& name : chart.y.categories) longest = std::max(longest, name.size());
  const double left =
      kEdge + 24.0 + kCharacter * static_cast<double>(std::min(longest, kLongestName));
  const double right = kWidth - kEdge - 10.0;
  const double bottom = top + chart.height;
  const auto [x, y] = chart_scales(chart, left, top, right, bottom);
  const Pen pen{chart, x, y};
  std::string plot;
  for (const ChartLayer& layer : chart.layers) plot += pen.draw(layer);
  // Charts of one page with the same name for it have the same rectangle.
  const std::string clip =
      fmt::format("plot-{}-{}-{}-{}", px(left), px(top), px(right - left), px(bottom - top));
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"trussmap-chart\" "
             "viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
             "height=\"{1}\" role=\"img\">\n<title>{2}</title>\n<desc>{3}</desc>\n{4}"
             "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
             "<clipPath id=\"{11}\"><rect x=\"{5}\" y=\"{6}\" width=\"{7}\" height=\"{8}\"/>"
             "</clipPath>\n<text class=\"title\" x=\"{9}\" y=\"{10}\">{2}</text>\n",
             px(kWidth), px(bottom + 50.0), text::xml_escaped(chart.title),
             text::xml_escaped(chart.caption), kStyle, px(left), px(top), px(right - left),
             px(bottom - top), px(kEdge), px(kEdge + 14.0), clip) +
         entries + axes(chart, x, y, left, top, right, bottom) + "<g clip-path=\"url(#" + clip +
         ")\">\n" + plot + "</g>\n</svg>\n";
}

}  // namespace trussmap::plot
