// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// compare.
#include "calls.hpp"
#include "fits.hpp"
#include "parts.hpp"
#include "responses.hpp"
#include "results.hpp"
#include "rows.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <utility>

namespace trussmap::python {
namespace {

struct ComparisonResult {
  Comparison found;
  ModelFit fit;
  std::vector<NoiseBudget> budget;
  Prepared input;
  std::size_t worst = 5;
  Lazy<ComparisonEvidence> evidence;
};

ComparisonResult run_compare(const py::object& recordings, const py::object& model,
                             const std::vector<std::string>& without, const py::object& exclude,
                             double gate, std::optional<double> every, double level, double holdout,
                             double min_drive, double leg, std::size_t worst,
                             const py::object& progress) {
  const Given given = python::given(recordings, model);
  UseOptions use = use_options(without, gate, every, holdout, min_drive, leg, level);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  ComparisonResult result;
  result.worst = worst;
  CallProgress told(progress, {{"reading", 1}, {"fitting the map", 4}, {"comparing", 40}});
  unlocked([&] {
    told.next();
    result.input = prepared(given, use);
  });
  warn(result.input.mistakes);
  unlocked([&] {
    const std::vector<DrivenRecording>& used = *result.input.recordings;
    CompareOptions how{use.fit, use.legs, use.level};
    how.fit.fit_effects = false;
    told.next();
    result.fit = fit_model(used, result.input.model, how.fit);
    told.next();
    result.found = compare(*result.input.rows, result.fit, how);
    result.budget = noise_budget(used, result.input.model);
  });
  told.end();
  return result;
}

std::string text(const ComparisonResult& self) {
  return comparison_text(self.found, self.input.model.noise, self.budget, self.worst) +
         notes_text(self.input.notes);
}

const ComparisonEvidence& evidence(const ComparisonResult& self) {
  return self.evidence.get([&] { return evidence_of(self.fit, self.found); });
}

Page page(const ComparisonResult& self) {
  return with_drive(comparison_page(evidence(self), self.input.subject), self.input.model.robot,
                    *self.input.recordings);
}

py::list table(const ComparisonResult& self, const std::string& what) {
  if (what == "trends") return table_of(self.found.trends);
  if (what == "legs") return table_of(self.found.worst);
  if (what == "routes") return table_of(self.found.routes);
  if (what == "landmarks") return table_of(self.found.worst_landmarks);
  if (what == "noise") return table_of(self.found.sources);
  if (what == "outliers") return table_of(self.found.outliers);
  no_table(what, {"trends", "legs", "routes", "landmarks", "noise", "outliers"});
}

void add_rows(py::module_& module) {
  RowClass<LegMisfit>(module, "LegMisfit", "LegMisfit")
      .field("from_", &LegMisfit::from)
      .field("to", &LegMisfit::to)
      .field("t", &LegMisfit::t)
      .field("chi2", &LegMisfit::chi2)
      .field("dof", &LegMisfit::dof)
      .field("stretch_error", &LegMisfit::stretch_error)
      .field("orientation_error", &LegMisfit::orientation_error);
  RowClass<RouteMisfit>(module, "RouteMisfit", "RouteMisfit")
      .field("from_", &RouteMisfit::from)
      .field("to", &RouteMisfit::to)
      .field("traversals", &RouteMisfit::traversals)
      .field("chi2", &RouteMisfit::chi2)
      .field("force", &RouteMisfit::force)
      .field("stretch_error", &RouteMisfit::stretch_error)
      .field("orientation_error", &RouteMisfit::orientation_error);
  RowClass<LandmarkMisfit>(module, "LandmarkMisfit", "LandmarkMisfit")
      .field("landmark", &LandmarkMisfit::landmark)
      .field("sightings", &LandmarkMisfit::sightings)
      .field("chi2", &LandmarkMisfit::chi2);
  RowClass<Trend>(module, "Trend", "Trend")
      .field("kind", &Trend::kind)
      .field("against", &Trend::against)
      .field("effect", &Trend::effect)
      .field("score", &Trend::score)
      .field("dof", &Trend::dof)
      .field("p_value", &Trend::p_value)
      .field("p_adjusted", &Trend::p_adjusted)
      .field("size", &Trend::size)
      .field("unit", &Trend::unit);
  RowClass<SourceCalibration>(module, "SourceCalibration", "SourceCalibration")
      .field("source", &SourceCalibration::source)
      .field("factor", &SourceCalibration::factor)
      .field("sd", &SourceCalibration::sd)
      .field("redundancy", &SourceCalibration::redundancy);
  RowClass<Outlier>(module, "Outlier", "Outlier")
      .field("what", &Outlier::what)
      .field("statistic", &Outlier::statistic)
      .field("dof", &Outlier::dof)
      .field("p_adjusted", &Outlier::p_adjusted);
}

/// A member of the comparison.
template <auto kMember>
auto get(const ComparisonResult& self) {
  return self.found.*kMember;
}

/// A list of it, which cannot be changed.
template <auto kMember>
py::tuple list(const ComparisonResult& self) {
  return py::tuple(py::cast(self.found.*kMember));
}

}  // namespace

void add_comparison(py::module_& module) {
  add_rows(module);
  py::class_<ComparisonResult> type(module, "Comparison",
                                    "A model set against recordings: is it consistent, where does "
                                    "it fail?");
  show(type, text, page);
  show_responses(type, evidence,
                 "Errors against what they go with most, the most telling first: bins and curves.");
  type.def_property_readonly(
          "verdict",
          [](const ComparisonResult& self) { return std::string(verdict_of(self.found)); },
          "consistent, or misfit, or what else it comes to.")
      .def_property_readonly(
          "consistent", [](const ComparisonResult& self) { return self.found.consistent(); },
          "Whether nothing speaks against the model.")
      .def_property_readonly(
          "tested", [](const ComparisonResult& self) { return self.found.tested(); },
          doc("Comparison.tested"))
      .def_property_readonly("missing", get<&Comparison::missing>, doc("Comparison.missing"))
      .def_property_readonly("chi2", get<&Comparison::chi2>, "Of the fit.")
      .def_property_readonly("dof", get<&Comparison::dof>, "Its degrees of freedom.")
      .def_property_readonly("p_value", get<&Comparison::p_value>, doc("Comparison.p_value"))
      .def_property_readonly("legs", get<&Comparison::legs>, "How many.")
      .def_property_readonly("landmarks", get<&Comparison::landmarks>, "How many.")
      .def_property_readonly("held_out", get<&Comparison::held_out>,
                             "How well the model predicts legs that it has not seen.")
      .def_property_readonly("worst", list<&Comparison::worst>, doc("Comparison.worst"))
      .def_property_readonly("routes", list<&Comparison::routes>, "The most strained first.")
      .def_property_readonly("worst_landmarks", list<&Comparison::worst_landmarks>,
                             "The worst first.")
      .def_property_readonly("trends", list<&Comparison::trends>, doc("Comparison.trends"))
      .def_property_readonly("sources", list<&Comparison::sources>,
                             "How noisy each source is, against what is stated.")
      .def_property_readonly("outliers", list<&Comparison::outliers>, doc("Comparison.outliers"))
      .def_property_readonly(
          "lacks", [](const ComparisonResult& self) { return in_words(self.found.lacks); },
          "What these data lack, in words.")
      .def_property_readonly(
          "noise_budget", [](const ComparisonResult& self) { return budget_rows(self.budget); },
          "What dead reckoning owes to each source of noise, a dict per horizon [s; 0: a leg].")
      .def_property_readonly("warnings", get<&Comparison::warnings>, "In words.")
      .def_property_readonly(
          "notes", [](const ComparisonResult& self) { return self.input.notes; },
          doc("PreparedRecordings.notes"))
      .def("table", table, py::arg("what") = "trends",
           "A list of dicts: trends, legs, routes, landmarks, noise or outliers.")
      .def("__repr__", [](const ComparisonResult& self) {
        return "<trussmap.Comparison: " + verdict_in_words(self.found) + ">";
      });
  module.def("compare", run_compare, py::arg("recordings"), py::arg("model"), py::kw_only(),
             py::arg("without") = std::vector<std::string>(), py::arg("exclude") = py::tuple(),
             py::arg("gate") = kModelGate, py::arg("every") = py::none(),
             py::arg("level") = kSignificance, py::arg("holdout") = LegOptions().share,
             py::arg("min_drive") = LegOptions().min_drive, py::arg("leg") = LegOptions().leg,
             py::arg("worst") = 5, py::arg("progress") = py::none(),
             (doc("Is a model consistent with recordings, and where does it fail?", "compare") +
              kUseDoc + " `worst`: legs and routes that are printed.")
                 .c_str());
}

}  // namespace trussmap::python
