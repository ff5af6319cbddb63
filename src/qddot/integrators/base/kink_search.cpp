#include "qddot/integrators/base/kink_search.hpp"

#include <cmath>

namespace qddot {
namespace {

// The number of looks at a length within a step, as it may change its sign twice.
constexpr int looks = 8;
constexpr int bisections = 60;

// The cubic polynomial on [0, 1] with these values and slopes at its ends.
struct Cubic {
  double value[2], slope[2];

  double at(double s) const {
    const double r = 1 - s;
    return r * r * ((1 + 2 * s) * value[0] + s * slope[0]) +
           s * s * ((1 + 2 * r) * value[1] - r * slope[1]);
  }
  // The first place with another sign than that at 0, or none.
  std::optional<double> first_change() const {
    const auto differs = [&](double s) { return at(s) * value[0] <= 0; };
    for (int look = 1; look <= looks; ++look) {
      double high = 1. * look / looks;
      if (!(look == looks ? value[1] * value[0] <= 0 : differs(high))) continue;
      double low = 1. * (look - 1) / looks;
      for (int i = 0; i < bisections; ++i) {
        const double middle = (low + high) / 2;
        (differs(middle) ? high : low) = middle;
      }
      return high;
    }
    return {};
  }
};

}  // namespace

KinkSearch::KinkSearch(const System& system) : kinks_(capability<Kinks>(system)) {
  const Index n = kinks_ ? kinks_->kinks() : 0;
  for (int end : {0, 1}) {
    length_[end].resize(n);
    rate_[end].resize(n);
  }
}

std::optional<KinkSearch::Change> KinkSearch::first(const State& a, const State& b) {
  const State* const ends[] = {&a, &b};
  for (int end : {0, 1}) {
    kinks_->kink_lengths(ends[end]->q, length_[end]);
    place_ = ends[end]->q + ends[end]->v;
    kinks_->kink_lengths(place_, rate_[end]);  // lengths are affine
    rate_[end] -= length_[end];
  }
  const double h = b.t - a.t;
  std::optional<Change> first;
  for (Index i = 0; i < length_[0].size(); ++i) {
    const double d0 = length_[0][i], d1 = length_[1][i];
    std::optional<double> part;
    if (d0 == 0) {
      if (d1 != 0) part = 0;
    } else if (d0 * d1 <= 0 || (d0 * rate_[0][i] < 0 && d1 * rate_[1][i] > 0)) {
      part = Cubic{{d0, d1}, {h * rate_[0][i], h * rate_[1][i]}}.first_change();
    }
    if (!part) continue;
    if (!first) first.emplace();
    if (*part <= first->part) {
      first->part = *part;
      first->speed = std::abs(rate_[0][i]);
    }
    first->is_at_end = first->is_at_end || d1 == 0;
  }
  return first;
}

}  // namespace qddot
