// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/svg.hpp"

#include "linalg/dense.hpp"
#include "plot/svg_marks.hpp"
#include "text/xml_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

constexpr double kPictureEdge = 16.0;  // pixels round the picture
constexpr double kLeftAxis = 62.0;     // numbers and label of the y axis
constexpr double kBottomAxis = 48.0;
constexpr double kPanelTitle = 26.0;
constexpr double kRightGap = 14.0;
constexpr double kPictureCharacter = 6.7;  // mean width of one at 13 px

Range fitted(const std::vector<Mark>& marks, int axis) {
  constexpr double kRangeMargin = 0.07;
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Mark& mark : marks) {
    for (const Vector2& point : mark.at) {
      range.low = std::min(range.low, point[axis]);
      range.high = std::max(range.high, point[axis]);
    }
  }
  if (range.low > range.high) return {0.0, 1.0};
  double size = range.high - range.low;
  if (!(size > 1e-12 * std::max(std::abs(range.low), std::abs(range.high)))) {
    size = range.high == 0.0 ? 1.0 : std::abs(range.high);
  }
  return {range.low - kRangeMargin * size, range.high + kRangeMargin * size};
}

void widen(Range& range, double factor) {
  const double middle = 0.5 * (range.low + range.high);
  const double half = 0.5 * factor * (range.high - range.low);
  range = {middle - half, middle + half};
}

View make_view(const Figure& figure, const Panel& panel, double left, double top) {
  View view{panel.x.value_or(fitted(panel.marks, 0)),
            panel.y.value_or(fitted(panel.marks, 1)),
            left + kLeftAxis,
            top + kPanelTitle,
            figure.panel_width - kLeftAxis - kRightGap,
            figure.panel_height - kBottomAxis - kPanelTitle};
  if (panel.equal_aspect) {
    const double per_x = (view.x.high - view.x.low) / view.width;
    const double per_y = (view.y.high - view.y.low) / view.height;
    if (per_x < per_y) {
      widen(view.x, per_y / per_x);
    } else {
      widen(view.y, per_x / per_y);
    }
  }
  return view;
}

/// A number on an axis whose ticks are `step` apart.
std::string tick_text(double value, double step) {
  const double size = std::max(std::abs(value), step);
  if (size >= 1e6 || step < 1e-5)
    return fmt::format("{:.3g}", std::abs(value) < step / 2 ? 0.0 : value);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::string text = fmt::format("{:.{}f}", std::abs(value) < step / 2 ? 0.0 : value, decimals);
  if (text.front() == '-') text.replace(0, 1, "\u2212");  // a minus sign as long as a plus
  return text;
}

std::string draw_axes(const Panel& panel, const View& view) {
  constexpr double kPixelsPerTick = 38.0;
  const double right = view.left + view.width;
  const double bottom = view.top + view.height;
  std::string grid;
  std::string text;
  const auto ticks_of = [](const Range& range, double pixels) {
    return round_ticks(range, std::max(2, static_cast<int>(pixels / kPixelsPerTick)));
  };
  const std::vector<double> x_ticks = ticks_of(view.x, view.width);
  const std::vector<double> y_ticks = ticks_of(view.y, view.height);
  const auto step = [](const std::vector<double>& ticks) {
    return ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  };
  for (const double tick : x_ticks) {
    const std::string x = px(view.to_x(tick));
    grid += fmt::format("M{} {}V{}", x, px(view.top), px(bottom));
    text += fmt::format("<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                        x, px(bottom + 16.0), tick_text(tick, step(x_ticks)));
  }
  for (const double tick : y_ticks) {
    const std::string y = px(view.to_y(tick));
    grid += fmt::format("M{} {}H{}", px(view.left), y, px(right));
    text +=
        fmt::format("<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n",
                    px(view.left - 6.0), px(view.to_y(tick) + 4.0), tick_text(tick, step(y_ticks)));
  }
  const double middle_x = view.left + 0.5 * view.width;
  const double middle_y = view.top + 0.5 * view.height;
  const double label_x = view.left - kLeftAxis + 14.0;
  text += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", px(middle_x),
                      px(bottom + 36.0), text::xml_escaped(panel.x_label));
  text += fmt::format(
      "<text x=\"{0}\" y=\"{1}\" text-anchor=\"middle\" transform=\"rotate(-90 {0} "
      "{1})\">{2}</text>\n",
      px(label_x), px(middle_y), text::xml_escaped(panel.y_label));
  text += fmt::format("<text class=\"panel\" x=\"{}\" y=\"{}\">{}</text>\n", px(view.left),
                      px(view.top - 9.0), text::xml_escaped(panel.title));
  std::string svg = fmt::format("<path class=\"grid\" d=\"{}\"/>\n", grid);
  if (panel.zero_lines) {
    std::string zero;
    if (view.x.low < 0.0 && view.x.high > 0.0) {
      zero += fmt::format("M{} {}V{}", px(view.to_x(0.0)), px(view.top), px(bottom));
    }
    if (view.y.low < 0.0 && view.y.high > 0.0) {
      zero += fmt::format("M{} {}H{}", px(view.left), px(view.to_y(0.0)), px(right));
    }
    svg += fmt::format("<path class=\"zero\" d=\"{}\"/>\n", zero);
  }
  return svg + text;
}

std::string draw_panel(const Figure& figure, const Panel& panel, double left, double top,
                       std::size_t number) {
  const View view = make_view(figure, panel, left, top);
  const std::string box = fmt::format("x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", px(view.left),
                                      px(view.top), px(view.width), px(view.height));
  std::string svg = fmt::format("<clipPath id=\"plot{}\"><rect {}/></clipPath>\n", number, box);
  svg += draw_axes(panel, view);
  svg += fmt::format("<g clip-path=\"url(#plot{})\">\n", number);
  for (const Mark& mark : panel.marks) svg += draw_mark(mark, view);
  return svg + "</g>\n" + fmt::format("<rect class=\"frame\" {}/>\n", box);
}

/// Entries in rows no wider than the picture; `bottom` moves below them.
std::string draw_legend(const Figure& figure, double width, double& bottom) {
  constexpr double kRow = 22.0;
  constexpr double kSymbol = 30.0;
  constexpr double kGap = 22.0;
  std::set<std::string> listed;
  std::string svg;
  double x = kPictureEdge;
  for (const Panel& panel : figure.panels) {
    for (const Mark& mark : panel.marks) {
      if (mark.legend.empty() || !listed.insert(mark.legend).second) continue;
      const double wide =
          kSymbol + kPictureCharacter * static_cast<double>(mark.legend.size()) + kGap;
      if (listed.size() == 1) {
        bottom += kRow;
      } else if (x + wide - kGap > width - kPictureEdge) {
        x = kPictureEdge;
        bottom += kRow;
      }
      const double y = bottom - 10.0;
      const bool line = mark.kind == MarkKind::polyline || mark.kind == MarkKind::segments;
      if (line) {
        svg += fmt::format("<path d=\"M{} {}h24\" {}/>\n", px(x), px(y), stroke(mark));
      } else if (mark.kind != MarkKind::labels) {
        svg += point_mark(mark, x + 12.0, y);
      }
      svg += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", px(x + kSymbol), px(y + 4.5),
                         text::xml_escaped(mark.legend));
      x += wide;
    }
  }
  return svg;
}

void check(const Figure& figure) {
  if (figure.panels.empty()) throw std::invalid_argument("a figure needs a panel");
  for (const Panel& panel : figure.panels) {
    for (const Mark& mark : panel.marks) {
      for (const Vector2& point : mark.at) {
        if (!point.allFinite()) throw std::invalid_argument("a mark of a figure is not finite");
      }
    }
    for (const auto& range : {panel.x, panel.y}) {
      const bool wide = !range || (std::isfinite(range->low) && std::isfinite(range->high) &&
                                   range->low < range->high);
      if (!wide) throw std::invalid_argument("an axis of a figure has no width");
    }
  }
}

constexpr const char* kPlotStyle =
    "<style>text{font:13px system-ui,'Segoe UI','DejaVu Sans',sans-serif;fill:#222}"
    ".title{font-size:17px;font-weight:600}.subtitle{fill:#555}.panel{font-weight:600}"
    ".tick{font-size:11.5px;fill:#555}.grid{stroke:#ececec;fill:none}.zero{stroke:#b5b5b5;fill:"
    "none}"
    ".frame{fill:none;stroke:#777}</style>\n";

}  // namespace

std::vector<double> round_ticks(const Range& range, int count) {
  const double raw = (range.high - range.low) / std::max(count, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double digit : {5.0, 2.0, 1.0}) {
    if (raw <= digit * power * (1.0 + 1e-9)) step = digit * power;
  }
  std::vector<double> ticks;
  const double first = std::ceil(range.low / step - 1e-9);
  const int steps = static_cast<int>(std::floor(range.high / step + 1e-9) - first);
  for (int k = 0; k <= steps; ++k) ticks.push_back((first + k) * step);
  return ticks;
}

std::vector<Vector2> ellipse_outline(const Vector2& centre, const Matrix2& covariance,
                                     double scale) {
  constexpr int kPoints = 96;
  const linalg::PlanarModes modes = linalg::planar_modes(covariance);
  const Vector2 axes = scale * modes.eigenvalues.cwiseMax(0.0).cwiseSqrt();
  std::vector<Vector2> outline;
  for (int k = 0; k <= kPoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k % kPoints) / kPoints;
    const Vector2 along(axes.x() * std::cos(angle), axes.y() * std::sin(angle));
    outline.push_back(centre + modes.eigenvectors * along);
  }
  return outline;
}

std::string draw_figure(const Figure& figure) {
  check(figure);
  const double width =
      2.0 * kPictureEdge + figure.panel_width * static_cast<double>(figure.panels.size());
  double top = kPictureEdge + 16.0;
  std::string svg = fmt::format("<text class=\"title\" x=\"{}\" y=\"{}\">{}</text>\n",
                                px(kPictureEdge), px(top), text::xml_escaped(figure.title));
  if (!figure.subtitle.empty()) {
    top += 21.0;
    svg += fmt::format("<text class=\"subtitle\" x=\"{}\" y=\"{}\">{}</text>\n", px(kPictureEdge),
                       px(top), text::xml_escaped(figure.subtitle));
  }
  top += 8.0;
  svg += draw_legend(figure, width, top);
  top += 4.0;
  for (std::size_t k = 0; k < figure.panels.size(); ++k) {
    const double left = kPictureEdge + figure.panel_width * static_cast<double>(k);
    svg += draw_panel(figure, figure.panels[k], left, top, k);
  }
  const double height = top + figure.panel_height + 0.5 * kPictureEdge;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
             "height=\"{1}\" role=\"img\">\n<title>{2}</title>\n{3}"
             "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
             px(width), px(height), text::xml_escaped(figure.title), kPlotStyle) +
         svg + "</svg>\n";
}

}  // namespace trussmap::plot
