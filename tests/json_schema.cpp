// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "json_schema.hpp"

#include "scratch_folder.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace trussmap::testing {
namespace {

using nlohmann::json;

/// A call's words, as a shell parts them where nothing but spaces and quotes matters.
std::vector<std::string> words_of(const std::string& arguments) {
  std::vector<std::string> words;
  std::string word;
  char quote = 0;
  bool quoted = false;
  for (const char c : arguments + " ") {
    if (quote != 0) {
      if (c == quote)
        quote = 0;
      else
        word += c;
    } else if (c == '"' || c == '\'') {
      quote = c;
      quoted = true;
    } else if (c != ' ') {
      word += c;
    } else if (!word.empty() || quoted) {
      words.push_back(std::move(word));
      word.clear();
      quoted = false;
    }
  }
  return words;
}

/// The value of --NAME VALUE or --NAME=VALUE; empty: it is not given.
std::string option_of(const std::vector<std::string>& words, const std::string& name) {
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == name && k + 1 < words.size()) return words[k + 1];
    if (words[k].starts_with(name + "=")) return words[k].substr(name.size() + 1);
  }
  return "";
}

const json& whole_schema() {
  static const json schema = json::parse(run_trussmap("schema").output);
  return schema;
}

json resolved(const json& schema) {
  const auto ref = schema.find("$ref");
  if (ref == schema.end()) return schema;
  return resolved(whole_schema().at(json::json_pointer(ref->get<std::string>().substr(1))));
}

/// All schemas that speak of the same value: those of allOf and anyOf as well.
std::vector<json> with_parts(const json& schema) {
  const json top = resolved(schema);
  std::vector<json> all{top};
  for (const char* kind : {"allOf", "anyOf"}) {
    for (const json& part : top.value(kind, json::array())) {
      for (json& each : with_parts(part)) all.push_back(std::move(each));
    }
  }
  return all;
}

/// Keys that no schema of the value has: a reader of the schema would not know of them.
void find_undescribed(const json& value, const json& schema, const std::string& at,
                      std::vector<std::string>& found) {
  const std::vector<json> schemas = with_parts(schema);
  const auto first_with = [&schemas](const auto& of) {
    for (const json& one : schemas) {
      if (json part = of(one); !part.is_null()) return part;
    }
    return json();
  };
  if (value.is_array()) {
    const json items = first_with([](const json& one) { return one.value("items", json()); });
    for (std::size_t k = 0; k < value.size() && !items.is_null(); ++k) {
      find_undescribed(value[k], items, text::joined(at, "/", k), found);
    }
  }
  if (!value.is_object()) return;
  for (const auto& [key, each] : value.items()) {
    const json member = first_with([&key = key](const json& one) {
      return one.value("properties", json::object())
          .value(key, one.value("additionalProperties", json()));
    });
    if (member.is_null())
      found.push_back(text::joined(at, "/", key, " is not in the schema"));
    else
      find_undescribed(each, member, text::joined(at, "/", key), found);
  }
}

}  // namespace

std::filesystem::path json_file_of(const std::string& arguments) {
  return option_of(words_of(arguments), "--json");
}

std::string definition_for(const std::string& arguments) {
  const std::vector<std::string> words = words_of(arguments);
  if (words.empty()) return "";
  if (words[0] == "fleet") return "fleet-report";
  if (words[0] == "build" && !option_of(words, "--store").empty()) return "build-store";
  const std::string solver = option_of(words, "--solver");
  if (words[0] == "adjust" && !solver.empty() && solver != "frontal") return "adjust-solver";
  return words[0];
}

std::vector<std::string> against_schema(const json& written, const std::string& definition) {
  if (!whole_schema().at("definitions").contains(definition)) {
    return {"the schema has no definition " + definition};
  }
  json root = whole_schema();
  root["allOf"] = json::array({{{"$ref", "#/definitions/" + definition}}});
  valijson::Schema schema;
  valijson::SchemaParser parser;
  const valijson::adapters::NlohmannJsonAdapter root_adapter(root);
  parser.populateSchema(root_adapter, schema);
  valijson::ValidationResults results;
  valijson::Validator validator;
  const valijson::adapters::NlohmannJsonAdapter target(written);
  std::vector<std::string> wrong;
  if (!validator.validate(schema, target, &results)) {
    valijson::ValidationResults::Error error;
    while (results.popError(error)) {
      std::string at;
      for (const std::string& part : error.context) at += part;
      wrong.push_back(at + ": " + error.description);
    }
  }
  find_undescribed(written, {{"$ref", "#/definitions/" + definition}}, "", wrong);
  return wrong;
}

}  // namespace trussmap::testing
