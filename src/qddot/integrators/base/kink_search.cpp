#include "qddot/integrators/base/kink_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace qddot {
namespace {

constexpr int bisections = 60;
// A polynomial is divided into halves so many times to show that it is positive.
constexpr int divisions = 24;
// The number of looks for the place where a length is least.
constexpr int looks = 8;

// A length on a step as a polynomial on [0, 1]: values, slopes and second derivatives at its ends.
struct Path {
  double value[2], slope[2], curve[2];

  double cubic(double s) const {
    const double r = 1 - s;
    return r * r * ((1 + 2 * s) * value[0] + s * slope[0]) +
           s * s * ((1 + 2 * r) * value[1] - r * slope[1]);
  }
  // The quintic polynomial is the cubic one and s^2 (1 - s)^2 ((1 - s) excess(0) + s excess(1)).
  double excess(int end) const {
    const double rise = value[1] - value[0];
    return end == 0 ? curve[0] / 2 - 3 * rise + 2 * slope[0] + slope[1]
                    : curve[1] / 2 + 3 * rise - slope[0] - 2 * slope[1];
  }
  double quintic(double s) const {
    const double r = 1 - s;
    return cubic(s) + s * s * r * r * (r * excess(0) + s * excess(1));
  }
  double doubt() const { return std::max(std::abs(excess(0)), std::abs(excess(1))); }
  // A place on the cubic polynomial where the sign, which differs at the ends, changes.
  double change() const {
    double low = 0, high = 1;
    for (int i = 0; i < bisections; ++i) {
      const double middle = (low + high) / 2;
      (cubic(middle) * value[0] <= 0 ? high : low) = middle;
    }
    return high;
  }
};

// The coefficients of a polynomial of degree 5 in Bernstein's form. It lies between the least and
// the largest of them.
using Bernstein = std::array<double, 6>;

// The quintic polynomial less doubt s^2 (1 - s)^2, all times the sign.
Bernstein lower_bound(const Path& path, double sign) {
  const auto& [value, slope, curve] = path;
  // s^2 (1 - s)^2 has the coefficients 0, 0, 1/10, 1/10, 0, 0.
  const double less = path.doubt() / 10;
  return {sign * value[0],
          sign * (value[0] + slope[0] / 5),
          sign * (value[0] + 2 * slope[0] / 5 + curve[0] / 20) - less,
          sign * (value[1] - 2 * slope[1] / 5 + curve[1] / 20) - less,
          sign * (value[1] - slope[1] / 5),
          sign * value[1]};
}

// Whether the polynomial is positive on [0, 1]; false if that is not found out.
bool is_positive(Bernstein b, int left = divisions) {
  if (std::ranges::all_of(b, [](double x) { return x > 0; })) return true;
  if (left == 0 || !(b.front() > 0 && b.back() > 0)) return false;
  Bernstein first;  // de Casteljau: b becomes the second half
  for (std::size_t i = 0; i < b.size(); ++i) {
    first[i] = b[0];
    for (std::size_t j = 0; j + 1 + i < b.size(); ++j) b[j] = (b[j] + b[j + 1]) / 2;
  }
  return is_positive(first, left - 1) && is_positive(b, left - 1);
}

// The part of a step over which differences in time are taken, and the least part of the time, of
// which they lose no more than half of their digits.
constexpr double small_part = 0.01, least_part = 1e-6;

}  // namespace

KinkSearch::KinkSearch(const System& system)
    : kinks_(system.kinks()), moves_by_itself_(!system.is_autonomous()) {
  const Index n = kinks_ ? kinks_->kink_count() : 0;
  ahead_.resize(n);
  behind_.resize(n);
  for (int end : {0, 1}) {
    length_[end].resize(n);
    rate_[end].resize(n);
    acceleration_[end].resize(n);
  }
}

void KinkSearch::look(const Instant& a, const Instant& b) {
  const Instant* const ends[] = {&a, &b};
  for (int end : {0, 1}) {
    const State& state = ends[end]->state;
    const double t = state.t;
    kinks_->kink_lengths({t, state.q}, length_[end]);
    // Lengths are affine in q.
    place_ = state.q + state.v;
    kinks_->kink_lengths({t, place_}, rate_[end]);
    rate_[end] -= length_[end];
    place_ = state.q + ends[end]->a;
    kinks_->kink_lengths({t, place_}, acceleration_[end]);
    acceleration_[end] -= length_[end];
    if (!moves_by_itself_) continue;
    // Points that move, by central differences.
    const double e =
        std::max(small_part * (b.state.t - a.state.t), least_part * std::abs(b.state.t));
    kinks_->kink_lengths({t + e, state.q}, ahead_);
    kinks_->kink_lengths({t - e, state.q}, behind_);
    rate_[end] += (ahead_ - behind_) / (2 * e);
    acceleration_[end] += (ahead_ - 2 * length_[end] + behind_) / (e * e);
  }
}

std::optional<KinkSearch::Change> KinkSearch::first(const Instant& a, const Instant& b) {
  look(a, b);
  const double h = b.state.t - a.state.t;
  std::optional<Change> first, doubtful;
  for (Index i = 0; i < length_[0].size(); ++i) {
    const Path path{{length_[0][i], length_[1][i]},
                    {h * rate_[0][i], h * rate_[1][i]},
                    {h * h * acceleration_[0][i], h * h * acceleration_[1][i]}};
    const auto [d0, d1] = path.value;
    if (d0 == 0 && d1 == 0) continue;
    if (d0 * d1 <= 0) {
      const double part = d0 == 0 ? 0 : path.change();
      if (!first) first.emplace();
      if (part <= first->part) {
        first->part = part;
        first->speed = std::abs(rate_[0][i]);
      }
      first->is_at_end = first->is_at_end || d1 == 0;
    } else if (const double sign = d0 > 0 ? 1 : -1; !is_positive(lower_bound(path, sign))) {
      Change change{.part = 1. / 2, .is_certain = false};
      double least = sign * path.quintic(change.part);
      for (int look = 1; look < looks; ++look) {
        const double s = 1. * look / looks, size = sign * path.quintic(s);
        if (size < least) change.part = s;
        least = std::min(least, size);
      }
      change.nearest = std::abs(least) + path.doubt() / 16;
      if (!doubtful || change.part < doubtful->part) doubtful = change;
    }
  }
  return first ? first : doubtful;
}

double KinkSearch::depth(const Instant& a, const Instant& b) {
  look(a, b);
  double least = INFINITY;
  for (Index i = 0; i < length_[0].size(); ++i) {
    const double d0 = length_[0][i], a0 = acceleration_[0][i], a1 = acceleration_[1][i];
    if (d0 * length_[1][i] >= 0 || d0 * a0 <= 0 || d0 * a1 >= 0) continue;
    const double rate = rate_[0][i];
    least = std::min(least, rate * rate / (2 * std::abs(a0)));
  }
  return least;
}

}  // namespace qddot
