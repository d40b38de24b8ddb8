// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "measure.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

namespace trussmap::bench {
namespace {

double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  double size = 0.0;
  double resident = 0.0;
  file >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void Stages::end(const std::string& name) {
  const double now = cpu_seconds();
  stages.push_back({name, now - last_});
  last_ = now;
}

double Stages::total() const {
  double sum = 0.0;
  for (const Stage& stage : stages) sum += stage.seconds;
  return sum;
}

double Stages::of(const std::string& name) const {
  for (const Stage& stage : stages) {
    if (stage.name == name) return stage.seconds;
  }
  return 0.0;
}

Run run_apart(const std::function<double(Stages&)>& work) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  std::fflush(stdout);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    const double before = resident_megabytes();
    Stages stages;
    std::string text;
    try {
      const double answer = work(stages);
      rusage usage{};
      getrusage(RUSAGE_SELF, &usage);
      text = fmt::format("{:.17g} {}\n", answer,
                         static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6 - before);
      for (const auto& stage : stages.stages) {
        text += fmt::format("{} {:.17g}\n", stage.name, stage.seconds);
      }
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    const bool written = !text.empty() && write(ends[1], text.data(), text.size()) ==
                                              static_cast<ssize_t>(text.size());
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t got = 0; (got = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  if (waitpid(child, &status, 0) != child || status != 0)
    throw std::runtime_error("a rival's process failed");
  Run run;
  int used = 0;
  std::sscanf(text.c_str(), "%lf %lf\n%n", &run.answer, &run.megabytes, &used);
  for (std::size_t at = static_cast<std::size_t>(used); at < text.size();) {
    const std::size_t blank = text.find(' ', at);
    const std::size_t end = text.find('\n', at);
    run.stages.stages.push_back(
        {text.substr(at, blank - at), std::stod(text.substr(blank + 1, end - blank - 1))});
    at = end + 1;
  }
  return run;
}

std::vector<Run> race(const std::vector<Rival>& rivals, int repetitions) {
  std::vector<Run> best(rivals.size());
  for (int round = 0; round < repetitions; ++round) {
    for (std::size_t k = 0; k < rivals.size(); ++k) {
      Run run = run_apart(rivals[k].work);
      if (round == 0) {
        best[k] = std::move(run);
        continue;
      }
      best[k].megabytes = std::max(best[k].megabytes, run.megabytes);
      for (std::size_t s = 0; s < run.stages.stages.size(); ++s) {
        double& least = best[k].stages.stages[s].seconds;
        least = std::min(least, run.stages.stages[s].seconds);
      }
    }
  }
  return best;
}

void print(const std::vector<Rival>& rivals, const std::vector<Run>& runs) {
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    std::string line = fmt::format("  {:<34}", rivals[k].name);
    for (const auto& stage : runs[k].stages.stages) {
      line += fmt::format(" {} {:.2f}", stage.name, 1e3 * stage.seconds);
    }
    line += fmt::format(" | total {:.2f} ms, {:.0f} MB, {:.3f} of the first; answer {:.10g}",
                        1e3 * runs[k].stages.total(), runs[k].megabytes,
                        runs[k].stages.total() / runs[0].stages.total(), runs[k].answer);
    fmt::print("{}\n", line);
  }
}

void verdict(const std::string& what, double value, double limit) {
  fmt::print("  {} {}: {:.3f}, at most {:g} wanted\n", value <= limit ? "holds " : "MISSED", what,
             value, limit);
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace trussmap::bench
