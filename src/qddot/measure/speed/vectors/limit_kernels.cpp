#include "qddot/measure/speed/limit_kernels.hpp"

#include "qddot/model/kernels/vectors/lanes.hpp"

namespace qddot::inline measure::QDDOT_LEVEL {
namespace {

using namespace kernels::QDDOT_LEVEL;

// Independent chains of operations: more than two units of latency 4 need.
constexpr int chains = 12;

double multiply_and_add(int rounds) {
  Lanes factor = 0.5 + Lanes{}, term = 1 + Lanes{}, chain[chains] = {};
  asm volatile("" : "+m"(factor), "+m"(term), "+m"(chain));
  const Lanes m = factor, t = term;
  Lanes x[chains];
  for (int c = 0; c < chains; ++c) x[c] = chain[c];
  for (int i = 0; i < rounds; ++i) {
    unroll<chains>([&]<int c>() __attribute__((always_inline)) { x[c] = x[c] * m + t; });
  }
  for (int c = 0; c < chains; ++c) chain[c] = x[c];
  asm volatile("" : "+m"(chain));
  return 2.0 * lanes * chains * rounds;
}

void triad(const double* b, const double* c, double s, double* a, std::ptrdiff_t n) {
  const std::ptrdiff_t whole = n / lanes * lanes;
  for (std::ptrdiff_t i = 0; i < whole; i += lanes) store(a + i, load(b + i) + s * load(c + i));
  for (std::ptrdiff_t i = whole; i < n; ++i) a[i] = b[i] + s * c[i];
}

double sum(const double* x, std::ptrdiff_t n) {
  Lanes sums[8] = {};
  for (std::ptrdiff_t i = 0; i < n; i += 8 * lanes) {
    unroll<8>([&]<int c>() __attribute__((always_inline)) { sums[c] += load(x + i + c * lanes); });
  }
  double total = 0;
  // Indices are used because a deduced type, as of a range's elements, loses the attribute that
  // Lanes may be unaligned.
  for (int c = 0; c < 8; ++c) {
    for (int t = 0; t < lanes; ++t) total += sums[c][t];
  }
  return total;
}

}  // namespace

extern const LimitKernels limit_kernels;
const LimitKernels limit_kernels = {multiply_and_add, triad, sum};

}  // namespace qddot::inline measure::QDDOT_LEVEL
