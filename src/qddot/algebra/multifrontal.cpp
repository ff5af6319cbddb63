#include <algorithm>
#include <array>
#include <atomic>
#include <omp.h>
#include <optional>

#include "qddot/algebra/factors.hpp"
#include "qddot/algebra/large_array.hpp"
#include "qddot/algebra/multifrontal/fetch_ahead.hpp"
#include "qddot/algebra/multifrontal/front_kernels.hpp"
#include "qddot/algebra/multifrontal/fronts.hpp"
#include "qddot/algebra/multifrontal/team.hpp"
#include "qddot/algebra/multifrontal/triangular_solves.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"

namespace qddot {
namespace {

using namespace multifrontal;

constexpr int height = strip_height;

// The memory that fronts need one after the other, for one thread or a team.
struct Workspace {
  // `scaled` holds L D in the panel's rows, then in a tile's or, for a team, in all rows below.
  Workspace(const Fronts::Sizes& sizes, int tile_strips, bool for_team)
      : updates(height + sizes.updates),
        columns(sizes.pivot_columns),
        scaled(Index{panel} * std::max(panel, for_team ? sizes.height + height * tile_strips
                                                       : height * tile_strips)) {}

  LargeArray updates;  // after a strip's height, which kernels read (see Fronts::place_updates)
  LargeArray columns;  // of the present front's pivots, until they are columns of L
  LargeArray scaled;   // L D of a panel, in strips as L
  std::array<Block, panel / height> blocks;  // of the panel, on the diagonal
  Index negative = 0;                        // pivots
};

// L and the pivots are the same to the last bit for any number of threads: each entry is the same
// sum in the same order.
class Multifrontal : public Factors {
 public:
  Multifrontal(const SymmetricMatrix& pattern, const Vec& diagonal, SymbolicFactorization symbolic)
      : diagonal_(diagonal.size()),
        fronts_(pattern, std::move(symbolic)),
        l_(fronts_.factor_size),
        pivot_(pattern.rows()),
        top_(fronts_.top_sizes, kernels_.tile_strips, true),
        solves_(fronts_, l_.get(), pivot_.get()) {
    for (Index i = 0; i < diagonal.size(); ++i) diagonal_[fronts_.place()[i]] = diagonal[i];
    add_workspaces(1);
  }

  Definiteness factorize(double a, double s, const SymmetricMatrix& k) override {
    if (!numeric({{a, s, diagonal_.data(), k.valuePtr()}, false})) return Definiteness::singular;
    return negative_pivots() > 0 ? Definiteness::indefinite : Definiteness::positive;
  }

  bool factorize_positive(double a, double s, const SymmetricMatrix& k) override {
    return numeric({{a, s, diagonal_.data(), k.valuePtr()}, true});
  }

  Index negative_pivots() const override {
    Index sum = top_.negative;
    for (const Workspace& w : workspaces_) sum += w.negative;
    return sum;
  }

  Index bytes() const override {
    return static_cast<Index>(sizeof(double)) * (fronts_.factor_size + diagonal_.size());
  }

  SolveOutcome solve(const Vec& b, Vec& x) override {
    solves_.solve(b, x);
    return SolveOutcome::found;
  }
  SolveOutcome solve(const FourColumns& b, FourColumns& x) override {
    solves_.solve(b, x);
    return SolveOutcome::found;
  }

 private:
  // A matrix, and whether to give up at the first pivot that is not positive.
  struct Task : Combination {
    bool only_positive;
  };

  // Whether every pivot can be divided by and, where asked for, is positive.
  bool numeric(const Task& task) {
    const bool divided = fronts_.branches().size() > 1 && !omp_in_parallel();
    const int most = divided ? omp_get_max_threads() : 1;
    add_workspaces(most);
    for (Workspace& w : workspaces_) w.negative = 0;
    top_.negative = 0;
    failed_ = false;
    if (most == 1) {
      work(task, Team(), workspaces_[0]);
    } else {
      std::optional<Barrier> meeting;
#pragma omp parallel num_threads(most)
      {
#pragma omp single
        meeting.emplace(omp_get_num_threads());
        work(task, Team(*meeting), workspaces_[omp_get_thread_num()]);
      }
    }
    return !failed_;
  }

  void add_workspaces(int threads) {
    while (std::ssize(workspaces_) < threads) {
      workspaces_.emplace_back(fronts_.branch_sizes, kernels_.tile_strips, false);
    }
  }

  // One thread's share: some of the branches by itself, then all fronts above them with the others.
  void work(const Task& task, Team team, Workspace& own) {
    Team alone;
    team.share(static_cast<int>(fronts_.branches().size()), [&](int b) {
      const Branch& branch = fronts_.branches()[b];
      for (int i = branch.start; i < branch.end && !failed_; ++i) {
        const Front& f = fronts_.all()[i];
        factorize(task, open(f, own), alone);
      }
    });
    if (failed_) return;
    for (const int i : fronts_.top()) {
      const Front& f = fronts_.all()[i];
      if (!factorize(task, open(f, top_), team)) return;
    }
  }

  double* update(const Front& f, Workspace& own) {
    return (f.kept ? top_ : own).updates.get() + height + f.update;
  }

  // A front while it is worked on.
  struct Open {
    const Front& f;
    Workspace& w;
    OpenFront matrix;
  };

  Open open(const Front& f, Workspace& own) {
    return {f,
            own,
            {.columns = own.columns.get(),
             .update = update(f, own),
             .factor = l_.get() + f.factor,
             .first = f.first,
             .pivots = f.pivots,
             .pivot_height = f.pivot_height(),
             .height = f.height()}};
  }

  // Whether to continue. All threads of a team must answer alike: they read failed_ only after the
  // team has met since its last change, and meet again before the next.
  bool factorize(const Task& task, const Open& open, Team& team) {
    assemble_pivots(task, open, team);
    for (int from = 0; from < open.f.pivots; from += panel) {
      const int end = std::min(from + panel, open.f.pivots);
      if (!eliminate(task, open, from, end, team)) return false;
    }
    if (fronts_.children(open.f).empty()) return true;
    const int pivot_height = open.f.pivot_height();
    team.share_parts(open.f.below_strips(), 1, [&](int from, int end) {
      for (const int child : fronts_.children(open.f))
        add_update(child, open, pivot_height + from * height, pivot_height + end * height);
    });
    return true;
  }

  // The lower triangle of the pivots' columns before they are eliminated: the matrix' entries and
  // the children's updates.
  void assemble_pivots(const Task& task, const Open& open, Team& team) {
    const Front& f = open.f;
    team.share_parts(f.pivot_strips(), 1, [&](int from, int end) {
      from *= height;
      end *= height;
      const std::span<const Entry> entries = fronts_.entries(f);
      const auto start =
          from == 0 ? entries.begin()
                    : std::ranges::lower_bound(entries, from * f.height(), {}, &Entry::target);
      kernels_.assemble(open.matrix, task, {std::to_address(start), std::to_address(entries.end())},
                        from, end);
      for (const int child : fronts_.children(f)) add_update(child, open, from, end);
    });
  }

  // A child's update in the front's columns [first, end), all of pivots or none.
  void add_update(int index, const Open& open, int first, int end) {
    const Front& child = fronts_.all()[index];
    const auto runs = fronts_.runs(child);
    const auto start = std::ranges::lower_bound(
        runs, first, {}, [](const Run& run) { return run.to + run.length - 1; });
    kernels_.add_update({.update = update(child, open.w),
                         .height = child.below_height(),
                         .begin = std::to_address(start),
                         .end = std::to_address(runs.end())},
                        open.matrix, first, end);
  }

  // Eliminates the pivots [from, end) and subtracts their part from the rest. Returns whether to
  // continue.
  bool eliminate(const Task& task, const Open& open, int from, int end, Team& team) {
    const Front& f = open.f;
    const int first = from / height, after = strips_of(end);
    const int tile_strips = kernels_.tile_strips;
    const auto divide = [&](int begin, int until, int i, int last, double* scaled) {
      kernels_.divide(open.matrix, from, begin, until, i, std::min(tile_strips, last - i),
                      open.w.blocks.data(), scaled);
    };
    // The panel's own rows: each block is divided by as soon as it is factorised.
    team.share(1, [&](int) {
      const auto row = [&](int i) { return scaled(open, 0) + (i - first) * panel * height; };
      for (int j = first; j < after && !failed_; ++j) {
        factorize_block(open, from, j, row(j), task.only_positive);
        for (int i = j + 1; i < after; i += tile_strips) divide(j, j + 1, i, after, row(i));
      }
    });
    if (failed_) return false;
    const auto tile = [&](int i) { return std::min(tile_strips, f.strips() - i); };
    const int tiles = (f.strips() - after + tile_strips - 1) / tile_strips;
    const Front* next = &f + 1;
    FetchAhead ahead(
        task.k, next == fronts_.end() ? std::span<const Entry>() : fronts_.entries(*next), tiles);
    for (int i = after; team.alone() && i < f.strips(); i += tile_strips) {
      if (from == 0) ahead.fetch_share();
      divide(first, after, i, f.strips(), scaled(open, 0));
      kernels_.subtract_from_rest(open.matrix, from, end, i, tile(i), scaled(open, 0));
    }
    if (team.alone()) return true;
    const auto row = [&](int t) { return after + t * tile_strips; };
    team.share(tiles, [&](int t) { divide(first, after, row(t), f.strips(), scaled(open, t)); });
    team.share(tiles, [&](int t) {
      t = tiles - 1 - t;  // the longest first
      kernels_.subtract_from_rest(open.matrix, from, end, row(t), tile(row(t)), scaled(open, t));
    });
    return true;
  }

  // L D of a panel in the rows of tile t.
  double* scaled(const Open& open, int t) const {
    return open.w.scaled.get() + Index{t} * kernels_.tile_strips * panel * height;
  }

  // The block of strip i on the diagonal; `scaled` is L D in the panel's columns before it.
  void factorize_block(const Open& open, int from, int i, const double* scaled,
                       bool only_positive) {
    const Front& f = open.f;
    const int k = std::min(height, f.pivots - i * height), first = f.first + i * height;
    Block& block = open.w.blocks[i - from / height];
    kernels_.factorize_block(open.matrix, from, i, scaled, block);
    if (!block.regular || (only_positive && block.negative > 0)) failed_ = true;
    open.w.negative += block.negative;
    std::copy_n(block.pivot, k, pivot_.get() + first);
    std::copy_n(block.l, k * height, open.matrix.factor + Index{i} * height * (f.pivots + height));
  }

  const FrontKernels& kernels_ = front_kernels();
  Vec diagonal_;  // D in the order of elimination
  Fronts fronts_;
  LargeArray l_, pivot_;
  std::vector<Workspace> workspaces_;  // of threads, for branches
  Workspace top_;
  TriangularSolves solves_;
  std::atomic<bool> failed_ = false;
};

}  // namespace

std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal) {
  return make_multifrontal(pattern, std::move(diagonal), analyse(pattern));
}

std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal,
                                           SymbolicFactorization symbolic) {
  return std::make_unique<Multifrontal>(pattern, std::move(diagonal), std::move(symbolic));
}

}  // namespace qddot
