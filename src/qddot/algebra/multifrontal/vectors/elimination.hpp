#pragma once

#include "qddot/algebra/multifrontal/vectors/strips.hpp"

namespace qddot::multifrontal::QDDOT_LEVEL {
namespace {

// Column j, as if its rows began with the pivots'.
double* column(const OpenFront& f, int j) {
  if (j < f.pivot_height) return f.columns + std::ptrdiff_t{j} * f.height;
  const int below = f.height - f.pivot_height;
  return f.update + std::ptrdiff_t{j - f.pivot_height} * below - f.pivot_height;
}

// L of the front: strip i from column k on.
double* factor(const OpenFront& f, int i, int k) {
  return f.factor + (std::ptrdiff_t{i} * f.pivots + k) * height;
}

// Strip by strip, whose columns stay in the first cache.
void assemble(const OpenFront& f, const Combination& matrix, Entries of_k, int from, int end) {
  const std::ptrdiff_t ld = f.height;
  const double minus_s = -matrix.s, *k = matrix.k;
  double* const columns = f.columns;
  const Entry* e = of_k.begin;
  for (int first = from; first < end; first += height) {
    for (double* to = columns + first * ld; to < columns + (first + height) * ld; to += ld) {
      for (std::ptrdiff_t i = first; i < ld; i += lanes) store(to + i, Lanes{});
    }
    const std::ptrdiff_t next = (first + height) * ld;
    for (; e < of_k.end && e->target < next; ++e) {
      const double* value = k + e->source;
      double* to = columns + e->target;
      const std::ptrdiff_t stride = e->across ? ld : 1;
      // Three without branches: one or two are written again.
      const int last = e->length - 1, middle = last < 1 ? last : 1;
      to[0] = minus_s * value[0];
      to[middle * stride] = minus_s * value[middle];
      to[last * stride] = minus_s * value[last];
    }
    // The columns that fill up the last strip are those of the identity.
    for (int j = first; j < first + height; ++j) {
      double& pivot = columns[j * (ld + 1)];
      pivot = j < f.pivots ? pivot + matrix.a * matrix.diagonal[f.first + j] : 1;
    }
  }
}

// All columns of one run of rows, then the next run. Columns on the diagonal go strip by strip.
void add_update(const ChildUpdate& child, const OpenFront& f, int first, int end) {
  const std::ptrdiff_t x_ld = child.height;
  const std::ptrdiff_t y_ld = first < f.pivot_height ? f.height : f.height - f.pivot_height;
  for (const Run* rows = child.begin; rows != child.end; ++rows) {
    for (const Run* run = child.begin; run <= rows && run->to < end; ++run) {
      const int last = run->length < end - run->to ? run->length : end - run->to;
      int j = first > run->to ? first - run->to : 0;
      const auto add_columns = [&](int count, int above) {
        const int from = (rows->to + above) % height, strip = rows->to + above - from;
        add(child.update + (run->from + j) * x_ld + rows->from + above - from, x_ld, from,
            rows->to + rows->length - strip, count, column(f, run->to + j) + strip, y_ld);
        j += count;
      };
      if (run < rows) add_columns(last - j, 0);
      while (j < last) {
        const int rest = height - (run->to + j) % height;
        add_columns(rest < last - j ? rest : last - j, j);
      }
    }
  }
}

void divide(const OpenFront& f, int from, int begin, int end, int i, int strips,
            const Block* blocks, double* scaled) {
  for (int j = begin; j < end; ++j) {
    const int k = j * height - from, after = f.pivots - j * height;
    const int columns = height < after ? height : after;
    divide(column(f, j * height) + i * height, f.height, scaled, panel * height, factor(f, j, from),
           k, blocks[j - from / height], columns, factor(f, i, j * height),
           std::ptrdiff_t{f.pivots} * height, strips);
  }
}

void factorize_block(const OpenFront& f, int from, int i, const double* scaled, Block& block) {
  double* a = column(f, i * height) + i * height;
  subtract<false>(a, f.height, scaled, panel * height, factor(f, i, from), i * height - from, 1);
  factorize(a, f.height, block);
}

void subtract_from_rest(const OpenFront& f, int from, int end, int i, int strips,
                        const double* scaled) {
  const int k = end - from;
  for (int j = strips_of(end); j < i + strips; ++j) {
    const int above = j > i ? j - i : 0;  // strips of the tile above the diagonal
    double* c = column(f, j * height) + (i + above) * height;
    const double* rows = scaled + above * panel * height;
    const double* w = factor(f, j, from);
    const bool is_update = j * height >= f.pivot_height;
    const auto subtract_tile = is_update && from == 0 ? subtract<true> : subtract<false>;
    subtract_tile(c, is_update ? f.height - f.pivot_height : f.height, rows, panel * height, w, k,
                  strips - above);
  }
}

}  // namespace
}  // namespace qddot::multifrontal::QDDOT_LEVEL
