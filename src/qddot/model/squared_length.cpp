#include "qddot/model/squared_length.hpp"

#include <algorithm>

namespace qddot {
namespace {

constexpr double narrowest = 1e-6;
constexpr std::size_t most_coefficients = 11;

// The same on [at, at + width], where c are the coefficients.
std::optional<double> first_below(std::span<const double> c, double bound, double at,
                                  double width) {
  if (c.front() < bound) return at;
  if (std::ranges::min(c) >= bound) return {};
  if (width < narrowest) return c.back() < bound ? std::optional(at + width) : std::nullopt;
  // de Casteljau: the coefficients on the two halves.
  std::array<double, most_coefficients> left, right;
  std::ranges::copy(c, right.begin());
  for (std::size_t level = 0; level < c.size(); ++level) {
    left[level] = right.front();
    for (std::size_t i = 0; i + level + 1 < c.size(); ++i) right[i] = (right[i] + right[i + 1]) / 2;
  }
  if (const auto s = first_below({left.data(), c.size()}, bound, at, width / 2)) return s;
  return first_below({right.data(), c.size()}, bound, at + width / 2, width / 2);
}

}  // namespace

std::optional<double> first_below(std::span<const double> c, double bound) {
  return first_below(c, bound, 0, 1);
}

}  // namespace qddot
