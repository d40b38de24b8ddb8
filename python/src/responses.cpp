// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "responses.hpp"

#include "arrays.hpp"
#include "parts.hpp"
#include "rows.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/wording.hpp"

#include <string>
#include <utility>

namespace trussmap::python {
namespace {

struct NamedResponse {
  std::string name;  ///< of the effect; "turn against speed"
  Response response;
};

/// A member of all bins, in their order.
template <double ResponseBin::*kMember>
py::array bins(const NamedResponse& self) {
  const std::vector<ResponseBin>& all = self.response.bins;
  Eigen::VectorXd values(static_cast<Eigen::Index>(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] = all[k].*kMember;
  }
  return array_of(values);
}

/// A dict per bin.
py::list table(const NamedResponse& self) {
  py::list rows;
  for (const ResponseBin& bin : self.response.bins) {
    py::dict row;
    row["at"] = bin.at;
    row["low"] = bin.low;
    row["high"] = bin.high;
    row["estimate"] = bin.estimate;
    row["sd"] = bin.sd;
    rows.append(row);
  }
  return rows;
}

}  // namespace

py::tuple responses(const std::vector<EffectEvidence>& effects,
                    const std::vector<TrendEvidence>& trends) {
  std::vector<NamedResponse> all;
  for (const EffectEvidence& one : effects) {
    all.push_back({one.estimate.effect.name, one.response});
  }
  for (const TrendEvidence& one : trends) {
    all.push_back({name_in_words(one), one.response});
  }
  std::erase_if(all, [](const NamedResponse& one) { return one.response.bins.empty(); });
  return py::tuple(py::cast(all));
}

void add_responses(py::module_& module) {
  RowClass<NamedResponse> type(module, "Response");
  type.field("name", &NamedResponse::name)
      .value(
          "channel",
          [](const NamedResponse& self) { return std::string(name_of(self.response.channel)); },
          "What errs.")
      .value(
          "unit", [](const NamedResponse& self) { return self.response.unit; },
          doc("Response.unit"))
      .value(
          "variable", [](const NamedResponse& self) { return self.response.variable; },
          "What it is shown against: heading (0 to 2 pi), speed, payload_kg, place (m from there).")
      .value(
          "variable_label",
          [](const NamedResponse& self) { return axes_of(self.response).variable; },
          "What stands at the variable's axis: \"heading [\u00b0]\".")
      .value(
          "error_label", [](const NamedResponse& self) { return axes_of(self.response).error; },
          "What stands at the error's: \"compass reads too much by [\u00b0]\".")
      .value(
          "variable_factor",
          [](const NamedResponse& self) { return axes_of(self.response).variable_factor; },
          "From the arrays' unit to the label's.")
      .value(
          "error_factor",
          [](const NamedResponse& self) { return axes_of(self.response).error_factor; },
          "From the arrays' unit to the label's.")
      .value("at", bins<&ResponseBin::at>, "Mean of the variable in each bin.")
      .value("low", bins<&ResponseBin::low>, "Where each bin begins.")
      .value("high", bins<&ResponseBin::high>, "Where each bin ends.")
      .value("estimate", bins<&ResponseBin::estimate>, "The error in each bin.")
      .value("sd", bins<&ResponseBin::sd>, "Its standard error.")
      .value(
          "curve", [](const NamedResponse& self) { return array_of(self.response.curve); },
          "Variable and error by the effect, n x 2, but for a constant; empty where it is no "
          "curve.");
  type.type().def("table", table, "A list of dicts, one per bin: at, low, high, estimate, sd.");
}

}  // namespace trussmap::python
