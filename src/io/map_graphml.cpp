// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "io/xml_element.hpp"
#include "text/plain_text.hpp"
#include "text/xml_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/write_files.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/LU>

namespace trussmap {
using namespace io;

namespace {

void write_data(std::string& text, const char* key, double value) {
  text += std::string("      <data key=\"") + key + "\">" + csv_number(value) + "</data>\n";
}

void write_covariance(std::string& text, const std::string& prefix, const Matrix2& covariance) {
  write_data(text, (prefix + "c_xx").c_str(), covariance(0, 0));
  write_data(text, (prefix + "c_xy").c_str(), covariance(0, 1));
  write_data(text, (prefix + "c_yy").c_str(), covariance(1, 1));
}

/// XML allows none in a comment, nor one before its end.
std::string without_double_hyphens(std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;) text.insert(++at, " ");
  return text;
}

bool has_headings(const LandmarkGraph& map) {
  for (int k = 0; k < map.landmarks(); ++k) {
    if (map.landmark(k).heading) return true;
  }
  return false;
}

using KeyNames = std::map<std::string, std::string>;

/// The data of one node or edge, by attribute name.
class Attributes {
 public:
  Attributes(const XmlElement& element, const KeyNames& names, std::string file, std::string what)
      : file_(std::move(file)), line_(element.line), what_(std::move(what)) {
    for (const XmlElement& child : element.children) {
      if (child.name != "data") continue;
      const std::string key = child.attribute("key");
      const auto name = names.find(key);
      values_[name == names.end() ? key : name->second] = child.text;
    }
  }

  [[nodiscard]] bool has(const std::string& name) const { return values_.count(name) > 0; }

  [[nodiscard]] double number(const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) fail("has no " + name + ", expected a number");
    const std::string& text = found->second;
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
      fail(name + " is \"" + text + "\", expected a finite number");
    }
    return value;
  }

  [[nodiscard]] Matrix2 covariance() const {
    const double xx = number("c_xx");
    const double xy = number("c_xy");
    const double yy = number("c_yy");
    Matrix2 C = (Matrix2() << xx, xy, xy, yy).finished();
    const double rounding = 1e-12 * C(0, 0) * C(1, 1);
    if (C(0, 0) < 0.0 || C(1, 1) < 0.0 || C.determinant() < -rounding) {
      fail("c_xx, c_xy, c_yy are no covariance, expected a positive semidefinite matrix");
    }
    return C;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(file_, line_, what_ + ": " + why);
  }

 private:
  std::string file_;
  int line_;
  std::string what_;
  std::map<std::string, std::string> values_;
};

/// Attribute names of the declared keys, for nodes or for edges.
KeyNames declared_keys(const XmlElement& graphml, const std::string& domain) {
  KeyNames names;
  for (const XmlElement& child : graphml.children) {
    if (child.name != "key") continue;
    const std::string of = child.attribute("for");
    if (of == domain || of == "all" || of.empty()) {
      names[child.attribute("id")] = child.attribute("attr.name");
    }
  }
  return names;
}

void read_node(const XmlElement& element, const KeyNames& names, const std::string& file,
               LandmarkGraph& map) {
  const std::string name = element.attribute("id");
  if (name.empty()) {
    throw InputError(file, element.line, "a node has no id, expected a landmark's name");
  }
  if (!text::is_plain_text(name)) {
    throw InputError(file, element.line,
                     "a node's id holds a control character, expected printable text in UTF-8");
  }
  const Attributes data(element, names, file, "landmark " + name);
  if (map.find(name)) data.fail("stands twice, expected each landmark once");
  const int landmark = map.add_landmark(name, {data.number("x"), data.number("y")});
  if (data.has("c_xx")) map.set_covariance(landmark, data.covariance());
  if (!data.has("heading")) return;
  std::optional<double> sd;
  if (data.has("sd_heading")) sd = data.number("sd_heading");
  if (sd && *sd < 0.0) data.fail("sd_heading is negative, expected 0 or more");
  map.set_heading(landmark, data.number("heading"), sd);
}

void read_edge(const XmlElement& element, const KeyNames& names, const std::string& file,
               LandmarkGraph& map) {
  const std::string source = element.attribute("source");
  const std::string target = element.attribute("target");
  const Attributes data(element, names, file, "route " + source + " - " + target);
  if (element.attribute("directed") == "true") data.fail("is directed, expected undirected edges");
  const std::optional<int> i = map.find(source);
  const std::optional<int> j = map.find(target);
  if (!i || !j) data.fail("landmark " + (i ? target : source) + " is unknown, expected a node");
  if (*i == *j) data.fail("joins a landmark to itself, expected two landmarks");
  if (map.route_between(*i, *j)) data.fail("stands twice, expected one edge between two nodes");
  Route route;
  route.source = *i;
  route.target = *j;
  const double traversals = data.number("traversals");
  if (traversals < 1.0 || traversals != std::floor(traversals) || traversals > 1e9) {
    data.fail("traversals is " + csv_number(traversals) + ", expected a whole number from 1");
  }
  route.traversals = static_cast<int>(traversals);
  route.stretch = data.number("stretch");
  route.orientation = data.number("orientation");
  route.displacement = {data.number("dx"), data.number("dy")};
  route.covariance = data.covariance();
  if (route.stretch < 0.0) data.fail("stretch is negative, expected 0 or more");
  map.set_route(map.add_route(*i, *j), route);
}

}  // namespace

LandmarkGraph read_map_graphml(const std::filesystem::path& file) {
  const std::string name = file.string();
  const XmlElement graphml = parse_xml(read_file(file), name);
  const XmlElement* graph = graphml.name == "graphml" ? graphml.child("graph") : nullptr;
  if (graph == nullptr) {
    throw InputError(name, graphml.line, "no GraphML, expected a graphml element with a graph");
  }
  if (graph->attribute("edgedefault") == "directed") {
    throw InputError(name, graph->line,
                     "the graph is directed, expected edgedefault=\"undirected\"");
  }
  LandmarkGraph map;
  const KeyNames node_keys = declared_keys(graphml, "node");
  const KeyNames edge_keys = declared_keys(graphml, "edge");
  for (const XmlElement& child : graph->children) {
    if (child.name == "node") read_node(child, node_keys, name, map);
  }
  for (const XmlElement& child : graph->children) {
    if (child.name == "edge") read_edge(child, edge_keys, name, map);
  }
  return map;
}

std::string format_map_graphml(const LandmarkGraph& map, const std::string& comment) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  if (!comment.empty()) text += "<!-- " + without_double_hyphens(comment) + " -->\n";
  text += "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n";
  const auto declare = [&text](const char* domain, const char* prefix, const char* attribute) {
    const bool count = std::string(attribute) == "traversals";
    text += std::string("  <key id=\"") + prefix + attribute + "\" for=\"" + domain +
            "\" attr.name=\"" + attribute + "\" attr.type=\"" + (count ? "int" : "double") +
            "\"/>\n";
  };
  for (const char* name : {"x", "y", "c_xx", "c_xy", "c_yy"}) declare("node", "n_", name);
  if (has_headings(map)) {
    for (const char* name : {"heading", "sd_heading"}) declare("node", "n_", name);
  }
  for (const char* name :
       {"traversals", "stretch", "orientation", "dx", "dy", "c_xx", "c_xy", "c_yy"}) {
    declare("edge", "e_", name);
  }
  text += "  <graph id=\"map\" edgedefault=\"undirected\">\n";
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& landmark = map.landmark(k);
    text += "    <node id=\"" + text::xml_escaped(landmark.name) + "\">\n";
    write_data(text, "n_x", landmark.position.x());
    write_data(text, "n_y", landmark.position.y());
    if (landmark.covariance) write_covariance(text, "n_", *landmark.covariance);
    if (landmark.heading) write_data(text, "n_heading", *landmark.heading);
    if (landmark.sd_heading) write_data(text, "n_sd_heading", *landmark.sd_heading);
    text += "    </node>\n";
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    text += "    <edge source=\"" + text::xml_escaped(map.landmark(route.source).name) +
            "\" target=\"" + text::xml_escaped(map.landmark(route.target).name) + "\">\n";
    write_data(text, "e_traversals", route.traversals);
    write_data(text, "e_stretch", route.stretch);
    write_data(text, "e_orientation", route.orientation);
    write_data(text, "e_dx", route.displacement.x());
    write_data(text, "e_dy", route.displacement.y());
    write_covariance(text, "e_", route.covariance);
    text += "    </edge>\n";
  }
  return text + "  </graph>\n</graphml>\n";
}

}  // namespace trussmap
