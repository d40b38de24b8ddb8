// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/communicator.hpp"

#include "geometry/index.hpp"
#include "trussmap/error.hpp"

#include <limits>

#include <fmt/format.h>

namespace trussmap::distributed {

void require_mpi(int status, const char* what) {
  if (status != MPI_SUCCESS) {
    throw SolveError(fmt::format("the processes cannot exchange {}: MPI error {}", what, status));
  }
}

PlainType::PlainType(std::size_t bytes) {
  require_mpi(MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_), "types");
  require_mpi(MPI_Type_commit(&type_), "types");
}

PlainType::~PlainType() {
  MPI_Type_free(&type_);
}

Communicator::Communicator(MPI_Comm comm) : comm_(comm) {
  require_mpi(MPI_Comm_rank(comm_, &rank_), "ranks");
  require_mpi(MPI_Comm_size(comm_, &count_), "ranks");
}

std::int64_t Communicator::sum(std::int64_t value) const {
  return sums({value}).front();
}

double Communicator::sum(double value) const {
  std::vector<double> all(idx(count_));
  require_mpi(MPI_Allgather(&value, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, comm_), "sums");
  return std::accumulate(all.begin(), all.end(), 0.0);
}

std::int64_t Communicator::least(std::int64_t value) const {
  std::int64_t result = 0;
  require_mpi(MPI_Allreduce(&value, &result, 1, MPI_INT64_T, MPI_MIN, comm_), "bounds");
  return result;
}

double Communicator::least(double value) const {
  double result = 0.0;
  require_mpi(MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, MPI_MIN, comm_), "bounds");
  return result;
}

std::vector<std::int64_t> Communicator::sums(std::vector<std::int64_t> values) const {
  require_mpi(MPI_Allreduce(MPI_IN_PLACE, values.data(), fitting(values.size()), MPI_INT64_T,
                            MPI_SUM, comm_),
              "sums");
  return values;
}

std::int64_t Communicator::sum_before(std::int64_t value) const {
  std::int64_t result = 0;
  require_mpi(MPI_Exscan(&value, &result, 1, MPI_INT64_T, MPI_SUM, comm_), "sums");
  return rank_ == 0 ? 0 : result;
}

std::vector<std::int64_t> Communicator::all_of(std::int64_t value) const {
  std::vector<std::int64_t> all(idx(count_));
  require_mpi(MPI_Allgather(&value, 1, MPI_INT64_T, all.data(), 1, MPI_INT64_T, comm_), "numbers");
  return all;
}

std::string Communicator::from(int rank, std::string text) const {
  auto size = static_cast<std::int64_t>(text.size());
  require_mpi(MPI_Bcast(&size, 1, MPI_INT64_T, rank, comm_), "texts");
  text.resize(idx(size));
  require_mpi(MPI_Bcast(text.data(), fitting(text.size()), MPI_CHAR, rank, comm_), "texts");
  return text;
}

std::vector<std::string> Communicator::gather(const std::string& text) const {
  std::vector<std::vector<char>> letters(idx(count_));
  letters.front().assign(text.begin(), text.end());
  std::vector<int> counts;
  const std::vector<char> come = exchange(letters, &counts);
  std::vector<std::string> texts;
  if (rank_ != 0) return texts;
  auto at = come.begin();
  for (const int count : counts) {
    texts.emplace_back(at, at + count);
    at += count;
  }
  return texts;
}

void Communicator::agree(const std::string& file, const std::optional<Fault>& fault) const {
  constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  const std::int64_t mine = fault ? static_cast<std::int64_t>(fault->line) : kNone;
  const std::int64_t first = least(mine);
  if (first == kNone) return;
  const auto who = static_cast<int>(least(std::int64_t{mine == first ? rank_ : count_}));
  throw InputError(file, idx(first), from(who, fault ? fault->what : ""));
}

int Communicator::fitting(std::size_t count) {
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw SolveError("the truss is too large for so few processes: start more of them");
  }
  return static_cast<int>(count);
}

std::vector<int> Communicator::starts(const std::vector<int>& counts) {
  std::vector<int> result{0};
  std::size_t all = 0;
  for (const int count : counts) {
    all += idx(count);
    result.push_back(fitting(all));
  }
  return result;
}

}  // namespace trussmap::distributed
