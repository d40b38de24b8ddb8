// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// diagnose.
#include "diagnosis.hpp"

#include "calls.hpp"
#include "parts.hpp"
#include "responses.hpp"
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
  UseOptions use = use_options(without, gate, every, holdout, min_drive, leg, level);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  DiagnosisResult result;
  result.list = list;
  result.how.fit = use.fit;
  result.how.legs = use.legs;
  result.how.level = use.level;
  result.how.estimate_noise = !stated_noise;
  CallProgress told(
      progress, {{"reading", 0.5}, {"fitting the map", 2.5}, {"looking for what is missing", 50}});
  unlocked([&] {
    told.next();
    result.input = prepared(given, use);
  });
  warn(result.input.mistakes);
  unlocked([&] {
    const std::vector<DrivenRecording>& used = *result.input.recordings;
    told.next();
    result.fit = fit_model(used, result.input.model, result.how.fit);
    told.next();
    result.found = diagnose(*result.input.rows, result.fit, result.how);
    take_rows(result.input);
    result.budget =
        noise_budget(*result.input.recordings,
                     result.found.under ? result.found.under->fit.model : result.fit.model);
  });
  told.end();
  return result;
}

RobotConstants constants(const DiagnosisResult& self) {
  return with_velocity_variances(robot_constants(self.found, self.fit.model),
                                 *self.input.recordings, self.fit.model);
}

std::string text(const DiagnosisResult& self) {
  return diagnosis_text(self.found, self.budget, self.list) + constants_text(constants(self)) +
         notes_text(self.input.notes);
}

const DiagnosisEvidence& evidence(const DiagnosisResult& self) {
  return self.evidence.get(
      [&] { return evidence_of(*self.input.recordings, self.fit, self.found, self.how); });
}

Page page(const DiagnosisResult& self) {
  return with_drive(with_constants(diagnosis_page(self.found, evidence(self), self.input.subject),
                                   constants(self)),
                    self.input.model.robot, *self.input.recordings);
}

py::list table(const DiagnosisResult& self, const std::string& what) {
  if (what == "candidates") return table_of(self.found.findings);
  if (what == "noise") {
    return self.found.under ? noise_rows(self.found.under->noise) : py::list();
  }
  if (what == "noise laws") return table_of(self.found.noise);
  if (what == "events") return table_of(self.found.events);
  if (what == "unobservable") return table_of(self.found.unobservable);
  no_table(what, {"candidates", "noise", "noise laws", "events", "unobservable"});
}

void add_rows(py::module_& module) {
  RowClass<LookAlike>(module, "LookAlike", "LookAlike")
      .field("effect", &LookAlike::effect)
      .field("cosine", &LookAlike::cosine)
      .field("behind", &LookAlike::behind)
      .value(
          "told_apart", [](const LookAlike& self) { return self.told_apart(); },
          "Whether all measurements together tell the two apart.");
  RowClass<Finding>(module, "Finding", "Finding")
      .field("effect", &Finding::effect)
      .value(
          "formula", [](const Finding& self) { return formula_of(self.effect); },
          "\"compass x sin(heading), cos(heading)\".")
      .value(
          "status", [](const Finding& self) { return std::string(name_of(self.status)); },
          "missing, absent, negligible or cannot tell.")
      .value(
          "status_in_words", [](const Finding& self) { return std::string(status_in_words(self)); },
          doc("status_in_words"))
      .field("catalogue", &Finding::catalogue)
      .field("score", &Finding::score)
      .field("dof", &Finding::dof)
      .field("p_value", &Finding::p_value)
      .field("p_adjusted", &Finding::p_adjusted)
      .field("evidence", &Finding::evidence)
      .value(
          "coefficients", [](const Finding& self) { return self.effect.coefficients; },
          "Of the effect, as estimated.")
      .field("sd", &Finding::sd)
      .field("minimal_detectable", &Finding::minimal_detectable)
      .value(
          "arrival_rms", [](const Finding& self) { return self.held_out.arrival_rms; },
          "m, of held-out legs with it added, predicted.")
      .field("implausible", &Finding::implausible)
      .field("tried", &Finding::tried)
      .aside("held_out", [](const Finding& self) { return self.held_out; })
      .aside("look_alikes",
             [](const Finding& self) { return py::tuple(py::cast(self.look_alikes)); })
      .aside("joint", [](const Finding& self) { return self.joint; })
      .aside("joint_sd", [](const Finding& self) { return self.joint_sd; })
      .aside(
          "in_words", [](const Finding& self) { return in_words(self); },
          "What it is, in a sentence.");
  RowClass<Unobservable>(module, "Unobservable", "Unobservable")
      .field("effect", &Unobservable::effect)
      .value(
          "why", [](const Unobservable& self) { return advice_on(self).why; }, "In words.")
      .value(
          "remedy", [](const Unobservable& self) { return advice_on(self).drive; },
          "What to drive or to measure.");
  RowClass<NoiseTest>(module, "NoiseTest", "NoiseTest")
      .field("law", &NoiseTest::law)
      .field("score", &NoiseTest::score)
      .field("dof", &NoiseTest::dof)
      .field("p_adjusted", &NoiseTest::p_adjusted)
      .field("size", &NoiseTest::size)
      .field("unit", &NoiseTest::unit)
      .value(
          "in_words", [](const NoiseTest& self) { return in_words(self); }, "In a sentence.");
  RowClass<EventTest>(module, "EventTest", "EventTest")
      .value(
          "kind", [](const EventTest& self) { return std::string(name_of(self.kind)); },
          "leg, landmark, sighting or session.")
      .field("name", &EventTest::name)
      .field("size", &EventTest::size)
      .field("score", &EventTest::score)
      .field("dof", &EventTest::dof)
      .field("p_adjusted", &EventTest::p_adjusted)
      .value(
          "in_words", [](const EventTest& self) { return in_words(self); }, "In a sentence.");
}

template <auto kMember>
auto get(const DiagnosisResult& self) {
  return self.found.*kMember;
}

template <auto kMember>
py::tuple list(const DiagnosisResult& self) {
  return py::tuple(py::cast(self.found.*kMember));
}

py::tuple missing_findings(const DiagnosisResult& self) {
  std::vector<Finding> missing = self.found.findings;
  std::erase_if(missing, [](const Finding& one) { return one.status != Status::missing; });
  return py::tuple(py::cast(missing));
}

/// The model with the effects that are missing, none of them fitted yet.
Model completed(const DiagnosisResult& self) {
  Model model = self.input.model;
  for (const Finding& one : self.found.findings) {
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
  show_constants(type, constants);
  show_responses(
      type, evidence,
      "What these recordings show of each effect that is missing, then errors against what "
      "they "
      "go with most: bins and curves.");
  type.def_property_readonly(
          "verdict",
          [](const DiagnosisResult& self) { return std::string(verdict_of(self.found)); },
          "missing, nothing missing or unexplained misfit.")
      .def_property_readonly("missing", get<&Diagnosis::missing>, doc("Diagnosis.missing"))
      .def_property_readonly("missing_findings", missing_findings,
                             "All that is missing: `joint` and `joint_sd` are their sizes with all "
                             "of them added.")
      .def_property_readonly("p_value", get<&Diagnosis::p_value>, doc("Diagnosis.p_value"))
      .def_property_readonly("chi2", get<&Diagnosis::chi2>, "Of the fit that is judged.")
      .def_property_readonly("dof", get<&Diagnosis::dof>, "Its degrees of freedom.")
      .def_property_readonly("held_out", get<&Diagnosis::held_out>, doc("Diagnosis.held_out"))
      .def_property_readonly("with_missing", get<&Diagnosis::with_missing>,
                             doc("Diagnosis.with_missing"))
      .def_property_readonly("findings", list<&Diagnosis::findings>, doc("Diagnosis.findings"))
      .def_property_readonly("unobservable", list<&Diagnosis::unobservable>,
                             "What these data cannot show, and why.")
      .def_property_readonly("noise_laws", list<&Diagnosis::noise>, doc("Diagnosis.noise"))
      .def_property_readonly("events", list<&Diagnosis::events>, doc("Diagnosis.events"))
      .def_property_readonly(
          "lacks", [](const DiagnosisResult& self) { return in_words(self.found.lacks); },
          "What these data lack, in words.")
      .def_property_readonly(
          "next_drive", [](const DiagnosisResult& self) { return in_words(self.found.next_drive); },
          "What to drive to tell the first finding from its rivals, in words; empty: nothing.")
      .def_property_readonly("tried", get<&Diagnosis::tried>, doc("Diagnosis.tried"))
      .def_property_readonly(
          "noise",
          [](const DiagnosisResult& self) -> py::object {
            return self.found.under ? py::object(noise_rows(self.found.under->noise)) : py::none();
          },
          "The noise that it goes by; None where it was not estimated.")
      .def_property_readonly(
          "noise_budget", [](const DiagnosisResult& self) { return budget_rows(self.budget); },
          "What dead reckoning owes to each source of noise, a dict per horizon [s; 0: a leg].")
      .def_property_readonly("warnings", get<&Diagnosis::warnings>, "In words.")
      .def_property_readonly(
          "notes", [](const DiagnosisResult& self) { return self.input.notes; },
          doc("PreparedRecordings.notes"))
      .def_property_readonly("model", completed,
                             "The model with the effects that are missing, to be fitted.")
      .def("table", table, py::arg("what") = "candidates",
           "A list of dicts: candidates, noise, noise laws, events or unobservable.")
      .def("__repr__", [](const DiagnosisResult& self) {
        return "<trussmap.Diagnosis: " + verdict_in_words(self.found) + ">";
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
