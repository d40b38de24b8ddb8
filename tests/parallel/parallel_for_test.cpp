// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "parallel/parallel_for.hpp"

#include "trussmap/running.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::parallel_for_test {
using namespace parallel;
namespace {

class ParallelFor : public ::testing::Test {
 protected:
  ~ParallelFor() override { set_threads(1); }
};

TEST_F(ParallelFor, RunsEveryTurnOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    set_threads(threads);
    for (const std::size_t turns : {0U, 1U, 2U, 1000U}) {
      std::vector<std::atomic<int>> runs(turns);
      parallel_for(turns, [&runs](std::size_t k) { ++runs[k]; });
      for (const std::atomic<int>& one : runs) EXPECT_EQ(one, 1);
    }
  }
}

TEST_F(ParallelFor, RangesCoverAllTurnsWithoutOverlap) {
  set_threads(3);
  std::vector<std::atomic<int>> runs(103);
  parallel_ranges(runs.size(), 10, [&runs](std::size_t begin, std::size_t end) {
    EXPECT_LE(end - begin, 10U);
    for (std::size_t k = begin; k < end; ++k) ++runs[k];
  });
  for (const std::atomic<int>& one : runs) EXPECT_EQ(one, 1);
}

TEST_F(ParallelFor, LoopsWithinATurnRunOnItsThread) {
  set_threads(4);
  parallel_for(8, [](std::size_t) {
    EXPECT_FALSE(is_parallel());
    const std::thread::id own = std::this_thread::get_id();
    int sum = 0;
    parallel_for(100, [&](std::size_t k) {
      EXPECT_EQ(std::this_thread::get_id(), own);
      sum += static_cast<int>(k);
    });
    EXPECT_EQ(sum, 4950);
  });
  EXPECT_TRUE(is_parallel());
}

TEST_F(ParallelFor, ThrowsWhatTheLowestTurnThrew) {
  for (const int threads : {1, 4}) {
    set_threads(threads);
    for (int round = 0; round < 50; ++round) {
      try {
        parallel_for(100, [](std::size_t k) {
          if (k % 7 == 5) throw std::runtime_error(std::to_string(k));
        });
        ADD_FAILURE() << "nothing thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_EQ(std::string(error.what()), "5");
      }
    }
  }
}

TEST_F(ParallelFor, CallersShareTheThreads) {
  set_threads(3);
  std::vector<std::thread> callers;
  std::atomic<int> sum = 0;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&sum] {
      for (int round = 0; round < 100; ++round) {
        parallel_for(20, [&sum](std::size_t) { ++sum; });
      }
    });
  }
  for (std::thread& one : callers) one.join();
  EXPECT_EQ(sum, 4 * 100 * 20);
}

TEST_F(ParallelFor, RefusesNoThread) {
  EXPECT_THROW(set_threads(0), std::invalid_argument);
  EXPECT_THROW(set_threads(-2), std::invalid_argument);
  EXPECT_GE(available_threads(), 1);
}

}  // namespace
}  // namespace trussmap::parallel_for_test
