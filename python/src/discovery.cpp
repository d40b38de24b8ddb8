// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// discover.
#include "calls.hpp"
#include "diagnosis.hpp"
#include "parts.hpp"
#include "responses.hpp"
#include "rows.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <utility>

namespace trussmap::python {
namespace {

struct DiscoveryResult {
  Discovery found;
  std::vector<NoiseBudget> budget;
  Prepared input;
  DiagnoseOptions how;
  Lazy<DiscoveryEvidence> evidence;
};

DiscoveryResult run_discover(const py::object& recordings, const py::object& model,
                             std::size_t most, bool stated_noise,
                             const std::vector<std::string>& without, const py::object& exclude,
                             double gate, std::optional<double> every, double level, double holdout,
                             double min_drive, double leg, const py::object& progress) {
  const Given given = python::given(recordings, model);
  UseOptions use = use_options(without, gate, every, holdout, min_drive, leg, level);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  DiscoveryResult result;
  result.how.fit = use.fit;
  result.how.legs = use.legs;
  result.how.level = use.level;
  result.how.estimate_noise = !stated_noise;
  // As if one effect were found.
  CallProgress told(progress, {{"reading", 0.5},
                               {"fitting the model given", 2.5},
                               {"looking for what is missing", 50},
                               {"fitting an effect", 20},
                               {"looking for what is missing", 50}});
  unlocked([&] {
    told.next();
    result.input = prepared(given, use);
  });
  warn(result.input.mistakes);
  unlocked([&] {
    DiscoverOptions how;
    how.diagnosis = result.how;
    how.most_effects = most;
    int step = 1;
    const auto reach = [&](int wanted) {
      if (step >= wanted) return false;
      while (step < wanted) {
        told.next();
        ++step;
      }
      return true;
    };
    how.progress = [&](const DiscoveryStage& stage) {
      switch (stage.kind) {
        case DiscoveryStage::Kind::fitting_given:
          reach(2);
          break;
        case DiscoveryStage::Kind::searching:
          if (!reach(step < 4 ? 3 : 5)) told.say("looking for what is missing");
          break;
        case DiscoveryStage::Kind::fitting_effect:
          reach(4);
          told.say("fitting \"" + stage.effect + "\"");
      }
    };
    result.found = discover(*result.input.rows, result.input.model, how);
    take_rows(result.input);
    result.budget = noise_budget(*result.input.recordings, result.found.found.model);
  });
  told.end();
  return result;
}

RobotConstants constants(const DiscoveryResult& self) {
  return with_velocity_variances(robot_constants(self.found, self.input.model),
                                 *self.input.recordings, self.found.found.model);
}

std::string text(const DiscoveryResult& self) {
  return discovery_text(self.found, self.input.model.noise, self.budget) +
         constants_text(constants(self)) + notes_text(self.input.notes);
}

const DiscoveryEvidence& evidence(const DiscoveryResult& self) {
  return self.evidence.get(
      [&] { return evidence_of(*self.input.recordings, self.found, self.how); });
}

Page page(const DiscoveryResult& self) {
  return with_drive(with_constants(discovery_page(self.found, evidence(self), self.input.subject),
                                   constants(self)),
                    self.input.model.robot, *self.input.recordings);
}

py::list table(const DiscoveryResult& self, const std::string& what) {
  if (what == "steps") return table_of(self.found.steps);
  if (what == "effects") return table_of(self.found.found.effects);
  no_table(what, {"steps", "effects"});
}

/// The diagnosis of the model given, or of the one found.
DiagnosisResult diagnosis_of(const DiscoveryResult& self, const Diagnosis& diagnosis,
                             const ModelFit& fit) {
  DiagnosisResult result;
  result.found = diagnosis;
  result.fit = fit;
  result.budget = self.budget;
  result.input = self.input;
  result.input.model = fit.model;
  result.how = self.how;
  return result;
}

void add_rows(py::module_& module) {
  RowClass<DiscoveryStep>(module, "DiscoveryStep", "DiscoveryStep")
      .field("added", &DiscoveryStep::added)
      .field("together", &DiscoveryStep::together)
      .field("dropped", &DiscoveryStep::dropped)
      .field("chi2", &DiscoveryStep::chi2)
      .field("dof", &DiscoveryStep::dof)
      .value(
          "arrival_rms", [](const DiscoveryStep& self) { return self.held_out.arrival_rms; },
          "m, of the held-out legs.")
      .value(
          "legs", [](const DiscoveryStep& self) { return self.held_out.legs.size(); },
          "How many were held out.")
      .field("reckoned_10", &DiscoveryStep::reckoned_10)
      .field("reckoned_30", &DiscoveryStep::reckoned_30)
      .field("predicted_decrease", &DiscoveryStep::predicted_decrease)
      .value(
          "predicted_rms", [](const DiscoveryStep& self) { return self.predicted.arrival_rms; },
          "m, of the held-out legs, as the diagnosis predicted it.")
      .aside("held_out", [](const DiscoveryStep& self) { return self.held_out; })
      .aside(
          "look_alikes",
          [](const DiscoveryStep& self) { return py::tuple(py::cast(self.look_alikes)); },
          "What it could be instead.");
}

}  // namespace

void add_discovery(py::module_& module) {
  add_rows(module);
  py::class_<DiscoveryResult> type(module, "Discovery",
                                   "Effects diagnosed, added and fitted for as long as that is "
                                   "justified.");
  show(type, text, page);
  show_constants(type, constants);
  show_responses(
      type, evidence,
      "What these recordings show of each effect found, then errors against what they still go "
      "with most: bins and curves.");
  type.def_property_readonly(
          "verdict",
          [](const DiscoveryResult& self) { return std::string(verdict_of(self.found)); },
          "consistent, or what is left unexplained.")
      .def_property_readonly(
          "consistent", [](const DiscoveryResult& self) { return self.found.consistent; },
          doc("Discovery.consistent"))
      .def_property_readonly(
          "model", [](const DiscoveryResult& self) { return self.found.found.model; },
          "The model found, fitted.")
      .def_property_readonly(
          "effects",
          [](const DiscoveryResult& self) { return py::tuple(py::cast(self.found.found.effects)); },
          "The effects of the model found, with standard errors.")
      .def_property_readonly(
          "steps",
          [](const DiscoveryResult& self) { return py::tuple(py::cast(self.found.steps)); },
          doc("Discovery.steps"))
      .def_property_readonly(
          "first",
          [](const DiscoveryResult& self) {
            return diagnosis_of(self, self.found.first, self.found.given);
          },
          doc("Discovery.first"))
      .def_property_readonly(
          "last",
          [](const DiscoveryResult& self) {
            return diagnosis_of(self, self.found.last, self.found.found);
          },
          doc("Discovery.last"))
      .def_property_readonly(
          "noise_budget", [](const DiscoveryResult& self) { return budget_rows(self.budget); },
          "What dead reckoning owes to each source of noise, a dict per horizon [s; 0: a leg].")
      .def_property_readonly(
          "warnings", [](const DiscoveryResult& self) { return self.found.found.warnings; },
          "In words.")
      .def_property_readonly(
          "notes", [](const DiscoveryResult& self) { return self.input.notes; },
          doc("PreparedRecordings.notes"))
      .def("table", table, py::arg("what") = "steps", "A list of dicts: steps or effects.")
      .def("__repr__", [](const DiscoveryResult& self) {
        return "<trussmap.Discovery: " + verdict_in_words(self.found) + ">";
      });
  module.def(
      "discover", run_discover, py::arg("recordings"), py::arg("model"), py::kw_only(),
      py::arg("most") = 6, py::arg("stated_noise") = false,
      py::arg("without") = std::vector<std::string>(), py::arg("exclude") = py::tuple(),
      py::arg("gate") = kModelGate, py::arg("every") = py::none(), py::arg("level") = kSignificance,
      py::arg("holdout") = LegOptions().share, py::arg("min_drive") = LegOptions().min_drive,
      py::arg("leg") = LegOptions().leg, py::arg("progress") = py::none(),
      (doc("Diagnoses, adds and fits effects, one by one, for as long as that is justified.",
           "discover") +
       kUseDoc +
       " `most`: effects that are added at most. `stated_noise`: judge by the noise that the "
       "model states, instead of estimating it.")
          .c_str());
}

}  // namespace trussmap::python
