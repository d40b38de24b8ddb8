// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Model and Effect, and the catalogue of effects.
#include "docs.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "results/catalogue.hpp"
#include "rows.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/wording.hpp"

#include <cmath>
#include <map>
#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

struct NoiseKey {
  const char* name;
  double Noise::*member;
};

/// As a model file's [noise] has them.
constexpr NoiseKey kNoise[] = {{"left", &Noise::left},
                               {"right", &Noise::right},
                               {"compass", &Noise::compass},
                               {"sighting", &Noise::sighting},
                               {"range", &Noise::range},
                               {"bearing", &Noise::bearing},
                               {"survey", &Noise::survey},
                               {"truth", &Noise::truth},
                               {"truth_heading", &Noise::truth_heading},
                               {"range_relative", &Noise::range_relative},
                               {"heading_per_s", &Noise::heading_per_s},
                               {"heading_per_rad", &Noise::heading_per_rad},
                               {"travel_per_s", &Noise::travel_per_s},
                               {"gyro", &Noise::gyro},
                               {"fix", &Noise::fix},
                               {"loop", &Noise::loop},
                               {"loop_heading", &Noise::loop_heading},
                               {"steer", &Noise::steer},
                               {"yaw", &Noise::yaw}};

using Sds = std::map<std::string, double>;

void set_noise(Noise& noise, const Sds& sds) {
  for (const auto& [name, sd] : sds) {
    double Noise::*member = nullptr;
    std::string names;
    for (const NoiseKey& key : kNoise) {
      if (name == key.name) member = key.member;
      names += (names.empty() ? "" : ", ") + std::string(key.name);
    }
    if (member == nullptr) {
      throw py::value_error("noise: \"" + name + "\" is unknown, expected one of " + names);
    }
    if (!(sd >= 0.0) || !std::isfinite(sd)) {
      throw py::value_error("noise: " + name + " is " + std::to_string(sd) +
                            ", expected 0 or more");
    }
    noise.*member = sd;
  }
}

py::dict noise_of(const Model& model) {
  py::dict sds;
  for (const NoiseKey& key : kNoise) sds[key.name] = model.noise.*key.member;
  return sds;
}

Effect make_effect(const std::string& name, std::vector<double> coefficients,
                   const std::optional<std::string>& channel, const py::object& shape,
                   bool per_session) {
  if (channel.has_value() == shape.is_none()) {
    throw py::value_error(
        "effect: channel and shape go together, expected both or a catalogue name alone");
  }
  Effect effect;
  if (!channel) {
    effect = catalogue_effect(name);
  } else {
    effect.channel = channel_named(*channel);
    if (py::isinstance<py::str>(shape)) {
      effect.shape.emplace_back(shape.cast<std::string>());
    } else {
      for (const std::string& one : shape.cast<std::vector<std::string>>()) {
        effect.shape.emplace_back(one);
      }
    }
    if (effect.shape.empty()) throw py::value_error("effect: expected a shape, or several");
  }
  effect.name = name;
  const std::size_t shapes = effect.shape.size();
  const bool fits = per_session ? coefficients.size() % shapes == 0
                                : coefficients.empty() || coefficients.size() == shapes;
  if (!fits) {
    throw py::value_error("effect \"" + name + "\" has " + std::to_string(coefficients.size()) +
                          " coefficients, expected " + std::to_string(shapes) + ", one per shape" +
                          (per_session ? ", per session" : ""));
  }
  effect.coefficients = std::move(coefficients);
  effect.per_session = per_session;
  return effect;
}

/// One by its name, or as it is.
Effect effect_of(py::handle value) {
  if (py::isinstance<Effect>(value)) return value.cast<Effect>();
  if (py::isinstance<py::str>(value)) return catalogue_effect(value.cast<std::string>());
  throw py::type_error("effect: expected an Effect, or a name of the catalogue");
}

bool same(const Effect& a, const Effect& b) {
  return a.name == b.name && a.channel == b.channel && a.shape == b.shape &&
         a.coefficients == b.coefficients && a.per_session == b.per_session;
}

Model with_effect(Model model, const py::object& added) {
  Effect effect = effect_of(added);
  for (const Effect& one : model.effects) {
    if (one.name == effect.name) {
      throw py::value_error("the model has an effect \"" + effect.name +
                            "\" already, expected another name");
    }
  }
  model.effects.push_back(std::move(effect));
  return model;
}

Model make_model(double wheelbase, const std::string& drive,
                 const std::optional<std::vector<std::string>>& columns, double length,
                 const Sds& noise, const py::iterable& effects) {
  const DriveKind kind = drive_named(drive);
  if (!(wheelbase > 0.0)) throw py::value_error("wheelbase: expected more than 0 metres");
  if (!(length >= 0.0)) throw py::value_error("length: expected more than 0 metres");
  Model model;
  model.robot.wheelbase = wheelbase;
  if (kind != DriveKind::differential) model.robot = usual_robot(kind, wheelbase, length);
  if (columns) model.robot.columns = *columns;
  set_noise(model.noise, noise);
  for (const py::handle one : effects) {
    model = with_effect(std::move(model), py::reinterpret_borrow<py::object>(one));
  }
  return model;
}

std::string repr(const Effect& effect) {
  std::string text = "<trussmap.Effect \"" + effect.name + "\": " + formula_of(effect);
  for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
    text += (k == 0 ? " = " : ", ") + std::string(py::repr(py::float_(effect.coefficients[k])));
  }
  return text + ">";
}

std::string repr(const Model& model) {
  std::string text = "<trussmap.Model: " + std::string(name_of(model.robot.drive));
  text += ", wheelbase " + std::string(py::repr(py::float_(model.robot.wheelbase))) + " m";
  for (const Effect& one : model.effects) text += ", " + one.name;
  return text + ">";
}

void add_effect(py::module_& module) {
  py::class_<Effect>(module, "Effect",
                     doc("Effect(\"hard iron\", [0.02, -0.01]) is one of the catalogue; with a "
                         "channel and a shape "
                         "(an expression over a row's variables, or several) it is your own.",
                         "Effect")
                         .c_str())
      .def(py::init(&make_effect), py::arg("name"), py::arg("coefficients") = std::vector<double>(),
           py::kw_only(), py::arg("channel") = py::none(), py::arg("shape") = py::none(),
           py::arg("per_session") = false)
      .def_readonly("name", &Effect::name, "As the catalogue, or its user, calls it.")
      .def_property_readonly(
          "channel", [](const Effect& self) { return std::string(name_of(self.channel)); },
          "Where it acts.")
      .def_property_readonly(
          "shape", [](const Effect& self) { return texts_of(self.shape); },
          "What it goes with: an expression per coefficient.")
      .def_readonly("coefficients", &Effect::coefficients, doc("Effect.coefficients"))
      .def_readonly("per_session", &Effect::per_session, doc("Effect.per_session"))
      .def_property_readonly(
          "formula", [](const Effect& self) { return formula_of(self); }, doc("formula_of"))
      .def(
          "in_words",
          [](const Effect& self, std::vector<double> sd) {
            if (self.coefficients.empty()) return formula_of(self) + ", not fitted";
            sd.resize(self.coefficients.size());
            return in_words(self, sd);
          },
          py::arg("sd") = std::vector<double>(),
          "What it does to the robot, in words; `sd`: the coefficients' standard errors, SI units.")
      .def("__eq__", same, py::is_operator())
      .def("__hash__", [](const Effect& self) { return py::hash(py::str(self.name)); })
      .def("__str__",
           [](const Effect& self) {
             return self.name + ": " +
                    (self.coefficients.empty()
                         ? formula_of(self)
                         : in_words(self, std::vector<double>(self.coefficients.size())));
           })
      .def("__repr__", [](const Effect& self) { return repr(self); });
  RowClass<CatalogueEntry>(module, "CatalogueEntry");
  module.def(
      "catalogue", [] { return py::tuple(py::cast(catalogue())); },
      "The named physical effects: channel and shape, what causes each and what helps.");
}

}  // namespace

void add_models(py::module_& module) {
  add_effect(module);
  py::class_<Model>(
      module, "Model",
      "What is believed of a robot: its geometry, its noise and the effects in its odometry. It "
      "does not change; with_effect and with_noise make another one.\n\n"
      "`noise`: standard deviations by the names that [noise] of a model file has "
      "(docs/formats.md); what is absent keeps its default. `columns`: of the drive that are the "
      "wheels, of other drives than two wheels. `length` as docs/formats.md has it.")
      .def(py::init(&make_model), py::arg("wheelbase") = Robot().wheelbase, py::kw_only(),
           py::arg("drive") = "differential", py::arg("columns") = py::none(),
           py::arg("length") = 0.0, py::arg("noise") = Sds(), py::arg("effects") = py::tuple())
      .def_static(
          "read", [](const fs::path& file) { return read_model(file); }, py::arg("file"),
          doc("read_model"))
      .def(
          "write", [](const Model& self, const fs::path& file) { write_model(file, self); },
          py::arg("file"), doc("format_model"))
      .def_property_readonly(
          "wheelbase", [](const Model& self) { return self.robot.wheelbase; }, "m, nominal.")
      .def_property_readonly(
          "drive", [](const Model& self) { return std::string(name_of(self.robot.drive)); },
          "How wheels move the body: differential, tricycle, ...")
      .def_property_readonly(
          "columns", [](const Model& self) { return self.robot.columns; }, doc("Robot.columns"))
      .def_property_readonly(
          "length", [](const Model& self) { return self.robot.length; }, doc("Robot.length"))
      .def_property_readonly("noise", noise_of, "Standard deviations by name.")
      .def_property_readonly(
          "effects", [](const Model& self) { return py::tuple(py::cast(self.effects)); },
          doc("Model.effects"))
      .def("with_effect", with_effect, py::arg("effect"),
           "The model with one more effect: an Effect, or a name of the catalogue.")
      .def(
          "without_effect",
          [](Model self, const std::string& name) {
            if (std::erase_if(self.effects, [&](const Effect& one) { return one.name == name; }) ==
                0) {
              std::string names;
              for (const Effect& one : self.effects) {
                names += (names.empty() ? "" : ", ") + ("\"" + one.name + "\"");
              }
              throw py::value_error("the model has no effect \"" + name + "\", expected " +
                                    (names.empty() ? "none: it has no effects" : names));
            }
            return self;
          },
          py::arg("name"), "The model without the effect of this name.")
      .def(
          "with_noise",
          [](Model self, const py::kwargs& sds) {
            set_noise(self.noise, sds.cast<Sds>());
            return self;
          },
          "The model with these standard deviations: with_noise(left=0.004, right=0.004).")
      .def(
          "__eq__",
          [](const Model& a, const Model& b) { return format_model(a) == format_model(b); },
          py::is_operator())
      .def("__hash__", [](const Model& self) { return py::hash(py::str(format_model(self))); })
      .def("__str__", [](const Model& self) { return for_print(format_model(self)); })
      .def("__repr__", [](const Model& self) { return repr(self); });
}

}  // namespace trussmap::python
