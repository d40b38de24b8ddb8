// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A workbench at work: one step after the other on a thread of its own, each kept on disk when it
// is done. Everybody else looks at what the last step left, which never changes.
//
//   FOLDER/steps.json   the log (model_file.hpp); the work goes on from it when begun again
//   FOLDER/model.toml   the model of the present step, as fitted
#pragma once

#include "progress.hpp"
#include "trussmap/workbench.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace trussmap::app {

struct BenchJob {
  PreparedRecordings rows;  ///< of the model
  Model model;              ///< as given
  DiagnoseOptions options;
  std::string subject;           ///< recordings and model, for people
  std::filesystem::path folder;  ///< where steps are kept
};

/// What a step left.
struct BenchView {
  std::size_t version = 0;  ///< counts whatever changes
  TriedModel now;
  WorkbenchLog log;
  std::string json;  ///< for the page
};

class BenchWork {
 public:
  /// Reads the log, where there is one, and begins. Throws InputError on a log of other work, or
  /// where the folder cannot be written.
  explicit BenchWork(BenchJob job);
  /// Ends when the step under way is done.
  ~BenchWork();
  BenchWork(const BenchWork&) = delete;
  BenchWork& operator=(const BenchWork&) = delete;

  /// nullptr until the first model has been fitted.
  [[nodiscard]] std::shared_ptr<const BenchView> view() const;

  enum class Taken { yes, busy, outdated };
  /// What is done, and what that is called: "Adding hard iron".
  struct Step {
    std::string title;
    std::function<void(Workbench&, const WorkbenchWatch&)> run;
  };
  /// A step on what `version` left. What goes wrong in it is said in the next status.
  Taken begin(std::size_t version, Step step);
  /// Ends the step under way soon, if there is one: everything stays as it was before it. The first
  /// model is fitted to its end.
  void stop();

  /// {"version", "busy", "step", "stops", "doing", "left" [s], "failed", "note"}.
  [[nodiscard]] std::string status() const;

 private:
  void run();
  void work(const Step& step);
  void publish(const Workbench& bench);
  void keep(const std::optional<Workbench>& before);
  void show(const TriedModel& now, const WorkbenchLog& log, bool provisional);
  [[nodiscard]] WorkbenchWatch watch();
  [[nodiscard]] double seconds() const;

  BenchJob job_;
  std::optional<WorkbenchLog> log_;   ///< of earlier work
  std::unique_ptr<Workbench> bench_;  ///< the thread's own
  mutable std::mutex mutex_;          // of what follows
  std::condition_variable wake_;
  std::shared_ptr<const BenchView> view_;
  std::optional<Step> next_;
  bool busy_ = true;
  bool ends_ = false;
  std::string title_;  ///< of the step under way, or the last; empty: the first model
  std::atomic<bool> stop_ = false;
  std::string failed_;
  std::string note_;
  std::optional<ProgressClock> clock_;
  std::chrono::steady_clock::time_point began_;
  std::thread thread_;
};

}  // namespace trussmap::app
