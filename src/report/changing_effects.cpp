// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/changing_effects.hpp"

#include "plot/layers.hpp"
#include "report/page_words.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

/// Columns of a stair: each part from its beginning to its end, a gap between sessions.
struct Stair {
  std::vector<double> t;
  std::vector<double> value;
  std::vector<double> low;
  std::vector<double> high;

  void add(double at, double mean, double sd) {
    t.push_back(at);
    value.push_back(mean);
    low.push_back(mean - plot::kNormal95 * sd);
    high.push_back(mean + plot::kNormal95 * sd);
  }
};

Stair stair_of(const std::vector<CoursePart>& course, std::size_t session) {
  Stair stair;
  for (const CoursePart& part : course) {
    if (part.session != session) continue;
    stair.add(part.from, part.value, part.sd);
    stair.add(part.until, part.value, part.sd);
  }
  return stair;
}

plot::Chart course_chart(const ChangingCoefficient& change, std::size_t number) {
  plot::Chart chart;
  chart.id = fmt::format("course-{}", number + 1);
  chart.title = capitalised(name_in_words(change.effect)) + " while driving";
  chart.caption =
      "The coefficient of each while of driving, with its 95 % band: the mean over all moments and "
      "sizes that the change may have. Dashed: the same all the time, as the model has it.";
  chart.x.title = "t [s]";
  chart.y.title =
      change.effect.coefficients.size() > 1 ? "times its size throughout" : "coefficient";
  const std::size_t sessions = change.course.empty() ? 0 : change.course.back().session + 1;
  for (std::size_t k = 0; k < sessions; ++k) {
    const Stair stair = stair_of(change.course, k);
    if (stair.t.empty()) continue;
    const std::string colour = std::to_string(k % 8 + 1);
    const std::string name = sessions > 1 ? fmt::format("recording {}", k + 1) : "course";
    chart.layers.push_back({plot::LayerKind::band,
                            "",
                            {{"t [s]", stair.t}, {"from", stair.low}, {"to", stair.high}},
                            colour});
    chart.layers.push_back(
        {plot::LayerKind::line, name, {{"t [s]", stair.t}, {"value", stair.value}}, colour});
  }
  plot::ChartLayer level{
      plot::LayerKind::level, "all the time the same", {{"value", {change.fitted}}}, "faint"};
  level.dashed = true;
  chart.layers.push_back(std::move(level));
  return chart;
}

}  // namespace

std::string changing_text(const Diagnosis& diagnosis) {
  std::string text;
  for (const ChangingCoefficient& one : diagnosis.changing) {
    if (text.empty()) text = "\nWhat changes while driving\n";
    text += fmt::format("  {} (p {})\n", in_words(one), probability_text(one.p_value));
  }
  return text;
}

void add_changes(const Diagnosis& diagnosis, PageContent& page) {
  if (diagnosis.changing.empty()) return;
  ChartRow charts;
  for (const ChangingCoefficient& one : diagnosis.changing) {
    charts.push_back(course_chart(one, charts.size()));
  }
  page.sections.push_back(told_section("What changes while driving",
                                       sentences_of(diagnosis.changing), std::move(charts)));
}

}  // namespace trussmap::report
