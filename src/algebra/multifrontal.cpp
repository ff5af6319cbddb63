#include "qddot/algebra/multifrontal.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <omp.h>
#include <optional>

#include "qddot/algebra/large_array.hpp"
#include "qddot/algebra/multifrontal/fronts.hpp"
#include "qddot/algebra/multifrontal/strips.hpp"
#include "qddot/algebra/multifrontal/team.hpp"
#include "qddot/algebra/multifrontal/triangular_solves.hpp"

namespace qddot {

namespace {

using namespace multifrontal;
using namespace multifrontal::strips;

// Pivots whose columns are taken off the rest of a front at once: as many as leave a tile's rows of
// L in the first cache.
constexpr int panel = 96;

// Where fronts are worked on one after the other, by one thread or a team.
struct Workspace {
  Workspace(const Fronts::Sizes& sizes, bool for_team)
      : updates(sizes.updates + height),  // see strips::add
        columns(sizes.pivot_columns + height),
        scaled(Index{panel} *
               (for_team ? sizes.height + height * tile_strips : height * tile_strips)) {}

  LargeArray updates;
  LargeArray columns;  // of the pivots of the front at hand, until they are columns of L
  LargeArray scaled;   // L D of a panel, strips as those of L: of a tile's rows or, for a team, all
  std::array<Block, panel / height> blocks;  // the panel's, on the diagonal
  Index negative = 0;                        // pivots
};

// L and the pivots are the same to the last bit for any number of threads: each entry is the same
// sum in the same order, whoever computes it.
class Multifrontal : public Factors {
 public:
  Multifrontal(const SymmetricMatrix& pattern, Vec diagonal, Elimination elimination)
      : diagonal_(std::move(diagonal)),
        fronts_(pattern, std::move(elimination)),
        l_(fronts_.factor_size),
        pivot_(pattern.rows()),
        top_(fronts_.top_sizes, true),
        solves_(fronts_, l_.get(), pivot_.get()) {
    workspaces_.emplace_back(fronts_.branch_sizes, false);
  }

  Definiteness factorize(double a, double s, const SymmetricMatrix& k) override {
    if (!numeric({a, s, k.valuePtr(), false})) return Definiteness::singular;
    return negative_pivots() > 0 ? Definiteness::indefinite : Definiteness::positive;
  }

  bool factorize_positive(double a, double s, const SymmetricMatrix& k) override {
    return numeric({a, s, k.valuePtr(), true});
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
  // a D - s K, and whether to give up at the first pivot that is not positive.
  struct Task {
    double a, s;
    const double* k;
    bool only_positive;
  };

  // Whether every pivot can be divided by and, where asked for, is positive.
  bool numeric(const Task& task) {
    const bool divided = fronts_.branches().size() > 1 && !omp_in_parallel();
    const int most = divided ? omp_get_max_threads() : 1;
    while (std::ssize(workspaces_) < most) workspaces_.emplace_back(fronts_.branch_sizes, false);
    for (Workspace& w : workspaces_) w.negative = 0;
    top_.negative = 0;
    failed_ = false;
    if (most == 1) {
      work(task, Team(), workspaces_[0]);
    } else {
      std::optional<Meeting> meeting;
#pragma omp parallel num_threads(most)
      {
#pragma omp single
        meeting.emplace(omp_get_num_threads());
        work(task, Team(*meeting), workspaces_[omp_get_thread_num()]);
      }
    }
    return !failed_;
  }

  // One thread's part: some of the branches by itself, then every front above them with the others.
  void work(const Task& task, Team team, Workspace& own) {
    Team alone;
    team.share(static_cast<int>(fronts_.branches().size()), [&](int b) {
      const Branch& branch = fronts_.branches()[b];
      for (int i = branch.start; i < branch.end && !failed_; ++i) {
        const Front& f = fronts_.all()[i];
        factorize(task, {f, own, update(f, own)}, alone);
      }
    });
    if (failed_) return;
    for (const int i : fronts_.top()) {
      const Front& f = fronts_.all()[i];
      if (!factorize(task, {f, top_, update(f, top_)}, team)) return;
    }
  }

  double* update(const Front& f, Workspace& own) {
    return (f.kept ? top_ : own).updates.get() + f.update;
  }

  // A front's dense matrix.
  struct Open {
    const Front& f;
    Workspace& w;
    double* update;

    // Column j, as if its rows began with the pivots'.
    double* column(int j) const {
      if (j < f.pivot_height()) return w.columns.get() + Index{j} * f.height();
      return update + Index{j - f.pivot_height()} * f.below_height() - f.pivot_height();
    }
  };

  // Whether to go on. All threads of a team must answer alike: they ask failed_ only where the team
  // has met since it may have been set, and will meet again before it may be.
  bool factorize(const Task& task, const Open& open, Team& team) {
    assemble_pivots(task, open, team);
    for (int from = 0; from < open.f.pivots; from += panel) {
      const int end = std::min(from + panel, open.f.pivots);
      if (!eliminate(open, from, end, task.only_positive, team)) return false;
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
    double* columns = open.w.columns.get();
    team.share_parts(f.pivot_strips(), 1, [&](int from, int end) {
      from *= height;
      end *= height;
      for (int j = from; j < end; ++j) {
        double* column = columns + Index{j} * f.height();
        std::fill(column + j / height * height, column + f.height(), 0.0);
      }
      const auto in_columns = [&](std::span<const Fronts::Entry> entries) {
        const auto first =
            std::ranges::lower_bound(entries, from * f.height(), {}, &Fronts::Entry::target);
        return std::ranges::subrange(
            first, std::ranges::lower_bound(first, entries.end(), end * f.height(), {},
                                            &Fronts::Entry::target));
      };
      for (const auto [source, target] : in_columns(fronts_.entries(f)))
        columns[target] = -task.s * task.k[source];
      for (const auto [source, target] : in_columns(fronts_.diagonal(f)))
        columns[target] += task.a * diagonal_[source];
      // The columns that fill up the last strip are those of the identity.
      for (int j = std::max(f.pivots, from); j < end; ++j) columns[Index{j} * (f.height() + 1)] = 1;
      for (const int child : fronts_.children(f)) add_update(child, open, from, end);
    });
  }

  // A child's update in the front's columns [first, end), all of pivots or none. All columns of one
  // run of rows, then the next run: so no sum waits for a neighbour to be stored.
  void add_update(int index, const Open& open, int first, int end) {
    const Front& child = fronts_.all()[index];
    const Index x_ld = child.below_height();
    const Index y_ld = first < open.f.pivot_height() ? open.f.height() : open.f.below_height();
    const auto runs = fronts_.runs(child);
    const auto start = std::ranges::lower_bound(
        runs, first, {}, [](const Run& run) { return run.to + run.length - 1; });
    for (auto rows = start; rows != runs.end(); ++rows) {
      for (auto run = start; run <= rows && run->to < end; ++run) {
        const int last = std::min(run->length, end - run->to);
        int j = std::max(0, first - run->to);
        const auto add_columns = [&](int count, int above) {
          add(update(child, open.w) + (run->from + j) * x_ld + rows->from + above, x_ld,
              rows->length - above, count, open.column(run->to + j) + rows->to + above, y_ld);
          j += count;
        };
        if (run < rows) add_columns(last - j, 0);
        while (j < last) add_columns(std::min(height, last - j), j);
      }
    }
  }

  // The pivots [from, end), and what they take off everything after them. Whether to go on.
  bool eliminate(const Open& open, int from, int end, bool only_positive, Team& team) {
    const Front& f = open.f;
    const int first = from / height, after = strips::count(end);
    const auto tile = [&](int i) { return std::min(tile_strips, f.strips() - i); };
    team.share(1, [&](int) {
      for (int i = first; i < after && !failed_; ++i) {
        divide(open, from, i, i, 1, scaled(open, 0));
        factorize_block(open, from, i, only_positive);
      }
    });
    if (failed_) return false;
    const int tiles = (f.strips() - after + tile_strips - 1) / tile_strips;
    for (int i = after; team.alone() && i < f.strips(); i += tile_strips) {
      divide(open, from, after, i, tile(i), scaled(open, 0));
      subtract_from_rest(open, from, end, i, tile(i), scaled(open, 0));
    }
    if (team.alone()) return true;
    const auto row = [&](int t) { return after + t * tile_strips; };
    team.share(tiles,
               [&](int t) { divide(open, from, after, row(t), tile(row(t)), scaled(open, t)); });
    team.share(tiles, [&](int t) {
      t = tiles - 1 - t;  // the longest first
      subtract_from_rest(open, from, end, row(t), tile(row(t)), scaled(open, t));
    });
    return true;
  }

  // L D of a panel in the rows of tile t.
  static double* scaled(const Open& open, int t) {
    return open.w.scaled.get() + Index{t} * tile_strips * panel * height;
  }

  // L of the front: strip i from column k on.
  double* factor(const Front& f, int i, int k) const {
    return l_.get() + f.factor + (Index{i} * f.pivots + k) * height;
  }

  // Strips i, ... of L and L D in the panel's columns, up to those of strip `end`.
  void divide(const Open& open, int from, int end, int i, int strips, double* ld) {
    const Front& f = open.f;
    for (int j = from / height; j < end; ++j) {
      const int k = j * height - from, columns = std::min(height, f.pivots - j * height);
      double* a = open.column(j * height) + i * height;
      subtract<false>(a, f.height(), ld, panel * height, factor(f, j, from), k, strips);
      for (int t = 0; t < strips; ++t) {
        divide_strip(a + t * height, f.height(), open.w.blocks[j - from / height], columns,
                     factor(f, i + t, j * height), ld + (t * panel + k) * height);
      }
    }
  }

  // The block of strip i on the diagonal.
  void factorize_block(const Open& open, int from, int i, bool only_positive) {
    const Front& f = open.f;
    const int k = std::min(height, f.pivots - i * height), first = f.first + i * height;
    double* a = open.column(i * height) + i * height;
    subtract<false>(a, f.height(), scaled(open, 0), panel * height, factor(f, i, from),
                    i * height - from, 1);
    Block& block = open.w.blocks[i - from / height];
    block = Block(a, f.height());
    if (!block.regular || (only_positive && block.negative > 0)) failed_ = true;
    open.w.negative += block.negative;
    std::copy_n(block.pivot, k, pivot_.get() + first);
    std::copy_n(block.l, k * height, factor(f, i, i * height));
  }

  // What the pivots [from, end) take off strips i, ... after them. The first ones begin the update.
  void subtract_from_rest(const Open& open, int from, int end, int i, int strips,
                          const double* ld) {
    const Front& f = open.f;
    const int k = end - from;
    for (int j = strips::count(end); j < i + strips; ++j) {
      const int above = std::max(j - i, 0);  // strips of the tile above the diagonal
      double* c = open.column(j * height) + (i + above) * height;
      const double* rows = ld + above * panel * height;
      const double* w = factor(f, j, from);
      const bool is_update = j >= f.pivot_strips();
      const auto subtract_tile = is_update && from == 0 ? subtract<true> : subtract<false>;
      subtract_tile(c, is_update ? f.below_height() : f.height(), rows, panel * height, w, k,
                    strips - above);
    }
  }

  Vec diagonal_;
  Fronts fronts_;
  LargeArray l_, pivot_;
  std::vector<Workspace> workspaces_;  // of threads, for branches
  Workspace top_;
  TriangularSolves solves_;
  std::atomic<bool> failed_ = false;
};

}  // namespace

std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal) {
  return make_multifrontal(pattern, std::move(diagonal), eliminate(pattern));
}

std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal,
                                           Elimination elimination) {
  return std::make_unique<Multifrontal>(pattern, std::move(diagonal), std::move(elimination));
}

}  // namespace qddot
