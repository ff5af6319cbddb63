#pragma once

#include "qddot/algebra/multifrontal/front_kernels.hpp"
#include "qddot/model/kernels/vectors/lanes.hpp"

namespace qddot::multifrontal::QDDOT_LEVEL {
namespace {

using namespace kernels::QDDOT_LEVEL;

// Dense kernels for LDL' and its triangular solves, on matrices cut into strips of 8 rows. A strip
// of k columns is k times 8 consecutive numbers. Products read them in this order, rows in the
// lanes of the processor's vectors.
constexpr int height = strip_height;

// A tile is as large as the processor's registers hold: 32 vectors with AVX-512, else 16.
constexpr int vectors = height / lanes;  // in a column of a strip
constexpr int tile_strips = lanes == 8 ? 3 : 1;
constexpr int tile_columns = lanes;

constexpr LaneNumbers first_places = lane_numbers([](int t) { return t; });

// The tile A W'. A: strips `stride` apart, of k columns; W: the first `tile_columns` rows of a
// strip of k columns.
template <int strips>
[[gnu::always_inline]] inline void multiply(const double* a, std::ptrdiff_t stride, const double* w,
                                            int k, Lanes (&sum)[tile_columns][strips * vectors]) {
  constexpr int rows = strips * vectors;
#pragma GCC unroll 16
  for (int j = 0; j < tile_columns; ++j) {
#pragma GCC unroll 16
    for (int i = 0; i < rows; ++i) sum[j][i] = Lanes{};
  }
  for (int p = 0; p < k; ++p, a += height, w += height) {
    Lanes x[rows];
#pragma GCC unroll 16
    for (int i = 0; i < rows; ++i) x[i] = load(a + i / vectors * stride + i % vectors * lanes);
#pragma GCC unroll 16
    for (int j = 0; j < tile_columns; ++j) {
#pragma GCC unroll 16
      for (int i = 0; i < rows; ++i) sum[j][i] += x[i] * w[j];
    }
  }
}

// C = C - A W', or C = -A W' where `fresh`. C: columns `ld` apart; A and W as above.
template <int strips, bool fresh>
inline void subtract_tile(double* c, std::ptrdiff_t ld, const double* a, std::ptrdiff_t stride,
                          const double* w, int k) {
  constexpr int rows = strips * vectors;
  // C may be in a farther cache than A and W: many products are worth fetching it before.
  if (k >= 36) {
#pragma GCC unroll 16
    for (int j = 0; j < tile_columns; ++j) {
#pragma GCC unroll 16
      for (int i = 0; i < strips; ++i) __builtin_prefetch(c + j * ld + i * height, 1);
    }
  }
  Lanes sum[tile_columns][rows];
  multiply<strips>(a, stride, w, k, sum);
#pragma GCC unroll 16
  for (int j = 0; j < tile_columns; ++j) {
#pragma GCC unroll 16
    for (int i = 0; i < rows; ++i) {
      double* to = c + j * ld + i * lanes;
      store(to, fresh ? -sum[j][i] : load(to) - sum[j][i]);
    }
  }
}

// The same for all 8 rows of W and 1 to `tile_strips` strips.
template <bool fresh>
inline void subtract(double* c, std::ptrdiff_t ld, const double* a, std::ptrdiff_t stride,
                     const double* w, int k, int strips) {
  for (int j = 0; j < height; j += tile_columns, c += tile_columns * ld, w += tile_columns) {
    if constexpr (tile_strips == 3) {
      if (strips == 3) subtract_tile<3, fresh>(c, ld, a, stride, w, k);
      if (strips == 2) subtract_tile<2, fresh>(c, ld, a, stride, w, k);
    }
    if (strips == 1) subtract_tile<1, fresh>(c, ld, a, stride, w, k);
  }
}

// Entry i of a strip's column, in every lane.
template <int i>
[[gnu::always_inline]] inline Lanes splat(const Lanes* x) {
  return shuffle(x[i / lanes], x[i / lanes], [](int) { return i % lanes; });
}

// Which entries of a column stand below (above) entry i, the others 0.
[[gnu::always_inline]] inline Lanes below(Lanes x, int v, int i) {
  return first_places + v * lanes > i ? x : Lanes{};
}
[[gnu::always_inline]] inline Lanes above(Lanes x, int v, int i) {
  return first_places + v * lanes < i ? x : Lanes{};
}

// Y = Y + X in rows [from, end), from < 8, of columns x_ld and y_ld apart. Row 0 of Y begins a line
// of the cache, so that no vector of Y crosses one. The first and last vector are read and written
// whole, other rows unchanged. Long columns come from farther caches: they are fetched before.
inline void add(const double* x, std::ptrdiff_t x_ld, int from, int end, int columns, double* y,
                std::ptrdiff_t y_ld) {
  constexpr int ahead = 8;
  const int fetched = end < 64 ? 0 : end;
  const int begin = from / lanes * lanes, last = (end - 1) / lanes * lanes;
  const auto in_first = first_places + begin >= from, in_last = first_places + last < end;
  const auto in_first_and_last = in_first & in_last;
  for (int j = 0; j < columns; ++j, x += x_ld, y += y_ld) {
    if (begin == last) {
      store(y + last, load(y + last) + (in_first_and_last ? load(x + last) : Lanes{}));
      continue;
    }
    for (int i = 0; i < fetched; i += height) {
      __builtin_prefetch(x + ahead * x_ld + i);
      __builtin_prefetch(y + ahead * y_ld + i, 1);
    }
    store(y + begin, load(y + begin) + (in_first ? load(x + begin) : Lanes{}));
#pragma GCC unroll 1
    for (int i = begin + lanes; i < last; i += lanes) store(y + i, load(y + i) + load(x + i));
    store(y + last, load(y + last) + (in_last ? load(x + last) : Lanes{}));
  }
}

// A = L D L' of 8 pivots without pivoting. A: the lower triangle of columns `a_ld` apart.
inline void factorize(const double* a, std::ptrdiff_t a_ld, Block& block) {
  Lanes x[height][vectors], y[height][vectors];
#pragma GCC unroll 8
  for (int j = 0; j < height; ++j) {
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) x[j][v] = load(a + j * a_ld + v * lanes);
  }
  unroll<height>([&]<int p>() __attribute__((always_inline)) {
    const Lanes d = splat<p>(x[p]);
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) y[p][v] = x[p][v] / d;
    unroll<height - p - 1>([&]<int after>() __attribute__((always_inline)) {
      constexpr int j = p + 1 + after;
#pragma GCC unroll 4
      for (int v = 0; v < vectors; ++v) x[j][v] -= y[p][v] * splat<j>(x[p]);
    });
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) {
      store(block.ld + p * height + v * lanes, x[p][v]);
      store(block.l + p * height + v * lanes, below(y[p][v], v, p));
    }
  });
  block.negative = 0;
  block.regular = true;
  for (int p = 0; p < height; ++p) {
    const double pivot = block.ld[p * height + p], inverse = 1 / pivot;
    block.pivot[p] = pivot;
    block.inverse[p] = inverse;
    block.negative += pivot < 0;
    block.regular = block.regular && __builtin_isfinite(pivot) && __builtin_isfinite(inverse);
    for (int i = p + 1; i < height; ++i) block.l[i * height + p] = block.l[p * height + i];
  }
}

// A tile of L below a block: L D = (C - A W') L'^-1, without leaving the registers. C: 8 columns
// `ld` apart; A and W as above; L: strips `l_stride` apart. L D's columns follow those of A. The
// first `columns` columns of L and L D are kept.
template <int strips>
inline void divide_tile(const double* c, std::ptrdiff_t ld, double* a, std::ptrdiff_t stride,
                        const double* w, int k, const Block& block, int columns, double* l,
                        std::ptrdiff_t l_stride) {
  constexpr int rows = strips * vectors;
  // L is new to the caches: here the next tile's part of it is fetched.
#pragma GCC unroll 16
  for (int i = 0; i < strips; ++i) {
#pragma GCC unroll 16
    for (int j = 0; j < height; ++j) {
      __builtin_prefetch(l + (i + strips) * l_stride + j * height, 1);
    }
  }
  Lanes x[height][rows];
#pragma GCC unroll 4
  for (int from = 0; from < height; from += tile_columns) {
    Lanes sum[tile_columns][rows];
    multiply<strips>(a, stride, w + from, k, sum);
#pragma GCC unroll 16
    for (int j = 0; j < tile_columns; ++j) {
#pragma GCC unroll 16
      for (int i = 0; i < rows; ++i) {
        x[from + j][i] = load(c + (from + j) * ld + i * lanes) - sum[j][i];
      }
    }
  }
  a += k * height;
#pragma GCC unroll 8
  for (int p = 0; p < height; ++p) {
    if (p >= columns) break;
#pragma GCC unroll 16
    for (int i = 0; i < rows; ++i) {
      store(a + i / vectors * stride + p * height + i % vectors * lanes, x[p][i]);
      x[p][i] *= block.inverse[p];
      store(l + i / vectors * l_stride + p * height + i % vectors * lanes, x[p][i]);
    }
#pragma GCC unroll 8
    for (int j = p + 1; j < height; ++j) {
#pragma GCC unroll 16
      for (int i = 0; i < rows; ++i) x[j][i] -= x[p][i] * block.ld[p * height + j];
    }
  }
}

// The same for 1 to `tile_strips` strips.
inline void divide(const double* c, std::ptrdiff_t ld, double* a, std::ptrdiff_t stride,
                   const double* w, int k, const Block& block, int columns, double* l,
                   std::ptrdiff_t l_stride, int strips) {
  if constexpr (tile_strips == 3) {
    if (strips == 3) divide_tile<3>(c, ld, a, stride, w, k, block, columns, l, l_stride);
    if (strips == 2) divide_tile<2>(c, ld, a, stride, w, k, block, columns, l, l_stride);
  }
  if (strips == 1) divide_tile<1>(c, ld, a, stride, w, k, block, columns, l, l_stride);
}

// y = y - A x of strips `stride` apart, of k <= 8 columns.
inline void subtract_product(const double* a, std::ptrdiff_t stride, const double* x, int k,
                             int strips, double* y) {
  for (int i = 0; i < strips; ++i, a += stride, y += height) {
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) {
      Lanes even = load(y + v * lanes), odd = {};
#pragma GCC unroll 8
      for (int j = 0; j < height; ++j) {
        if (j < k) (j % 2 ? odd : even) -= load(a + j * height + v * lanes) * x[j];
      }
      store(y + v * lanes, even + odd);
    }
  }
}

// The sums of `size` vectors' lanes, size a multiple of `lanes`, into size / lanes vectors: by
// halves, sums of `width` lanes side by side.
template <int size, int width = 1>
inline void add_lanes(Lanes* x) {
  if constexpr (width < lanes) {
    constexpr auto lane = [](int t) {
      const int block = t / width, within = t % width;
      return within + (block - block % 2) * width + block % 2 * lanes;
    };
#pragma GCC unroll 8
    for (int i = 0; i < size / 2; ++i) {
      x[i] = shuffle(x[2 * i], x[2 * i + 1], lane) +
             shuffle(x[2 * i], x[2 * i + 1], [=](int t) { return lane(t) + width; });
    }
    add_lanes<size / 2, 2 * width>(x);
  }
}

// y = y - A' x of strips `stride` apart, of k <= 8 columns.
inline void subtract_transposed(const double* a, std::ptrdiff_t stride, const double* x, int k,
                                int strips, double* y) {
  Lanes sum[height][vectors] = {};
  for (int i = 0; i < strips; ++i, a += stride, x += height) {
#pragma GCC unroll 8
    for (int j = 0; j < height; ++j) {
      if (j >= k) continue;
#pragma GCC unroll 4
      for (int v = 0; v < vectors; ++v)
        sum[j][v] += load(a + j * height + v * lanes) * load(x + v * lanes);
    }
  }
  // The rows by twos, fours and eights, whatever the width of vectors.
  Lanes total[vectors][height];
#pragma GCC unroll 4
  for (int v = 0; v < vectors; ++v) {
#pragma GCC unroll 8
    for (int j = 0; j < height; ++j) total[v][j] = sum[j][v];
    add_lanes<height>(total[v]);
  }
#pragma GCC unroll 2
  for (int apart = 1; apart < vectors; apart *= 2) {
#pragma GCC unroll 4
    for (int v = 0; v < vectors; v += 2 * apart) {
#pragma GCC unroll 4
      for (int i = 0; i < vectors; ++i) total[v][i] += total[v + apart][i];
    }
  }
#pragma GCC unroll 4
  for (int v = 0; v < vectors; ++v) store(y + v * lanes, load(y + v * lanes) - total[0][v]);
}

// x = L^-1 x and x = L'^-1 x for the first k pivots of a block, `l` as in Block; further x are 0.
inline void solve_lower(const double* l, int k, double* x) {
  Lanes z[vectors];
#pragma GCC unroll 4
  for (int v = 0; v < vectors; ++v) z[v] = load(x + v * lanes);
  unroll<height>([&]<int p>() __attribute__((always_inline)) {
    if (p >= k) return;
    const Lanes pivot = splat<p>(z);
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) z[v] -= below(load(l + p * height + v * lanes), v, p) * pivot;
  });
#pragma GCC unroll 4
  for (int v = 0; v < vectors; ++v) store(x + v * lanes, z[v]);
}

inline void solve_upper(const double* l, int k, double* x) {
  Lanes z[vectors];
#pragma GCC unroll 4
  for (int v = 0; v < vectors; ++v) z[v] = load(x + v * lanes);
  unroll<height>([&]<int solved>() __attribute__((always_inline)) {
    constexpr int p = height - 1 - solved;
    if (p >= k) return;
    const Lanes pivot = splat<p>(z);
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) z[v] -= above(load(l + p * height + v * lanes), v, p) * pivot;
  });
#pragma GCC unroll 4
  for (int v = 0; v < vectors; ++v) store(x + v * lanes, z[v]);
}

// The same for four right-hand sides at once, whose rows are the lanes: no sums over lanes, and
// one load of a row where it is gathered.
constexpr int quad = 4;
typedef double Quad __attribute__((vector_size(quad * sizeof(double)), aligned(8), may_alias));

[[gnu::always_inline]] inline Quad& row(double* x, int i) { return reinterpret_cast<Quad*>(x)[i]; }
[[gnu::always_inline]] inline const Quad& row(const double* x, int i) {
  return reinterpret_cast<const Quad*>(x)[i];
}

// Y = Y - A X of one strip of k columns.
inline void subtract_products(const double* a, const double* x, int k, double* y) {
  Quad sum[height];
#pragma GCC unroll 8
  for (int i = 0; i < height; ++i) sum[i] = row(y, i);
  for (int j = 0; j < k; ++j, a += height) {
    const Quad xj = row(x, j);
#pragma GCC unroll 8
    for (int i = 0; i < height; ++i) sum[i] -= a[i] * xj;
  }
#pragma GCC unroll 8
  for (int i = 0; i < height; ++i) row(y, i) = sum[i];
}

// Y = Y - A' X of strips `stride` apart, of `columns` columns.
template <int columns>
inline void subtract_transposed_products(const double* a, std::ptrdiff_t stride, const double* x,
                                         int strips, double* y) {
  Quad sum[columns];
#pragma GCC unroll 8
  for (int j = 0; j < columns; ++j) sum[j] = row(y, j);
  for (int i = 0; i < strips; ++i, a += stride, x += height * quad) {
#pragma GCC unroll 8
    for (int r = 0; r < height; ++r) {
      const Quad xr = row(x, r);
#pragma GCC unroll 8
      for (int j = 0; j < columns; ++j) sum[j] -= a[j * height + r] * xr;
    }
  }
#pragma GCC unroll 8
  for (int j = 0; j < columns; ++j) row(y, j) = sum[j];
}

// The same of k <= 8 columns.
inline void subtract_transposed_products(const double* a, std::ptrdiff_t stride, const double* x,
                                         int k, int strips, double* y) {
  for (; k >= 4; k -= 4, a += 4 * height, y += 4 * quad) {
    subtract_transposed_products<4>(a, stride, x, strips, y);
  }
  for (; k >= 1; k -= 1, a += height, y += quad) {
    subtract_transposed_products<1>(a, stride, x, strips, y);
  }
}

// X = L^-1 X and X = L'^-1 X for the first k pivots of a block.
inline void solve_lowers(const double* l, int k, double* x) {
  for (int p = 0; p < k; ++p) {
    const Quad pivot = row(x, p);
    for (int i = p + 1; i < k; ++i) row(x, i) -= l[p * height + i] * pivot;
  }
}

inline void solve_uppers(const double* l, int k, double* x) {
  for (int p = k; p-- > 0;) {
    const Quad pivot = row(x, p);
    for (int i = 0; i < p; ++i) row(x, i) -= l[p * height + i] * pivot;
  }
}

}  // namespace
}  // namespace qddot::multifrontal::QDDOT_LEVEL
