// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "parallel/parallel_for.hpp"
#include "trussmap/running.hpp"

#include <atomic>
#include <cstddef>
#include <thread>

#include <gtest/gtest.h>

namespace trussmap::stop_test {
namespace {

TEST(Stop, NobodyIsAskedWithoutAQuestion) {
  EXPECT_NO_THROW(stop_if_asked());
  std::size_t turns = 0;
  parallel::parallel_for(100, [&](std::size_t) { ++turns; });
  EXPECT_EQ(turns, 100U);
}

TEST(Stop, ALoopEndsWhereTheAnswerIsYes) {
  int asked = 0;
  const StopQuestion question([&] {
    ++asked;
    return true;
  });
  std::size_t turns = 0;
  EXPECT_THROW(parallel::parallel_for(100, [&](std::size_t) { ++turns; }), StoppedOnRequest);
  EXPECT_EQ(turns, 0U);
  EXPECT_THROW(stop_if_asked(), StoppedOnRequest);
  EXPECT_EQ(asked, 1);  // once yes, always yes
}

TEST(Stop, TheQuestionIsAskedNowAndThenAlone) {
  int asked = 0;
  const StopQuestion question([&] {
    ++asked;
    return false;
  });
  for (int k = 0; k < 1000; ++k) stop_if_asked();
  EXPECT_GE(asked, 1);
  EXPECT_LT(asked, 1000);
}

TEST(Stop, IsOfOneThread) {
  const StopQuestion question([] { return true; });
  bool thrown = false;
  std::thread other([&] {
    try {
      stop_if_asked();
    } catch (const StoppedOnRequest&) {
      thrown = true;
    }
  });
  other.join();
  EXPECT_FALSE(thrown);
}

TEST(Stop, QuestionsEndInReverseOrder) {
  const StopQuestion outer([] { return true; });
  {
    const StopQuestion inner([] { return false; });
    EXPECT_NO_THROW(stop_if_asked());
  }
  EXPECT_THROW(stop_if_asked(), StoppedOnRequest);
}

TEST(Stop, EndsALoopOnManyThreads) {
  const int before = threads();
  set_threads(4);
  std::atomic<bool> asked_to = false;
  const StopQuestion question([&] { return asked_to.load(); });
  std::atomic<std::size_t> turns = 0;
  asked_to = true;
  EXPECT_THROW(parallel::parallel_for(100000,
                                      [&](std::size_t) {
                                        ++turns;
                                        std::this_thread::yield();
                                      }),
               StoppedOnRequest);
  EXPECT_LT(turns, 100000U);
  set_threads(before);
}

}  // namespace
}  // namespace trussmap::stop_test
