#include "experiments/solvers/direct_solvers.hpp"
#include "qddot/measure/motion/timing.hpp"

// C = alpha A B + beta C of column-major matrices (Dongarra, Du Croz, Hammarling, Hanson, ACM TOMS
// 14 (1988) 1-17), as Fortran calls it.
extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n,
                       const int* k, const double* alpha, const double* a, const int* lda,
                       const double* b, const int* ldb, const double* beta, double* c,
                       const int* ldc);

namespace qddot::solvers {

double product_flops(double seconds) {
  constexpr int n = 480;  // three of them fit about into the second cache
  constexpr double one = 1, zero = 0;
  const std::vector<double> a(n * n, 0.5), b = a;
  std::vector<double> c(n * n);
  const double least = measure::least_seconds(seconds, [&] {
    dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n);
  });
  return 2.0 * n * n * n / least;
}

}  // namespace qddot::solvers
