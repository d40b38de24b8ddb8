// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "io/geojson.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/recording.hpp"

#include <nlohmann/json.hpp>

namespace trussmap {
using namespace io;

namespace {

using nlohmann::json;

void add_covariance(json& properties, const Matrix2& covariance) {
  properties["c_xx"] = covariance(0, 0);
  properties["c_xy"] = covariance(0, 1);
  properties["c_yy"] = covariance(1, 1);
}

std::string dot_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace

std::string format_geojson(const LandmarkGraph& map) {
  json features = json::array();
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& landmark = map.landmark(k);
    json properties = {{"landmark", landmark.name}};
    if (landmark.covariance) add_covariance(properties, *landmark.covariance);
    if (landmark.heading) properties["heading"] = *landmark.heading;
    if (landmark.sd_heading) properties["sd_heading"] = *landmark.sd_heading;
    features.push_back(geojson_point(landmark.position, std::move(properties)));
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Landmark& source = map.landmark(route.source);
    const Landmark& target = map.landmark(route.target);
    json properties = {{"from", source.name},
                       {"to", target.name},
                       {"traversals", route.traversals},
                       {"stretch", route.stretch},
                       {"orientation", route.orientation},
                       {"dx", route.displacement.x()},
                       {"dy", route.displacement.y()}};
    add_covariance(properties, route.covariance);
    features.push_back(geojson_line(source.position, target.position, std::move(properties)));
  }
  return geojson_text(features);
}

std::string format_dot(const LandmarkGraph& map) {
  std::string text = "graph map {\n  node [shape=point];\n";
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& landmark = map.landmark(k);
    text += "  " + dot_text(landmark.name) + " [xlabel=" + dot_text(landmark.name) + ", pos=\"" +
            csv_number(landmark.position.x()) + "," + csv_number(landmark.position.y()) + "!\"];\n";
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    text += "  " + dot_text(map.landmark(route.source).name) + " -- " +
            dot_text(map.landmark(route.target).name) + " [len=" + csv_number(route.stretch) +
            ", weight=" + std::to_string(route.traversals) + "];\n";
  }
  return text + "}\n";
}

std::string format_positions(const LandmarkGraph& map) {
  bool certain = map.landmarks() > 0;
  bool headings = false;
  for (int k = 0; k < map.landmarks(); ++k) {
    certain = certain && map.landmark(k).covariance;
    headings = headings || map.landmark(k).heading;
  }
  std::string text = "landmark,x,y";
  text += certain ? ",c_xx,c_xy,c_yy" : "";
  text += headings ? ",heading,sd_heading\n" : "\n";
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& one = map.landmark(k);
    text += csv_field(one.name) + ',' + csv_number(one.position.x()) + ',' +
            csv_number(one.position.y());
    if (certain) {
      const Matrix2& C = *one.covariance;
      text += ',' + csv_number(C(0, 0)) + ',' + csv_number(C(0, 1)) + ',' + csv_number(C(1, 1));
    }
    if (headings) {
      text += ',' + csv_number(one.heading.value_or(kAbsent)) + ',' +
              csv_number(one.sd_heading.value_or(kAbsent));
    }
    text += '\n';
  }
  return text;
}

}  // namespace trussmap
