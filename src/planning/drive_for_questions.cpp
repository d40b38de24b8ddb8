// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/drive_for_questions.hpp"

#include "planning/instruments.hpp"

namespace trussmap::planning {

std::vector<bool> beyond_drives(const SearchTask& task, const std::vector<double>& before) {
  constexpr double kBeyond = 0.25;  // of the lambda that is lacking
  const std::vector<double> thorough =
      lambdas_of(task, gram_with(task, task.world, plan_of(task.world, thorough_tour(task.world))));
  std::vector<bool> beyond;
  beyond.reserve(thorough.size());
  for (std::size_t k = 0; k < thorough.size(); ++k) {
    beyond.push_back(thorough[k] - before[k] < kBeyond * (task.questions[k].wanted - before[k]));
  }
  return beyond;
}

std::vector<double> drive_for(const SearchTask& task, const std::vector<bool>& beyond,
                              PlannedDrive& result) {
  SearchTask open = task;
  open.questions.clear();
  for (std::size_t k = 0; k < beyond.size(); ++k) {
    if (!beyond[k]) open.questions.push_back(task.questions[k]);
  }
  if (open.questions.empty()) return lambdas_of(task, gram_before(task));
  const FoundTour found = search_tour(open);
  result.enough = found.value.least >= 1.0;
  if (found.tour.legs.empty()) return lambdas_of(task, gram_before(task));
  result.plan = plan_of(task.world, found.tour);
  result.length = found.value.length;
  result.duration = found.value.time;
  result.worth = worth_of_instruments(task, result.plan, beyond);
  return lambdas_of(task, gram_with(task, task.world, result.plan));
}

}  // namespace trussmap::planning
