// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/model_toml.hpp"

#include "effects/channel_physics.hpp"
#include "io/model_sections.hpp"
#include "io/toml_text.hpp"
#include "text/plain_text.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/write_files.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
using namespace io;

namespace {

Shape read_shape(const toml::node& node, const std::string& effect) {
  const std::string expression = toml_words(node, "a shape");
  if (expression.find_first_not_of(" \t") == std::string::npos) {
    refuse(node.source(), "effect \"" + effect + "\" has an empty shape, expected an expression");
  }
  return told(node, "effect \"" + effect + "\": ", [&] { return Shape(expression); });
}

/// The effect with the catalogue's channel and shapes where the file has none.
Effect spelt_out(const toml::table& table) {
  const toml::node* named = table.get("name");
  const std::string name = named == nullptr ? "" : toml_words(*named, "name");
  if (!text::is_plain_text(name)) {
    refuse(named->source(), "name holds a control character, expected printable text");
  }
  if (name.empty()) refuse(table.source(), "an effect has no name, expected name = \"...\"");
  const toml::node* channel = table.get("channel");
  const toml::node* shape = table.get("shape");
  Effect effect;
  std::vector<double> coefficients;
  for (const auto& entry : table) {
    const toml::key& key = entry.first;
    const toml::node& node = entry.second;
    if (key == "channel") {
      effect.channel = told(node, "effect \"" + name + "\": ", [&] {
        return channel_named(toml_words(node, "channel"));
      });
    } else if (key == "shape") {
      for (const toml::node& one : toml_list(node, "shape")) {
        effect.shape.push_back(read_shape(one, name));
      }
    } else if (key == "coefficients") {
      for (const toml::node& value : toml_list(node, "coefficients")) {
        coefficients.push_back(toml_figure(value, "a coefficient"));
      }
    } else if (key == "per") {
      if (toml_words(node, "per") != "session") {
        refuse(node.source(), "per is \"" + toml_words(node, "per") + "\", expected \"session\"");
      }
      effect.per_session = true;
    } else if (key != "name") {
      refuse(key.source(), "key \"" + std::string(key.str()) +
                               "\" in [[effect]] is unknown, expected name, channel, shape, "
                               "coefficients or per");
    }
  }
  if ((channel == nullptr) != (shape == nullptr)) {
    refuse(table.source(),
           "effect \"" + name + "\" has a " +
               (shape == nullptr ? "channel but no shape" : "shape but no channel") +
               ", expected both or neither");
  }
  if (shape == nullptr) {
    const Effect known = told(table, "", [&] { return catalogue_effect(name); });
    effect.channel = known.channel;
    effect.shape = known.shape;
  } else if (effect.shape.empty()) {
    refuse(shape->source(), "effect \"" + name + "\" has no shape, expected one or more");
  }
  effect.name = name;
  effect.coefficients = std::move(coefficients);
  // What can still be wrong with it is most likely its formula.
  effect.line = static_cast<int>((shape != nullptr ? *shape : table).source().begin.line);
  return effect;
}

Effect read_effect(const toml::table& table) {
  Effect effect = spelt_out(table);
  const std::size_t shapes = effect.shape.size();
  const std::size_t coefficients = effect.coefficients.size();
  const bool fits =
      effect.per_session ? coefficients % shapes == 0 : coefficients == 0 || coefficients == shapes;
  if (!fits) {
    refuse(table.get("coefficients")->source(),
           "effect \"" + effect.name + "\" has " + std::to_string(coefficients) +
               " coefficients, expected " + std::to_string(shapes) + ", one per shape" +
               (effect.per_session ? ", per session" : ""));
  }
  return effect;
}

std::string effect_text(const Effect& effect) {
  std::string text = "\n[[effect]]\nname = " + toml_string(effect.name) + "\n";
  text += "channel = " + toml_string(std::string(name_of(effect.channel))) + "\nshape = [";
  for (std::size_t k = 0; k < effect.shape.size(); ++k) {
    text += (k == 0 ? "" : ", ") + toml_string(effect.shape[k].text());
  }
  text += "]\n";
  if (!effect.coefficients.empty()) {
    text += "coefficients = [";
    for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
      text += (k == 0 ? "" : ", ") + toml_number(effect.coefficients[k]);
    }
    text += "]\n";
  }
  if (effect.per_session) text += "per = \"session\"\n";
  return text;
}

Model read_sections(const toml::table& root) {
  Model model;
  model.robot.wheelbase_stated = false;
  for (const auto& [key, node] : root) {
    if (key == "robot") {
      model.robot = read_robot(toml_table(node, "robot"));
    } else if (key == "noise") {
      model.noise = read_noise(toml_table(node, "noise"));
    } else if (key == "effect") {
      for (const toml::node& one : toml_tables(node, "effect", "[[effect]]")) {
        model.effects.push_back(read_effect(*one.as_table()));
      }
    } else {
      refuse(key.source(),
             "key \"" + std::string(key.str()) + "\" is unknown, expected robot, noise or effect");
    }
  }
  return model;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::io {

namespace {

void require_of_its_drive(const Model& model, const std::string& file) {
  for (const Effect& effect : model.effects) {
    try {
      effects::require_of_drive(effect, model.robot);
    } catch (const std::invalid_argument& error) {
      throw InputError(file, effect.line, error.what());
    }
  }
}

/// Its effects may be of any drive.
Model sections_of(const toml::table& root, const std::string& file) {
  try {
    return read_sections(root);
  } catch (const TomlFault& fault) {
    throw InputError(file, fault.line, fault.what);
  }
}

Model sections_from_text(const std::string& text, const std::string& file) {
  try {
    return sections_of(toml::parse(text), file);
  } catch (const toml::parse_error& error) {
    throw InputError(file, error.source().begin.line, toml_fault(error));
  } catch (const TomlAssertion&) {
    throw InputError(file, 0, "no TOML: keys or values are malformed");
  }
}

}  // namespace

Model model_of(const toml::table& root, const std::string& file) {
  Model model = sections_of(root, file);
  require_of_its_drive(model, file);
  return model;
}

Model model_from_text(const std::string& text, const std::string& file) {
  Model model = sections_from_text(text, file);
  require_of_its_drive(model, file);
  return model;
}

}  // namespace trussmap::io

namespace trussmap {

Model read_model(const std::filesystem::path& file) {
  return model_from_text(read_file(file), file.string());
}

std::vector<Effect> read_effects(const std::filesystem::path& file) {
  return sections_from_text(read_file(file), file.string()).effects;
}

std::string format_model(const Model& model) {
  std::string text = robot_text(model.robot) + "\n" + noise_text(model);
  for (const Effect& effect : model.effects) text += effect_text(effect);
  return text;
}

void write_model(const std::filesystem::path& file, const Model& model) {
  write_file(file, format_model(model));
}

}  // namespace trussmap
