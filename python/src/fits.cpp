// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// fit, and what results of fits have in common.
#include "fits.hpp"

#include "arrays.hpp"
#include "calls.hpp"
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

/// A model's effects fitted, beside the same robot without them.
struct FitResult {
  FitReport report;
  Prepared input;
  Lazy<FitEvidence> evidence;
};

FitResult run_fit(const py::object& recordings, const py::object& model, bool noise,
                  const std::vector<std::string>& without, const py::object& exclude, double gate,
                  std::optional<double> every, double holdout, double min_drive, double leg,
                  const py::object& progress) {
  const Given given = python::given(recordings, model);
  FitResult result;
  SessionOptions use = use_options(without, gate, every, holdout, min_drive, leg, kSignificance);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  CallProgress told(progress, fit_stages(noise));
  unlocked([&] {
    told.next();
    result.input = prepared(given, use);
  });
  warn(result.input.mistakes);
  if (result.input.model().effects.empty() && !noise) {
    throw py::value_error("the model has no effect to fit, expected one or more");
  }
  unlocked([&] { result.report = fit(*result.input.session, noise, [&told] { told.next(); }); });
  told.end();
  return result;
}

RobotConstants constants(const FitResult& self) {
  return self.report.constants;
}

std::string text(const FitResult& self) {
  return fit_text(self.report.gain, self.report.noise) + constants_text(constants(self)) +
         notes_text(self.input.notes());
}

const FitEvidence& evidence(const FitResult& self) {
  return self.evidence.get([&] {
    const CompareOptions how = compare_options(self.input.session->options);
    FitEvidence found = evidence_of(self.input.recordings(), self.report.gain, how);
    if (self.report.noise) found.noise = in_words(*self.report.noise);
    return found;
  });
}

Page page(const FitResult& self) {
  return with_drive(with_constants(fit_page(evidence(self), self.input.subject), constants(self)),
                    self.input.model().robot, self.input.recordings());
}

py::list table(const FitResult& self, const std::string& what) {
  if (what == "effects") return table_of(self.report.gain.with.effects);
  if (what == "landmarks") return table_of(self.report.gain.with.landmarks);
  if (what == "noise")
    return self.report.noise ? py::list(to_python(self.report.noise->sources)) : py::list();
  no_table(what, {"effects", "landmarks", "noise"});
}

py::array positions(const std::vector<FittedLandmark>& landmarks) {
  std::vector<Vector2> points;
  for (const FittedLandmark& one : landmarks) points.push_back(one.position);
  return array_of(points);
}

void add_parts(py::module_& module) {
  RowClass<LegPrediction>(module, "LegPrediction")
      .field("leg", &LegPrediction::leg)
      .field("from_", &LegPrediction::from)
      .field("to", &LegPrediction::to)
      .field("t", &LegPrediction::t)
      .value(
          "error_x", [](const LegPrediction& self) { return self.arrival_error.x(); },
          "m, predicted less true.")
      .value(
          "error_y", [](const LegPrediction& self) { return self.arrival_error.y(); },
          "m, predicted less true.")
      .field("expected_error", &LegPrediction::expected_error)
      .field("stretch_error", &LegPrediction::stretch_error)
      .field("orientation_error", &LegPrediction::orientation_error);
  RowClass<HeldOutMetrics>(module, "HeldOutMetrics");
  RowClass<HeldOut>(module, "HeldOut")
      .value(
          "each", [](const HeldOut& self) { return py::tuple(py::cast(self.legs)); },
          "The legs held out, each with its error.");
  RowClass<EffectEstimate>(module, "EffectEstimate");
  RowClass<FittedLandmark>(module, "FittedLandmark")
      .field("name", &FittedLandmark::name)
      .value(
          "x", [](const FittedLandmark& self) { return self.position.x(); }, "m, map frame.")
      .value(
          "y", [](const FittedLandmark& self) { return self.position.y(); }, "m, map frame.")
      .value("covariance", [](const FittedLandmark& self) { return array_of(self.covariance); });
}

}  // namespace

void no_table(const std::string& what, const std::vector<std::string>& tables) {
  std::string names;
  for (const std::string& one : tables) names += (names.empty() ? "" : ", ") + one;
  throw py::value_error("table: there is none called \"" + what + "\", expected one of " + names);
}

void add_fits(py::module_& module) {
  add_parts(module);
  py::class_<FitResult> type(module, "Fit",
                             "A model's effects fitted, beside the model without them.");
  show(type, text, page);
  show_constants(type, constants);
  show_responses(type, evidence, "What these recordings show of each effect: bins and curves.");
  add_fields<FitResult, EffectGain>(
      type, results::kDescribed<EffectGain>,
      [](const FitResult& self) -> const EffectGain& { return self.report.gain; });
  type.def_property_readonly(
          "model", [](const FitResult& self) { return self.report.gain.with.model; },
          doc("ModelFit.model"))
      .def_property_readonly(
          "landmarks",
          [](const FitResult& self) {
            return py::tuple(py::cast(self.report.gain.with.landmarks));
          },
          doc("ModelFit.landmarks"))
      .def_property_readonly(
          "positions",
          [](const FitResult& self) { return positions(self.report.gain.with.landmarks); },
          "m, of the landmarks, n x 2.")
      .def_property_readonly(
          "noise", [](const FitResult& self) { return to_python(self.report.noise); },
          "The noise that was estimated; None where it was not.")
      .def_property_readonly(
          "left_out", [](const FitResult& self) { return self.report.gain.with.left_out; },
          doc("ModelFit.left_out"))
      .def_property_readonly(
          "notes", [](const FitResult& self) { return self.input.notes(); },
          doc("PreparedRecordings.notes"))
      .def("table", table, py::arg("what") = "effects",
           "A list of dicts: effects, landmarks or noise.")
      .def("__repr__", [](const FitResult& self) {
        return "<trussmap.Fit of " + std::to_string(self.report.gain.with.effects.size()) +
               " effects: chi2 " + std::to_string(self.report.gain.without.chi2) + " -> " +
               std::to_string(self.report.gain.with.chi2) + ">";
      });
  module.def("fit", run_fit, py::arg("recordings"), py::arg("model"), py::kw_only(),
             py::arg("noise") = false, py::arg("without") = std::vector<std::string>(),
             py::arg("exclude") = py::tuple(), py::arg("gate") = kModelGate,
             py::arg("every") = py::none(), py::arg("holdout") = LegOptions().share,
             py::arg("min_drive") = LegOptions().min_drive, py::arg("leg") = LegOptions().leg,
             py::arg("progress") = py::none(),
             (doc("Estimates the coefficients of a model's effects; with `noise` the noise, too.",
                  "fit_model") +
              kUseDoc)
                 .c_str());
}

}  // namespace trussmap::python
