// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The charts that pages on a model's fit have in common.
//
//   truss_chart     the map: bars by their force, landmarks with 95 % ellipses, the path
//   route_chart     the map: routes by how far off their legs end
//   response_chart  the signature: a channel's error along a variable, with curves
//   ladder_chart    what each step takes off the held-out legs' error, down to noise alone
//   source_chart    is each source of noise as large as stated?
//   quantile_chart  do its errors scatter as they should?
//   histogram_chart the same errors counted, beside a normal distribution
//   held_out_chart  how many held-out legs end within which distance
//   legs_chart      stretch or orientation error of all legs, in time
//   worst_chart     the legs with most chi^2
#pragma once

#include "plot/chart.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/evidence.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::plot {

/// The strongest bars are drawn one by one (the others as one faint net). `loudest` is the force
/// that has the strongest colour.
[[nodiscard]] Chart truss_chart(const std::string& id, const std::string& title,
                                const FittedMap& map, const std::vector<RouteMisfit>& routes,
                                double loudest);
/// For one map alone: its strongest force, but so that mere noise looks calm.
[[nodiscard]] double loudest_force(const Comparison& comparison);

/// A route's legs, as a comparison has them (`worst`): how far off they end.
struct RouteError {
  std::string from;
  std::string to;
  int legs = 0;
  double rms = 0.0;    ///< m
  double along = 0.0;  ///< m, mean, + is measured too long
  double left = 0.0;   ///< m, mean, + is measured too far to the left
};
/// Of all routes between landmarks of the map, the worst first.
[[nodiscard]] std::vector<RouteError> route_errors(const std::vector<LegMisfit>& legs,
                                                   const FittedMap& map);
/// Likewise of held-out legs, by where they are predicted to end; routes that have none are last,
/// with `legs` 0. `all` as above.
[[nodiscard]] std::vector<RouteError> held_out_errors(const std::vector<LegPrediction>& legs,
                                                      const std::vector<LegMisfit>& all,
                                                      const FittedMap& map);

/// What the colours of a route chart are of.
struct RouteColours {
  double worst = 0.0;   ///< m, the error that has the strongest colour
  std::string caption;  ///< what an error is
  std::string key;      ///< of the strongest colour
};
/// Of legs by wheels alone.
[[nodiscard]] RouteColours by_wheels_alone(double worst);
/// Of held-out legs: twice the error `first`, m, has the strongest colour.
[[nodiscard]] RouteColours by_held_out_legs(double first);
/// Of a map without landmarks it is the path.
[[nodiscard]] Chart route_chart(const std::string& id, const std::string& title,
                                const FittedMap& map, const std::vector<RouteError>& routes,
                                const RouteColours& colours);
/// Rings round the places that effects act at, where any does.
void add_places(Chart& chart, const std::vector<Effect>& effects);

/// A curve beside the response's own: a rival's, say.
struct NamedCurve {
  std::string name;
  std::vector<Vector2> points;  ///< variable, g
};
[[nodiscard]] Chart response_chart(const std::string& id, const std::string& title,
                                   const std::string& caption, const Response& response,
                                   const std::string& curve_name,
                                   const std::vector<NamedCurve>& rivals = {});

/// A model on the way from the nominal one: "without effects", "+ hard iron" ...
struct LadderStep {
  std::string name;
  double arrival_rms = 0.0;  ///< m, of held-out legs
  double chi2 = 0.0;
  int dof = 0;
  std::optional<double> predicted_rms = std::nullopt;  ///< m, before the fit
};
/// A staircase; `floor`: what noise alone would leave (HeldOut::expected_rms), m; 0: unknown.
[[nodiscard]] Chart ladder_chart(const std::string& id, const std::vector<LadderStep>& steps,
                                 double floor = 0.0);

using NamedSources = std::pair<std::string, std::vector<SourceCalibration>>;
[[nodiscard]] Chart source_chart(const std::string& id, const std::vector<NamedSources>& models);

/// Standardised residuals against those that a normal distribution would have (Q-Q).
[[nodiscard]] Chart quantile_chart(const std::string& id, const std::string& title,
                                   const std::vector<SourceResiduals>& sources);
/// All of them in steps of half a standard deviation.
[[nodiscard]] Chart histogram_chart(const std::string& id, const std::string& title,
                                    const std::vector<SourceResiduals>& sources);

/// A name for each set: "nominal", "with hard iron".
using NamedHeldOut = std::pair<std::string, HeldOut>;
[[nodiscard]] Chart held_out_chart(const std::string& id, const std::vector<NamedHeldOut>& models);

enum class LegError { stretch, orientation };
[[nodiscard]] Chart legs_chart(const std::string& id, const std::vector<LegMisfit>& legs,
                               LegError which);
[[nodiscard]] Chart worst_chart(const std::string& id, const std::vector<LegMisfit>& legs,
                                std::size_t count);

}  // namespace trussmap::plot
