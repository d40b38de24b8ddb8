// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the processes say to each other: sums, sequences and letters, in the order of their ranks,
// so that nothing depends on who is first.
#pragma once

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <cstdint>
#include <mpi.h>
#include <numeric>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace trussmap::distributed {

/// Throws SolveError unless an MPI call has succeeded.
void require_mpi(int status, const char* what);

/// A type of MPI's for the bytes of a plain struct.
class PlainType {
 public:
  explicit PlainType(std::size_t bytes);
  ~PlainType();
  PlainType(const PlainType&) = delete;
  PlainType& operator=(const PlainType&) = delete;
  [[nodiscard]] MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

/// Something that one process has found wrong with a line of a file.
struct Fault {
  std::size_t line = 0;
  std::string what;
};

class Communicator {
 public:
  explicit Communicator(MPI_Comm comm = MPI_COMM_WORLD);

  [[nodiscard]] MPI_Comm get() const { return comm_; }
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int count() const { return count_; }

  [[nodiscard]] std::int64_t sum(std::int64_t value) const;
  /// Of the doubles in the order of the ranks.
  [[nodiscard]] double sum(double value) const;
  [[nodiscard]] std::int64_t least(std::int64_t value) const;
  [[nodiscard]] double least(double value) const;
  [[nodiscard]] std::vector<std::int64_t> sums(std::vector<std::int64_t> values) const;
  /// Of the processes before this one.
  [[nodiscard]] std::int64_t sum_before(std::int64_t value) const;
  /// One of each process.
  [[nodiscard]] std::vector<std::int64_t> all_of(std::int64_t value) const;
  [[nodiscard]] std::string from(int rank, std::string text) const;
  [[nodiscard]] std::vector<std::string> gather(const std::string& text) const;

  /// Throws InputError in all processes where one of them has a fault: that of the first line.
  void agree(const std::string& file, const std::optional<Fault>& fault) const;
  /// True where it is in all of them.
  [[nodiscard]] bool all(bool here) const { return least(std::int64_t{here ? 1 : 0}) == 1; }

  /// Letters to every process; what comes is in the order of the senders, and each sender's in its
  /// own. `counts`, where asked for: how many come from each.
  template <typename T>
  [[nodiscard]] std::vector<T> exchange(const std::vector<std::vector<T>>& letters,
                                        std::vector<int>* counts = nullptr) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<int> sent;
    std::vector<T> outgoing;
    std::size_t all = 0;
    for (const std::vector<T>& one : letters) all += one.size();
    outgoing.reserve(all);
    for (const std::vector<T>& one : letters) {
      sent.push_back(fitting(one.size()));
      outgoing.insert(outgoing.end(), one.begin(), one.end());
    }
    std::vector<int> received(sent.size());
    require_mpi(MPI_Alltoall(sent.data(), 1, MPI_INT, received.data(), 1, MPI_INT, comm_),
                "counts");
    const std::vector<int> from = starts(sent);
    const std::vector<int> to = starts(received);
    std::vector<T> incoming(static_cast<std::size_t>(to.back()));
    const PlainType type(sizeof(T));
    require_mpi(MPI_Alltoallv(outgoing.data(), sent.data(), from.data(), type.get(),
                              incoming.data(), received.data(), to.data(), type.get(), comm_),
                "letters");
    if (counts != nullptr) *counts = received;
    return incoming;
  }

  /// Asks `whom[k]` the question k; answers in the order of the questions. `answer` is called for
  /// questions of others, too.
  template <typename Question, typename Answer>
  [[nodiscard]] auto ask(const std::vector<Question>& questions, const std::vector<int>& whom,
                         const Answer& answer) const {
    using Reply = std::invoke_result_t<Answer, const Question&>;
    std::vector<std::vector<Question>> letters(static_cast<std::size_t>(count_));
    for (std::size_t k = 0; k < questions.size(); ++k) {
      letters[static_cast<std::size_t>(whom[k])].push_back(questions[k]);
    }
    std::vector<int> counts;
    const std::vector<Question> asked = exchange(letters, &counts);
    std::vector<std::vector<Reply>> replies(letters.size());
    std::size_t at = 0;
    for (std::size_t r = 0; r < replies.size(); ++r) {
      for (int k = 0; k < counts[r]; ++k) replies[r].push_back(answer(asked[at++]));
    }
    std::vector<int> sent;
    for (const auto& one : letters) sent.push_back(static_cast<int>(one.size()));
    const std::vector<Reply> come = exchange(replies);
    std::vector<int> next = starts(sent);
    std::vector<Reply> result;
    result.reserve(questions.size());
    for (const int r : whom) {
      result.push_back(come[static_cast<std::size_t>(next[static_cast<std::size_t>(r)]++)]);
    }
    return result;
  }

 private:
  /// Throws SolveError where there are more letters than MPI counts.
  [[nodiscard]] static int fitting(std::size_t count);
  /// 0, first, first + second, ...; throws like fitting().
  [[nodiscard]] static std::vector<int> starts(const std::vector<int>& counts);

  MPI_Comm comm_;
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace trussmap::distributed
