#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <Eigen/Core>

namespace qddot {
inline namespace tests {

// One long step of y' = f(t, y) by Gragg's midpoint rule, with 2, 4, 6, ... substeps and
// extrapolation to infinitely many (Hairer, Norsett, Wanner: Solving ODEs I, II.9), in long double.
class ExtrapolatedStep {
 public:
  using Real = long double;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  struct Result {
    Vector y;       // after the step
    Real error;     // over the tolerance, of the last but one column; that of y is smaller
    Real stretch;   // by what the next step may be longer
    bool is_whole;  // whether all slopes exist
  };

  // The error is the largest of all components, each over its size times the tolerance. slope(t, y)
  // returns f, or nothing where it does not exist.
  template <class Slope>
  static Result step(const Slope& slope, Real t, const Vector& y, Real h, Real tolerance,
                     const Vector& sizes) {
    const std::optional<Vector> first = slope(t, y);
    if (!first) return {y, 0, 1, false};
    std::array<Vector, columns> row;
    Result result{y, 0, 1, true};
    for (std::size_t j = 0; j < columns; ++j) {
      const std::optional<Vector> coarse = midpoint(slope, t, y, *first, h, substeps(j));
      if (!coarse) return {y, 0, 1, false};
      const Real change = extrapolate(*coarse, j, row, sizes);
      if (j < least_columns - 1) continue;
      result.error = change / tolerance;
      result.y = y + row[j];
      result.stretch = stretch(result.error, j);
      if (result.error <= 1) break;
    }
    return result;
  }

 private:
  static constexpr std::size_t columns = 9, least_columns = 5;
  static int substeps(std::size_t j) { return 2 * (static_cast<int>(j) + 1); }

  // The increment of y by n substeps of the midpoint rule; its error has even powers of h/n only.
  template <class Slope>
  static std::optional<Vector> midpoint(const Slope& slope, Real t, const Vector& y,
                                        const Vector& first, Real h, int n) {
    const Real part = h / n;
    Vector before = Vector::Zero(y.size()), now = part * first;
    for (int k = 1; k < n; ++k) {
      const std::optional<Vector> f = slope(t + k * part, y + now);
      if (!f) return {};
      before += 2 * part * *f;
      before.swap(now);
    }
    return now;
  }

  // Adds row j of Aitken's and Neville's table; row[k] then is its column j - k from the end of the
  // former rows. Returns the largest change by the last column, over sizes.
  static Real extrapolate(const Vector& coarse, std::size_t j, std::array<Vector, columns>& row,
                          const Vector& sizes) {
    // On entry row[k] is T(j - 1, k); on return T(j, k).
    Vector value = coarse, last_change = Vector::Zero(coarse.size());
    for (std::size_t k = 0; k < j; ++k) {
      const Real ratio = static_cast<Real>(substeps(j)) / substeps(j - k - 1);
      last_change = (value - row[k]) / (ratio * ratio - 1);
      row[k].swap(value);
      value = row[k] + last_change;
    }
    row[j] = value;
    Real largest = 0;
    for (Eigen::Index c = 0; c < sizes.size(); ++c) {
      const Real own = std::abs(last_change[c]) / sizes[c];
      // A number that is none is an error, too.
      largest = std::isnan(own) ? std::numeric_limits<Real>::infinity() : std::max(largest, own);
    }
    return largest;
  }

  // The error after j + 1 rows goes with h^(2 j + 1). Fewer rows than all let the step grow.
  static Real stretch(Real error, std::size_t j) {
    if (!(error < 1e30L)) return 0.25L;
    const Real factor =
        0.9L * std::pow(std::max(error, Real(1e-30L)), -1.0L / static_cast<Real>(2 * j + 1));
    const Real more = j + 1 < columns ? 1.0L + 0.1L * static_cast<Real>(columns - 1 - j) : 1.0L;
    return std::min(Real(3), std::max(Real(0.2L), factor * more));
  }
};

}  // namespace tests
}  // namespace qddot
