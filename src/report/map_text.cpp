// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "report/path_text.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::size_t kRejectedShown = 10;

std::string survey_text(const MapOnSurvey& on_survey) {
  std::string text;
  const SurveyComparison& map = on_survey.comparison;
  text += fmt::format("\n  against the survey of {} landmarks, after rotation and translation:\n",
                      map.landmarks);
  text += fmt::format("  {:<28} {:>8.3f} m\n", "rms error of the map", map.rigid.rms);
  if (!std::isnan(on_survey.rms_dead_reckoning)) {
    text +=
        fmt::format("  {:<28} {:>8.3f} m\n", "rms of dead reckoning", on_survey.rms_dead_reckoning);
  }
  if (map.has_scale()) {
    text += fmt::format("  {:<28} {:>8.3f} m  ({})\n", "rms with a scale as well",
                        map.similarity.rms, map_scale_in_words(map.similarity.scale));
  }
  if (map.contradicting.empty()) return text;
  text += fmt::format(
      "\n  These landmarks contradict the survey and do not count above (with them the rms "
      "is {:.3f} m):\n",
      map.rms_all);
  for (const std::string& name : map.contradicting)
    text += fmt::format("    landmark {}\n", shortened_words(name));
  for (const auto& [a, b] : map.exchanged) {
    text += fmt::format(
        "    landmarks {} and {} each lie where the survey has the other: are their labels "
        "exchanged?\n",
        shortened_words(a), shortened_words(b));
  }
  return text;
}

std::string left_out_text(const BuiltMap& built, bool several) {
  std::string text;
  text += fmt::format("  {:<28} {:>8}  of {}\n", "sightings left out", built.rejected.size(),
                      built.quality.sightings);
  for (std::size_t k = 0; k < std::min(built.rejected.size(), kRejectedShown); ++k) {
    const RejectedSighting& one = built.rejected[k];
    const std::string where = several ? one.recording + ", " : "";
    text += fmt::format("    {}t = {:.3f} s: landmark {} seen {:.2f} m from where the map has it\n",
                        where, one.t, shortened_words(one.landmark), one.misfit);
  }
  if (built.rejected.size() > kRejectedShown) {
    text +=
        fmt::format("    and {} more (--json lists all)\n", built.rejected.size() - kRejectedShown);
  }
  return text;
}

std::string quality_text(const BuiltMap& built) {
  std::string text;
  const MapQuality& quality = built.quality;
  text += fmt::format("  {:<28} {:>8.3f} m  (median; worst {:.3f} m, landmark {})\n",
                      "standard error of landmarks", quality.median_sd, quality.worst_sd,
                      shortened_words(quality.worst_landmark));
  if (quality.oriented > 0) {
    text += fmt::format("  {:<28} {:>8}  of {}, their axes good to {:.2f} deg (median)\n",
                        "landmarks with orientation", quality.oriented, built.map.landmarks(),
                        quality.median_sd_heading * geometry::kDegrees);
  }
  if (built.method != Method::adjustment) {
    text += fmt::format("  {:<28} {:>8.3f} m  (rms; the standard errors above are that map's)\n",
                        "off the adjusted map by", quality.from_adjusted);
  }
  text += fmt::format(
      "  {:<28} {:>8.2f}  (chi^2/dof of {} degrees of freedom{}; 1: as the model says)\n",
      "dispersion of the errors", quality.dispersion, built.fit.dof,
      built.on_survey ? " without the survey" : "");
  if (quality.loops > 0) {
    text +=
        fmt::format("  {:<28} {:>7.2f} %  of the way, by dead reckoning (median of {})\n",
                    "loops miss their start by", 100.0 * quality.misclosure_share, quality.loops);
  }
  return text;
}

std::string figures_text(const BuiltMap& built, bool several) {
  std::string text = quality_text(built);
  const auto line = [&text](const char* what, int number) {
    text += fmt::format("  {:<28} {:>8}\n", what, number);
  };
  line("legs", built.legs);
  line("loops closed at first sight", built.first_sight);
  line("known routes driven again", built.refinements);
  line("sightings beside a leg's end", built.side_sightings);
  text += left_out_text(built, several);
  if (built.on_survey) text += survey_text(*built.on_survey);
  return text;
}

}  // namespace

std::string map_text(const BuiltMap& built, const std::string& method, bool several,
                     TextStyle style) {
  std::string text;
  const bool paths = !built.paths.empty();
  if (paths) {
    text += report::paths_headline(built.paths);
  } else {
    text += fmt::format("map of {} landmarks and {} routes, method {}\n", built.map.landmarks(),
                        built.map.routes(), method);
  }
  text += fmt::format("{}\n\n", verdict_text(built.good() ? Mood::good : Mood::doubt,
                                             verdict_in_words(built), style));
  text += paths ? report::paths_text(built) : figures_text(built, several);
  for (std::size_t k = 1; k < built.warnings.size(); ++k) {  // the verdict has the first
    text += fmt::format("\n{}", warning_text(built.warnings[k], style));
  }
  for (const std::string& note : built.notes)
    text += fmt::format("\nnote: {}\n", shortened_words(note));
  return text;
}

}  // namespace trussmap
