#pragma once

#include <cmath>

#include "src/model/system.hpp"

namespace qddot::strips {

// Dense kernels for LDL' and its triangular solves, on matrices cut into strips of 8 rows. A strip
// of k columns is k times 8 numbers, one after the other: products read it as it lies in memory,
// its rows in the lanes of the processor's vectors.
constexpr int height = 8;

// Strips that hold so many rows.
constexpr int count(int rows) { return (rows + height - 1) / height; }

// Vectors as wide as the processor's; tiles of as many as its registers hold: 32 with AVX-512, else
// 16.
constexpr int lanes = __BIGGEST_ALIGNMENT__ / sizeof(double);
constexpr int vectors = height / lanes;  // in a column of a strip
constexpr int tile_strips = lanes == 8 ? 3 : 1;
constexpr int tile_columns = lanes;
constexpr int product_strips = lanes == 8 ? 4 : 1;
using Lanes = double __attribute__((vector_size(lanes * sizeof(double)), aligned(8), may_alias));

inline Lanes load(const double* x) { return *reinterpret_cast<const Lanes*>(x); }
inline void store(double* x, Lanes value) { *reinterpret_cast<Lanes*>(x) = value; }

// S = A D: a strip of k columns times a diagonal.
inline void scale(const double* a, const double* d, int k, double* s) {
  for (int p = 0; p < k; ++p) {
    for (int i = 0; i < height; ++i) s[p * height + i] = a[p * height + i] * d[p];
  }
}

// C = C - A W', or C = -A W' where `fresh`. C: columns `ld` apart; A: strips `stride` apart, of k
// columns; W: the first `tile_columns` rows of a strip of k columns.
template <int strips, bool fresh>
inline void subtract_tile(double* c, Index ld, const double* a, Index stride, const double* w,
                          int k) {
  constexpr int rows = strips * vectors;
  Lanes sum[tile_columns][rows] = {};
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
inline void subtract(double* c, Index ld, const double* a, Index stride, const double* w, int k,
                     int strips) {
  for (int j = 0; j < height; j += tile_columns, c += tile_columns * ld, w += tile_columns) {
    if constexpr (tile_strips == 3) {
      if (strips == 3) subtract_tile<3, fresh>(c, ld, a, stride, w, k);
      if (strips == 2) subtract_tile<2, fresh>(c, ld, a, stride, w, k);
    }
    if (strips == 1) subtract_tile<1, fresh>(c, ld, a, stride, w, k);
  }
}

// A = L D L' of the k <= 8 pivots of a block without pivoting; A: the lower triangle of columns
// `ld` apart.
struct Block {
  double ld[height][height] = {};  // columns of L D
  double pivot[height] = {}, inverse[height] = {};
  int pivots, negative = 0;
  bool regular = true;  // every pivot is a number that can be divided by

  Block(const double* a, Index a_ld, int k) : pivots(k) {
    for (int j = 0; j < k; ++j) {
      for (int i = 0; i < height; ++i) ld[j][i] = a[j * a_ld + i];
    }
    for (int p = 0; p < k; ++p) {
      pivot[p] = ld[p][p];
      inverse[p] = 1 / pivot[p];
      negative += pivot[p] < 0;
      regular = regular && std::isfinite(pivot[p]) && std::isfinite(inverse[p]);
      double l[height];
      for (int i = 0; i < height; ++i) l[i] = ld[p][i] / pivot[p];
      for (int j = p + 1; j < k; ++j) {
        for (int i = 0; i < height; ++i) ld[j][i] -= l[i] * ld[p][j];
      }
    }
  }

  // L without its unit diagonal, zeros there and above.
  void store_unit_lower(double* l) const {
    for (int j = 0; j < pivots; ++j) {
      for (int i = 0; i < height; ++i) l[j * height + i] = i > j ? ld[j][i] / pivot[j] : 0;
    }
  }
};

// A strip of L below a block: L = A (D L')^-1, A's 8 columns `ld` apart.
inline void divide_strip(const double* a, Index ld, const Block& block, double* l) {
#pragma GCC unroll 4
  for (int v = 0; v < vectors; ++v) {
    Lanes x[height];
#pragma GCC unroll 8
    for (int j = 0; j < height; ++j) x[j] = load(a + j * ld + v * lanes);
#pragma GCC unroll 8
    for (int p = 0; p < height; ++p) {
      x[p] *= block.inverse[p];
#pragma GCC unroll 8
      for (int j = p + 1; j < height; ++j) x[j] -= x[p] * block.ld[p][j];
    }
#pragma GCC unroll 8
    for (int j = 0; j < height; ++j) {
      if (j < block.pivots) store(l + j * height + v * lanes, x[j]);
    }
  }
}

// y = A x of strips `stride` apart, of k columns.
template <int strips>
inline void multiply_tile(const double* a, Index stride, const double* x, int k, double* y) {
  constexpr int rows = strips * vectors;
  Lanes sum[rows] = {};
  for (int p = 0; p < k; ++p, a += height) {
#pragma GCC unroll 16
    for (int i = 0; i < rows; ++i)
      sum[i] += load(a + i / vectors * stride + i % vectors * lanes) * x[p];
  }
#pragma GCC unroll 16
  for (int i = 0; i < rows; ++i) store(y + i * lanes, sum[i]);
}

// The same for 1 to `product_strips` strips.
inline void multiply(const double* a, Index stride, const double* x, int k, int strips, double* y) {
  if constexpr (product_strips == 4) {
    if (strips == 4) return multiply_tile<4>(a, stride, x, k, y);
    if (strips == 3) return multiply_tile<3>(a, stride, x, k, y);
    if (strips == 2) return multiply_tile<2>(a, stride, x, k, y);
  }
  multiply_tile<1>(a, stride, x, k, y);
}

// y = A' x for k <= 8 columns of strips `stride` apart.
inline void multiply_transposed(const double* a, Index stride, const double* x, int strips, int k,
                                double* y) {
  Lanes sum[height][vectors] = {};
  if (k == height) {
    for (int i = 0; i < strips; ++i, a += stride, x += height) {
#pragma GCC unroll 8
      for (int j = 0; j < height; ++j) {
#pragma GCC unroll 4
        for (int v = 0; v < vectors; ++v)
          sum[j][v] += load(a + j * height + v * lanes) * load(x + v * lanes);
      }
    }
  } else {
    for (int i = 0; i < strips; ++i, a += stride, x += height) {
#pragma GCC unroll 8
      for (int j = 0; j < height; ++j) {
        if (j >= k) break;
#pragma GCC unroll 4
        for (int v = 0; v < vectors; ++v)
          sum[j][v] += load(a + j * height + v * lanes) * load(x + v * lanes);
      }
    }
  }
  for (int j = 0; j < height; ++j) {
    Lanes total = sum[j][0];
    for (int v = 1; v < vectors; ++v) total += sum[j][v];
    y[j] = 0;
    for (int i = 0; i < lanes; ++i) y[j] += total[i];
  }
}

// x = L^-1 (x - sum) and x = L'^-1 (x - sum), of a block's k <= 8 pivots; L from store_unit_lower.
inline void solve_unit_lower(const double* l, const double* sum, double* x, int k) {
  double z[height] = {};
  for (int i = 0; i < k; ++i) z[i] = x[i] - sum[i];
  for (int p = 0; p < k; ++p) {
    for (int i = 0; i < height; ++i) z[i] -= l[p * height + i] * z[p];
  }
  for (int i = 0; i < k; ++i) x[i] = z[i];
}

inline void solve_unit_upper(const double* l, const double* sum, double* x, int k) {
  for (int p = k; p-- > 0;) {
    x[p] -= sum[p];
    for (int i = p + 1; i < k; ++i) x[p] -= l[p * height + i] * x[i];
  }
}

}  // namespace qddot::strips
