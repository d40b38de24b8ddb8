// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// diagnose.
#include "diagnosis.hpp"

#include "calls.hpp"
#include "parts.hpp"
#include "responses.hpp"
#include "results/criticism.hpp"
#include "rows.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <utility>

namespace trussmap::python {
namespace {

DiagnosisResult run_diagnose(const py::object& recordings, const py::object& model,
                             bool stated_noise, const std::vector<std::string>& without,
                             const py::object& exclude, double gate, std::optional<double> every,
                             double level, double holdout, double min_drive, double leg,
                             std::size_t list, const py::object& progress) {
  const Given given = python::given(recordings, model);
  SessionOptions use = use_options(without, gate, every, holdout, min_drive, leg, level);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  DiagnosisResult result;
  result.list = list;
  use.estimate_noise = !stated_noise;
  CallProgress told(progress, diagnose_stages());
  unlocked([&] {
    told.next();
    result.input = prepared(given, use);
  });
  warn(result.input.mistakes);
  result.model = result.input.model();
  unlocked([&] { result.report = diagnose(*result.input.session, [&told] { told.next(); }); });
  told.end();
  return result;
}

RobotConstants constants(const DiagnosisResult& self) {
  return self.report.constants;
}

std::string text(const DiagnosisResult& self) {
  return diagnosis_text(self.report.found, self.report.noise_budget, self.list) +
         constants_text(constants(self)) + notes_text(self.input.notes());
}

const DiagnosisEvidence& evidence(const DiagnosisResult& self) {
  return self.evidence.get([&] {
    return evidence_of(self.input.recordings(), self.report.fit, self.report.found,
                       diagnose_options(self.input.session->options));
  });
}

Page page(const DiagnosisResult& self) {
  return with_drive(
      with_constants(diagnosis_page(self.report.found, evidence(self), self.input.subject),
                     constants(self)),
      self.model.robot, self.input.recordings());
}

std::optional<NextCommand> next(const DiagnosisResult& self) {
  return next_command(self.report.found);
}

py::list table(const DiagnosisResult& self, const std::string& what) {
  if (what == "candidates") return table_of(self.report.found.findings);
  if (what == "noise") {
    return self.report.found.under ? py::list(to_python(self.report.found.under->noise.sources))
                                   : py::list();
  }
  if (what == "noise laws") return table_of(self.report.found.noise);
  if (what == "outliers") return table_of(self.report.found.events);
  if (what == "unobservable") return table_of(self.report.found.unobservable);
  no_table(what, {"candidates", "noise", "noise laws", "outliers", "unobservable"});
}

void add_rows(py::module_& module) {
  RowClass<LookAlike>(module, "LookAlike")
      .value(
          "told_apart", [](const LookAlike& self) { return self.told_apart(); },
          "Whether all measurements together tell the two apart.");
  RowClass<Finding>(module, "Finding")
      .value(
          "formula", [](const Finding& self) { return formula_of(self.effect); },
          "\"compass x sin(heading), cos(heading)\".")
      .value(
          "status_in_words", [](const Finding& self) { return status_in_words(self); },
          doc("status_in_words"))
      .field("catalogue", &Finding::catalogue)
      .field("joint", &Finding::joint)
      .field("joint_sd", &Finding::joint_sd)
      .value(
          "in_words", [](const Finding& self) { return in_words(self); },
          "What it is, in a sentence.");
  RowClass<Unobservable>(module, "Unobservable");
  RowClass<NoiseTest>(module, "NoiseTest");
  RowClass<EventTest>(module, "EventTest").field("size", &EventTest::size);
}

py::tuple missing_findings(const DiagnosisResult& self) {
  std::vector<Finding> missing = self.report.found.findings;
  std::erase_if(missing, [](const Finding& one) { return one.status != Status::missing; });
  return py::tuple(py::cast(missing));
}

/// The model with the effects that are missing, none of them fitted yet.
Model completed(const DiagnosisResult& self) {
  Model model = self.model;
  for (const Finding& one : self.report.found.findings) {
    if (one.status != Status::missing) continue;
    model.effects.push_back(one.effect);
    model.effects.back().coefficients.clear();
  }
  return model;
}

}  // namespace

void add_diagnosis(py::module_& module) {
  add_rows(module);
  py::class_<DiagnosisResult> type(module, "Diagnosis", "Which physical effect is missing?");
  show(type, text, page);
  show_next(type, next);
  show_constants(type, constants);
  show_responses(
      type, evidence,
      "What these recordings show of each effect that is missing, then errors against what "
      "they "
      "go with most: bins and curves.");
  add_fields<DiagnosisResult, Diagnosis>(
      type, results::kDescribed<Diagnosis>,
      [](const DiagnosisResult& self) -> const Diagnosis& { return self.report.found; });
  type.def_property_readonly("missing_findings", missing_findings,
                             "All that is missing: `joint` and `joint_sd` are their sizes with all "
                             "of them added.")
      .def_property_readonly(
          "with_missing",
          [](const DiagnosisResult& self) { return self.report.found.with_missing; },
          doc("Diagnosis.with_missing"))
      .def_property_readonly(
          "noise_budget",
          [](const DiagnosisResult& self) { return to_python(self.report.noise_budget); },
          "What dead reckoning owes to each source of noise, a dict per horizon (0: a leg).")
      .def_property_readonly(
          "notes", [](const DiagnosisResult& self) { return self.input.notes(); },
          doc("PreparedRecordings.notes"))
      .def_property_readonly("model", completed,
                             "The model with the effects that are missing, to be fitted.")
      .def("table", table, py::arg("what") = "candidates",
           "A list of dicts: candidates, noise, noise laws, outliers or unobservable.")
      .def("__repr__", [](const DiagnosisResult& self) {
        return "<trussmap.Diagnosis: " + verdict_in_words(self.report.found) + ">";
      });
  module.def(
      "diagnose", run_diagnose, py::arg("recordings"), py::arg("model"), py::kw_only(),
      py::arg("stated_noise") = false, py::arg("without") = std::vector<std::string>(),
      py::arg("exclude") = py::tuple(), py::arg("gate") = kModelGate, py::arg("every") = py::none(),
      py::arg("level") = kSignificance, py::arg("holdout") = LegOptions().share,
      py::arg("min_drive") = LegOptions().min_drive, py::arg("leg") = LegOptions().leg,
      py::arg("list") = 8, py::arg("progress") = py::none(),
      (doc("Which physical effect is a model missing?", "diagnose") + kUseDoc +
       " `stated_noise`: judge by the noise that the model states, instead of estimating it. "
       "`list`: candidates that are printed.")
          .c_str());
}

}  // namespace trussmap::python
