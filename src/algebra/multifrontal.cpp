#include "src/algebra/multifrontal.hpp"

#include <algorithm>

#include "src/algebra/fronts.hpp"
#include "src/algebra/large_array.hpp"
#include "src/algebra/strips.hpp"

namespace qddot {

namespace {

using namespace strips;

// Pivots whose columns are taken off the rest of a front at once: as many as leave a tile's rows of
// L in the first cache.
constexpr int panel = 96;

class Multifrontal : public Factors {
 public:
  Multifrontal(const SymmetricMatrix& pattern, Vec diagonal, Elimination elimination)
      : diagonal_(std::move(diagonal)),
        fronts_(pattern, std::move(elimination)),
        l_(fronts_.factor_size),
        updates_(fronts_.update_size),
        columns_(fronts_.pivot_columns_size),
        scaled_(panel * height * tile_strips),
        pivot_(pattern.rows()),
        y_(quad * pattern.rows()),
        gathered_(quad * fronts_.largest_height) {}

  Definiteness factorize(double a, double s, const SymmetricMatrix& k) override {
    if (!numeric(a, s, k, false)) return Definiteness::singular;
    return negative_ > 0 ? Definiteness::indefinite : Definiteness::positive;
  }

  bool factorize_positive(double a, double s, const SymmetricMatrix& k) override {
    return numeric(a, s, k, true);
  }

  Index negative_pivots() const override { return negative_; }

  Index bytes() const override {
    return static_cast<Index>(sizeof(double)) * (fronts_.factor_size + diagonal_.size());
  }

  SolveOutcome solve(const Vec& b, Vec& x) override {
    const auto& place = fronts_.place();
    for (Index i = 0; i < b.size(); ++i) y_.get()[place[i]] = b[i];
    for (const Front& f : fronts_) forward(f);
    for (Index i = 0; i < b.size(); ++i) y_.get()[i] /= pivot_.get()[i];
    for (const Front* f = fronts_.end(); f != fronts_.begin();) backward(*--f);
    x.resize(b.size());
    for (Index i = 0; i < b.size(); ++i) x[i] = y_.get()[place[i]];
    return SolveOutcome::found;
  }

  SolveOutcome solve(const FourColumns& b, FourColumns& x) override {
    const auto& place = fronts_.place();
    for (Index i = 0; i < b.rows(); ++i) row(y_.get(), place[i]) = row(b.data(), i);
    for (const Front& f : fronts_) forwards(f);
    for (const Front* f = fronts_.end(); f != fronts_.begin();) backwards(*--f);
    for (Index i = 0; i < b.rows(); ++i) row(x.data(), i) = row(y_.get(), place[i]);
    return SolveOutcome::found;
  }

 private:
  // Whether every pivot can be divided by and, where asked for, is positive.
  bool numeric(double a, double s, const SymmetricMatrix& k, bool only_positive) {
    negative_ = 0;
    for (const Front& f : fronts_) {
      assemble(f, a, s, k.valuePtr());
      if (!eliminate_pivots(f, only_positive)) return false;
    }
    return true;
  }

  // The lower triangle of the front before its pivots are eliminated: the matrix' entries in its
  // columns and its children's updates. A leaf's update is not set to zero but overwritten later.
  void assemble(const Front& f, double a, double s, const double* k) {
    const auto clear = [](double* matrix, int rows, int columns) {
      for (int j = 0; j < columns; ++j, matrix += rows) {
        const int above = j / height * height;
        std::fill(matrix + above, matrix + rows, 0.0);
      }
    };
    double* columns = columns_.get();
    clear(columns, f.height(), f.pivot_height());
    for (const auto [source, target] : fronts_.entries(f)) columns[target] = -s * k[source];
    for (const auto [source, target] : fronts_.diagonal(f))
      columns[target] += a * diagonal_[source];
    // The columns that fill up the last strip are those of the identity.
    for (int j = f.pivots; j < f.pivot_height(); ++j) columns[Index{j} * (f.height() + 1)] = 1;
    const auto children = fronts_.children(f);
    if (!children.empty()) clear(updates_.get() + f.update, f.below_height(), f.below_height());
    for (const int child : children) add_update(fronts_.all()[child], f);
  }

  void add_update(const Front& child, const Front& f) {
    const auto runs = fronts_.runs(child);
    for (std::size_t r = 0; r < runs.size(); ++r) {
      for (int j = 0; j < runs[r].length; ++j) {
        const double* from =
            updates_.get() + child.update + Index{runs[r].from + j} * child.below_height();
        double* to = column(f, runs[r].to + j);
        for (int i = j; i < runs[r].length; ++i) to[runs[r].to + i] += from[runs[r].from + i];
        for (const Run& run : runs.subspan(r + 1)) {
          for (int i = 0; i < run.length; ++i) to[run.to + i] += from[run.from + i];
        }
      }
    }
  }

  // The front's column j, as if its rows began with the pivots'.
  double* column(const Front& f, int j) const {
    if (j < f.pivot_height()) return columns_.get() + Index{j} * f.height();
    return updates_.get() + f.update + Index{j - f.pivot_height()} * f.below_height() -
           f.pivot_height();
  }

  bool eliminate_pivots(const Front& f, bool only_positive) {
    for (int from = 0; from < f.pivots; from += panel) {
      const int end = std::min(from + panel, f.pivots);
      for (int j = from / height; j < strips::count(end); ++j) {
        if (j > from / height) subtract_from_strip(f, j, from);
        if (!divide(f, j, only_positive)) return false;
      }
      subtract_from_rest(f, from, end);
    }
    return true;
  }

  // L of the front: strip i from column k on.
  double* factor(const Front& f, int i, int k) const {
    return l_.get() + f.factor + (Index{i} * f.pivots + k) * height;
  }
  static Index stride(const Front& f) { return Index{f.pivots} * height; }

  // Columns of the pivots 8 j, ..., 8 j + 7, less what the pivots from `from` to them take off.
  void subtract_from_strip(const Front& f, int j, int from) {
    const int k = j * height - from;
    scale(factor(f, j, from), pivot_.get() + f.first + from, k, scaled_.get());
    for (int i = j; i < f.strips(); i += tile_strips) {
      subtract<false>(column(f, j * height) + i * height, f.height(), factor(f, i, from), stride(f),
                      scaled_.get(), k, std::min(tile_strips, f.strips() - i));
    }
  }

  // Those columns of L.
  bool divide(const Front& f, int j, bool only_positive) {
    const int k = std::min(height, f.pivots - j * height), first = f.first + j * height;
    const double* a = column(f, j * height);
    const Block block(a + j * height, f.height());
    if (!block.regular || (only_positive && block.negative > 0)) return false;
    negative_ += block.negative;
    std::copy_n(block.pivot, k, pivot_.get() + first);
    std::copy_n(block.l, k * height, factor(f, j, j * height));
    for (int i = j + 1; i < f.strips(); ++i)
      divide_strip(a + i * height, f.height(), block, k, factor(f, i, j * height));
    return true;
  }

  // What the pivots [from, end) take off everything after them, by rows of tiles.
  void subtract_from_rest(const Front& f, int from, int end) {
    const int k = end - from, first = strips::count(end);
    const bool fresh = from == 0 && fronts_.children(f).empty();
    for (int i = first; i < f.strips(); i += tile_strips) {
      const int strips = std::min(tile_strips, f.strips() - i);
      for (int t = 0; t < strips; ++t) {
        scale(factor(f, i + t, from), pivot_.get() + f.first + from, k,
              scaled_.get() + t * k * height);
      }
      for (int j = first; j < i + strips; ++j) {
        const int above = std::max(j - i, 0);  // strips of the tile above the diagonal
        double* c = column(f, j * height) + (i + above) * height;
        const double* rows = scaled_.get() + above * k * height;
        const double* w = factor(f, j, from);
        if (j < f.pivot_strips()) {
          subtract<false>(c, f.height(), rows, k * height, w, k, strips - above);
        } else if (fresh) {
          subtract<true>(c, f.below_height(), rows, k * height, w, k, strips - above);
        } else {
          subtract<false>(c, f.below_height(), rows, k * height, w, k, strips - above);
        }
      }
    }
  }

  // Of L z = b: the front's pivots of z, and what they take off the rows below.
  void forward(const Front& f) {
    double* z = gathered_.get();
    std::copy_n(y_.get() + f.first, f.pivots, z);
    std::fill(z + f.pivots, z + f.height(), 0.0);
    for (int j = 0; j < f.pivot_strips(); ++j) {
      const int k = std::min(height, f.pivots - j * height);
      double* zj = z + j * height;
      solve_lower(factor(f, j, j * height), k, zj);
      subtract_product(factor(f, j + 1, j * height), stride(f), zj, k, f.strips() - j - 1,
                       zj + height);
    }
    std::copy_n(z, f.pivots, y_.get() + f.first);
    z += f.pivot_height();
    for (const int row : fronts_.rows(f)) y_.get()[row] += *z++;
  }

  // Of L' x = y: the front's pivots of x.
  void backward(const Front& f) {
    double* x = gathered_.get();
    std::copy_n(y_.get() + f.first, f.pivots, x);
    std::fill(x + f.pivots, x + f.pivot_height(), 0.0);
    double* below = x + f.pivot_height();
    for (const int row : fronts_.rows(f)) *below++ = y_.get()[row];
    std::fill(below, x + f.height(), 0.0);
    for (int j = f.pivot_strips(); j-- > 0;) {
      const int k = std::min(height, f.pivots - j * height);
      double* xj = x + j * height;
      subtract_transposed(factor(f, j + 1, j * height), stride(f), xj + height, k,
                          f.strips() - j - 1, xj);
      solve_upper(factor(f, j, j * height), k, xj);
    }
    std::copy_n(x, f.pivots, y_.get() + f.first);
  }

  // Both for four right-hand sides; backwards() divides by the pivots, too.
  void forwards(const Front& f) {
    double* z = gathered_.get();
    std::copy_n(y_.get() + quad * f.first, quad * f.pivots, z);
    std::fill(z + quad * f.pivots, z + quad * f.pivot_height(), 0.0);
    for (int j = 0; j < f.pivot_strips(); ++j) {
      const int before = j * height, k = std::min(height, f.pivots - before);
      subtract_products(factor(f, j, 0), z, before, z + quad * before);
      solve_lowers(factor(f, j, before), k, z + quad * before);
    }
    std::copy_n(z, quad * f.pivots, y_.get() + quad * f.first);
    const auto rows = fronts_.rows(f);
    for (int i = 0; i < f.below_strips(); ++i) {
      double sums[quad * height] = {};
      subtract_products(factor(f, f.pivot_strips() + i, 0), z, f.pivots, sums);
      const int count = std::min(height, f.below - i * height);
      for (int r = 0; r < count; ++r) row(y_.get(), rows[i * height + r]) += row(sums, r);
    }
  }

  void backwards(const Front& f) {
    double* x = gathered_.get();
    for (int p = 0; p < f.pivots; ++p) {
      row(x, p) = row(y_.get(), f.first + p) / pivot_.get()[f.first + p];
    }
    std::fill(x + quad * f.pivots, x + quad * f.pivot_height(), 0.0);
    int at = f.pivot_height();
    for (const int i : fronts_.rows(f)) row(x, at++) = row(y_.get(), i);
    std::fill(x + quad * at, x + quad * f.height(), 0.0);
    for (int j = f.pivot_strips(); j-- > 0;) {
      const int before = j * height, k = std::min(height, f.pivots - before);
      double* xj = x + quad * before;
      subtract_transposed_products(factor(f, j + 1, before), stride(f), xj + quad * height, k,
                                   f.strips() - j - 1, xj);
      solve_uppers(factor(f, j, before), k, xj);
    }
    std::copy_n(x, quad * f.pivots, y_.get() + quad * f.first);
  }

  Vec diagonal_;
  Fronts fronts_;
  LargeArray l_, updates_;
  LargeArray columns_;  // of the pivots of the front at hand, until they are columns of L
  LargeArray scaled_;   // some of its strips times the pivots
  LargeArray pivot_, y_, gathered_;
  Index negative_ = 0;
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
