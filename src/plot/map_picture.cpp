// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/map_picture.hpp"

#include "plot/path_picture.hpp"
#include "plot/picture_frame.hpp"
#include "text/xml_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

constexpr std::size_t kMostNamesDrawn = 80;  // beyond that names only clutter

std::string line(const PictureFrame& view, const Vector2& a, const Vector2& b, const char* kind,
                 double width) {
  return fmt::format(
      "<line class=\"{}\" x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" "
      "stroke-width=\"{:.2f}\"/>\n",
      kind, view.x(a), view.y(a), view.x(b), view.y(b), width);
}

std::string cross(const PictureFrame& view, const Vector2& at) {
  constexpr double r = 4.5;
  const double x = view.x(at);
  const double y = view.y(at);
  return fmt::format(
      "<path class=\"truth\" d=\"M{:.2f} {:.2f}l{:.1f} {:.1f}m{:.1f} 0l{:.1f} {:.1f}\"/>\n", x - r,
      y - r, 2 * r, 2 * r, -2 * r, 2 * r, -2 * r);
}

/// From a landmark's joint along its own axis.
std::string tick(const PictureFrame& view, const Vector2& at, double heading) {
  constexpr double kLength = 14.0;
  const double x = view.x(at);
  const double y = view.y(at);
  return fmt::format(
      "<line class=\"axis\" x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" "
      "stroke-width=\"1.60\"/>\n",
      x, y, x + kLength * std::cos(heading), y - kLength * std::sin(heading));
}

/// The map's routes as they truly lie.
std::string true_routes(const MapPicture& picture, const PictureFrame& view) {
  constexpr double kWidth = 5.0;
  std::string lines;
  for (int number = 0; number < picture.map.routes(); ++number) {
    const Route& route = picture.map.route(number);
    const auto from = picture.truth.find(picture.map.landmark(route.source).name);
    const auto to = picture.truth.find(picture.map.landmark(route.target).name);
    if (from == picture.truth.end() || to == picture.truth.end()) continue;
    lines += line(view, from->second, to->second, "true", kWidth);
  }
  return lines;
}

/// The largest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double digits = length / power;
  return power * (digits >= 5.0 ? 5.0 : digits >= 2.0 ? 2.0 : 1.0);
}

std::string header(const MapPicture& picture, const PictureFrame& view) {
  std::string svg = fmt::format("<text class=\"title\" x=\"{}\" y=\"28\">{}</text>\n",
                                kPictureMargin, text::xml_escaped(picture.title));
  double x = kPictureMargin;
  const auto entry = [&](const std::string& mark, const char* label, double width) {
    svg += fmt::format(
        "<g transform=\"translate({:.1f},54)\">{}<text x=\"30\" y=\"5\">{}</text>"
        "</g>\n",
        x, mark, label);
    x += width;
  };
  const std::string bar =
      "<line class=\"{}\" x1=\"0\" y1=\"0\" x2=\"24\" y2=\"0\" "
      "stroke-width=\"2\"/>";
  const bool paths = !picture.paths.empty();
  if (paths) {
    entry(fmt::format(fmt::runtime(bar), "before"), "dead reckoning", 150.0);
  } else if (!picture.measured.empty()) {
    entry(fmt::format(fmt::runtime(bar), "measured"), "as measured", 130.0);
  } else if (!picture.before.empty()) {
    entry(fmt::format(fmt::runtime(bar), "before"), "before correction", 170.0);
  }
  entry(fmt::format(fmt::runtime(bar), "after"), paths ? "adjusted path" : "corrected map", 150.0);
  if (picture.true_routes) entry(fmt::format(fmt::runtime(bar), "true"), "true map", 110.0);
  if (!picture.truth.empty() && picture.crosses) {
    entry("<path class=\"truth\" d=\"M7.5 -4.5l9 9m-9 0l9 -9\"/>", "true position", 140.0);
  }
  if (paths) {
    entry(
        "<circle class=\"fix\" cx=\"12\" cy=\"0\" r=\"2\"/>"
        "<path class=\"loop\" d=\"M0 4h24\"/>",
        "fix, loop", 100.0);
    entry(
        "<circle class=\"fix wrong\" cx=\"12\" cy=\"0\" r=\"2.5\"/>"
        "<path class=\"loop wrong\" d=\"M0 4h24\"/>",
        "left out", 90.0);
  }
  const double length = round_length(0.2 * kPictureWidth / view.scale());
  const double pixels = length * view.scale();
  svg += fmt::format(
      "<g transform=\"translate({:.1f},54)\"><path class=\"scale\" d=\"M0 -4v8M0 0h{:.1f}M{:.1f} "
      "-4v8\"/><text x=\"{:.1f}\" y=\"-8\" text-anchor=\"middle\">{:g} m</text></g>\n",
      kPictureWidth - kPictureMargin - pixels, pixels, pixels, 0.5 * pixels, length);
  return svg;
}

constexpr const char* kMapStyle =
    "<style>text{font:13px system-ui,sans-serif;fill:#222}.title{font-size:17px;font-weight:600}"
    ".name{font-size:10px;fill:#555}.before{stroke:#b9b9b9}.true{stroke:#d3dae6}.measured{stroke:#"
    "8f8f8f}.after{stroke:#111}"
    ".axis{stroke:#1b6ca8}"
    ".joint{fill:#111}.ghost{fill:#b9b9b9}.truth{stroke:#d1495b;stroke-width:1.6;fill:none}"
    ".scale{stroke:#222;fill:none}polyline,.loop{fill:none;stroke-width:1}"
    ".fix{fill:#2a6fb0}.loop{stroke:#7fb3d9;stroke-width:.6}"
    ".fix.wrong{fill:#d1495b}.loop.wrong{stroke:#d1495b;stroke-opacity:.4}</style>\n";

}  // namespace

MapPicture picture_of(const BuiltMap& built, const std::string& title) {
  MapPicture picture;
  picture.title = title;
  picture.map = built.map;
  picture.before = built.dead_reckoned;
  picture.paths = built.paths;
  if (built.on_survey) {
    picture.map_onto_truth = built.on_survey->comparison.rigid;
    for (const SurveyPoint& point : built.on_survey->points) {
      picture.truth[point.landmark] = {point.x, point.y};
    }
  }
  return picture;
}

std::string draw_map(const MapPicture& picture) {
  const Alignment& lay = picture.map_onto_truth;
  const auto after = [&](int k) { return lay.apply(picture.map.landmark(k).position); };
  const auto before = [&](int k) { return picture.before.find(picture.map.landmark(k).name); };
  PictureFrame view;
  for (int k = 0; k < picture.map.landmarks(); ++k) {
    view.include(after(k));
    if (before(k) != picture.before.end()) view.include(lay.apply(before(k)->second));
  }
  for (const auto& [name, position] : picture.truth) view.include(position);
  for (const auto& [from, to] : picture.measured) {
    view.include(lay.apply(from));
    view.include(lay.apply(to));
  }
  include_paths(picture.paths, view);
  view.finish();

  std::string body = draw_paths(picture.paths, view);
  if (picture.true_routes) body += true_routes(picture, view);
  for (const auto& [from, to] : picture.measured) {
    body += line(view, lay.apply(from), lay.apply(to), "measured", 1.0);
  }
  for (int number = 0; number < picture.map.routes(); ++number) {
    const Route& route = picture.map.route(number);
    const auto a = before(route.source);
    const auto b = before(route.target);
    if (a == picture.before.end() || b == picture.before.end()) continue;
    body += line(view, lay.apply(a->second), lay.apply(b->second), "before", 1.5);
  }
  for (int number = 0; number < picture.map.routes(); ++number) {
    const Route& route = picture.map.route(number);
    const double width = std::min(0.8 + 0.4 * std::log2(route.traversals), 3.0);
    body += line(view, after(route.source), after(route.target), "after", width);
  }
  for (int k = 0; k < picture.map.landmarks(); ++k) {
    if (const std::optional<double>& heading = picture.map.landmark(k).heading) {
      body += tick(view, after(k), *heading + lay.angle);
    }
    body += fmt::format("<circle class=\"joint\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"2.6\"/>\n",
                        view.x(after(k)), view.y(after(k)));
  }
  for (const auto& [name, position] : picture.truth) {
    if (picture.crosses) body += cross(view, position);
  }
  const auto count = static_cast<std::size_t>(picture.map.landmarks());
  for (int k = 0; picture.names && count <= kMostNamesDrawn && k < picture.map.landmarks(); ++k) {
    body += fmt::format("<text class=\"name\" x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n",
                        view.x(after(k)) + 6.0, view.y(after(k)) - 6.0,
                        text::xml_escaped(picture.map.landmark(k).name));
  }
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
             "width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\">\n<title>{2}</title>\n"
             "{3}<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
             kPictureWidth, view.height(), text::xml_escaped(picture.title), kMapStyle) +
         header(picture, view) + body + "</svg>\n";
}

}  // namespace trussmap::plot
