// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Runs in shares: every trial once, and a message that names what is missing or there twice.

#include "trussmap/tour_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::shards_test {
namespace {

using Shares = std::vector<std::pair<std::string, ShardResults>>;

/// The shares of a run whose trial k comes to k / 7.
Shares shares_of(int of, std::size_t trials) {
  Shares shares;
  for (int number = 1; number <= of; ++number) {
    ShardResults one{"program", R"({"seeds":1})", {number, of}, trials, {}};
    for (std::size_t k = 0; k < trials; ++k) {
      if (one.shard.has(k)) one.results.emplace(k, std::to_string(k));
    }
    const std::string name = "part" + std::to_string(number);
    shares.emplace_back(name, parse_shard_results(format_shard(one), name));
  }
  return shares;
}

std::string fault_of(const Shares& shares) {
  try {
    static_cast<void>(merge_shards(shares));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Shards, AreReadFromWords) {
  EXPECT_EQ(parse_shard("3/16").number, 3);
  EXPECT_EQ(parse_shard("3/16").of, 16);
  for (const char* wrong : {"", "3", "0/4", "5/4", "-1/4", "1/0", "1/4x", "a/b", "1/ 4"}) {
    EXPECT_THROW(static_cast<void>(parse_shard(wrong)), std::invalid_argument) << wrong;
  }
}

TEST(Shards, EveryTrialIsInOneOfThem) {
  for (const int of : {1, 3, 16, 40}) {
    Shares shares = shares_of(of, 25);
    std::reverse(shares.begin(), shares.end());
    const ShardResults whole = merge_shards(shares);
    EXPECT_EQ(whole.results.size(), 25U);
    EXPECT_EQ(format_shard(whole), format_shard(merge_shards(shares_of(1, 25)))) << of;
  }
}

TEST(Shards, MissingOnesAreNamed) {
  Shares shares = shares_of(16, 25);
  shares.erase(shares.begin() + 6);
  shares.erase(shares.begin() + 2);
  EXPECT_EQ(fault_of(shares), "part1: the run has 16 shards, missing: 3, 7");
}

TEST(Shards, DoubledOnesAreNamed) {
  Shares shares = shares_of(4, 25);
  shares.push_back(shares[2]);
  shares.back().first = "copy";
  EXPECT_EQ(fault_of(shares),
            "part1: there twice: shard 3 (part3 and copy), expected each of the 4 once");
}

TEST(Shards, ThoseOfAnotherRunAreRefused) {
  Shares shares = shares_of(4, 25);
  shares[1].second.settings = R"({"seeds":2})";
  EXPECT_EQ(fault_of(shares),
            "part2: is of another run than part1: the settings differ, expected shards of one run");
}

TEST(Shards, DamagedFilesAreRefused) {
  ShardResults one = shares_of(2, 4).front().second;
  one.results.erase(0);
  EXPECT_THROW(static_cast<void>(parse_shard_results(format_shard(one), "x")), InputError);
  one = shares_of(2, 4).front().second;
  one.results.emplace(1, "1");
  EXPECT_THROW(static_cast<void>(parse_shard_results(format_shard(one), "x")), InputError);
  for (const char* wrong :
       {"", "{}", "[1]", R"({"trussmap_shard":1})", R"({"trussmap_shard":2})"}) {
    EXPECT_THROW(static_cast<void>(parse_shard_results(wrong, "x")), InputError) << wrong;
  }
}

TEST(Shards, ToursInPartsComeToTheSame) {
  TourOptions options;
  options.mesh = even_mesh({3, 3}, 5.0);
  options.tours = 2;
  options.seeds = 5;
  const TourResult whole = run_tours(options);
  std::vector<SeedErrors> seeds(5);
  for (const std::vector<int>& part : std::vector<std::vector<int>>{{4, 0}, {2}, {1, 3}}) {
    const std::vector<SeedErrors> errors = run_tour_seeds(options, part);
    for (std::size_t k = 0; k < part.size(); ++k) {
      seeds[static_cast<std::size_t>(part[k])] = errors[k];
    }
  }
  const TourResult merged = average_tours(seeds);
  for (const std::string& method : tour_methods()) {
    const TourMetrics& a = whole.tours.back().at(method);
    const TourMetrics& b = merged.tours.back().at(method);
    EXPECT_EQ(a.stretch_error.mean, b.stretch_error.mean) << method;
    EXPECT_EQ(a.orientation_error.standard_error, b.orientation_error.standard_error) << method;
  }
}

}  // namespace
}  // namespace trussmap::shards_test
