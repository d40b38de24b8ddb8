// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A program of the build: trussmap_catalogue_maker OUT.cpp FILE.toml ... makes the records of the
// catalogue of one file per effect. What is wrong with a file is one line, and no source is
// written.
#include "trussmap/channel.hpp"
#include "trussmap/shape.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace trussmap::effects {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& file, const toml::source_region& where,
                         const std::string& what) {
  const auto line = where.begin.line;  // 0 of a table that is not there
  throw std::runtime_error(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
}

/// A table of a file, of which every key has to be asked for.
class Fields {
 public:
  Fields(const toml::table& table, std::string file, std::string name)
      : table_(table), file_(std::move(file)), name_(std::move(name)) {}

  std::string text(const std::string& key) {
    const std::optional<std::string> found = value<std::string>(key, "a text");
    if (!found || found->empty()) refuse(file_, table_.source(), missing(key, "a text"));
    return *found;
  }

  std::string text_or_none(const std::string& key) {
    return value<std::string>(key, "a text").value_or("");
  }

  std::vector<std::string> texts(const std::string& key) {
    asked_.insert(key);
    std::vector<std::string> found;
    const toml::node* node = table_.get(key);
    if (node == nullptr) return found;
    const toml::array* array = node->as_array();
    if (array == nullptr) refuse(file_, node->source(), wrong(key, "a list of texts"));
    for (const toml::node& one : *array) {
      const std::optional<std::string> text = one.value_exact<std::string>();
      if (!text || text->empty()) refuse(file_, one.source(), wrong(key, "a list of texts"));
      found.push_back(*text);
    }
    return found;
  }

  std::optional<double> number(const std::string& key) { return value<double>(key, "a number"); }
  std::optional<std::int64_t> integer(const std::string& key) {
    return value<std::int64_t>(key, "a whole number");
  }
  bool flag(const std::string& key) { return value<bool>(key, "true or false").value_or(false); }

  int sign() {
    const std::int64_t sign = integer("sign").value_or(0);
    if (sign < -1 || sign > 1) fail("sign", wrong("sign", "1 or -1"));
    return static_cast<int>(sign);
  }

  /// Empty where there is none.
  Fields table(const std::string& key) {
    static const toml::table kNone;
    asked_.insert(key);
    const toml::node* node = table_.get(key);
    if (node != nullptr && !node->is_table()) fail(key, wrong(key, "a table"));
    return {node == nullptr ? kNone : *node->as_table(), file_, key};
  }

  std::vector<Fields> tables(const std::string& key) {
    asked_.insert(key);
    std::vector<Fields> found;
    const toml::node* node = table_.get(key);
    if (node == nullptr) return found;
    if (!node->is_array_of_tables()) fail(key, wrong(key, "[[" + key + "]]"));
    for (const toml::node& one : *node->as_array()) {
      found.emplace_back(*one.as_table(), file_, key);
    }
    return found;
  }

  std::vector<std::pair<std::string, std::string>> pairs() {
    std::vector<std::pair<std::string, std::string>> found;
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      found.emplace_back(name, text(name));
    }
    return found;
  }

  /// Refuses what nobody asked for.
  void done() const {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (asked_.contains(name)) continue;
      std::string text = "unknown key \"" + name + "\"" + in_table() + ", expected one of";
      const char* between = " ";
      for (const std::string& one : asked_) {
        text.append(between).append(one);
        between = ", ";
      }
      refuse(file_, key.source(), text);
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    const toml::node* node = table_.get(key);
    refuse(file_, node == nullptr ? table_.source() : node->source(), what);
  }

 private:
  [[nodiscard]] std::string in_table() const { return name_.empty() ? "" : " in [" + name_ + "]"; }
  [[nodiscard]] std::string wrong(const std::string& key, const std::string& expected) const {
    return "\"" + key + "\"" + in_table() + " is something else, expected " + expected;
  }
  [[nodiscard]] std::string missing(const std::string& key, const std::string& expected) const {
    return "\"" + key + "\"" + in_table() + " is missing or empty, expected " + expected;
  }

  template <typename T>
  std::optional<T> value(const std::string& key, const std::string& expected) {
    asked_.insert(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    std::optional<T> found = std::is_same_v<T, double> ? node->value<T>() : node->value_exact<T>();
    if (!found) refuse(file_, node->source(), wrong(key, expected));
    return found;
  }

  const toml::table& table_;
  std::string file_;
  std::string name_;
  std::set<std::string> asked_;
};

// What is written, as C++.

std::string in_cpp(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '\n') {
      result += "\\n";
      continue;
    }
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string in_cpp(const std::vector<std::string>& texts) {
  std::string result;
  for (const std::string& one : texts) result += (result.empty() ? "" : ", ") + in_cpp(one);
  return "{" + result + "}";
}

std::string in_cpp(double value) {
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  const std::string digits(std::begin(text), end);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

std::string flag_in_cpp(bool value) {
  return value ? "true" : "false";
}

struct MadeEffect {
  std::string file;
  std::string name;
  std::int64_t rank = 0;
  std::string code;  ///< of its record
};

class EffectReader {
 public:
  EffectReader(const fs::path& path, const toml::table& table)
      : path_(path), top_(table, path.string(), "") {}

  MadeEffect read() {
    name_ = top_.text("name");
    check_name();
    MadeEffect made{path_.string(), name_, rank(), "{.entry = " + entry()};
    const std::string known_as = top_.text_or_none("known_as");
    made.code += ",\n .known_as = " + in_cpp(known_as.empty() ? name_ : known_as);
    made.code += ",\n .well_known = " + flag_in_cpp(top_.flag("well_known"));
    made.code += ",\n .common_motion = " + flag_in_cpp(top_.flag("common_motion"));
    made.code += ",\n .robot_constant = " + flag_in_cpp(top_.flag("robot_constant"));
    made.code += ",\n .former_names = " + former_names();
    made.code += ",\n .explanation = " + explanation();
    made.code += ",\n .drawing = " + drawing();
    made.code += ",\n .hidden = " + hidden() + "}";
    check_gallery();
    top_.done();
    return made;
  }

 private:
  void check_name() {
    std::string stem = name_;
    std::replace(stem.begin(), stem.end(), ' ', '-');
    if (path_.stem() == stem) return;
    top_.fail("name",
              "\"" + name_ + "\" stands in a file of another name, expected " + stem + ".toml");
  }

  std::int64_t rank() {
    const std::optional<std::int64_t> found = top_.integer("rank");
    if (!found) top_.fail("rank", "\"rank\" is missing, expected its place in the catalogue");
    return *found;
  }

  std::string entry() {
    const std::string channel = top_.text("channel");
    if (!parse_channel(channel)) {
      top_.fail("channel",
                "channel \"" + channel + "\" is unknown, expected one of " + channel_names());
    }
    const std::vector<std::string> pattern = top_.texts("pattern");
    if (pattern.empty()) top_.fail("pattern", "\"pattern\" is missing, expected a list of shapes");
    const std::string parameters = this->parameters();
    for (const std::string& one : pattern) check_shape(one);
    if (of_column_ && !usual_.empty()) {
      top_.fail("pattern", "\"pattern\" has a column ({}) and parameters, expected one of both");
    }
    return "{.name = " + in_cpp(name_) + ",\n  .channel = Channel::" + channel +
           ",\n  .pattern = " + in_cpp(pattern) + ",\n  .cause = " + in_cpp(top_.text("cause")) +
           ",\n  .remedy = " + in_cpp(top_.text("remedy")) +
           ",\n  .unit = " + in_cpp(top_.text_or_none("unit")) +
           ",\n  .detectable = " + in_cpp(top_.number("detectable").value_or(0.0)) +
           ",\n  .parameters = " + parameters + ",\n  .also_of = " + in_cpp(top_.texts("also_of")) +
           "}";
  }

  std::string parameters() {
    std::string result;
    for (Fields& one : top_.tables("parameters")) {
      const std::string name = one.text("name");
      const double usual = one.number("usual").value_or(0.0);
      usual_.push_back({name, usual});
      result += result.empty() ? "" : ", ";
      result += "{" + in_cpp(name) + ", " + in_cpp(one.text("unit")) + ", " + in_cpp(usual) + ", " +
                in_cpp(one.number("smallest").value_or(0.0)) + ", " +
                in_cpp(one.number("largest").value_or(0.0)) + "}";
      one.done();
    }
    return "{" + result + "}";
  }

  /// By the library's own reader of shapes.
  void check_shape(std::string pattern) {
    constexpr std::string_view kOpen = "{}";
    for (std::size_t at = pattern.find(kOpen); at != std::string::npos; at = pattern.find(kOpen)) {
      pattern.replace(at, kOpen.size(), "column");
      of_column_ = true;
    }
    try {
      static_cast<void>(usual_.empty() ? Shape(pattern) : Shape(pattern, usual_));
    } catch (const std::exception& error) {
      top_.fail("pattern", error.what());
    }
  }

  std::string former_names() {
    std::string result;
    for (const auto& [former, present] : top_.table("former_names").pairs()) {
      result += (result.empty() ? "{" : ", {") + in_cpp(former) + ", " + in_cpp(present) + "}";
    }
    return "{" + result + "}";
  }

  std::string explanation() {
    Fields fields = top_.table("explanation");
    const int sign = fields.sign();
    const std::string otherwise = fields.text_or_none("otherwise");
    if ((sign == 0) != otherwise.empty()) {
      fields.fail("sign", "\"sign\" and \"otherwise\" in [explanation] go together");
    }
    std::string result = "{";
    for (const char* key : {"does", "look", "drive"}) result += in_cpp(fields.text(key)) + ",\n  ";
    result += std::to_string(sign) + ", " + in_cpp(otherwise) + "}";
    fields.done();
    return result;
  }

  std::string drawing() {
    Fields fields = top_.table("drawing");
    const std::string of = fields.text_or_none("of");
    std::string result =
        "{" + in_cpp(of.empty() ? name_ : of) + ", " + in_cpp(fields.text_or_none("part")) + "}";
    fields.done();
    return result;
  }

  std::string hidden() {
    Fields fields = top_.table("hidden");
    const bool drawn = fields.text_or_none("never").empty();
    const std::vector<std::string> columns = fields.texts("columns");
    if (of_column_ && drawn && top_.number("detectable") && columns.empty()) {
      fields.fail("columns",
                  "\"columns\" in [hidden] is missing, expected what of a simulated "
                  "recording to put for {}, or why it is \"never\" drawn");
    }
    std::string result = "{.drawn = " + flag_in_cpp(drawn) +
                         ", .needs_survey = " + flag_in_cpp(fields.flag("needs_survey")) +
                         ", .needs_compass = " + flag_in_cpp(fields.flag("needs_compass")) +
                         ", .sign = " + std::to_string(fields.sign()) +
                         ", .columns = " + in_cpp(columns) + "}";
    fields.done();
    return result;
  }

  /// Which docs/site/gallery.py reads.
  void check_gallery() {
    Fields fields = top_.table("gallery");
    for (const char* key : {"group", "happens", "look"}) static_cast<void>(fields.text(key));
    if (!fields.text("effect").starts_with(name_)) {
      fields.fail("effect",
                  "\"effect\" in [gallery] is another, expected " + name_ + "=COEFFICIENTS");
    }
    for (const char* key : {"recording", "drive"}) static_cast<void>(fields.text_or_none(key));
    fields.done();
  }

  fs::path path_;
  Fields top_;
  std::string name_;
  std::vector<ShapeParameter> usual_;
  bool of_column_ = false;
};

MadeEffect read_effect(const fs::path& path) {
  try {
    const toml::table table = toml::parse_file(path.string());
    return EffectReader(path, table).read();
  } catch (const toml::parse_error& error) {
    refuse(path.string(), error.source(), std::string(error.description()));
  }
}

/// By their ranks, of which each has its own.
std::vector<MadeEffect> read_all(const std::vector<fs::path>& paths) {
  std::vector<MadeEffect> effects;
  effects.reserve(paths.size());
  for (const fs::path& one : paths) effects.push_back(read_effect(one));
  std::sort(effects.begin(), effects.end(),
            [](const MadeEffect& a, const MadeEffect& b) { return a.rank < b.rank; });
  for (std::size_t k = 1; k < effects.size(); ++k) {
    if (effects[k].rank != effects[k - 1].rank) continue;
    throw std::runtime_error(effects[k].file + ": rank " + std::to_string(effects[k].rank) +
                             " is that of \"" + effects[k - 1].name + "\" already");
  }
  return effects;
}

std::string source_of(const std::vector<MadeEffect>& effects) {
  std::string text =
      "// Made of src/effects/catalogue by trussmap_catalogue_maker.\n"
      "#include \"effects/catalogue_record.hpp\"\n\n"
      "namespace trussmap::effects {\n\n"
      "const std::vector<CatalogueRecord>& catalogue_records() {\n"
      "  static const std::vector<CatalogueRecord> records{\n";
  for (const MadeEffect& one : effects) text += one.code + ",\n";
  return text + "  };\n  return records;\n}\n\n}  // namespace trussmap::effects\n";
}

}  // namespace
}  // namespace trussmap::effects

int main(int count, char** arguments) {
  try {
    if (count < 3)
      throw std::runtime_error("usage: trussmap_catalogue_maker OUT.cpp FILE.toml ...");
    const std::string source = trussmap::effects::source_of(
        trussmap::effects::read_all({arguments + 2, arguments + count}));
    std::ofstream out(arguments[1], std::ios::binary);
    out << source;
    if (!out.flush()) throw std::runtime_error(std::string(arguments[1]) + ": cannot be written");
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
