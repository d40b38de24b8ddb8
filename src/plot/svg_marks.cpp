// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/svg_marks.hpp"

#include "text/xml_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::plot {

std::string px(double value) {
  const double rounded = std::round(value * 100.0) / 100.0;
  return fmt::format("{:g}", rounded == 0.0 ? 0.0 : std::stod(fmt::format("{:.2f}", rounded)));
}

std::string stroke(const Mark& mark) {
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}",
                     text::xml_escaped(mark.colour), px(mark.size),
                     mark.dashed ? " stroke-dasharray=\"7 4\"" : "");
}

std::string point_mark(const Mark& mark, double x, double y) {
  const std::string colour = text::xml_escaped(mark.colour);
  const double r = mark.size;
  switch (mark.kind) {
    case MarkKind::dots:
      return fmt::format(
          "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" fill-opacity=\"0.75\"/>\n", px(x),
          px(y), px(r), colour);
    case MarkKind::circles:
      return fmt::format(
          "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"#fff\" stroke=\"{}\" "
          "stroke-width=\"1.6\"/>\n",
          px(x), px(y), px(r), colour);
    case MarkKind::crosses:
      return fmt::format(
          "<path d=\"M{0} {1}l{2} {2}m0 -{2}l-{2} {2}\" fill=\"none\" stroke=\"{3}\" "
          "stroke-width=\"2\"/>\n",
          px(x - r), px(y - r), px(2 * r), colour);
    default:
      return fmt::format(
          "<path d=\"M{} {}h{}M{} {}v{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n",
          px(x - r), px(y), px(2 * r), px(x), px(y - r), px(2 * r), colour);
  }
}

std::string draw_mark(const Mark& mark, const View& view) {
  std::string svg;
  switch (mark.kind) {
    case MarkKind::polyline: {
      if (mark.at.empty()) return svg;
      svg = "<polyline points=\"";
      for (std::size_t k = 0; k < mark.at.size(); ++k) {
        svg += (k == 0 ? "" : " ") + view.point(mark.at[k], ",");
      }
      return svg + "\" stroke-linejoin=\"round\" " + stroke(mark) + "/>\n";
    }
    case MarkKind::segments: {
      if (mark.at.size() < 2) return svg;
      svg = "<path d=\"";
      for (std::size_t k = 0; k + 1 < mark.at.size(); k += 2) {
        svg += "M" + view.point(mark.at[k], " ") + "L" + view.point(mark.at[k + 1], " ");
      }
      return svg + "\" stroke-linecap=\"round\" " + stroke(mark) + "/>\n";
    }
    case MarkKind::labels:
      for (std::size_t k = 0; k < std::min(mark.at.size(), mark.texts.size()); ++k) {
        svg += fmt::format("<text x=\"{}\" y=\"{}\" style=\"font-size:{}px;fill:{}\">{}</text>\n",
                           px(view.to_x(mark.at[k].x()) + 7.0), px(view.to_y(mark.at[k].y()) - 6.0),
                           px(mark.size), text::xml_escaped(mark.colour),
                           text::xml_escaped(mark.texts[k]));
      }
      return svg;
    default:
      for (const Vector2& p : mark.at) svg += point_mark(mark, view.to_x(p.x()), view.to_y(p.y()));
      return svg;
  }
}

}  // namespace trussmap::plot
