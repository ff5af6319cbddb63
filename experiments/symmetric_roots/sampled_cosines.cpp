#include "experiments/symmetric_roots/sampled_cosines.hpp"

#include <algorithm>
#include <array>
#include <functional>

namespace qddot::spurious_roots {
namespace {

constexpr std::array bases = {2, 3, 5, 7, 11};
// A root with a larger cosine is within 0.3 of the motion's own, and the limit is less than that.
constexpr double lowest = -1, highest = 0.95;

// The digits of the number in a base, mirrored at the point.
double mirrored(int number, int base) {
  double sum = 0, place = 1;
  for (; number > 0; number /= base) {
    place /= base;
    sum += number % base * place;
  }
  return sum;
}

}  // namespace

std::vector<double> sampled_cosines(int index, int pairs) {
  std::vector<double> cosines;
  for (int i = 0; i < pairs; ++i) {
    const double share = mirrored(index, bases[static_cast<std::size_t>(i)]);
    cosines.push_back(lowest + (highest - lowest) * share);
  }
  std::ranges::sort(cosines, std::greater());
  return cosines;
}

}  // namespace qddot::spurious_roots
