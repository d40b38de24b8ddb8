// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// discover.
#include "calls.hpp"
#include "diagnosis.hpp"
#include "parts.hpp"
#include "responses.hpp"
#include "results/criticism.hpp"
#include "rows.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <utility>

namespace trussmap::python {
namespace {

struct DiscoveryResult {
  DiscoveryReport report;
  Prepared input;
  Lazy<DiscoveryEvidence> evidence;
};

DiscoveryResult run_discover(const py::object& recordings, const py::object& model,
                             std::size_t most, bool stated_noise,
                             const std::vector<std::string>& without, const py::object& exclude,
                             double gate, std::optional<double> every, double level, double holdout,
                             double min_drive, double leg, const py::object& progress) {
  const Given given = python::given(recordings, model);
  SessionOptions use = use_options(without, gate, every, holdout, min_drive, leg, level);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  DiscoveryResult result;
  use.estimate_noise = !stated_noise;
  use.most_effects = most;
  CallProgress told(progress, discover_stages());
  unlocked([&] {
    told.next();
    result.input = prepared(given, use);
  });
  warn(result.input.mistakes);
  unlocked([&] {
    int step = 1;
    const auto reach = [&](int wanted) {
      if (step >= wanted) return false;
      while (step < wanted) {
        told.next();
        ++step;
      }
      return true;
    };
    const auto tell = [&](const DiscoveryStage& stage) {
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
    result.report = discover(*result.input.session, tell);
  });
  told.end();
  return result;
}

RobotConstants constants(const DiscoveryResult& self) {
  return self.report.constants;
}

std::string text(const DiscoveryResult& self) {
  return discovery_text(self.report.found, self.input.model().noise, self.report.noise_budget) +
         constants_text(constants(self)) + notes_text(self.input.notes());
}

const DiscoveryEvidence& evidence(const DiscoveryResult& self) {
  return self.evidence.get([&] {
    return evidence_of(self.input.recordings(), self.report.found,
                       diagnose_options(self.input.session->options));
  });
}

Page page(const DiscoveryResult& self) {
  return with_drive(
      with_constants(discovery_page(self.report.found, evidence(self), self.input.subject),
                     constants(self)),
      self.input.model().robot, self.input.recordings());
}

std::optional<NextCommand> next(const DiscoveryResult& self) {
  return next_command(self.report.found, true);
}

py::list table(const DiscoveryResult& self, const std::string& what) {
  if (what == "steps") return table_of(self.report.found.steps);
  if (what == "effects") return table_of(self.report.found.found.effects);
  no_table(what, {"steps", "effects"});
}

/// The diagnosis of the model given, or of the one found.
DiagnosisResult diagnosis_of(const DiscoveryResult& self, const Diagnosis& diagnosis,
                             const ModelFit& fit) {
  DiagnosisResult result;
  result.report.found = diagnosis;
  result.report.fit = fit;
  result.report.noise_budget = self.report.noise_budget;
  result.report.constants = with_velocity_variances(robot_constants(diagnosis, fit.model),
                                                    self.input.recordings(), fit.model);
  result.model = fit.model;
  result.input = self.input;
  return result;
}

void add_rows(py::module_& module) {
  RowClass<DiscoveryStep>(module, "DiscoveryStep");
}

}  // namespace

void add_discovery(py::module_& module) {
  add_rows(module);
  py::class_<DiscoveryResult> type(module, "Discovery",
                                   "Effects diagnosed, added and fitted for as long as that is "
                                   "justified.");
  show(type, text, page);
  show_next(type, next);
  show_constants(type, constants);
  show_responses(
      type, evidence,
      "What these recordings show of each effect found, then errors against what they still go "
      "with most: bins and curves.");
  add_fields<DiscoveryResult, Discovery>(
      type, results::kDescribed<Discovery>,
      [](const DiscoveryResult& self) -> const Discovery& { return self.report.found; });
  type.def_property_readonly(
      "noise_budget",
      [](const DiscoveryResult& self) { return to_python(self.report.noise_budget); },
      "What dead reckoning owes to each source of noise, a dict per horizon (0: a leg).");
  type.def_property_readonly(
          "consistent", [](const DiscoveryResult& self) { return self.report.found.consistent; },
          doc("Discovery.consistent"))
      .def_property_readonly(
          "model", [](const DiscoveryResult& self) { return self.report.found.found.model; },
          "The model found, fitted.")
      .def_property_readonly(
          "first",
          [](const DiscoveryResult& self) {
            return diagnosis_of(self, self.report.found.first, self.report.found.given);
          },
          doc("Discovery.first"))
      .def_property_readonly(
          "last",
          [](const DiscoveryResult& self) {
            return diagnosis_of(self, self.report.found.last, self.report.found.found);
          },
          doc("Discovery.last"))
      .def_property_readonly(
          "notes", [](const DiscoveryResult& self) { return self.input.notes(); },
          doc("PreparedRecordings.notes"))
      .def("table", table, py::arg("what") = "steps", "A list of dicts: steps or effects.")
      .def("__repr__", [](const DiscoveryResult& self) {
        return "<trussmap.Discovery: " + verdict_in_words(self.report.found) + ">";
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
