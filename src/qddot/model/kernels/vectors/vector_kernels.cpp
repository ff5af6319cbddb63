#include "qddot/model/kernels/vector_kernels.hpp"

#include "qddot/model/kernels/vectors/lanes.hpp"
#include "qddot/model/kernels/vectors/quotients.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

void add_scaled(const double* x, double c, const double* z, double* out, std::ptrdiff_t n) {
  std::ptrdiff_t i = 0;
  for (; i + lanes <= n; i += lanes)
    store(out + i, add_product(c + Lanes{}, load(z + i), load(x + i)));
  for (; i < n; ++i) out[i] = add_product(c, z[i], x[i]);
}

void add_quotient(const double* x, double c, const double* f, const Masses& masses, double* out,
                  std::ptrdiff_t n) {
  with_quotients(
      masses, [&](const auto& quotient) __attribute__((always_inline)) {
        std::ptrdiff_t i = 0;
        for (; i + lanes <= n; i += lanes)
          store(out + i, add_product(c + Lanes{}, quotient(load(f + i), i), load(x + i)));
        for (; i < n; ++i) out[i] = add_product(c, f[i] / masses.m[i], x[i]);
      });
}

void kick_and_drift(const double* q, const double* v, const double* f, const Masses& masses,
                    double c0, double c, double h, double* q_next, double* w, std::ptrdiff_t n) {
  with_quotients(
      masses, [&](const auto& quotient) __attribute__((always_inline)) {
        std::ptrdiff_t i = 0;
        for (; i + lanes <= n; i += lanes) {
          const Lanes a = quotient(load(f + i), i);
          const Lanes kicked =
              add_product(c + Lanes{}, a, add_product(c0 + Lanes{}, a, load(v + i)));
          store(w + i, kicked);
          store(q_next + i, add_product(h + Lanes{}, kicked, load(q + i)));
        }
        for (; i < n; ++i) {
          const double a = f[i] / masses.m[i];
          w[i] = add_product(c, a, add_product(c0, a, v[i]));
          q_next[i] = add_product(h, w[i], q[i]);
        }
      });
}

void half_kick_and_drift(const double* q, const double* v, const double* f, const Masses& masses,
                         double h, double* q_next, double* w, double* kicked, std::ptrdiff_t n) {
  with_quotients(
      masses, [&](const auto& quotient) __attribute__((always_inline)) {
        std::ptrdiff_t i = 0;
        for (; i + lanes <= n; i += lanes) {
          const Lanes a = quotient(load(f + i), i), own = load(v + i);
          const Lanes half = add_product(h / 2 + Lanes{}, a, own);
          store(w + i, half);
          store(kicked + i, add_product(h + Lanes{}, a, own));
          store(q_next + i, add_product(h + Lanes{}, half, load(q + i)));
        }
        for (; i < n; ++i) {
          const double a = f[i] / masses.m[i];
          w[i] = add_product(h / 2, a, v[i]);
          kicked[i] = add_product(h, a, v[i]);
          q_next[i] = add_product(h, w[i], q[i]);
        }
      });
}

void divide(const double* f, const Masses& masses, double* out, std::ptrdiff_t n) {
  with_quotients(
      masses, [&](const auto& quotient) __attribute__((always_inline)) {
        std::ptrdiff_t i = 0;
        for (; i + lanes <= n; i += lanes) store(out + i, quotient(load(f + i), i));
        for (; i < n; ++i) out[i] = f[i] / masses.m[i];
      });
}

void multiply(const double* a, const double* b, double* out, std::ptrdiff_t n) {
  std::ptrdiff_t i = 0;
  for (; i + lanes <= n; i += lanes) store(out + i, load(a + i) * load(b + i));
  for (; i < n; ++i) out[i] = a[i] * b[i];
}

// Adds the next `width` vectors: sums side by side hide each other's latency.
template <int width>
[[gnu::always_inline]] inline void combine(const double* x, double d, const double* v, double c,
                                           const double* const* z, const double* b, int count,
                                           double* out, std::ptrdiff_t i) {
  Lanes sum[width] = {};
  for (int j = 0; j < count; ++j) {
    const double* from = z[j] + i;
    unroll<width>([&]<int w>() __attribute__((always_inline)) {
      sum[w] = add_product(b[j] + Lanes{}, load(from + w * lanes), sum[w]);
    });
  }
  for (int w = 0; w < width; ++w) {
    const std::ptrdiff_t at = i + w * lanes;
    if (!x) {
      store(out + at, c * sum[w]);
    } else if (!v) {
      store(out + at, add_product(c + Lanes{}, sum[w], load(x + at)));
    } else {
      store(out + at,
            add_product(c + Lanes{}, sum[w], add_product(d + Lanes{}, load(v + at), load(x + at))));
    }
  }
}

void add_combination(const double* x, double d, const double* v, double c, const double* const* z,
                     const double* b, int count, double* out, std::ptrdiff_t n) {
  std::ptrdiff_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) combine<4>(x, d, v, c, z, b, count, out, i);
  for (; i + lanes <= n; i += lanes) combine<1>(x, d, v, c, z, b, count, out, i);
  for (; i < n; ++i) {
    double sum = 0;
    for (int j = 0; j < count; ++j) sum = add_product(b[j], z[j][i], sum);
    out[i] = !x   ? c * sum
             : !v ? add_product(c, sum, x[i])
                  : add_product(c, sum, add_product(d, v[i], x[i]));
  }
}

// Advances the next `width` vectors, side by side as above.
template <int width>
[[gnu::always_inline]] inline void step_some(const double* f, const double* c,
                                             const double* const* u, const double* r,
                                             const double* b, int count, const double* q,
                                             const double* d, double* u_0, double* d_next,
                                             double* q_next, std::ptrdiff_t i) {
  Lanes newest[width], sum[width] = {};
  unroll<width>([&]<int w>() __attribute__((always_inline)) {
    newest[w] = load(f + i + w * lanes) * load(c + i + w * lanes);
  });
  for (int j = 1; j <= count; ++j) {
    const double* from = u[j] + i;
    unroll<width>([&]<int w>() __attribute__((always_inline)) {
      const Lanes old = load(from + w * lanes);
      newest[w] = subtract_product(r[j] + Lanes{}, old, newest[w]);
      sum[w] = add_product(b[j] + Lanes{}, old, sum[w]);
    });
  }
  unroll<width>([&]<int w>() __attribute__((always_inline)) {
    const std::ptrdiff_t at = i + w * lanes;
    store(u_0 + at, newest[w]);
    const Lanes increment = load(d + at) + add_product(b[0] + Lanes{}, newest[w], sum[w]);
    store(d_next + at, increment);
    store(q_next + at, load(q + at) + increment);
  });
}

void step_by_history(const double* f, const double* c, const double* const* u, const double* r,
                     const double* b, int count, const double* q, const double* d, double* u_0,
                     double* d_next, double* q_next, std::ptrdiff_t n) {
  std::ptrdiff_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) {
    step_some<4>(f, c, u, r, b, count, q, d, u_0, d_next, q_next, i);
  }
  for (; i + lanes <= n; i += lanes) {
    step_some<1>(f, c, u, r, b, count, q, d, u_0, d_next, q_next, i);
  }
  for (; i < n; ++i) {
    double newest = f[i] * c[i], sum = 0;
    for (int j = 1; j <= count; ++j) {
      newest = add_product(-r[j], u[j][i], newest);
      sum = add_product(b[j], u[j][i], sum);
    }
    u_0[i] = newest;
    d_next[i] = d[i] + add_product(b[0], newest, sum);
    q_next[i] = q[i] + d_next[i];
  }
}

// Sums over all numbers are `sums` partial sums, each of every `sums`-th number, for any width of
// vectors: so all processors round them alike.
constexpr int sums = 32, vectors_of_sums = sums / lanes;

// add_lanes(i, sum) and add_number(i, sum) return a sum and what number i and, in a vector, the
// next ones add to it.
template <class AddLanes, class AddNumber>
[[gnu::always_inline]] inline double sum_of(std::ptrdiff_t n, const AddLanes& add_lanes,
                                            const AddNumber& add_number) {
  Lanes columns[vectors_of_sums] = {};
  std::ptrdiff_t i = 0;
  for (; i + sums <= n; i += sums) {
    unroll<vectors_of_sums>([&]<int w>() __attribute__((always_inline)) {
      columns[w] = add_lanes(i + w * lanes, columns[w]);
    });
  }
  // Eight sums of the 32, then their sum.
  double eight[8] = {};
  double column[sums];
  for (int w = 0; w < vectors_of_sums; ++w) store(column + w * lanes, columns[w]);
  for (int t = 0; t < 8; ++t) {
    eight[t] = (column[t] + column[8 + t]) + (column[16 + t] + column[24 + t]);
  }
  double total = 0;
  for (const double part : eight) total += part;
  for (; i < n; ++i) total = add_number(i, total);
  return total;
}

// number(i) and lanes_at(i) return the numbers to square: one, or a vector of them.
template <class LanesAt, class Number>
[[gnu::always_inline]] inline double sum_of_squares(std::ptrdiff_t n, const LanesAt& lanes_at,
                                                    const Number& number) {
  return sum_of(
      n,
      [&](std::ptrdiff_t i, Lanes sum) __attribute__((always_inline)) {
        const Lanes some = lanes_at(i);
        return add_product(some, some, sum);
      },
      [&](std::ptrdiff_t i, double sum) {
        const double some = number(i);
        return add_product(some, some, sum);
      });
}

double squared_norm(const double* x, std::ptrdiff_t n) {
  return sum_of_squares(
      n, [&](std::ptrdiff_t i) __attribute__((always_inline)) { return load(x + i); },
      [&](std::ptrdiff_t i) { return x[i]; });
}

double product(const double* a, const double* b, std::ptrdiff_t n) {
  return sum_of(
      n,
      [&](std::ptrdiff_t i, Lanes sum)
          __attribute__((always_inline)) { return add_product(load(a + i), load(b + i), sum); },
      [&](std::ptrdiff_t i, double sum) { return add_product(a[i], b[i], sum); });
}

double product_with_sum(const double* a, const double* b, const double* c, std::ptrdiff_t n) {
  return sum_of(
      n,
      [&](std::ptrdiff_t i, Lanes sum) __attribute__((always_inline)) {
        return add_product(load(a + i) + load(b + i), load(c + i), sum);
      },
      [&](std::ptrdiff_t i, double sum) { return add_product(a[i] + b[i], c[i], sum); });
}

double squared_norm_of_kicked(const double* v, double c, const double* f, const Masses& masses,
                              std::ptrdiff_t n) {
  return with_quotients(
      masses, [&](const auto& quotient) __attribute__((always_inline)) {
        return sum_of_squares(
            n,
            [&](std::ptrdiff_t i) __attribute__((always_inline)) {
              return add_product(c + Lanes{}, quotient(load(f + i), i), load(v + i));
            },
            [&](std::ptrdiff_t i) { return add_product(c, f[i] / masses.m[i], v[i]); });
      });
}

// x/(rtol |y| + atol)
[[gnu::always_inline]] inline Lanes in_tolerances(Lanes x, double rtol, Lanes y, double atol) {
  const Lanes size = reinterpret_cast<Lanes>(reinterpret_cast<LaneNumbers>(y) & __LONG_MAX__);
  return x / add_product(rtol + Lanes{}, size, atol + Lanes{});
}

double squared_error(const double* x, double rtol, const double* y, double atol, std::ptrdiff_t n) {
  return sum_of_squares(
      n,
      [&](std::ptrdiff_t i) __attribute__((always_inline)) {
        return in_tolerances(load(x + i), rtol, load(y + i), atol);
      },
      [&](std::ptrdiff_t i) { return x[i] / add_product(rtol, __builtin_fabs(y[i]), atol); });
}

}  // namespace

extern const VectorKernels vector_kernels;
const VectorKernels vector_kernels = {.add_scaled = add_scaled,
                                      .add_quotient = add_quotient,
                                      .kick_and_drift = kick_and_drift,
                                      .half_kick_and_drift = half_kick_and_drift,
                                      .divide = divide,
                                      .multiply = multiply,
                                      .add_combination = add_combination,
                                      .step_by_history = step_by_history,
                                      .squared_norm = squared_norm,
                                      .product = product,
                                      .product_with_sum = product_with_sum,
                                      .squared_norm_of_kicked = squared_norm_of_kicked,
                                      .squared_error = squared_error};

}  // namespace qddot::kernels::QDDOT_LEVEL
