// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// compare.
#include "calls.hpp"
#include "fits.hpp"
#include "parts.hpp"
#include "responses.hpp"
#include "results.hpp"
#include "results/criticism.hpp"
#include "rows.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <utility>

namespace trussmap::python {
namespace {

struct ComparisonResult {
  ComparisonReport report;
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
  SessionOptions use = use_options(without, gate, every, holdout, min_drive, leg, level);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  ComparisonResult result;
  result.worst = worst;
  CallProgress told(progress, compare_stages());
  unlocked([&] {
    told.next();
    result.input = prepared(given, use);
  });
  warn(result.input.mistakes);
  unlocked([&] { result.report = compare(*result.input.session, [&told] { told.next(); }); });
  told.end();
  return result;
}

std::string text(const ComparisonResult& self) {
  return comparison_text(self.report.found, self.input.model().noise, self.report.noise_budget,
                         self.worst) +
         notes_text(self.input.notes());
}

const ComparisonEvidence& evidence(const ComparisonResult& self) {
  return self.evidence.get([&] { return evidence_of(self.report.fit, self.report.found); });
}

Page page(const ComparisonResult& self) {
  return with_drive(comparison_page(evidence(self), self.input.subject), self.input.model().robot,
                    self.input.recordings());
}

std::optional<NextCommand> next(const ComparisonResult& self) {
  return next_command(self.report.found);
}

py::list table(const ComparisonResult& self, const std::string& what) {
  if (what == "trends") return table_of(self.report.found.trends);
  if (what == "legs") return table_of(self.report.found.worst);
  if (what == "routes") return table_of(self.report.found.routes);
  if (what == "landmarks") return table_of(self.report.found.worst_landmarks);
  if (what == "noise") return table_of(self.report.found.sources);
  if (what == "outliers") return table_of(self.report.found.outliers);
  no_table(what, {"trends", "legs", "routes", "landmarks", "noise", "outliers"});
}

void add_rows(py::module_& module) {
  RowClass<LegMisfit>(module, "LegMisfit");
  RowClass<RouteMisfit>(module, "RouteMisfit");
  RowClass<LandmarkMisfit>(module, "LandmarkMisfit");
  RowClass<Trend>(module, "Trend");
  RowClass<SourceCalibration>(module, "SourceCalibration");
  RowClass<Outlier>(module, "Outlier");
}

}  // namespace

void add_comparison(py::module_& module) {
  add_rows(module);
  py::class_<ComparisonResult> type(module, "Comparison",
                                    "A model set against recordings: is it consistent, where does "
                                    "it fail?");
  show(type, text, page);
  show_next(type, next);
  show_responses(type, evidence,
                 "Errors against what they go with most, the most telling first: bins and curves.");
  add_fields<ComparisonResult, ComparisonReport>(
      type, results::kDescribed<ComparisonReport>,
      [](const ComparisonResult& self) -> const ComparisonReport& { return self.report; });
  type.def_property_readonly(
          "consistent", [](const ComparisonResult& self) { return self.report.found.consistent(); },
          "Whether nothing speaks against the model.")
      .def_property_readonly(
          "tested", [](const ComparisonResult& self) { return self.report.found.tested(); },
          doc("Comparison.tested"))
      .def_property_readonly(
          "missing", [](const ComparisonResult& self) { return self.report.found.missing; },
          doc("Comparison.missing"))
      .def_property_readonly(
          "notes", [](const ComparisonResult& self) { return self.input.notes(); },
          doc("PreparedRecordings.notes"))
      .def("table", table, py::arg("what") = "trends",
           "A list of dicts: trends, legs, routes, landmarks, noise or outliers.")
      .def("__repr__", [](const ComparisonResult& self) {
        return "<trussmap.Comparison: " + verdict_in_words(self.report.found) + ">";
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
