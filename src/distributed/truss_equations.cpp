// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/truss_equations.hpp"

#include "geometry/index.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace trussmap::distributed {
namespace {

constexpr int kPerLandmark = 2;  // unknowns

/// A landmark's bars by neighbour: the neighbour's number, and the bar.
struct End {
  std::int64_t neighbour;
  std::size_t bar;
};

/// The bars' ends at this process's landmarks: of landmark k from starts[k] on, by neighbour, then
/// in the order of the file.
struct Ends {
  std::vector<std::size_t> starts;
  std::vector<End> ends;
};

Ends ends_at(const Placing& placing, const std::vector<ShareBar>& bars) {
  const std::size_t count = placing.own().size();
  Ends result;
  result.starts.assign(count + 1, 0);
  for (const ShareBar& bar : bars) {
    if (placing.mine(bar.from)) ++result.starts[placing.local(bar.from) + 1];
    if (placing.mine(bar.to)) ++result.starts[placing.local(bar.to) + 1];
  }
  for (std::size_t k = 0; k < count; ++k) result.starts[k + 1] += result.starts[k];
  result.ends.resize(result.starts.back());
  std::vector<std::size_t> next(result.starts.begin(), result.starts.end() - 1);
  for (std::size_t b = 0; b < bars.size(); ++b) {
    const ShareBar& bar = bars[b];
    if (placing.mine(bar.from)) result.ends[next[placing.local(bar.from)]++] = {bar.to, b};
    if (placing.mine(bar.to)) result.ends[next[placing.local(bar.to)]++] = {bar.from, b};
  }
  const auto place = [&](std::size_t at) {
    return result.ends.begin() + static_cast<std::ptrdiff_t>(at);
  };
  for (std::size_t k = 0; k < count; ++k) {
    std::stable_sort(place(result.starts[k]), place(result.starts[k + 1]),
                     [](const End& a, const End& b) { return a.neighbour < b.neighbour; });
  }
  return result;
}

struct Block {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  void add(const ShareBar& bar) {
    xx += bar.xx;
    xy += bar.xy;
    yy += bar.yy;
  }
};

/// Writes one landmark's two rows.
class RowWriter {
 public:
  RowWriter(const Placing& placing, const std::vector<ShareBar>& bars, Mat K, Vec f)
      : placing_(placing), bars_(bars), K_(K), f_(f) {}

  void write(std::size_t k, const End* begin, const End* end) {
    const std::int64_t number = placing_.first() + static_cast<std::int64_t>(k);
    const bool held = placing_.own()[k].fixed == 1;
    Block diagonal;
    std::array<PetscScalar, kPerLandmark> force{};
    for (const End* at = begin; at != end;) {
      const std::int64_t neighbour = at->neighbour;
      Block coupling;
      bool free = !held;
      for (; at != end && at->neighbour == neighbour; ++at) {
        const ShareBar& bar = bars_[at->bar];
        const bool pulled = bar.to == number;
        const double sign = pulled ? 1.0 : -1.0;
        coupling.add(bar);
        force[0] += sign * (bar.xx * bar.off_x + bar.xy * bar.off_y);
        force[1] += sign * (bar.xy * bar.off_x + bar.yy * bar.off_y);
        free = free && (pulled ? bar.from_held : bar.to_held) == 0;
      }
      diagonal.xx += coupling.xx;
      diagonal.xy += coupling.xy;
      diagonal.yy += coupling.yy;
      if (free) put(number, neighbour, {-coupling.xx, -coupling.xy, -coupling.yy});
    }
    if (held) {
      const double size = (diagonal.xx + diagonal.yy) / 2.0;
      diagonal = {size > 0.0 ? size : 1.0, 0.0, size > 0.0 ? size : 1.0};
      force = {};
    }
    put(number, number, diagonal);
    const auto row = static_cast<PetscInt>(number);
    require_petsc(VecSetValuesBlocked(f_, 1, &row, force.data(), INSERT_VALUES), "the forces");
  }

 private:
  void put(std::int64_t row, std::int64_t column, const Block& block) {
    const std::array<PetscScalar, 4> values{block.xx, block.xy, block.xy, block.yy};
    const auto r = static_cast<PetscInt>(row);
    const auto c = static_cast<PetscInt>(column);
    require_petsc(MatSetValuesBlocked(K_, 1, &r, 1, &c, values.data(), INSERT_VALUES),
                  "the stiffness matrix");
  }

  const Placing& placing_;
  const std::vector<ShareBar>& bars_;
  Mat K_;
  Vec f_;
};

void allocate(const Communicator& all, const Placing& placing, const Ends& ends,
              TrussEquations& made) {
  const std::size_t count = placing.own().size();
  std::vector<PetscInt> near(count, 1);
  std::vector<PetscInt> far(count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t e = ends.starts[k]; e < ends.starts[k + 1]; ++e) {
      if (e > ends.starts[k] && ends.ends[e].neighbour == ends.ends[e - 1].neighbour) continue;
      ++(placing.mine(ends.ends[e].neighbour) ? near : far)[k];
    }
  }
  const auto rows = static_cast<PetscInt>(kPerLandmark * count);
  require_petsc(MatCreate(all.get(), made.K.place()), "the stiffness matrix");
  const Mat K = made.K.get();
  require_petsc(MatSetSizes(K, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE), "the matrix's size");
  require_petsc(MatSetType(K, MATAIJ), "the stiffness matrix");
  require_petsc(MatXAIJSetPreallocation(K, kPerLandmark, near.data(), far.data(), nullptr, nullptr),
                "the matrix's memory");
  require_petsc(MatSetOption(K, MAT_SPD, PETSC_TRUE), "the stiffness matrix");
  require_petsc(MatSetOption(K, MAT_SPD_ETERNAL, PETSC_TRUE), "the stiffness matrix");
  require_petsc(MatSetOption(K, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE), "the stiffness matrix");
  require_petsc(VecCreate(all.get(), made.f.place()), "the forces");
  require_petsc(VecSetBlockSize(made.f.get(), kPerLandmark), "the forces");
  require_petsc(VecSetSizes(made.f.get(), rows, PETSC_DETERMINE), "the forces");
  require_petsc(VecSetType(made.f.get(), VECSTANDARD), "the forces");
}

}  // namespace

TrussEquations make_equations(const Communicator& all, const Placing& placing,
                              const std::vector<ShareBar>& bars) {
  if (placing.count() > std::numeric_limits<PetscInt>::max() / kPerLandmark) {
    throw SolveError(
        "the truss has more landmarks than this PETSc counts: build with its 64-bit "
        "variant (Debian: libpetsc64-real-dev)");
  }
  const Ends ends = ends_at(placing, bars);
  TrussEquations made;
  allocate(all, placing, ends, made);
  RowWriter writer(placing, bars, made.K.get(), made.f.get());
  for (std::size_t k = 0; k < placing.own().size(); ++k) {
    writer.write(k, ends.ends.data() + ends.starts[k], ends.ends.data() + ends.starts[k + 1]);
  }
  require_petsc(VecAssemblyBegin(made.f.get()), "the forces");
  require_petsc(VecAssemblyEnd(made.f.get()), "the forces");
  require_petsc(MatAssemblyBegin(made.K.get(), MAT_FINAL_ASSEMBLY), "the stiffness matrix");
  require_petsc(MatAssemblyEnd(made.K.get(), MAT_FINAL_ASSEMBLY), "the stiffness matrix");
  return made;
}

void tell_rigid_body_modes(const Communicator& all, const Placing& placing, Mat K) {
  OwnedVector places;
  require_petsc(VecCreate(all.get(), places.place()), "the positions");
  require_petsc(VecSetBlockSize(places.get(), kPerLandmark), "the positions");
  require_petsc(
      VecSetSizes(places.get(), static_cast<PetscInt>(kPerLandmark * placing.own().size()),
                  PETSC_DETERMINE),
      "the positions");
  require_petsc(VecSetType(places.get(), VECSTANDARD), "the positions");
  PetscScalar* values = nullptr;
  require_petsc(VecGetArrayWrite(places.get(), &values), "the positions");
  for (std::size_t k = 0; k < placing.own().size(); ++k) {
    values[kPerLandmark * k] = placing.own()[k].x;
    values[kPerLandmark * k + 1] = placing.own()[k].y;
  }
  require_petsc(VecRestoreArrayWrite(places.get(), &values), "the positions");
  OwnedNullSpace modes;
  require_petsc(MatNullSpaceCreateRigidBody(places.get(), modes.place()), "the rigid-body modes");
  require_petsc(MatSetNearNullSpace(K, modes.get()), "the rigid-body modes");
}

}  // namespace trussmap::distributed
