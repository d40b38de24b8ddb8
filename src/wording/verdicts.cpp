// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/number_text.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string beyond_noise(double chi2, int dof) {
  return fmt::format("errors are {} times what the model's noise allows",
                     text::times_text(std::sqrt(chi2 / std::max(1, dof))));
}

/// A verdict, and by how many of the sightings it is one.
std::string judged(const std::string& verdict, const UsedSightings& sightings) {
  const std::string by = in_words(sightings);
  return by.empty() ? verdict : verdict + "; " + by;
}

std::string goes_with(const Trend& trend) {
  return trend.against == "all"
             ? fmt::format("the {} error is everywhere alike", trend.kind)
             : fmt::format("the {} error depends on {}", trend.kind, trend.against);
}

}  // namespace

std::string_view name_of(Status status) {
  switch (status) {
    case Status::missing:
      return "missing";
    case Status::absent:
      return "absent";
    case Status::negligible:
      return "negligible";
    case Status::cannot_tell:
      break;
  }
  return "cannot tell";
}

std::string_view status_in_words(const Finding& finding) {
  const bool significant = finding.p_adjusted < kSignificance;
  if (significant && finding.implausible && finding.status != Status::missing) {
    return "implausibly large";
  }
  if (significant && finding.status == Status::absent) return "explained by the above";
  return name_of(finding.status);
}

std::string_view name_of(EventKind kind) {
  switch (kind) {
    case EventKind::leg:
      return "leg";
    case EventKind::landmark:
      return "landmark";
    case EventKind::sighting:
      return "sighting";
    case EventKind::session:
      break;
  }
  return "session";
}

std::string_view verdict_of(const Comparison& result) {
  return result.consistent() ? "consistent" : "misfit";
}

std::string_view verdict_of(const Diagnosis& result) {
  switch (result.verdict) {
    case Diagnosis::Verdict::missing:
      return "missing";
    case Diagnosis::Verdict::nothing_missing:
      return "nothing missing";
    case Diagnosis::Verdict::unexplained_misfit:
      break;
  }
  return "unexplained misfit";
}

std::string_view verdict_of(const Discovery& result) {
  return result.consistent ? "consistent" : "unexplained misfit";
}

namespace {

constexpr const char* kNoNoise =
    "something lasts that is not noise: it would have to be larger than is sought";

std::string changes_in_words(const std::string& name) {
  return fmt::format("the coefficient of {} is not the same all the time", name);
}

std::string change_in_words(const Diagnosis& diagnosis) {
  return changes_in_words(name_in_words(diagnosis.changing.front().effect));
}

std::string place_in_words(const Diagnosis& diagnosis) {
  const auto field = std::ranges::find_if(diagnosis.places, &FieldOfPlaces::is_field);
  return field_in_words(field->channel);
}

}  // namespace

std::string objection_in_words(const Comparison& result) {
  switch (result.objection) {
    case Objection::none:
      if (!result.tested()) {
        return fmt::format(
            "but hardly tested: {} degrees of freedom say nothing for a model; drive routes again, "
            "or survey landmarks",
            result.dof);
      }
      return "the model explains these measurements to within its noise";
    case Objection::chi2:
      return beyond_noise(result.chi2, result.dof);
    case Objection::trend:
      return "errors are small enough as a whole, but " +
             (result.trends.empty() ? std::string() : goes_with(result.trends.front()));
    case Objection::noise:
      return kNoNoise;
    case Objection::change:
      return "errors are small enough as a whole, but " + changes_in_words(result.changing) +
             " (see trussmap diagnose)";
    case Objection::place:  // no comparison asks
    case Objection::effect:
      break;
  }
  return fmt::format(
      "errors are small enough as a whole, but {} is missing (see trussmap diagnose)",
      result.missing);
}

std::string objection_in_words(const Diagnosis& diagnosis, const Comparison& result) {
  if (diagnosis.objection == Objection::change) return change_in_words(diagnosis);
  if (diagnosis.objection == Objection::place) return place_in_words(diagnosis);
  return diagnosis.objection == Objection::noise ? kNoNoise : objection_in_words(result);
}

std::string verdict_in_words(const Comparison& result) {
  const bool hardly = result.consistent() && !result.tested();
  return judged(
      fmt::format("{}{} {}", verdict_of(result), hardly ? "," : ":", objection_in_words(result)),
      result.sightings);
}

std::string in_words(const UsedSightings& sightings) {
  if (!sightings.thinned()) return "";
  return fmt::format("judged by {} of {} sightings, one frame in {:g} s", sightings.used,
                     sightings.all, sightings.every);
}

namespace {

std::string verdict_of_all(const Diagnosis& result) {
  std::string text(verdict_of(result));
  switch (result.verdict) {
    case Diagnosis::Verdict::missing:
      return text + ": " + result.missing;
    case Diagnosis::Verdict::nothing_missing:
      return text +
             fmt::format(": none of {} effects tried explains more than chance", result.tried) +
             (result.under && result.under->noise.changed() ? ", but its noise is not as stated"
                                                            : "");
    case Diagnosis::Verdict::unexplained_misfit:
      break;
  }
  if (result.objection == Objection::trend) {
    return text + fmt::format(
                      ": errors follow a trend (see trussmap compare), and none of {} effects "
                      "tried explains it",
                      result.tried);
  }
  if (result.objection == Objection::change) return text + ": " + change_in_words(result);
  if (result.objection == Objection::place) return text + ": " + place_in_words(result);
  if (result.objection == Objection::noise) {
    return text +
           fmt::format(": {}, and none of {} effects tried explains it", kNoNoise, result.tried);
  }
  if (is_slight_misfit(result)) {
    return text + fmt::format(
                      ", a slight one: noise alone makes such errors in one of {:.0f} recordings, "
                      "and none of {} effects tried explains them",
                      1.0 / result.p_value, result.tried);
  }
  return text + fmt::format(
                    ": the model's noise does not allow these errors (p {}), and none of {} "
                    "effects tried explains them",
                    probability_text(result.p_value), result.tried);
}

}  // namespace

std::string verdict_in_words(const Diagnosis& result) {
  return judged(verdict_of_all(result), result.sightings);
}

std::string verdict_in_words(const Discovery& result) {
  const std::size_t given = result.given.model.effects.size();
  const std::size_t now = result.found.model.effects.size();
  const std::size_t added = now > given ? now - given : 0;
  const bool noise = result.last.under && result.last.under->noise.changed();
  const std::string found = added == 0 && noise ? "nothing found but noise that is not as stated"
                            : added == 0        ? "nothing found, the model stays as it is"
                            : added == 1        ? "one effect found"
                                         : fmt::format("{} effects found, one by one", added);
  return judged(fmt::format("{}: {}; {}", verdict_of(result), found, stop_in_words(result)),
                result.sightings);
}

std::string in_words(const Finding& finding) {
  Effect effect = finding.effect;
  if (!finding.joint.empty()) effect.coefficients = finding.joint;
  return fmt::format(
      "{}: {}; {}{}", name_of(finding.status), effect.name,
      in_words(effect, finding.joint.empty() ? finding.sd : finding.joint_sd),
      finding.implausible ? "; implausibly large: is a unit wrong, or a sensor at fault?" : "");
}

std::string behind_in_words(const LookAlike& rival) {
  constexpr double kShows = 0.5;  // of chi^2
  return rival.behind < kShows ? "" : fmt::format(", its fit {:.0f} behind (chi^2)", rival.behind);
}

std::string stop_in_words(const Discovery& result) {
  std::string why = [&] {
    const Stopped& stopped = result.stopped;
    switch (stopped.reason) {
      case StopReason::limit_reached:
        return fmt::format("effect limit reached ({})", stopped.limit);
      case StopReason::cannot_be_fitted:
        return fmt::format("\"{}\" cannot be fitted beside what the model has", stopped.effect);
      case StopReason::predicts_worse:
        return fmt::format("\"{}\" fits these legs, but predicts others worse", stopped.effect);
      case StopReason::told_to:
        return std::string("told to stop");
      case StopReason::nothing_significant:
        break;
    }
    return std::string("nothing more is significant");
  }();
  if (result.consistent) return why;
  if (result.last.objection == Objection::change) {
    return why + ", but " + change_in_words(result.last);
  }
  if (result.last.objection == Objection::place) {
    return why + ", but " + place_in_words(result.last);
  }
  return why + (is_slight_misfit(result.last)
                    ? fmt::format(", but a slight misfit is not explained (noise alone makes as "
                                  "much in one of {:.0f} recordings)",
                                  1.0 / result.last.p_value)
                    : ", but the misfit is not explained");
}

std::string in_words(const HeldOut& held_out) {
  if (held_out.legs.empty())
    return "no leg could be held out: too few, none that ends at a known place, or --holdout 0";
  return fmt::format(
      "{} legs not used in the fit end {:.1f} mm off (rms), stretched by {:.2f} %, turned by "
      "{:.2f} "
      "mrad (means)",
      held_out.legs.size(), 1e3 * held_out.arrival_rms, 100.0 * held_out.stretch_error,
      1e3 * held_out.orientation_error);
}

std::string fit_in_words(double chi2, int dof, int coefficients) {
  return fmt::format("chi2 {:.1f}, dof {}{}", chi2, dof,
                     coefficients == 0 ? std::string()
                     : coefficients == 1
                         ? std::string(" (1 coefficient estimated)")
                         : fmt::format(" ({} coefficients estimated)", coefficients));
}

std::string map_scale_in_words(double scale) {
  constexpr double kNothing = 0.0005;
  const double error = 1.0 / scale - 1.0;
  if (std::abs(error) < kNothing) return "the map's size is right within 0.05 %";
  return fmt::format("the map is {:.1f} % too {}", 100.0 * std::abs(error),
                     error > 0.0 ? "large" : "small");
}

std::string_view verdict_of(const BuiltMap& built) {
  return built.good() ? "good" : "doubtful";
}

std::string verdict_in_words(const BuiltMap& built) {
  if (!built.good()) return fmt::format("{}: {}", verdict_of(built), built.warnings.front());
  const std::string size =
      built.method == Method::adjustment
          ? fmt::format("certain to {:.3f} m (median)", built.quality.median_sd)
          : fmt::format("{:.3f} m off the adjusted one (rms)", built.quality.from_adjusted);
  return fmt::format("{}: nothing speaks against this {}, {}", verdict_of(built),
                     built.paths.empty() ? "map" : "path", size);
}

}  // namespace trussmap
