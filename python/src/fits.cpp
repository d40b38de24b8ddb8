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
#include "rows.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <utility>

namespace trussmap::python {
namespace {

/// A model's effects fitted, beside the same robot without them.
struct FitResult {
  EffectGain gain;
  std::optional<FittedNoise> noise;
  Prepared input;
  UseOptions use;
  Lazy<FitEvidence> evidence;
};

FitResult run_fit(const py::object& recordings, const py::object& model, bool noise,
                  const std::vector<std::string>& without, const py::object& exclude, double gate,
                  std::optional<double> every, double holdout, double min_drive, double leg,
                  const py::object& progress) {
  const Given given = python::given(recordings, model);
  FitResult result;
  result.use = use_options(without, gate, every, holdout, min_drive, leg, kSignificance);
  result.use.fit.excluded = excluded_of(exclude, given.held.size());
  std::vector<CallStep> steps{{"reading", 0.5},
                              {"fitting without effects", 2.5},
                              {"fitting the effects", 5},
                              {"predicting held-out legs", 8}};
  if (noise) steps.insert(steps.begin() + 1, {"estimating the noise", 8});
  CallProgress told(progress, steps);
  unlocked([&] {
    told.next();
    result.input = prepared(given, result.use);
  });
  warn(result.input.mistakes);
  if (result.input.model.effects.empty() && !noise) {
    throw py::value_error("the model has no effect to fit, expected one or more");
  }
  unlocked([&] {
    const std::vector<DrivenRecording>& used = *result.input.recordings;
    Model fitted = result.input.model;
    FitOptions how = result.use.fit;
    if (noise) {
      told.next();
      result.noise = fit_model_and_noise(used, fitted, how).noise;
      fitted.noise = result.noise->noise;
    }
    Model bare = fitted;
    bare.effects.clear();
    told.next();
    how.fit_effects = false;
    const ModelFit before = fit_model(used, bare, how);
    told.next();
    how.fit_effects = true;
    const ModelFit after = fit_model(used, fitted, how);
    told.next();
    result.gain = gain_of_effects(used, before, after, result.use.legs);
  });
  told.end();
  return result;
}

RobotConstants constants(const FitResult& self) {
  return with_velocity_variances(robot_constants(self.input.model, self.gain.with),
                                 *self.input.recordings, self.gain.with.model);
}

std::string text(const FitResult& self) {
  return fit_text(self.gain, self.noise) + constants_text(constants(self)) +
         notes_text(self.input.notes);
}

const FitEvidence& evidence(const FitResult& self) {
  return self.evidence.get([&] {
    const CompareOptions how{self.use.fit, self.use.legs, self.use.level};
    FitEvidence found = evidence_of(*self.input.recordings, self.gain, how);
    if (self.noise) found.noise = in_words(*self.noise);
    return found;
  });
}

Page page(const FitResult& self) {
  return with_drive(with_constants(fit_page(evidence(self), self.input.subject), constants(self)),
                    self.input.model.robot, *self.input.recordings);
}

py::list table(const FitResult& self, const std::string& what) {
  if (what == "effects") return table_of(self.gain.with.effects);
  if (what == "landmarks") return table_of(self.gain.with.landmarks);
  if (what == "noise") return self.noise ? noise_rows(*self.noise) : py::list();
  no_table(what, {"effects", "landmarks", "noise"});
}

py::array positions(const std::vector<FittedLandmark>& landmarks) {
  std::vector<Vector2> points;
  for (const FittedLandmark& one : landmarks) points.push_back(one.position);
  return array_of(points);
}

void add_parts(py::module_& module) {
  RowClass<LegPrediction>(module, "LegPrediction", "LegPrediction")
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
  RowClass<HeldOutMetrics>(module, "HeldOutMetrics", "HeldOutMetrics")
      .field("arrival_rms", &HeldOutMetrics::arrival_rms)
      .field("stretch_error", &HeldOutMetrics::stretch_error)
      .field("orientation_error", &HeldOutMetrics::orientation_error);
  RowClass<HeldOut>(module, "HeldOut", "HeldOut")
      .value(
          "arrival_rms", [](const HeldOut& self) { return self.arrival_rms; },
          doc("HeldOutMetrics.arrival_rms"))
      .value(
          "stretch_error", [](const HeldOut& self) { return self.stretch_error; },
          doc("HeldOutMetrics.stretch_error"))
      .value(
          "orientation_error", [](const HeldOut& self) { return self.orientation_error; },
          doc("HeldOutMetrics.orientation_error"))
      .field("expected_rms", &HeldOut::expected_rms)
      .aside(
          "legs", [](const HeldOut& self) { return py::tuple(py::cast(self.legs)); },
          "The legs held out, each with its error.");
  RowClass<EffectEstimate>(module, "EffectEstimate", "EffectEstimate")
      .field("effect", &EffectEstimate::effect)
      .value(
          "coefficients", [](const EffectEstimate& self) { return self.effect.coefficients; },
          "Of the effect, one per shape.")
      .field("sd", &EffectEstimate::sd)
      .value(
          "in_words", [](const EffectEstimate& self) { return in_words(self.effect, self.sd); },
          "\"the wheelbase is 2.0 +- 0.1 % larger than nominal\".")
      .value("not_fitted", [](const EffectEstimate& self) {
        std::vector<std::string> lines;
        for (const UnfittedCoefficient& one : self.not_fitted) {
          lines.push_back(in_words(self, one));
        }
        return lines;
      });
  RowClass<FittedLandmark>(module, "FittedLandmark", "FittedLandmark")
      .field("name", &FittedLandmark::name)
      .value(
          "x", [](const FittedLandmark& self) { return self.position.x(); }, "m, map frame.")
      .value(
          "y", [](const FittedLandmark& self) { return self.position.y(); }, "m, map frame.")
      .aside("covariance", [](const FittedLandmark& self) { return array_of(self.covariance); });
}

}  // namespace

py::list budget_rows(const std::vector<NoiseBudget>& budget) {
  py::list rows;
  for (const NoiseBudget& one : budget) {
    py::dict shares;
    for (const NoiseShare& share : one.shares) shares[share.source.c_str()] = share.share;
    py::dict row;
    row["horizon"] = one.horizon;
    row["rms"] = one.rms;
    row["windows"] = one.windows;
    row["shares"] = shares;
    rows.append(row);
  }
  return rows;
}

py::list noise_rows(const FittedNoise& noise) {
  py::list rows;
  for (const NoiseSource& one : noise.sources) {
    py::dict row;
    row["source"] = one.name;
    row["unit"] = one.unit;
    row["stated"] = one.stated;
    row["sd"] = one.sd;
    row["sd_error"] = one.sd_error;
    row["length"] = one.process.length;
    row["length_error"] = one.length_error;
    row["at_limit"] = one.at_limit;
    row["gain"] = one.gain;
    rows.append(row);
  }
  return rows;
}

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
  type.def_property_readonly(
          "model", [](const FitResult& self) { return self.gain.with.model; },
          doc("ModelFit.model"))
      .def_property_readonly(
          "effects",
          [](const FitResult& self) { return py::tuple(py::cast(self.gain.with.effects)); },
          doc("ModelFit.effects"))
      .def_property_readonly(
          "landmarks",
          [](const FitResult& self) { return py::tuple(py::cast(self.gain.with.landmarks)); },
          doc("ModelFit.landmarks"))
      .def_property_readonly(
          "positions", [](const FitResult& self) { return positions(self.gain.with.landmarks); },
          "m, of the landmarks, n x 2.")
      .def_property_readonly(
          "chi2", [](const FitResult& self) { return self.gain.with.chi2; }, "Of the fit.")
      .def_property_readonly(
          "dof", [](const FitResult& self) { return self.gain.with.dof; }, doc("ModelFit.dof"))
      .def_property_readonly(
          "p_value", [](const FitResult& self) { return self.gain.with.p_value; },
          doc("ModelFit.p_value"))
      .def_property_readonly(
          "chi2_without", [](const FitResult& self) { return self.gain.without.chi2; },
          "Of the fit without effects.")
      .def_property_readonly(
          "dof_without", [](const FitResult& self) { return self.gain.without.dof; },
          "Of the fit without effects.")
      .def_property_readonly(
          "predicted_decrease", [](const FitResult& self) { return self.gain.predicted_decrease; },
          doc("EffectGain.predicted_decrease"))
      .def_property_readonly(
          "held_out", [](const FitResult& self) { return self.gain.held_out_with; },
          "How well the fitted model predicts legs that it has not seen.")
      .def_property_readonly(
          "held_out_without", [](const FitResult& self) { return self.gain.held_out_without; },
          "How well the model without effects does.")
      .def_property_readonly(
          "noise",
          [](const FitResult& self) -> py::object {
            return self.noise ? py::object(noise_rows(*self.noise)) : py::none();
          },
          "What was found of each source of noise; None where it was not estimated.")
      .def_property_readonly(
          "left_out", [](const FitResult& self) { return self.gain.with.left_out; },
          doc("ModelFit.left_out"))
      .def_property_readonly(
          "warnings", [](const FitResult& self) { return self.gain.with.warnings; }, "In words.")
      .def_property_readonly(
          "notes", [](const FitResult& self) { return self.input.notes; },
          doc("PreparedRecordings.notes"))
      .def("table", table, py::arg("what") = "effects",
           "A list of dicts: effects, landmarks or noise.")
      .def("__repr__", [](const FitResult& self) {
        return "<trussmap.Fit of " + std::to_string(self.gain.with.effects.size()) +
               " effects: chi2 " + std::to_string(self.gain.without.chi2) + " -> " +
               std::to_string(self.gain.with.chi2) + ">";
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
