// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the shared library throws is caught by its type outside of it, and what a caller's function
// throws comes through the library as it is.
#include "trussmap/error.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/running.hpp"
#include "trussmap/truss.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <typeinfo>

#include <gtest/gtest.h>

namespace {

using namespace trussmap;

/// The type of what a call throws, as seen here.
template <typename Call>
const std::type_info* thrown_by(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return &typeid(error);
  }
  return &typeid(void);
}

void ask_for_a_missing_file() {
  static_cast<void>(read_file("no such file"));
}

void solve_what_nothing_holds() {
  static_cast<void>(solve_truss(2, {{0, 1, Matrix2::Identity()}}, {}, {}));
}

void ask_to_stop() {
  StopQuestion question([] { return true; });
  question.ask();
}

TEST(SharedExceptions, HaveTheTypesOfTheHeaders) {
  EXPECT_EQ(*thrown_by(ask_for_a_missing_file), typeid(InputError));
  EXPECT_EQ(*thrown_by(solve_what_nothing_holds), typeid(UnsupportedJoint));
  EXPECT_EQ(*thrown_by(ask_to_stop), typeid(StoppedOnRequest));
  EXPECT_EQ(*thrown_by([] { set_threads(0); }), typeid(std::invalid_argument));
}

TEST(SharedExceptions, AreCaughtByTheirTypesAndTheirBases) {
  EXPECT_THROW(ask_for_a_missing_file(), InputError);
  EXPECT_THROW(ask_for_a_missing_file(), std::runtime_error);
  EXPECT_THROW(solve_what_nothing_holds(), UnsupportedJoint);
  EXPECT_THROW(solve_what_nothing_holds(), SolveError);
  EXPECT_THROW(ask_to_stop(), StoppedOnRequest);
  try {
    solve_what_nothing_holds();
    FAIL() << "a truss held by nothing was solved";
  } catch (const SolveError& error) {
    const auto* joint = dynamic_cast<const UnsupportedJoint*>(&error);
    ASSERT_NE(joint, nullptr);
    EXPECT_GE(joint->joint(), 0);
    EXPECT_NE(std::string(error.what()).find("joint"), std::string::npos);
  }
}

class OfTheCaller : public SolveError {
 public:
  using SolveError::SolveError;
};

TEST(SharedExceptions, OfACallersFunctionComeThrough) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) /
                                     ("trussmap_shared_" + std::string(SHARED_TEST_NAME) + ".map");
  std::filesystem::remove(file);
  {
    MapStore store(file);
    try {
      store.append("a", "a", [](MapBuilder&) { throw OfTheCaller("enough"); });
      FAIL() << "nothing was thrown";
    } catch (const OfTheCaller& error) {
      EXPECT_STREQ(error.what(), "enough");
    }
    EXPECT_FALSE(store.has_session("a"));
  }
  for (const auto& entry : std::filesystem::directory_iterator(file.parent_path())) {
    if (entry.path().string().starts_with(file.string())) std::filesystem::remove(entry.path());
  }
}

}  // namespace
