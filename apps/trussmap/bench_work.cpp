// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "bench_work.hpp"

#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/running.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <sys/resource.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

constexpr const char* kLog = "steps.json";
constexpr const char* kModel = "model.toml";

std::vector<Stage> stages() {
  return {{"fitting the map", 5}, {"looking for what is missing", 50}, {"comparing", 10}};
}

bool same_spans(const std::vector<std::vector<TimeSpan>>& a,
                const std::vector<std::vector<TimeSpan>>& b) {
  const auto same = [](const TimeSpan& one, const TimeSpan& other) {
    return one.from == other.from && one.to == other.to;
  };
  return std::ranges::equal(a, b, [&same](const auto& one, const auto& other) {
    return std::ranges::equal(one, other, same);
  });
}

/// Makes it where it is missing: better said now than after the first step.
void require_writable(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  std::string probe = (folder / ".trussmap-XXXXXX").string();
  const int file = failed ? -1 : ::mkstemp(probe.data());
  if (file < 0) {
    const std::string why = failed ? failed.message() : std::generic_category().message(errno);
    throw InputError(folder.string(), 0,
                     "cannot be written: " + why + ", expected a folder for the steps (--work)");
  }
  ::close(file);
  ::unlink(probe.c_str());
}

std::optional<WorkbenchLog> log_in(const BenchJob& job) {
  const std::filesystem::path file = job.folder / kLog;
  if (!std::filesystem::exists(file)) return std::nullopt;
  WorkbenchLog log = read_workbench_log(file, job.rows.recordings);
  if (format_model(log.steps.front().model) != format_model(job.model)) {
    throw InputError(file.string(), 0,
                     "the work began with another model, expected the same (or another --work)");
  }
  if (!same_spans(log.steps.front().excluded, job.options.fit.excluded)) {
    throw InputError(file.string(), 0,
                     "the work began with other times excluded, expected the same (or another "
                     "--work)");
  }
  return log;
}

}  // namespace

BenchWork::BenchWork(BenchJob job) : job_(std::move(job)), log_(log_in(job_)) {
  require_writable(job_.folder);
  thread_ = std::thread([this] { run(); });
}

BenchWork::~BenchWork() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

std::shared_ptr<const BenchView> BenchWork::view() const {
  const std::scoped_lock lock(mutex_);
  return view_;
}

BenchWork::Taken BenchWork::begin(std::size_t version, Step step) {
  const std::scoped_lock lock(mutex_);
  if (busy_) return Taken::busy;
  if (!view_ || view_->version != version) return Taken::outdated;
  title_ = step.title;
  next_ = std::move(step);
  stop_ = false;
  busy_ = true;
  failed_.clear();
  wake_.notify_all();
  return Taken::yes;
}

void BenchWork::stop() {
  const std::scoped_lock lock(mutex_);
  if (busy_ && !title_.empty()) stop_ = true;
}

double BenchWork::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

std::string BenchWork::status() const {
  const std::scoped_lock lock(mutex_);
  nlohmann::ordered_json result = {{"version", view_ ? view_->version : 0},
                                   {"busy", busy_},
                                   {"step", busy_ ? title_ : ""},
                                   {"stops", busy_ && !title_.empty() && !stop_},
                                   {"failed", failed_},
                                   {"note", note_}};
  if (busy_ && clock_) {
    result["doing"] = clock_->line(std::floor(seconds()));
    const std::optional<double> left = clock_->left(std::floor(seconds()));
    result["left"] = left ? nlohmann::ordered_json(std::ceil(*left)) : nullptr;
  }
  return result.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

WorkbenchWatch BenchWork::watch() {
  {
    const std::scoped_lock lock(mutex_);
    clock_.emplace(stages());
    began_ = std::chrono::steady_clock::now();
  }
  return {[this](TryingStage stage) {
            const std::scoped_lock lock(mutex_);
            if (stage == TryingStage::fitting) clock_.emplace(stages());
            clock_->next(seconds());
          },
          [this](const TriedModel& now, const WorkbenchLog& log) {
            show(now, log, true);
            const std::scoped_lock lock(mutex_);
            note_ = "The noise is still being estimated: figures may change a little.";
            began_ = std::chrono::steady_clock::now();
          }};
}

void BenchWork::show(const TriedModel& now, const WorkbenchLog& log, bool provisional) {
  std::string json = workbench_json(now, log, job_.subject, provisional);
  const std::scoped_lock lock(mutex_);
  const std::size_t version = view_ ? view_->version + 1 : 1;
  view_ = std::make_shared<const BenchView>(BenchView{version, now, log, std::move(json)});
}

/// On disk first: what is shown as done is never lost.
void BenchWork::publish(const Workbench& bench) {
  const WorkbenchLog& log = bench.log();
  write_files({}, {{job_.folder,
                    {{kLog, format_workbench_log(log, job_.rows.recordings)},
                     {kModel, format_model(bench.now().fit().model)}},
                    {}}});
  show(bench.now(), log, false);
}

/// A step that cannot be written is not done: what is in memory is what is on disk.
void BenchWork::keep(const std::optional<Workbench>& before) {
  try {
    publish(*bench_);
  } catch (...) {
    if (before) {
      *bench_ = *before;
    } else {
      show(bench_->now(), bench_->log(), false);  // the model as given, which nobody loses
    }
    throw;
  }
}

void BenchWork::work(const Step& step) {
  std::string failed;
  const std::shared_ptr<const BenchView> before = view();
  const std::optional<Workbench> kept = bench_ ? std::optional(*bench_) : std::nullopt;
  const auto as_before = [this, &before] {
    if (before && view() != before) show(before->now, before->log, false);
  };
  try {
    {
      const StopQuestion question([this] { return stop_.load(); });
      step.run(*bench_, watch());
    }
    keep(kept);
  } catch (const StoppedOnRequest&) {
    as_before();
  } catch (const std::exception& error) {
    failed = error.what();
    as_before();
  }
  const std::scoped_lock lock(mutex_);
  failed_ = std::move(failed);
  note_.clear();
  busy_ = false;
}

void BenchWork::run() {
#ifdef __linux__
  // Of this thread and of those that it begins: the browser that shows the page comes first.
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, 10));
#endif
  const auto first = [this](Workbench&, const WorkbenchWatch& watch) {
    bench_ = log_ ? std::make_unique<Workbench>(job_.rows, *log_, job_.options, watch)
                  : std::make_unique<Workbench>(job_.rows, job_.model, job_.options, watch);
  };
  work({"", first});
  while (true) {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return ends_ || next_; });
    if (ends_) return;
    const Step step = std::move(*next_);
    next_.reset();
    lock.unlock();
    work(step);
  }
}

}  // namespace trussmap::app
