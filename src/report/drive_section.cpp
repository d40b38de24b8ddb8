// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/drive_charts.hpp"
#include "report/page.hpp"
#include "trussmap/pages.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace trussmap {

Page with_drive(const Page& page, const Robot& robot,
                const std::vector<DrivenRecording>& recordings) {
  if (robot.drive == DriveKind::differential) return page;
  std::optional<plot::Steering> steering = plot::steering_of(recordings);
  report::ChartRow charts;
  plot::Chart wheels =
      plot::wheels_chart(robot, steering ? std::optional(steering->angles) : std::nullopt);
  if (!wheels.layers.empty()) charts.push_back(std::move(wheels));
  if (steering) charts.push_back(std::move(steering->chart));
  if (charts.empty()) return page;
  report::PageContent content = page.content();
  const auto tables =
      std::find_if(content.sections.begin(), content.sections.end(),
                   [](const report::PageSection& section) { return section.title == "Tables"; });
  content.sections.insert(tables, {"The robot's drive", {std::move(charts)}});
  return content;
}

}  // namespace trussmap
