// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "parallel/parallel_for.hpp"

#include "trussmap/running.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace trussmap {
namespace {

std::atomic<int> wanted = 1;
thread_local bool within_turn = false;

/// Threads that wait for work; made when first needed.
class Pool {
 public:
  Pool() = default;
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  Pool(Pool&&) = delete;
  Pool& operator=(Pool&&) = delete;

  ~Pool() {
    {
      const std::scoped_lock lock(mutex_);
      ends_ = true;
    }
    begin_.notify_all();
    for (std::thread& one : threads_) one.join();
  }

  /// `work` on the caller's thread and on up to `helpers` others, those that come while it lasts;
  /// false, and nothing done, where another caller has them. `work` must not throw.
  bool run(std::size_t helpers, const std::function<void()>& work) {
    const std::unique_lock caller(caller_, std::try_to_lock);
    if (!caller.owns_lock()) return false;
    {
      const std::scoped_lock lock(mutex_);
      hire(helpers);
      work_ = &work;
      open_ = helpers;
    }
    begin_.notify_all();
    work();
    std::unique_lock lock(mutex_);
    open_ = 0;
    end_.wait(lock, [this] { return working_ == 0; });
    return true;
  }

 private:
  void hire(std::size_t helpers) {
    try {
      while (threads_.size() < helpers) threads_.emplace_back([this] { wait_and_work(); });
    } catch (const std::system_error&) {
      return;  // those that there are have to do
    }
  }

  void wait_and_work() {
    within_turn = true;
    std::unique_lock lock(mutex_);
    while (true) {
      begin_.wait(lock, [this] { return ends_ || open_ > 0; });
      if (ends_) return;
      --open_;
      ++working_;
      const std::function<void()>& work = *work_;
      lock.unlock();
      work();
      lock.lock();
      --working_;
      end_.notify_one();
    }
  }

  std::mutex caller_;
  std::mutex mutex_;  // of what follows
  std::condition_variable begin_;
  std::condition_variable end_;
  std::vector<std::thread> threads_;
  const std::function<void()>* work_ = nullptr;
  std::size_t open_ = 0;
  std::size_t working_ = 0;
  bool ends_ = false;
};

Pool& pool() {
  static Pool the_pool;
  return the_pool;
}

/// Turns handed out one after the other, until one fails.
class Turns {
 public:
  Turns(std::size_t turns, const std::function<void(std::size_t)>& turn)
      : turns_(turns), turn_(turn) {}

  void work() {
    const bool before = within_turn;
    within_turn = true;
    for (std::size_t k = next_++; k < turns_ && k < failed_; k = next_++) {
      try {
        stop_if_asked();
        turn_(k);
      } catch (...) {
        const std::scoped_lock lock(mutex_);
        if (k < failed_) {
          failed_ = k;
          error_ = std::current_exception();
        }
      }
    }
    within_turn = before;
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::size_t turns_;
  const std::function<void(std::size_t)>& turn_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<std::size_t> failed_ = std::numeric_limits<std::size_t>::max();
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

void set_threads(int threads) {
  if (threads < 1) {
    throw std::invalid_argument("1 thread at least is needed, not " + std::to_string(threads));
  }
  wanted = threads;
}

int threads() {
  return wanted;
}

int available_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace trussmap

namespace trussmap::parallel {

bool is_parallel() {
  return !within_turn && threads() > 1;
}

void parallel_for(std::size_t turns, const std::function<void(std::size_t)>& turn) {
  if (turns > 1 && is_parallel()) {
    Turns shared(turns, turn);
    const std::size_t helpers = std::min(turns, static_cast<std::size_t>(threads())) - 1;
    if (pool().run(helpers, [&shared] { shared.work(); })) return shared.rethrow();
  }
  for (std::size_t k = 0; k < turns; ++k) {
    stop_if_asked();
    turn(k);
  }
}

void parallel_ranges(std::size_t turns, std::size_t block,
                     const std::function<void(std::size_t begin, std::size_t end)>& range) {
  parallel_for((turns + block - 1) / block,
               [&](std::size_t k) { range(k * block, std::min(turns, (k + 1) * block)); });
}

}  // namespace trussmap::parallel
